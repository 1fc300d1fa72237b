/* temperature of the bodies of a contact: no law of the contact reads it. */
#define TEMPERATURE_PAIR_FIELDS(READ, WRITE)
#define TEMPERATURE_OF_BODY(i) R(0.0)
#define TEMPERATURE_ROWS 0
#define TEMPERATURE_ROWS_FILL(i, to)
#define TEMPERATURE_OF_ROWS(rows, n, lane) R(0.0)
#define TEMPERATURE_ASK_FOR(i)
