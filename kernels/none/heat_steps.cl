/* heat steps: heat advances in every step. */
#define HEAT_STEPS_PARTICLE_FIELDS(READ, WRITE)
#define HEAT_STEPS_GATHER(launch, i, h)
#define HEAT_STEPS_WAITS(launch) false
#define HEAT_STEPS_SPAN(launch) number((launch)->dt)
