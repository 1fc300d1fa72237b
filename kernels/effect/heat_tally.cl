/* heat tally: what each grain has gained by each path so far, J. */
#define HEAT_TALLY_PARTICLE_FIELDS(READ, WRITE) WRITE(exact, heat_tally)
#define HEAT_TALLY_ADD(i, h) heat_tally_add(heat_tally + CLAST_TALLIES * (size_t)(i), h)
#define HEAT_TALLY_OF(i, q) precise_load(heat_tally[CLAST_TALLIES * (size_t)(i) + (q)])

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
}
