/* conductivity: depends on the temperature of the grain, by a table; a wall's mirror image has that of its grain. Reads CONDUCTIVITY_TABLE = k or its
 * table, CONDUCTIVITY_MOST = the largest; writes resistivity, the factor largest k/k(T), where the temperature is written. */
#ifndef CONDUCTIVITY_TABLE
#define CONDUCTIVITY_TABLE 0
#define CONDUCTIVITY_MOST 0
#endif
#define CONDUCTIVITY_PAIR_FIELDS(READ, WRITE) READ(real, resistivity)
#define CONDUCTIVITY_PARTICLE_FIELDS(READ, WRITE) WRITE(real, resistivity)
#define RESISTIVITY_OF(i) resistivity[i]
#define RESISTIVITY_STORE(i, g, t) resistivity[i] = resistivity_at(g, rounded(t))

INLINE real resistivity_at(const grain *g, real temperature)
{
    real k = tabled_at(g->tables, g->value[CONDUCTIVITY_TABLE], temperature), least = R(1e-20) * g->value[CONDUCTIVITY_MOST];
    return g->value[CONDUCTIVITY_MOST] > R(0.0) ? g->value[CONDUCTIVITY_MOST] / (k > least ? k : least) : R(1.0);
}

INLINE real conductivity_shared(const contact *c, real share)
{
    return R(1.0) / (share * c->resists_i + (R(1.0) - share) * c->resists_j);
}
