#include "fields.h"

const field field_spin = {"spin", PER_PARTICLE, FIELD_REAL, 3, FIELD_STATE, "rad/s", "angular velocity"};
const field field_torque = {"torque", PER_RECORD, FIELD_REAL, 6, FIELD_RESULT, "N m", "torque on the owner (3) and on the other body (3)"};
const field field_material = {"material", PER_PARTICLE, FIELD_INT, 1, FIELD_STATE, "", "index of the material"};
const field field_mover = {"mover", PER_PARTICLE, FIELD_INT, 1, FIELD_STATE, "", "prescribed motion that moves the grain; -1: free"};
const field field_orientation = {"orientation", PER_PARTICLE, FIELD_REAL, 4, FIELD_STATE, "", "unit quaternion w x y z"};
const field field_half_velocity = {"half_velocity", PER_PARTICLE, FIELD_REAL, 3, FIELD_STATE, "m/s", "velocity half a step behind the position"};
const field field_half_spin = {"half_spin", PER_PARTICLE, FIELD_REAL, 3, FIELD_STATE, "rad/s", "angular velocity half a step behind the position"};
const field field_faces = {"faces", PER_SCENE, FIELD_REAL, 1, FIELD_RESULT, "", "faces of the walls, a row a step where walls move"};
const field field_movers = {"movers", PER_SCENE, FIELD_REAL, 1, FIELD_RESULT, "", "prescribed motions, a row a step"};
