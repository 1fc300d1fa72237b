/* The numbers that materials and interactions carry, one row each. A law that needs a new one adds its row here or in its own file. */
#ifndef CLAST_HOST_PROPERTY_H
#define CLAST_HOST_PROPERTY_H
#include "law.h"

extern const property property_density, property_youngs_modulus, property_poissons_ratio, property_conductivity, property_specific_heat;
extern const property property_film_thickness, property_film_conductivity, property_real_modulus, property_emissivity, property_absorptance, property_heat_generation;
extern const property property_gas_conductivity, property_gas_specific_heat, property_gas_viscosity, property_gas_density;
extern const property property_restitution, property_normal_damping, property_tangential_damping, property_rolling_damping;
extern const property property_friction_static, property_friction_dynamic, property_rolling_friction;
extern const property property_normal_stiffness, property_tangential_stiffness;
extern const property property_repulsion_stiffness, property_repulsion_exponent;
extern const property property_bond_stiffness, property_bond_equilibrium_overlap, property_bond_normalised_stiffness,
    property_bond_equilibrium_strain, property_bond_exponent, property_bond_damping, property_bond_threshold, property_bond_tensile_strength,
    property_bond_shear_strength, property_bond_youngs_modulus, property_bond_shear_modulus, property_bond_radius_ratio, property_bond_gap_ratio,
    property_work_of_adhesion, property_surface_energy, property_boundary_diffusion, property_atomic_volume, property_sintering_activation,
    property_neck_ratio_least, property_neck_ratio_most;

extern const property property_softening_temperature, property_softening_rate, property_modulus_floor;
extern const property property_expansion, property_reference_temperature;

/* Ratio to critical damping of the normal law: as given, or from the coefficient of restitution through `invert`, or 0. */
double normal_damping_ratio(const contact_class *class, double (*invert)(double restitution));
double interaction_value(const contact_class *class, const property *property);
/* The same as the kernels take what may be a table: its number, or -1 - its row. */
double interaction_constant(const contact_class *class, const property *property);
double material_value(const contact_class *class, int material, const property *property);
/* 1/E* = sum (1 - nu^2)/E over the bodies that deform (TM Eq. 3, Remark 1). */
double effective_modulus(const contact_class *class);

#endif
