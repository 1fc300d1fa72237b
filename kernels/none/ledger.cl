/* ledger: nobody asks for energies. */
#define LEDGER_PAIR_FIELDS(READ, WRITE)
#define LEDGER_PARTICLE_FIELDS(READ, WRITE)
#define LEDGER_LOAD(launch, k, s) (s).unused = 0
#define LEDGER_STORE(launch, k, s)
#define LEDGER_ADVANCE(launch, i, step)
#define LEDGER_HALF_STEP(launch, i, step, now, ends)

typedef struct ledger_state {
    int unused;
} ledger_state;

INLINE void ledger_contact(ledger_state *s, dissipation lost)
{
    (void)s;
    (void)lost;
}

INLINE void ledger_wall(ledger_state *s, real work)
{
    (void)s;
    (void)work;
}
