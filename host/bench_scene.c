#include "bench_scene.h"

#include "property.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Fixed, so that all laws see the same records: an automatic one would go on adapting while they are measured. */
#define SKIN_M 5.0e-5

const bench_setting bench_settings[] = {
    {.name = "static and dynamic friction", .interactions = ", friction_dynamic: 0.4"},
    {.name = "two materials", .second_material = true},
    {.name = "velocity Verlet", .lines = "integrator: velocity_verlet\n"},
    {.name = "orientations", .lines = "output: {fields: [orientation]}\n"},
    {.name = "ledger of energies", .lines = "output: {observables: [dissipated_normal]}\n"},
    {.name = "mixed precision", .mixed = true},
    {0},
};

/* Values that suit the bed, which stays at rest under them; what is not here takes its default, or 1 where it has none. */
static const struct {
    const char *key;
    double value;
} values[] = {
    {"density_kg_m3", 2500},
    {"youngs_modulus_pa", 5.0e6},
    {"real_modulus_pa", 5.0e9},
    {"poissons_ratio", 0.3},
    {"conductivity_w_mk", 1},
    {"specific_heat_j_kgk", 800},
    {"emissivity", 0.9},
    {"absorptance", 0.9},
    {"heat_generation_w_m3", 1.0e3},
    {"softening_temperature_k", 400},
    {"expansion_1_k", 1.0e-5},
    {"reference_temperature_k", 300},
    {"viscosity_pa_s", 1.8e-5},
    {"restitution", 0.5},
    {"friction_static", 0.5},
    {"rolling_friction", 0.01},
    {"normal_stiffness_n_m", 500},
    {"tangential_stiffness_n_m", 250},
    {"repulsion_stiffness", 1.0e5},
    {"work_of_adhesion_j_m2", 1.0e-4},
    {"bond_equilibrium_strain", 1.0e-4},
    {"bond_youngs_modulus_pa", 1.0e5},
    /* options of laws */
    {"coefficient_w_m2k", 50},
    {"coefficient", 0.1},
    {"diameter_m", 0.02},
    {"attenuation_1_m", 2000},
    {"depth_max_m", 1.0e-3},
};

static double value_of(const char *key, double low, double high, double fallback)
{
    for (size_t n = 0; n < sizeof values / sizeof *values; n++)
        if (strcmp(values[n].key, key) == 0)
            return values[n].value;
    return isnan(fallback) ? fmin(fmax(1.0, low), high) : fallback;
}

/* What bonds need is not among their descriptors' needs: each law takes one of several keys. */
static const char bond_keys[] = ", bond_equilibrium_strain: 1.0e-4, bond_youngs_modulus_pa: 1.0e5";

static bool named_before(const property *const *const *lists, int list, int n)
{
    for (int l = 0; l <= list; l++)
        for (int p = 0; p < LAW_PROPERTIES_MAX && lists[l][p] && (l < list || p < n); p++)
            if (lists[l][p] == lists[list][n])
                return true;
    return false;
}

/* "key: value, ..." for what the laws need, each once. */
static void print_needs(FILE *out, const property *const *const *lists, int count)
{
    for (int l = 0; l < count; l++)
        for (int p = 0; p < LAW_PROPERTIES_MAX && lists[l][p]; p++) {
            const property *need = lists[l][p];
            if (!named_before(lists, l, p) && !(isnan(need->fallback) && need->fallback_property))
                fprintf(out, "%s%s: %.15g", l + p > 0 ? ", " : "", need->key, value_of(need->key, need->low, need->high, need->fallback));
        }
}

static void print_law(FILE *out, const law *l)
{
    fprintf(out, "  - {slot: %s, law: %s", slot_name(l->slot), l->name);
    for (int o = 0; o < LAW_OPTIONS_MAX && l->options[o].key; o++) {
        const law_option *option = &l->options[o];
        if (!option->choices)
            fprintf(out, ", %s: %.15g", option->key, value_of(option->key, option->low, option->high, option->fallback));
    }
    if (l->slot == SLOT_SOURCE)
        fprintf(out, ", name: beam, direction: [0, 0, -1], path: {time_s: [0], position_m: [[0.01, 0.01, 0]], power_w: [1]}");
    fprintf(out, "}\n");
}

static bool fills(const law *const *live, int count, slot_id slot)
{
    for (int l = 0; l < count; l++)
        if (live[l]->slot == slot)
            return true;
    return false;
}

static void print_environment(FILE *out, const law *const *live, int count)
{
    const property *const *gas[BENCH_LAWS_MAX];
    int gases = 0;
    for (int l = 0; l < count; l++)
        if (live[l]->gas_needs[0])
            gas[gases++] = live[l]->gas_needs;
    if (gases == 0 && !fills(live, count, SLOT_CONVECTION) && !fills(live, count, SLOT_RADIATION))
        return;
    fprintf(out, "environment: {temperature_k: 300");
    if (gases > 0) {
        fprintf(out, ", gas: {");
        print_needs(out, gas, gases);
        fprintf(out, "}");
    }
    fprintf(out, "}\n");
}

static void print_materials(FILE *out, const law *const *live, int count, const bench_setting *setting)
{
    static const property *const own_material[LAW_PROPERTIES_MAX] = {&property_density, &property_specific_heat};
    static const property *const own_interaction[LAW_PROPERTIES_MAX] = {&property_restitution};
    const property *const *material[BENCH_LAWS_MAX + 1] = {own_material}, *const * interaction[BENCH_LAWS_MAX + 1] = {own_interaction};
    for (int l = 0; l < count; l++) {
        material[l + 1] = live[l]->material_needs;
        interaction[l + 1] = live[l]->interaction_needs;
    }
    fprintf(out, "materials:\n");
    for (int m = 0; m < (setting && setting->second_material ? 2 : 1); m++) {
        fprintf(out, "  - {name: %s, ", m == 0 ? "glass" : "other");
        print_needs(out, material, count + 1);
        fprintf(out, "}\n");
    }
    fprintf(out, "interactions:\n  - {between: default, ");
    print_needs(out, interaction, count + 1);
    fprintf(out, "%s%s}\n", fills(live, count, SLOT_BOND) ? bond_keys : "", setting && setting->interactions ? setting->interactions : "");
}

static void print_scene(FILE *out, const settled_bed *of, const law *const *live, int count, const bench_setting *setting, bool mixed)
{
    double side = of->side_m;
    fprintf(out, "title: Settled bed\ngravity_m_s2: [0, 0, -9.81]\nprecision: %s\n%s",
            mixed || (setting && setting->mixed) ? "mixed" : "double", setting && setting->lines ? setting->lines : "");
    fprintf(out, count > 0 ? "effects:\n" : "effects: []\n");
    for (int l = 0; l < count; l++)
        print_law(out, live[l]);
    print_environment(out, live, count);
    print_materials(out, live, count, setting);
    fprintf(out, "particles:\n  - {name: bed, material: glass, generator: random, count: %lld, radius_m: 1.0e-3, temperature_k: 300,\n",
            (long long)of->bed.count);
    fprintf(out, "     region: {low_m: [0, 0, 0], high_m: [%.17g, %.17g, 1]}}\nwalls:\n", side, side);
    fprintf(out, "  - {name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}\n  - {name: west, shape: plane, point_m: [0, 0, "
                 "0], normal: [1, 0, 0]}\n"
                 "  - {name: south, shape: plane, point_m: [0, 0, 0], normal: [0, 1, 0]}\n");
    fprintf(out, "  - {name: east, shape: plane, point_m: [%.17g, 0, 0], normal: [-1, 0, 0]}\n", side);
    fprintf(out, "  - {name: north, shape: plane, point_m: [0, %.17g, 0], normal: [0, -1, 0]}\n", side);
    fprintf(out, "contact_table: {skin_m: %g, step_form: two_kernels}\nstages: [{name: rest, until: {steps: 1}}]\n", SKIN_M);
}

char *bench_scene_text(const settled_bed *of, const law *const *live, int count, const bench_setting *setting, bool mixed)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream)
        return NULL;
    print_scene(stream, of, live, count, setting, mixed);
    fclose(stream);
    return text;
}

status bench_scene_make(const settled_bed *of, const law *const *live, int count, const bench_setting *setting, bool mixed, scene **out,
                        failure *why)
{
    char *text = bench_scene_text(of, live, count, setting, mixed);
    if (!text)
        return fail(why, STATUS_ERROR, "out of memory");
    status result = scene_read_text(text, "settled bed", 0, NULL, out, why);
    free(text);
    return result;
}

int bench_stack(const law **out, int max)
{
    static const slot_id first[] = {SLOT_NORMAL, SLOT_TANGENTIAL, SLOT_ROLLING, SLOT_CONDUCTION, SLOT_CONVECTION, SLOT_RADIATION};
    const int early = sizeof first / sizeof *first;
    int count = 0;
    for (int n = 0; n < early + SLOT_COUNT; n++) {
        slot_id slot = n < early ? first[n] : (slot_id)(n - early);
        if (fills(out, count, slot))
            continue;
        for (const law *const *l = laws; *l && count < max; l++)
            if ((*l)->slot == slot) {
                out[count++] = *l;
                break;
            }
    }
    return count;
}
