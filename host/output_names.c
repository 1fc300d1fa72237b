/* What `output:` may list. */
#include "scene_table.h"

const output_name output_fields[] = {
    {"position", "m", 3, NULL, "centre"},
    {"velocity", "m/s", 3, NULL, "velocity of the centre"},
    {"spin", "rad/s", 3, NULL, "angular velocity"},
    {"orientation", "1", 4, NULL, "unit quaternion w, x, y, z"},
    {"force", "N", 3, NULL, "total force"},
    {"torque", "N m", 3, NULL, "total torque about the centre"},
    {"scalar", "1", 1, NULL, "the scalar of the grain that a bond criterion looks at"},
    {"temperature", "K", 1, NULL, "temperature"},
    {0},
};

#define LEDGER "the energy ledger"
#define HEAT   "a heat law"

const output_name output_observables[] = {
    {"time_step", "s", 1, NULL, "time step"},
    {"kinetic_energy", "J", 1, NULL, "translational kinetic energy"},
    {"rotational_energy", "J", 1, NULL, "rotational kinetic energy"},
    {"elastic_energy", "J", 1, NULL, "energy stored in contacts"},
    {"gravitational_energy", "J", 1, NULL, "energy in the field of gravity"},
    {"overlap_max", "1", 1, NULL, "largest overlap, as a fraction of the smaller radius"},
    {"coordination_number", "1", 1, NULL, "mean number of contacts of a particle"},
    {"contacts", "1", 1, NULL, "number of contacts"},
    {"momentum", "kg m/s", 3, NULL, "total momentum"},
    {"angular_momentum", "kg m^2/s", 3, NULL, "total angular momentum about the origin"},
    {"stress", "Pa", 9, NULL, "mean stress from contact forces and branch vectors"},
    {"rebuilds", "1", 1, NULL, "rebuilds of the contact table so far"},
    {"left_count", "1", 1, NULL, "particles that have left the domain"},
    {"left_mass", "kg", 1, NULL, "their mass"},
    {"dissipated_normal", "J", 1, LEDGER, "energy lost to normal damping"},
    {"dissipated_tangential", "J", 1, LEDGER, "energy lost to friction and tangential damping"},
    {"dissipated_rolling", "J", 1, LEDGER, "energy lost to rolling resistance"},
    {"work_gravity", "J", 1, LEDGER, "work of gravity"},
    {"work_walls", "J", 1, LEDGER, "work of the walls"},
    {"work_expansion", "J", 1, LEDGER, "work of thermal expansion"},
    {"work_stiffness", "J", 1, LEDGER, "work of changing stiffness"},
    {"thermal_energy", "J", 1, NULL, "heat content, the sum of m c T"},
    {"heat_sources", "J", 1, NULL, "heat gained from sources, generation, given fluxes and prescribed temperatures so far"},
    {"heat_convection", "J", 1, NULL, "heat gained by convection so far"},
    {"heat_radiation", "J", 1, NULL, "heat gained by radiation so far"},
    {"heat_walls", "J", 1, NULL, "heat gained from walls so far"},
    {"heat_dissipation", "J", 1, HEAT, "heat from dissipation"},
    {"source_absorbed", "J", 1, HEAT, "energy absorbed from sources"},
    {"source_delivered", "J", 1, HEAT, "energy delivered by sources"},
    {"temperature_min", "K", 1, NULL, "lowest temperature"},
    {"temperature_mean", "K", 1, NULL, "mean temperature"},
    {"temperature_max", "K", 1, NULL, "highest temperature"},
    {"bonds_alive", "1", 1, NULL, "living bonds"},
    {"bonds_made", "1", 1, NULL, "bonds made so far"},
    {"bonds_broken", "1", 1, NULL, "bonds broken so far"},
    {0},
};
