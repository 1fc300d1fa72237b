/* What a run tells the user. */
#include "clock.h"
#include "run_parts.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

void run_tell(const run *r, const char *format, ...)
{
    va_list values;
    if (r->quiet)
        return;
    va_start(values, format);
    if (r->terminal)
        fputs("\r\033[K", stderr);
    vfprintf(stderr, format, values);
    fputc('\n', stderr);
    va_end(values);
}

/* Share of the stage that is done, where time or steps end it; negative where only rest does. */
static double stage_share(const run *r)
{
    const scene_stage *stage = &r->scene->stage[r->sim->stage];
    double share = -1.0;
    if (!isnan(stage->until_time_s) && stage->until_time_s > 0.0)
        share = (r->sim->time - r->schedule.stage_start) / stage->until_time_s;
    if (stage->until_steps > 0)
        share = fmax(share, (double)r->sim->stage_steps / (double)stage->until_steps);
    return share;
}

void run_show_progress(run *r)
{
    double now = clock_seconds(), every = r->terminal ? 0.5 : 10.0;
    if (r->quiet || now - r->shown < every)
        return;
    r->shown = now;
    double rate = (double)(r->sim->step - r->first_step) / (now - r->started), share = stage_share(r);
    char part[64] = "";
    if (share >= 0.0)
        snprintf(part, sizeof part, " %5.1f %%", 100.0 * share);
    fprintf(stderr, "%s%s%s  t = %.6g s  step %lld  dt = %.3g s  %.3g steps/s  %.3g particle-steps/s%s", r->terminal ? "\r\033[K" : "",
            r->scene->stage[r->sim->stage].name, part, r->sim->time, (long long)r->sim->step, r->sim->dt, rate, rate * (double)r->sim->count,
            r->terminal ? "" : "\n");
    fflush(stderr);
}

void run_summarise(run *r)
{
    const simulation *sim = r->sim;
    double wall = clock_seconds() - r->started;
    int64_t steps = sim->step - r->first_step, rebuilds = sim->rebuilds - r->first_rebuilds;
    char text[512];
    failure ignored;
    snprintf(text, sizeof text,
             "%lld steps of %lld grains in %.3g s: %.3g particle-steps/s; %lld tables, %.3g s (%.1f %%), one in %.3g steps, skin %.3g m; %.0f bytes a grain on "
             "the device",
             (long long)steps, (long long)sim->id_count, wall, wall > 0.0 ? (double)steps * (double)sim->id_count / wall : 0.0,
             (long long)rebuilds, sim->rebuild_seconds, wall > 0.0 ? 100.0 * sim->rebuild_seconds / wall : 0.0,
             rebuilds > 0 ? (double)steps / (double)rebuilds : 0.0, sim->table.skin, (double)sim->bytes / (double)sim->id_count);
    run_tell(r, "%s", text);
    output_text(r->output, "summary", text, &ignored);
}

status run_report_sources(run *r, failure *why)
{
    heat_sums sums;
    bool met[SOURCES_MAX] = {false};
    if (!r->sim->live.law[SLOT_SOURCE])
        return STATUS_OK;
    TRY(heat_observe(r->sim, &sums, why));
    TRY(beams_met(r->sim, met, why));
    double absorbed = sums.tally[CLAST_TALLY_ABSORBED], delivered = r->sim->beams.delivered, share = delivered > 0.0 ? absorbed / delivered : 0.0;
    run_tell(r, "sources: %.6g J delivered, %.6g J absorbed (%.1f %%)", delivered, absorbed, 100.0 * share);
    if (share > 1.0)
        run_tell(r, "warning: the grains absorb more than the beams carry: several layers together take more than falls on them; lower the absorptance or "
                "raise the attenuation");
    for (int b = 0; b < r->sim->beams.count; b++)
        if (!met[b])
            run_tell(r, "warning: the source `%s` has met no grain; look at the positions, direction and diameter of its beam", scene_beam(r->scene, b)->name);
    return STATUS_OK;
}

