/* What conducts, and the surfaces, follow the temperatures while nothing moves: by conductivities that depend on them, or by the grains' growth. */
#include "frozen_parts.h"

bool frozen_follows(const simulation *sim)
{
    return (sim->live.law[SLOT_CONDUCTION] && sim->live.law[SLOT_CONDUCTIVITY]) || sim->live.law[SLOT_RADIUS];
}

cl_mem frozen_rates_at_start(const simulation *sim)
{
    return frozen_follows(sim) && frozen_stage(sim)->heat_method != HEAT_EXPLICIT ? sim->frozen.begin : sim->frozen.start;
}

status frozen_probe(simulation *sim, cl_mem rises, double share, failure *why)
{
    clast_launch launch = launch_values(sim);
    cl_kernel kernel = launch_kernel(sim, "heat_frozen_probe");
    TRY(launch_set(kernel, "heat_frozen_probe", why, sim->mixed ? "Lmf" : "Lmd", &launch, rises, share));
    return frozen_run_grains(sim, "heat_frozen_probe", 3, why);
}

status frozen_look_up(simulation *sim, cl_mem rises, double share, failure *why)
{
    TRY(frozen_probe(sim, rises, share, why));
    sim->frozen.linked = false;
    TRY(frozen_link(sim, why));
    return frozen_find_limit(sim, why);
}

status frozen_take_back(simulation *sim, failure *why)
{
    return frozen_follows(sim) ? frozen_look_up(sim, sim->frozen.zero, 1.0, why) : STATUS_OK;
}

status frozen_keep_start(simulation *sim, failure *why)
{
    return store_copy(sim, sim->frozen.start, sim->frozen.begin, 0, 0, sim->frozen.grain_bytes, why);
}

/* Share of the skin that grains may use up by growing before the pairs are looked for anew. */
#define GROWN_SHARE 0.25

/* Two that grow by half of it may meet unseen. */
static status skin_used(simulation *sim, double *share, failure *why)
{
    double growth;
    *share = 0.0;
    if (!sim->live.law[SLOT_RADIUS])
        return STATUS_OK;
    TRY(table_growth(sim, &growth, why));
    *share = (growth - sim->table.growth) / sim->table.skin;
    return STATUS_OK;
}

status frozen_fits_table(simulation *sim, bool *fits, failure *why)
{
    double share;
    TRY(skin_used(sim, &share, why));
    *fits = share <= 0.5;
    return STATUS_OK;
}

status frozen_follow_growth(simulation *sim, failure *why)
{
    double share;
    TRY(skin_used(sim, &share, why));
    if (share <= GROWN_SHARE)
        return STATUS_OK;
    TRY(table_build(sim, false, why));
    sim->frozen.linked = false;
    TRY(frozen_link(sim, why));
    return frozen_find_limit(sim, why);
}
