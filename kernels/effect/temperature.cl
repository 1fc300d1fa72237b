/* temperature: one for each grain, m c dT/dt = Q (TM Eq. 28), explicit. Reads and writes temperature; reads the constants of the grain's
 * material. What a grain stores is in a file of
 * its own. Assumes that a grain is isothermal (Biot number below 0.1). */
#ifndef GRAIN_CONSTANTS
#define GRAIN_CONSTANTS 1
#endif
#define TEMPERATURE_PARTICLE_FIELDS(READ, WRITE) WRITE(exact, temperature) READ(real, grain_constants)
#define TEMPERATURE_OF_GRAIN(i) number(temperature[i])
#define TEMPERATURE_PRECISE(i) precise_load(temperature[i])
#define TEMPERATURE_CONSTANTS(row) (grain_constants + (row)*GRAIN_CONSTANTS)
#define TEMPERATURE_STORE(i, t) temperature[i] = precise_store(t)

/* The only place that adds to a temperature. */
INLINE precise temperature_after(precise temperature, real rise)
{
    return precise_add(temperature, precise_from(rise));
}
