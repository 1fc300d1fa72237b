/* tables: properties of grains that depend on temperature. */
#define TABLES_PARTICLE_FIELDS(READ, WRITE) READ(real, property_tables)
#define TABLES_OF_GRAINS property_tables
