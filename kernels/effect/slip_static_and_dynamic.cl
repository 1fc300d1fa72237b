/* slip: static and dynamic friction, TM Eq. 8 with a flag per contact: once it slides, the limit is mu_d N until the trial force falls
 * below it. (Without the flag a contact would stick again after every step of sliding, and average the two coefficients.)
 * Reads FRICTION_STATIC, FRICTION_DYNAMIC; history: sliding. */
#ifndef FRICTION_STATIC
#define FRICTION_STATIC 0
#define FRICTION_DYNAMIC 1
#endif
#define SLIP_PAIR_FIELDS(READ, WRITE) WRITE(real, sliding)
#define SLIP_LOAD(launch, k, s) (s).sliding = sliding[k]
#define SLIP_STORE(launch, k, s) sliding[k] = (s).sliding

typedef struct slip_state {
    real sliding;
} slip_state;

INLINE real slip_limit(const contact *c, real normal, const slip_state *s)
{
    return (s->sliding > R(0.5) ? FRICTION_OF(c, FRICTION_DYNAMIC) : FRICTION_OF(c, FRICTION_STATIC)) * normal;
}

/* 1 where the trial force holds. */
INLINE real slip_factor(const contact *c, real normal, real trial, slip_state *s)
{
    real kinetic = FRICTION_OF(c, FRICTION_DYNAMIC) * normal;
    real limit = s->sliding > R(0.5) ? kinetic : FRICTION_OF(c, FRICTION_STATIC) * normal;
    bool slides = trial > limit;
    s->sliding = slides && c->overlap > R(0.0) ? R(1.0) : R(0.0);
    return slides ? kinetic / trial : R(1.0);
}
