/* Heat of single grains: what surrounds them, what they make themselves; and the slots that follow from a scene with heat. */
#include "../property.h"
#include "../scene.h"
#include "fields.h"
#include "laws.h"

#include <math.h>

static void derive_temperature(const scene *scene, int stage, int material, const double *option, double *parameter)
{
    (void)stage;
    (void)option;
    parameter[0] = material_constant(scene, material, &property_specific_heat);
}

static void derive_temperature_tabled(const scene *scene, int stage, int material, const double *option, double *parameter)
{
    derive_temperature(scene, stage, material, option, parameter);
    parameter[1] = scene_material(scene, material, &property_specific_heat);
}

/* clang-format off */
#define TEMPERATURE                                                                  \
    .slot = SLOT_TEMPERATURE,                                                        \
    .doc = "Temperature of every grain, advanced explicitly.",                       \
    .source = "TM Eq. 28",                                                           \
    .kernel_file = "effect/temperature.cl",                                          \
    .particle_fields = {&field_temperature, &field_grain_constants}
#define CONSTANT_CAPACITY .grain_parameters = {"SPECIFIC_HEAT"}, .derive_grain = derive_temperature
#define TABLED_CAPACITY .grain_parameters = {"SPECIFIC_HEAT", "SPECIFIC_HEAT_LEAST"}, .derive_grain = derive_temperature_tabled
/* clang-format on */

const law law_temperature_grains = {
    .name = "of grains",
    TEMPERATURE,
    CONSTANT_CAPACITY,
    .more_files = {"effect/capacity_constant.cl", "none/temperature_pairs.cl"},
};

const law law_temperature_pairs = {
    .name = "of grains and contacts",
    TEMPERATURE,
    CONSTANT_CAPACITY,
    .more_files = {"effect/capacity_constant.cl", "effect/temperature_pairs.cl"},
    .pair_fields = {&field_temperature},
};

const law law_temperature_grains_tabled = {
    .name = "of grains, by enthalpy",
    TEMPERATURE,
    TABLED_CAPACITY,
    .more_files = {"effect/capacity_tabled.cl", "none/temperature_pairs.cl"},
};

const law law_temperature_pairs_tabled = {
    .name = "of grains and contacts, by enthalpy",
    TEMPERATURE,
    TABLED_CAPACITY,
    .more_files = {"effect/capacity_tabled.cl", "effect/temperature_pairs.cl"},
    .pair_fields = {&field_temperature},
};

const law law_substance_several = {
    .name = "several",
    .slot = SLOT_SUBSTANCE,
    .doc = "Several materials: every grain looks its constants up.",
    .source = "",
    .kernel_file = "effect/substance_several.cl",
    .particle_fields = {&field_material},
};

const law law_wall_temperature = {
    .name = "temperature",
    .slot = SLOT_WALL_HEAT,
    .doc = "Walls of prescribed temperature; others are adiabatic.",
    .source = "TM 5.1",
    .kernel_file = "effect/wall_heat_temperature.cl",
    .pair_fields = {&field_wall_heat},
};

const law law_wall_flux = {
    .name = "flux",
    .slot = SLOT_WALL_HEAT,
    .doc = "Walls that give a prescribed flow of heat, shared by area of contact; others have a temperature or are adiabatic.",
    .source = "",
    .kernel_file = "effect/wall_heat_flux.cl",
    .pair_fields = {&field_wall_heat, &field_wall_area},
};

const law law_environment_uniform = {
    .name = "uniform",
    .slot = SLOT_ENVIRONMENT,
    .doc = "The environment is the same everywhere; it may vary in time.",
    .source = "",
    .kernel_file = "effect/environment_uniform.cl",
    .particle_fields = {&field_environment},
};

const law law_environment_profile = {
    .name = "profile",
    .slot = SLOT_ENVIRONMENT,
    .doc = "The environment varies along an axis.",
    .source = "",
    .kernel_file = "effect/environment_profile.cl",
    .particle_fields = {&field_environment, &field_profile},
};

const law law_thermal_groups = {
    .name = "groups",
    .slot = SLOT_THERMAL_GROUPS,
    .doc = "Groups of grains whose temperature is prescribed, or that are given heat.",
    .source = "",
    .kernel_file = "effect/thermal_groups.cl",
    .particle_fields = {&field_thermal_group, &field_group_heat},
};

static const field field_heat_waiting = {"heat_waiting", PER_PARTICLE, FIELD_EXACT, 3, FIELD_STATE, "J",
                                         "heat that waits for its step: of contacts, of walls among them, of dissipation"};

const law law_heat_steps_every = {
    .name = "every n-th",
    .slot = SLOT_HEAT_STEPS,
    .doc = "Heat advances in every n-th step, from what contacts bring in all of them.",
    .source = "docs/theory.md",
    .kernel_file = "effect/heat_steps_every.cl",
    .particle_fields = {&field_heat_waiting},
};

const law law_heat_tally = {
    .name = "by grain",
    .slot = SLOT_HEAT_TALLY,
    .doc = "Adds up what each grain gains by each path.",
    .source = "",
    .kernel_file = "effect/heat_tally.cl",
    .particle_fields = {&field_heat_tally},
};

static void derive_newton(const scene *scene, int stage, int material, const double *option, double *parameter)
{
    (void)scene;
    (void)stage;
    (void)material;
    parameter[0] = option[0];
}

const law law_newton = {
    .name = "newton",
    .slot = SLOT_CONVECTION,
    .doc = "Convection with a given coefficient.",
    .source = "TM Eq. 37",
    .kernel_file = "effect/convection_newton.cl",
    .options = {{"coefficient_w_m2k", NULL, 0, 1e9, NAN, "coefficient of heat transfer"}},
    .grain_parameters = {"CONVECTION_COEFFICIENT"},
    .derive_grain = derive_newton,
};

static void derive_still_gas(const scene *scene, int stage, int material, const double *option, double *parameter)
{
    (void)stage;
    (void)material;
    (void)option;
    parameter[0] = scene_gas(scene, &property_gas_conductivity);
}

const law law_still_gas = {
    .name = "still_gas",
    .slot = SLOT_CONVECTION,
    .doc = "Convection into a gas at rest: h = k/r.",
    .source = "TM Eq. 37-38, Nu = 2",
    .kernel_file = "effect/convection_still_gas.cl",
    .gas_needs = {&property_gas_conductivity},
    .grain_parameters = {"CONVECTION_GAS"},
    .derive_grain = derive_still_gas,
};

static void derive_nusselt(const scene *scene, int stage, int material, const double *option, double *parameter)
{
    (void)stage;
    (void)material;
    (void)option;
    double k = scene_gas(scene, &property_gas_conductivity), viscosity = scene_gas(scene, &property_gas_viscosity);
    parameter[0] = k;
    parameter[1] = pow(scene_gas(scene, &property_gas_specific_heat) * viscosity / k, 0.4);
    parameter[2] = 2.0 * scene_gas(scene, &property_gas_density) / viscosity;
}

const law law_nusselt = {
    .name = "nusselt",
    .slot = SLOT_CONVECTION,
    .doc = "Convection into a moving gas, by the velocity relative to it.",
    .source = "TM Eq. 37-40 (Whitaker)",
    .kernel_file = "effect/convection_nusselt.cl",
    .gas_needs = {&property_gas_conductivity, &property_gas_specific_heat, &property_gas_viscosity, &property_gas_density},
    .grain_parameters = {"CONVECTION_GAS", "CONVECTION_PRANDTL", "CONVECTION_REYNOLDS"},
    .derive_grain = derive_nusselt,
};

#define STEFAN_BOLTZMANN 5.670367e-8 /* W/(m2 K4) */

static void derive_radiation(const scene *scene, int stage, int material, const double *option, double *parameter)
{
    (void)stage;
    (void)option;
    parameter[0] = 4.0 * M_PI * STEFAN_BOLTZMANN * scene_material(scene, material, &property_emissivity);
}

const law law_stefan_boltzmann = {
    .name = "stefan_boltzmann",
    .slot = SLOT_RADIATION,
    .doc = "Radiation to and from the environment.",
    .source = "TM Eq. 41",
    .kernel_file = "effect/radiation_stefan_boltzmann.cl",
    .material_needs = {&property_emissivity},
    .grain_parameters = {"RADIATION_STRENGTH"},
    .derive_grain = derive_radiation,
};

static void derive_volumetric(const scene *scene, int stage, int material, const double *option, double *parameter)
{
    (void)stage;
    (void)option;
    parameter[0] = 4.0 / 3.0 * M_PI * scene_material(scene, material, &property_heat_generation);
}

const law law_volumetric = {
    .name = "volumetric",
    .slot = SLOT_HEAT_GENERATION,
    .doc = "Heat made in the volume of the grains, as by an electric current.",
    .source = "Joule heating",
    .kernel_file = "effect/heat_generation_volumetric.cl",
    .material_needs = {&property_heat_generation},
    .grain_parameters = {"HEAT_GENERATION"},
    .derive_grain = derive_volumetric,
};
