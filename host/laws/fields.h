/* The fields that more than one law or stage names. */
#ifndef CLAST_HOST_LAWS_FIELDS_H
#define CLAST_HOST_LAWS_FIELDS_H
#include "../law.h"

extern const field field_spin, field_torque, field_material, field_mover, field_orientation, field_faces, field_movers, field_half_velocity, field_half_spin,
    field_bonded, field_scalar;
extern const field field_temperature, field_heat_tally, field_thermal_group, field_heat, field_grain_constants, field_environment, field_profile,
    field_wall_heat, field_wall_area, field_group_heat, field_beams, field_beam_meets, field_depth[];
extern const field field_modulus_factor, field_reference_radius, field_built_radius, field_property_tables, field_resistivity;
/* The sums of the energy ledger. */
extern const field field_dissipated, field_work_contacts, field_work_grains;

#endif
