/* tangential: no friction. */
#define TANGENTIAL_PAIR_FIELDS(READ, WRITE)
#define TANGENTIAL_ASK_FOR(launch, k)
#define TANGENTIAL_LOAD(launch, k, s) (s).unused = 0
#define TANGENTIAL_STORE(launch, k, s)
#ifndef LEVER_ARM_SHRINKS
#define LEVER_ARM_SHRINKS R(1.0)
#endif

typedef struct tangential_state {
    int unused;
} tangential_state;

INLINE void tangential_force(const contact *c, slip_state *slip, tangential_state *s, response *out)
{
    (void)c;
    (void)slip;
    (void)s;
    out->tangential = v3(R(0.0), R(0.0), R(0.0));
    out->sliding = no_spring(false);
}

INLINE real tangential_energy(const contact *c, const slip_state *slip, const tangential_state *s, real normal)
{
    (void)c;
    (void)slip;
    (void)normal;
    (void)s;
    return R(0.0);
}

INLINE mode tangential_mode(const contact *c)
{
    (void)c;
    mode m = {R(0.0), R(0.0)};
    return m;
}
