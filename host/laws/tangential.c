#include "../property.h"
#include "fields.h"
#include "laws.h"

#include "../restitution.h"
#include "../scene.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const field field_tangential_spring = {"tangential_spring", PER_RECORD, FIELD_REAL, 3, FIELD_HISTORY, "m",
                                              "tangential spring of a contact, in the frame of its owner"};

enum { MINDLIN_SHEAR_MODULUS, MINDLIN_LEVER_ARM, MINDLIN_UNLOADING };

/* G of one body; 1/G* adds up over the bodies that deform, each weighted by `weight` (1: as TM Eq. 9 prints it, 2 - nu: Mindlin). */
double effective_shear_modulus(const contact_class *class, int mindlin)
{
    double compliance = 0.0;
    const int body[2] = {class->material_a, class->material_b};
    for (int k = 0; k < 2; k++) {
        if (body[k] < 0)
            continue;
        double nu = material_value(class, body[k], &property_poissons_ratio);
        double shear = material_value(class, body[k], &property_youngs_modulus) / (2.0 * (1.0 + nu));
        compliance += (mindlin ? 2.0 - nu : 1.0) / shear;
    }
    return 1.0 / compliance;
}

double tangential_damping_ratio(const contact_class *class)
{
    double xi = interaction_value(class, &property_tangential_damping);
    if (!isnan(xi))
        return xi;
    const effect *normal = scene_effect(class->scene, -1, SLOT_NORMAL);
    return normal_damping_ratio(class, normal && !strcmp(normal->law->name, "linear") ? linear_damping_ratio : hertz_damping_ratio);
}

double rolling_damping_ratio(const contact_class *class)
{
    double xi = interaction_value(class, &property_rolling_damping);
    if (!isnan(xi))
        return xi;
    const effect *normal = scene_effect(class->scene, -1, SLOT_NORMAL);
    return normal_damping_ratio(class, normal && !strcmp(normal->law->name, "linear") ? linear_damping_ratio : hertz_damping_ratio);
}

static void derive_mindlin(const contact_class *class, const double *option, double *parameter)
{
    double shear = effective_shear_modulus(class, option[MINDLIN_SHEAR_MODULUS] == 1.0);
    if (interaction_value(class, &property_friction_static) == 0.0)
        shear = 0.0; /* a spring that never bears anything must not limit the step */
    parameter[0] = 8.0 * shear;
    parameter[1] = 2.0 * tangential_damping_ratio(class) * sqrt(8.0 * shear);
    parameter[2] = shear > 0.0 ? 1.0 / (8.0 * shear) : 0.0;
}

static void lever_arm_constant(double choice, char *text, size_t size)
{
    size_t used = strlen(text);
    snprintf(text + used, size - used, "#define LEVER_ARM_SHRINKS %s\n", choice == 0.0 ? "R(1.0)" : "R(0.0)");
}

static void mindlin_constants(const double *option, char *text, size_t size)
{
    lever_arm_constant(option[MINDLIN_LEVER_ARM], text, size);
    size_t used = strlen(text);
    snprintf(text + used, size - used, "#define TANGENTIAL_RESCALED %d\n", option[MINDLIN_UNLOADING] == 1.0);
}

const law law_mindlin = {
    .name = "mindlin",
    .slot = SLOT_TANGENTIAL,
    .doc = "Stick-slip friction with a tangential spring of Mindlin's stiffness, damped while it sticks.",
    .source = "TM Eq. 7-14 as settled in docs/theory.md",
    .kernel_file = "effect/tangential_mindlin.cl",
    .more_files = {"effect/tangential_spring.cl"},
    .options = {{"shear_modulus", "printed|mindlin", 0, 0, 0, "G* as TM Eq. 9 prints it, or 1/G* = sum (2 - nu)/G"},
                {"lever_arm", "contact_point|radius", 0, 0, 0, "arm of the friction force: to the contact point, or the radius as TM prints it"},
                {"unloading", "printed|rescaled", 0, 0, 0, "while the overlap falls: keep the spring, or scale it with the stiffness"}},
    .material_needs = {&property_youngs_modulus, &property_poissons_ratio},
    .interaction_needs = {&property_friction_static},
    .pair_fields = {&field_tangential_spring},
    .parameters = {"TANGENTIAL_MODULUS", "TANGENTIAL_DAMPING", "TANGENTIAL_COMPLIANCE"},
    .derive = derive_mindlin,
    .constants = mindlin_constants,
};

static void derive_coulomb_linear(const contact_class *class, const double *option, double *parameter)
{
    (void)option;
    double stiffness = interaction_value(class, &property_tangential_stiffness);
    if (interaction_value(class, &property_friction_static) == 0.0)
        stiffness = 0.0;
    parameter[0] = stiffness;
    parameter[1] = 2.0 * tangential_damping_ratio(class) * sqrt(stiffness);
    parameter[2] = stiffness > 0.0 ? 1.0 / stiffness : 0.0;
}

static void coulomb_linear_constants(const double *option, char *text, size_t size)
{
    lever_arm_constant(option[0], text, size);
}

const law law_coulomb_linear = {
    .name = "coulomb_linear",
    .slot = SLOT_TANGENTIAL,
    .doc = "Stick-slip friction with a tangential spring of constant stiffness.",
    .source = "Cundall and Strack 1979; damper and return as TM Eq. 7-13",
    .kernel_file = "effect/tangential_linear.cl",
    .more_files = {"effect/tangential_spring.cl"},
    .options = {{"lever_arm", "contact_point|radius", 0, 0, 0, "arm of the friction force: to the contact point, or the radius"}},
    .interaction_needs = {&property_tangential_stiffness, &property_friction_static},
    .pair_fields = {&field_tangential_spring},
    .parameters = {"TANGENTIAL_STIFFNESS", "TANGENTIAL_DAMPING", "TANGENTIAL_COMPLIANCE"},
    .derive = derive_coulomb_linear,
    .constants = coulomb_linear_constants,
};
