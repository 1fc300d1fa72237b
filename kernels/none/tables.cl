/* tables: no property depends on temperature. */
#define TABLES_PAIR_FIELDS(READ, WRITE)
#define TABLES_PARTICLE_FIELDS(READ, WRITE)
#define TABLES_OF_PAIRS ((__global const real *)0)
#define TABLES_OF_GRAINS ((__global const real *)0)
