/* convection: TM Eqs. 37-40, Nu = 2 + (0.4 Re^1/2 + 0.06 Re^2/3) Pr^0.4 with the velocity relative to the gas; its viscosity at the grain's
 * surface is taken as that of the gas. Reads k of the gas, Pr^0.4, and 2 rho/mu, so that Re = that times r |v - v_gas|. */
#ifndef CONVECTION_GAS
#define CONVECTION_GAS 0
#define CONVECTION_PRANDTL 1
#define CONVECTION_REYNOLDS 2
#endif

/* W/K */
INLINE real convection_coefficient(const grain *g, real temperature)
{
    (void)temperature;
    vec3 u = sub(g->velocity, g->gas);
    real re = g->value[CONVECTION_REYNOLDS] * g->radius * sqrt(dot3(u, u));
    real third = cbrt(re);
    real nu = R(2.0) + (R(0.4) * sqrt(re) + R(0.06) * third * third) * g->value[CONVECTION_PRANDTL];
    return nu * g->value[CONVECTION_GAS] * R(6.2831853071795862) * g->radius;
}
