#include "../property.h"
#include "../scene.h"
#include "fields.h"
#include "laws.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* No value of a criterion reaches it: such a pair does not bond. */
#define NEVER 1e30

repulsion repulsion_of(const contact_class *class)
{
    const effect *normal = scene_effect(class->scene, -1, SLOT_NORMAL);
    const char *name = normal ? normal->law->name : "";
    if (!strcmp(name, "hertz"))
        return (repulsion){4.0 / 3.0 * effective_modulus(class), 0.5, 1.5};
    if (!strcmp(name, "linear"))
        return (repulsion){interaction_value(class, &property_normal_stiffness), 0.0, 1.0};
    if (!strcmp(name, "power"))
        return (repulsion){interaction_value(class, &property_repulsion_stiffness), 0.0, interaction_value(class, &property_repulsion_exponent)};
    return (repulsion){0.0, 0.0, 0.0};
}

/* BM Eq. 8 solved for the adhesion, k = k2 d_eq^(a2 - a), and Eq. 18 and 19 with strains: all of the form K r*^p. */
adhesion adhesion_of(const contact_class *class)
{
    repulsion push = repulsion_of(class);
    double a = interaction_value(class, &property_bond_exponent), apart = push.exponent - a;
    double stiffness = interaction_value(class, &property_bond_stiffness), overlap = interaction_value(class, &property_bond_equilibrium_overlap);
    double normalised = interaction_value(class, &property_bond_normalised_stiffness);
    double strain = interaction_value(class, &property_bond_equilibrium_strain), xi = interaction_value(class, &property_bond_damping);
    adhesion pull = {0.0, 0.0, a, isnan(xi) ? 0.0 : xi};
    if (!isnan(stiffness))
        pull.coefficient = stiffness;
    else if (!isnan(overlap))
        pull = (adhesion){push.coefficient * pow(overlap, apart), push.radius_power, a, pull.damping_ratio};
    else if (!isnan(normalised))
        pull = (adhesion){normalised, -a, a, pull.damping_ratio};
    else if (!isnan(strain))
        pull = (adhesion){push.coefficient * pow(strain, apart), push.radius_power + apart, a, pull.damping_ratio};
    return pull;
}

/* ---- when contacts bond ---- */

bool pair_bonds(const contact_class *class)
{
    const effect *bond = scene_effect(class->scene, -1, SLOT_BOND);
    if (bond && (bond->law == &law_parallel || bond->law == &law_sintering))
        return interaction_value(class, &property_bond_youngs_modulus) > 0.0;
    return adhesion_of(class).coefficient > 0.0;
}

static void derive_bonding(const contact_class *class, const double *option, double *parameter)
{
    (void)option;
    parameter[0] = pair_bonds(class) ? 0.5 : NEVER;
}

static void derive_bonding_threshold(const contact_class *class, const double *option, double *parameter)
{
    (void)option;
    double threshold = interaction_value(class, &property_bond_threshold);
    parameter[0] = pair_bonds(class) && !isnan(threshold) ? threshold : NEVER;
}

const law law_bonding_always = {
    .name = "always",
    .slot = SLOT_BONDING,
    .doc = "Every contact may bond.",
    .source = "BM Eq. 25",
    .kernel_file = "effect/bonding_always.cl",
    .parameters = {"BONDING_THRESHOLD"},
    .derive = derive_bonding,
};

const law law_bonding_at_time = {
    .name = "at_time",
    .slot = SLOT_BONDING,
    .doc = "The contacts of one moment bond, and no others.",
    .source = "",
    .kernel_file = "effect/bonding_at_time.cl",
    .parameters = {"BONDING_THRESHOLD"},
    .derive = derive_bonding,
};

const law law_bonding_scalar = {
    .name = "scalar_above",
    .slot = SLOT_BONDING,
    .doc = "Contacts bond while the scalar of both grains is above a threshold.",
    .source = "BM sec. 3 (a concentration)",
    .kernel_file = "effect/bonding_scalar.cl",
    .pair_fields = {&field_scalar},
    .parameters = {"BONDING_THRESHOLD"},
    .derive = derive_bonding_threshold,
};

static void temperature_constants(const double *option, char *text, size_t size)
{
    size_t used = strlen(text);
    snprintf(text + used, size - used, "#define BONDING_TEMPERATURE %d\n", (int)option[BOND_CRITERION] - BOND_BOTH_ABOVE);
}

const law law_bonding_temperature = {
    .name = "temperature_above",
    .slot = SLOT_BONDING,
    .doc = "Contacts bond while the temperatures of their bodies are above a threshold: both, their mean, or the higher one.",
    .source = "BM sec. 3",
    .kernel_file = "effect/bonding_temperature.cl",
    .parameters = {"BONDING_THRESHOLD"},
    .derive = derive_bonding_threshold,
    .constants = temperature_constants,
    .reads_temperature = true,
};

bool bonding_reads_temperature(const law *bond, const double *option)
{
    return bond && (bond->reads_temperature || (int)option[BOND_CRITERION] >= BOND_BOTH_ABOVE);
}

const law *bonding_of(const law *bond, const double *option)
{
    static const law *const all[] = {&law_bonding_always, &law_bonding_at_time, &law_bonding_scalar, &law_bonding_temperature, &law_bonding_temperature,
                                     &law_bonding_temperature};
    return bond ? all[(int)option[BOND_CRITERION]] : NULL;
}

#define BOND_OPTIONS                                                                                                                             \
    {"criterion", "always|at_time|scalar_above|both_above|mean_above|hottest_above", 0, 0, 0,                                                                                         \
     "when a contact bonds: whenever it can; at `time_s` alone; or while something is above `bond_threshold`: the `scalar` of both grains, "      \
     "both temperatures, their mean, or the higher one"},                                                                                         \
        {"time_s", NULL, 0, 1e30, 0, "the moment of `at_time`: the first step that starts then or later"}

/* ---- adhesion ---- */

enum { ADHESION_CLAMPS = BOND_OWN, ADHESION_FOLLOWS, ADHESION_MELTS };

static void derive_adhesion(const contact_class *class, const double *option, double *parameter)
{
    (void)option;
    adhesion pull = adhesion_of(class);
    parameter[0] = pull.coefficient;
    parameter[1] = pull.radius_power;
    parameter[2] = pull.exponent;
    parameter[3] = 2.0 * pull.damping_ratio;
    parameter[4] = fmin(M_PI * interaction_value(class, &property_bond_tensile_strength), 1e30);
    parameter[5] = fmin(M_PI * interaction_value(class, &property_bond_shear_strength), 1e15); /* its square stays a number in float */
    repulsion push = repulsion_of(class);
    double apart = push.exponent - pull.exponent;
    parameter[6] = pow(pull.exponent * pull.coefficient / (push.exponent * push.coefficient), 1.0 / apart); /* d_crit = this r*^next */
    parameter[7] = (pull.radius_power - push.radius_power) / apart;
    parameter[8] = -1.0 / apart;
    parameter[9] = pull.exponent / push.exponent;
    parameter[10] = pow(push.exponent / pull.exponent, 1.0 / apart);
}

static void adhesion_constants(const double *option, char *text, size_t size)
{
    size_t used = strlen(text);
    snprintf(text + used, size - used, "#define ADHESION_CLAMPS %d\n", option[ADHESION_CLAMPS] == 0.0);
    used = strlen(text);
    snprintf(text + used, size - used, "#define ADHESION_FOLLOWS %d\n", option[ADHESION_FOLLOWS] == 0.0);
    used = strlen(text);
    snprintf(text + used, size - used, "#define ADHESION_MELTS %d\n", option[ADHESION_MELTS] != 0.0);
}

static bool adhesion_keeps_bonds(const double *option)
{
    return option[ADHESION_MELTS] != 0.0;
}

/* Exponents of all contacts that bond, in quarters, where they are whole numbers and the same; false where they are not. */
static bool shared_quarters(const struct scene *scene, int *exponent, int *radius)
{
    int found = 0;
    for (int s = 0; scene->material && s < scene->stage_count; s++)
        for (int a = 0; a < scene->material_count; a++)
            for (int p = 0; p < scene->material_count + scene->wall_count; p++) {
                bool wall = p >= scene->material_count;
                adhesion pull = adhesion_of(&(contact_class){scene, s, a, wall ? -1 : p, wall ? p - scene->material_count : -1});
                double n = 4.0 * pull.exponent, m = 4.0 * pull.radius_power;
                if (pull.coefficient == 0.0)
                    continue;
                if (fabs(n - round(n)) > 1e-12 || fabs(m - round(m)) > 1e-12 || n > 31.0 || fabs(m) > 31.0)
                    return false;
                if (found++ > 0 && ((int)round(n) != *exponent || (int)round(m) != *radius))
                    return false;
                *exponent = (int)round(n);
                *radius = (int)round(m);
            }
    return found > 0;
}

/* Some contact that bonds has a strength, in some stage. */
static bool any_strength(const struct scene *scene)
{
    for (int s = 0; scene->material && s < scene->stage_count; s++)
        for (int a = 0; a < scene->material_count; a++)
            for (int p = 0; p < scene->material_count + scene->wall_count; p++) {
                bool wall = p >= scene->material_count;
                contact_class class = {scene, s, a, wall ? -1 : p, wall ? p - scene->material_count : -1};
                if (adhesion_of(&class).coefficient > 0.0 && (interaction_value(&class, &property_bond_tensile_strength) < 1e30 ||
                                                              interaction_value(&class, &property_bond_shear_strength) < 1e30))
                    return true;
            }
    return false;
}

static void adhesion_scene_constants(const struct scene *scene, char *text, size_t size)
{
    int exponent = 4, radius = 0;
    size_t used = strlen(text);
    bool shared = shared_quarters(scene, &exponent, &radius);
    snprintf(text + used, size - used, "#define ADHESION_SHARED %d\n#define ADHESION_QUARTERS %d\n#define ADHESION_RADIUS_QUARTERS (%d)\n", shared,
             exponent, radius);
    used = strlen(text);
    snprintf(text + used, size - used, "#define ADHESION_TEARS %d\n", any_strength(scene));
}

const law law_adhesion = {
    .name = "adhesion",
    .slot = SLOT_BOND,
    .doc = "Attraction k d^a against the repulsion of the normal law once a contact is deep enough, damped about its equilibrium.",
    .source = "BM Eq. 7 to 26 as settled in docs/theory.md",
    .kernel_file = "effect/bond_adhesion.cl",
    .options = {BOND_OPTIONS,
                {"clamps", "printed|none", 0, 0, 0,
                 "as printed, no net pull beyond the equilibrium overlap and no net push short of it, or spring and damper as they add up"},
                {"adhesion_follows_modulus", "true|false", 0, 0, 0,
                 "where moduli soften, adhesion softens with E*, so that the equilibrium overlap stays; or it is constant"},
                {"while_met", "solid|liquid", 0, 0, 0,
                 "what a bond is while its criterion is met: as later, when it ends at the critical overlap, or at a strength; or liquid (strengths do "
                 "not count), and once the criterion is no longer met solid for good: then it does not end at the critical overlap, but resists any "
                 "pull with the stiffness that it has at rest, and only a strength, over the area of the neck at rest, ends it"}},
    .pair_fields = {&field_bonded},
    .parameters = {"ADHESION_STIFFNESS", "ADHESION_RADIUS_POWER", "ADHESION_EXPONENT", "ADHESION_DAMPING", "ADHESION_TENSILE", "ADHESION_SHEAR",
                   "ADHESION_CRITICAL", "ADHESION_CRITICAL_POWER", "ADHESION_CRITICAL_MODULUS", "ADHESION_SHARE", "ADHESION_REST"},
    .derive = derive_adhesion,
    .constants = adhesion_constants,
    .scene_constants = adhesion_scene_constants,
    .keeps_bonds = adhesion_keeps_bonds,
};

/* ---- parallel ---- */

static const field field_bond_gap = {"bond_gap", PER_RECORD, FIELD_REAL, 1, FIELD_HISTORY, "m", "gap between the surfaces when the bond was made"};
static const field field_bond_shear = {"bond_shear", PER_RECORD, FIELD_REAL, 3, FIELD_HISTORY, "m", "displacement across the bond, in the frame of its owner"};
static const field field_bond_turn = {"bond_turn", PER_RECORD, FIELD_REAL, 3, FIELD_HISTORY, "rad", "turn across the bond, in the frame of its owner"};

static void derive_parallel(const contact_class *class, const double *option, double *parameter)
{
    (void)option;
    double young = interaction_value(class, &property_bond_youngs_modulus), shear = interaction_value(class, &property_bond_shear_modulus);
    double xi = interaction_value(class, &property_bond_damping);
    parameter[0] = young;
    parameter[1] = isnan(shear) ? 0.4 * young : shear;
    parameter[2] = interaction_value(class, &property_bond_radius_ratio);
    parameter[3] = isnan(xi) ? 0.0 : 2.0 * xi;
    parameter[4] = interaction_value(class, &property_bond_tensile_strength);
    parameter[5] = interaction_value(class, &property_bond_shear_strength);
    parameter[6] = interaction_value(class, &property_bond_gap_ratio);
    parameter[7] = young > 0.0 ? sqrt(parameter[1] / young) : 0.0;
}

/* The options a bond law has by itself stand behind those of all. */
static void parallel_constants(const double *option, char *text, size_t size)
{
    size_t used = strlen(text);
    snprintf(text + used, size - used, "#define PARALLEL_LIQUID %d\n", option[BOND_OWN] != 0.0);
}

static double parallel_reach(const contact_class *class, double radius)
{
    return pair_bonds(class) ? interaction_value(class, &property_bond_gap_ratio) * radius : 0.0;
}

static bool beams_keep_bonds(const double *option)
{
    (void)option;
    return true;
}

const law law_parallel = {
    .name = "parallel",
    .slot = SLOT_BOND,
    .doc = "A beam of cement beside the contact, which stretches, shears, bends and twists, and breaks at its tensile or shear strength; it holds at "
           "any distance. A pair bonds where `bond_youngs_modulus_pa` is above 0.",
    .source = "Potyondy and Cundall 2004, with dampers",
    .kernel_file = "effect/bond_parallel.cl",
    .more_files = {"effect/bond_beam.cl"},
    .options = {BOND_OPTIONS,
                {"while_met", "solid|liquid", 0, 0, 0,
                 "what a bond is while its criterion is met: as solid as ever, or liquid (it carries nothing, and sets for good, at rest where it then "
                 "is, once the criterion is no longer met, as a molten neck that has cooled)"}},
    .pair_fields = {&field_bonded, &field_bond_gap, &field_bond_shear, &field_bond_turn},
    .parameters = {"PARALLEL_YOUNG", "PARALLEL_SHEAR", "PARALLEL_RADIUS", "PARALLEL_DAMPING", "PARALLEL_TENSILE", "PARALLEL_SHEAR_STRENGTH",
                   "PARALLEL_GAP", "PARALLEL_ROOT"},
    .derive = derive_parallel,
    .constants = parallel_constants,
    .reach = parallel_reach,
    .keeps_bonds = beams_keep_bonds,
    .turns = true,
};

/* ---- sintering ---- */

#define BOLTZMANN 1.380649e-23 /* J/K */
#define GAS       8.31446261815324 /* J/(mol K) */

static const field field_neck_growth = {"neck_growth", PER_RECORD, FIELD_REAL, 1, FIELD_HISTORY, "", "sixth power of the neck's radius over 2 r*"};
static const field field_neck_growth_low = {"neck_growth_low", PER_RECORD, FIELD_REAL, 1, FIELD_HISTORY, "", "what rounding leaves of it"};

static void derive_sintering(const contact_class *class, const double *option, double *parameter)
{
    (void)option;
    double young = interaction_value(class, &property_bond_youngs_modulus), shear = interaction_value(class, &property_bond_shear_modulus);
    double xi = interaction_value(class, &property_bond_damping), tension = interaction_value(class, &property_surface_energy);
    double mobility = interaction_value(class, &property_atomic_volume) * interaction_value(class, &property_boundary_diffusion) / BOLTZMANN;
    parameter[0] = young;
    parameter[1] = isnan(shear) ? 0.4 * young : shear;
    parameter[2] = isnan(xi) ? 0.0 : 2.0 * xi;
    parameter[3] = interaction_value(class, &property_bond_tensile_strength);
    parameter[4] = interaction_value(class, &property_bond_shear_strength);
    parameter[5] = young > 0.0 ? sqrt(parameter[1] / young) : 0.0;
    parameter[6] = 3.375 * tension * mobility;
    parameter[7] = interaction_value(class, &property_sintering_activation) / GAS;
    parameter[8] = 2.25 * M_PI * tension;
    parameter[9] = interaction_value(class, &property_neck_ratio_least);
    parameter[10] = interaction_value(class, &property_neck_ratio_most);
    parameter[11] = interaction_value(class, &property_bond_gap_ratio);
}

const law law_sintering = {
    .name = "sintering",
    .slot = SLOT_BOND,
    .doc = "A neck that grows between hot grains by diffusion along their boundary, a^6 in proportion to time, draws them together, conducts, and carries "
           "tension, shear, bending and torsion up to its strength. A pair bonds where `bond_youngs_modulus_pa` is above 0.",
    .source = "Bouvier and McMeeking 1996, Parhami and McMeeking 1998; neck of Coble 1958",
    .kernel_file = "effect/bond_sintering.cl",
    .more_files = {"effect/bond_beam.cl"},
    .options = {BOND_OPTIONS},
    .interaction_needs = {&property_surface_energy, &property_boundary_diffusion, &property_atomic_volume, &property_sintering_activation},
    .pair_fields = {&field_bonded, &field_bond_gap, &field_bond_shear, &field_bond_turn, &field_neck_growth, &field_neck_growth_low},
    .parameters = {"SINTER_YOUNG", "SINTER_SHEAR", "SINTER_DAMPING", "SINTER_TENSILE", "SINTER_SHEAR_STRENGTH", "SINTER_ROOT", "SINTER_RATE",
                   "SINTER_ACTIVATION", "SINTER_PULL", "SINTER_LEAST", "SINTER_MOST", "SINTER_GAP"},
    .derive = derive_sintering,
    .reach = parallel_reach,
    .keeps_bonds = beams_keep_bonds,
    .turns = true,
    .reads_temperature = true,
};
