/* heat tally: what each grain has gained by each path so far, J. */
#define HEAT_TALLY_PARTICLE_FIELDS(READ, WRITE) WRITE(real, heat_tally)
#define HEAT_TALLY_ADD(i, h) heat_tally_add(heat_tally + CLAST_TALLIES * (size_t)(i), h)
#define HEAT_TALLY_OF(i, q) heat_tally[CLAST_TALLIES * (size_t)(i) + (q)]

INLINE void heat_tally_add(__global real *tally, const grain_heat *h)
{
    tally[CLAST_TALLY_SOURCES] += h->sources;
    tally[CLAST_TALLY_CONVECTION] += h->convection;
    tally[CLAST_TALLY_RADIATION] += h->radiation;
    tally[CLAST_TALLY_WALLS] += h->walls;
}
