/* Heat that is advanced every n-th mechanical step. */
#include "simulation.h"

/* What temperatures advance by in step s of the batch to come. The same bits whatever the batches: it depends on counts of steps, and where the
 * step has changed since the last time, on that time. */
double heat_steps_span(const simulation *sim, int s)
{
    if (!sim->live.law[SLOT_HEAT_STEPS])
        return sim->dt;
    int64_t every = sim->scene->stage[sim->stage].heat_every;
    if ((sim->stage_steps + s + 1) % every != 0)
        return 0.0;
    bool alike = sim->step + s + 1 - every >= sim->segment_step;
    return alike ? (double)every * sim->dt : simulation_time_after(sim, s + 1) - sim->heat.since;
}

void heat_steps_note(simulation *sim, int done)
{
    for (int s = done - 1; s >= 0 && sim->live.law[SLOT_HEAT_STEPS]; s--)
        if (heat_steps_span(sim, s) > 0.0) {
            sim->heat.since = simulation_time_after(sim, s + 1);
            return;
        }
}

/* At the end of a stage nothing may wait. */
status heat_steps_end(simulation *sim, failure *why)
{
    cl_kernel kernel = launch_kernel(sim, "heat_flush");
    if (kernel && sim->time > sim->heat.since) {
        TRY(simulation_pose_now(sim, why));
        clast_launch launch = launch_values(sim);
        launch.heat_span = sim->time - sim->heat.since;
        TRY(launch_pass(kernel, "heat_flush", &launch, why));
        TRY(launch_bind(sim, "heat_flush", 1, why));
        TRY(launch_run(sim, kernel, "heat_flush", sim->count, sim->block, why));
    }
    sim->heat.since = sim->time;
    return STATUS_OK;
}
