/* modulus: a table of Young's modulus against temperature. Reads MODULUS_TABLE = E or its table, MODULUS_INVERSE = 1/the largest E. */
#ifndef MODULUS_TABLE
#define MODULUS_TABLE 0
#define MODULUS_INVERSE 1
#endif

INLINE real modulus_at(const grain *g, real temperature)
{
    return tabled_at(g->tables, g->value[MODULUS_TABLE], temperature) * g->value[MODULUS_INVERSE];
}
