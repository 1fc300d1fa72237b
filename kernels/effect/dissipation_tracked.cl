/* dissipation: what the forces of a contact take out of the motion in a step, the clamp included, and no spring stores: all of the energy that a
 * collision loses and no more (docs/theory.md, "The energy ledger"). History: energy and stiffness of the two springs after the last step. */
#define DISSIPATION_PAIR_FIELDS(READ, WRITE)                                            \
    DISSIPATION_AHEAD_PAIR_FIELDS(READ, WRITE) WRITE(real, tangential_stored) WRITE(real, tangential_stiffness) WRITE(real, rolling_stored) WRITE(real, rolling_stiffness)
#define DISSIPATION_LOAD(launch, k, s)                    \
    do {                                                  \
        (s).tangential = tangential_stored[k];            \
        (s).tangential_at = tangential_stiffness[k];      \
        (s).rolling = rolling_stored[k];                  \
        (s).rolling_at = rolling_stiffness[k];            \
    } while (0)
#define DISSIPATION_STORE(launch, k, s)                   \
    do {                                                  \
        tangential_stored[k] = (s).tangential;            \
        tangential_stiffness[k] = (s).tangential_at;      \
        rolling_stored[k] = (s).rolling;                  \
        rolling_stiffness[k] = (s).rolling_at;            \
    } while (0)

typedef struct dissipation_state {
    real tangential, tangential_at, rolling, rolling_at;
} dissipation_state;

/* The velocities at the time of the forces. */
typedef struct acting_rates {
    real approach;
    vec3 slip, turning;
} acting_rates;

INLINE acting_rates dissipation_rates(const contact *c)
{
    acting_rates r;
    real gain = dot3(c->ahead, c->n);
    vec3 levers = add_scaled(scale(c->arm_i, c->ahead_spin_i), c->arm_j, c->ahead_spin_j);
    r.approach = c->approach + gain;
    r.slip = add(c->slip, add(add_scaled(c->ahead, -gain, c->n), cross3(levers, c->n)));
    r.turning = add(sub(c->spin_i, c->spin_j), sub(c->ahead_spin_i, c->ahead_spin_j));
    return r;
}

/* What spring, damper and slider lose. `stored` was held at the stiffness `at`: all of the spring's energy, or what the slider would have let it
 * give back. While the contact sticks the change of stiffness since does work on the stretch, *work: what the spring gains beyond the mean of its
 * forces before and after times its stretching, which is the change of stiffness times half the product of the two stretches. While it slides, the
 * slider sets the stretch, and what the spring loses is lost. */
INLINE real dissipation_spring(const spring_step *step, real stored, real at, vec3 force, vec3 rate, real dt, real *work)
{
    bool slides = step->slides || !(step->stiffness > R(0.0));
    real kept = step->rescaled, softer = at / (slides ? R(1.0) : step->stiffness * kept); /* the stiffness before over that of now */
    real held = step->before * softer / kept, stiffened = step->between * (R(1.0) - softer) - held * (R(1.0) - kept);
    real after = step->after < step->limit ? step->after : step->limit;
    real counted = stiffened * (stored < held ? stored / held : R(1.0));
    real sliding = -dt * dot3(force, rate) - (after - stored);
    real sticking = -dt * dot3(step->damper, rate) + (step->after - after) - (held - stored) - (stiffened - counted);
    *work = slides ? R(0.0) : counted;
    return slides ? sliding : sticking;
}

INLINE dissipation dissipation_of(const contact *c, const response *out, dissipation_state *s)
{
    acting_rates rate = dissipation_rates(c);
    dissipation lost;
    real sliding, turning;
    lost.normal = c->span * (out->normal - out->spring) * rate.approach;
    lost.tangential = dissipation_spring(&out->sliding, s->tangential, s->tangential_at, out->tangential, rate.slip, c->span, &sliding);
    lost.rolling = dissipation_spring(&out->turning, s->rolling, s->rolling_at, out->rolling, rate.turning, c->span, &turning);
    lost.stiffness = sliding + turning;
    s->tangential = out->sliding.after < out->sliding.limit ? out->sliding.after : out->sliding.limit;
    s->tangential_at = out->sliding.stiffness;
    s->rolling = out->turning.after < out->turning.limit ? out->turning.after : out->turning.limit;
    s->rolling_at = out->turning.stiffness;
    return lost;
}
