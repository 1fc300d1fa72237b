/* tables: properties of contacts that depend on temperature. */
#define TABLES_PAIR_FIELDS(READ, WRITE) READ(real, property_tables)
#define TABLES_OF_PAIRS property_tables
