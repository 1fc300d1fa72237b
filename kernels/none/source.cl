/* source: no beam. */
#define SOURCE_PARTICLE_FIELDS(READ, WRITE)
#define SOURCE_HEAT(launch, i, g) R(0.0)
