/* The runs of a study: each in a process of its own, because a device may not be shared over a fork. */
#include "bed.h"
#include "clock.h"
#include "crew.h"
#include "device.h"
#include "simulation.h"
#include "study.h"
#include "work_precision.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define PROBE_WARM_UP 20
#define PROBE_STEPS   200

/* Settings of a run or a probe; the caller frees the list and, from base_count on, its strings. */
char **study_sets(const study *s, const study_point *p, const study_probe *probe, int seed, int *count)
{
    char **set = NULL;
    *count = 0;
    for (int k = 0; k < s->base_count; k++)
        study_add_set(&set, count, "%s", s->base[k]);
    if (probe)
        for (int k = 0; k < probe->set_count; k++)
            study_add_set(&set, count, "%s", probe->set[k]);
    for (int k = 0; p && k < s->curve[p->curve].set_count; k++)
        study_add_set(&set, count, "%s", s->curve[p->curve].set[k]);
    for (int k = 0; p && k < p->set_count; k++)
        study_add_set(&set, count, "%s", p->set[k]);
    if (s->seeds > 1)
        study_add_set(&set, count, "seed=%lld", (long long)s->scene->seed + seed);
    return set;
}

static void free_sets(char **set, int count)
{
    for (int k = 0; k < count; k++)
        free(set[k]);
    free(set);
}

/* ---- probes ---- */

static const char *probe_log(void *context, int index)
{
    static char path[4300];
    snprintf(path, sizeof path, "%s/runs/probe_%02d.log", ((const study *)context)->options->run.out, index);
    return path;
}

static status time_steps(simulation *sim, study_probe *probe, failure *why)
{
    double step = 0.25 * probe->recommended_s[sim->stage];
    if (!isfinite(step))
        return STATUS_OK;
    simulation_set_step(sim, step);
    TRY(simulation_advance(sim, PROBE_WARM_UP, why));
    double start = clock_seconds();
    TRY(simulation_advance(sim, PROBE_STEPS, why));
    probe->step_cost_s = (clock_seconds() - start) / PROBE_STEPS;
    return STATUS_OK;
}

static status probe_stages(simulation *sim, study_probe *probe, failure *why)
{
    for (int t = 0; t < sim->scene->stage_count && t < STUDY_STAGES_MAX; t++) {
        step_limit limit;
        TRY(simulation_begin_stage(sim, t, why));
        probe->limit_s[t] = probe->recommended_s[t] = 0.0;
        if (sim->scene->stage[t].frozen)
            continue;
        TRY(limit_find(sim, &limit, why));
        probe->limit_s[t] = limit.limit_s;
        probe->recommended_s[t] = limit.recommended_s;
        if (probe->step_cost_s == 0.0)
            TRY(time_steps(sim, probe, why));
    }
    return STATUS_OK;
}

static status probe_scene(const study *s, scene *scene, study_probe *probe, failure *why)
{
    bed bed = {0};
    device device = {0};
    simulation *sim = NULL;
    status result = bed_generate(scene, &bed, why);
    if (result == STATUS_OK)
        result = simulation_open_device(scene, s->options->run.device, &device, why);
    if (result == STATUS_OK)
        result = simulation_create(scene, &bed, &device, s->options->run.kernels, &sim, why);
    if (result == STATUS_OK)
        result = probe_stages(sim, probe, why);
    probe->grains = bed.count;
    return result; /* the process ends */
}

static status probe_member(void *context, int index, failure *why)
{
    const study *s = context;
    scene *scene = NULL;
    int count;
    char **set = study_sets(s, NULL, &s->probe[index], 0, &count);
    TRY(scene_read(s->options->run.scene_path, count, set, &scene, why));
    TRY(probe_scene(s, scene, &s->probe[index], why));
    s->probe[index].done = true;
    return STATUS_OK;
}

static void probe_ended(void *context, int index, status result, double wall_s)
{
    char line[1024];
    (void)wall_s;
    if (result == STATUS_OK)
        return;
    crew_last_line(probe_log(context, index), line, sizeof line);
    fprintf(stderr, "a choice cannot be run: %s\n", line);
}

status study_fill_probes(study *s, failure *why)
{
    const crew probes = {.count = s->probe_count,
                         .jobs = crew_jobs(s->options->jobs, s->grains, s->probe_count),
                         .context = s,
                         .log = probe_log,
                         .work = probe_member,
                         .ended = probe_ended};
    return s->probe_count > 0 ? crew_run(&probes, why) : STATUS_OK;
}

/* ---- runs ---- */

static const char *run_log(void *context, int index)
{
    return ((const study *)context)->run[index].log;
}

static status run_once(const study *s, int index, failure *why)
{
    const study_run *r = &s->run[index];
    run_options options = s->options->run;
    int count;
    options.sets = study_sets(s, &s->point[r->point], NULL, r->seed, &count);
    options.set_count = count;
    options.out = r->result;
    options.quiet = true;
    options.report = &s->report[index];
    status result = run_scene(&options, why);
    free_sets((char **)options.sets, count);
    return result;
}

static status run_member(void *context, int index, failure *why)
{
    return run_once(context, index, why);
}

static void remove_results(const study_run *r)
{
    char path[4300];
    size_t stem = strlen(r->result) - 3;
    unlink(r->result);
    snprintf(path, sizeof path, "%.*s.xdmf", (int)stem, r->result);
    unlink(path);
    snprintf(path, sizeof path, "%.*s.checkpoint.h5", (int)stem, r->result);
    unlink(path);
}

static status read_answers(const study *s, study_run *r, failure *why)
{
    r->answer = scene_allocate((size_t)s->answer_count, sizeof *r->answer);
    for (int a = 0; a < s->answer_count; a++) {
        TRY(answer_read(r->result, &s->answer[a], s->first, &r->answer[a], why));
        answer_merge(&r->answer[a], SAME_SAMPLE * s->interval_s);
    }
    return STATUS_OK;
}

static void tell(const study *s, const study_run *r, const char *line)
{
    const study_point *p = &s->point[r->point];
    if (r->status != STATUS_OK)
        fprintf(stderr, "[%d/%d] %s, %.3g: failed (exit code %d): %s\n", s->done, s->run_count, s->curve[p->curve].label, p->parameter,
                r->status, line);
    else if (!s->options->run.quiet)
        fprintf(stderr, "[%d/%d] %s, %.3g: %.3g s\n", s->done, s->run_count, s->curve[p->curve].label, p->parameter, r->wall_s);
}

static void run_ended(void *context, int index, status result, double wall_s)
{
    study *s = context;
    study_run *r = &s->run[index];
    study_point *p = &s->point[r->point];
    char line[1024] = "";
    failure why;
    r->wall_s = wall_s;
    if (result == STATUS_OK && (result = read_answers(s, r, &why)) != STATUS_OK)
        snprintf(line, sizeof line, "%.1000s", why.text);
    else if (result != STATUS_OK)
        crew_last_line(r->log, line, sizeof line);
    r->status = (int)result;
    s->done++;
    if (result == STATUS_OK || !p->failed) /* one seed speaks for all */
        tell(s, r, line);
    if (result != STATUS_OK) {
        p->failed = true;
        snprintf(p->failure, sizeof p->failure, "%.199s", line);
    }
    remove_results(r);
}

static void list_runs(study *s)
{
    for (int p = 0; p < s->point_count; p++)
        if (!s->point[p].failed)
            s->run_count += s->seeds;
    s->run = scene_allocate((size_t)s->run_count, sizeof *s->run);
    int next = 0;
    for (int p = 0; p < s->point_count; p++) {
        s->point[p].first_run = next;
        for (int seed = 0; seed < s->seeds && !s->point[p].failed; seed++) {
            study_run *r = &s->run[next++];
            r->point = p;
            r->seed = seed;
            r->status = -1;
            snprintf(r->result, sizeof r->result, "%s/runs/%04d.h5", s->options->run.out, next);
            snprintf(r->log, sizeof r->log, "%s/runs/%04d.log", s->options->run.out, next);
        }
    }
}

status study_run_all(study *s, failure *why)
{
    list_runs(s);
    s->report = crew_shared(sizeof *s->report * (size_t)(s->run_count + 1));
    if (!s->report)
        return fail(why, STATUS_ERROR, "out of memory");
    const crew runs = {.count = s->run_count,
                       .jobs = crew_jobs(s->options->jobs, s->grains, s->run_count),
                       .context = s,
                       .log = run_log,
                       .work = run_member,
                       .ended = run_ended};
    TRY(crew_run(&runs, why));
    if (crew_interrupted())
        return fail(why, STATUS_INTERRUPTED, "interrupted after %d of %d runs", s->done, s->run_count);
    return STATUS_OK;
}

/* ---- what a step costs ---- */

/* Times are noisy, and runs side by side disturb each other. So the time of a point is its steps times the cost of a step, and that cost is
 * the median over repeated runs of one point a curve, one after the other, the curves in turn. Where each point has a cost of its own,
 * each is repeated. */
typedef struct timing {
    study *s;
    int run;
} timing;

static const char *timing_log(void *context, int index)
{
    (void)index;
    return ((const timing *)context)->s->run[((const timing *)context)->run].log;
}

static status timing_member(void *context, int index, failure *why)
{
    const timing *t = context;
    (void)index;
    return run_once(t->s, t->run, why);
}

static void timing_ended(void *context, int index, status result, double wall_s)
{
    const timing *t = context;
    (void)index;
    (void)result;
    (void)wall_s;
    remove_results(&t->s->run[t->run]);
}

#define TIMED_AT_MOST_S 1.0

/* The point of a curve with most steps that does not take long; the one with fewest where all do. */
static int point_to_time(const study *s, int curve)
{
    int best = -1;
    for (int p = 0; p < s->point_count; p++) {
        const study_point *point = &s->point[p];
        if (point->curve != curve || point->failed || s->run[point->first_run].status != STATUS_OK)
            continue;
        const run_report *mine = &s->report[point->first_run], *other = best < 0 ? NULL : &s->report[s->point[best].first_run];
        bool quick = mine->stepping_s < TIMED_AT_MOST_S, other_quick = other && other->stepping_s < TIMED_AT_MOST_S;
        if (!other || (quick && (!other_quick || mine->steps > other->steps)) || (!quick && !other_quick && mine->steps < other->steps))
            best = p;
    }
    return best;
}

static status repeat(study *s, const int *point, int count, double *cost, failure *why)
{
    for (int round = 0; round < s->options->repeats; round++)
        for (int k = 0; k < count; k++) {
            timing t = {s, s->point[point[k]].first_run};
            const crew one = {.count = 1, .jobs = 1, .context = &t, .log = timing_log, .work = timing_member, .ended = timing_ended};
            TRY(crew_run(&one, why));
            if (crew_interrupted())
                return fail(why, STATUS_INTERRUPTED, "interrupted while the cost of steps was measured");
            const run_report *r = &s->report[t.run];
            cost[k * s->options->repeats + round] = r->stepping_s / fmax(1.0, (double)r->steps);
        }
    return STATUS_OK;
}

static bool is_timed_alone(const study *s, const study_point *p)
{
    return !p->hidden && !p->failed && s->curve[p->curve].each_costs;
}

/* A method that asks for no tolerance gives the same for all of them: one point of it says everything. */
static void hide_repetitions(study *s)
{
    for (int p = 1; p < s->point_count; p++) {
        study_point *one = &s->point[p - 1], *two = &s->point[p];
        if (one->curve != two->curve || s->curve[one->curve].ladder != LADDER_TOLERANCE || one->failed || two->failed || two->hidden)
            continue;
        bool same = s->report[one->first_run].steps == s->report[two->first_run].steps;
        for (int a = 0; same && a < s->answer_count; a++) {
            const answer_series *x = &s->run[one->first_run].answer[a], *y = &s->run[two->first_run].answer[a];
            same = memcmp(x->value, y->value, sizeof *x->value * (size_t)(x->samples * x->width)) == 0;
        }
        two->hidden = same;
    }
}

status study_calibrate(study *s, failure *why)
{
    hide_repetitions(s);
    int count = 0, *point = scene_allocate((size_t)(s->curve_count + s->point_count), sizeof *point);
    for (int c = 0; c < s->curve_count; c++)
        if (!s->curve[c].each_costs && s->curve[c].costs_like < 0 && point_to_time(s, c) >= 0)
            point[count++] = point_to_time(s, c);
    for (int p = 0; p < s->point_count; p++)
        if (is_timed_alone(s, &s->point[p]))
            point[count++] = p;
    double *cost = scene_allocate((size_t)count * (size_t)s->options->repeats, sizeof *cost);
    status result = repeat(s, point, count, cost, why);
    for (int k = 0; k < count && result == STATUS_OK; k++) {
        study_point *p = &s->point[point[k]];
        double median = wp_median(&cost[k * s->options->repeats], s->options->repeats);
        if (s->curve[p->curve].each_costs)
            p->time_s = median;
        else
            s->curve[p->curve].step_cost_s = median;
    }
    for (int c = 0; c < s->curve_count; c++)
        if (s->curve[c].costs_like >= 0)
            s->curve[c].step_cost_s = s->curve[s->curve[c].costs_like].step_cost_s;
    for (int p = 0; p < s->point_count && result == STATUS_OK; p++) {
        study_point *q = &s->point[p];
        double steps = 0.0, wall = 0.0;
        for (int seed = 0; seed < s->seeds && !q->failed; seed++) {
            steps += (double)s->report[q->first_run + seed].steps / s->seeds;
            wall += s->report[q->first_run + seed].stepping_s / s->seeds;
        }
        if (q->failed)
            continue;
        q->steps = steps;
        q->wall_s = wall;
        q->time_s = steps * (s->curve[q->curve].each_costs ? q->time_s : s->curve[q->curve].step_cost_s);
    }
    free(cost);
    free(point);
    return result;
}
