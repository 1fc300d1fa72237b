#include "steady.h"

#include "frozen.h"
#include "schedule.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void look_free(temperature_look *look)
{
    free(look->value);
    look->value = NULL;
}

int64_t steady_interval(const scene_stage *stage)
{
    return REST_CHECK_STEPS * stage->heat_every;
}

status look_at_temperatures(simulation *sim, temperature_look *last, double *change, double *span, failure *why)
{
    double *now = NULL;
    TRY(observe_field(sim, "temperature", &now, why));
    *change = last->value ? 0.0 : INFINITY;
    *span = last->value ? sim->time - last->time : INFINITY;
    for (int64_t i = 0; last->value && i < sim->id_count; i++)
        *change = fmax(*change, fabs(now[i] - last->value[i])); /* fmax passes over grains that have left */
    look_free(last);
    *last = (temperature_look){now, sim->time};
    return STATUS_OK;
}

status rounds_end(stage_rounds *rounds, simulation *sim, bool *again, char *text, size_t size, failure *why)
{
    const scene_stage *stage = &sim->scene->stage[sim->stage];
    double change, span, range;
    TRY(look_at_temperatures(sim, &rounds->last, &change, &span, why));
    TRY(frozen_range(sim, &range, why));
    rounds->range = fmax(rounds->range, range);
    double allowed = stage->repeat_change * rounds->range;
    rounds->round++;
    *again = !(change <= allowed) && rounds->round < stage->repeat_rounds;
    if (isnan(allowed) || !isfinite(change))
        snprintf(text, size, "stage %s: end of round %lld", stage->name, (long long)rounds->round);
    else if (change <= allowed || *again)
        snprintf(text, size, "stage %s: end of round %lld: temperatures have changed by at most %.3g K, %.3g of their range; asked for %.3g", stage->name,
                 (long long)rounds->round, change, rounds->range > 0.0 ? change / rounds->range : 0.0, stage->repeat_change);
    else
        snprintf(text, size, "warning: stage %s: in the last of %lld rounds temperatures still changed by %.3g K, %.3g of their range; `until_change` is %.3g",
                 stage->name, (long long)rounds->round, change, rounds->range > 0.0 ? change / rounds->range : 0.0, stage->repeat_change);
    if (!*again) {
        look_free(&rounds->last);
        rounds->round = 0;
    }
    return STATUS_OK;
}

/* ---- checkpoints ---- */

void look_save(const temperature_look *look, const simulation *sim, const char *name, bundle *out)
{
    char place[64];
    if (!look->value)
        return;
    snprintf(place, sizeof place, "%s/temperature", name);
    bundle_add(out, place, BUNDLE_F64, sim->id_count, 1, look->value);
    snprintf(place, sizeof place, "%s/time", name);
    bundle_add_f64(out, place, look->time);
}

status look_load(temperature_look *look, const simulation *sim, const char *name, const bundle *in, failure *why)
{
    const bundle_entry *value, *time;
    char place[64];
    snprintf(place, sizeof place, "%s/temperature", name);
    if (!bundle_find(in, place))
        return STATUS_OK;
    TRY(bundle_get(in, "the checkpoint", place, BUNDLE_F64, sim->id_count, 1, &value, why));
    snprintf(place, sizeof place, "%s/time", name);
    TRY(bundle_get(in, "the checkpoint", place, BUNDLE_F64, 1, 1, &time, why));
    size_t bytes = sizeof *look->value * (size_t)sim->id_count;
    look->value = malloc(bytes + 1);
    if (!look->value)
        return fail(why, STATUS_ERROR, "out of memory");
    memcpy(look->value, value->data, bytes);
    look->time = *(double *)time->data;
    return STATUS_OK;
}

void rounds_save(const stage_rounds *rounds, const simulation *sim, bundle *out)
{
    bundle_add_i64(out, "rounds/round", rounds->round);
    bundle_add_f64(out, "rounds/range", rounds->range);
    look_save(&rounds->last, sim, "rounds", out);
}

status rounds_load(stage_rounds *rounds, const simulation *sim, const bundle *in, const char *path, failure *why)
{
    const bundle_entry *round, *range;
    TRY(bundle_get(in, path, "rounds/round", BUNDLE_I64, 1, 1, &round, why));
    TRY(bundle_get(in, path, "rounds/range", BUNDLE_F64, 1, 1, &range, why));
    rounds->round = *(int64_t *)round->data;
    rounds->range = *(double *)range->data;
    return look_load(&rounds->last, sim, "rounds", in, why);
}
