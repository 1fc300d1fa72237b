/* heat generation: q a volume, as by an electric current. Reads HEAT_GENERATION = q 4 pi/3, W/m3. */
#ifndef HEAT_GENERATION
#define HEAT_GENERATION 0
#endif

/* W */
INLINE real generation_heat(const grain *g)
{
    return g->value[HEAT_GENERATION] * g->radius * g->radius * g->radius;
}
