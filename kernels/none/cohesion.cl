/* cohesion: none. */
#define COHESION_PAIR_FIELDS(READ, WRITE)
#define COHESION_LOAD(launch, k, s) (s).unused = 0
#define COHESION_STORE(launch, k, s)

typedef struct cohesion_state {
    int unused;
} cohesion_state;

INLINE void cohesion_force(const contact *c, cohesion_state *s, response *out)
{
    (void)c;
    (void)s;
    (void)out;
}

INLINE real cohesion_energy(const contact *c, const cohesion_state *s)
{
    (void)c;
    (void)s;
    return R(0.0);
}

INLINE cohesion_state cohesion_expected(const contact *c)
{
    cohesion_state s = {0};
    (void)c;
    return s;
}

INLINE void cohesion_mode(const contact *c, const cohesion_state *s, mode *normal)
{
    (void)c;
    (void)s;
    (void)normal;
}
