/* Runs a scene stage by stage: steps, looks between them, and what is written when. */
#include "clock.h"
#include "frozen.h"
#include "run_parts.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
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
    return run_stop_by_guard(r, text, why);
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
        return run_stop_by_guard(r, finding.text, why);
    return run_keep_good_state(r, why);
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
    TRY(frozen_refuse_endless(r->sim, why));
    r->rounds.range = fmax(r->rounds.range, range);
    run_tell(r, "stage %s: motion is frozen; heat by the %s method, tolerance %.3g of the temperature range; limit of Euler's method %.4g s", stage->name,
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
    TRY(guard_walls(r->sim, why));
    TRY(limit_find(r->sim, &limit, why));
    if (!isnan(stage->step_s) && stage->step_s > limit.limit_s && !stage->allow_unstable_step)
        return refuse_step(r, stage, &limit, why);
    run_tell(r, "stage %s: limit of the step %.4g s (%s), recommended %.4g s, taken %s", stage->name, limit.limit_s, limit.binds, limit.recommended_s,
         isnan(stage->step_s) ? "automatically" : "as given");
    if (!isnan(stage->step_s) && stage->step_s > limit.recommended_s)
        run_tell(r, "warning: stage %s: step_s of %.4g s is larger than recommended; compare with a smaller one", stage->name, stage->step_s);
    schedule_begin_stage(&r->schedule, r->sim, limit.recommended_s);
    r->beyond_limit = 0;
    return STATUS_OK;
}

static status interrupt(run *r, failure *why)
{
    TRY(run_write_checkpoint(r, why));
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
    return now.checkpoint ? run_write_checkpoint(r, why) : STATUS_OK;
}

/* Steps end on what is due. */
static status run_frozen_stage(run *r, failure *why)
{
    while (!schedule_stage_over(&r->schedule, r->sim)) {
        double start = clock_seconds();
        TRY(frozen_advance(r->sim, schedule_next_time(&r->schedule, r->sim), 1, why));
        r->stepping += clock_seconds() - start;
        run_show_progress(r);
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
            double start = clock_seconds();
            TRY(simulation_advance(r->sim, some, why));
            steps -= some;
            double spent = fmax(clock_seconds() - start, 1e-6);
            r->stepping += spent;
            r->chunk_steps = fmax(1.0, fmin(1e6, (double)some * 0.5 / spent));
            run_show_progress(r);
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
        run_tell(r, "%s", text);
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
    run_tell(r, "warning: grains %lld and %lld overlap by %.3g of the smaller radius at the start", (long long)i, (long long)j, most);
    return STATUS_OK;
}

static status prepare(run *r, const run_options *options, const char *results_path, failure *why)
{
    r->quiet = options->quiet;
    r->terminal = isatty(STDERR_FILENO);
    r->started = r->shown = clock_seconds();
    r->chunk_steps = 100;
    r->results_path = strdup(results_path);
    r->checkpoint_path = run_checkpoint_path(results_path);
    if (!r->results_path || !r->checkpoint_path)
        return fail(why, STATUS_ERROR, "out of memory");
    TRY(simulation_open_device(r->scene, options->device, &r->device, why));
    return simulation_create(r->scene, &r->bed, &r->device, options->kernels, &r->sim, why);
}

static const char *type_name(field_type type)
{
    return type == FIELD_REAL ? "real" : type == FIELD_EXACT ? "exact" : "int";
}

/* The live laws of every slot, and what is stored for them. */
static char *plan_of(const simulation *sim)
{
    static const char *const a[] = {
        [PER_PARTICLE] = "grain", [PER_RECORD] = "contact record", [PER_RECORD_BLOCK] = "block of contact records", [PER_SCENE] = "scene"};
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
                type_name(sim->field[f].field->type), a[sim->field[f].field->extent]);
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
        result = run_report_sources(r, why);
    if (result == STATUS_OK)
        run_summarise(r);
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
    run_tell(r, "%lld grains on %s, %.0f bytes each; first step after %.2f s", (long long)r->sim->id_count, r->device.info.name,
         (double)r->sim->bytes / (double)r->sim->id_count, clock_seconds() - r->started);
    double first = clock_seconds();
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

static status resume_from(run *r, const run_options *options, const bundle *state, failure *why)
{
    char *results;
    const char *from = options->checkpoint_path;
    status result = run_load_scene(r, state, from, &results, why);
    if (result == STATUS_OK)
        result = prepare(r, options, options->out ? options->out : results, why);
    free(results);
    TRY(result);
    schedule_init(&r->schedule, r->scene);
    TRY(run_load_state(r, state, from, why));
    r->first_step = r->sim->step;
    r->first_rebuilds = r->sim->rebuilds;
    TRY(open_output(r, options->out == NULL, why));
    if (options->out) {
        TRY(output_observe(r->output, why));
        TRY(output_frame(r->output, why));
    }
    run_tell(r, "going on at t = %.9g s (step %lld) in %s", r->sim->time, (long long)r->sim->step, r->results_path);
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
