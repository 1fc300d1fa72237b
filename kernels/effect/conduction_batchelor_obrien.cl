/* conduction: H = 2 a k between two grains, k the harmonic mean, and H = 4 a k at a wall, an isothermal half-space (Batchelor & O'Brien 1977;
 * HC Eqs. 9-12 with the mean as settled in docs/theory.md); a = sqrt(r* d) is the radius of a Hertz contact, or that of a neck.
 * Reads CONDUCTION_STRENGTH, which holds the conductivities and the factors of the soft modulus, and CONDUCTION_SHARE, the
 * share of the owner in the resistance. */
#ifndef CONDUCTION_STRENGTH
#define CONDUCTION_STRENGTH 0
#define CONDUCTION_SHARE 1
#endif

INLINE real conduction_conductance(const contact *c)
{
    real a = c->neck > R(0.0) ? c->neck : sqrt(c->radius_eff * c->touch);
    return conductivity_shared(c, c->value[CONDUCTION_SHARE]) * c->value[CONDUCTION_STRENGTH] * a;
}

INLINE real conduction_wall_conductance(const contact *c)
{
    return conduction_conductance(c);
}
