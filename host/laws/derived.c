/* Slots that the scene as a whole fills, rather than an entry of `effects:`. */
#include "fields.h"
#include "laws.h"

#include <stdio.h>
#include <string.h>

/* Appends. */
static void mixed_constants(const double *option, char *text, size_t size)
{
    (void)option;
    size_t used = strlen(text);
    snprintf(text + used, size - used, "#define REAL_IS_FLOAT\n");
}

const law law_precision_mixed = {
    .name = "mixed",
    .slot = SLOT_PRECISION,
    .doc = "Arithmetic in float; what takes small increments over many steps, and what overlaps are differences of, in pairs of floats.",
    .source = "Knuth, TAOCP 2, sec. 4.2.2; Dekker 1971",
    .kernel_file = "precision/mixed.cl",
    .constants = mixed_constants,
};

const law law_composition_several = {
    .name = "several",
    .slot = SLOT_COMPOSITION,
    .doc = "Several materials or kinds of contact: every grain carries its material, and a contact looks its constants up.",
    .source = "",
    .kernel_file = "effect/composition_several.cl",
    .pair_fields = {&field_material},
};

const law law_dimensions_two = {
    .name = "two",
    .slot = SLOT_DIMENSIONS,
    .doc = "Motion in the plane of x and y, and spins about z: what is always 0 is not computed.",
    .source = "",
    .kernel_file = "effect/dimensions_two.cl",
};

static const field field_packed = {"packed", PER_PARTICLE, FIELD_REAL, 16, FIELD_RESULT, "", "what pairs read of the grain, side by side"};

const law law_packed_grains = {
    .name = "grains",
    .slot = SLOT_PACKED,
    .doc = "What the pair stage reads of a grain, once more in 16 floats side by side: one line of a cache.",
    .source = "",
    .kernel_file = "effect/packed_grains.cl",
    .pair_fields = {&field_packed},
    .particle_fields = {&field_packed},
};

static const field field_touched = {"touched", PER_PARTICLE, FIELD_INT, 1, FIELD_RESULT, "", "1: the grain may have a contact in this step"};
static const field field_quiet_lots = {"quiet_lots", PER_RECORD_BLOCK, FIELD_INT, 1, FIELD_RESULT, "", "lots of records whose forces are 0, a bit each"};

const law law_touched_marks = {
    .name = "marks",
    .slot = SLOT_TOUCHED,
    .doc = "In a loose bed, which grains may have a contact: the others have no forces to be summed.",
    .source = "",
    .kernel_file = "effect/touched_marks.cl",
    .pair_fields = {&field_touched, &field_quiet_lots},
    .particle_fields = {&field_touched},
};

const law law_periodic_box = {
    .name = "box",
    .slot = SLOT_PERIODIC,
    .doc = "Nearest image in the periodic directions.",
    .source = "",
    .kernel_file = "effect/periodic_box.cl",
};

const law law_motion_groups = {
    .name = "groups",
    .slot = SLOT_MOTION,
    .doc = "Grains that are held or moved as prescribed; they count as infinitely heavy.",
    .source = "",
    .kernel_file = "effect/motion_groups.cl",
    .pair_fields = {&field_mover},
    .particle_fields = {&field_mover, &field_movers},
};

const law law_rotation_spin = {
    .name = "spin",
    .slot = SLOT_ROTATION,
    .doc = "Spin and torque.",
    .source = "TM Eq. 1",
    .kernel_file = "effect/rotation_spin.cl",
    .pair_fields = {&field_spin, &field_torque},
    .particle_fields = {&field_spin, &field_torque},
};

/* The array of torques also holds what steps in mixed precision by blocks keep of a record (kernels/stage/wrenches_together.cl). */
static const field field_torque_of_8 = {"torque", PER_RECORD, FIELD_REAL, 8, FIELD_RESULT, "N m", "force, lever of friction and arms of a record side by side; where they are asked for, torques as without"};
static const field field_torque_of_12 = {"torque", PER_RECORD, FIELD_REAL, 12, FIELD_RESULT, "N m", "force and both torques of a record side by side; where they are asked for, torques as without"};

const law law_rotation_wrenches = {
    .name = "spin",
    .slot = SLOT_ROTATION,
    .doc = "Spin and torque; what a record gives its two grains stands side by side.",
    .source = "TM Eq. 1",
    .kernel_file = "effect/wrench_of_8.cl",
    .more_files = {"effect/rotation_spin.cl"},
    .pair_fields = {&field_spin, &field_torque_of_8},
    .particle_fields = {&field_spin, &field_torque_of_8},
};

const law law_rotation_wrenches_moment = {
    .name = "spin",
    .slot = SLOT_ROTATION,
    .doc = "Spin and torque; what a record gives its two grains, a moment too, stands side by side.",
    .source = "TM Eq. 1",
    .kernel_file = "effect/wrench_of_12.cl",
    .more_files = {"effect/rotation_spin.cl"},
    .pair_fields = {&field_spin, &field_torque_of_12},
    .particle_fields = {&field_spin, &field_torque_of_12},
};

const law law_walls_planes = {
    .name = "planes",
    .slot = SLOT_WALLS,
    .doc = "Infinite planes, at rest or moving.",
    .source = "TM Remark 1",
    .kernel_file = "effect/walls_common.cl",
    .more_files = {"effect/walls_planes.cl"},
    .pair_fields = {&field_faces},
};

const law law_walls_finite = {
    .name = "finite",
    .slot = SLOT_WALLS,
    .doc = "Planes, rectangles and discs, at rest or moving; a shared edge gives one contact.",
    .source = "TM Remark 1",
    .kernel_file = "effect/walls_common.cl",
    .more_files = {"effect/walls_flat.cl", "effect/walls_finite.cl"},
    .pair_fields = {&field_faces},
};

const law law_walls_round = {
    .name = "round",
    .slot = SLOT_WALLS,
    .doc = "Cylinders and cones, beside planes, rectangles and discs, at rest or moving.",
    .source = "TM Remark 1",
    .kernel_file = "effect/walls_common.cl",
    .more_files = {"effect/walls_round.cl", "effect/walls_finite.cl"},
    .pair_fields = {&field_faces},
};

const law law_orientation_quaternion = {
    .name = "quaternion",
    .slot = SLOT_ORIENTATION,
    .doc = "Orientation by unit quaternions.",
    .source = "replaces TM Eq. 45, which is singular at half a turn",
    .kernel_file = "effect/orientation_quaternion.cl",
    .particle_fields = {&field_orientation},
};

const law law_semi_implicit_euler = {
    .name = "semi_implicit_euler",
    .slot = SLOT_INTEGRATOR,
    .doc = "Velocity first, then position with the new velocity.",
    .source = "TM sec. 4",
    .kernel_file = "effect/integrator_semi_implicit_euler.cl",
};

const law law_velocity_verlet = {
    .name = "velocity_verlet",
    .slot = SLOT_INTEGRATOR,
    .doc = "Leapfrog: velocities half a step behind the positions; laws are given the extrapolated one.",
    .source = "Swope et al. 1982",
    .kernel_file = "effect/integrator_velocity_verlet.cl",
    .more_files = {"effect/integrator_no_spin.cl"},
    .pair_fields = {&field_half_velocity},
    .particle_fields = {&field_half_velocity},
};

const law law_velocity_verlet_spin = {
    .name = "velocity_verlet",
    .slot = SLOT_INTEGRATOR,
    .doc = "Leapfrog: velocities and spins half a step behind the positions; laws are given the extrapolated ones.",
    .source = "Swope et al. 1982",
    .kernel_file = "effect/integrator_velocity_verlet.cl",
    .more_files = {"effect/integrator_half_spin.cl"},
    .pair_fields = {&field_half_velocity, &field_half_spin},
    .particle_fields = {&field_half_velocity, &field_half_spin},
};
