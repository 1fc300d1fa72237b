#include "property.h"

#include "scene.h"

#include <math.h>

const property property_density = {"density_kg_m3", 0, 1e6, true, NAN, NULL, "mass density of the grains"};
const property property_youngs_modulus = {"youngs_modulus_pa", 0, 1e15, true, NAN, NULL, "Young's modulus"};
const property property_poissons_ratio = {"poissons_ratio", -1, 0.5, true, NAN, NULL, "Poisson's ratio"};
const property property_conductivity = {"conductivity_w_mk", 0, 1e6, false, NAN, NULL, "thermal conductivity"};
const property property_specific_heat = {"specific_heat_j_kgk", 0, 1e9, true, NAN, NULL, "specific heat"};

const property property_film_thickness = {"film_thickness_m", 0, 1, false, 0, NULL, "thickness of a film on the surface, which resists conduction"};
const property property_film_conductivity = {"film_conductivity_w_mk", 0, 1e6, true, 1, NULL, "thermal conductivity of that film"};
const property property_real_modulus = {"real_modulus_pa", 0, 1e15, true, NAN, NULL,
                                        "Young's modulus of the real material, where `youngs_modulus_pa` is softer; for `soft_modulus`"};
const property property_emissivity = {"emissivity", 0, 1, false, NAN, NULL, "emissivity of the surface"};
const property property_absorptance = {"absorptance", 0, 1, false, NAN, NULL, "share of a beam's heat that a grain takes up"};
const property property_heat_generation = {"heat_generation_w_m3", 0, 1e15, false, NAN, NULL, "heat made in each volume of the grains"};

const property property_gas_conductivity = {"conductivity_w_mk", 0, 1e6, true, NAN, NULL, "thermal conductivity of the gas"};
const property property_gas_specific_heat = {"specific_heat_j_kgk", 0, 1e9, true, NAN, NULL, "specific heat of the gas"};
const property property_gas_viscosity = {"viscosity_pa_s", 0, 1e6, true, NAN, NULL, "dynamic viscosity of the gas"};
const property property_gas_density = {"density_kg_m3", 0, 1e6, true, NAN, NULL, "density of the gas"};

const property property_restitution = {"restitution", 0, 1, true, NAN, NULL,
                                       "coefficient of restitution; gives the normal damping ratio where that is absent"};
const property property_normal_damping = {"normal_damping_ratio", 0, 100, false, NAN, NULL, "normal damping, ratio to critical"};
const property property_tangential_damping = {"tangential_damping_ratio", 0, 100, false, NAN, &property_normal_damping,
                                              "tangential damping, ratio to critical; default: the normal one"};
const property property_rolling_damping = {"rolling_damping_ratio", 0, 100, false, NAN, &property_normal_damping,
                                           "rolling damping, ratio to critical; default: the normal one"};
const property property_friction_static = {"friction_static", 0, 1e3, false, NAN, NULL, "static friction coefficient"};
const property property_friction_dynamic = {"friction_dynamic", 0, 1e3, false, NAN, &property_friction_static,
                                            "dynamic friction coefficient; default: the static one"};
const property property_rolling_friction = {"rolling_friction", 0, 1e3, false, NAN, NULL, "rolling resistance coefficient"};
const property property_normal_stiffness = {"normal_stiffness_n_m", 0, 1e15, true, NAN, NULL, "stiffness of the linear normal spring"};
const property property_tangential_stiffness = {"tangential_stiffness_n_m", 0, 1e15, false, NAN, NULL,
                                                "stiffness of the linear tangential spring"};

const property property_repulsion_stiffness = {"repulsion_stiffness", 0, 1e30, true, NAN, NULL,
                                               "stiffness k of the normal force k d^a, in N/m^a"};
const property property_repulsion_exponent = {"repulsion_exponent", 0.1, 10, false, 1.5, NULL, "exponent a of the normal force k d^a"};

const property property_bond_stiffness = {"bond_stiffness", 0, 1e30, false, NAN, NULL,
                                          "adhesion k of the bond force k d^a, in N/m^a; 0: this pair does not bond"};
const property property_bond_equilibrium_overlap = {"bond_equilibrium_overlap_m", 0, 1, true, NAN, NULL,
                                                    "overlap at which a bond is at rest; gives the adhesion instead of `bond_stiffness`"};
const property property_bond_normalised_stiffness = {"bond_normalised_stiffness_n", 0, 1e30, true, NAN, NULL,
                                                     "adhesion k r*^a of the bond force per strain d/r*; gives the adhesion instead of `bond_stiffness`"};
const property property_bond_equilibrium_strain = {"bond_equilibrium_strain", 0, 1, true, NAN, NULL,
                                                   "overlap over r* at which a bond is at rest; gives the adhesion instead of `bond_stiffness`"};
const property property_bond_exponent = {"bond_exponent", 0, 10, true, 1.0, NULL,
                                         "exponent of adhesion in the overlap; below that of the repulsion (1.5 for Hertz)"};
const property property_bond_damping = {"bond_damping_ratio", 0, 100, false, NAN, &property_normal_damping,
                                        "damping of a bond, ratio to critical; default: the normal one"};
const property property_bond_threshold = {"bond_threshold", -1e30, 1e29, false, NAN, NULL,
                                          "value above which the bond criterion is met, in the unit of what it looks at"};
const property property_bond_tensile_strength = {"bond_tensile_strength_pa", 0, 1e29, true, 1e30, NULL,
                                                 "tension at which a bond breaks; default: it does not"};
const property property_bond_youngs_modulus = {"bond_youngs_modulus_pa", 0, 1e15, false, 0, NULL,
                                              "Young's modulus of the bond's material; 0: this pair does not bond"};
const property property_bond_shear_modulus = {"bond_shear_modulus_pa", 0, 1e15, false, NAN, NULL,
                                              "shear modulus of the bond's material; default: 0.4 of its Young's modulus"};
const property property_bond_radius_ratio = {"bond_radius_ratio", 0, 1, true, 1, NULL, "radius of the bond, of the smaller grain's"};
const property property_bond_gap_ratio = {"bond_gap_ratio", 0, 1, false, 1e-6, NULL,
                                          "gap up to which a bond is made, of the smaller grain's radius"};
const property property_surface_energy = {"surface_energy_j_m2", 0, 1e6, true, NAN, NULL, "energy of the free surface, which drives sintering"};
const property property_boundary_diffusion = {"boundary_diffusion_m3_s", 0, 1, true, NAN, NULL,
                                              "diffusion along the boundary of two grains times its thickness, delta D_0, before the Arrhenius factor"};
const property property_atomic_volume = {"atomic_volume_m3", 0, 1e-20, true, NAN, NULL, "volume of an atom, for the diffusion that sinters"};
const property property_sintering_activation = {"activation_energy_j_mol", 0, 1e7, false, NAN, NULL, "activation energy of that diffusion"};
const property property_neck_ratio_least = {"neck_radius_ratio_least", 1e-3, 1, false, 0.01, NULL,
                                            "radius with which a neck starts at least, of the smaller grain's"};
const property property_neck_ratio_most = {"neck_radius_ratio_most", 1e-3, 1, false, 0.5, NULL, "radius up to which a neck grows, of the smaller grain's"};
const property property_work_of_adhesion = {"work_of_adhesion_j_m2", 0, 1e6, false, NAN, NULL,
                                            "work of adhesion of two surfaces; 0: this pair does not cohere"};
const property property_bond_shear_strength = {"bond_shear_strength_pa", 0, 1e29, true, 1e30, NULL,
                                               "shear stress at which a bond breaks; default: it does not"};

double interaction_value(const contact_class *class, const property *property)
{
    return scene_interaction(class->scene, class->stage, class->material_a, class->material_b, class->wall, property);
}

double material_value(const contact_class *class, int material, const property *property)
{
    return scene_material(class->scene, material, property);
}

double interaction_constant(const contact_class *class, const property *property)
{
    const property_table *table = scene_interaction_table(class->scene, class->stage, class->material_a, class->material_b, class->wall, property);
    return table ? scene_table_constant(class->scene, table) : interaction_value(class, property);
}

double normal_damping_ratio(const contact_class *class, double (*invert)(double restitution))
{
    double ratio = interaction_value(class, &property_normal_damping);
    double restitution = interaction_value(class, &property_restitution);
    if (!isnan(ratio))
        return ratio;
    return isnan(restitution) ? 0.0 : invert(restitution);
}

double effective_modulus(const contact_class *class)
{
    double compliance = 0.0;
    const int body[2] = {class->material_a, class->material_b};
    for (int k = 0; k < 2; k++) {
        if (body[k] < 0)
            continue;
        double nu = material_value(class, body[k], &property_poissons_ratio);
        compliance += (1.0 - nu * nu) / material_value(class, body[k], &property_youngs_modulus);
    }
    return 1.0 / compliance;
}
