#include "../property.h"
#include "laws.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const field field_rolling_spring = {
    "rolling_spring", PER_RECORD, FIELD_REAL, 3, FIELD_HISTORY, "rad", "rolling spring of a contact, in the frame of its owner"};

enum { ROLLING_TWIST, ROLLING_SHEAR_MODULUS };

static void twist_constant(double choice, char *text, size_t size)
{
    size_t used = strlen(text);
    snprintf(text + used, size - used, "#define ROLLING_TWIST %s\n", choice == 0.0 ? "R(1.0)" : "R(0.0)");
}

static void derive_elastic_plastic(const contact_class *class, const double *option, double *parameter)
{
    double shear = effective_shear_modulus(class, option[ROLLING_SHEAR_MODULUS] == 1.0);
    if (interaction_value(class, &property_rolling_friction) == 0.0)
        shear = 0.0; /* a spring that never bears anything must not limit the step */
    parameter[0] = 8.0 * shear;
    parameter[1] = 2.0 * rolling_damping_ratio(class) * sqrt(8.0 * shear);
    parameter[2] = interaction_value(class, &property_rolling_friction);
    parameter[3] = shear > 0.0 ? 1.0 / (8.0 * shear) : 0.0;
}

static void elastic_plastic_constants(const double *option, char *text, size_t size)
{
    twist_constant(option[ROLLING_TWIST], text, size);
}

const law law_elastic_plastic = {
    .name = "elastic_plastic",
    .slot = SLOT_ROLLING,
    .doc = "Rolling resistance: a rotational spring and damper that yields at mu_r r* N.",
    .source = "TM Eq. 15-20 as settled in docs/theory.md",
    .kernel_file = "effect/rolling_elastic_plastic.cl",
    .options = {{"twist", "kept|left_out", 0, 0, 0, "whether relative spin about the normal counts"},
                {"shear_modulus", "printed|mindlin", 0, 0, 0, "G* as TM Eq. 9 prints it, or 1/G* = sum (2 - nu)/G"}},
    .material_needs = {&property_youngs_modulus, &property_poissons_ratio},
    .interaction_needs = {&property_rolling_friction},
    .pair_fields = {&field_rolling_spring},
    .parameters = {"ROLLING_MODULUS", "ROLLING_DAMPING", "ROLLING_FRICTION", "ROLLING_COMPLIANCE"},
    .derive = derive_elastic_plastic,
    .constants = elastic_plastic_constants,
};

static void derive_constant_torque(const contact_class *class, const double *option, double *parameter)
{
    (void)option;
    parameter[0] = interaction_value(class, &property_rolling_friction);
}

const law law_constant_torque = {
    .name = "constant_torque",
    .slot = SLOT_ROLLING,
    .doc = "Rolling resistance: a torque mu_r r* N against the relative spin; needs no history.",
    .source = "directional constant torque (Zhou et al. 1999)",
    .kernel_file = "effect/rolling_constant_torque.cl",
    .options = {{"twist", "kept|left_out", 0, 0, 0, "whether relative spin about the normal counts"}},
    .interaction_needs = {&property_rolling_friction},
    .parameters = {"ROLLING_FRICTION"},
    .derive = derive_constant_torque,
    .constants = elastic_plastic_constants,
};
