/* The rows of the scene: every section and key, and the names that output understands. */
#ifndef CLAST_HOST_SCENE_TABLE_H
#define CLAST_HOST_SCENE_TABLE_H
#include "parameter.h"

extern const section scene_section, domain_section, effect_section, material_section, interaction_section, group_section, region_section,
    item_section, radius_section, wall_section, servo_section, wall_group_section,
    wall_group_change_section, motion_section, stage_section, until_section, change_section, wall_change_section,
    group_change_section, output_section, table_section, guard_section, study_section, closed_form_section, environment_section, gas_section, quantity_section, property_table_section,
    stage_heat_section, stage_repeat_section, path_section;
/* Keys of every source besides its law's options; ends with a NULL key. */
extern const parameter beam_rows[];

/* A per-particle field or an observable that `output:` may list. */
typedef struct output_name {
    const char *name, *unit;
    int components;
    const char *needs; /* a law that this version lacks, or NULL */
    const char *doc;
} output_name;

/* Both end with a NULL name. */
extern const output_name output_fields[], output_observables[];

/* Readers of values that no plain type covers (host/scene_values.c, host/scene_motion.c). */
status read_effects(reader *r, const parameter *row, int node, void *target);
status read_effects_off(reader *r, const parameter *row, int node, void *target);
status read_between(reader *r, const parameter *row, int node, void *target);
status read_material(reader *r, const parameter *row, int node, void *target);
status read_wall(reader *r, const parameter *row, int node, void *target);
status read_group(reader *r, const parameter *row, int node, void *target);
status read_radius(reader *r, const parameter *row, int node, void *target);
status read_items(reader *r, const parameter *row, int node, void *target);
status read_sieve_sizes(reader *r, const parameter *row, int node, void *target);
status read_cone_radii(reader *r, const parameter *row, int node, void *target);
status read_corners(reader *r, const parameter *row, int node, void *target);
status read_file(reader *r, const parameter *row, int node, void *target);
status read_motion(reader *r, const parameter *row, int node, void *target);
status read_group_motion(reader *r, const parameter *row, int node, void *target);
status read_changed_motion(reader *r, const parameter *row, int node, void *target);
status read_group_temperature(reader *r, const parameter *row, int node, void *target);
/* host/scene_quantity.c: a number, or a table in time, or also along an axis. */
status read_number_in_time(reader *r, const parameter *row, int node, void *target);
status read_number_anywhere(reader *r, const parameter *row, int node, void *target);
status read_vector_anywhere(reader *r, const parameter *row, int node, void *target);
status read_wall_group(reader *r, const parameter *row, int node, void *target);
status read_changed_servo(reader *r, const parameter *row, int node, void *target);
status read_table_velocity(reader *r, const parameter *row, int node, void *target);

/* Checks over several keys of one section. */
status finish_domain(reader *r, int node, void *target);
status finish_region(reader *r, int node, void *target);
status finish_radius(reader *r, int node, void *target);
status check_wall_group(reader *r, int node, wall *wall);
status check_wall_groups(reader *r);
status finish_wall(reader *r, int node, void *target);
status finish_servo(reader *r, int node, void *target);
status finish_motion(reader *r, int node, void *target);
status finish_interaction(reader *r, int node, void *target);
status finish_until(reader *r, int node, void *target);

#endif
