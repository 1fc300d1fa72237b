/* temperature: grains have none, and nothing is heated. */
#define TEMPERATURE_PAIR_FIELDS(READ, WRITE)
#define TEMPERATURE_PARTICLE_FIELDS(READ, WRITE)
#define TEMPERATURE_OF_BODY(i) R(0.0)
#define TEMPERATURE_ROWS 0
#define TEMPERATURE_ROWS_FILL(i, to)
#define TEMPERATURE_OF_ROWS(rows, n, lane) R(0.0)
#define TEMPERATURE_ASK_FOR(i)
#define TEMPERATURE_OF_GRAIN(i) R(0.0)
#define TEMPERATURE_PRECISE(i) precise_from(R(0.0))
#define TEMPERATURE_CONSTANTS(row) ((__global const real *)0)
#define TEMPERATURE_STORE(i, t) (void)(t)

INLINE real temperature_capacity(const grain *g)
{
    (void)g;
    return R(1.0);
}

INLINE real temperature_capacity_least(const grain *g)
{
    return temperature_capacity(g);
}

INLINE real temperature_rise(const grain *g, real gain)
{
    (void)g;
    return gain;
}

INLINE real temperature_heat(const grain *g, real rise)
{
    (void)g;
    return rise;
}

INLINE precise temperature_after(precise temperature, real rise)
{
    (void)rise;
    return temperature;
}
