/* Radii that follow the temperature. */
#include "../property.h"
#include "../scene.h"
#include "fields.h"
#include "laws.h"

#include <math.h>

const property property_expansion = {"expansion_1_k", -0.1, 0.1, false, NAN, NULL, "coefficient of linear thermal expansion alpha, r = r_ref (1 + alpha (T - T_ref))"};
const property property_reference_temperature = {"reference_temperature_k", 0, 1e6, false, 300, NULL,
                                                 "temperature T_ref at which the particles have the radius and the density given"};

const field field_reference_radius = {"reference_radius", PER_PARTICLE, FIELD_EXACT, 1, FIELD_STATE, "m", "radius at the reference temperature"};
const field field_built_radius = {"built_radius", PER_PARTICLE, FIELD_EXACT, 1, FIELD_RESULT, "m", "radius when the contact table was built"};
static const field field_growth = {"growth", PER_PARTICLE, FIELD_REAL, 1, FIELD_STATE, "m", "growth of the radius in the last step"};
static const field field_pushed = {"pushed", PER_RECORD, FIELD_REAL, 1, FIELD_HISTORY, "N", "force of the normal spring in the last step"};
static const field field_expansion_work = {"expansion_work", PER_RECORD, FIELD_REAL, 1, FIELD_RESULT, "J", "work of the growth of the two grains in this step"};

static void derive_expansion(const scene *scene, int stage, int material, const double *option, double *parameter)
{
    (void)stage;
    (void)option;
    parameter[0] = scene_material(scene, material, &property_expansion);
    parameter[1] = scene_material(scene, material, &property_reference_temperature);
}

const law law_linear_expansion = {
    .name = "linear_expansion",
    .slot = SLOT_RADIUS,
    .doc = "Radii grow in proportion to the temperature; mass and angular momentum stay.",
    .source = "HC Eq. 8",
    .kernel_file = "effect/radius_linear_expansion.cl",
    .material_needs = {&property_expansion},
    .particle_fields = {&field_reference_radius, &field_built_radius},
    .grain_parameters = {"EXPANSION", "EXPANSION_FROM"},
    .derive_grain = derive_expansion,
};

const law law_expansion_tracked = {
    .name = "tracked",
    .slot = SLOT_EXPANSION,
    .doc = "Work of grains that grow in contact.",
    .source = "docs/theory.md",
    .kernel_file = "effect/expansion_tracked.cl",
    .pair_fields = {&field_growth, &field_pushed, &field_expansion_work},
    .particle_fields = {&field_growth, &field_expansion_work},
};

double expansion_factor(const scene *scene, int material, double temperature)
{
    double p[2];
    if (!scene_effect(scene, -1, SLOT_RADIUS))
        return 1.0;
    derive_expansion(scene, -1, material, NULL, p);
    if (scene->precision == PRECISION_MIXED)
        return 1.0 + (double)(float)p[0] * (temperature - (double)(float)p[1]); /* as the device has them */
    return 1.0 + p[0] * (temperature - p[1]);
}
