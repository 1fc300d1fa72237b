/* tables: no property of a contact depends on temperature. */
#define TABLES_PAIR_FIELDS(READ, WRITE)
#define TABLES_OF_PAIRS ((__global const real *)0)
