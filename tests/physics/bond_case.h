/* Pairs of BM 5.1 that adhesion bonds, for its tests: E* 5e8 Pa, r 1 mm, equilibrium overlap 5e-5 m; pairs stand in lanes that do not see each
 * other. */
#ifndef CLAST_TESTS_BOND_CASE_H
#define CLAST_TESTS_BOND_CASE_H
#include "case.h"

static const double young = 1.0e9, radius = 1.0e-3, density = 2000.0, equilibrium = 5.0e-5;
#define MODULUS (0.5 * young) /* E* of two equal spheres, nu 0 */
#define R_PAIR  (0.5 * radius)
#define LANE    0.01

static const double bm_adhesion = 1.05409255e5;

/* Materials a, b, ... of one density each, for scenes of several lanes. */
static inline text head(const char *effects, int materials, const double *densities)
{
    text t = {0};
    put(&t, "effects: [%s]\nmaterials:\n", effects);
    for (int m = 0; m < materials; m++)
        put(&t, "  - {name: m%d, density_kg_m3: %.17g, youngs_modulus_pa: %.17g, poissons_ratio: 0}\n", m, densities ? densities[m] : density, young);
    return t;
}

#define ADHESION      "{slot: normal, law: hertz}, {slot: bond, law: adhesion}"
#define ADHESION_FREE "{slot: normal, law: hertz}, {slot: bond, law: adhesion, clamps: none}"

/* A pair in the lane y of material m, that touches at t = 0 (or overlaps by d) and approaches at v. */
static inline void put_pair(text *t, int m, int lane, double d, double v)
{
    put(t, "  - name: p%d\n    material: m%d\n    generator: list\n    items:\n", lane, m);
    put_grain(t, radius, (double[]){-radius + 0.5 * d, LANE * lane, 0}, (double[]){0.5 * v, 0, 0}, (double[]){0, 0, 0});
    put_grain(t, radius, (double[]){radius - 0.5 * d, LANE * lane, 0}, (double[]){-0.5 * v, 0, 0}, (double[]){0, 0, 0});
}

static inline double overlap_of(physics_case *c, int pair)
{
    double *x = case_field(c, "position");
    double d = 2.0 * radius - hypot(x[6 * pair + 3] - x[6 * pair], x[6 * pair + 4] - x[6 * pair + 1]);
    free(x);
    return d;
}

static inline bond_sums bonds_of(physics_case *c)
{
    bond_sums sums;
    MUST(bonds_count(c->sim, &sums, why));
    return sums;
}

#endif
