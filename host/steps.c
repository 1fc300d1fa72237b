/* Steps by batches, with a table where one is due. */
#include "clock.h"
#include "simulation.h"

#include <math.h>
#include <stdlib.h>

double simulation_time_after(const simulation *sim, int64_t steps)
{
    return sim->segment_time + (double)(sim->step + steps - sim->segment_step) * sim->dt;
}

void simulation_set_step(simulation *sim, double dt)
{
    sim->segment_time = sim->time;
    sim->segment_step = sim->step;
    sim->dt = dt;
    if (sim->mixed) { /* time and motion agree on it; rounded up, so that whole steps to the end of a stage leave no sliver for one more */
        float nearest = (float)dt;
        sim->dt = (double)((double)nearest < dt ? nextafterf(nearest, INFINITY) : nearest);
    }
}

status simulation_count_leavers(simulation *sim, int64_t kept, failure *why)
{
    if (kept == sim->count)
        return STATUS_OK;
    int64_t gone = sim->count - kept;
    int32_t *order = malloc(sizeof *order * (size_t)gone);
    double *mass = malloc(sizeof *mass * (size_t)sim->stride);
    status result = order && mass ? STATUS_OK : fail(why, STATUS_ERROR, "out of memory");
    if (result == STATUS_OK)
        result = store_read(sim, sim->table.work[2], 4 * (uint64_t)kept, 4 * (uint64_t)gone, order, why);
    if (result == STATUS_OK)
        result = store_get_grains(sim, store_find(sim, "mass"), sim->stride, mass, why);
    for (int64_t k = 0; k < gone && result == STATUS_OK; k++)
        sim->left_mass += mass[order[k]];
    if (result == STATUS_OK)
        result = ledger_leave(sim, order, gone, why);
    free(order);
    free(mass);
    sim->left_count += gone;
    sim->count = kept;
    return result;
}

clast_launch launch_of_step(const simulation *sim, int s, int bond_step)
{
    clast_launch launch = launch_values(sim);
    launch.bonding = s == bond_step;
    double since = sim->time + (double)(s + 1) * sim->dt - sim->built_time;
    launch.step = s;
    launch.lag = s == 0 ? sim->lag : sim->dt;
    launch.kick = live_keeps_half_steps(&sim->live) ? 0.5 * (launch.lag + sim->dt) : sim->dt;
    launch.face_row = sim->walls_move ? s : 0;
    launch.mover_row = sim->groups_move ? s : 0;
    launch.heat_row = sim->heat.vary ? s : 0;
    launch.heat_span = heat_steps_span(sim, s);
    for (int c = 0; c < 3; c++)
        launch.drift[c] = sim->drift_velocity[c] * since;
    return launch;
}

/* Packets as the grains are at the start of a batch; its steps keep them up. */
status steps_pack_grains(simulation *sim, failure *why)
{
    int blocks = (int)(sim->stride / sim->block);
    if (!sim->live.law[SLOT_PACKED])
        return STATUS_OK;
    cl_kernel kernel = launch_kernel(sim, "particle_pack");
    TRY(launch_set(kernel, "particle_pack", why, "i", (cl_int)blocks));
    return launch_run(sim, kernel, "particle_pack", blocks, 1, why);
}

static status enqueue_batch(simulation *sim, int steps, failure *why)
{
    int bond_step = bonds_step(sim, steps);
    TRY(steps_pack_grains(sim, why));
    if (step_loop_now(sim))
        return step_loop_enqueue(sim, steps, why);
    for (int s = 0; s < steps; s++) {
        clast_launch launch = launch_of_step(sim, s, bond_step);
        TRY(heat_sum_areas(sim, &launch, why));
        TRY(step_plan_enqueue(sim, sim->device->queue, launch, NULL, why));
        TRY(servo_step(sim, &launch, steps, why));
    }
    return STATUS_OK;
}

/* Steps before a wall has used up its half of the skin. */
static int steps_before_walls(const simulation *sim, int steps)
{
    if (!sim->walls_move)
        return steps;
    for (int s = 0; s < steps; s++)
        if (body_rows_wall_travel(sim, sim->time + (double)s * sim->dt) > servo_share(sim) * sim->table.skin)
            return s;
    return steps;
}

/* One batch; *done of the steps asked for were taken, and *rebuild tells that a table is due before the next. */
static status run_batch(simulation *sim, int steps, int *done, bool *rebuild, failure *why)
{
    clast_control control = {steps, 0, {0, 0}};
    int bonding = bonds_step(sim, steps);
    TRY(beams_before_batch(sim, why));
    if (sim->walls_move || sim->groups_move || sim->heat.vary)
        TRY(body_rows_write(sim, steps, why));
    double start = clock_seconds();
    TRY(store_write(sim, sim->control, 0, sizeof control, &control, why));
    TRY(enqueue_batch(sim, steps, why));
    TRY(store_read(sim, sim->control, 0, sizeof control, &control, why));
    TRY(servo_end(sim, why));
    *done = control.halt_step < steps ? control.halt_step : steps;
    step_loop_note(sim, *done, clock_seconds() - start);
    sim->bonding_done = sim->bonding_done || (bonding >= 0 && bonding < *done);
    *rebuild = control.reason != 0;
    for (int s = 0; s < *done; s++)
        beams_deliver(sim, simulation_time_after(sim, s), sim->dt);
    return STATUS_OK;
}

status simulation_advance(simulation *sim, int64_t steps, failure *why)
{
    double start = clock_seconds(), rebuilding = sim->rebuild_seconds;
    while (steps > 0) {
        int64_t most = beams_steps_allowed(sim, sim->batch_limit < steps ? sim->batch_limit : steps);
        int allowed = steps_before_walls(sim, (int)most), done = 0;
        bool rebuild = allowed == 0;
        if (allowed == 0 && sim->step == sim->rebuild_step && sim->table.built)
            allowed = 1; /* a wall that outruns the skin in one step: a table a step */
        if (allowed > 0)
            TRY(run_batch(sim, allowed, &done, &rebuild, why));
        heat_steps_note(sim, done);
        sim->step += done;
        sim->stage_steps += done;
        sim->lag = done > 0 ? sim->dt : sim->lag;
        sim->time = simulation_time_after(sim, 0);
        steps -= done;
        if (rebuild)
            skin_adapt(sim);
        else
            TRY(skin_look(sim, &rebuild, why));
        if (rebuild) {
            int64_t lasted = sim->step - sim->rebuild_step;
            double before = sim->rebuild_seconds;
            TRY(simulation_pose_now(sim, why));
            TRY(table_build(sim, false, why));
            form_trials_note_table(&sim->loop.trials, lasted, sim->rebuild_seconds - before);
        }
    }
    sim->step_seconds += clock_seconds() - start - (sim->rebuild_seconds - rebuilding);
    return STATUS_OK;
}
