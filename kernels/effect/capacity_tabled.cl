/* heat capacity: specific heats that depend on temperature. Heat is added up as enthalpy: a gain q raises the temperature by the x for which the
 * integral of m c over x is q, whatever places of the table lie between. Reads SPECIFIC_HEAT = c or its table, SPECIFIC_HEAT_LEAST. */
#ifndef SPECIFIC_HEAT
#define SPECIFIC_HEAT 0
#endif
#ifndef SPECIFIC_HEAT_LEAST
#define SPECIFIC_HEAT_LEAST 0
#endif

INLINE real temperature_capacity(const grain *g)
{
    return g->mass * tabled_at(g->tables, g->value[SPECIFIC_HEAT], g->temperature);
}

INLINE real temperature_capacity_least(const grain *g)
{
    return g->mass * g->value[SPECIFIC_HEAT_LEAST];
}

INLINE real temperature_rise(const grain *g, real gain)
{
    return tabled_inverse(g->tables, g->value[SPECIFIC_HEAT], g->temperature, gain / g->mass);
}

INLINE real temperature_heat(const grain *g, real rise)
{
    return g->mass * tabled_integral(g->tables, g->value[SPECIFIC_HEAT], g->temperature, rise);
}

INLINE real temperature_lift(const grain *g, real rise)
{
    return temperature_heat(g, rise) / temperature_capacity(g);
}

INLINE real temperature_drop(const grain *g, real lift)
{
    return temperature_rise(g, lift * temperature_capacity(g));
}

/* Counted from the first place of the table, at 0 K for a constant: what is above the last place passed is added with all bits. */
INLINE precise temperature_content(const grain *g, precise temperature)
{
    real value = g->value[SPECIFIC_HEAT], t = rounded(temperature);
    __global const real *row = TABLED_ROW(g->tables, value);
    bool tabled = value < R(0.0);
    int p = tabled ? tabled_place(row, t) : 0;
    real from = tabled ? row[p] : R(0.0), c = tabled ? row[TABLED_PLACES + p] : value;
    real slope = tabled && t > from ? row[2 * TABLED_PLACES + p] : R(0.0);
    precise past = precise_sub(temperature, precise_from(from)), sum = precise_from(R(0.0));
    for (int n = 0; n < p; n++) {
        real way = row[n + 1] - row[n];
        sum = precise_add(sum, precise_from(way * (row[TABLED_PLACES + n] + R(0.5) * row[2 * TABLED_PLACES + n] * way)));
    }
    if (tabled)
        sum = precise_add(sum, precise_from(row[TABLED_PLACES] * row[0]));
    sum = precise_add(sum, precise_mul(past, precise_add_scaled(precise_from(c), R(0.5) * slope, past)));
    return precise_mul(precise_from(g->mass), sum);
}
