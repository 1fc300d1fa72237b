/* rolling: no rolling resistance. */
#define ROLLING_PAIR_FIELDS(READ, WRITE)
#define ROLLING_ASK_FOR(launch, k)
#define ROLLING_LOAD(launch, k, s) (s).unused = 0
#define ROLLING_STORE(launch, k, s)

typedef struct rolling_state {
    int unused;
} rolling_state;

INLINE void rolling_moment(const contact *c, rolling_state *s, response *out)
{
    (void)c;
    (void)s;
    out->rolling = v3(R(0.0), R(0.0), R(0.0));
    out->turning = no_spring(false);
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
