#include "numbers.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static uint64_t bits(uint64_t *state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

double uniform(uint64_t *state, double low, double high)
{
    return low + (high - low) * (double)(bits(state) >> 11) * 0x1p-53;
}

double decades(uint64_t *state, double low, double high)
{
    return pow(10.0, uniform(state, low, high));
}

bool chance(uint64_t *state, double share)
{
    return uniform(state, 0.0, 1.0) < share;
}

int below(uint64_t *state, int count)
{
    return (int)(bits(state) % (uint64_t)count);
}

/* ---- values ---- */

/* Decades (or, where `even`, the range itself) that numbers are drawn from. A property that is not here follows its own default and range. */
static const struct {
    const char *key;
    double low, high;
    bool even;
} ranges[] = {
    {"density_kg_m3", 2.5, 4.0, false},
    {"youngs_modulus_pa", 6.0, 11.0, false},
    {"poissons_ratio", 0.0, 0.49, true},
    {"conductivity_w_mk", -2.0, 2.5, false},
    {"specific_heat_j_kgk", 0.0, 3.0, false},
    {"film_thickness_m", -8.0, -5.0, false},
    {"real_modulus_pa", 10.0, 11.5, false},
    {"heat_generation_w_m3", 2.0, 7.0, false},
    {"softening_temperature_k", 200, 600, true},
    {"softening_rate", 0.0, 5.0, true},
    {"modulus_floor_pa", 4.0, 6.0, false},
    {"restitution", 0.05, 1.0, true},
    {"normal_damping_ratio", 0.0, 1.5, true},
    {"friction_static", 0.0, 1.5, true},
    {"friction_dynamic", 0.0, 1.0, true},
    {"rolling_friction", 0.0, 0.5, true},
    {"normal_stiffness_n_m", 2.0, 6.0, false},
    {"tangential_stiffness_n_m", 2.0, 5.0, false},
    {"repulsion_stiffness", 7.0, 9.0, false},
    {"repulsion_exponent", 1.0, 2.0, true},
    {"bond_stiffness", 1.0, 4.0, false},
    {"bond_equilibrium_overlap_m", -8, -5.5, 0},
    {"bond_normalised_stiffness_n", -1, 1, 0},
    {"bond_equilibrium_strain", -4, -2, 0},
    {"bond_exponent", 0.5, 1.2, true},
    {"bond_threshold", 250, 450, true},
    {"bond_tensile_strength_pa", 4.0, 7.0, false},
    {"bond_shear_strength_pa", 4.0, 7.0, false},
    {"bond_youngs_modulus_pa", 6.0, 9.0, false},
    {"bond_shear_modulus_pa", 6.0, 9.0, false},
    {"bond_radius_ratio", 0.1, 1.0, true},
    {"bond_gap_ratio", -6.0, -1.5, false},
    {"work_of_adhesion_j_m2", -4.0, -0.5, false},
    {"expansion_1_k", -6.0, -4.0, false},
    {"reference_temperature_k", 200, 400, true},
    {"bond_damping_ratio", 0.0, 1.5, true},
    {"surface_energy_j_m2", -1.0, 0.5, false},
    {"boundary_diffusion_m3_s", -26.0, -18.0, false},
    {"atomic_volume_m3", -29.5, -28.0, false},
    {"activation_energy_j_mol", 2.0, 5.3, false},
    {"tangential_damping_ratio", 0, 1.5, true},
    {"rolling_damping_ratio", 0, 1.5, true},
};

double draw(const char *key, double low, double high, double fallback, uint64_t *state)
{
    for (size_t k = 0; k < sizeof ranges / sizeof *ranges; k++)
        if (strcmp(ranges[k].key, key) == 0)
            return ranges[k].even ? uniform(state, ranges[k].low, ranges[k].high) : decades(state, ranges[k].low, ranges[k].high);
    if (low >= 0.0 && high <= 1.0)
        return uniform(state, low, high);
    double value = isfinite(fallback) && fallback != 0.0 ? fallback * decades(state, -1.0, 1.0) : decades(state, -1.0, 2.0);
    return fmin(high, fmax(low, value));
}

/* Properties of which a pair gives only one, and some that it may do without: whether they are there changes the program. */
static bool left_out(const char *key, uint64_t *state, const char *bond, const char *damping)
{
    static const char *const bonds[] = {"bond_stiffness", "bond_equilibrium_overlap_m", "bond_normalised_stiffness_n",
                                        "bond_equilibrium_strain"};
    for (int k = 0; k < 4; k++)
        if (strcmp(key, bonds[k]) == 0)
            return strcmp(key, bond) != 0;
    if (strcmp(key, "restitution") == 0 || strcmp(key, "normal_damping_ratio") == 0)
        return strcmp(key, damping) != 0;
    if (strstr(key, "strength") || strstr(key, "film") || strcmp(key, "friction_dynamic") == 0 || strstr(key, "_damping_ratio"))
        return chance(state, 0.5);
    return false;
}

/* Where the key allows tables and the scene has temperatures, one property in four is a table; Young's modulus is one where its law asks. */
static bool tabled(const property *p, bool warm, bool modulus, uint64_t *shape)
{
    if (!property_is_tabled(p) || !warm)
        return false;
    return strcmp(p->key, "youngs_modulus_pa") == 0 ? modulus : chance(shape, 0.25);
}

void put_properties(char *text, size_t size, const property *const *list, bool warm, bool modulus, uint64_t *shape, uint64_t *state)
{
    static const char *const bonds[] = {"bond_stiffness", "bond_equilibrium_overlap_m", "bond_normalised_stiffness_n",
                                        "bond_equilibrium_strain"};
    const char *bond = bonds[below(state, 4)], *damping = chance(state, 0.5) ? "restitution" : "normal_damping_ratio";
    for (; *list; list++) {
        const property *p = *list;
        size_t used = strlen(text);
        bool table = tabled(p, warm, modulus, shape);
        if (left_out(p->key, shape, bond, damping) && !table)
            continue;
        double value = draw(p->key, p->low, p->high, p->fallback, state);
        if (table)
            snprintf(text + used, size - used, ", %s: {temperature_k: [%.6g, %.6g], value: [%.6g, %.6g]}", p->key, uniform(state, 100, 400),
                     uniform(state, 401, 900), value, value * uniform(state, 0.2, 1.0));
        else
            snprintf(text + used, size - used, ", %s: %.6g", p->key, value);
    }
}
