/* cohesion: simplified JKR; the adhesive term of JKR with Hertz's contact radius, N = [Hertz]_+ - sqrt(8 pi w E*) (r* d)^(3/4) while the two touch.
 * No hysteresis; the largest pull is 3/2 pi w r*, as for JKR. Reads COHESION_PULL = sqrt(8 pi w E*). Writes the normal force. */
#ifndef COHESION_PULL
#define COHESION_PULL 0
#endif
#define COHESION_PAIR_FIELDS(READ, WRITE)
#define COHESION_LOAD(launch, k, s) (s).unused = 0
#define COHESION_STORE(launch, k, s)

typedef struct cohesion_state {
    int unused;
} cohesion_state;

INLINE real cohesion_pull(const contact *c)
{
    return modulus_root(modulus_normal(c)) * c->value[COHESION_PULL] * c->contact_radius * sqrt(c->contact_radius);
}

INLINE void cohesion_force(const contact *c, cohesion_state *s, response *out)
{
    (void)s;
    out->spring -= cohesion_pull(c);
    out->normal -= cohesion_pull(c);
}

INLINE real cohesion_energy(const contact *c, const cohesion_state *s)
{
    (void)s;
    return R(-0.57142857142857143) * cohesion_pull(c) * c->overlap;
}
