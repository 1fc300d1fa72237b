/* A bed on a device: fields, contact table, programs, and the step. What is due between steps (frames, guards, ends of stages) is run.c's. */
#ifndef CLAST_HOST_SIMULATION_H
#define CLAST_HOST_SIMULATION_H
#include "bed.h"
#include "bundle.h"
#include "device.h"
#include "ledger.h"
#include "live.h"
#include "pose.h"
#include "scene.h"
#include "servo.h"

#include <clast/shared.h>

#include <stdarg.h>

#define SIMULATION_FIELDS_MAX 64
#define SIMULATION_KERNELS_MAX 96
#define BATCH_STEPS_MAX 1024
/* Arguments of a kernel that the descriptors name, at most. */
#define LAUNCH_NAMES_MAX 96

/* One array on the device. */
typedef struct stored_field {
    const field *field;
    cl_mem mem;
} stored_field;

typedef struct kernel_slot {
    const char *name;
    cl_kernel kernel;
} kernel_slot;

/* What is to be done for a table, on its way to the device; see table_phases.c. */
typedef struct table_list {
    clast_table_list *rows;
    clast_launch launch;
    cl_mem memory[CLAST_TABLE_MEMORIES], device;
    int memories, count;
    bool launched; /* some phase has taken `launch` */
} table_list;

/* The contact table: packed records, slots of every grain, and the arrays that build them. Two generations stand side by side while
 * histories are carried over. */
typedef struct contact_table {
    cl_mem owner[2], other[2], slots[2], slot_offset[2];
    int now; /* generation in use */
    int64_t record_capacity, slot_capacity, cell_capacity;
    int64_t slots_held[2]; /* of each generation */
    int slot_count;        /* of the generation in use */
    cl_uint found[3];      /* pairs, records of walls and slots, as read from the device */
    bool slots_outgrown[2];
    int old_wall_base; /* of the generation in use, while the next one is built */
    cl_mem placed; /* slots that lead to the places of forces where chunks share them; NULL until they do */
    int64_t placed_held;
    int pair_count, wall_base, record_count; /* record_count: end of the wall records, filled up to a work-group */
    int wall_record_count;
    int64_t record_stride;
    cl_mem match;
    cl_mem work[5]; /* per particle, 32 bits */
    cl_mem cell_count, cell_start, sums, grid, width, totals;
    clast_grid grid_host;
    table_list list;
    double skin;
    double radius_min, radius_max; /* at the reference temperature, where radii change */
    double growth;                 /* largest since, m */
    bool skin_is_given;
    int64_t skin_look; /* steps after the last table at which the skin is looked at again */
    bool built;
} contact_table;

/* Steps up to which no temperature leaves the interval of those around it, by what draws it. */
typedef struct heat_limit {
    double conduction, convection, radiation, all;
    double stiffness; /* in which the stiffness of a contact changes by a factor of e */
} heat_limit;

/* The pieces of a step, in order; see step_plan.c. */
typedef struct step_plan {
    clast_piece *piece;
    int count, capacity;
    clast_phases phases;
    int chunk_records; /* 0: the stages go whole */
    int force_records; /* places for forces of pairs; 0: every record has its own */
} step_plan;

/* Copies of what is on its way to the device, see store.c. */
#define OUTBOX_BYTES (1 << 17)
typedef struct outbox {
    char *copy;
    uint64_t used;
} outbox;

/* Who goes through the phases of the steps of a batch, see step_loop.c. */
typedef enum loop_manner { LOOP_PHASES, LOOP_TEAM, LOOP_ALONE, LOOP_MANNERS } loop_manner;

/* Which of them is the fastest, by the batches of the run itself, see form_trials.c. Work is steps times what a step costs, in a unit of the caller's. */
typedef struct form_trials {
    loop_manner manner, best;   /* of the batch under way; of all but trials */
    bool trial;                 /* the batch under way is part of one */
    int64_t batches;            /* so far, with this program */
    int settling, timed;        /* batches that this manner still goes through before one is timed; those that were */
    double pace;                /* of the best, s a unit of work of late; 0: not known */
    double spent;               /* s in batches */
    double due[LOOP_MANNERS];   /* of them, when it is to be tried again */
    int wins[LOOP_MANNERS];     /* trials in a row in which it was the faster */
    double began;               /* of them, when this manner's batches began */
    double work, timed_work, timed_seconds; /* of them in all, and of those of a trial that were timed */
    double table[LOOP_MANNERS]; /* s a table after such a batch, of late; 0: not known */
    double table_steps;         /* that a table lasts, of late */
} form_trials;

/* What many steps in one launch need, see step_loop.c; nothing while they are not used. */
typedef struct step_loop {
    cl_mem launches, team, phases, pieces; /* of the steps of a batch; of the plan */
    clast_launch *rows;
    int rows_held, pieces_held;
    form_trials trials;
} step_loop;

typedef struct step_limit {
    double limit_s;       /* largest stable step; infinite where nothing binds */
    double recommended_s; /* seven tenths of the limit, a tenth of the shortest contact, and a tenth of the limit of heat */
    char binds[64];       /* "normal", "tangential and rolling", "tenth of the contact", ... */
    double contact_s;     /* duration of the shortest contact expected, 0: none */
    heat_limit heat;
    double live_s, expected_s; /* limits from the contacts there are, and from those to be expected */
} step_limit;

/* Tables of heat on the device, and the host's copies of rows that vary from step to step. */
typedef struct heat_tables {
    cl_mem constants, tables, profile, environment, walls, areas, groups;
    double since; /* time up to which temperatures have advanced, where they do in every n-th step */
    int rows;
    bool vary;
    clast_environment *environment_rows;
    clast_wall_heat *wall_rows; /* by row and face */
    clast_group_heat *group_rows;
} heat_tables;

/* A stage in which nothing moves (frozen.c): the links of the contact network, and how its steps go. */
typedef struct frozen_heat {
    bool linked;           /* the arrays hold the network as it stands */
    cl_mem link, conductance, given, start, begin, zero, error, rates, kept, rises[3];
    uint64_t link_bytes, grain_bytes;
    cl_mem fixed, residual, slope, diagonal, x, p, q, scalar; /* linear systems */
    double low, high;      /* temperatures that none leaves without being heated; NAN: not yet known */
    double next;           /* step to try, s; NAN: none yet */
    double rate;           /* largest rate of change at the last step, K/s; infinite before it */
    double limit, hottest; /* limit of Euler's method, s, for surfaces up to this temperature; NAN: not yet known */
    int64_t rejected;
} frozen_heat;
/* Beams of the sources, and the columns in which the bed's surface is looked for. */
typedef struct beam_tables {
    int count, sides, row_count;
    int64_t interval; /* steps between two searches for the surface */
    clast_beam *rows; /* by row and beam */
    clast_columns columns[CLAST_BEAM_SIDES_MAX];
    cl_mem device_rows, device_columns, bounds, surface, meets;
    int64_t surface_held;
    double delivered; /* J */
} beam_tables;

/* Who is told of every launch of a kernel, with an event to release; for benchmarks. `items`: work-items, or of a stage its grains or records. */
typedef struct launch_watch {
    void (*seen)(void *context, const char *name, cl_kernel kernel, size_t items, cl_event event);
    void *context;
} launch_watch;

typedef struct simulation {
    const scene *scene;
    device *device;
    int block;              /* grains or records a work-group, see CLAST_BLOCK */
    bool mixed;             /* precision of the device's numbers; the host's are double */
    double origin[3];       /* of the device's positions; 0 in double precision */
    char *kernels_directory;
    const launch_watch *watch; /* NULL: nobody */
    live_laws live, all; /* of the stage, and the union over stages */
    int stage;
    cl_program program, table_program;
    kernel_slot kernel[SIMULATION_KERNELS_MAX];
    int kernel_count;
    stored_field field[SIMULATION_FIELDS_MAX];
    int field_count;

    int64_t id_count;       /* grains of the scene */
    int64_t count;          /* grains still there */
    int64_t stride;         /* grains that fields have room for: `id_count` up to a whole block; components of a grain stand together */
    bool particles_stale;   /* `where` lags behind */
    cl_mem where, partial, control, faces, movers, constants, built_position, scratch4;
    step_loop loop;
    outbox outbox;
    cl_mem velocity_now, spin_now; /* synchronised, where velocities stand half a step behind */
    cl_mem ledger_now;             /* and the ledger of that half step, nine numbers a grain; NULL without a ledger */
    int64_t partial_capacity;
    contact_table table;
    step_plan plan;

    int face_count, mover_count;
    moving_body *wall_body, *group_body;
    drives drives;
    bool walls_move, groups_move;
    clast_face *face_rows;   /* host rows of a batch */
    clast_mover *mover_rows;
    int batch_rows;          /* rows allocated */
    uint64_t face_bytes, mover_bytes;
    heat_tables heat;
    frozen_heat frozen;
    beam_tables beams;
    int32_t *group_of_id;
    bool *group_held;        /* by group: held or moved as prescribed, now */
    int64_t batch_limit;     /* steps a batch, now */

    double gravity[3];
    double time;             /* s */
    int64_t step;
    double dt;               /* of the steps to come */
    double lag;              /* twice the time by which half-step velocities are behind: the step before; 0 at the start of a stage */
    double segment_time;     /* time = segment_time + (step - segment_step) dt while dt stays */
    int64_t segment_step, stage_steps;
    double built_time;       /* when the table was built */
    double drift_velocity[3];
    double mean_radius, radius_min, radius_max, mean_mass;
    double bed_low[3], bed_high[3]; /* where cells are laid: the domain, or the bed as generated */
    int64_t rebuilds, rebuild_step; /* step of the last one */
    double rebuild_seconds, step_seconds; /* wall time */
    int64_t left_count;
    double left_mass;
    int64_t bonds_gone;      /* bonds that records had which are no longer in the table */
    double reach;            /* largest gap over which laws act, m */
    bool bonding_done;       /* contacts have bonded at the time given for it */
    double left_energy[LEDGER_TERMS]; /* what the grains that have left had in the ledger */
    uint64_t bytes;          /* on the device */
} simulation;

/* Opens the device for a scene. A scene that leaves its precision open is set to mixed where the device has no fp64. */
status simulation_open_device(scene *scene, const char *choice, device *out, failure *why);
status simulation_create(const scene *scene, const bed *bed, device *device, const char *kernels_directory, simulation **out, failure *why);
void simulation_free(simulation *sim);
/* The step to take from here on. */
void simulation_set_step(simulation *sim, double dt);
/* Takes up the laws, gravity, motions and constants of a scene stage. */
status simulation_begin_stage(simulation *sim, int stage, failure *why);
/* The same without its changes of motion: for a state that is already in the stage. */
status simulation_enter_stage(simulation *sim, int stage, failure *why);
/* Takes n steps of sim->dt; builds tables on the way. Grains that leave are deleted where the scene says so, else STATUS_GUARD. */
status simulation_advance(simulation *sim, int64_t steps, failure *why);
/* Packets as the grains are now, before steps that are enqueued (kernels/stage/rows_packed.cl); nothing where grains have none. */
status steps_pack_grains(simulation *sim, failure *why);
/* After a sort that put the leavers last: takes note of them; `kept` grains remain. */
status simulation_count_leavers(simulation *sim, int64_t kept, failure *why);
/* Displacements are measured against this velocity until the next table. */
status simulation_choose_drift(simulation *sim, failure *why);
/* Time after so many more steps, to the same bits whatever the batches. */
double simulation_time_after(const simulation *sim, int64_t steps);

/* body_rows.c: walls and prescribed motions */
/* Rows for the steps of the batch to come. */
status body_rows_write(simulation *sim, int rows, failure *why);
/* How far a wall may have moved, against the common drift, since the table was built: an upper bound over what the bed can touch, m. */
double body_rows_wall_travel(const simulation *sim, double time);
/* A wall as it stands now, with what its servo has moved it. */
body_pose simulation_wall_pose(const simulation *sim, int wall);
/* Faces and movers for the step that starts at the present time, as row 0. */
status simulation_pose_now(simulation *sim, failure *why);

/* skin.c: unless the scene gives one */
/* Before a table that grains ask for. */
void skin_adapt(simulation *sim);
/* A table that lasts long has too many pairs: a smaller skin may do. Says so by *rebuild. */
status skin_look(simulation *sim, bool *rebuild, failure *why);

/* heat_steps.c: heat that is advanced every n-th step */
/* What temperatures advance by in step s of the batch to come, s; the same bits whatever the batches. */
double heat_steps_span(const simulation *sim, int s);
/* After a batch. */
void heat_steps_note(simulation *sim, int done);
/* At the end of a stage nothing may wait. */
status heat_steps_end(simulation *sim, failure *why);

/* store.c: arrays and kernels by name */
status store_buffer(simulation *sim, cl_mem *mem, uint64_t bytes, const char *what, failure *why);
void store_release(simulation *sim, cl_mem *mem, uint64_t bytes);
/* What the core needs, and what the live laws of any stage ask for, each once; nothing else. */
int store_needs(const live_laws *all, const field **out, int max);
status store_fields(simulation *sim, failure *why);
stored_field *store_find(simulation *sim, const char *name);
/* Bytes of a number of the type on the device. */
uint64_t store_item(const simulation *sim, field_type type);
/* Numbers first.. of an array between the host's doubles and the precision of the device. */
status store_put(simulation *sim, cl_mem mem, field_type type, int64_t first, int64_t count, const double *values, failure *why);
status store_get(simulation *sim, cl_mem mem, field_type type, int64_t first, int64_t count, double *values, failure *why);
/* The same for a field of the first `count` grains, components side by side; positions are the scene's. */
status store_put_grains(simulation *sim, const stored_field *stored, int64_t count, const double *values, failure *why);
status store_get_grains(simulation *sim, const stored_field *stored, int64_t count, double *values, failure *why);
uint64_t field_bytes(const simulation *sim, const field *field);
/* The same with so many elements between the components of a field of records. */
uint64_t field_bytes_at(const simulation *sim, const field *field, int64_t record_stride);
status store_write(simulation *sim, cl_mem mem, uint64_t offset, uint64_t bytes, const void *data, failure *why);
status store_read(simulation *sim, cl_mem mem, uint64_t offset, uint64_t bytes, void *data, failure *why);
status store_fill(simulation *sim, cl_mem mem, uint64_t bytes, failure *why);
/* Zeroes `count` 32-bit words from word `first` on. */
status store_clear_ints(simulation *sim, cl_mem mem, int64_t first, int64_t count, failure *why);
status store_copy(simulation *sim, cl_mem from, cl_mem to, uint64_t from_offset, uint64_t to_offset, uint64_t bytes, failure *why);
extern const field field_position, field_velocity, field_radius, field_mass, field_id, field_force;

/* launch.c: kernels of the program, their arguments by the descriptors */
status launch_open(simulation *sim, failure *why);
void launch_close(simulation *sim);
/* Names of the arguments of a stage after launch and control, by walking the descriptors; returns how many. */
int launch_argument_names(const live_laws *live, const char *kernel, const char **names, int max);
/* Sets the fields of one of the stages that read records or grains, from argument `first` on. */
status launch_bind(simulation *sim, const char *kernel, int first, failure *why);
/* The same where the kernel is to find forces at the places that chunks share; nothing where they have none. */
status launch_bind_placed_slots(simulation *sim, const char *kernel, int first, failure *why);
status launch_bind_stages(simulation *sim, failure *why);
cl_kernel launch_kernel(const simulation *sim, const char *name);
clast_launch launch_values(const simulation *sim);
/* The values as a kernel reads them: in pairs of floats where precision is mixed. */
clast_launch launch_as_passed(clast_launch launch);
/* Sets argument 0, in the precision that the values name. */
status launch_pass(cl_kernel kernel, const char *name, const clast_launch *launch, failure *why);
status launch_run(simulation *sim, cl_kernel kernel, const char *name, int64_t items, int64_t group, failure *why);
/* Sets arguments first.. in order: 'm' cl_mem, 'i' int, 'l' clast_i64, 'f' double as float,
 * 'd' double, 'L' const clast_launch *. */
status launch_set(cl_kernel kernel, const char *name, failure *why, const char *types, ...);
status launch_set_list(cl_kernel kernel, const char *name, failure *why, const char *types, va_list values);
/* The same from argument `first` on. */
status launch_set_from(cl_kernel kernel, const char *name, cl_uint first, failure *why, const char *types, ...);

/* What the stages are told in step `s` of the batch to come; bonds are made in `bond_step` of it (-1: in none). */
clast_launch launch_of_step(const simulation *sim, int s, int bond_step);

/* step_loop.c: many steps in one launch */
/* True where the text of the kernel is in the scene's program: on a CPU whichever form the scene asks for, so that all forms have one program. */
bool step_loop_in_program(const simulation *sim);
/* True where the scene is to have the kernel. */
bool step_loop_wanted(const simulation *sim);
/* True where the batch to come takes that form. */
bool step_loop_now(const simulation *sim);
/* Members of the team for the table of the moment; 1: none. */
int step_loop_members(const simulation *sim);
/* Who goes through the phases of a table now, and with how many members where it is a team. */
loop_manner step_loop_table_manner(const simulation *sim);
int step_loop_team(const simulation *sim);
/* Work-items of a work-group. */
int step_loop_items(const simulation *sim);
/* After every table. */
status step_loop_bind(simulation *sim, failure *why);
status step_loop_enqueue(simulation *sim, int steps, failure *why);
/* How most batches of late were taken: "team", "phases", "one group", or "two kernels". */
const char *step_loop_name(const simulation *sim);
/* Launches of a step so taken; 0: one of a batch. */
int step_loop_launches(const simulation *sim);
/* After a batch of so many steps, which took so long. */
void step_loop_note(simulation *sim, int steps, double seconds);
void step_loop_free(simulation *sim);

/* form_trials.c */
/* What was timed was of another program. */
void form_trials_forget(form_trials *trials);
/* The manner of the batch to come; `only`: the one that it must have, or LOOP_MANNERS. A bed that is not small is not tried alone. */
loop_manner form_trials_next(form_trials *trials, loop_manner only, bool small);
/* After a batch of so many steps, each so much work, which took so long. */
void form_trials_note(form_trials *trials, int64_t steps, double step_work, double seconds, bool small);
/* What the table after the last batch took, and the steps that the one before it had lasted. */
void form_trials_note_table(form_trials *trials, int64_t lasted, double seconds);

/* step_plan.c */
/* Work-items that take a block of grains through the particle stage, where stages go by blocks (PARTICLE_LANES in kernels/stage/by_blocks.cl). */
#define STEP_BLOCK_ITEMS 2
/* After every table. */
status step_plan_make(simulation *sim, failure *why);
void step_plan_free(step_plan *plan);
/* Enqueues one step; takes an event of every piece where `events` is given. */
status step_plan_enqueue(const simulation *sim, cl_command_queue queue, clast_launch launch, cl_event *events, failure *why);

/* table.c */
status table_create(simulation *sim, failure *why);
void table_free(simulation *sim);
/* Sorts the grains and builds the table anew, histories carried over. drop_outside: grains outside the domain leave for good. */
status table_build(simulation *sim, bool drop_outside, failure *why);
/* What the largest growth of a grain is since the reference temperature, m. Where radii change, tables go by those at that temperature (who owns a
 * pair may not depend on when a table was built), and what grains have grown by since is added to the skin. */
status table_growth(simulation *sim, double *growth, failure *why);
/* Largest displacement since the table was built, relative to the common one, m. */
status table_travel(simulation *sim, double *out, failure *why);
/* The radii that tables go by. */
cl_mem table_radii(simulation *sim);
uint64_t table_bytes(const simulation *sim);

/* table_phases.c: what is done for a table, in order */
/* As launch_set and launch_run, at once or with what else is due; so are the two below. */
status table_do(simulation *sim, const char *name, int64_t items, int64_t group, failure *why, const char *types, ...);
status table_do_fill(simulation *sim, cl_mem memory, uint64_t bytes, cl_int value, failure *why);
/* The cells, to be told first. */
status table_give_grid(simulation *sim, const clast_grid *grid, failure *why);
status table_do_copy(simulation *sim, cl_mem from, cl_mem to, uint64_t bytes, failure *why);
/* Before the queue is given anything else, and before a buffer is released: what is due. */
status table_flush(simulation *sim, failure *why);
void table_list_free(simulation *sim);

/* limit.c */
status limit_find(simulation *sim, step_limit *out, failure *why);

/* observe.c */
typedef struct particle_sums {
    double kinetic, rotational, gravitational, mass, momentum[3], angular[3], speed_max, weight_radius; /* weight_radius: sum of m r */
} particle_sums;
typedef struct contact_sums {
    double overlap_max, elastic;
    int64_t contacts, pairs; /* contacts: live records; pairs: of them between grains */
} contact_sums;
/* A live contact, on the host. */
typedef struct live_contact {
    int32_t i, j, wall; /* permanent ids; j -1 at a wall */
    double overlap, area, force[3], torque_wall[3];
    double heat; /* into i, W */
    bool bonded;
} live_contact;
/* Room on the device for `doubles` results of a reduction. */
status observe_partial(simulation *sim, int64_t doubles, failure *why);
status observe_where(simulation *sim, failure *why);
status observe_particle_sums(simulation *sim, particle_sums *out, failure *why);
/* The same with the velocities that the laws are given, which an integrator may have extrapolated: no force is computed. */
status observe_stored_sums(simulation *sim, particle_sums *out, failure *why);
/* Velocities and spins (NULL without) at the time of the positions, in arrays of the device. */
status observe_velocities(simulation *sim, cl_mem *velocity, cl_mem *spin, failure *why);
/* Where a stage ends under an integrator of half steps: velocities, histories of contacts, ledger and heat of dissipation come to the time of the
 * positions for good. */
status observe_end_half_steps(simulation *sim, failure *why);
status observe_contact_sums(simulation *sim, contact_sums *out, failure *why);
/* Leaves in the records the forces and flows as they stand. */
status observe_flows(simulation *sim, failure *why);
/* Live contacts in the order of ids; forces as they stand. walls_only leaves the pairs out. Caller frees. */
status observe_contacts(simulation *sim, bool walls_only, live_contact **out, int64_t *count, failure *why);
/* Sum of the contacts' forces (or torques) on every grain, [id_count][3]; NAN where the grain has left. Caller frees. */
status observe_totals(simulation *sim, bool torque, double **out, failure *why);
/* Volume-averaged stress times volume: sum of f_a l_b over contacts, row-major, J. */
status observe_virial(simulation *sim, double *stress, failure *why);
/* Host copy of a particle field in permanent-id order, [id_count][components]; NAN (or -1) where the grain has left. Caller frees. */
status observe_field(simulation *sim, const char *name, double **out, failure *why);

/* heat.c */
/* All do nothing in a scene without temperatures. */
status heat_create(simulation *sim, failure *why);
void heat_free(simulation *sim);
status heat_upload_bed(simulation *sim, const bed *bed, failure *why);
status heat_upload_constants(simulation *sim, int stage, failure *why);
/* Something prescribed varies in time in the present stage. */
bool heat_varies(const simulation *sim);
status heat_fit_rows(simulation *sim, int rows, failure *why);
void heat_fill_row(simulation *sim, int row, double time);
status heat_write_rows(simulation *sim, int rows, failure *why);
/* Sums the areas of contact of walls that give heat, for the pair stage of `launch`. */
status heat_sum_areas(simulation *sim, const clast_launch *launch, failure *why);
typedef struct heat_sums {
    double content;                     /* sum of m c T, J */
    double lowest, mean, highest;       /* K; NAN where no grain is left */
    double tally[CLAST_TALLIES];        /* J */
} heat_sums;
status heat_observe(simulation *sim, heat_sums *out, failure *why);
/* Temperatures at the time of the positions, in an array of the device: what is dissipated in the half step by which velocities stand behind is in. */
status heat_temperatures(simulation *sim, cl_mem *out, failure *why);
status heat_limit_find(simulation *sim, heat_limit *out, failure *why);
/* Conductances of the records where their heat stands, and of the grains' surfaces among the partial sums, W/K. */
status heat_enqueue_coefficients(simulation *sim, failure *why);
/* heat_biot.c: raises the largest Biot numbers of every material, by contacts and by surfaces, to those there are now. */
status heat_biot(simulation *sim, double *contact, double *surface, failure *why);

/* beams.c: all do nothing where no source is live */
status beams_create(simulation *sim, failure *why);
void beams_free(simulation *sim);
/* Some beam moves or changes its power. */
bool beams_vary(const simulation *sim);
status beams_fit_rows(simulation *sim, int rows, failure *why);
void beams_fill_row(simulation *sim, int row, double time);
status beams_write_rows(simulation *sim, int rows, failure *why);
/* Counts what the beams deliver in the step of length dt that starts at `time`. */
void beams_deliver(simulation *sim, double time, double dt);
/* Finds how deep every grain lies, now. */
status beams_find_depths(simulation *sim, failure *why);
/* Steps that a batch may take before depths are due; and what is due before it. */
int64_t beams_steps_allowed(const simulation *sim, int64_t steps);
status beams_before_batch(simulation *sim, failure *why);
/* Which beams have met a grain so far. */
status beams_met(simulation *sim, bool *met, failure *why);

/* bonds.c */
typedef struct bond_sums {
    int64_t made, broken, alive;
} bond_sums;
/* Which of the next steps is the one in which contacts bond at a given time; -1: none. */
int bonds_step(const simulation *sim, int steps);
status bonds_count(simulation *sim, bond_sums *out, failure *why);
/* Around whatever drops records or their histories, so that the bonds they had still count. */
status bonds_before(simulation *sim, failure *why);
status bonds_after(simulation *sim, failure *why);
/* Largest gap over which laws act between grains of at most that radius, m. */
double bonds_reach(const scene *scene, const live_laws *live, double radius);
/* The live law's bonds hold at any distance. */
bool bonds_are_kept(const simulation *sim);
/* Records of such bonds into the table that is being built: counted, then written where grains have more than `room` partners. */
status bonds_keep(simulation *sim, const clast_launch *launch, int room, bool fill, failure *why);

/* clusters.c: grains that bonds join, directly or through others; walls join nobody */
#define CLUSTER_CLASSES 24
typedef struct cluster_sums {
    int64_t count, grains, largest;  /* clusters of two and more, grains in them; grains of the largest (1 where there is no bond) */
    double sizes[CLUSTER_CLASSES];   /* clusters of 1, 2, 3 to 4, 5 to 8, ... grains */
} cluster_sums;
/* By permanent id the smallest id of the grain's cluster; -1 where it has left. Caller frees. */
status clusters_find(simulation *sim, int32_t **out, failure *why);
status clusters_measure(simulation *sim, cluster_sums *out, failure *why);

/* ledger.c */
/* The terms of the ledger so far, LEDGER_TERMS of them in the order of ledger_terms. */
status ledger_read(simulation *sim, double *out, failure *why);
/* Adds to one of the ledger's fields, a row a grain, the half step by which velocities stand behind the positions; nothing to other fields. */
status ledger_add_half_step(simulation *sim, const field *term, double *rows, failure *why);
/* Keeps the sums of grains that leave. */
status ledger_leave(simulation *sim, const int32_t *index, int64_t count, failure *why);

/* softening.c */
/* Takes the factors of the grains' moduli from their temperatures; nothing without softening. */
status softening_refresh(simulation *sim, failure *why);

/* guard.c */
typedef struct guard_finding {
    bool stop;
    char text[1024];
} guard_finding;
status guard_check(simulation *sim, guard_finding *out, failure *why);
/* Refuses a stage that begins with a free grain deeper in a wall than guards.overlap_max, which would be shot out, or with a wall that would act
 * through a periodic face of the domain. */
status guard_walls(simulation *sim, failure *why);
/* True, and which wall and axis (x, y, z), where as walls now stand one is so near a periodic face that a grain on the other side would touch it. */
bool guard_periodic_wall(const simulation *sim, int *wall, char *axis);

/* state.c */
/* Everything needed to go on bit for bit, into a bundle; and back into a simulation made from the same scene. */
status state_save(simulation *sim, bundle *out, failure *why);
status state_load(simulation *sim, const bundle *in, const char *path, failure *why);

#endif
