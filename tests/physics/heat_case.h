/* Grains that do not move and exchange heat: what the tests of heat share. */
#ifndef CLAST_TESTS_HEAT_CASE_H
#define CLAST_TESTS_HEAT_CASE_H
#include "case.h"

#define STEFAN 5.670367e-8

typedef struct hot_grain {
    const char *material;
    double radius, x, temperature;
} hot_grain;

/* Grains in a row along x. No law of force: they stay. `more` ends with a line feed. */
static inline physics_case row_open(const char *effects, const char *materials, const char *more, const hot_grain *grains, int count)
{
    text t = {0};
    put(&t, "effects:\n%s\nmaterials:\n%s\n%sparticles:\n", effects, materials, more);
    for (int k = 0; k < count; k++)
        put(&t,
            "  - {name: g%d, material: %s, generator: list, temperature_k: %.17g, items: [{position_m: [%.17g, 0, 0], radius_m: %.17g}]}\n", k,
            grains[k].material, grains[k].temperature, grains[k].x, grains[k].radius);
    return case_open(&t);
}

static inline double temperature_of(physics_case *c, int grain)
{
    return case_get(c, "temperature", grain, 0);
}

static inline heat_sums case_heat(physics_case *c)
{
    heat_sums sums;
    MUST(heat_observe(c->sim, &sums, why));
    return sums;
}

/* Heat of the contact between two grains, or of a grain and a wall (j = -1 - wall), into i, W. */
static inline double flow_of(physics_case *c, int i, int j)
{
    int64_t count;
    live_contact *live = case_contacts(c, &count);
    double flow = NAN;
    for (int64_t k = 0; k < count; k++)
        if (live[k].i == i && (j < 0 ? live[k].wall == -1 - j : live[k].j == j))
            flow = live[k].heat;
    free(live);
    return flow;
}

/* TM Eqs. 33-35 as printed, W/K. */
static inline double overlap_conductance(double ri, double rj, double overlap, double ki, double kj)
{
    double distance = ri + rj - overlap, length = 0.5 * (distance - (rj * rj - ri * ri) / distance);
    return (ri + rj) / (ri / ki + rj / kj) * PI * (ri * ri - length * length) / distance;
}

#endif
