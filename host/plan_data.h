/* A plan as plain data: collected once, then written as text or JSON. */
#ifndef CLAST_HOST_PLAN_DATA_H
#define CLAST_HOST_PLAN_DATA_H
#include "bond_figures.h"
#include "simulation.h"

/* A group of grains as generated. */
typedef struct plan_group {
    const particle_group *group;
    int64_t count;
    double radius_min, radius_max; /* m */
} plan_group;

typedef struct plan_stage {
    const scene_stage *stage;
    live_laws live;
    step_limit limit;
    double step_s; /* that a run takes at the stage's start; NAN: nothing sets it */
    double steps;  /* to the stage's end in time or steps at that step; NAN: known only by running */
} plan_stage;

typedef struct plan_field {
    const char *name;
    field_extent per;
    uint64_t bytes;
} plan_field;

typedef struct plan_arguments {
    const char *kernel;
    const char *name[64]; /* after launch and control */
    int count;
    uint64_t bytes; /* of all arguments, as a driver counts them */
} plan_arguments;

typedef struct plan_probe {
    bool done;
    int64_t steps;
    double wall_s, particle_steps_per_s;
    double expected_wall_s; /* of the whole run, frames left out; NAN where a stage's length is not known */
} plan_probe;

typedef struct plan {
    const scene *scene;
    const device_info *device;
    int64_t particles;
    int group_count;
    plan_group *group;
    double overlap_max; /* of the smaller radius, at the start */
    int64_t overlap_i, overlap_j;
    int stage_count;
    plan_stage *stage;
    double *biot_contact, *biot_surface; /* by material, the largest of all stages' starts; NULL without temperatures */
    char **unused; /* places in the scene, as --set writes them; ends with NULL */
    int field_count;
    plan_field field[SIMULATION_FIELDS_MAX];
    int bond_count;
    bond_figures *bond; /* of the first stage in which grains bond */
    uint64_t table_bytes, other_bytes, bytes;
    uint64_t packed_bytes; /* when the bed is packed densely: contacts and their table grow with a bed that settles */
    double skin_m;
    plan_arguments pair, particle;
    plan_probe probe;
} plan;

/* Places of the material and interaction properties that the scene gives and nothing in it uses. NULL: out of memory. The scene is changed
 * while this looks, and restored. */
char **plan_unused(scene *scene, const bed *bed);
void plan_write_text(const plan *p);
status plan_write_json(const plan *p, failure *why);
double plan_bytes_per_particle(const plan *p, uint64_t bytes);

#endif
