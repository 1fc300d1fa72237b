#include "scene_table.h"

#include <math.h>

/* One row a key reads better than one line a field. */
/* clang-format off */

/* Shorthands for the rows below. */
#define AT(type, member) .offset = offsetof(type, member)
#define POSITIVE .low = 0, .high = INFINITY, .open_low = true
#define NOT_NEGATIVE .low = 0, .high = INFINITY

static const parameter domain_rows[] = {
    {.key = "low_m", .type = PARAMETER_VECTOR, .unit = "m", .required = true, AT(domain, low_m), .doc = "lower corner"},
    {.key = "high_m", .type = PARAMETER_VECTOR, .unit = "m", .required = true, AT(domain, high_m), .doc = "upper corner"},
    {.key = "periodic", .type = PARAMETER_FLAGS, .choices = "x|y|z", AT(domain, periodic), .shown = "[]",
     .doc = "directions in which the domain repeats; walls do not: each goes on along the whole of such a direction, or keeps a grain's radius away from its ends"},
    {.key = "leaving", .type = PARAMETER_CHOICE, .choices = "stop|delete", .fallback = "stop", AT(domain, delete_leaving), .as_flag = true,
     .doc = "what happens when a particle leaves the domain: the run stops, or the particle is deleted and counted"},
    {0},
};
const section domain_section = {.name = "domain", .doc = "The box that holds the particles. Without it space is unbounded.",
                                .row = domain_rows,
                                .placed = true, .at = offsetof(domain, at), .finish = finish_domain};

static const parameter gas_rows[] = {
    {.key = "velocity_m_s", .type = PARAMETER_OTHER, .read = read_vector_anywhere, .unit = "m/s", AT(environment, gas_velocity_m_s),
     .form = "[x, y, z], or table", .shown = "`[0, 0, 0]`", .doc = "velocity, a vector or a table of vectors in time or along an axis"},
    {0},
};
const section gas_section = {.name = "gas", .doc = "The gas around the particles. It heats and cools, and does not drag.", .row = gas_rows,
                             .properties = gas_properties, .values = offsetof(environment, gas)};

static const parameter environment_rows[] = {
    {.key = "temperature_k", .type = PARAMETER_OTHER, .read = read_number_anywhere, .unit = "K", POSITIVE, AT(environment, temperature_k),
     .form = "number, or table", .shown = "none", .doc = "temperature, a number or a table in time or along an axis"},
    {.key = "gas", .type = PARAMETER_SECTION, .section = &gas_section, .offset = 0, .shown = "none", .doc = "the gas"},
    {0},
};
const section environment_section = {.name = "environment", .doc = "What surrounds the particles, for convection and radiation.",
                                     .row = environment_rows};

/* For the reference alone: read_effects makes its own rows, which hold the law's options too. */
static const parameter effect_rows[] = {
    {.key = "slot", .type = PARAMETER_OTHER, .form = "name of a slot", .required = true, .doc = "the slot that the law fills"},
    {.key = "law", .type = PARAMETER_OTHER, .form = "name of a law", .required = true, .doc = "the law"},
    {.key = "name", .type = PARAMETER_NAME, .doc = "a name, where a slot takes several entries", AT(effect, name)},
    {0},
};
const section effect_section = {.name = "effect",
                                .doc = "The live laws, one entry a slot. Nothing else is simulated, and what is not listed costs nothing. "
                                       "Further keys are the law's options, below.",
                                .row = effect_rows, .placed = true, .at = offsetof(effect, at)};

static const parameter material_rows[] = {
    {.key = "name", .type = PARAMETER_NAME, .required = true, AT(material, name), .doc = "name of the material"},
    {0},
};
const section material_section = {.name = "material",
                                  .doc = "What the particles are made of. A property is needed where a live law reads it.",
                                  .row = material_rows, .properties = material_properties, .values = offsetof(material, value),
                                  .placed = true,
                                  .at = offsetof(material, at)};

static const parameter interaction_rows[] = {
    {.key = "between", .type = PARAMETER_OTHER, .read = read_between, .required = true, .form = "`default`, or [name, name]",
     .doc = "`default`, or a pair of materials, or a material and a wall"},
    {0},
};
const section interaction_section = {.name = "interaction",
                                     .doc = "What two bodies in contact share, by pair of materials or of a material and a wall. The pair's "
                                            "own entry counts first, then `default`, key by key. `restitution` and `normal_damping_ratio` say "
                                            "the same thing in two ways: of the two the closer entry's counts. A pair's own `friction_static` "
                                            "also hides `friction_dynamic` of `default`.",
                                     .row = interaction_rows, .properties = interaction_properties, .values = offsetof(interaction, value),
                                     .placed = true, .at = offsetof(interaction, at), .finish = finish_interaction};

static const parameter region_rows[] = {
    {.key = "low_m", .type = PARAMETER_VECTOR, .unit = "m", .required = true, AT(particle_group, region_low_m), .doc = "lower corner"},
    {.key = "high_m", .type = PARAMETER_VECTOR, .unit = "m", .required = true, AT(particle_group, region_high_m), .doc = "upper corner"},
    {0},
};
const section region_section = {.name = "region", .doc = "A box that holds whole spheres; it wraps where it spans a periodic direction.",
                                .row = region_rows,
                                .finish = finish_region};

static const parameter item_rows[] = {
    {.key = "position_m", .type = PARAMETER_VECTOR, .unit = "m", .required = true, AT(particle_item, position_m), .doc = "centre"},
    {.key = "radius_m", .type = PARAMETER_NUMBER, .unit = "m", .required = true, POSITIVE, AT(particle_item, radius_m), .doc = "radius"},
    {.key = "velocity_m_s", .type = PARAMETER_VECTOR, .unit = "m/s", .keep = true, .shown = "the group's", AT(particle_item, velocity_m_s),
     .doc = "velocity"},
    {.key = "spin_rad_s", .type = PARAMETER_VECTOR, .unit = "rad/s", .keep = true, .shown = "the group's", AT(particle_item, spin_rad_s),
     .doc = "angular velocity"},
    {.key = "temperature_k", .type = PARAMETER_NUMBER, .unit = "K", POSITIVE, .keep = true, .shown = "the group's",
     AT(particle_item, temperature_k), .doc = "temperature"},
    {.key = "scalar", .type = PARAMETER_NUMBER, .low = -INFINITY, .high = INFINITY, .keep = true, .shown = "the group's",
     AT(particle_item, scalar), .doc = "a scalar, such as a concentration"},
    {0},
};
const section item_section = {.name = "particle item", .doc = "One particle of a list.", .row = item_rows};

static const parameter radius_rows[] = {
    {.key = "distribution", .type = PARAMETER_CHOICE, .choices = "uniform|normal|lognormal|sieve", .required = true,
     .first = RADIUS_UNIFORM,
     AT(radius_spec, distribution), .doc = "how radii scatter"},
    {.key = "low", .type = PARAMETER_NUMBER, .unit = "m", .required = true, POSITIVE, .only = "uniform", AT(radius_spec, low),
     .doc = "smallest radius"},
    {.key = "high", .type = PARAMETER_NUMBER, .unit = "m", .required = true, POSITIVE, .only = "uniform", AT(radius_spec, high),
     .doc = "largest radius"},
    {.key = "mean", .type = PARAMETER_NUMBER, .unit = "m", .required = true, POSITIVE, .only = "normal|lognormal", AT(radius_spec, mean),
     .doc = "mean of the radius, before truncation"},
    {.key = "std", .type = PARAMETER_NUMBER, .unit = "m", .required = true, NOT_NEGATIVE, .only = "normal|lognormal", AT(radius_spec, std),
     .doc = "standard deviation of the radius, before truncation"},
    {.key = "truncate_sigmas", .type = PARAMETER_NUMBER, .fallback = "3", .low = 0, .high = 10, .open_low = true,
     .only = "normal|lognormal",
     AT(radius_spec, truncate_sigmas),
     .doc = "radii (lognormal: their logarithms) further from the mean than this many deviations are drawn again"},
    {.key = "mass_fraction", .type = PARAMETER_NUMBERS, .required = true, .low = 0, .high = 1,
     .only = "sieve", AT(radius_spec, mass_fraction),
     .count = offsetof(radius_spec, count), .doc = "mass between each size and the next as a fraction of the whole; the sum is 1"},
    {.key = "size_m", .type = PARAMETER_OTHER, .read = read_sieve_sizes, .unit = "m", .required = true, POSITIVE, .only = "sieve",
     AT(radius_spec, size_m), .form = "list of numbers",
     .doc = "radii that bound the fractions, rising, one more than there are fractions"},
    {0},
};
const section radius_section = {.name = "radius distribution", .doc = "A number gives every particle of the group the same radius.",
                                .selector = "distribution", .row = radius_rows, .finish = finish_radius};

static const parameter group_rows[] = {
    {.key = "name", .type = PARAMETER_NAME, .required = true, AT(particle_group, name), .doc = "name of the group"},
    {.key = "material", .type = PARAMETER_OTHER, .read = read_material, .required = true, AT(particle_group, material),
     .form = "name of a material", .doc = "what the particles are made of"},
    {.key = "generator", .type = PARAMETER_CHOICE, .choices = "list|lattice|random|csv|result", .required = true,
     AT(particle_group, generator),
     .doc = "where particles come from: written out, on a lattice, at random without overlap, from a table, or from an earlier run's frame"},
    {.key = "velocity_m_s", .type = PARAMETER_VECTOR, .unit = "m/s", .fallback = "[0, 0, 0]", AT(particle_group, velocity_m_s),
     .doc = "velocity at the start, where the generator gives none"},
    {.key = "velocity_spread_m_s", .type = PARAMETER_NUMBER, .unit = "m/s", .low = 0.0, .high = 1e6, .fallback = "0", AT(particle_group, velocity_spread_m_s),
     .doc = "standard deviation of a normal distribution that is added to every component of the velocity, its mean over the group taken out"},
    {.key = "spin_rad_s", .type = PARAMETER_VECTOR, .unit = "rad/s", .fallback = "[0, 0, 0]", AT(particle_group, spin_rad_s),
     .doc = "angular velocity at the start, where the generator gives none"},
    {.key = "temperature_k", .type = PARAMETER_OTHER, .read = read_group_temperature, .unit = "K", POSITIVE, AT(particle_group, temperature_k),
     .absent = NAN, .form = "number, or table in time", .shown = "none",
     .doc = "temperature at the start, where the generator gives none; with `thermal: prescribed` the temperature, which may be a table in "
            "time"},
    {.key = "thermal", .type = PARAMETER_CHOICE, .choices = "free|prescribed|flux", .fallback = "free", AT(particle_group, thermal),
     .doc = "the temperature is free; or it is as `temperature_k` prescribes; or it is free and `heat_flux_w` heats"},
    {.key = "heat_flux_w", .type = PARAMETER_NUMBER, .unit = "W", AT(particle_group, heat_flux_w),
     .doc = "with `thermal: flux`: heat into each particle"},
    {.key = "scalar", .type = PARAMETER_NUMBER, .low = -INFINITY, .high = INFINITY, .fallback = "0", AT(particle_group, scalar),
     .doc = "a scalar that a bond criterion looks at, such as a concentration, where the generator gives none"},
    {.key = "items", .type = PARAMETER_OTHER, .read = read_items, .required = true, .only = "list", .form = "list of particle items",
     .doc = "the particles"},
    {.key = "count", .type = PARAMETER_INTEGER, .required = true, .low = 0, .high = 2e9, .only = "random", AT(particle_group, count),
     .doc = "number of particles"},
    {.key = "radius_m", .type = PARAMETER_OTHER, .read = read_radius, .required = true, .unit = "m", POSITIVE, .only = "random|lattice",
     AT(particle_group, radius_m), .form = "number or radius distribution", .doc = "radius"},
    {.key = "radius_m", .type = PARAMETER_OTHER, .read = read_radius, .unit = "m", POSITIVE, .only = "csv", AT(particle_group, radius_m),
     .form = "number or radius distribution", .doc = "radius, where the table has no such column"},
    {.key = "region", .type = PARAMETER_SECTION, .section = &region_section, .only = "random", .shown = "the domain",
     .given = offsetof(particle_group, region_given), .doc = "where the particles lie"},
    {.key = "lattice", .type = PARAMETER_CHOICE, .choices = "simple_cubic|hexagonal|triangular", .fallback = "simple_cubic",
     .only = "lattice",
     AT(particle_group, lattice),
     .doc = "simple cubic; hexagonal close packing in layers along z; or triangular layers in the x-z plane, repeated along y (with "
            "`dimensions: 2` in the x-y plane)"},
    {.key = "counts", .type = PARAMETER_COUNTS, .required = true, .low = 1, .high = 1e9, .only = "lattice", AT(particle_group, counts),
     .form = "three whole numbers",
     .doc = "particles along a row, number of rows, number of layers; triangular: along x, along y, along z"},
    {.key = "spacing_m", .type = PARAMETER_NUMBER, .unit = "m", .required = true, POSITIVE,
     .only = "lattice", AT(particle_group, spacing_m),
     .doc = "distance between neighbours"},
    {.key = "origin_m", .type = PARAMETER_VECTOR, .unit = "m", .fallback = "[0, 0, 0]", .only = "lattice", AT(particle_group, origin_m),
     .doc = "centre of the first particle"},
    {.key = "file", .type = PARAMETER_OTHER, .read = read_file, .required = true, .only = "csv|result", AT(particle_group, path),
     .form = "path", .doc = "the file, relative to the scene's folder"},
    {.key = "frame", .type = PARAMETER_INTEGER, .fallback = "-1", .low = -1, .high = 1e15, .only = "result", AT(particle_group, frame),
     .doc = "frame of the results file, counted from 0; -1 is the last"},
    {.key = "motion", .type = PARAMETER_OTHER, .read = read_group_motion, .shown = "free", AT(particle_group, motion),
     .form = "`free`, `fixed`, or list of motion terms", .doc = "free; held where it is; or moved as prescribed, the terms adding up"},
    {0},
};
const section group_section = {.name = "particle group", .doc = "Groups of particles.", .selector = "generator", .row = group_rows,
                               .placed = true,
                               .at = offsetof(particle_group, at)};

static const parameter motion_rows[] = {
    {.key = "type", .type = PARAMETER_CHOICE, .choices = "constant|sinusoid|rotation|table", .required = true, AT(motion, type),
     .doc = "kind of motion"},
    {.key = "velocity_m_s", .type = PARAMETER_VECTOR, .unit = "m/s", .required = true, .only = "constant", AT(motion, velocity_m_s),
     .doc = "velocity"},
    {.key = "direction", .type = PARAMETER_DIRECTION, .required = true, .only = "sinusoid", AT(motion, direction), .doc = "direction"},
    {.key = "amplitude_m", .type = PARAMETER_NUMBER, .unit = "m", .required = true, NOT_NEGATIVE,
     .only = "sinusoid", AT(motion, amplitude_m),
     .doc = "amplitude A of the displacement A sin(2 pi f t + phase)"},
    {.key = "frequency_hz", .type = PARAMETER_NUMBER, .unit = "Hz", .required = true, NOT_NEGATIVE,
     .only = "sinusoid", AT(motion, frequency_hz),
     .doc = "frequency f"},
    {.key = "phase_rad", .type = PARAMETER_NUMBER, .unit = "rad", .fallback = "0", .only = "sinusoid", AT(motion, phase_rad),
     .doc = "phase"},
    {.key = "point_m", .type = PARAMETER_VECTOR, .unit = "m", .required = true, .only = "rotation", AT(motion, point_m),
     .doc = "a point on the axis"},
    {.key = "axis", .type = PARAMETER_DIRECTION, .required = true, .only = "rotation", AT(motion, axis), .doc = "direction of the axis"},
    {.key = "rate_rad_s", .type = PARAMETER_NUMBER, .unit = "rad/s", .required = true, .only = "rotation", AT(motion, rate_rad_s),
     .doc = "angular velocity, right-handed about the axis"},
    {.key = "time_s", .type = PARAMETER_NUMBERS, .unit = "s", .required = true, .only = "table", AT(motion, time_s),
     .count = offsetof(motion, count), .doc = "times, rising"},
    {.key = "velocity_m_s", .type = PARAMETER_OTHER, .read = read_table_velocity, .unit = "m/s", .required = true, .only = "table",
     .form = "list of [x, y, z]", .doc = "velocity at those times, linear between them and constant outside"},
    {0},
};
const section motion_section = {.name = "motion term", .doc = "One term of a prescribed motion; the terms of a list add up.",
                                .selector = "type",
                                .row = motion_rows, .finish = finish_motion};

static const parameter servo_rows[] = {
    {.key = "direction", .type = PARAMETER_DIRECTION, .required = true, AT(servo_spec, direction),
     .doc = "direction in which the wall presses on the bed, and along which it moves"},
    {.key = "pressure_pa", .type = PARAMETER_NUMBER, .unit = "Pa", POSITIVE, AT(servo_spec, pressure_pa),
     .doc = "pressure to keep: the force is this times the area that faces the bed"},
    {.key = "force_n", .type = PARAMETER_NUMBER, .unit = "N", POSITIVE, AT(servo_spec, force_n), .doc = "force to keep, instead of a pressure"},
    {.key = "area_m2", .type = PARAMETER_NUMBER, .unit = "m^2", POSITIVE, AT(servo_spec, area_m2),
     .shown = "of rectangles, discs and boxes as seen along the direction; of a plane the cross-section of the one box or cylinder around the "
              "bed, else of the domain",
     .doc = "area that faces the bed"},
    {.key = "speed_max_m_s", .type = PARAMETER_NUMBER, .unit = "m/s", .required = true, POSITIVE, AT(servo_spec, speed_max_m_s),
     .doc = "speed at which the wall runs while it meets nothing, and never faster; the smaller, the gentler"},
    {.key = "travel_max_m", .type = PARAMETER_NUMBER, .unit = "m", POSITIVE, AT(servo_spec, travel_max_m),
     .shown = "to the far end of the bed as generated", .doc = "way, in either sense, after which a guard stops the run"},
    {0},
};
const section servo_section = {.name = "servo", .doc = "A wall, or a group of walls, that moves to keep a force (see the theory page).",
                               .row = servo_rows, .finish = finish_servo};

static const parameter wall_group_rows[] = {
    {.key = "name", .type = PARAMETER_NAME, .required = true, AT(wall_group, name), .doc = "name of the group"},
    {.key = "motion", .type = PARAMETER_OTHER, .read = read_motion, .shown = "[]", AT(wall_group, motion), .form = "list of motion terms",
     .doc = "prescribed motion of all its walls"},
    {.key = "servo", .type = PARAMETER_SECTION, .section = &servo_section, AT(wall_group, servo.spec), .given = offsetof(wall_group, servo.given),
     .doc = "keeps the sum of the forces on its walls, or a pressure times the sum of their areas"},
    {0},
};
const section wall_group_section = {.name = "wall group", .doc = "Walls that move together, as one body.", .row = wall_group_rows,
                                    .placed = true, .at = offsetof(wall_group, at)};

static const parameter wall_rows[] = {
    {.key = "name", .type = PARAMETER_NAME, .required = true, AT(wall, name),
     .doc = "name of the wall, used like a material's in `between`"},
    {.key = "shape", .type = PARAMETER_CHOICE, .choices = "plane|box|rectangle|disc|cylinder|cone", .required = true,
     AT(wall, shape), .doc = "shape of the wall"},
    {.key = "point_m", .type = PARAMETER_VECTOR, .unit = "m", .required = true, .only = "plane", AT(wall, point_m),
     .doc = "a point of the plane"},
    {.key = "normal", .type = PARAMETER_DIRECTION, .required = true, .only = "plane|disc", AT(wall, normal),
     .doc = "normal; a plane's points to the side of the particles"},
    {.key = "low_m", .type = PARAMETER_VECTOR, .unit = "m", .required = true, .only = "box", AT(wall, low_m), .doc = "lower corner"},
    {.key = "high_m", .type = PARAMETER_VECTOR, .unit = "m", .required = true, .only = "box", AT(wall, high_m), .doc = "upper corner"},
    {.key = "open", .type = PARAMETER_FLAGS, .choices = "x_low|x_high|y_low|y_high|z_low|z_high", .only = "box", AT(wall, open),
     .shown = "[]",
     .doc = "faces left out; with `dimensions: 2` those along z are always left out"},
    {.key = "corners_m", .type = PARAMETER_OTHER, .read = read_corners, .unit = "m", .required = true, .only = "rectangle",
     .form = "three [x, y, z]", .doc = "a corner and its two neighbours; the sides must be perpendicular"},
    {.key = "center_m", .type = PARAMETER_VECTOR, .unit = "m", .required = true, .only = "disc", AT(wall, center_m), .doc = "centre"},
    {.key = "radius_m", .type = PARAMETER_NUMBER, .unit = "m", .required = true, POSITIVE, .only = "disc", AT(wall, radius_m),
     .doc = "radius"},
    {.key = "side", .type = PARAMETER_CHOICE, .choices = "inside|outside", .fallback = "inside", .only = "cylinder|cone", .as_flag = true,
     AT(wall, outside), .doc = "where the particles are; inside, the largest one must fit"},
    {.key = "axis_point_m", .type = PARAMETER_VECTOR, .unit = "m", .required = true, .only = "cylinder|cone", AT(wall, axis_point_m),
     .doc = "centre of the first end"},
    {.key = "axis", .type = PARAMETER_DIRECTION, .required = true, .only = "cylinder|cone", AT(wall, axis),
     .doc = "direction from the first end to the other"},
    {.key = "radius_m", .type = PARAMETER_NUMBER, .unit = "m", .required = true, POSITIVE, .only = "cylinder", AT(wall, radii_m),
     .doc = "radius"},
    {.key = "radius_m", .type = PARAMETER_OTHER, .read = read_cone_radii, .unit = "m", .required = true, NOT_NEGATIVE, .only = "cone",
     AT(wall, radii_m), .form = "[first end, other end]", .doc = "radii at both ends; one of them may be 0"},
    {.key = "length_m", .type = PARAMETER_NUMBER, .unit = "m", .required = true, POSITIVE, .only = "cylinder|cone", AT(wall, length_m),
     .doc = "length along the axis; the ends are open"},
    {.key = "motion", .type = PARAMETER_OTHER, .read = read_motion, .shown = "[]", AT(wall, motion), .form = "list of motion terms",
     .doc = "prescribed motion; the terms add up"},
    {.key = "heat", .type = PARAMETER_CHOICE, .choices = "adiabatic", .shown = "adiabatic", AT(wall, heat.word),
     .given = offsetof(wall, heat.adiabatic), .doc = "no heat passes"},
    {.key = "temperature_k", .type = PARAMETER_OTHER, .read = read_number_in_time, .unit = "K", POSITIVE, AT(wall, heat.temperature_k),
     .form = "number, or table in time", .shown = "none", .doc = "prescribed temperature"},
    {.key = "heat_flux_w", .type = PARAMETER_NUMBER, .unit = "W", AT(wall, heat.flux_w), .shown = "none",
     .doc = "heat into the particles that touch the wall, shared among them by area of contact; none flows while none touches"},
    {.key = "servo", .type = PARAMETER_SECTION, .section = &servo_section, AT(wall, servo.spec), .given = offsetof(wall, servo.given),
     .doc = "lets the wall move so that it keeps a force or a pressure, beside its prescribed motion"},
    {.key = "group", .type = PARAMETER_OTHER, .read = read_wall_group, AT(wall, group), .form = "name of a wall group",
     .doc = "moves with the walls of this group; motion and servo are then the group's"},
    {0},
};
const section wall_section = {.name = "wall", .doc = "Rigid walls. They have no material: interactions name the wall.", .selector = "shape",
                              .row = wall_rows, .placed = true, .at = offsetof(wall, at), .finish = finish_wall};

static const parameter until_rows[] = {
    {.key = "time_s", .type = PARAMETER_NUMBER, .unit = "s", POSITIVE, AT(scene_stage, until_time_s), .doc = "duration of the stage"},
    {.key = "steps", .type = PARAMETER_INTEGER, .low = 1, .high = 1e15, .absent = -1, AT(scene_stage, until_steps),
     .doc = "number of steps"},
    {.key = "rest", .type = PARAMETER_NUMBER, POSITIVE, AT(scene_stage, until_rest),
     .doc = "translational kinetic energy below this fraction of the sum of m g r at 100 successive checks, 100 steps apart"},
    {.key = "rest_j", .type = PARAMETER_NUMBER, .unit = "J", POSITIVE, AT(scene_stage, until_rest_j),
     .doc = "the same with a limit in joules, for scenes without gravity"},
    {.key = "steady_k_s", .type = PARAMETER_NUMBER, .unit = "K/s", POSITIVE, AT(scene_stage, until_steady_k_s),
     .doc = "no temperature changes faster than this; where grains move, in the mean over 100 steps (of heat)"},
    {0},
};
const section until_section = {.name = "stage end (`until`)", .doc = "When a stage ends; with several keys the first one met ends it.",
                               .row = until_rows,
                               .finish = finish_until};

static const parameter wall_change_rows[] = {
    {.key = "name", .type = PARAMETER_OTHER, .read = read_wall, .required = true, AT(wall_change, wall), .form = "name of a wall",
     .doc = "the wall that changes"},
    {.key = "motion", .type = PARAMETER_OTHER, .read = read_motion, AT(wall_change, motion), .given = offsetof(wall_change, motion_given),
     .shown = "unchanged", .form = "list of motion terms", .doc = "its motion from now on; `[]` stops it"},
    {.key = "servo", .type = PARAMETER_OTHER, .read = read_changed_servo, AT(wall_change, servo), .shown = "unchanged", .form = "servo, or `off`",
     .doc = "its servo from now on; `off` lets it stand where it is"},
    {.key = "heat", .type = PARAMETER_CHOICE, .choices = "adiabatic", .shown = "unchanged", AT(wall_change, heat.word),
     .given = offsetof(wall_change, heat.adiabatic), .doc = "no heat passes"},
    {.key = "temperature_k", .type = PARAMETER_OTHER, .read = read_number_in_time, .unit = "K", POSITIVE, AT(wall_change, heat.temperature_k),
     .form = "number, or table in time", .shown = "unchanged", .doc = "prescribed temperature"},
    {.key = "heat_flux_w", .type = PARAMETER_NUMBER, .unit = "W", AT(wall_change, heat.flux_w), .shown = "unchanged",
     .doc = "heat into the particles that touch the wall, shared among them by area of contact; none flows while none touches"},
    {0},
};
const section wall_change_section = {.name = "wall change",
                                     .doc = "Interaction properties given here hold between this wall and every material.",
                                     .row = wall_change_rows, .properties = interaction_properties, .values = offsetof(wall_change, value)};

static const parameter wall_group_change_rows[] = {
    {.key = "name", .type = PARAMETER_OTHER, .read = read_wall_group, .required = true, AT(wall_group_change, group),
     .form = "name of a wall group", .doc = "the group that changes"},
    {.key = "motion", .type = PARAMETER_OTHER, .read = read_motion, AT(wall_group_change, motion), .given = offsetof(wall_group_change, motion_given),
     .shown = "unchanged", .form = "list of motion terms", .doc = "its motion from now on; `[]` stops it"},
    {.key = "servo", .type = PARAMETER_OTHER, .read = read_changed_servo, AT(wall_group_change, servo), .shown = "unchanged",
     .form = "servo, or `off`", .doc = "its servo from now on; `off` lets it stand where it is"},
    {0},
};
const section wall_group_change_section = {.name = "wall group change", .doc = "A change of a wall group's motion.", .row = wall_group_change_rows};

static const parameter group_change_rows[] = {
    {.key = "name", .type = PARAMETER_OTHER, .read = read_group, .required = true, AT(group_change, group),
     .form = "name of a particle group",
     .doc = "the group that changes"},
    {.key = "motion", .type = PARAMETER_OTHER, .read = read_changed_motion, .required = true, AT(group_change, motion),
     .form = "`free`, `fixed`, or list of motion terms", .doc = "its motion from now on"},
    {0},
};
const section group_change_section = {.name = "particle group change", .doc = "A change of a group's motion.", .row = group_change_rows};

static const parameter change_rows[] = {
    {.key = "gravity_m_s2", .type = PARAMETER_VECTOR, .unit = "m/s^2", .shown = "unchanged", AT(scene_stage, gravity_m_s2),
     .given = offsetof(scene_stage, gravity_given), .doc = "gravity"},
    {.key = "walls", .type = PARAMETER_LIST, .section = &wall_change_section, .size = sizeof(wall_change), AT(scene_stage, wall_change),
     .count = offsetof(scene_stage, wall_change_count), .doc = "walls whose motion or interactions change"},
    {.key = "wall_groups", .type = PARAMETER_LIST, .section = &wall_group_change_section, .size = sizeof(wall_group_change),
     AT(scene_stage, wall_group_change), .count = offsetof(scene_stage, wall_group_change_count), .doc = "wall groups whose motion changes"},
    {.key = "particles", .type = PARAMETER_LIST, .section = &group_change_section,
     .size = sizeof(group_change), AT(scene_stage, group_change),
     .count = offsetof(scene_stage, group_change_count), .doc = "particle groups whose motion changes"},
    {.key = "interactions", .type = PARAMETER_LIST, .section = &interaction_section,
     .size = sizeof(interaction), AT(scene_stage, interaction),
     .count = offsetof(scene_stage, interaction_count), .doc = "interactions laid over the scene's, pair by pair and key by key"},
    {0},
};
const section change_section = {.name = "stage change", .doc = "What changes at the start of a stage; it stays so in later stages.",
                                .row = change_rows};

static const parameter stage_heat_rows[] = {
    {.key = "method", .type = PARAMETER_CHOICE, .choices = "stabilised|implicit|steady|explicit", .fallback = "stabilised",
     AT(scene_stage, heat_method), .doc = "how temperatures advance while nothing moves: `stabilised` takes steps of RKL2 with error control, "
     "`implicit` steps of SDIRK2 with error control, `steady` goes to the steady state at once, `explicit` takes steps of Euler's method at the "
     "thermal limit"},
    {.key = "tolerance", .type = PARAMETER_NUMBER, .low = 1e-12, .high = 0.1, .fallback = "1e-6", AT(scene_stage, heat_tolerance),
     .doc = "error of a step, as a share of the range of temperatures (initial, walls, environment and prescribed ones)"},
    {.key = "every_steps", .type = PARAMETER_INTEGER, .low = 1, .high = 1000000, .fallback = "1", AT(scene_stage, heat_every),
     .doc = "where grains move: temperatures advance in every n-th step, from what contacts bring in all of them"},
    {0},
};
const section stage_heat_section = {.name = "heat of a stage", .doc = "How heat advances: `method` and `tolerance` in a stage with `motion: frozen`, `every_steps` in others.", .row = stage_heat_rows};

static const parameter stage_repeat_rows[] = {
    {.key = "from", .type = PARAMETER_NAME, .required = true, AT(scene_stage, repeat_from), .doc = "the earlier stage to go back to"},
    {.key = "until_change", .type = PARAMETER_NUMBER, .low = 1e-12, .high = 1.0, AT(scene_stage, repeat_change), .shown = "none where `rounds` is given, else 1e-3",
     .doc = "the rounds end when no temperature has changed by more than this share of the range of temperatures between the ends of two rounds"},
    {.key = "rounds", .type = PARAMETER_INTEGER, .low = 1, .high = 1000000, .absent = -1, AT(scene_stage, repeat_rounds), .shown = "100",
     .doc = "number of rounds; with `until_change` the largest"},
    {0},
};
const section stage_repeat_section = {.name = "repetition of stages", .doc = "Rounds of stages: heat while nothing moves and motion with the moduli and radii that it leaves, say.",
                                      .row = stage_repeat_rows};

static const parameter stage_rows[] = {
    {.key = "name", .type = PARAMETER_NAME, .shown = "stage1, stage2, ...", AT(scene_stage, name), .doc = "name of the stage"},
    {.key = "until", .type = PARAMETER_SECTION, .section = &until_section, .required = true,
     .doc = "when the stage ends: `time_s`, `steps`, `rest`, `rest_j` or `steady_k_s`"},
    {.key = "step_s", .type = PARAMETER_NUMBER, .unit = "s", POSITIVE, .word = "auto", .fallback = "auto", AT(scene_stage, step_s),
     .doc = "time step"},
    {.key = "allow_unstable_step", .type = PARAMETER_FLAG, .fallback = "false", AT(scene_stage, allow_unstable_step),
     .doc = "run even with a step beyond the stability limit"},
    {.key = "motion", .type = PARAMETER_CHOICE, .choices = "free|frozen", .fallback = "free", AT(scene_stage, frozen), .as_flag = true,
     .doc = "`frozen`: nothing moves and only temperatures change, with steps of their own; velocities are kept for later stages"},
    {.key = "heat", .type = PARAMETER_SECTION, .section = &stage_heat_section, .doc = "how heat advances"},
    {.key = "change", .type = PARAMETER_SECTION, .section = &change_section, .doc = "what changes at the start of the stage"},
    {.key = "effects_off", .type = PARAMETER_OTHER, .read = read_effects_off, .shown = "[]", .form = "list of slots",
     .doc = "slots whose law is switched off during this stage"},
    {.key = "repeat", .type = PARAMETER_SECTION, .section = &stage_repeat_section, .shown = "no",
     .doc = "at its end goes back to an earlier stage, round by round, until temperatures stand"},
    {0},
};
const section stage_section = {.name = "stage", .doc = "What is run, one stage after the other; time runs on.", .row = stage_rows,
                               .placed = true,
                               .at = offsetof(scene_stage, at)};

static const parameter output_rows[] = {
    {.key = "every_s", .type = PARAMETER_NUMBER, .unit = "s", POSITIVE, .shown = "start and stage ends only", AT(output_spec, every_s),
     .doc = "time between frames"},
    {.key = "fields", .type = PARAMETER_WORDS, AT(output_spec, fields), .count = offsetof(output_spec, field_count),
     .shown = "[position, velocity], and spin where a tangential or rolling law is live", .doc = "per-particle fields of a frame"},
    {.key = "observables", .type = PARAMETER_WORDS, AT(output_spec, observables), .count = offsetof(output_spec, observable_count),
     .shown = "[kinetic_energy]", .doc = "numbers of the scene as a whole; each wall's force and torque are always written"},
    {.key = "observables_every_s", .type = PARAMETER_NUMBER, .unit = "s", POSITIVE, .shown = "with the frames",
     AT(output_spec, observables_every_s), .doc = "time between observations"},
    {.key = "contacts", .type = PARAMETER_FLAG, .fallback = "false", AT(output_spec, contacts),
     .doc = "write the contacts with every frame"},
    {.key = "checkpoint_every_s", .type = PARAMETER_NUMBER, .unit = "s", POSITIVE, .shown = "only when interrupted or stopped by a guard",
     AT(output_spec, checkpoint_every_s), .doc = "time between checkpoints"},
    {0},
};
const section output_section = {.name = "output", .doc = "What the results file holds.", .row = output_rows};

static const parameter table_rows[] = {
    {.key = "skin_m", .type = PARAMETER_NUMBER, .unit = "m", POSITIVE, .word = "auto", .fallback = "auto", AT(table_spec, skin_m),
     .doc = "pairs up to this far apart are listed, so that the list lasts for many steps"},
    {.key = "batch_steps", .type = PARAMETER_INTEGER, .low = 1, .high = 1e9, .word = "auto",
     .fallback = "auto", AT(table_spec, batch_steps),
     .doc = "steps enqueued before the host looks"},
    {.key = "step_form", .type = PARAMETER_CHOICE, .choices = "auto|two_kernels|one_group|phases|team", .fallback = "auto", AT(table_spec, step_form),
     .doc = "a launch for each stage and chunk; or many steps in one launch by one work-group, or by a team of one for every core, or a launch for each"
            " phase of such a team's step; `auto` takes what is fastest at the moment, and results are the same"},
    {.key = "kernel_form", .type = PARAMETER_CHOICE, .choices = "auto|items|blocks", .fallback = "auto", AT(table_spec, kernel_form),
     .doc = "a work-item takes one contact or grain, as GPUs want it, or a block of them, as CPUs do; `auto` goes by the device, and results are"
            " the same"},
    {.key = "chunk_records", .type = PARAMETER_INTEGER, .low = 1, .high = 1e9, .word = "auto",
     .fallback = "auto", AT(table_spec, chunk_records),
     .doc = "records of pairs that go through a step together, so that their forces stay in the cache (rounded up to a power of two; as many as"
            " there are: all at once); `auto`: chunks for large beds on a CPU"},
    {0},
};
const section table_section = {.name = "contact table", .doc = "How contacts are searched. Changes speed, not results.", .row = table_rows};

static const parameter guard_rows[] = {
    {.key = "every_steps", .type = PARAMETER_INTEGER, .fallback = "100", .low = 0, .high = 1e9, AT(guard_spec, every_steps),
     .doc = "steps between checks; 0 switches the guards off"},
    {.key = "overlap_max", .type = PARAMETER_NUMBER, .fallback = "0.3", .low = 0, .high = 2, .open_low = true, AT(guard_spec, overlap_max),
     .doc = "largest overlap, as a fraction of the smaller radius"},
    {.key = "move_max", .type = PARAMETER_NUMBER, .fallback = "0.5", .low = 0, .high = 1e6, .open_low = true, AT(guard_spec, move_max),
     .doc = "largest move in one step, as a fraction of the skin (of a tenth of the mean radius, where the skin is smaller)"},
    {0},
};
const section guard_section = {.name = "guards", .doc = "Checks that stop a run that goes wrong.", .row = guard_rows};

static const parameter closed_form_rows[] = {
    {.key = "answer", .type = PARAMETER_TEXT, .required = true, AT(closed_form, answer),
     .doc = "one of the answers, with its component where it has several: `particles[pair].items[0].velocity.x`"},
    {.key = "time_s", .type = PARAMETER_NUMBERS, .unit = "s", .required = true, .low = 0, .high = 1e30, AT(closed_form, time_s),
     .count = offsetof(closed_form, time_count), .doc = "times, which must be among those at which answers are compared"},
    {.key = "value", .type = PARAMETER_NUMBERS, .required = true, AT(closed_form, value), .count = offsetof(closed_form, value_count),
     .doc = "what the formula gives at these times"},
    {0},
};
const section closed_form_section = {.name = "closed form", .doc = "What a formula gives for an answer; the error of that answer is measured against it.",
                                     .row = closed_form_rows, .placed = true, .at = offsetof(closed_form, at)};

static const parameter study_rows[] = {
    {.key = "answers", .type = PARAMETER_WORDS, AT(study_spec, answers), .count = offsetof(study_spec, answer_count), .shown = "[]",
     .doc = "what a study compares: an observable (`kinetic_energy`, `walls[floor].force.z`), a field of one grain "
            "(`particles[pair].items[0].velocity`) or of all grains of a group (`particles[bed].temperature`), with `.x` behind it for a component"},
    {.key = "set", .type = PARAMETER_WORDS, AT(study_spec, set), .count = offsetof(study_spec, set_count), .shown = "[]",
     .doc = "settings in the form of `--set` that a study lays over the scene, as to make it smaller"},
    {.key = "samples", .type = PARAMETER_INTEGER, .low = 1, .high = 100000, .fallback = "10", AT(study_spec, samples),
     .doc = "times at which answers are compared, evenly spread over the run"},
    {.key = "seeds", .type = PARAMETER_INTEGER, .low = 0, .high = 1000, .fallback = "0", AT(study_spec, seeds),
     .doc = "for scenes that small differences change beyond recognition: answers are compared by their means over so many values of `seed`"},
    {.key = "average_from_s", .type = PARAMETER_NUMBER, .unit = "s", .low = 0, .high = 1e30, .shown = "the last sample alone",
     AT(study_spec, average_from_s), .doc = "with `seeds`: answers are averaged over the samples from this time on"},
    {.key = "closed_form", .type = PARAMETER_LIST, .section = &closed_form_section, .size = sizeof(closed_form), AT(study_spec, closed_form),
     .count = offsetof(study_spec, closed_form_count), .doc = "answers that a formula gives, where there is one"},
    {0},
};
const section study_section = {.name = "study", .doc = "What `clast study` looks at.", .row = study_rows};

static const parameter scene_rows[] = {
    {.key = "title", .type = PARAMETER_TEXT, .fallback = "", AT(scene, title), .doc = "title of the scene"},
    {.key = "dimensions", .type = PARAMETER_CHOICE, .choices = "2|3", .fallback = "3", .first = 2, AT(scene, dimensions),
     .doc = "2: motion in x and y (y is up), spin about z"},
    {.key = "seed", .type = PARAMETER_INTEGER, .fallback = "1", .low = 0, .high = 9007199254740992.0, AT(scene, seed),
     .doc = "everything random follows from it"},
    {.key = "gravity_m_s2", .type = PARAMETER_VECTOR, .unit = "m/s^2", .fallback = "[0, 0, 0]", AT(scene, gravity_m_s2), .doc = "gravity"},
    {.key = "precision", .type = PARAMETER_CHOICE, .choices = "auto|double|mixed", .fallback = "auto", AT(scene, precision),
     .doc = "arithmetic: `mixed` computes in float, needs no fp64, and keeps what float would lose in pairs of floats; `auto` is `double` on a device "
            "that has fp64, else `mixed`"},
    {.key = "integrator", .type = PARAMETER_CHOICE, .choices = "semi_implicit_euler|velocity_verlet",
     .fallback = "semi_implicit_euler", AT(scene, integrator), .doc = "how time advances"},
    {.key = "domain", .type = PARAMETER_SECTION, .section = &domain_section, AT(scene, domain), .given = offsetof(scene, domain.given),
     .shown = "unbounded", .doc = "the box that holds the particles"},
    {.key = "environment", .type = PARAMETER_SECTION, .section = &environment_section, AT(scene, environment), .shown = "none",
     .doc = "what surrounds the particles"},
    {.key = "effects", .type = PARAMETER_OTHER, .read = read_effects, .section = &effect_section, .shown = "[]", .form = "list of effects",
     .doc = "the live laws"},
    {.key = "materials", .type = PARAMETER_LIST, .section = &material_section, .size = sizeof(material), .required = true,
     AT(scene, material), .count = offsetof(scene, material_count), .doc = "what the particles are made of"},
    {.key = "wall_groups", .type = PARAMETER_LIST, .section = &wall_group_section, .size = sizeof(wall_group), AT(scene, wall_group),
     .count = offsetof(scene, wall_group_count), .shown = "[]", .doc = "groups of walls that move together"},
    {.key = "walls", .type = PARAMETER_LIST, .section = &wall_section, .size = sizeof(wall), AT(scene, wall),
     .count = offsetof(scene, wall_count), .shown = "[]", .doc = "rigid walls"},
    {.key = "interactions", .type = PARAMETER_LIST, .section = &interaction_section, .size = sizeof(interaction), AT(scene, interaction),
     .count = offsetof(scene, interaction_count), .shown = "[]", .doc = "what two bodies in contact share"},
    {.key = "particles", .type = PARAMETER_LIST, .section = &group_section, .size = sizeof(particle_group),
     .required = true, AT(scene, group),
     .count = offsetof(scene, group_count), .doc = "groups of particles"},
    {.key = "stages", .type = PARAMETER_LIST, .section = &stage_section, .size = sizeof(scene_stage), .required = true, AT(scene, stage),
     .count = offsetof(scene, stage_count), .doc = "what is run, one stage after the other"},
    {.key = "output", .type = PARAMETER_SECTION, .section = &output_section, AT(scene, output), .doc = "what the results file holds"},
    {.key = "contact_table", .type = PARAMETER_SECTION, .section = &table_section, AT(scene, table), .doc = "how contacts are searched"},
    {.key = "guards", .type = PARAMETER_SECTION, .section = &guard_section, AT(scene, guards),
     .doc = "checks that stop a run that goes wrong"},
    {.key = "study", .type = PARAMETER_SECTION, .section = &study_section, AT(scene, study), .doc = "what a study looks at"},
    {0},
};
const section scene_section = {.name = "scene", .doc = "The keys of a scene.", .row = scene_rows};
