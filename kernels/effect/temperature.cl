/* temperature: one for each grain, m c dT/dt = Q (TM Eq. 28), explicit. Reads and writes temperature; reads the constants of the grain's
 * material. Assumes that a grain is isothermal (Biot number below 0.1). */
#ifndef GRAIN_CONSTANTS
#define GRAIN_CONSTANTS 1
#endif
#ifndef SPECIFIC_HEAT
#define SPECIFIC_HEAT 0
#endif
#define TEMPERATURE_PARTICLE_FIELDS(READ, WRITE) WRITE(real, temperature) READ(real, grain_constants)
#define TEMPERATURE_OF_GRAIN(i) temperature[i]
#define TEMPERATURE_CONSTANTS(row) (grain_constants + (row)*GRAIN_CONSTANTS)
#define TEMPERATURE_STORE(i, t) temperature[i] = (t)

/* J/K */
INLINE real temperature_capacity(const grain *g)
{
    return g->mass * g->value[SPECIFIC_HEAT];
}

/* The only place that adds to a temperature. */
INLINE real temperature_after(real temperature, real rise)
{
    return temperature + rise;
}
