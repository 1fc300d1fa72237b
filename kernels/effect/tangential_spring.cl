/* The stick-slip machinery that the tangential laws share: they define the stiffness of a contact, its reciprocal
 * (0 where the two do not touch) and its damping. */

/* The stored spring turned with the pair: with the normal, and about it with the pair's mean spin. What is left along the normal after a
 * step's turn is of second order and is dropped. (TM; docs/theory.md.) */
INLINE vec3 spring_turn(const contact *c, vec3 spring)
{
    real twist = R(0.5) * dot3(add(c->past_spin_i, c->past_spin_j), c->n);
    vec3 turned = turn_by(spring, scale(c->elapsed, add_scaled(c->turn, twist, c->n)));
    return add_scaled(turned, -dot3(turned, c->n), c->n);
}

/* While the overlap falls, the spring is scaled with the stiffness, so that unloading creates no energy. */
INLINE real spring_unloading(const contact *c)
{
    real before = c->overlap - c->past_approach * c->elapsed;
    bool falls = c->past_approach < R(0.0) && c->overlap > R(0.0);
    return falls ? sqrt(c->overlap / (falls ? before : R(1.0))) : R(1.0);
}

/* Where the contact slides, the spring that gives the force: D = -(f + c u)/k (TM Eq. 13); nothing where the two do not touch. */
INLINE vec3 spring_return(const contact *c, real compliance, real damping, real factor, vec3 trial, vec3 force)
{
    bool slides = factor < R(1.0);
    vec3 returned = scale(-compliance, add_scaled(force, damping, c->slip));
    vec3 spring = v3(slides ? returned.x : trial.x, slides ? returned.y : trial.y, slides ? returned.z : trial.z);
    bool live = compliance > R(0.0);
    return v3(live ? spring.x : R(0.0), live ? spring.y : R(0.0), live ? spring.z : R(0.0));
}

#define TANGENTIAL_PAIR_FIELDS(READ, WRITE) WRITE(real, tangential_spring)
#define TANGENTIAL_ASK_FOR(launch, k) RECORDS_ASK_FOR(launch, tangential_spring, 3, k)
#define TANGENTIAL_LOAD(launch, k, s) (s).spring = LOAD_POLAR3(tangential_spring, (launch)->record_stride, k)
#define TANGENTIAL_STORE(launch, k, s) STORE_POLAR3(tangential_spring, (launch)->record_stride, k, (s).spring)

typedef struct tangential_state {
    vec3 spring;
} tangential_state;

INLINE void tangential_force(const contact *c, slip_state *slip, tangential_state *s, response *out)
{
    real stiffness = TANGENTIAL_STIFFNESS_OF(c), damping = TANGENTIAL_DAMPING_OF(c);
    vec3 before = spring_turn(c, s->spring);
    real shortened = TANGENTIAL_RESCALED ? spring_unloading(c) : R(1.0);
    if (TANGENTIAL_RESCALED)
        before = scale(shortened, before);
    vec3 spring = add_scaled(before, c->elapsed, c->past_slip);
    vec3 trial = add_scaled(scale(-stiffness, spring), -damping, c->slip);
    real factor = slip_factor(c, out->bearing, sqrt(dot3(trial, trial)), slip);
    out->tangential = scale(factor, trial);
    s->spring = spring_return(c, TANGENTIAL_COMPLIANCE_OF(c), damping, factor, spring, out->tangential);
    real limit = slip_limit(c, out->bearing, slip), bound = R(0.5) * TANGENTIAL_COMPLIANCE_OF(c) * limit * limit;
    spring_step step = {stiffness,
                        R(0.5) * stiffness * dot3(before, before),
                        R(0.5) * stiffness * dot3(s->spring, s->spring),
                        R(0.5) * stiffness * dot3(before, s->spring),
                        bound,
                        shortened,
                        factor < R(1.0),
                        scale(-damping, c->slip)};
    out->sliding = step;
}

INLINE real tangential_energy(const contact *c, const slip_state *slip, const tangential_state *s, real normal)
{
    return spring_energy(TANGENTIAL_STIFFNESS_OF(c), TANGENTIAL_COMPLIANCE_OF(c), s->spring, slip_limit(c, normal, slip));
}

INLINE mode tangential_mode(const contact *c)
{
    mode m = {TANGENTIAL_STIFFNESS_OF(c), TANGENTIAL_DAMPING_OF(c)};
    return m;
}
