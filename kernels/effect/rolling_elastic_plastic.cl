/* rolling: rotational spring, damper and slider, TM Eq. 15-20 with the moment against the relative spin (docs/theory.md).
 * k = 8 G* sqrt(r* d) r*^2, c = 2 xi sqrt(8 G* j* sqrt(r*)) r* d^(1/4), limit mu_r r* N; j = (7/5) m r^2 about the contact.
 * Reads ROLLING_MODULUS = 8 G*, ROLLING_DAMPING = 2 xi sqrt(8 G*), ROLLING_FRICTION = mu_r,
 * ROLLING_COMPLIANCE = 1/(8 G*); history: rolling_spring (rad). */
#ifndef ROLLING_MODULUS
#define ROLLING_MODULUS 0
#define ROLLING_DAMPING 1
#define ROLLING_FRICTION 2
#define ROLLING_COMPLIANCE 3
#endif
#ifndef ROLLING_TWIST
#define ROLLING_TWIST R(1.0)
#endif
#define ROLLING_PAIR_FIELDS(READ, WRITE) WRITE(real, rolling_spring)
#define ROLLING_ASK_FOR(launch, k) RECORDS_ASK_FOR(launch, rolling_spring, 3, k)
#define ROLLING_LOAD(launch, k, s) (s).spring = LOAD_AXIAL3(rolling_spring, (launch)->record_stride, k)
#define ROLLING_STORE(launch, k, s) STORE_AXIAL3(rolling_spring, (launch)->record_stride, k, (s).spring)

typedef struct rolling_state {
    vec3 spring;
} rolling_state;

/* 1/j* = sum 1/(j + m r^2); a wall, and a grain that is held, is infinitely heavy: then mass_eff is the free one's mass. */
INLINE real rolling_inertia(const contact *c)
{
    real ii = c->mass_i * c->radius_i * c->radius_i, jj = c->mass_j * c->radius_j * c->radius_j;
    return R(1.4) * ii * jj / (ii + jj);
}

/* Turned with the pair: by the turn of the normal and the mean spin about it. */
INLINE vec3 rolling_turn(const contact *c, vec3 spring)
{
    real twist = R(0.5) * dot3(add(c->past_spin_i, c->past_spin_j), c->n);
    return turn_by(spring, scale(c->elapsed, add_scaled(c->turn, twist, c->n)));
}

INLINE vec3 rolling_rate(const contact *c, vec3 spin_i, vec3 spin_j)
{
    vec3 rate = sub(spin_i, spin_j);
    return add_scaled(rate, (ROLLING_TWIST - R(1.0)) * dot3(rate, c->n), c->n);
}

INLINE mode rolling_mode(const contact *c)
{
    mode m = {modulus_rolling(c) * c->value[ROLLING_MODULUS] * c->contact_radius * c->radius_eff * c->radius_eff,
              modulus_root(modulus_rolling(c)) * c->value[ROLLING_DAMPING] * sqrt(rolling_inertia(c) * c->contact_radius) * c->radius_eff};
    return m;
}

INLINE void rolling_moment(const contact *c, rolling_state *s, response *out)
{
    mode m = rolling_mode(c);
    vec3 rate = rolling_rate(c, c->spin_i, c->spin_j);
    vec3 before = rolling_turn(c, s->spring);
    vec3 spring = add_scaled(before, c->elapsed, rolling_rate(c, c->past_spin_i, c->past_spin_j));
    vec3 trial = add_scaled(scale(-m.stiffness, spring), -m.damping, rate);
    real size = sqrt(dot3(trial, trial)), limit = c->value[ROLLING_FRICTION] * c->radius_eff * out->bearing;
    real compliance = modulus_inverse(modulus_rolling(c)) * c->value[ROLLING_COMPLIANCE] * c->contact_inverse * c->radius_inverse * c->radius_inverse;
    bool yields = size > limit, live = compliance > R(0.0);
    real factor = yields ? limit / size : R(1.0);
    out->rolling = scale(factor, trial);
    vec3 returned = scale(-compliance, add_scaled(out->rolling, m.damping, rate));
    s->spring = v3(yields ? returned.x : spring.x, yields ? returned.y : spring.y, yields ? returned.z : spring.z);
    s->spring = v3(live ? s->spring.x : R(0.0), live ? s->spring.y : R(0.0), live ? s->spring.z : R(0.0));
    /* in another order than those of the tangential spring: the compiler pairs up what is the same, and then no longer vectorises over records */
    spring_step step = {m.stiffness,
                        dot3(scale(R(0.5) * m.stiffness, before), before),
                        dot3(scale(R(0.5) * m.stiffness, s->spring), s->spring),
                        dot3(scale(R(0.5) * m.stiffness, s->spring), before),
                        limit * compliance * (R(0.5) * limit),
                        R(1.0),
                        yields,
                        scale(-m.damping, rate)};
    out->turning = step;
}

INLINE real rolling_energy(const contact *c, const rolling_state *s, real normal)
{
    real compliance = modulus_inverse(modulus_rolling(c)) * c->value[ROLLING_COMPLIANCE] * c->contact_inverse * c->radius_inverse * c->radius_inverse;
    return spring_energy(rolling_mode(c).stiffness, compliance, s->spring, c->value[ROLLING_FRICTION] * c->radius_eff * normal);
}
