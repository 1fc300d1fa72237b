/* modulus: exponential softening, TM Eq. 42 with floor and rate: E = max(E_floor, E0 min(1, exp(beta (1 - T/T*)))), so that softening starts at
 * T* for any beta. Reads SOFTENING_TEMPERATURE = T* (K), SOFTENING_RATE = beta, SOFTENING_FLOOR = E_floor/E0. */
#ifndef SOFTENING_TEMPERATURE
#define SOFTENING_TEMPERATURE 0
#define SOFTENING_RATE 1
#define SOFTENING_FLOOR 2
#endif

INLINE real modulus_at(const grain *g, real temperature)
{
    real above = temperature / g->value[SOFTENING_TEMPERATURE] - R(1.0);
    real factor = above > R(0.0) ? exp(-g->value[SOFTENING_RATE] * above) : R(1.0);
    return factor > g->value[SOFTENING_FLOOR] ? factor : g->value[SOFTENING_FLOOR];
}
