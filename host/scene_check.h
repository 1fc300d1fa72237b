/* Checks over the scene as a whole, after every key has been read. */
#ifndef CLAST_HOST_SCENE_CHECK_H
#define CLAST_HOST_SCENE_CHECK_H
#include "parameter.h"

status scene_check(reader *r);
status check_frozen_stage(reader *r, int stage);
status scene_check_heat(reader *r);
/* Names of sources, and the directions of their beams. */
status scene_check_sources(reader *r);
status check_wall_heat(reader *r, int node, const wall_heat *heat);

#endif
