#include "laws.h"

#include <stdio.h>
#include <string.h>

static void coefficient_constant(const double *option, char *text, size_t size)
{
    size_t used = strlen(text);
    snprintf(text + used, size - used, "#define BODY_DAMPING R(%.17e)\n", option[0]);
}

static double drag_rate(const double *option)
{
    return option[0];
}

const law law_local_damping = {
    .name = "local_damping",
    .slot = SLOT_BODY,
    .doc = "Non-viscous damping: every component of the unbalanced force and torque is reduced by the coefficient where it does work on the "
           "motion and raised by it where it brakes; leaves equilibrium forces untouched.",
    .source = "Cundall 1987",
    .kernel_file = "effect/body_local_damping.cl",
    .options = {{"coefficient", NULL, 0, 1, 0.2, "fraction of the unbalanced force"}},
    .constants = coefficient_constant,
};

const law law_viscous_damping = {
    .name = "viscous_damping",
    .slot = SLOT_BODY,
    .doc = "Background drag: velocity and spin decay at the rate `coefficient` (1/s).",
    .source = "dv/dt = -c v",
    .kernel_file = "effect/body_viscous_damping.cl",
    .options = {{"coefficient", NULL, 0, 1e9, 1, "rate of decay, 1/s"}},
    .drag_rate = drag_rate,
    .constants = coefficient_constant,
};
