#include "../property.h"
#include "laws.h"

#include <math.h>

static const field field_neck = {"neck", PER_RECORD, FIELD_REAL, 1, FIELD_HISTORY, "", "1 while a cohesive contact holds, across a gap too"};

static double work_of_adhesion(const contact_class *class)
{
    return interaction_value(class, &property_work_of_adhesion);
}

static void derive_dmt(const contact_class *class, const double *option, double *parameter)
{
    (void)option;
    parameter[0] = 2.0 * M_PI * work_of_adhesion(class);
}

static void derive_sjkr(const contact_class *class, const double *option, double *parameter)
{
    (void)option;
    parameter[0] = sqrt(8.0 * M_PI * work_of_adhesion(class) * effective_modulus(class));
}

static void derive_jkr(const contact_class *class, const double *option, double *parameter)
{
    (void)option;
    parameter[0] = effective_modulus(class);
    parameter[1] = cbrt(M_PI * work_of_adhesion(class) / (8.0 * parameter[0]));
}

/* The gap at which the contact lets go, 3 a_c^2/r*, which grows with r*: at a wall r* is the radius. */
static double jkr_reach(const contact_class *class, double radius)
{
    double critical = cbrt(M_PI * work_of_adhesion(class) * radius * radius / (8.0 * effective_modulus(class)));
    return 3.0 * critical * critical / radius;
}

const law law_jkr = {
    .name = "jkr",
    .slot = SLOT_COHESION,
    .doc = "Cohesion of fine, soft powders: contact over a neck that holds across a gap; contacts stick at touch and let go later. Needs `hertz`.",
    .source = "Johnson, Kendall and Roberts 1971",
    .kernel_file = "effect/cohesion_jkr.cl",
    .material_needs = {&property_youngs_modulus, &property_poissons_ratio},
    .interaction_needs = {&property_work_of_adhesion},
    .pair_fields = {&field_neck},
    .parameters = {"JKR_MODULUS", "JKR_LENGTH"},
    .derive = derive_jkr,
    .reach = jkr_reach,
};

const law law_dmt = {
    .name = "dmt",
    .slot = SLOT_COHESION,
    .doc = "Cohesion of fine, hard powders: a pull of 2 pi w r* while two bodies touch.",
    .source = "Derjaguin, Muller and Toporov 1975",
    .kernel_file = "effect/cohesion_dmt.cl",
    .more_files = {"effect/cohesion_stateless.cl"},
    .interaction_needs = {&property_work_of_adhesion},
    .parameters = {"COHESION_PULL"},
    .derive = derive_dmt,
};

const law law_sjkr = {
    .name = "sjkr",
    .slot = SLOT_COHESION,
    .doc = "Simplified JKR: its adhesive term with Hertz's contact radius, without hysteresis; the largest pull is that of JKR.",
    .source = "after Johnson, Kendall and Roberts 1971",
    .kernel_file = "effect/cohesion_sjkr.cl",
    .more_files = {"effect/cohesion_stateless.cl"},
    .material_needs = {&property_youngs_modulus, &property_poissons_ratio},
    .interaction_needs = {&property_work_of_adhesion},
    .parameters = {"COHESION_PULL"},
    .derive = derive_sjkr,
};
