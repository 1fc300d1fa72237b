/* Every law by name. */
#ifndef CLAST_HOST_LAWS_LAWS_H
#define CLAST_HOST_LAWS_LAWS_H
#include "../law.h"

extern const law law_hertz, law_linear, law_mindlin, law_coulomb_linear, law_elastic_plastic, law_constant_torque, law_local_damping,
    law_viscous_damping;
extern const law law_composition_several, law_periodic_box, law_motion_groups, law_rotation_spin, law_slip_single, law_slip_two,
    law_walls_planes, law_walls_finite, law_orientation_quaternion, law_semi_implicit_euler, law_velocity_verlet, law_velocity_verlet_spin;
extern const law law_overlap_area, law_newton, law_still_gas, law_nusselt, law_stefan_boltzmann, law_volumetric;
extern const law law_temperature_grains, law_temperature_pairs, law_substance_several, law_wall_temperature, law_environment_uniform,
    law_environment_profile, law_thermal_groups, law_heat_tally;

double effective_shear_modulus(const contact_class *class, int mindlin);
double tangential_damping_ratio(const contact_class *class);
double rolling_damping_ratio(const contact_class *class);

#endif
