/* heat capacity: a constant specific heat. Reads SPECIFIC_HEAT = c. */
#ifndef SPECIFIC_HEAT
#define SPECIFIC_HEAT 0
#endif

/* At the grain's temperature, J/K. */
INLINE real temperature_capacity(const grain *g)
{
    return g->mass * g->value[SPECIFIC_HEAT];
}

/* The smallest at any temperature. */
INLINE real temperature_capacity_least(const grain *g)
{
    return temperature_capacity(g);
}

/* What a gain of heat raises the grain's temperature by, K. */
INLINE real temperature_rise(const grain *g, real gain)
{
    return gain / temperature_capacity(g);
}

/* The heat that a rise takes, J. */
INLINE real temperature_heat(const grain *g, real rise)
{
    return temperature_capacity(g) * rise;
}

/* The same over the capacity at the grain's temperature: a rise as heat measures it; and back. */
INLINE real temperature_lift(const grain *g, real rise)
{
    (void)g;
    return rise;
}

INLINE real temperature_drop(const grain *g, real lift)
{
    (void)g;
    return lift;
}

/* Heat content at a temperature, J. */
INLINE precise temperature_content(const grain *g, precise temperature)
{
    return precise_add_scaled(precise_from(R(0.0)), temperature_capacity(g), temperature);
}
