/* The stick-slip machinery that the tangential laws share: they define TANGENTIAL_STIFFNESS_OF and TANGENTIAL_DAMPING_OF. */

/* The stored spring in the current tangent plane, turned about the normal with the pair's mean spin, its length kept (TM, settled in
 * docs/theory.md). A spring along the normal has no direction left and is dropped. */
INLINE vec3 spring_turn(const contact *c, vec3 spring)
{
    real before = dot3(spring, spring);
    vec3 flat = add_scaled(spring, -dot3(spring, c->n), c->n);
    real twist = R(0.5) * c->dt * dot3(add(c->spin_i, c->spin_j), c->n);
    flat = add_scaled(flat, twist, cross3(c->n, flat));
    real after = dot3(flat, flat);
    bool kept = after > R(1e-24) * before;
    return scale(kept ? sqrt(before / (kept ? after : R(1.0))) : R(0.0), flat);
}

/* While the overlap falls, the spring is scaled with the stiffness, so that unloading creates no energy. */
INLINE real spring_unloading(const contact *c)
{
    real before = c->overlap - c->approach * c->dt;
    bool falls = c->approach < R(0.0) && c->overlap > R(0.0);
    return falls ? sqrt(c->overlap / (falls ? before : R(1.0))) : R(1.0);
}

/* Where the contact slides, the spring that gives the force: D = -(f + c u)/k (TM Eq. 13); nothing where the two do not touch. */
INLINE vec3 spring_return(const contact *c, real stiffness, real damping, real factor, vec3 trial, vec3 force)
{
    bool slides = factor < R(1.0), stiff = stiffness > R(0.0);
    real inverse = R(-1.0) / (stiff ? stiffness : R(1.0));
    vec3 returned = scale(inverse, add_scaled(force, damping, c->slip));
    vec3 spring = v3(slides ? returned.x : trial.x, slides ? returned.y : trial.y, slides ? returned.z : trial.z);
    bool live = stiff && c->overlap > R(0.0);
    return v3(live ? spring.x : R(0.0), live ? spring.y : R(0.0), live ? spring.z : R(0.0));
}

#define TANGENTIAL_PAIR_FIELDS(READ, WRITE) WRITE(real, tangential_spring)
#define TANGENTIAL_LOAD(launch, k, s) (s).spring = LOAD3(tangential_spring, (launch)->record_stride, k)
#define TANGENTIAL_STORE(launch, k, s) STORE3(tangential_spring, (launch)->record_stride, k, (s).spring)

typedef struct tangential_state {
    vec3 spring;
} tangential_state;

INLINE void tangential_force(const contact *c, slip_state *slip, tangential_state *s, response *out)
{
    real stiffness = TANGENTIAL_STIFFNESS_OF(c), damping = TANGENTIAL_DAMPING_OF(c);
    vec3 spring = spring_turn(c, s->spring);
    if (TANGENTIAL_RESCALED)
        spring = scale(spring_unloading(c), spring);
    spring = add_scaled(spring, c->dt, c->slip);
    vec3 trial = add_scaled(scale(-stiffness, spring), -damping, c->slip);
    real factor = slip_factor(c, out->normal, sqrt(dot3(trial, trial)), slip);
    out->tangential = scale(factor, trial);
    s->spring = spring_return(c, stiffness, damping, factor, spring, out->tangential);
}

INLINE real tangential_energy(const contact *c, const tangential_state *s)
{
    return R(0.5) * TANGENTIAL_STIFFNESS_OF(c) * dot3(s->spring, s->spring);
}

INLINE mode tangential_mode(const contact *c)
{
    mode m = {TANGENTIAL_STIFFNESS_OF(c), TANGENTIAL_DAMPING_OF(c)};
    return m;
}
