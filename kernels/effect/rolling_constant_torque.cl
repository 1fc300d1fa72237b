/* rolling: a moment of mu_r r* N against the relative spin. Reads ROLLING_FRICTION = mu_r; no history. */
#ifndef ROLLING_FRICTION
#define ROLLING_FRICTION 0
#endif
#ifndef ROLLING_TWIST
#define ROLLING_TWIST R(1.0)
#endif
#define ROLLING_PAIR_FIELDS(READ, WRITE)
#define ROLLING_ASK_FOR(launch, k)
#define ROLLING_LOAD(launch, k, s) (s).unused = 0
#define ROLLING_STORE(launch, k, s)

typedef struct rolling_state {
    int unused;
} rolling_state;

/* Within one step the moment may stop the relative spin but not turn it round: it is at most j_eff |w|/dt. */
INLINE void rolling_moment(const contact *c, rolling_state *s, response *out)
{
    (void)s;
    vec3 rate = sub(c->spin_i, c->spin_j);
    rate = add_scaled(rate, (ROLLING_TWIST - R(1.0)) * dot3(rate, c->n), c->n);
    real size = sqrt(dot3(rate, rate)), limit = c->value[ROLLING_FRICTION] * c->radius_eff * out->bearing;
    real ii = R(0.4) * c->mass_i * c->radius_i * c->radius_i, jj = R(0.4) * c->mass_j * c->radius_j * c->radius_j;
    real stop = c->dt > R(0.0) ? ii * jj / (ii + jj) * size / c->dt : R(0.0);
    limit = limit < stop ? limit : stop;
    out->turning = no_spring(true);
    out->rolling = scale(size > R(0.0) ? -limit / (size > R(0.0) ? size : R(1.0)) : R(0.0), rate);
}

INLINE real rolling_energy(const contact *c, const rolling_state *s, real normal)
{
    (void)c;
    (void)normal;
    (void)s;
    return R(0.0);
}

INLINE mode rolling_mode(const contact *c)
{
    (void)c;
    mode m = {R(0.0), R(0.0)};
    return m;
}
