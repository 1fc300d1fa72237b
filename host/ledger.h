/* The energy ledger's sums over the run (docs/theory.md): three fields of three components, in this order. */
#ifndef CLAST_HOST_LEDGER_H
#define CLAST_HOST_LEDGER_H

#define LEDGER_FIELDS 3
#define LEDGER_TERMS (3 * LEDGER_FIELDS)

/* The observables that make the ledger live. */
extern const char *const ledger_terms[LEDGER_TERMS];

#endif
