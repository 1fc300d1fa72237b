/* Reference, errors and orders of a study. Errors are shares of the largest change that the reference makes, so that they mean the same for
 * a position as for a temperature; the error of a run is that of its worst answer. */
#include "study.h"
#include "work_precision.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Errors above are no part of an order: such runs have not begun to converge. */
#define CONVERGES_BELOW 0.1
/* An error is seen where it is so many times what the reference is uncertain by. */
#define SEEN_ABOVE 3.0

static const closed_form *form_of(const study *s, int a)
{
    for (int k = 0; s->closed_forms_hold && k < s->scene->study.closed_form_count; k++)
        if (strcmp(s->scene->study.closed_form[k].answer, s->answer[a].text) == 0)
            return &s->scene->study.closed_form[k];
    return NULL;
}

static const study_run *run_of(const study *s, const study_point *p, int seed)
{
    return &s->run[p->first_run + seed];
}

/* Samples that are compared: all but the start, or the last alone where no time ends the run. */
static int first_sample(const study *s, const answer_series *series)
{
    return isnan(s->duration_s) ? series->samples - 1 : 1;
}

static int compared(const study *s, const answer_series *series)
{
    return (series->samples - first_sample(s, series)) * series->width;
}

static const double *samples_of(const study *s, const answer_series *series)
{
    return &series->value[first_sample(s, series) * series->width];
}

/* Numbers that stand for an answer in a run: its samples, or with seeds their mean from a time on. */
static void value_of(const study *s, const answer_series *series, double *out)
{
    double from = s->scene->study.average_from_s;
    int count = 0;
    if (s->seeds == 1) {
        memcpy(out, samples_of(s, series), sizeof *out * (size_t)compared(s, series));
        return;
    }
    memset(out, 0, sizeof *out * (size_t)series->width);
    for (int k = 1; k < series->samples; k++) {
        bool taken = isnan(from) ? k == series->samples - 1 : series->time[k] >= from * (1.0 - 1e-9);
        for (int w = 0; taken && w < series->width; w++)
            out[w] += series->value[k * series->width + w];
        count += taken;
    }
    for (int w = 0; w < series->width; w++)
        out[w] /= fmax(1.0, count);
}

/* Finds the point of a curve at a level of its ladder; NULL where it is not there or has failed. */
static const study_point *point_at(const study *s, int curve, int level)
{
    for (int p = 0; p < s->point_count; p++)
        if (s->point[p].curve == curve && s->point[p].level == level)
            return s->point[p].failed ? NULL : &s->point[p];
    return NULL;
}

/* ---- the reference ---- */

static status same_samples(const study *s, failure *why)
{
    const answer_series *first = NULL;
    if (isnan(s->duration_s))
        return STATUS_OK;
    for (int r = 0; r < s->run_count; r++) {
        study_run *run = &s->run[r];
        if (run->status != STATUS_OK)
            continue;
        for (int a = 0; a < s->answer_count; a++) {
            const answer_series *series = &run->answer[a];
            first = first ? first : series;
            bool same = series->samples == first->samples;
            for (int k = 0; same && k < series->samples; k++)
                same = fabs(series->time[k] - first->time[k]) <= SAME_SAMPLE * s->interval_s;
            if (same)
                continue;
            study_point *p = &s->point[run->point];
            p->failed = true;
            run->status = STATUS_ERROR;
            snprintf(p->failure, sizeof p->failure, "its samples fall on other times");
            break;
        }
    }
    return first ? STATUS_OK : fail(why, STATUS_ERROR, "no run has ended well; see the logs in %s/runs", s->options->run.out);
}

static double *allocate(int count)
{
    return scene_allocate((size_t)count + 1, sizeof(double));
}

/* Largest change of an answer from its start, as the length of all its numbers. */
static double scale_of(const study *s, const answer_series *series)
{
    double scale = 0.0, size = 0.0;
    for (int k = 1; k < series->samples; k++) {
        scale = fmax(scale, wp_distance(&series->value[k * series->width], series->value, series->width));
        size = fmax(size, wp_distance(&series->value[k * series->width], NULL, series->width));
    }
    if (s->seeds > 1)
        return size;
    return scale > 1e-12 * size ? scale : size;
}

typedef struct extrapolated {
    double **value; /* by answer */
    double *floor, worst;
    bool by_order;
} extrapolated;

static extrapolated extrapolate(const study *s, int curve)
{
    extrapolated out = {scene_allocate((size_t)s->answer_count, sizeof *out.value), allocate(s->answer_count), INFINITY, true};
    const study_point *p[3];
    for (int k = 0; k < 3; k++) {
        p[k] = point_at(s, curve, s->levels - 1 + k);
        if (!p[k])
            return out;
    }
    out.worst = 0.0;
    for (int a = 0; a < s->answer_count; a++) {
        const answer_series *fine = &run_of(s, p[2], 0)->answer[a];
        int count = compared(s, fine);
        out.value[a] = allocate(count);
        wp_extrapolation found = wp_richardson(samples_of(s, &run_of(s, p[0], 0)->answer[a]), samples_of(s, &run_of(s, p[1], 0)->answer[a]),
                                               samples_of(s, fine), count, out.value[a]);
        out.floor[a] = found.uncertainty / sqrt((double)count / fine->width);
        out.by_order = out.by_order && found.extrapolated;
        if (!form_of(s, a) && s->scale[a] > 0.0)
            out.worst = fmax(out.worst, out.floor[a] / s->scale[a]);
    }
    return out;
}

static void take(study *s, extrapolated *from)
{
    s->reference = from->value;
    s->reference_floor = from->floor;
}

/* The finest runs of every candidate, extrapolated: the one whose last halving changed least is taken. How well two candidates agree tells
 * nothing: integrators may share their positions to the last bit. */
static status refer_to_steps(study *s, failure *why)
{
    int best = -1;
    extrapolated found[64] = {{0}};
    for (int c = 0; c < s->curve_count && c < 64; c++) {
        if (!s->curve[c].candidate)
            continue;
        found[c] = extrapolate(s, c);
        if (isfinite(found[c].worst) && (best < 0 || found[c].worst < found[best].worst))
            best = c;
    }
    if (best < 0)
        return fail(why, STATUS_ERROR, "no run fine enough for a reference has ended well; see the logs in %s/runs", s->options->run.out);
    take(s, &found[best]);
    snprintf(s->reference_text, sizeof s->reference_text, "%s, %s", s->curve[best].label,
             found[best].by_order ? "extrapolated after Richardson" : "the finest run (not all answers show an order to extrapolate by)");
    return STATUS_OK;
}

/* The finest run of a curve, uncertain by what another curve's finest gives instead. */
static status refer_to_tolerances(study *s, failure *why)
{
    const study_point *finest[2] = {NULL, NULL};
    for (int p = 0; p < s->point_count; p++) {
        const study_point *q = &s->point[p];
        if (q->hidden && !q->failed && s->curve[q->curve].candidate)
            finest[finest[0] ? 1 : 0] = finest[0] && finest[1] ? finest[1] : q;
    }
    if (!finest[0])
        return fail(why, STATUS_ERROR, "no run fine enough for a reference has ended well; see the logs in %s/runs", s->options->run.out);
    s->reference = scene_allocate((size_t)s->answer_count, sizeof *s->reference);
    s->reference_floor = allocate(s->answer_count);
    for (int a = 0; a < s->answer_count; a++) {
        const answer_series *one = &run_of(s, finest[0], 0)->answer[a], *two = finest[1] ? &run_of(s, finest[1], 0)->answer[a] : one;
        int count = compared(s, one);
        s->reference[a] = allocate(count);
        memcpy(s->reference[a], samples_of(s, one), sizeof(double) * (size_t)count);
        s->reference_floor[a] = wp_distance(samples_of(s, one), samples_of(s, two), count) / sqrt((double)count / one->width);
    }
    snprintf(s->reference_text, sizeof s->reference_text, "%s at a tolerance of %g", s->curve[finest[0]->curve].label,
             finest[0]->parameter);
    return STATUS_OK;
}

/* The candidate's finest run of every seed: what is compared is the mean of the differences. */
static status refer_to_seeds(study *s, failure *why)
{
    for (int c = 0; c < s->curve_count; c++)
        if (s->curve[c].candidate && point_at(s, c, s->levels)) {
            s->reference_floor = allocate(s->answer_count);
            snprintf(s->reference_text, sizeof s->reference_text, "%s with half the finest step, mean over %d seeds", s->curve[c].label,
                     s->seeds);
            return STATUS_OK;
        }
    return fail(why, STATUS_ERROR, "the runs for the reference have failed; see the logs in %s/runs", s->options->run.out);
}

static const study_point *reference_point(const study *s)
{
    for (int c = 0; c < s->curve_count; c++)
        if (s->curve[c].candidate)
            return point_at(s, c, s->levels);
    return NULL;
}

static status find_scales(study *s, failure *why)
{
    const study_point *p = NULL;
    for (int k = 0; k < s->point_count; k++)
        if (!s->point[k].failed && s->curve[s->point[k].curve].candidate)
            p = &s->point[k]; /* the last is the finest */
    if (!p)
        return fail(why, STATUS_ERROR, "no run has ended well; see the logs in %s/runs", s->options->run.out);
    s->scale = allocate(s->answer_count);
    for (int a = 0; a < s->answer_count; a++) {
        const closed_form *form = form_of(s, a);
        const answer_series *series = &run_of(s, p, 0)->answer[a];
        s->scale[a] = scale_of(s, series);
        if (form) {
            double change = 0.0, size = 0.0;
            for (int k = 0; k < form->time_count; k++) {
                change = fmax(change, fabs(form->value[k] - series->value[0]));
                size = fmax(size, fabs(form->value[k]));
            }
            s->scale[a] = change > 1e-12 * size ? change : size;
        }
        if (!(s->scale[a] > 0.0))
            return fail(why, STATUS_BAD_INPUT,
                        "%s: the answer `%s` is 0 all the time, so that its error is no share of anything; leave it out", s->scene->path,
                        s->answer[a].text);
    }
    return STATUS_OK;
}

/* ---- errors ---- */

static status error_to_form(const study *s, int a, const closed_form *form, const answer_series *series, double *out, failure *why)
{
    double sum = 0.0;
    for (int k = 0; k < form->time_count; k++) {
        int at = -1;
        for (int n = 0; n < series->samples; n++)
            if (fabs(series->time[n] - form->time_s[k]) <= SAME_SAMPLE * (isnan(s->interval_s) ? form->time_s[k] : s->interval_s))
                at = n;
        if (at < 0)
            return fail(why, STATUS_BAD_INPUT,
                        "%s:%d:%d: closed form of `%s`: %g s is no time of a sample; there are %lld, %g s apart (`study.samples`)",
                        s->scene->path, form->at.line, form->at.column, form->answer, form->time_s[k], (long long)s->scene->study.samples,
                        s->interval_s);
        sum += pow(series->value[at] - form->value[k], 2);
    }
    *out = sqrt(sum / form->time_count) / s->scale[a];
    return STATUS_OK;
}

static status error_of_run(const study *s, const study_point *p, int a, double *out, failure *why)
{
    const answer_series *series = &run_of(s, p, 0)->answer[a];
    const closed_form *form = form_of(s, a);
    if (form)
        return error_to_form(s, a, form, series, out, why);
    int count = compared(s, series);
    *out = wp_distance(samples_of(s, series), s->reference[a], count) / sqrt((double)count / series->width) / s->scale[a];
    return STATUS_OK;
}

/* Differences to the reference run of the same seed: beds differ from seed to seed more than steps do. */
static void error_of_seeds(const study *s, const study_point *p, int a, double *error, double *bar)
{
    const study_point *reference = reference_point(s);
    int width = run_of(s, p, 0)->answer[a].width;
    double *difference = allocate(width * s->seeds), *one = allocate(width), *two = allocate(width), *column = allocate(s->seeds);
    for (int seed = 0; seed < s->seeds; seed++) {
        value_of(s, &run_of(s, p, seed)->answer[a], one);
        value_of(s, &run_of(s, reference, seed)->answer[a], two);
        for (int w = 0; w < width; w++)
            difference[w * s->seeds + seed] = one[w] - two[w];
    }
    *error = *bar = 0.0;
    for (int w = 0; w < width; w++) {
        double mean, spread;
        memcpy(column, &difference[w * s->seeds], sizeof *column * (size_t)s->seeds);
        wp_mean(column, s->seeds, &mean, &spread);
        *error += mean * mean;
        *bar += spread * spread;
    }
    *error = sqrt(*error) / s->scale[a];
    *bar = sqrt(*bar) / s->scale[a];
    free(difference);
    free(one);
    free(two);
    free(column);
}

static status find_error(study *s, study_point *p, failure *why)
{
    p->error = p->bar = p->uncertainty = 0.0;
    for (int a = 0; a < s->answer_count; a++) {
        double error = 0.0, bar = 0.0;
        if (s->seeds > 1)
            error_of_seeds(s, p, a, &error, &bar);
        else
            TRY(error_of_run(s, p, a, &error, why));
        p->answer_error[a] = error;
        p->error = fmax(p->error, error);
        p->bar = fmax(p->bar, bar);
        if (!form_of(s, a))
            p->uncertainty = fmax(p->uncertainty, s->reference_floor[a] / s->scale[a]);
    }
    return STATUS_OK;
}

/* `a`: an answer, or -1 for the worst of each point. */
static double order_of(const study *s, int curve, int a)
{
    double step[64], error[64], floor = 0.0;
    int count = 0;
    for (int p = 0; p < s->point_count && count < 64; p++) {
        const study_point *q = &s->point[p];
        if (q->curve != curve || q->failed || q->hidden)
            continue;
        step[count] = q->step_s;
        error[count++] = a < 0 ? q->error : q->answer_error[a];
        floor = SEEN_ABOVE * (a < 0 ? q->uncertainty : form_of(s, a) ? 0.0 : s->reference_floor[a] / s->scale[a]);
    }
    return wp_order(step, error, count, CONVERGES_BELOW, floor);
}

static void find_orders(study *s, int curve)
{
    study_curve *c = &s->curve[curve];
    c->answer_order = allocate(s->answer_count);
    bool ordered = c->ladder == LADDER_STEP && s->seeds == 1 && !c->other_model;
    c->order = ordered ? order_of(s, curve, -1) : NAN;
    for (int a = 0; a < s->answer_count; a++)
        c->answer_order[a] = ordered ? order_of(s, curve, a) : NAN;
}

double study_error(const study_point *p)
{
    return p->hidden || p->failed ? NAN : fmax(p->error + 2.0 * p->bar, p->uncertainty);
}

static void find_front(study *s)
{
    double *time = allocate(s->point_count), *error = allocate(s->point_count);
    bool *front = scene_allocate((size_t)s->point_count, sizeof *front);
    for (int p = 0; p < s->point_count; p++) {
        time[p] = s->point[p].time_s;
        error[p] = study_error(&s->point[p]);
    }
    wp_pareto(time, error, s->point_count, front);
    for (int p = 0; p < s->point_count; p++)
        s->point[p].front = front[p];
    free(time);
    free(error);
    free(front);
}

status study_compare(study *s, failure *why)
{
    TRY(same_samples(s, why));
    TRY(find_scales(s, why));
    if (s->seeds > 1)
        TRY(refer_to_seeds(s, why));
    else if (s->curve[0].ladder == LADDER_TOLERANCE)
        TRY(refer_to_tolerances(s, why));
    else
        TRY(refer_to_steps(s, why));
    for (int p = 0; p < s->point_count; p++)
        if (!s->point[p].failed)
            TRY(find_error(s, &s->point[p], why));
    for (int c = 0; c < s->curve_count; c++)
        find_orders(s, c);
    find_front(s);
    return STATUS_OK;
}
