/* Properties that depend on temperature. */
#include "../property.h"
#include "../scene.h"
#include "fields.h"
#include "laws.h"

#include <math.h>

const field field_property_tables = {"property_tables", PER_SCENE, FIELD_REAL, 1, FIELD_RESULT, "", "properties against temperature, a row a table"};
const field field_resistivity = {"resistivity", PER_PARTICLE, FIELD_REAL, 1, FIELD_STATE, "", "largest conductivity of the material over that at the grain's temperature"};

/* clang-format off */
#define TABLES                                                                       \
    .slot = SLOT_TABLES,                                                             \
    .doc = "Properties by temperature, from tables.",                                \
    .source = "docs/theory.md",                                                      \
    .kernel_file = "effect/tables.cl"
/* clang-format on */

const law law_tables_of_pairs = {
    .name = "of contacts",
    TABLES,
    .more_files = {"effect/tables_pairs.cl", "none/tables_grains.cl"},
    .pair_fields = {&field_property_tables},
};

const law law_tables_of_grains = {
    .name = "of grains",
    TABLES,
    .more_files = {"none/tables_pairs.cl", "effect/tables_grains.cl"},
    .particle_fields = {&field_property_tables},
};

const law law_tables_of_both = {
    .name = "of contacts and grains",
    TABLES,
    .more_files = {"effect/tables_pairs.cl", "effect/tables_grains.cl"},
    .pair_fields = {&field_property_tables},
    .particle_fields = {&field_property_tables},
};

double material_constant(const scene *scene, int material, const property *property)
{
    const property_table *table = scene_material_table(scene, material, property);
    return table ? scene_table_constant(scene, table) : scene_material(scene, material, property);
}

static void derive_conductivity(const scene *scene, int stage, int material, const double *option, double *parameter)
{
    (void)stage;
    (void)option;
    parameter[0] = material_constant(scene, material, &property_conductivity);
    parameter[1] = scene_material(scene, material, &property_conductivity);
}

const law law_conductivity_tabled = {
    .name = "tables",
    .slot = SLOT_CONDUCTIVITY,
    .doc = "Conductivities that depend on the grain's temperature.",
    .source = "docs/theory.md",
    .kernel_file = "effect/conductivity_tabled.cl",
    .pair_fields = {&field_resistivity},
    .particle_fields = {&field_resistivity},
    .grain_parameters = {"CONDUCTIVITY_TABLE", "CONDUCTIVITY_MOST"},
    .derive_grain = derive_conductivity,
};

double resistivity_at(const scene *scene, int material, double temperature)
{
    const property_table *table = scene_material_table(scene, material, &property_conductivity);
    double most = scene_material(scene, material, &property_conductivity);
    return table && most > 0.0 ? most / fmax(property_table_at(table, temperature), 1e-20 * most) : 1.0;
}

double specific_heat_at(const scene *scene, int material, double temperature)
{
    const property_table *table = scene_material_table(scene, material, &property_specific_heat);
    return table ? property_table_at(table, temperature) : scene_material(scene, material, &property_specific_heat);
}

/* Linear between the places: the trapezoidal rule from place to place is exact. */
double specific_heat_between(const scene *scene, int material, double from, double to)
{
    const property_table *table = scene_material_table(scene, material, &property_specific_heat);
    double low = fmin(from, to), high = fmax(from, to), sum = 0.0, at = low;
    for (int p = 0; p <= (table ? table->count : 0); p++) {
        double next = table && p < table->count ? fmin(fmax(table->temperature_k[p], low), high) : high;
        sum += 0.5 * (next - at) * (specific_heat_at(scene, material, at) + specific_heat_at(scene, material, next));
        at = next;
    }
    return to < from ? -sum : sum;
}

const law law_friction_tabled = {
    .name = "tables",
    .slot = SLOT_FRICTION,
    .doc = "Friction coefficients that depend on the mean temperature of the two bodies.",
    .source = "docs/theory.md",
    .kernel_file = "effect/friction_tabled.cl",
    .reads_temperature = true,
};
