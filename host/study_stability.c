/* The step of a stage is multiplied by a factor, and the stage is run with it: auto's step, looked at as often as auto looks, times the
 * factor. A run is stable where no guard stops it, where its energy rises no further than that of a run at a quarter of the step, where it
 * ends as calm, and where no temperature leaves the range of that run. How far two runs at a quarter and at half of the step differ tells
 * what chance does in a scene that is chaotic. */
#include "study_stability.h"

#include "bed.h"
#include "schedule.h"
#include "simulation.h"

#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define PROBES     64
#define FINE       0.25
#define HALF       0.5
#define FACTOR_MAX 64.0
#define RUNS_MAX   32
/* What a run may differ from the fine one, or by thrice what the two fine ones do. */
#define RISE_ALLOWED   2.0
#define UNREST_ALLOWED 4.0
#define RANGE_ALLOWED  0.01
/* Of the largest energy, and of the sum of m g r: less is rest. */
#define REST 1e-6

/* What is looked at in a run, at PROBES times. */
typedef struct trace {
    double factor, fixed;   /* fixed: the step itself, whatever auto takes; 0: none */
    bool stopped;   /* by a guard, or numbers were lost */
    char text[400]; /* why; or what is past what is allowed */
    int probes;
    double energy_max; /* kinetic, rotational and elastic, J */
    double kinetic[PROBES], time[PROBES];
    double lowest, highest; /* K */
    double rest;            /* J */
    int64_t steps;
    double span, step_min, step_max; /* s */
} trace;

typedef struct stage_result {
    const scene_stage *stage;
    bool frozen, bounded;           /* bounded: an unstable factor was found */
    step_limit limit;               /* at the start */
    double factor, unstable_factor; /* the largest stable one, and the smallest unstable one */
    double given_factor;            /* of the stage's own step; NAN: auto */
    bool given_stable;
    char given_text[400];
    char past[400];                 /* what happens past it */
    trace fine;
    int run_count;
    trace run[RUNS_MAX];
} stage_result;

typedef struct study {
    const stability_options *options;
    scene *scene;
    bed bed;
    device device;
    int count;
    stage_result *result;
} study;

/* ---- one run ---- */

static double unbound_step(const scene_stage *stage)
{
    return isnan(stage->until_time_s) ? 1e-4 : 1e-4 * stage->until_time_s;
}

static status probe(simulation *sim, trace *t, failure *why)
{
    particle_sums sums;
    contact_sums contacts = {0};
    heat_sums heat;
    guard_finding finding;
    TRY(observe_particle_sums(sim, &sums, why));
    TRY(guard_check(sim, &finding, why));
    if (finding.stop || !isfinite(sums.kinetic)) {
        t->stopped = true;
        const char *what = strstr(finding.text, "grain ");
        snprintf(t->text, sizeof t->text, "%.390s", finding.stop ? (what ? what : finding.text) : "velocities are not numbers");
        return STATUS_OK;
    }
    if (sim->live.law[SLOT_NORMAL])
        TRY(observe_contact_sums(sim, &contacts, why));
    double g = sqrt(pow(sim->gravity[0], 2) + pow(sim->gravity[1], 2) + pow(sim->gravity[2], 2));
    t->energy_max = fmax(t->energy_max, sums.kinetic + sums.rotational + contacts.elastic);
    t->rest = REST * fmax(t->energy_max, g * sums.weight_radius);
    if (scene_has_temperature(sim->scene)) {
        TRY(heat_observe(sim, &heat, why));
        t->lowest = fmin(t->lowest, heat.lowest);
        t->highest = fmax(t->highest, heat.highest);
        if (!isfinite(heat.mean)) {
            t->stopped = sim->count > 0;
            snprintf(t->text, sizeof t->text, "temperatures are not numbers");
        }
    }
    if (t->probes < PROBES) {
        t->kinetic[t->probes] = sums.kinetic + sums.rotational;
        t->time[t->probes++] = sim->time;
    }
    return STATUS_OK;
}

static status take_step(simulation *sim, trace *t, failure *why)
{
    step_limit limit;
    const scene_stage *stage = &sim->scene->stage[sim->stage];
    TRY(limit_find(sim, &limit, why));
    double dt = isfinite(limit.recommended_s) ? limit.recommended_s : unbound_step(stage);
    t->step_min = fmin(t->step_min, dt);
    t->step_max = fmax(t->step_max, dt);
    simulation_set_step(sim, t->fixed > 0.0 ? t->fixed : t->factor * dt);
    return STATUS_OK;
}

/* Goes on for `span`, or where that is NAN for `steps` of auto's size or to the end of the stage; leaves what it took in t->span. */
static status run_on(simulation *sim, double factor, double fixed, double span, int64_t steps, trace *t, failure *why)
{
    const scene_stage *stage = &sim->scene->stage[sim->stage];
    double start = sim->time, until = !isnan(span) ? span : stage->until_time_s;
    int64_t looks = (int64_t)fmax(1.0, LIMIT_CHECK_STEPS / factor), most = (int64_t)fmax(1.0, (double)steps / factor);
    *t = (trace){.factor = factor, .fixed = fixed, .lowest = INFINITY, .highest = -INFINITY, .step_min = INFINITY};
    if (isnan(span) && stage->until_steps >= 0 && (double)stage->until_steps / factor < (double)most)
        most = (int64_t)ceil((double)stage->until_steps / factor);
    TRY(probe(sim, t, why));
    while (!t->stopped && (isnan(until) || sim->time - start < until) && (!isnan(span) || t->steps < most)) {
        if (t->steps % looks == 0)
            TRY(take_step(sim, t, why));
        /* between two probes */
        double done = isnan(span) ? (double)t->steps / (double)most : (sim->time - start) / span;
        double wait = isnan(span) ? (double)most / PROBES : span / PROBES / sim->dt;
        int64_t some = (int64_t)fmax(1.0, fmin(wait, (double)(looks - t->steps % looks)));
        if (!isnan(until))
            some = (int64_t)fmax(1.0, fmin((double)some, ceil((until - (sim->time - start)) / sim->dt - 1e-6)));
        status result = simulation_advance(sim, some, why);
        if (result == STATUS_GUARD) { /* a grain has left */
            t->stopped = true;
            snprintf(t->text, sizeof t->text, "%.300s", why->text);
            break;
        }
        TRY(result);
        t->steps += some;
        if (done * PROBES >= (double)t->probes - 1.0)
            TRY(probe(sim, t, why));
    }
    t->span = sim->time - start;
    return t->stopped ? STATUS_OK : probe(sim, t, why);
}

static status open_at(study *s, const bundle *state, simulation **sim, failure *why)
{
    TRY(simulation_create(s->scene, &s->bed, &s->device, s->options->run.kernels, sim, why));
    return state_load(*sim, state, "the state at the start of the stage", why);
}

static status run_from(study *s, const bundle *state, double factor, double fixed, double span, trace *t, failure *why)
{
    simulation *sim = NULL;
    status result = open_at(s, state, &sim, why);
    if (result == STATUS_OK)
        result = run_on(sim, factor, fixed, span, s->options->steps, t, why);
    simulation_free(sim);
    return result;
}

/* ---- what is stable ---- */

/* Mean over the last quarter. */
static double unrest(const trace *t)
{
    double sum = 0.0;
    int from = t->probes - (t->probes + 3) / 4;
    for (int k = from; k < t->probes; k++)
        sum += t->kinetic[k];
    return t->probes > from ? sum / (t->probes - from) : 0.0;
}

/* How far two fine runs differ: a factor of at least 1. */
static double apart(double a, double b, double least)
{
    return (fmax(a, b) + least) / (fmin(a, b) + least);
}

static bool stable(trace *t, const trace *fine, const trace *half)
{
    double rest = fine->rest, rise = 1.0 + fmax(RISE_ALLOWED - 1.0, 3.0 * (apart(fine->energy_max, half->energy_max, rest) - 1.0));
    double restless = fmax(UNREST_ALLOWED, 3.0 * apart(unrest(fine), unrest(half), rest));
    double range = fmax(fine->highest - fine->lowest, 0.0), beyond = RANGE_ALLOWED * range + 1e-6 * fabs(fine->highest);
    if (t->stopped)
        return false;
    if (t->energy_max > rise * fine->energy_max + rest) {
        snprintf(t->text, sizeof t->text, "energy rises to %.3g J; at a quarter of the step it stays below %.3g J", t->energy_max,
                 fine->energy_max);
        return false;
    }
    if (unrest(t) > restless * unrest(fine) + rest) {
        snprintf(t->text, sizeof t->text, "it does not come to rest: %.3g J of motion in the last quarter; at a quarter of the step %.3g J",
                 unrest(t), unrest(fine));
        return false;
    }
    if (range >= 0.0 && (t->highest > fine->highest + beyond || t->lowest < fine->lowest - beyond)) {
        snprintf(t->text, sizeof t->text, "temperatures from %.6g to %.6g K; at a quarter of the step from %.6g to %.6g K", t->lowest,
                 t->highest, fine->lowest, fine->highest);
        return false;
    }
    return true;
}

static status try_factor(study *s, const bundle *state, stage_result *r, const trace *half, double factor, bool *ok, failure *why)
{
    trace *t = &r->run[r->run_count++];
    TRY(run_from(s, state, factor, 0.0, r->fine.span, t, why));
    *ok = stable(t, &r->fine, half);
    if (*ok) {
        r->factor = fmax(r->factor, factor);
    } else if (factor < r->unstable_factor) {
        r->unstable_factor = factor;
        snprintf(r->past, sizeof r->past, "%s", t->text);
    }
    if (!s->options->json)
        fprintf(stderr, "stage %s: factor %.4g: %s%s\n", r->stage->name, factor, *ok ? "stable" : "not stable: ", *ok ? "" : t->text);
    return STATUS_OK;
}

/* The step that the scene gives. */
static status try_given(study *s, const bundle *state, stage_result *r, const trace *half, failure *why)
{
    trace t;
    if (isnan(r->given_factor))
        return STATUS_OK;
    TRY(run_from(s, state, r->given_factor, r->stage->step_s, r->fine.span, &t, why));
    r->given_stable = stable(&t, &r->fine, half);
    snprintf(r->given_text, sizeof r->given_text, "%s", t.text);
    return STATUS_OK;
}

/* Doubles the factor until a run is unstable, then bisects. */
static status bisect(study *s, const bundle *state, stage_result *r, const trace *half, failure *why)
{
    bool ok = true;
    for (double factor = 1.0; ok && factor <= FACTOR_MAX; factor *= 2.0)
        TRY(try_factor(s, state, r, half, factor, &ok, why));
    r->bounded = !ok;
    while (r->bounded && r->unstable_factor > r->factor * (1.0 + s->options->tolerance) && r->run_count < RUNS_MAX)
        TRY(try_factor(s, state, r, half, sqrt(r->factor * r->unstable_factor), &ok, why));
    return STATUS_OK;
}

static status study_moving(study *s, simulation *sim, const bundle *state, stage_result *r, failure *why)
{
    trace half;
    TRY(limit_find(sim, &r->limit, why));
    TRY(run_on(sim, FINE, 0.0, NAN, s->options->steps, &r->fine, why));
    if (r->fine.stopped)
        return fail(why, STATUS_GUARD, "%s: stage %s stops at a quarter of auto's step already: %s", s->scene->path, r->stage->name,
                    r->fine.text);
    TRY(run_from(s, state, HALF, 0.0, r->fine.span, &half, why));
    if (half.stopped || half.energy_max > 2.0 * r->fine.energy_max + r->fine.rest)
        return fail(why, STATUS_ERROR,
                    "%s: stage %s: runs at a quarter and at half of auto's step differ too much to tell what is stable: energies up to "
                    "%.3g and %.3g J%s%s; "
                    "try another number of steps",
                    s->scene->path, r->stage->name, r->fine.energy_max, half.energy_max, half.stopped ? ": " : "", half.text);
    r->factor = HALF;
    r->unstable_factor = INFINITY;
    r->given_factor = isfinite(r->limit.recommended_s) ? r->stage->step_s / r->limit.recommended_s : NAN;
    TRY(try_given(s, state, r, &half, why));
    return bisect(s, state, r, &half, why);
}

static status study_stage(study *s, simulation *sim, int index, failure *why)
{
    bundle state;
    stage_result *r = &s->result[s->count];
    trace passed;
    bool asked = !s->options->stage || strcmp(s->options->stage, s->scene->stage[index].name) == 0;
    *r = (stage_result){.stage = &s->scene->stage[index], .given_factor = NAN};
    TRY(simulation_begin_stage(sim, index, why));
    if (r->stage->frozen) {
        r->frozen = true;
        s->count += asked;
        return STATUS_OK; /* its step is chosen by its error */
    }
    if (!asked)
        return run_on(sim, 1.0, 0.0, NAN, s->options->steps, &passed, why);
    s->count++;
    bundle_init(&state);
    status result = state_save(sim, &state, why);
    if (result == STATUS_OK)
        result = study_moving(s, sim, &state, r, why);
    bundle_free(&state);
    return result;
}

/* ---- what is told ---- */

static void print_stage(const stage_result *r)
{
    if (r->frozen) {
        printf("stage %s: nothing moves; its step is chosen by its error, and no step is unstable\n", r->stage->name);
        return;
    }
    printf("stage %s: auto takes %.4g to %.4g s; limit at the start %.4g s (%s); %lld steps of auto's size, %.4g s\n", r->stage->name,
           r->fine.step_min, r->fine.step_max, r->limit.limit_s, r->limit.binds, (long long)llrint((double)r->fine.steps * FINE),
           r->fine.span);
    if (!isnan(r->given_factor))
        printf("  step_s of the scene is %.4g s, %.3g times auto's at the start: %s%s\n", r->stage->step_s, r->given_factor,
               r->given_stable ? "stable" : "not stable: ", r->given_text);
    if (r->bounded)
        printf("  safety factor %.3g: stable up to %.4g s, not at %.3g times auto's step (%s)\n", r->factor, r->factor * r->fine.step_min,
               r->unstable_factor, r->past);
    else
        printf("  safety factor above %.3g: no unstable step was found\n", r->factor);
}

static json_t *number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *stage_json(const stage_result *r)
{
    json_t *entry = json_object(), *runs = json_array();
    json_object_set_new(entry, "stage", json_string(r->stage->name));
    json_object_set_new(entry, "frozen", json_boolean(r->frozen));
    if (!r->frozen) {
        json_object_set_new(entry, "auto_min_s", number(r->fine.step_min));
        json_object_set_new(entry, "auto_max_s", number(r->fine.step_max));
        json_object_set_new(entry, "limit_s", number(r->limit.limit_s));
        json_object_set_new(entry, "bound_by", json_string(r->limit.binds));
        json_object_set_new(entry, "span_s", number(r->fine.span));
        json_object_set_new(entry, "steps", json_integer(llrint((double)r->fine.steps * FINE)));
        json_object_set_new(entry, "step_s", number(r->stage->step_s));
        json_object_set_new(entry, "step_over_auto", number(r->given_factor));
        json_object_set_new(entry, "step_is_stable", isnan(r->given_factor) ? json_null() : json_boolean(r->given_stable));
        json_object_set_new(entry, "safety_factor", number(r->factor));
        json_object_set_new(entry, "unstable_factor", r->bounded ? number(r->unstable_factor) : json_null());
        json_object_set_new(entry, "past_it", r->bounded ? json_string(r->past) : json_null());
    }
    for (int k = 0; k < r->run_count; k++) {
        json_t *run = json_object();
        json_object_set_new(run, "factor", number(r->run[k].factor));
        json_object_set_new(run, "stable", json_boolean(r->run[k].text[0] == '\0'));
        json_object_set_new(run, "energy_max_j", number(r->run[k].energy_max));
        json_array_append_new(runs, run);
    }
    json_object_set_new(entry, "runs", runs);
    return entry;
}

static json_t *study_json(const study *s)
{
    json_t *top = json_object(), *stages = json_array();
    json_object_set_new(top, "scene", json_string(s->scene->path));
    json_object_set_new(top, "device", json_string(s->device.info.name));
    json_object_set_new(top, "grains", json_integer(s->bed.count));
    json_object_set_new(top, "tolerance", number(s->options->tolerance));
    for (int k = 0; k < s->count; k++)
        json_array_append_new(stages, stage_json(&s->result[k]));
    json_object_set_new(top, "stages", stages);
    return top;
}

static FILE *open_in(const char *folder, const char *name, failure *why)
{
    char path[4200];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    if (!file)
        fail(why, STATUS_BAD_INPUT, "%s: cannot be written: %s", path, strerror(errno));
    return file;
}

static status write_files(const study *s, json_t *json, failure *why)
{
    const char *folder = s->options->run.out;
    FILE *file = open_in(folder, "stability.json", why);
    if (!file)
        return STATUS_BAD_INPUT;
    bool bad = json_dumpf(json, file, JSON_INDENT(2)) != 0;
    bad = fclose(file) != 0 || bad;
    file = open_in(folder, "stability.csv", why);
    if (!file)
        return STATUS_BAD_INPUT;
    fputs("stage,auto_min_s,auto_max_s,limit_s,step_s,safety_factor,unstable_factor,steps,span_s\n", file);
    for (int k = 0; k < s->count; k++) {
        const stage_result *r = &s->result[k];
        if (r->frozen)
            continue;
        fprintf(file, "%s,%.17g,%.17g,", r->stage->name, r->fine.step_min, r->fine.step_max);
        fprintf(file, isfinite(r->limit.limit_s) ? "%.17g," : ",", r->limit.limit_s);
        fprintf(file, isfinite(r->stage->step_s) ? "%.17g," : ",", r->stage->step_s);
        fprintf(file, "%.6g,", r->factor);
        fprintf(file, r->bounded ? "%.6g," : ",", r->unstable_factor);
        fprintf(file, "%lld,%.17g\n", llrint((double)r->fine.steps * FINE), r->fine.span);
    }
    bad = ferror(file) != 0 || bad;
    bad = fclose(file) != 0 || bad;
    return bad ? fail(why, STATUS_ERROR, "%s: the tables cannot be written: %s", folder, strerror(errno)) : STATUS_OK;
}

static status make_folder(const char *path, failure *why)
{
    struct stat found;
    if (!path || mkdir(path, 0777) == 0 || (errno == EEXIST && stat(path, &found) == 0 && S_ISDIR(found.st_mode)))
        return STATUS_OK;
    return fail(why, STATUS_BAD_INPUT, "%s: cannot be made a folder for the results: %s", path,
                strerror(errno == EEXIST ? ENOTDIR : errno));
}

static status tell(const study *s, failure *why)
{
    json_t *json = study_json(s);
    status result = s->options->run.out ? write_files(s, json, why) : STATUS_OK;
    if (s->options->json) {
        json_dumpf(json, stdout, JSON_INDENT(2));
        putchar('\n');
    } else {
        for (int k = 0; k < s->count; k++)
            print_stage(&s->result[k]);
    }
    json_decref(json);
    return result;
}

/* ---- all of it ---- */

static status last_stage(const study *s, int *last, failure *why)
{
    *last = s->scene->stage_count - 1;
    if (!s->options->stage)
        return STATUS_OK;
    for (int k = 0; k < s->scene->stage_count; k++)
        if (strcmp(s->scene->stage[k].name, s->options->stage) == 0) {
            *last = k;
            return STATUS_OK;
        }
    return fail(why, STATUS_BAD_INPUT, "%s: there is no stage `%s`; the last one is `%s`", s->scene->path, s->options->stage,
                s->scene->stage[*last].name);
}

static status prepare(study *s, int *last, failure *why)
{
    const stability_options *o = s->options;
    TRY(make_folder(o->run.out, why));
    TRY(scene_read(o->run.scene_path, o->run.set_count, o->run.sets, &s->scene, why));
    if (o->run.precision)
        precision_find(o->run.precision, &s->scene->precision);
    TRY(last_stage(s, last, why));
    TRY(bed_generate(s->scene, &s->bed, why));
    s->result = calloc((size_t)s->scene->stage_count, sizeof *s->result);
    if (!s->result)
        return fail(why, STATUS_ERROR, "out of memory");
    return simulation_open_device(s->scene, o->run.device, &s->device, why);
}

status study_stability(const stability_options *options, failure *why)
{
    study s = {.options = options};
    simulation *sim = NULL;
    int last;
    status result = prepare(&s, &last, why);
    if (result == STATUS_OK)
        result = simulation_create(s.scene, &s.bed, &s.device, options->run.kernels, &sim, why);
    for (int k = 0; result == STATUS_OK && k <= last; k++)
        result = study_stage(&s, sim, k, why);
    if (result == STATUS_OK)
        result = tell(&s, why);
    simulation_free(sim);
    free(s.result);
    bed_free(&s.bed);
    scene_free(s.scene);
    device_close(&s.device);
    return result;
}
