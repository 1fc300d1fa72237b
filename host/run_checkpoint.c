/* The state of a run as a bundle: written as a checkpoint, and taken up again. */
#include "clock.h"
#include "run_parts.h"

#include <stdlib.h>
#include <string.h>

char *run_checkpoint_path(const char *results)
{
    size_t length = strlen(results), stem = length;
    if (length > 3 && strcmp(results + length - 3, ".h5") == 0)
        stem = length - 3;
    char *path = malloc(stem + sizeof ".checkpoint.h5");
    if (path) {
        memcpy(path, results, stem);
        strcpy(path + stem, ".checkpoint.h5");
    }
    return path;
}

/* ---- writing ---- */

static status save_state(run *r, bundle *out, failure *why)
{
    const schedule *s = &r->schedule;
    bundle_init(out);
    bundle_add_text(out, "scene/text", r->scene->text);
    bundle_add_text(out, "scene/path", r->scene->path);
    bundle_add_text(out, "run/results", r->results_path);
    bundle_add_i64(out, "schedule/next_frame", s->next_frame);
    bundle_add_i64(out, "schedule/next_observation", s->next_observation);
    bundle_add_i64(out, "schedule/next_checkpoint", s->next_checkpoint);
    bundle_add_i64(out, "schedule/rest_checks", s->rest_checks);
    bundle_add_f64(out, "schedule/stage_start", s->stage_start);
    bundle_add_f64(out, "schedule/recommended_s", s->recommended_s);
    bundle_add_i64(out, "schedule/automatic", s->automatic);
    bundle_add_f64(out, "steady/rate", r->sim->frozen.rate);
    look_save(&r->steady, r->sim, "steady", out);
    rounds_save(&r->rounds, r->sim, out);
    const simulation *sim = r->sim;
    const double measures[] = {sim->radius_min, sim->radius_max, sim->mean_radius, sim->mean_mass};
    bundle_add(out, "bed/measures", BUNDLE_F64, 4, 1, measures);
    bundle_add(out, "bed/low", BUNDLE_F64, 3, 1, sim->bed_low);
    bundle_add(out, "bed/high", BUNDLE_F64, 3, 1, sim->bed_high);
    return state_save(r->sim, out, why);
}

status run_write_checkpoint(run *r, failure *why)
{
    bundle state;
    status result = save_state(r, &state, why);
    if (result == STATUS_OK)
        result = bundle_write(&state, r->checkpoint_path, why);
    bundle_free(&state);
    return result;
}

/* Kept as often as it costs no more than a fiftieth of the run. */
status run_keep_good_state(run *r, failure *why)
{
    double now = clock_seconds();
    if (r->good.count > 0 && now - r->good_at < 50.0 * r->good_cost)
        return STATUS_OK;
    bundle_free(&r->good);
    TRY(save_state(r, &r->good, why));
    r->good_at = clock_seconds();
    r->good_cost = r->good_at - now;
    return STATUS_OK;
}

status run_stop_by_guard(run *r, const char *text, failure *why)
{
    failure other;
    const char *written = "no checkpoint: no earlier state passed the guards";
    if (r->good.count > 0)
        written = bundle_write(&r->good, r->checkpoint_path, &other) == STATUS_OK ? r->checkpoint_path : other.text;
    return fail(why, STATUS_GUARD, "%s (last good state: %s)", text, written);
}

/* ---- taking it up again ---- */

static status text_of(const bundle *in, const char *path, const char *name, char **out, failure *why)
{
    const bundle_entry *entry;
    TRY(bundle_get(in, path, name, BUNDLE_TEXT, -1, -1, &entry, why));
    *out = strndup(entry->data, (size_t)entry->rows);
    return *out ? STATUS_OK : fail(why, STATUS_ERROR, "out of memory");
}

static status schedule_load(schedule *s, const bundle *in, const char *path, failure *why)
{
    const struct {
        const char *name;
        int64_t *to;
    } integers[] = {{"schedule/next_frame", &s->next_frame},
                    {"schedule/next_observation", &s->next_observation},
                    {"schedule/next_checkpoint", &s->next_checkpoint},
                    {"schedule/rest_checks", &s->rest_checks}};
    const bundle_entry *entry;
    for (size_t k = 0; k < sizeof integers / sizeof *integers; k++) {
        TRY(bundle_get(in, path, integers[k].name, BUNDLE_I64, 1, 1, &entry, why));
        *integers[k].to = *(int64_t *)entry->data;
    }
    TRY(bundle_get(in, path, "schedule/stage_start", BUNDLE_F64, 1, 1, &entry, why));
    s->stage_start = *(double *)entry->data;
    TRY(bundle_get(in, path, "schedule/recommended_s", BUNDLE_F64, 1, 1, &entry, why));
    s->recommended_s = *(double *)entry->data;
    TRY(bundle_get(in, path, "schedule/automatic", BUNDLE_I64, 1, 1, &entry, why));
    s->automatic = *(int64_t *)entry->data != 0;
    return STATUS_OK;
}

/* The grains as the checkpoint knows them: files that the scene was made from may be gone. */
static status bed_of(const bundle *in, const char *path, const scene *scene, bed *out, failure *why)
{
    const bundle_entry *group, *radius, *measures;
    TRY(bundle_get(in, path, "particles/group", BUNDLE_I32, -1, 1, &group, why));
    TRY(bundle_get(in, path, "particles/radius", BUNDLE_F64, group->rows, 1, &radius, why));
    TRY(bundle_get(in, path, "bed/measures", BUNDLE_F64, 4, 1, &measures, why));
    size_t n = (size_t)group->rows;
    *out = (bed){.count = group->rows,
                 .position = calloc(n, sizeof *out->position),
                 .velocity = calloc(n, sizeof *out->velocity),
                 .spin = calloc(n, sizeof *out->spin),
                 .radius = malloc(n * sizeof *out->radius),
                 .temperature = calloc(n, sizeof *out->temperature),
                 .material = malloc(n * sizeof *out->material),
                 .group = malloc(n * sizeof *out->group)};
    if (!out->position || !out->velocity || !out->spin || !out->radius || !out->temperature || !out->material || !out->group)
        return fail(why, STATUS_ERROR, "out of memory");
    for (size_t i = 0; i < n; i++) {
        int32_t g = ((int32_t *)group->data)[i];
        double r = ((double *)radius->data)[i];
        if (g < 0 || g >= scene->group_count)
            return fail(why, STATUS_BAD_INPUT, "%s: particles/group holds %d, the scene has %d groups", path, g, scene->group_count);
        out->group[i] = g;
        out->material[i] = scene->group[g].material;
        out->radius[i] = r > 0.0 ? r : *(double *)measures->data; /* a grain that has left */
    }
    /* grains that could turn at the start can turn now, even if none does */
    if (n > 0 && bundle_find(in, "particles/spin"))
        out->spin[0][0] = 1.0;
    return STATUS_OK;
}

static status load_measures(simulation *sim, const bundle *in, const char *path, failure *why)
{
    const bundle_entry *measures, *low, *high;
    TRY(bundle_get(in, path, "bed/measures", BUNDLE_F64, 4, 1, &measures, why));
    TRY(bundle_get(in, path, "bed/low", BUNDLE_F64, 3, 1, &low, why));
    TRY(bundle_get(in, path, "bed/high", BUNDLE_F64, 3, 1, &high, why));
    const double *m = measures->data;
    sim->radius_min = m[0];
    sim->radius_max = m[1];
    sim->mean_radius = m[2];
    sim->mean_mass = m[3];
    memcpy(sim->bed_low, low->data, sizeof sim->bed_low);
    memcpy(sim->bed_high, high->data, sizeof sim->bed_high);
    return STATUS_OK;
}

/* A run goes on in the precision that it began in. */
static status precision_of(const bundle *in, const char *path, scene *scene, failure *why)
{
    const bundle_entry *mixed;
    TRY(bundle_get(in, path, "run/mixed", BUNDLE_I64, 1, 1, &mixed, why));
    scene->precision = *(int64_t *)mixed->data ? PRECISION_MIXED : PRECISION_DOUBLE;
    return STATUS_OK;
}

status run_load_scene(run *r, const bundle *in, const char *path, char **results, failure *why)
{
    char *text = NULL, *scene_path = NULL;
    *results = NULL;
    status result = text_of(in, path, "scene/text", &text, why);
    if (result == STATUS_OK)
        result = text_of(in, path, "scene/path", &scene_path, why);
    if (result == STATUS_OK)
        result = text_of(in, path, "run/results", results, why);
    if (result == STATUS_OK)
        result = scene_read_text(text, scene_path, 0, NULL, &r->scene, why);
    free(text);
    free(scene_path);
    TRY(result);
    TRY(precision_of(in, path, r->scene, why));
    return bed_of(in, path, r->scene, &r->bed, why);
}

status run_load_state(run *r, const bundle *in, const char *path, failure *why)
{
    const bundle_entry *rate;
    TRY(schedule_load(&r->schedule, in, path, why));
    TRY(load_measures(r->sim, in, path, why));
    TRY(state_load(r->sim, in, path, why));
    TRY(rounds_load(&r->rounds, r->sim, in, path, why));
    TRY(look_load(&r->steady, r->sim, "steady", in, why));
    TRY(bundle_get(in, path, "steady/rate", BUNDLE_F64, 1, 1, &rate, why));
    r->sim->frozen.rate = *(double *)rate->data;
    return STATUS_OK;
}
