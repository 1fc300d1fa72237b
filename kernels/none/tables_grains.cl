/* tables: no property of single grains depends on temperature. */
#define TABLES_PARTICLE_FIELDS(READ, WRITE)
#define TABLES_OF_GRAINS ((__global const real *)0)
