/* heat tally: what each grain has gained by each path so far, J. */
#define HEAT_TALLY_PARTICLE_FIELDS(READ, WRITE) WRITE(exact, heat_tally)
#define HEAT_TALLY_ADD(i, h) heat_tally_add(heat_tally + CLAST_TALLIES * (size_t)(i), h)
#define HEAT_TALLY_OF(i, q) precise_load(heat_tally[CLAST_TALLIES * (size_t)(i) + (q)])
/* A step of several stages adds up in `kept` until it is accepted: six numbers a grain. */
#define HEAT_TALLY_KEEP(kept, i, h, weight, first) heat_tally_keep(kept + 6 * (size_t)(i), h, weight, first)
#define HEAT_TALLY_KEPT(kept, i, h) heat_tally_kept(kept + 6 * (size_t)(i), h)

INLINE void heat_tally_more(__global exact *tally, real heat)
{
    *tally = precise_store(precise_add(precise_load(*tally), precise_from(heat)));
}

INLINE void heat_tally_add(__global exact *tally, const grain_heat *h)
{
    heat_tally_more(tally + CLAST_TALLY_SOURCES, h->sources);
    heat_tally_more(tally + CLAST_TALLY_CONVECTION, h->convection);
    heat_tally_more(tally + CLAST_TALLY_RADIATION, h->radiation);
    heat_tally_more(tally + CLAST_TALLY_WALLS, h->walls);
    heat_tally_more(tally + CLAST_TALLY_ABSORBED, h->absorbed);
    heat_tally_more(tally + CLAST_TALLY_DISSIPATION, h->rubbed);
}

INLINE void heat_tally_keep(__global real *kept, const grain_heat *h, real weight, bool first)
{
    const real flow[6] = {h->contacts, h->walls, h->sources, h->convection, h->radiation, h->absorbed};
    for (int q = 0; q < 6; q++)
        kept[q] = (first ? R(0.0) : kept[q]) + weight * flow[q];
}

INLINE void heat_tally_kept(__global const real *kept, grain_heat *h)
{
    h->contacts = kept[0];
    h->walls = kept[1];
    h->sources = kept[2];
    h->convection = kept[3];
    h->radiation = kept[4];
    h->absorbed = kept[5];
    h->rubbed = R(0.0); /* nothing moves */
}
