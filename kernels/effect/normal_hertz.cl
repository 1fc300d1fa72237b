/* normal: Hertz, TM Eq. 2 and 6; N = [4/3 E* sqrt(r*) d^1.5 + 2 xi sqrt(2 E* m* sqrt(r*)) d^(1/4) d']_+; the stage
 * clamps (BM sec. 4).
 * Reads NORMAL_MODULUS = E* (Pa), NORMAL_DAMPING = 2 xi sqrt(2 E*) (Pa^1/2). Writes spring and damper. */
#ifndef NORMAL_MODULUS
#define NORMAL_MODULUS 0
#define NORMAL_DAMPING 1
#endif

/* d ln(energy)/d ln r* at a given overlap. */
#define NORMAL_ENERGY_BY_RADIUS R(0.5)

INLINE void normal_force(const contact *c, response *out)
{
    out->spring = R(1.33333333333333333) * modulus_normal(c) * c->value[NORMAL_MODULUS] * c->contact_radius * c->overlap;
    out->damper = modulus_root(modulus_normal(c)) * c->value[NORMAL_DAMPING] * c->inertia_root * c->approach;
}

INLINE real normal_energy(const contact *c)
{
    return R(0.53333333333333333) * modulus_normal(c) * c->value[NORMAL_MODULUS] * c->contact_radius * c->overlap * c->overlap;
}

/* Tangent stiffness 2 E* sqrt(r* d). */
INLINE mode normal_mode(const contact *c)
{
    mode m = {R(2.0) * modulus_normal(c) * c->value[NORMAL_MODULUS] * c->contact_radius, modulus_root(modulus_normal(c)) * c->value[NORMAL_DAMPING] * c->inertia_root};
    return m;
}
