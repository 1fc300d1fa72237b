/* slip: one friction coefficient. slip_factor gives |f|/|f_trial| (TM Eq. 8 with mu_s = mu_d, as a radial return).
 * Reads FRICTION_STATIC. */
#ifndef FRICTION_STATIC
#define FRICTION_STATIC 0
#endif
#define SLIP_PAIR_FIELDS(READ, WRITE)
#define SLIP_LOAD(launch, k, s) (s).sliding = R(0.0)
#define SLIP_STORE(launch, k, s)

typedef struct slip_state {
    real sliding;
} slip_state;

INLINE real slip_limit(const contact *c, real normal, const slip_state *s)
{
    (void)s;
    return FRICTION_OF(c, FRICTION_STATIC) * normal;
}

/* 1 where the trial force holds. */
INLINE real slip_factor(const contact *c, real normal, real trial, slip_state *s)
{
    (void)s;
    real limit = FRICTION_OF(c, FRICTION_STATIC) * normal;
    return trial > limit ? limit / trial : R(1.0);
}
