/* substance: one material; its constants are those of every grain. */
#define SUBSTANCE_PARTICLE_FIELDS(READ, WRITE)
#define SUBSTANCE_ROW(i) 0
