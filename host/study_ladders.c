/* Points of the curves: which steps a study takes, and how fine it can afford to go. */
#include "study.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define START_S              0.6 /* wall time of a run beside its steps, for planning */
#define TOP_SHARE            4.0 /* the coarsest step, of the recommended one, where the limit allows it */
#define BELOW_LIMIT          0.999
#define BELOW_LIMIT_OF_SEEDS 0.95 /* another seed's bed has another limit */
#define LEVELS_MIN           4

/* The step of a stage at a level of the ladder: a sample interval over a whole number, so that all runs meet at the samples. */
static double step_of(const study *s, const study_probe *probe, int stage, int level)
{
    double recommended = probe->recommended_s[stage],
           top = fmin(TOP_SHARE * recommended, (s->seeds > 1 ? BELOW_LIMIT_OF_SEEDS : BELOW_LIMIT) * probe->limit_s[stage]);
    double aim = level < 0 ? recommended : top, interval = s->interval_s;
    if (isnan(interval))
        interval = s->scene->stage[stage].until_time_s;
    if (!isfinite(aim) && isnan(interval))
        return NAN;
    if (isnan(interval))
        return ldexp(aim, level < 0 ? 0 : -level);
    double parts = isfinite(aim) ? fmax(1.0, ceil(interval / aim * (1.0 - 1e-9))) : 1.0;
    return interval / ldexp(parts, level < 0 ? 0 : level);
}

static double steps_expected(const study *s, const study_probe *probe, int level)
{
    double steps = 0.0;
    for (int t = 0; t < s->scene->stage_count; t++) {
        const scene_stage *stage = &s->scene->stage[t];
        double span = isnan(stage->until_time_s) ? 1.0 : stage->until_time_s;
        if (study_moves(stage))
            steps += span / step_of(s, probe, t, level);
    }
    return steps;
}

static status set_steps(const study *s, study_point *p, failure *why)
{
    const study_probe *probe = &s->probe[p->probe];
    for (int t = 0; t < s->scene->stage_count && t < STUDY_STAGES_MAX; t++) {
        double step = step_of(s, probe, t, p->level);
        if (probe->limit_s[t] == 0.0)
            continue; /* nothing moves in it */
        if (isnan(step))
            return fail(why, STATUS_BAD_INPUT, "%s: stage %s: nothing tells how large a step could be; give `until.time_s`", s->scene->path,
                        s->scene->stage[t].name);
        study_add_set(&p->set, &p->set_count, "stages[%d].step_s=%.17g", t, step);
        if (isnan(p->step_s)) {
            p->step_s = step;
            if (p->level >= 0)
                p->parameter = step / probe->recommended_s[t];
        }
    }
    return STATUS_OK;
}

/* Wall time of the study with so many levels, roughly. */
static double cost_of(const study *s, int levels)
{
    double cost = 0.0, jobs = s->options->jobs > 0 ? s->options->jobs : 2.0;
    for (int c = 0; c < s->curve_count; c++) {
        const study_curve *curve = &s->curve[c];
        if (curve->ladder != LADDER_STEP || curve->probe < 0 || !s->probe[curve->probe].done)
            continue;
        int past = curve->candidate ? s->seeds > 1 ? 1 : STUDY_LEVELS_PAST : 0;
        const study_probe *probe = &s->probe[curve->probe];
        for (int level = 0; level < levels + past; level++)
            cost += s->seeds * (steps_expected(s, probe, level) * probe->step_cost_s + START_S) / jobs;
        cost += s->options->repeats * (fmin(0.5, steps_expected(s, probe, levels - 1) * probe->step_cost_s) + START_S);
    }
    for (int p = 0; p < s->point_count; p++)
        if (s->point[p].probe >= 0 && s->probe[s->point[p].probe].done)
            cost += s->seeds * (steps_expected(s, &s->probe[s->point[p].probe], -1) * s->probe[s->point[p].probe].step_cost_s + START_S) /
                    jobs;
        else
            cost += s->seeds * START_S;
    return cost;
}

static void lay_ladder(study *s, int c)
{
    int past = s->curve[c].candidate ? s->seeds > 1 ? 1 : STUDY_LEVELS_PAST : 0;
    for (int level = 0; level < s->levels + past; level++) {
        study_point *p = study_add_point(s, c, s->curve[c].probe);
        p->level = level;
        p->hidden = level >= s->levels;
    }
}

/* Motion beside frozen heat: one step, and only where it can be paid. */
static void lay_coupled(study *s, int c)
{
    const study_probe *probe = &s->probe[s->curve[c].probe];
    double cost = steps_expected(s, probe, -1) * probe->step_cost_s;
    if (cost > 0.3 * s->options->budget_s) {
        fprintf(stderr, "%s: left out: it would take %.3g s, and the budget is %.3g s\n", s->curve[c].label, cost, s->options->budget_s);
        return;
    }
    study_add_point(s, c, s->curve[c].probe);
}

static int by_curve(const void *a, const void *b)
{
    const study_point *p = a, *q = b;
    if (p->curve != q->curve)
        return p->curve - q->curve;
    return (p->level > q->level) - (p->level < q->level) + 2 * ((p->parameter < q->parameter) - (p->parameter > q->parameter));
}

status study_lay_ladders(study *s, failure *why)
{
    int most = STUDY_LEVELS_MAX - STUDY_LEVELS_PAST;
    bool frozen = s->curve[0].ladder == LADDER_TOLERANCE;
    s->levels = s->options->levels > 0 ? s->options->levels : most;
    for (int c = 0; c < s->curve_count; c++)
        if (s->curve[c].ladder == LADDER_STEP && s->curve[c].candidate && !s->probe[s->curve[c].probe].done)
            return fail(why, STATUS_ERROR, "%s: the scene cannot be prepared; see the logs in %s", s->curve[c].label, s->options->run.out);
    while (s->options->levels == 0 && s->levels > LEVELS_MIN && !frozen && cost_of(s, s->levels) > s->options->budget_s)
        s->levels--;
    for (int c = 0; c < s->curve_count; c++)
        if (s->curve[c].ladder == LADDER_STEP && s->probe[s->curve[c].probe].done) {
            if (frozen)
                lay_coupled(s, c);
            else
                lay_ladder(s, c);
        }
    qsort(s->point, (size_t)s->point_count, sizeof *s->point, by_curve);
    for (int p = 0; p < s->point_count; p++) {
        study_point *point = &s->point[p];
        point->failed = point->probe >= 0 && !s->probe[point->probe].done;
        if (point->failed)
            snprintf(point->failure, sizeof point->failure, "the scene cannot be prepared");
        else if (point->probe >= 0)
            TRY(set_steps(s, point, why));
    }
    return STATUS_OK;
}
