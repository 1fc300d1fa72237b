/* Cohesion that is a pull by the overlap alone, without history: the law gives cohesion_pull (N) and COHESION_WORK. */
#define COHESION_PAIR_FIELDS(READ, WRITE)
#define COHESION_LOAD(launch, k, s) (s).unused = 0
#define COHESION_STORE(launch, k, s)

typedef struct cohesion_state {
    int unused;
} cohesion_state;

INLINE void cohesion_force(const contact *c, cohesion_state *s, response *out)
{
    (void)s;
    out->spring -= cohesion_pull(c);
    out->normal -= cohesion_pull(c);
}

INLINE real cohesion_energy(const contact *c, const cohesion_state *s)
{
    (void)s;
    return -COHESION_WORK * cohesion_pull(c) * c->overlap;
}

INLINE cohesion_state cohesion_expected(const contact *c)
{
    cohesion_state s = {0};
    (void)c;
    return s;
}

/* The stiffness of the contact bounds that with the pull from above. */
INLINE void cohesion_mode(const contact *c, const cohesion_state *s, mode *normal)
{
    (void)c;
    (void)s;
    (void)normal;
}
