/* cohesion: Derjaguin, Muller and Toporov 1975; the contact pulls with 2 pi w r* while the two touch, whatever the overlap: N = [Hertz]_+ - 2 pi w r*.
 * Reads COHESION_PULL = 2 pi w (N/m). Writes the normal force. */
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
    return c->overlap > R(0.0) ? c->value[COHESION_PULL] * c->radius_eff : R(0.0);
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
    return -cohesion_pull(c) * c->overlap;
}
