/* convection: Q = h (T_E - T) 4 pi r^2 (TM Eq. 37) with h given. Reads CONVECTION_COEFFICIENT = h. */
#ifndef CONVECTION_COEFFICIENT
#define CONVECTION_COEFFICIENT 0
#endif

/* W/K */
INLINE real convection_coefficient(const grain *g, real temperature)
{
    (void)temperature;
    return g->value[CONVECTION_COEFFICIENT] * R(12.566370614359172) * g->radius * g->radius;
}
