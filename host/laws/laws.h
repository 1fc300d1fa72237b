/* Every law by name. */
#ifndef CLAST_HOST_LAWS_LAWS_H
#define CLAST_HOST_LAWS_LAWS_H
#include "../law.h"

extern const law law_hertz, law_linear, law_mindlin, law_coulomb_linear, law_elastic_plastic, law_constant_torque, law_local_damping,
    law_viscous_damping, law_power, law_adhesion, law_parallel, law_sintering, law_jkr, law_dmt, law_sjkr;
extern const law law_bonding_always, law_bonding_at_time, law_bonding_scalar, law_bonding_temperature;
extern const law law_precision_mixed, law_composition_several, law_dimensions_two, law_packed_grains, law_touched_marks, law_periodic_box, law_motion_groups, law_rotation_spin, law_rotation_wrenches, law_rotation_wrenches_moment, law_slip_single, law_slip_two,
    law_walls_planes, law_walls_finite, law_walls_round, law_orientation_quaternion, law_semi_implicit_euler, law_velocity_verlet, law_velocity_verlet_spin,
    law_dissipation_tracked, law_dissipation_synchronous, law_ledger_energies, law_fraction, law_exponential_softening, law_softening_tracked;

extern const law law_heat_steps_every, law_tables_of_pairs, law_tables_of_grains, law_tables_of_both, law_conductivity_tabled, law_friction_tabled, law_modulus_table,
    law_temperature_grains_tabled, law_temperature_pairs_tabled;
/* Of a material's property, as the kernels take what may be a table. */
double material_constant(const struct scene *scene, int material, const property *property);
/* Factor of a grain's thermal resistivity at a temperature. */
double resistivity_at(const struct scene *scene, int material, double temperature);
/* J/(kg K), and its integral over a way of temperatures. */
double specific_heat_at(const struct scene *scene, int material, double temperature);
double specific_heat_between(const struct scene *scene, int material, double from, double to);
extern const law law_linear_expansion, law_expansion_tracked;
/* Radius at a temperature over the one given; 1 without a law of expansion. */
double expansion_factor(const struct scene *scene, int material, double temperature);

/* E(T)/E of a grain of this material by the live law of softening. */
double modulus_factor_at(const struct scene *scene, int material, double temperature);
extern const law law_overlap_area, law_batchelor_obrien, law_pipe_network, law_wall_flux, law_newton, law_still_gas, law_nusselt, law_stefan_boltzmann,
    law_volumetric;
extern const law law_temperature_grains, law_temperature_pairs, law_substance_several, law_wall_temperature, law_environment_uniform,
    law_environment_profile, law_thermal_groups, law_heat_tally;

/* Options of a source's law, in this order; reach: attenuation of a laser, largest depth of a burner. */
enum { SOURCE_PROFILE, SOURCE_DIAMETER, SOURCE_REACH, SOURCE_INTERVAL };
extern const law law_laser, law_burner;
/* The law of a program that holds the scene's sources. */
struct scene;
const law *law_of_beams(const struct scene *scene);

/* What pushes two bodies apart: coefficient r*^radius_power d^exponent, as the scene's normal law has it; exponent 0: nothing does. */
typedef struct repulsion {
    double coefficient, radius_power, exponent;
} repulsion;
repulsion repulsion_of(const contact_class *class);

/* Adhesion of a pair that bonds: coefficient r*^radius_power d^exponent; coefficient 0: the pair does not bond. */
typedef struct adhesion {
    double coefficient, radius_power, exponent, damping_ratio;
} adhesion;
adhesion adhesion_of(const contact_class *class);

/* Criteria of the bond laws, in the order of their option. */
enum { BOND_ALWAYS, BOND_AT_TIME, BOND_SCALAR_ABOVE, BOND_BOTH_ABOVE, BOND_MEAN_ABOVE, BOND_HOTTEST_ABOVE };
/* Places of the options that every bond law has, in this order. */
enum { BOND_CRITERION, BOND_TIME, BOND_OWN /* the first that a law adds; of adhesion: its clamps */ };
/* The law that looks for the criterion of a live bond law. */
/* The interactions of the pair let it bond. */
bool pair_bonds(const contact_class *class);
bool bonding_reads_temperature(const law *bond, const double *option);
const law *bonding_of(const law *bond, const double *option);

double effective_shear_modulus(const contact_class *class, int mindlin);
double tangential_damping_ratio(const contact_class *class);
double rolling_damping_ratio(const contact_class *class);

#endif
