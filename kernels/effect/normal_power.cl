/* normal: a power of the overlap, BM Eq. 7; N = [k d^a + 2 xi sqrt(m* a k d^(a-1)) d']_+ while the two touch; the stage clamps.
 * Reads NORMAL_STIFFNESS = k (N/m^a), NORMAL_EXPONENT = a, NORMAL_DAMPING = 2 xi. Writes spring and damper. */
#ifndef NORMAL_STIFFNESS
#define NORMAL_STIFFNESS 0
#define NORMAL_EXPONENT 1
#define NORMAL_DAMPING 2
#endif

/* d ln(energy)/d ln r* at a given overlap. */
#define NORMAL_ENERGY_BY_RADIUS R(0.0)

INLINE real normal_spring(const contact *c)
{
    bool touches = c->overlap > R(0.0);
    real force = modulus_normal(c) * c->value[NORMAL_STIFFNESS] * power_of(touches ? c->overlap : R(1.0), c->value[NORMAL_EXPONENT]);
    return touches ? force : R(0.0);
}

/* 1/d from 1/sqrt(r* d), which is 0 where the two do not touch. */
INLINE mode normal_mode(const contact *c)
{
    real stiffness = c->value[NORMAL_EXPONENT] * normal_spring(c) * (c->contact_inverse * c->contact_inverse * c->radius_eff);
    mode m = {stiffness, c->value[NORMAL_DAMPING] * sqrt(c->mass_eff * stiffness)};
    return m;
}

INLINE void normal_force(const contact *c, response *out)
{
    out->spring = normal_spring(c);
    out->damper = normal_mode(c).damping * c->approach;
}

INLINE real normal_energy(const contact *c)
{
    return normal_spring(c) * c->overlap / (c->value[NORMAL_EXPONENT] + R(1.0));
}
