#include "law.h"

#include "laws/laws.h"
#include "property.h"

#include <string.h>

const law *const laws[] = {&law_hertz,        &law_linear,        &law_mindlin, &law_coulomb_linear, &law_elastic_plastic,
                           &law_constant_torque, &law_power, &law_adhesion, &law_parallel, &law_sintering, &law_jkr, &law_dmt, &law_sjkr,
                           &law_local_damping, &law_viscous_damping, &law_overlap_area,
                           &law_batchelor_obrien, &law_pipe_network, &law_newton,
                           &law_still_gas,    &law_nusselt,       &law_stefan_boltzmann, &law_volumetric, &law_laser, &law_burner, &law_exponential_softening, &law_modulus_table, &law_linear_expansion, &law_fraction, NULL};

static const struct {
    const char *name;
    bool listed;
} slots[SLOT_COUNT] = {
    [SLOT_PRECISION] = {"precision", false},     [SLOT_COMPOSITION] = {"composition", false}, [SLOT_DIMENSIONS] = {"dimensions", false},    [SLOT_PERIODIC] = {"periodic", false},     [SLOT_MOTION] = {"motion", false},
    [SLOT_ROTATION] = {"rotation", false},       [SLOT_NORMAL] = {"normal", true},
    [SLOT_BONDING] = {"bonding", false},         [SLOT_BOND] = {"bond", true},              [SLOT_COHESION] = {"cohesion", true},
    [SLOT_SLIP] = {"slip", false},
    [SLOT_TANGENTIAL] = {"tangential", true},    [SLOT_ROLLING] = {"rolling", true},        [SLOT_MODULUS] = {"modulus", true},          [SLOT_SOFTENING] = {"softening", false},
    [SLOT_HEAT_STEPS] = {"heat_steps", false},
    [SLOT_TABLES] = {"tables", false},           [SLOT_CONDUCTIVITY] = {"conductivity", false}, [SLOT_FRICTION] = {"friction", false},
    [SLOT_RADIUS] = {"radius", true},            [SLOT_EXPANSION] = {"expansion", false},
    [SLOT_DISSIPATION] = {"dissipation", false},
    [SLOT_DISSIPATION_HEAT] = {"dissipation_heat", true},
    [SLOT_LEDGER] = {"ledger", false},           [SLOT_WALLS] = {"walls", false},
    [SLOT_TEMPERATURE] = {"temperature", false}, [SLOT_SUBSTANCE] = {"substance", false},   [SLOT_CONDUCTION] = {"conduction", true},
    [SLOT_WALL_HEAT] = {"wall_heat", false},     [SLOT_ENVIRONMENT] = {"environment", false}, [SLOT_CONVECTION] = {"convection", true},
    [SLOT_RADIATION] = {"radiation", true},      [SLOT_SOURCE] = {"source", true},         [SLOT_HEAT_GENERATION] = {"heat_generation", true},
    [SLOT_THERMAL_GROUPS] = {"thermal_groups", false}, [SLOT_HEAT_TALLY] = {"heat_tally", false},
    [SLOT_BODY] = {"body", true},                [SLOT_ORIENTATION] = {"orientation", false}, [SLOT_INTEGRATOR] = {"integrator", false},
    [SLOT_PACKED] = {"packed", false},
    [SLOT_TOUCHED] = {"touched", false},
};

const char *slot_name(slot_id slot)
{
    return slots[slot].name;
}

bool slot_is_listed(slot_id slot)
{
    return slots[slot].listed;
}

slot_id slot_find(const char *name)
{
    slot_id slot = 0;
    while (slot < SLOT_COUNT && strcmp(slots[slot].name, name) != 0)
        slot++;
    return slot;
}

const law *law_find(slot_id slot, const char *name)
{
    for (const law *const *l = laws; *l; l++)
        if ((*l)->slot == slot && strcmp((*l)->name, name) == 0)
            return *l;
    return NULL;
}

bool property_is_tabled(const property *p)
{
    return p == &property_conductivity || p == &property_specific_heat || p == &property_youngs_modulus || p == &property_friction_static ||
           p == &property_friction_dynamic;
}

const property *const *material_properties(void)
{
    static const property *const all[] = {&property_density, &property_youngs_modulus, &property_poissons_ratio,
                                          &property_conductivity, &property_specific_heat,
                                          &property_film_thickness, &property_film_conductivity, &property_real_modulus,
                                          &property_emissivity, &property_absorptance, &property_heat_generation, 
                                          &property_softening_temperature, &property_softening_rate, &property_modulus_floor,
                                          &property_expansion, &property_reference_temperature, NULL};
    return all;
}

const property *const *interaction_properties(void)
{
    static const property *const all[] = {&property_restitution,       &property_normal_damping,   &property_tangential_damping,
                                          &property_rolling_damping,   &property_friction_static,  &property_friction_dynamic,
                                          &property_rolling_friction,  &property_normal_stiffness, &property_tangential_stiffness,
                                          &property_repulsion_stiffness, &property_repulsion_exponent, &property_bond_stiffness,
                                          &property_bond_equilibrium_overlap, &property_bond_normalised_stiffness,
                                          &property_bond_equilibrium_strain, &property_bond_exponent, &property_bond_damping,
                                          &property_bond_threshold, &property_bond_tensile_strength, &property_bond_shear_strength,
                                          &property_bond_youngs_modulus, &property_bond_shear_modulus, &property_bond_radius_ratio,
                                          &property_bond_gap_ratio, &property_surface_energy, &property_boundary_diffusion,
                                          &property_atomic_volume, &property_sintering_activation, &property_neck_ratio_least, &property_neck_ratio_most,
                                          &property_work_of_adhesion,
                                          NULL};
    return all;
}

const property *const *gas_properties(void)
{
    static const property *const all[] = {&property_gas_conductivity, &property_gas_specific_heat, &property_gas_viscosity, &property_gas_density, NULL};
    return all;
}
