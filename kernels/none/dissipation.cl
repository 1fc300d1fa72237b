/* dissipation: nobody asks what contacts dissipate. */
#define DISSIPATION_PAIR_FIELDS(READ, WRITE)
#define DISSIPATION_PARTICLE_FIELDS(READ, WRITE)
#define DISSIPATION_AHEAD(i) v3(R(0.0), R(0.0), R(0.0))
#define DISSIPATION_AHEAD_SPIN(i) v3(R(0.0), R(0.0), R(0.0))
#define DISSIPATION_KEEP(i, step)
#define DISSIPATION_LOAD(launch, k, s) (s).unused = 0
#define DISSIPATION_STORE(launch, k, s)

typedef struct dissipation_state {
    int unused;
} dissipation_state;

INLINE dissipation dissipation_of(const contact *c, const response *out, dissipation_state *s)
{
    dissipation none = {R(0.0), R(0.0), R(0.0), R(0.0)};
    (void)c;
    (void)out;
    (void)s;
    return none;
}
