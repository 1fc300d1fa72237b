/* convection: h = k/r, a grain in a gas at rest (TM Eqs. 37 and 38 with Nu = 2). Reads CONVECTION_GAS = k of the gas. */
#ifndef CONVECTION_GAS
#define CONVECTION_GAS 0
#endif

/* W/K */
INLINE real convection_coefficient(const grain *g, real temperature)
{
    (void)temperature;
    return g->value[CONVECTION_GAS] * R(12.566370614359172) * g->radius;
}
