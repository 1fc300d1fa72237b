/* The step in one work-group that loops over many of them (kernels/stage/step_loop.cl), and where it is the faster form. */
#include "laws/laws.h"
#include "simulation.h"

#include <stdlib.h>

/* Under pocl a work-group is one thread's; on a GPU it has one multiprocessor, and a launch costs less. */
#define LOOP_ITEMS_GPU 512

int step_loop_items(const simulation *sim)
{
    return sim->device->info.cpu ? 1 : LOOP_ITEMS_GPU;
}

/* Records up to which one work-group is faster than two launches a step (docs/performance.md). */
static int loop_records(const simulation *sim)
{
    return sim->device->tuning.loop_records;
}

/* A grain has at least a record in any bed that is not dilute. Where walls give a heat flow, their areas are summed in a launch of its own
 * between the two stages; where they keep a force, a launch of its own behind them moves them. */
bool step_loop_wanted(const simulation *sim)
{
    step_form form = sim->scene->table.step_form;
    if (sim->live.law[SLOT_WALL_HEAT] == &law_wall_flux || sim->live.servo)
        return false;
    return form == STEP_ONE_GROUP || (form == STEP_AUTO && sim->id_count <= loop_records(sim));
}

bool step_loop_now(const simulation *sim)
{
    if (!launch_kernel(sim, "step_loop"))
        return false;
    return sim->scene->table.step_form == STEP_ONE_GROUP || sim->table.record_count <= loop_records(sim);
}

status step_loop_bind(simulation *sim, failure *why)
{
    cl_kernel kernel = launch_kernel(sim, "step_loop");
    return kernel ? launch_bind(sim, "step_loop", 5, why) : STATUS_OK;
}

static status fit_launches(simulation *sim, int steps, failure *why)
{
    if (steps <= sim->loop_capacity)
        return STATUS_OK;
    store_release(sim, &sim->launches, sizeof *sim->launch_rows * (uint64_t)sim->loop_capacity);
    free(sim->launch_rows);
    sim->loop_capacity = 0;
    sim->launch_rows = malloc(sizeof *sim->launch_rows * (size_t)steps);
    if (!sim->launch_rows)
        return fail(why, STATUS_ERROR, "out of memory");
    TRY(store_buffer(sim, &sim->launches, sizeof *sim->launch_rows * (uint64_t)steps, "values of the steps of a batch", why));
    sim->loop_capacity = steps;
    return STATUS_OK;
}

status step_loop_enqueue(simulation *sim, int steps, failure *why)
{
    cl_kernel kernel = launch_kernel(sim, "step_loop");
    contact_table *t = &sim->table;
    int bond_step = bonds_step(sim, steps);
    TRY(fit_launches(sim, steps, why));
    for (int s = 0; s < steps; s++)
        sim->launch_rows[s] = launch_as_passed(launch_of_step(sim, s, bond_step));
    TRY(store_write(sim, sim->launches, 0, sizeof *sim->launch_rows * (uint64_t)steps, sim->launch_rows, why));
    TRY(launch_set(kernel, "step_loop", why, "mmiii", sim->launches, sim->control, (cl_int)steps, (cl_int)t->record_count, (cl_int)t->wall_base));
    int items = step_loop_items(sim);
    return launch_run(sim, kernel, "step_loop", items, items, why);
}
