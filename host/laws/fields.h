/* The fields that more than one law or stage names. */
#ifndef CLAST_HOST_LAWS_FIELDS_H
#define CLAST_HOST_LAWS_FIELDS_H
#include "../law.h"

extern const field field_spin, field_torque, field_material, field_mover, field_orientation, field_faces, field_movers, field_half_velocity, field_half_spin;

#endif
