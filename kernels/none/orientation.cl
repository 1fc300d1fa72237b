/* orientation: not followed. */
#define ORIENTATION_PARTICLE_FIELDS(READ, WRITE)
#define ORIENTATION_ADVANCE(launch, i, spin)
