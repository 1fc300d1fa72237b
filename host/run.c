#include "run.h"

#include "frozen.h"
#include "output.h"
#include "schedule.h"
#include "steady.h"

#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/* Set by the signal handler alone. */
static volatile sig_atomic_t interrupted;

static void note_signal(int signal_number)
{
    (void)signal_number;
    interrupted = 1;
}

void run_catch_signals(void)
{
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = note_signal;
    action.sa_flags = SA_RESETHAND; /* a second one ends the program at once */
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

typedef struct run {
    scene *scene;
    bed bed;
    device device;
    simulation *sim;
    output *output;
    schedule schedule;
    temperature_look steady; /* at the last look, in stages that move and end when temperatures stand */
    stage_rounds rounds;
    char *results_path, *checkpoint_path;
    bundle good;      /* the last state that passed the guards; empty at first */
    double good_cost, good_at; /* wall seconds that it took, and when */
    int64_t beyond_limit; /* looks in a row at which the step was past twice its limit */
    bool quiet, terminal;
    double started, shown, chunk_steps, stepping;
    int64_t first_step;
} run;

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void run_free(run *r)
{
    failure ignored;
    if (r->output)
        output_close(r->output, &ignored);
    simulation_free(r->sim);
    bed_free(&r->bed);
    scene_free(r->scene);
    bundle_free(&r->good);
    look_free(&r->steady);
    look_free(&r->rounds.last);
    device_close(&r->device);
    free(r->results_path);
    free(r->checkpoint_path);
}

/* <stem>.checkpoint.h5 beside the result. */
static char *checkpoint_path_of(const char *results)
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

/* ---- telling the user ---- */

static void tell(const run *r, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void tell(const run *r, const char *format, ...)
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

static void show_progress(run *r)
{
    double now = seconds(), every = r->terminal ? 0.5 : 10.0;
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

static void summarise(run *r)
{
    const simulation *sim = r->sim;
    double wall = seconds() - r->started;
    int64_t steps = sim->step - r->first_step;
    char text[512];
    failure ignored;
    snprintf(text, sizeof text,
             "%lld steps of %lld grains in %.3g s: %.3g particle-steps/s; %lld tables, %.3g s (%.1f %%), one in %.3g steps, skin %.3g m; %.0f bytes a grain on "
             "the device",
             (long long)steps, (long long)sim->id_count, wall, wall > 0.0 ? (double)steps * (double)sim->id_count / wall : 0.0,
             (long long)sim->rebuilds, sim->rebuild_seconds, wall > 0.0 ? 100.0 * sim->rebuild_seconds / wall : 0.0,
             sim->rebuilds ? (double)steps / (double)sim->rebuilds : 0.0, sim->table.skin, (double)sim->bytes / (double)sim->id_count);
    tell(r, "%s", text);
    output_text(r->output, "summary", text, &ignored);
}

/* What the beams of a scene delivered and what the grains took, and beams that met none. */
static status report_sources(run *r, failure *why)
{
    heat_sums sums;
    bool met[SOURCES_MAX] = {false};
    if (!r->sim->live.law[SLOT_SOURCE])
        return STATUS_OK;
    TRY(heat_observe(r->sim, &sums, why));
    TRY(beams_met(r->sim, met, why));
    double absorbed = sums.tally[CLAST_TALLY_ABSORBED], delivered = r->sim->beams.delivered, share = delivered > 0.0 ? absorbed / delivered : 0.0;
    tell(r, "sources: %.6g J delivered, %.6g J absorbed (%.1f %%)", delivered, absorbed, 100.0 * share);
    if (share > 1.0)
        tell(r, "warning: the grains absorb more than the beams carry: several layers together take more than falls on them; lower the absorptance or "
                "raise the attenuation");
    for (int b = 0; b < r->sim->beams.count; b++)
        if (!met[b])
            tell(r, "warning: the source `%s` has met no grain; look at the positions, direction and diameter of its beam", scene_beam(r->scene, b)->name);
    return STATUS_OK;
}

/* ---- checkpoints ---- */

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

static status write_checkpoint(run *r, failure *why)
{
    bundle state;
    status result = save_state(r, &state, why);
    if (result == STATUS_OK)
        result = bundle_write(&state, r->checkpoint_path, why);
    bundle_free(&state);
    return result;
}

/* Kept as often as it costs no more than a fiftieth of the run. */
static status keep_good_state(run *r, failure *why)
{
    double now = seconds();
    if (r->good.count > 0 && now - r->good_at < 50.0 * r->good_cost)
        return STATUS_OK;
    bundle_free(&r->good);
    TRY(save_state(r, &r->good, why));
    r->good_at = seconds();
    r->good_cost = r->good_at - now;
    return STATUS_OK;
}

static status stop_by_guard(run *r, const char *text, failure *why)
{
    failure other;
    const char *written = "no checkpoint: no earlier state passed the guards";
    if (r->good.count > 0)
        written = bundle_write(&r->good, r->checkpoint_path, &other) == STATUS_OK ? r->checkpoint_path : other.text;
    return fail(why, STATUS_GUARD, "%s (last good state: %s)", text, written);
}

/* ---- looks between steps ---- */

/* A fixed step may pass its limit for moments, as contacts deepen in a collision; for long it may not. */
#define LOOKS_BEYOND_LIMIT 20

static status look_at_limit(run *r, failure *why)
{
    step_limit limit;
    char text[512];
    simulation *sim = r->sim;
    const scene_stage *stage = &r->scene->stage[sim->stage];
    TRY(limit_find(sim, &limit, why));
    if (r->schedule.automatic) {
        schedule_adapt(&r->schedule, sim, limit.recommended_s);
        return STATUS_OK;
    }
    r->beyond_limit = sim->dt > 2.0 * limit.live_s && !stage->allow_unstable_step ? r->beyond_limit + 1 : 0;
    if (r->beyond_limit < LOOKS_BEYOND_LIMIT)
        return STATUS_OK;
    snprintf(text, sizeof text,
             "%s: stopped by a guard at t = %.9g s (step %lld): the step of %.3g s has been past twice its limit of %.3g s (%s) for long; "
             "try step_s: auto, or at most %.3g",
             r->scene->path, sim->time, (long long)sim->step, sim->dt, limit.live_s, limit.binds, limit.recommended_s);
    return stop_by_guard(r, text, why);
}

static status look_for_rest(run *r, failure *why)
{
    const scene_stage *stage = &r->scene->stage[r->sim->stage];
    particle_sums sums;
    TRY(observe_particle_sums(r->sim, &sums, why));
    double g = sqrt(pow(r->sim->gravity[0], 2) + pow(r->sim->gravity[1], 2) + pow(r->sim->gravity[2], 2));
    bool rest = (!isnan(stage->until_rest) && sums.kinetic < stage->until_rest * g * sums.weight_radius) ||
                (!isnan(stage->until_rest_j) && sums.kinetic < stage->until_rest_j);
    r->schedule.rest_checks = rest ? r->schedule.rest_checks + 1 : 0;
    return STATUS_OK;
}

static status look_for_steady(run *r, failure *why)
{
    double change, span;
    TRY(look_at_temperatures(r->sim, &r->steady, &change, &span, why));
    r->sim->frozen.rate = change / span;
    return STATUS_OK;
}

static status look_at_guards(run *r, failure *why)
{
    guard_finding finding;
    TRY(guard_check(r->sim, &finding, why));
    if (finding.stop)
        return stop_by_guard(r, finding.text, why);
    return keep_good_state(r, why);
}

static bool every(int64_t steps, int64_t interval)
{
    return interval > 0 && steps % interval == 0;
}

static status looks(run *r, failure *why)
{
    simulation *sim = r->sim;
    const scene_stage *stage = &r->scene->stage[sim->stage];
    if (every(sim->stage_steps, r->scene->guards.every_steps))
        TRY(look_at_guards(r, why));
    if ((!isnan(stage->until_rest) || !isnan(stage->until_rest_j)) && every(sim->stage_steps, REST_CHECK_STEPS))
        TRY(look_for_rest(r, why));
    if (!isnan(stage->until_steady_k_s) && every(sim->stage_steps, steady_interval(stage)))
        TRY(look_for_steady(r, why));
    if (every(sim->stage_steps, r->schedule.automatic ? LIMIT_CHECK_STEPS : 10 * r->scene->guards.every_steps))
        TRY(look_at_limit(r, why));
    return STATUS_OK;
}

/* ---- stages ---- */

static status refuse_step(const run *r, const scene_stage *stage, const step_limit *limit, failure *why)
{
    return fail(why, STATUS_BAD_INPUT,
                "%s:%d:%d: stage %s: step_s of %.4g s is past the stability limit of %.4g s (%s); recommended is %.4g s, or step_s: auto; "
                "allow_unstable_step: true runs it all the same",
                r->scene->path, stage->at.line, stage->at.column, stage->name, stage->step_s, limit->limit_s, limit->binds, limit->recommended_s);
}

static status begin_frozen_stage(run *r, const scene_stage *stage, failure *why)
{
    double limit, range;
    TRY(frozen_limit(r->sim, &limit, why));
    TRY(frozen_range(r->sim, &range, why));
    r->rounds.range = fmax(r->rounds.range, range);
    tell(r, "stage %s: motion is frozen; heat by the %s method, tolerance %.3g of the temperature range; limit of Euler's method %.4g s", stage->name,
         frozen_method_name(stage->heat_method), stage->heat_tolerance, limit);
    schedule_begin_stage(&r->schedule, r->sim, isfinite(limit) ? limit : 1.0);
    return STATUS_OK;
}

static status begin_stage(run *r, int index, failure *why)
{
    const scene_stage *stage = &r->scene->stage[index];
    step_limit limit;
    TRY(simulation_begin_stage(r->sim, index, why));
    if (stage->frozen)
        return begin_frozen_stage(r, stage, why);
    look_free(&r->steady);
    if (!isnan(stage->until_steady_k_s)) { /* the first look, to compare with */
        double change, span;
        TRY(look_at_temperatures(r->sim, &r->steady, &change, &span, why));
    }
    TRY(limit_find(r->sim, &limit, why));
    if (!isnan(stage->step_s) && stage->step_s > limit.limit_s && !stage->allow_unstable_step)
        return refuse_step(r, stage, &limit, why);
    tell(r, "stage %s: limit of the step %.4g s (%s), recommended %.4g s, taken %s", stage->name, limit.limit_s, limit.binds, limit.recommended_s,
         isnan(stage->step_s) ? "automatically" : "as given");
    if (!isnan(stage->step_s) && stage->step_s > limit.recommended_s)
        tell(r, "warning: stage %s: step_s of %.4g s is larger than recommended; compare with a smaller one", stage->name, stage->step_s);
    schedule_begin_stage(&r->schedule, r->sim, limit.recommended_s);
    r->beyond_limit = 0;
    return STATUS_OK;
}

static status interrupt(run *r, failure *why)
{
    TRY(write_checkpoint(r, why));
    return fail(why, STATUS_INTERRUPTED, "interrupted at t = %.9g s; go on with: clast resume %s", r->sim->time, r->checkpoint_path);
}

/* Writes what is due at the present step. */
static status write_due(run *r, failure *why)
{
    due now = schedule_due(&r->schedule, r->sim);
    if (r->schedule.automatic && (now.frame || now.observation))
        schedule_adapt(&r->schedule, r->sim, r->schedule.recommended_s);
    if (now.observation || now.frame || now.stage_end)
        TRY(output_observe(r->output, why));
    if (now.frame || now.stage_end)
        TRY(output_frame(r->output, why));
    return now.checkpoint ? write_checkpoint(r, why) : STATUS_OK;
}

/* Steps end on what is due. */
static status run_frozen_stage(run *r, failure *why)
{
    while (!schedule_stage_over(&r->schedule, r->sim)) {
        double start = seconds();
        TRY(frozen_advance(r->sim, schedule_next_time(&r->schedule, r->sim), 1, why));
        r->stepping += seconds() - start;
        show_progress(r);
        TRY(write_due(r, why));
        if (interrupted)
            return interrupt(r, why);
    }
    return STATUS_OK;
}

/* A signal is heard after the steps of a chunk, or once all that is due at a step is done: a checkpoint leaves nothing of its step to do. */
static status run_stage(run *r, failure *why)
{
    while (!schedule_stage_over(&r->schedule, r->sim)) {
        int64_t steps = schedule_steps(&r->schedule, r->sim);
        while (steps > 0) {
            /* about half a second, so that a signal is heard */
            int64_t some = (double)steps > r->chunk_steps ? (int64_t)r->chunk_steps : steps;
            double start = seconds();
            TRY(simulation_advance(r->sim, some, why));
            steps -= some;
            double spent = fmax(seconds() - start, 1e-6);
            r->stepping += spent;
            r->chunk_steps = fmax(1.0, fmin(1e6, (double)some * 0.5 / spent));
            show_progress(r);
            if (interrupted && steps > 0)
                return interrupt(r, why);
        }
        TRY(looks(r, why));
        TRY(write_due(r, why));
        if (interrupted)
            return interrupt(r, why);
    }
    return STATUS_OK;
}

/* The stage that follows `s`: the next, or another round of those that it repeats. */
static status next_stage(run *r, int *s, failure *why)
{
    const scene_stage *stage = &r->scene->stage[*s];
    bool again = false;
    char text[512];
    if (stage->repeat_from) {
        TRY(rounds_end(&r->rounds, r->sim, &again, text, sizeof text, why));
        tell(r, "%s", text);
    }
    *s = again ? stage->repeat_index : *s + 1;
    return STATUS_OK;
}

/* From stage `first` on, which is under way. */
static status run_stages(run *r, int first, failure *why)
{
    for (int s = first; s < r->scene->stage_count;) {
        TRY(r->scene->stage[s].frozen ? run_frozen_stage(r, why) : run_stage(r, why));
        TRY(next_stage(r, &s, why));
        if (s < r->scene->stage_count)
            TRY(begin_stage(r, s, why));
    }
    return STATUS_OK;
}

/* Grains that begin pressed into each other would fly apart: where guards look on, such a scene is refused before a step is taken. */
static status refuse_overlaps(const run *r, failure *why)
{
    int64_t i, j;
    const guard_spec *guards = &r->scene->guards;
    double most = bed_largest_overlap(&r->bed, &r->scene->domain, &i, &j);
    bool felt = scene_effect(r->scene, 0, SLOT_NORMAL) && !r->scene->stage[0].frozen;
    if (felt && most > 0.0 && i != j && most * fmin(r->bed.radius[i], r->bed.radius[j]) >= r->bed.radius[i] + r->bed.radius[j])
        return fail(why, STATUS_BAD_INPUT, "%s: grains %lld and %lld are at the same place, so that no direction leads them apart; move one of them",
                    r->scene->path, (long long)i, (long long)j);
    if (most <= guards->overlap_max)
        return STATUS_OK;
    if (guards->every_steps > 0 && felt)
        return fail(why, STATUS_BAD_INPUT,
                    "%s: grains %lld and %lld overlap by %.3g of the smaller radius at the start, guards.overlap_max is %g; move them apart, or raise "
                    "guards.overlap_max and list {slot: body, law: viscous_damping}, so that they part gently",
                    r->scene->path, (long long)i, (long long)j, most, guards->overlap_max);
    tell(r, "warning: grains %lld and %lld overlap by %.3g of the smaller radius at the start", (long long)i, (long long)j, most);
    return STATUS_OK;
}

static status prepare(run *r, const run_options *options, const char *results_path, failure *why)
{
    r->quiet = options->quiet;
    r->terminal = isatty(STDERR_FILENO);
    r->started = r->shown = seconds();
    r->chunk_steps = 100;
    r->results_path = strdup(results_path);
    r->checkpoint_path = checkpoint_path_of(results_path);
    if (!r->results_path || !r->checkpoint_path)
        return fail(why, STATUS_ERROR, "out of memory");
    TRY(device_open(options->device, r->scene->precision != PRECISION_MIXED, &r->device, why));
    return simulation_create(r->scene, &r->bed, &r->device, options->kernels, &r->sim, why);
}

static const char *type_name(field_type type)
{
    return type == FIELD_REAL ? "real" : type == FIELD_EXACT ? "exact" : "int";
}

/* The live laws of every slot, and what is stored for them. */
static char *plan_of(const simulation *sim)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return NULL;
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
        if (sim->all.law[slot])
            fprintf(out, "%s: %s (%s)\n", slot_name(slot), sim->all.law[slot]->name, sim->all.law[slot]->kernel_file);
    for (int f = 0; f < sim->field_count; f++)
        fprintf(out, "field %s: %d x %s a %s\n", sim->field[f].field->name, sim->field[f].field->components,
                type_name(sim->field[f].field->type), sim->field[f].field->extent == PER_PARTICLE ? "grain" : "contact record");
    fclose(out);
    return text;
}

static status open_output(run *r, bool continued, failure *why)
{
    char *plan = plan_of(r->sim);
    status result = output_open(r->sim, r->results_path, plan ? plan : "", continued, &r->output, why);
    free(plan);
    return result;
}

static status finish(run *r, status result, failure *why)
{
    if (result == STATUS_OK)
        result = report_sources(r, why);
    if (result == STATUS_OK)
        summarise(r);
    if (r->output) {
        failure closing;
        status closed = output_close(r->output, &closing);
        r->output = NULL;
        if (result == STATUS_OK && closed != STATUS_OK) {
            *why = closing;
            result = closed;
        }
    }
    run_free(r);
    return result;
}

static status begin_scene(run *r, const run_options *options, failure *why)
{
    TRY(scene_read(options->scene_path, options->set_count, options->sets, &r->scene, why));
    if (options->precision)
        precision_find(options->precision, &r->scene->precision);
    TRY(bed_generate(r->scene, &r->bed, why));
    TRY(prepare(r, options, options->out, why));
    TRY(refuse_overlaps(r, why));
    schedule_init(&r->schedule, r->scene);
    TRY(begin_stage(r, 0, why));
    TRY(open_output(r, false, why));
    TRY(output_observe(r->output, why));
    TRY(output_frame(r->output, why));
    tell(r, "%lld grains on %s, %.0f bytes each; first step after %.2f s", (long long)r->sim->id_count, r->device.info.name,
         (double)r->sim->bytes / (double)r->sim->id_count, seconds() - r->started);
    double first = seconds();
    TRY(run_stages(r, 0, why));
    if (options->report)
        *options->report = (run_report){r->sim->id_count, r->sim->step, r->stepping, first - r->started, r->sim->time};
    return STATUS_OK;
}

status run_scene(const run_options *options, failure *why)
{
    run r;
    memset(&r, 0, sizeof r);
    bundle_init(&r.good);
    return finish(&r, begin_scene(&r, options, why), why);
}

/* ---- resume ---- */

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

static status resume_from(run *r, const run_options *options, const bundle *state, failure *why)
{
    char *text = NULL, *path = NULL, *results = NULL;
    const bundle_entry *rate;
    const char *from = options->checkpoint_path;
    status result = text_of(state, from, "scene/text", &text, why);
    if (result == STATUS_OK)
        result = text_of(state, from, "scene/path", &path, why);
    if (result == STATUS_OK)
        result = text_of(state, from, "run/results", &results, why);
    if (result == STATUS_OK)
        result = scene_read_text(text, path, 0, NULL, &r->scene, why);
    if (result == STATUS_OK)
        result = precision_of(state, from, r->scene, why);
    if (result == STATUS_OK)
        result = bed_of(state, from, r->scene, &r->bed, why);
    if (result == STATUS_OK)
        result = prepare(r, options, options->out ? options->out : results, why);
    free(text);
    free(path);
    free(results);
    TRY(result);
    schedule_init(&r->schedule, r->scene);
    TRY(schedule_load(&r->schedule, state, from, why));
    TRY(load_measures(r->sim, state, from, why));
    TRY(state_load(r->sim, state, from, why));
    TRY(rounds_load(&r->rounds, r->sim, state, from, why));
    TRY(look_load(&r->steady, r->sim, "steady", state, why));
    TRY(bundle_get(state, from, "steady/rate", BUNDLE_F64, 1, 1, &rate, why));
    r->sim->frozen.rate = *(double *)rate->data;
    r->first_step = r->sim->step;
    TRY(open_output(r, options->out == NULL, why));
    if (options->out) {
        TRY(output_observe(r->output, why));
        TRY(output_frame(r->output, why));
    }
    tell(r, "going on at t = %.9g s (step %lld) in %s", r->sim->time, (long long)r->sim->step, r->results_path);
    return run_stages(r, r->sim->stage, why);
}

status run_resume(const run_options *options, failure *why)
{
    run r;
    bundle state;
    memset(&r, 0, sizeof r);
    bundle_init(&r.good);
    bundle_init(&state);
    status result = bundle_read(options->checkpoint_path, &state, why);
    if (result == STATUS_OK)
        result = resume_from(&r, options, &state, why);
    bundle_free(&state);
    return finish(&r, result, why);
}
