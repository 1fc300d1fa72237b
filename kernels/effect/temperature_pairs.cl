/* temperature of the bodies of a contact, for the laws that read it. */
#define TEMPERATURE_PAIR_FIELDS(READ, WRITE) READ(exact, temperature)
#define TEMPERATURE_OF_BODY(i) number(temperature[i])
#define TEMPERATURE_ROWS 1
#define TEMPERATURE_ROWS_FILL(i, to) rows_number(temperature, i, to)
#define TEMPERATURE_OF_ROWS(rows, n, lane) ROW_NUMBER(rows, n, lane)
#define TEMPERATURE_ASK_FOR(i) ASK_FOR(temperature + (i))
