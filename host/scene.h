/* A scene as the user wrote it, checked and complete: every number in SI, every name resolved. Plain data; nothing here knows of devices. */
#ifndef CLAST_HOST_SCENE_H
#define CLAST_HOST_SCENE_H
#include "law.h"
#include "status.h"

#include <stdint.h>

typedef struct place {
    int line, column; /* counted from 1; 0: not from the file */
} place;

typedef enum precision { PRECISION_AUTO, PRECISION_DOUBLE, PRECISION_MIXED } precision;
/* What `auto|double|mixed` names; false where it is none of them. */
bool precision_find(const char *word, precision *out);
struct scene;
/* What the scene runs in: `double` or `mixed`. */
const char *precision_name(const struct scene *scene);
typedef enum integrator { INTEGRATOR_SEMI_IMPLICIT_EULER, INTEGRATOR_VELOCITY_VERLET } integrator;

typedef struct domain {
    bool given;
    double low_m[3], high_m[3];
    bool periodic[3];
    bool delete_leaving;
    place at;
} domain;

typedef struct material {
    char *name;
    double *value; /* by index into material_properties(); NAN where absent */
    place at;
} material;

typedef struct interaction {
    bool is_default;
    char *between[2];
    double *value; /* by index into interaction_properties(); NAN where absent */
    place at;
} interaction;

/* A value that may vary: linear between the places of a table, constant outside. */
#define QUANTITY_PLACES_MAX 64 /* of a table along an axis: kernels look it up */
typedef enum quantity_kind { QUANTITY_NUMBER, QUANTITY_TIME, QUANTITY_AXIS } quantity_kind;
typedef struct quantity {
    bool given;
    quantity_kind kind;
    int components; /* 1 or 3 */
    double number[3];
    int axis, count;
    double *at;    /* s or m, rising */
    double *value; /* [count][components] */
} quantity;

#define SOURCES_MAX 64
/* Path of a source's beam: tables in time. */
typedef struct beam {
    double direction[3]; /* unit vector */
    quantity position, power;
} beam;

typedef struct effect {
    const law *law;
    char *name; /* of a source, else NULL */
    double option[LAW_OPTIONS_MAX];
    beam beam; /* of a source */
    place at;
} effect;

/* Value at a time or a place; NAN where the quantity is not given. */
double quantity_at(const quantity *q, double x);
double quantity_component(const quantity *q, double x, int component);
bool quantity_varies_in_time(const quantity *q);
double quantity_largest(const quantity *q);
void quantity_free(quantity *q);

/* What surrounds the bed. */
typedef struct environment {
    quantity temperature_k, gas_velocity_m_s;
    double *gas; /* by index into gas_properties(), or NULL */
} environment;

typedef enum thermal_kind { THERMAL_FREE, THERMAL_PRESCRIBED, THERMAL_FLUX } thermal_kind;

/* What a wall's entry, or a change of it, says about heat. */
typedef struct wall_heat {
    bool adiabatic; /* written out */
    int word;
    quantity temperature_k;
    double flux_w; /* NAN: not given */
} wall_heat;
typedef enum wall_heat_kind { WALL_HEAT_ADIABATIC, WALL_HEAT_TEMPERATURE, WALL_HEAT_FLUX } wall_heat_kind;
wall_heat_kind wall_heat_kind_of(const wall_heat *heat);

typedef enum motion_type { MOTION_CONSTANT, MOTION_SINUSOID, MOTION_ROTATION, MOTION_TABLE } motion_type;

/* One term; the terms of a list add up. */
typedef struct motion {
    motion_type type;
    double velocity_m_s[3];                            /* constant */
    double direction[3], amplitude_m, frequency_hz, phase_rad; /* sinusoid: displacement A sin(2 pi f t + phase) along the unit direction */
    double point_m[3], axis[3], rate_rad_s;            /* rotation, right-handed about the unit axis */
    int count;                                         /* table: velocity, linear between times, constant outside */
    double *time_s;
    double (*table_velocity_m_s)[3];
} motion;

typedef struct motion_list {
    int count;
    motion *term;
} motion_list;

typedef enum distribution { RADIUS_NUMBER, RADIUS_UNIFORM, RADIUS_NORMAL, RADIUS_LOGNORMAL, RADIUS_SIEVE } distribution;

typedef struct radius_spec {
    distribution distribution;
    double value;                  /* number */
    double low, high;              /* uniform */
    double mean, std, truncate_sigmas; /* normal, lognormal (mean and std of the radius itself) */
    int count;                     /* sieve: passing sizes and the mass fraction between each and the next */
    double *size_m;                /* count + 1 radii, rising */
    double *mass_fraction;         /* count, sum 1 */
} radius_spec;

typedef enum generator { GENERATOR_LIST, GENERATOR_LATTICE, GENERATOR_RANDOM, GENERATOR_CSV, GENERATOR_RESULT } generator;
typedef enum lattice { LATTICE_SIMPLE_CUBIC, LATTICE_HEXAGONAL, LATTICE_TRIANGULAR } lattice;

typedef struct particle_item {
    double position_m[3], velocity_m_s[3], spin_rad_s[3], radius_m, temperature_k, scalar; /* temperature NAN where absent */
} particle_item;

typedef struct particle_group {
    char *name;
    int material;
    generator generator;
    int64_t count; /* random: asked for; list: written; else 0, as only the generator knows it */
    radius_spec radius_m;
    bool region_given;
    double region_low_m[3], region_high_m[3];
    double velocity_spread_m_s; /* standard deviation of every component of the velocity */
    double velocity_m_s[3], spin_rad_s[3], temperature_k, scalar; /* temperature at the start, NAN where absent */
    quantity temperature;  /* the same as written: a prescribed one may be a table in time */
    thermal_kind thermal;
    double heat_flux_w;    /* into each particle; NAN where absent */
    int item_count;
    particle_item *item;
    lattice lattice;
    int64_t counts[3];
    double spacing_m, origin_m[3];
    char *path;  /* csv, result: already made relative to the scene file's folder */
    int64_t frame; /* result: -1 is the last */
    bool fixed;  /* motion: fixed */
    motion_list motion; /* prescribed when not fixed and count > 0, else free */
    place at;
} particle_group;

typedef enum wall_shape { WALL_PLANE, WALL_BOX, WALL_RECTANGLE, WALL_DISC, WALL_CYLINDER, WALL_CONE } wall_shape;

/* Keeps a force along a direction, or a pressure times an area; NAN where absent. */
typedef struct servo_spec {
    double direction[3], pressure_pa, force_n, area_m2, speed_max_m_s, travel_max_m;
} servo_spec;

typedef struct servo_choice {
    bool given, off;
    servo_spec spec;
} servo_choice;

/* Walls that move together. */
typedef struct wall_group {
    char *name;
    motion_list motion;
    servo_choice servo;
    place at;
} wall_group;

typedef struct wall {
    char *name;
    int group; /* -1: none */
    servo_choice servo;
    wall_shape shape;
    double point_m[3], normal[3];      /* plane (the normal points to the side of the particles), disc uses center_m and normal */
    double low_m[3], high_m[3];        /* box */
    bool open[6];                      /* x_low x_high y_low y_high z_low z_high */
    double corners_m[3][3];            /* rectangle: a corner and its two neighbours */
    double center_m[3], radius_m;      /* disc */
    bool outside;                      /* cylinder, cone: side on which the grains are */
    double axis_point_m[3], axis[3];   /* their first end, and the unit vector to the other */
    double radii_m[2], length_m;       /* radii at both ends */
    motion_list motion;
    wall_heat heat;
    place at;
} wall;

/* What a scene stage changes from its start on. */
typedef struct wall_change {
    int wall;
    bool motion_given;
    motion_list motion;
    servo_choice servo;
    wall_heat heat;
    double *value; /* interaction properties between every material and this wall; NAN: unchanged */
} wall_change;

typedef struct wall_group_change {
    int group;
    bool motion_given;
    motion_list motion;
    servo_choice servo;
} wall_group_change;

typedef struct group_change {
    int group;
    bool fixed, free;
    motion_list motion;
} group_change;

/* How heat advances while nothing moves. */
typedef enum heat_method { HEAT_STABILISED, HEAT_IMPLICIT, HEAT_STEADY, HEAT_EXPLICIT } heat_method;

typedef struct scene_stage {
    char *name;
    double until_time_s;    /* NAN: not given */
    int64_t until_steps;    /* -1 */
    double until_rest;      /* NAN */
    double until_rest_j;    /* NAN */
    double until_steady_k_s; /* NAN */
    double step_s;          /* NAN: auto */
    bool frozen;            /* nothing moves */
    heat_method heat_method;
    int64_t heat_every;     /* mechanical steps for one of heat, where grains move */
    double heat_tolerance;  /* of the temperature range, a step */
    bool allow_unstable_step;
    bool gravity_given;
    double gravity_m_s2[3];
    int wall_change_count;
    wall_change *wall_change;
    int wall_group_change_count;
    wall_group_change *wall_group_change;
    int group_change_count;
    group_change *group_change;
    int interaction_count;
    interaction *interaction; /* laid over the scene's: its values replace those of the same pair */
    bool slot_off[SLOT_COUNT];
    char *repeat_from;      /* NULL: the next stage follows */
    int repeat_index;       /* of that stage */
    double repeat_change;   /* of the range of temperatures */
    int64_t repeat_rounds;
    place at;
} scene_stage;

typedef struct output_spec {
    double every_s;              /* NAN: only t = 0 and the ends of the stages */
    int field_count;
    char **fields;
    int observable_count;
    char **observables;
    double observables_every_s;  /* NAN: with the frames */
    bool contacts;
    double checkpoint_every_s;   /* NAN: none but at an interrupt or a guard */
} output_spec;

/* See step_loop.c. */
typedef enum step_form { STEP_AUTO, STEP_TWO_KERNELS, STEP_ONE_GROUP, STEP_PHASES, STEP_TEAM } step_form;

/* A work-item of the two stages takes one record or grain, or a block of them. */
typedef enum kernel_form { KERNEL_AUTO, KERNEL_ITEMS, KERNEL_BLOCKS } kernel_form;

typedef struct table_spec {
    double skin_m;         /* NAN: auto */
    int64_t batch_steps;   /* 0: auto */
    step_form step_form;
    kernel_form kernel_form;
    int64_t chunk_records; /* 0: auto */
} table_spec;

typedef struct guard_spec {
    int64_t every_steps; /* 0: off */
    double overlap_max, move_max;
} guard_spec;

/* Values that an answer takes at known times, from a formula. */
typedef struct closed_form {
    char *answer; /* one number: a component where the answer has several */
    int time_count, value_count;
    double *time_s, *value;
    place at;
} closed_form;

/* What `clast study` looks at. */
typedef struct study_spec {
    int answer_count, set_count, closed_form_count;
    char **answers;          /* "kinetic_energy", "particles[pair].items[0].velocity" */
    char **set;              /* settings laid over the scene for a study */
    closed_form *closed_form;
    int64_t samples;         /* times at which answers are compared */
    int64_t seeds;           /* 0: the answers are compared run by run; else their means over so many seeds */
    double average_from_s;   /* with seeds: answers are averaged from this time on; NAN: the last sample */
} study_spec;

/* A property as a table against temperature: linear between the places, constant outside. Where one number has to do it is the largest value, of
 * specific heats the smallest. */
typedef struct property_table {
    const double *of; /* where that number stands */
    int count, value_count;
    double *temperature_k, *value;
} property_table;

typedef struct scene {
    char *title;
    int dimensions;
    uint64_t seed;
    double gravity_m_s2[3];
    precision precision;
    integrator integrator;
    domain domain;
    environment environment;
    int effect_count;
    effect *effect;
    int material_count;
    material *material;
    int interaction_count;
    interaction *interaction;
    int table_count;
    property_table *property_table;
    int group_count;
    particle_group *group;
    int wall_group_count;
    wall_group *wall_group;
    int wall_count;
    wall *wall;
    int stage_count;
    scene_stage *stage;
    output_spec output;
    table_spec table;
    guard_spec guards;
    study_spec study;
    char *path;     /* as given; messages begin with it */
    char *text;     /* the scene as YAML after every --set, complete enough to run again */
} scene;

/* Reads, applies `--set path=value` strings in order, fills defaults and checks everything that can be known without a device.
 * On failure `why` holds "scene.yaml:12:5: ..." and *out is NULL. */
status scene_read(const char *path, int set_count, char *const *sets, scene **out, failure *why);
/* The same from text (a checkpoint holds it); `path` is used in messages and to find files beside the scene. */
status scene_read_text(const char *text, const char *path, int set_count, char *const *sets, scene **out, failure *why);
void scene_free(scene *scene);

/* Value of an interaction property between material a and either material b or a wall (the other is -1), as stage `stage` (-1: the
 * scene itself) sees it: stage's overlay, the pair's own entry, `default`, the property's fallbacks. NAN when there is none. */
double scene_interaction(const scene *scene, int stage, int material_a, int material_b, int wall, const property *property);
double scene_material(const scene *scene, int material, const property *property);
/* True when the value above was written in the scene rather than taken from a fallback. */
bool scene_interaction_given(const scene *scene, int stage, int material_a, int material_b, int wall, const property *property);

/* The tables of such properties; NULL where they are numbers. */
const property_table *scene_interaction_table(const scene *scene, int stage, int material_a, int material_b, int wall, const property *property);
const property_table *scene_material_table(const scene *scene, int material, const property *property);
/* Some material has a table of it; some interaction has. */
bool scene_has_material_table(const scene *scene, const property *property);
bool scene_has_interaction_table(const scene *scene, const property *property);
double property_table_at(const property_table *table, double temperature);
/* -1 - row: how the kernels are told. */
double scene_table_constant(const scene *scene, const property_table *table);

/* Prescribed motion of a wall at the start: its own, or its group's. */
const motion_list *scene_wall_motion(const scene *scene, int wall);
/* True where the wall moves in some stage. */
bool scene_wall_moves(const scene *scene, int wall);
/* True where some wall keeps a force in some stage. */
bool scene_has_servo(const scene *scene);

/* The law that fills a slot in a stage, or NULL (none twin). */
const effect *scene_effect(const scene *scene, int stage, slot_id slot);

/* Gravity in a stage (-1: the scene's own): changes stay in force until the next one. */
void scene_gravity(const scene *scene, int stage, double gravity_m_s2[3]);

/* Sources: how many; one of them; which direction of beams it belongs to; how many directions there are (host/beams.c). */
int scene_beam_count(const scene *scene);
const effect *scene_beam(const scene *scene, int index);
int scene_beam_side(const scene *scene, int index);
int scene_beam_sides(const scene *scene);

/* A thermal law is listed; grains have a temperature; what each path of heat brings is kept. */
bool scene_has_heat(const scene *scene);
bool scene_has_temperature(const scene *scene);
bool scene_tallies_heat(const scene *scene);
/* A field or an observable is listed under `output`. */
bool scene_outputs(const scene *scene, const char *name);
/* What a wall's heat is in a stage (-1: at the start). */
const wall_heat *scene_wall_heat(const scene *scene, int stage, int wall);
/* A property of the environment's gas; NAN where absent. */
double scene_gas(const scene *scene, const property *property);

/* The scene reference page, made from the parameter table and the law descriptors, as Markdown. Caller frees. */
char *scene_reference(void);

#endif
