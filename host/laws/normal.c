#include "../property.h"
#include "../restitution.h"
#include "laws.h"

#include <math.h>

static void derive_hertz(const contact_class *class, const double *option, double *parameter)
{
    (void)option;
    double modulus = effective_modulus(class);
    double xi = normal_damping_ratio(class, hertz_damping_ratio);
    parameter[0] = modulus;
    parameter[1] = 2.0 * xi * sqrt(2.0 * modulus);
}

const law law_hertz = {
    .name = "hertz",
    .slot = SLOT_NORMAL,
    .doc = "Hertz contact with damping proportional to the critical damping of the tangent stiffness; never attracts.",
    .source = "TM Eq. 2, 3, 6; the clamp: BM sec. 4",
    .kernel_file = "effect/normal_hertz.cl",
    .material_needs = {&property_youngs_modulus, &property_poissons_ratio},
    .interaction_needs = {0},
    .parameters = {"NORMAL_MODULUS", "NORMAL_DAMPING"},
    .derive = derive_hertz,
};

static void derive_linear(const contact_class *class, const double *option, double *parameter)
{
    (void)option;
    double stiffness = interaction_value(class, &property_normal_stiffness);
    double xi = normal_damping_ratio(class, linear_damping_ratio);
    parameter[0] = stiffness;
    parameter[1] = 2.0 * xi * sqrt(stiffness);
}

const law law_linear = {
    .name = "linear",
    .slot = SLOT_NORMAL,
    .doc = "Linear spring and dashpot; never attracts.",
    .source = "Cundall and Strack 1979; the damping ratio as in TM",
    .kernel_file = "effect/normal_linear.cl",
    .interaction_needs = {&property_normal_stiffness},
    .parameters = {"NORMAL_STIFFNESS", "NORMAL_DAMPING"},
    .derive = derive_linear,
};

static void derive_power(const contact_class *class, const double *option, double *parameter)
{
    (void)option;
    double xi = interaction_value(class, &property_normal_damping);
    parameter[0] = interaction_value(class, &property_repulsion_stiffness);
    parameter[1] = interaction_value(class, &property_repulsion_exponent);
    parameter[2] = isnan(xi) ? 0.0 : 2.0 * xi;
}

const law law_power = {
    .name = "power",
    .slot = SLOT_NORMAL,
    .doc = "A given power of the overlap, with damping proportional to the critical damping of the tangent stiffness; never attracts. "
           "Damping by `normal_damping_ratio`; `restitution` is not inverted for it.",
    .source = "BM Eq. 7",
    .kernel_file = "effect/normal_power.cl",
    .interaction_needs = {&property_repulsion_stiffness},
    .parameters = {"NORMAL_STIFFNESS", "NORMAL_EXPONENT", "NORMAL_DAMPING"},
    .derive = derive_power,
};
