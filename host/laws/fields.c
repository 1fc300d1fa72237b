#include "fields.h"

#include <clast/shared.h>

const field field_spin = {"spin", PER_PARTICLE, FIELD_EXACT, 3, FIELD_STATE, "rad/s", "angular velocity"};
const field field_torque = {"torque", PER_RECORD, FIELD_REAL, 6, FIELD_RESULT, "N m", "torque on the owner (3) and on the other body (3)"};
const field field_material = {"material", PER_PARTICLE, FIELD_INT, 1, FIELD_STATE, "", "index of the material"};
const field field_mover = {"mover", PER_PARTICLE, FIELD_INT, 1, FIELD_STATE, "", "prescribed motion that moves the grain; -1: free"};
const field field_orientation = {"orientation", PER_PARTICLE, FIELD_EXACT, 4, FIELD_STATE, "", "unit quaternion w x y z"};
const field field_half_velocity = {"half_velocity", PER_PARTICLE, FIELD_EXACT, 3, FIELD_STATE, "m/s", "velocity half a step behind the position"};
const field field_half_spin = {"half_spin", PER_PARTICLE, FIELD_EXACT, 3, FIELD_STATE, "rad/s", "angular velocity half a step behind the position"};
const field field_faces = {"faces", PER_SCENE, FIELD_REAL, 1, FIELD_RESULT, "", "faces of the walls, a row a step where walls move"};
const field field_movers = {"movers", PER_SCENE, FIELD_REAL, 1, FIELD_RESULT, "", "prescribed motions, a row a step"};
const field field_temperature = {"temperature", PER_PARTICLE, FIELD_EXACT, 1, FIELD_STATE, "K", "temperature"};
const field field_heat_tally = {"heat_tally", PER_PARTICLE, FIELD_EXACT, CLAST_TALLIES, FIELD_STATE, "J", "heat gained so far, by path"};
const field field_thermal_group = {"thermal_group", PER_PARTICLE, FIELD_INT, 1, FIELD_STATE, "",
                                   "group whose temperature or heating is prescribed; -1: free"};
const field field_heat = {"heat", PER_RECORD, FIELD_REAL, 1, FIELD_RESULT, "W", "heat that a contact brings its owner"};
const field field_grain_constants = {"grain_constants", PER_SCENE, FIELD_REAL, 1, FIELD_RESULT, "", "constants of every material"};
const field field_environment = {"environment", PER_SCENE, FIELD_REAL, 1, FIELD_RESULT, "", "what surrounds the bed, a row a step where it varies"};
const field field_profile = {"profile", PER_SCENE, FIELD_REAL, 1, FIELD_RESULT, "", "the environment along an axis"};
const field field_wall_heat = {"wall_heat", PER_SCENE, FIELD_REAL, 1, FIELD_RESULT, "", "heat of the faces of walls, a row a step where it varies"};
const field field_group_heat = {"group_heat", PER_SCENE, FIELD_REAL, 1, FIELD_RESULT, "", "heat of the groups, a row a step where it varies"};
const field field_bonded = {"bonded", PER_RECORD, FIELD_REAL, 1, FIELD_HISTORY, "",
                            "twice the bonds that the contact has had, one less while the last one lives; negative: broken by a strength"};
const field field_scalar = {"scalar", PER_PARTICLE, FIELD_REAL, 1, FIELD_STATE, "", "a scalar of the grain, such as a concentration"};
const field field_wall_area = {"wall_area", PER_SCENE, FIELD_INT, 1, FIELD_RESULT, "", "area that touches each wall"};
const field field_beams = {"beams", PER_SCENE, FIELD_REAL, 1, FIELD_RESULT, "", "beams of the sources, a row a step where they vary"};
const field field_beam_meets = {"beam_meets", PER_SCENE, FIELD_INT, 1, FIELD_RESULT, "", "1 for every beam that has met a grain"};
#define DEPTH(sides) {"depth", PER_PARTICLE, FIELD_REAL, sides, FIELD_STATE, "m", "depth of the top below the bed's surface, by direction of beams"}
const field field_depth[CLAST_BEAM_SIDES_MAX] = {DEPTH(1), DEPTH(2), DEPTH(3), DEPTH(4)};
