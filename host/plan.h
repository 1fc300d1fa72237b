/* What a scene will do and cost, without doing it: the output of `clast check`. */
#ifndef CLAST_HOST_PLAN_H
#define CLAST_HOST_PLAN_H
#include "status.h"

/* Reads the scene, builds its particles and writes the plan to standard output, as text or JSON: live laws by stage, unused properties,
 * fields and arguments, step limits, memory. `probe` also runs a few steps for the expected speed. `device` is as in device_choose,
 * `kernels` a directory instead of the embedded kernels; either may be NULL. */
status plan_command(const char *scene_path, int set_count, char *const *sets, const char *device, const char *kernels, bool json,
                    bool probe, failure *why);

#endif
