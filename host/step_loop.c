/* Many steps in one launch (kernels/stage/step_loop.cl), and where that is the faster form.
 *
 * On a GPU one work-group goes through the steps, which only small beds are faster in. On a CPU a step has phases (step_plan.c), and one of three goes
 * through them: a work-group alone; a team with a work-group for every core, which meet after every phase; or a launch a phase. A team wins on a
 * quiet machine and loses where others want the cores, since its members wait by looking. Nothing foretells that: results are the same to the
 * bit, so the batches of the run itself are timed, the fastest is taken, and the others are tried again from time to time. What a step costs changes with
 * what the grains do, so a trial is held against the batches just before it, and never against older ones. */
#include "laws/laws.h"
#include "simulation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LOOP_ARGUMENTS 8 /* before the fields of the stages */
#define LOOP_ITEMS_GPU 512
/* Pocl hands work-groups to a thread several at a time; as many for each core leave some for each. All but one of each return at once. */
#define GROUPS_EACH 32
/* Work-groups of a launch for each core, where pieces are shared. */
#define SHARES_EACH 4
/* Batches of a trial of a small bed before those that are timed, since the first ones fetch the grains from the caches of other cores; and those. */
#define SETTLING_BATCHES 2
#define TRIAL_BATCHES    3
/* What a trial takes of the best's time where it wins; in a small bed it wins so often in a row before it is the best, or by far, since batches are
 * short, and the grains may do something else meanwhile. */
#define TRIAL_WINS        0.95
#define TRIALS_TO_WIN     3
#define TRIAL_WINS_BY_FAR 0.5
/* Of the time, what trials of a manner may lose; and the least rest after one, in times that it took. */
#define TRIAL_SHARE 0.005
#define TRIAL_REST  16.0
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
    loop_manner fixed = built ? fixed_manner(sim) : LOOP_PHASES, manner = fixed == LOOP_MANNERS ? sim->loop.manner : fixed;
    if (manner == LOOP_TEAM || (manner == LOOP_PHASES && sim->scene->table.step_form == STEP_PHASES))
        return manner;
    return small ? LOOP_ALONE : LOOP_PHASES;
}

/* ---- the fastest manner ---- */

/* Seconds a step at this pace, and of the tables between: who has gone through the steps has the grains in its caches, and a table costs more where
 * two have. */
static double cost(const simulation *sim, loop_manner m, double pace)
{
    const step_loop *loop = &sim->loop;
    double table = loop->table[m];
    for (loop_manner other = LOOP_PHASES; other < LOOP_MANNERS && loop->table[m] <= 0.0; other++)
        if (loop->table[other] > 0.0 && (table <= 0.0 || loop->table[other] < table))
            table = loop->table[other];
    return pace * (1.0 + (double)sim->table.record_count) + (loop->table_steps > 0.0 ? table / loop->table_steps : 0.0);
}

/* The first batch compiles, and is not timed. */
static loop_manner choose_manner(const simulation *sim)
{
    const step_loop *loop = &sim->loop;
    loop_manner fixed = fixed_manner(sim);
    if (fixed != LOOP_MANNERS)
        return fixed;
    if (loop->settling > 0 || loop->timed > 0)
        return loop->manner;
    bool may_try = loop->pace > 0.0 && loop->manner == loop->best; /* one trial, and the best again */
    for (loop_manner m = LOOP_PHASES; m < LOOP_MANNERS && may_try; m++)
        if (m != loop->best && loop->spent >= loop->due[m] && (m != LOOP_ALONE || is_small(sim)))
            return m;
    return loop->best;
}

const char *step_loop_name(const simulation *sim)
{
    static const char *const name[LOOP_MANNERS] = {"phases", "team", "one group"};
    loop_manner fixed = fixed_manner(sim);
    return step_loop_now(sim) ? name[fixed != LOOP_MANNERS ? fixed : sim->loop.best] : "two kernels";
}

int step_loop_launches(const simulation *sim)
{
    if (!step_loop_now(sim))
        return sim->plan.count;
    return strcmp(step_loop_name(sim), "phases") == 0 ? sim->plan.phases.count : 0;
}

void step_loop_forget(simulation *sim)
{
    step_loop *loop = &sim->loop;
    loop->batches = 0;
    loop->settling = loop->timed = 0;
    loop->best = LOOP_PHASES;
    loop->pace = loop->spent = 0.0;
    memset(loop->due, 0, sizeof loop->due);
    memset(loop->wins, 0, sizeof loop->wins);
    memset(loop->table, 0, sizeof loop->table);
    loop->table_steps = 0.0;
}

/* The mean of late, which begins with the first. */
static void follow(double *mean, double value)
{
    *mean = *mean > 0.0 ? *mean + 0.2 * (value - *mean) : value;
}

/* What a trial costs more than the best would have tells when the next may come. */
static void end_trial(simulation *sim)
{
    step_loop *loop = &sim->loop;
    loop_manner m = loop->manner;
    double pace = loop->timed_seconds / loop->timed_work, took = loop->spent - loop->trial_begin, lost = took - loop->pace * loop->trial_work;
    double ratio = cost(sim, m, pace) / cost(sim, loop->best, loop->pace);
    loop->timed = 0;
    loop->wins[m] = ratio < TRIAL_WINS ? loop->wins[m] + 1 : 0;
    loop->due[m] = loop->spent + (loop->wins[m] > 0 ? TRIAL_REST * took : fmax(TRIAL_REST * took, lost / TRIAL_SHARE));
    if (ratio < TRIAL_WINS_BY_FAR || loop->wins[m] >= (is_small(sim) ? TRIALS_TO_WIN : 1)) {
        loop->due[loop->best] = loop->spent + TRIAL_REST * took;
        loop->best = m;
        loop->pace = pace;
        memset(loop->wins, 0, sizeof loop->wins);
    }
}

void step_loop_note(simulation *sim, int steps, double seconds)
{
    step_loop *loop = &sim->loop;
    double work = (double)steps * (1.0 + (double)sim->table.record_count); /* their number changes between one trial and the next */
    if (loop->batches++ == 0 || steps <= 0)
        return;
    loop->spent += seconds;
    loop->trial_work += work;
    if (loop->settling > 0) {
        loop->settling--;
        return;
    }
    if (fixed_manner(sim) != LOOP_MANNERS)
        return;
    if (loop->manner == loop->best) {
        follow(&loop->pace, seconds / work);
        return;
    }
    loop->timed_work += work;
    loop->timed_seconds += seconds;
    if (++loop->timed >= (is_small(sim) ? TRIAL_BATCHES : 1))
        end_trial(sim);
}

/* Batches of another manner than before: a trial, or the best again. */
static void begin_manner(simulation *sim)
{
    step_loop *loop = &sim->loop;
    loop->settling = is_small(sim) ? SETTLING_BATCHES : 0;
    loop->timed = 0;
    loop->trial_begin = loop->spent;
    loop->trial_work = loop->timed_work = loop->timed_seconds = 0.0;
}

void step_loop_note_table(simulation *sim, int64_t lasted, double seconds)
{
    step_loop *loop = &sim->loop;
    if (loop->batches < 2 || loop->settling > 0 || lasted <= 0)
        return;
    follow(&loop->table[loop->manner], seconds);
    follow(&loop->table_steps, (double)lasted);
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
    loop_manner before = loop->manner;
    loop->manner = choose_manner(sim);
    if (loop->manner != before)
        begin_manner(sim);
    int bond_step = bonds_step(sim, steps), most = loop->manner == LOOP_TEAM ? step_loop_members(sim) : 1, items = step_loop_items(sim);
    TRY(fit_rows(sim, steps, why));
    for (int s = 0; s < steps; s++) {
        clast_launch launch = launch_of_step(sim, s, bond_step);
        launch.first_wall_place = sim->plan.force_records > 0 ? sim->plan.force_records : sim->table.wall_base;
        loop->rows[s] = launch_as_passed(launch);
    }
    TRY(store_write(sim, loop->launches, 0, sizeof *loop->rows * (uint64_t)steps, loop->rows, why));
    TRY(launch_set(kernel, "step_loop", why, "mmmmmiii", loop->launches, sim->control, loop->team, loop->phases, loop->pieces, (cl_int)steps,
                   (cl_int)most, (cl_int)-1));
    if (loop->manner == LOOP_PHASES)
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
