/* radiation: Q = eps B (T_E^4 - T^4) 4 pi r^2 (TM Eq. 41), to the environment; grains do not see each other. Written as a coefficient times
 * T_E - T, so that nothing cancels near equilibrium. Reads RADIATION_STRENGTH = 4 pi eps B. */
#ifndef RADIATION_STRENGTH
#define RADIATION_STRENGTH 0
#endif

/* W/K between the surroundings and a surface at `temperature` */
INLINE real radiation_coefficient(const grain *g, real temperature)
{
    real t = g->surroundings;
    return g->value[RADIATION_STRENGTH] * g->radius * g->radius * (t + temperature) * (t * t + temperature * temperature);
}
