/* Many steps in one launch (kernels/stage/step_loop.cl), and where that is the faster form.
 *
 * On a GPU one work-group goes through the steps, which only small beds are faster in. On a CPU a step has phases (step_plan.c), and one of three goes
 * through them: a work-group alone; a team with a work-group for every core, which meet after every phase; or a launch a phase. A team wins on a
 * quiet machine and loses where others want the cores, since its members wait by looking; form_trials.c finds out which is the fastest. */
#include "laws/laws.h"
#include "simulation.h"

#include <stdlib.h>
#include <string.h>

#define LOOP_ARGUMENTS 8 /* before the fields of the stages */
#define LOOP_ITEMS_GPU 512
/* Pocl hands work-groups to a thread several at a time; as many for each core leave some for each. All but one of each return at once. */
#define GROUPS_EACH 32
/* Work-groups of a launch for each core, where pieces are shared. */
#define SHARES_EACH 4
/* Beds of more records are not tried alone: they have work for every core, and long batches. */
#define SMALL_BED_RECORDS 20000

int step_loop_items(const simulation *sim)
{
    return sim->device->info.cpu ? 1 : LOOP_ITEMS_GPU;
}

/* Records up to which one thread, or one work-group of a GPU, does best alone (docs/performance.md). */
static int records_alone(const simulation *sim)
{
    return sim->device->tuning.loop_records;
}

/* Where walls give a heat flow, their areas are summed in a launch of its own between the two stages; where they keep a force, a launch of its own
 * behind them moves them. */
static bool launches_between(const simulation *sim)
{
    return sim->live.law[SLOT_WALL_HEAT] == &law_wall_flux || sim->live.servo;
}

bool step_loop_in_program(const simulation *sim)
{
    return step_loop_wanted(sim) || (sim->live.blocks && !launches_between(sim));
}

bool step_loop_wanted(const simulation *sim)
{
    step_form form = sim->scene->table.step_form;
    if (launches_between(sim) || form == STEP_TWO_KERNELS)
        return false;
    return form != STEP_AUTO || sim->live.blocks || sim->id_count <= records_alone(sim);
}

bool step_loop_now(const simulation *sim)
{
    if (!launch_kernel(sim, "step_loop"))
        return false;
    return sim->scene->table.step_form != STEP_AUTO || sim->live.blocks || sim->table.record_count <= records_alone(sim);
}

/* A form that the scene asks for, or the only one that the device or the size leave; LOOP_MANNERS: what is fastest. */
static loop_manner fixed_manner(const simulation *sim)
{
    step_form form = sim->scene->table.step_form;
    if (form == STEP_ONE_GROUP || !sim->live.blocks || sim->device->info.compute_units < 2)
        return LOOP_ALONE;
    if (form == STEP_PHASES || form == STEP_TEAM)
        return form == STEP_TEAM ? LOOP_TEAM : LOOP_PHASES;
    return sim->table.record_count <= records_alone(sim) ? LOOP_ALONE : LOOP_MANNERS;
}

static bool is_small(const simulation *sim)
{
    return sim->table.record_count < SMALL_BED_RECORDS;
}

int step_loop_team(const simulation *sim)
{
    int units = (int)sim->device->info.compute_units;
    return units < CLAST_TEAM_MAX ? units : CLAST_TEAM_MAX;
}

int step_loop_members(const simulation *sim)
{
    return step_loop_now(sim) && fixed_manner(sim) != LOOP_ALONE ? step_loop_team(sim) : 1;
}

/* As the last batch, whose members have the grains in their caches; but what goes alone is small, and what has a launch for each phase is large. */
loop_manner step_loop_table_manner(const simulation *sim)
{
    bool built = sim->table.built, small = built ? is_small(sim) : sim->id_count <= records_alone(sim);
    loop_manner fixed = built ? fixed_manner(sim) : LOOP_PHASES, manner = fixed == LOOP_MANNERS ? sim->loop.trials.manner : fixed;
    if (manner == LOOP_TEAM || (manner == LOOP_PHASES && sim->scene->table.step_form == STEP_PHASES))
        return manner;
    return small ? LOOP_ALONE : LOOP_PHASES;
}

const char *step_loop_name(const simulation *sim)
{
    static const char *const name[LOOP_MANNERS] = {"phases", "team", "one group"};
    loop_manner fixed = fixed_manner(sim);
    return step_loop_now(sim) ? name[fixed != LOOP_MANNERS ? fixed : sim->loop.trials.best] : "two kernels";
}

int step_loop_launches(const simulation *sim)
{
    if (!step_loop_now(sim))
        return sim->plan.count;
    return strcmp(step_loop_name(sim), "phases") == 0 ? sim->plan.phases.count : 0;
}

/* What the records of a step cost, and what it costs without any; their number changes between one trial and the next. */
static double step_work(const simulation *sim)
{
    return 1.0 + (double)sim->table.record_count;
}

void step_loop_note(simulation *sim, int steps, double seconds)
{
    form_trials_note(&sim->loop.trials, steps, step_work(sim), seconds, is_small(sim));
}

static uint64_t pieces_bytes(int count)
{
    return sizeof(clast_piece) * (uint64_t)count;
}

static status send_pieces(simulation *sim, failure *why)
{
    step_loop *loop = &sim->loop;
    if (sim->plan.count > loop->pieces_held) {
        store_release(sim, &loop->pieces, pieces_bytes(loop->pieces_held));
        loop->pieces_held = 0;
        TRY(store_buffer(sim, &loop->pieces, pieces_bytes(sim->plan.capacity), "the pieces of a step", why));
        loop->pieces_held = sim->plan.capacity;
    }
    TRY(store_write(sim, loop->phases, 0, sizeof sim->plan.phases, &sim->plan.phases, why));
    return store_write(sim, loop->pieces, 0, pieces_bytes(sim->plan.count), sim->plan.piece, why);
}

status step_loop_bind(simulation *sim, failure *why)
{
    if (!launch_kernel(sim, "step_loop"))
        return STATUS_OK;
    if (!sim->loop.team)
        TRY(store_buffer(sim, &sim->loop.team, sizeof(clast_team), "what a team shares", why));
    if (!sim->loop.phases)
        TRY(store_buffer(sim, &sim->loop.phases, sizeof(clast_phases), "the pieces of a step", why));
    TRY(send_pieces(sim, why));
    TRY(launch_bind(sim, "step_loop", LOOP_ARGUMENTS, why));
    return launch_bind_placed_slots(sim, "step_loop", LOOP_ARGUMENTS, why);
}

static status fit_rows(simulation *sim, int steps, failure *why)
{
    step_loop *loop = &sim->loop;
    if (steps <= loop->rows_held)
        return STATUS_OK;
    store_release(sim, &loop->launches, sizeof *loop->rows * (uint64_t)loop->rows_held);
    free(loop->rows);
    loop->rows_held = 0;
    loop->rows = malloc(sizeof *loop->rows * (size_t)steps);
    if (!loop->rows)
        return fail(why, STATUS_ERROR, "out of memory");
    TRY(store_buffer(sim, &loop->launches, sizeof *loop->rows * (uint64_t)steps, "values of the steps of a batch", why));
    loop->rows_held = steps;
    return STATUS_OK;
}

static status run_phases(simulation *sim, cl_kernel kernel, int steps, failure *why)
{
    const clast_phases *phases = &sim->plan.phases;
    int members = step_loop_members(sim);
    for (int p = 0; p < steps * phases->count; p++) {
        const clast_phase *phase = &phases->phase[p % phases->count];
        int groups = phase->streams ? phase->units : SHARES_EACH * members;
        TRY(launch_set_from(kernel, "step_loop", LOOP_ARGUMENTS - 1, why, "i", (cl_int)p));
        TRY(launch_run(sim, kernel, "step_loop", groups < phase->units ? groups : phase->units, 1, why));
    }
    return STATUS_OK;
}

status step_loop_enqueue(simulation *sim, int steps, failure *why)
{
    cl_kernel kernel = launch_kernel(sim, "step_loop");
    step_loop *loop = &sim->loop;
    loop_manner manner = form_trials_next(&loop->trials, fixed_manner(sim), is_small(sim));
    int bond_step = bonds_step(sim, steps), most = manner == LOOP_TEAM ? step_loop_members(sim) : 1, items = step_loop_items(sim);
    TRY(fit_rows(sim, steps, why));
    for (int s = 0; s < steps; s++) {
        clast_launch launch = launch_of_step(sim, s, bond_step);
        launch.first_wall_place = sim->plan.force_records > 0 ? sim->plan.force_records : sim->table.wall_base;
        loop->rows[s] = launch_as_passed(launch);
    }
    TRY(store_write(sim, loop->launches, 0, sizeof *loop->rows * (uint64_t)steps, loop->rows, why));
    TRY(launch_set(kernel, "step_loop", why, "mmmmmiii", loop->launches, sim->control, loop->team, loop->phases, loop->pieces, (cl_int)steps,
                   (cl_int)most, (cl_int)-1));
    if (manner == LOOP_PHASES)
        return run_phases(sim, kernel, steps, why);
    TRY(store_fill(sim, loop->team, sizeof(clast_team), why));
    return launch_run(sim, kernel, "step_loop", (int64_t)items * (most > 1 ? most * GROUPS_EACH : 1), items, why);
}

void step_loop_free(simulation *sim)
{
    store_release(sim, &sim->loop.launches, 0);
    store_release(sim, &sim->loop.team, 0);
    store_release(sim, &sim->loop.phases, 0);
    store_release(sim, &sim->loop.pieces, 0);
    free(sim->loop.rows);
    sim->loop = (step_loop){0};
}
