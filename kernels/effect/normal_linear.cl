/* normal: linear spring and dashpot, N = [k d + 2 xi sqrt(m* k) d']_+ while the two touch.
 * Reads NORMAL_STIFFNESS = k (N/m), NORMAL_DAMPING = 2 xi sqrt(k). Writes spring and damper; the stage clamps. */
#ifndef NORMAL_STIFFNESS
#define NORMAL_STIFFNESS 0
#define NORMAL_DAMPING 1
#endif

/* d ln(energy)/d ln r* at a given overlap. */
#define NORMAL_ENERGY_BY_RADIUS R(0.0)

INLINE void normal_force(const contact *c, response *out)
{
    real damping = c->overlap > R(0.0) ? modulus_root(modulus_normal(c)) * c->value[NORMAL_DAMPING] * sqrt(c->mass_eff) : R(0.0);
    out->spring = modulus_normal(c) * c->value[NORMAL_STIFFNESS] * c->overlap;
    out->damper = damping * c->approach;
}

INLINE real normal_energy(const contact *c)
{
    return R(0.5) * modulus_normal(c) * c->value[NORMAL_STIFFNESS] * c->overlap * c->overlap;
}

INLINE mode normal_mode(const contact *c)
{
    real touching = c->overlap > R(0.0) ? R(1.0) : R(0.0);
    mode m = {touching * modulus_normal(c) * c->value[NORMAL_STIFFNESS], touching * modulus_root(modulus_normal(c)) * c->value[NORMAL_DAMPING] * sqrt(c->mass_eff)};
    return m;
}
