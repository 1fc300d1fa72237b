/* substance: several materials; a grain looks the constants of its own up. */
#define SUBSTANCE_PARTICLE_FIELDS(READ, WRITE) READ(int, material)
#define SUBSTANCE_ROW(i) material[i]
