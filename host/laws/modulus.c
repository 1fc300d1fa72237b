/* Moduli that depend on temperature. */
#include "../property.h"
#include "../scene.h"
#include "fields.h"
#include "laws.h"

#include <math.h>

const property property_softening_temperature = {"softening_temperature_k", 0, 1e6, true, NAN, NULL, "temperature T* above which the material softens"};
const property property_softening_rate = {"softening_rate", 0, 1e6, false, 1.0, NULL, "rate beta of exponential softening, E = E0 exp(beta (1 - T/T*))"};
const property property_modulus_floor = {"modulus_floor_pa", 0, 1e15, false, 0.0, NULL, "Young's modulus below which the material does not soften"};

const field field_modulus_factor = {"modulus_factor", PER_PARTICLE, FIELD_REAL, 1, FIELD_STATE, "", "Young's modulus at the grain's temperature over that given"};
static const field field_softened = {"softened", PER_RECORD, FIELD_REAL, 1, FIELD_HISTORY, "", "factor of the normal stiffness in the last step"};

/* Share of body a in the compliance of a contact: of E*, or of G* as printed (mindlin 0) or after Mindlin (1). */
static double share(const contact_class *class, double (*weight)(double nu))
{
    const int body[2] = {class->material_a, class->material_b};
    double compliance[2] = {0.0, 0.0};
    for (int k = 0; k < 2; k++)
        if (body[k] >= 0)
            compliance[k] = weight(material_value(class, body[k], &property_poissons_ratio)) / material_value(class, body[k], &property_youngs_modulus);
    return compliance[0] / (compliance[0] + compliance[1]);
}

static double plane_strain(double nu)
{
    return 1.0 - nu * nu;
}

static double shear_printed(double nu)
{
    return 1.0 + nu;
}

static double shear_mindlin(double nu)
{
    return (2.0 - nu) * (1.0 + nu);
}

static void derive_shares(const contact_class *class, const double *option, double *parameter)
{
    const effect *friction = scene_effect(class->scene, -1, SLOT_TANGENTIAL);
    bool mindlin = friction && friction->law == &law_mindlin && friction->option[0] == 1.0;
    (void)option;
    parameter[0] = share(class, plane_strain);
    parameter[1] = share(class, mindlin ? shear_mindlin : shear_printed);
    parameter[2] = share(class, shear_printed);
    parameter[3] = 1.0;
}

static void derive_exponential(const scene *scene, int stage, int material, const double *option, double *parameter)
{
    (void)stage;
    (void)option;
    parameter[0] = scene_material(scene, material, &property_softening_temperature);
    parameter[1] = scene_material(scene, material, &property_softening_rate);
    parameter[2] = scene_material(scene, material, &property_modulus_floor) / scene_material(scene, material, &property_youngs_modulus);
}

const law law_exponential_softening = {
    .name = "exponential_softening",
    .slot = SLOT_MODULUS,
    .doc = "Young's modulus falls exponentially with the grain's temperature; Poisson's ratio stays, so friction and rolling soften too.",
    .source = "TM Eq. 42 with floor and rate (docs/theory.md)",
    .kernel_file = "effect/modulus_pair.cl",
    .more_files = {"effect/modulus_exponential.cl"},
    .material_needs = {&property_youngs_modulus, &property_poissons_ratio, &property_softening_temperature},
    .pair_fields = {&field_modulus_factor},
    .particle_fields = {&field_modulus_factor},
    .parameters = {"MODULUS_SHARE_NORMAL", "MODULUS_SHARE_TANGENTIAL", "MODULUS_SHARE_ROLLING", "MODULUS_MOST"},
    .derive = derive_shares,
    .grain_parameters = {"SOFTENING_TEMPERATURE", "SOFTENING_RATE", "SOFTENING_FLOOR"},
    .derive_grain = derive_exponential,
};

static void derive_table(const scene *scene, int stage, int material, const double *option, double *parameter)
{
    (void)stage;
    (void)option;
    parameter[0] = material_constant(scene, material, &property_youngs_modulus);
    parameter[1] = 1.0 / scene_material(scene, material, &property_youngs_modulus);
}

const law law_modulus_table = {
    .name = "table",
    .slot = SLOT_MODULUS,
    .doc = "Young's modulus follows a table against the grain's temperature; Poisson's ratio stays, so friction and rolling follow too.",
    .source = "TM Eq. 42 by a table (docs/theory.md)",
    .kernel_file = "effect/modulus_pair.cl",
    .more_files = {"effect/modulus_tabled.cl"},
    .material_needs = {&property_youngs_modulus, &property_poissons_ratio},
    .pair_fields = {&field_modulus_factor},
    .particle_fields = {&field_modulus_factor},
    .parameters = {"MODULUS_SHARE_NORMAL", "MODULUS_SHARE_TANGENTIAL", "MODULUS_SHARE_ROLLING", "MODULUS_MOST"},
    .derive = derive_shares,
    .grain_parameters = {"MODULUS_TABLE", "MODULUS_INVERSE"},
    .derive_grain = derive_table,
};

const law law_softening_tracked = {
    .name = "tracked",
    .slot = SLOT_SOFTENING,
    .doc = "Work of moduli that change under a contact.",
    .source = "docs/theory.md",
    .kernel_file = "effect/softening_tracked.cl",
    .pair_fields = {&field_softened},
};

double modulus_factor_at(const scene *scene, int material, double temperature)
{
    double p[3];
    if (scene_effect(scene, -1, SLOT_MODULUS)->law == &law_modulus_table) {
        const property_table *table = scene_material_table(scene, material, &property_youngs_modulus);
        return table ? property_table_at(table, temperature) / scene_material(scene, material, &property_youngs_modulus) : 1.0;
    }
    derive_exponential(scene, -1, material, NULL, p);
    return fmax(p[2], fmin(1.0, exp(p[1] * (1.0 - temperature / p[0]))));
}
