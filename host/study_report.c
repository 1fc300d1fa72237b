/* The tables of a study, its diagram, and what it says at the end. */
#include "hdf5_common.h"
#include "study.h"
#include "work_precision.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* ---- columns ---- */

typedef struct column {
    const char *name, *unit, *doc;
    double (*number)(const study *s, const study_point *p);
} column;

static double parameter_of(const study *s, const study_point *p)
{
    (void)s;
    return p->parameter;
}
static double step_of(const study *s, const study_point *p)
{
    (void)s;
    return p->step_s;
}
static double steps_of(const study *s, const study_point *p)
{
    (void)s;
    return p->steps;
}
static double particle_steps_of(const study *s, const study_point *p)
{
    return p->steps * (double)s->grains;
}
static double time_of(const study *s, const study_point *p)
{
    (void)s;
    return p->time_s;
}
static double wall_of(const study *s, const study_point *p)
{
    (void)s;
    return p->wall_s;
}
static double error_of(const study *s, const study_point *p)
{
    (void)s;
    return p->error;
}
static double bar_of(const study *s, const study_point *p)
{
    return s->seeds > 1 ? p->bar : NAN;
}
static double uncertainty_of(const study *s, const study_point *p)
{
    (void)s;
    return p->uncertainty;
}
static double front_of(const study *s, const study_point *p)
{
    (void)s;
    return p->front ? 1.0 : 0.0;
}

static const column columns[] = {
    {"parameter", "1", "what the curve goes along: share of the recommended step, tolerance, or value", parameter_of},
    {"step_s", "s", "step of the first moving stage", step_of},
    {"steps", "1", "steps of a run", steps_of},
    {"particle_steps", "1", "steps times grains", particle_steps_of},
    {"time_s", "s", "steps times the calibrated cost of a step", time_of},
    {"wall_s", "s", "wall time of the steps as they ran, beside other runs", wall_of},
    {"error", "1", "error of the worst answer, as a share of its largest change", error_of},
    {"error_bar", "1", "standard error over seeds", bar_of},
    {"reference_uncertainty", "1", "what the reference is uncertain by, in the same measure", uncertainty_of},
    {"pareto", "1", "1: no other settings are both quicker and more accurate", front_of},
};
enum { COLUMNS = sizeof columns / sizeof columns[0] };

static bool shown(const study_point *p)
{
    return !p->hidden;
}

/* What a user writes to get a point's settings. */
static void settings_of(const study *s, const study_point *p, char *text, size_t size)
{
    const study_curve *c = &s->curve[p->curve];
    text[0] = '\0';
    for (int k = 0; k < c->set_count + p->set_count; k++) {
        size_t used = strlen(text);
        snprintf(text + used, size - used, "%s--set %s", used ? " " : "", k < c->set_count ? c->set[k] : p->set[k - c->set_count]);
    }
}

/* ---- CSV ---- */

static void put_text(FILE *file, const char *text)
{
    fputc('"', file);
    for (; *text; text++) {
        if (*text == '"')
            fputc('"', file);
        fputc(*text, file);
    }
    fputc('"', file);
}

static void put_number(FILE *file, double value)
{
    if (isnan(value))
        fputc(',', file);
    else
        fprintf(file, ",%.9g", value);
}

static status write_csv(const study *s, failure *why)
{
    char path[4200], settings[2048];
    snprintf(path, sizeof path, "%s/accuracy.csv", s->options->run.out);
    FILE *file = fopen(path, "w");
    if (!file)
        return fail(why, STATUS_BAD_INPUT, "%s: cannot be written: %s", path, strerror(errno));
    fputs("choice,integrator,precision", file);
    for (int k = 0; k < COLUMNS; k++)
        fprintf(file, ",%s", columns[k].name);
    for (int a = 0; a < s->answer_count; a++) {
        fputs(",", file);
        snprintf(settings, sizeof settings, "error %s", s->answer[a].text);
        put_text(file, settings);
    }
    fputs(",failure,settings\n", file);
    for (int k = 0; k < s->point_count; k++) {
        const study_point *p = &s->point[k];
        const study_curve *c = &s->curve[p->curve];
        if (!shown(p))
            continue;
        put_text(file, c->label);
        fprintf(file, ",%s,%s", c->integrator, c->precision);
        for (int n = 0; n < COLUMNS; n++)
            put_number(file, columns[n].number(s, p));
        for (int a = 0; a < s->answer_count; a++)
            put_number(file, p->failed ? NAN : p->answer_error[a]);
        fputc(',', file);
        put_text(file, p->failure);
        fputc(',', file);
        settings_of(s, p, settings, sizeof settings);
        put_text(file, settings);
        fputc('\n', file);
    }
    bool bad = ferror(file) != 0;
    return fclose(file) == 0 && !bad ? STATUS_OK : fail(why, STATUS_ERROR, "%s: writing stopped: %s", path, strerror(errno));
}

/* ---- HDF5 ---- */

static bool put_numbers(hid_t group, const char *name, const char *unit, const char *doc, hsize_t rows, hsize_t width, const double *value)
{
    hsize_t extent[2] = {rows, width};
    hid_t space = H5Screate_simple(width > 1 ? 2 : 1, extent, NULL);
    hid_t set = H5Dcreate2(group, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    bool good = set >= 0 && (rows == 0 || H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0);
    good = good && hdf5_text_attribute(set, "unit", unit) && hdf5_text_attribute(set, "doc", doc);
    if (set >= 0)
        H5Dclose(set);
    H5Sclose(space);
    return good;
}

static bool put_texts(hid_t group, const char *name, hsize_t rows, const char *const *text)
{
    hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate_simple(1, &rows, NULL);
    H5Tset_size(type, H5T_VARIABLE);
    hid_t set = H5Dcreate2(group, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    bool good = set >= 0 && (rows == 0 || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) >= 0);
    if (set >= 0)
        H5Dclose(set);
    H5Sclose(space);
    H5Tclose(type);
    return good;
}

static bool put_points(const study *s, hid_t group)
{
    const study_point **p = scene_allocate((size_t)s->point_count + 1, sizeof(const study_point *));
    const char **text = scene_allocate((size_t)s->point_count + 1, sizeof(const char *));
    double *number = scene_allocate((size_t)(s->point_count + 1) * (size_t)s->answer_count, sizeof *number);
    hsize_t rows = 0;
    bool good = true;
    for (int k = 0; k < s->point_count; k++)
        if (shown(&s->point[k]))
            p[rows++] = &s->point[k];
    for (int n = 0; n < COLUMNS; n++) {
        for (hsize_t k = 0; k < rows; k++)
            number[k] = columns[n].number(s, p[k]);
        good &= put_numbers(group, columns[n].name, columns[n].unit, columns[n].doc, rows, 1, number);
    }
    for (hsize_t k = 0; k < rows; k++)
        for (int a = 0; a < s->answer_count; a++)
            number[k * (hsize_t)s->answer_count + (hsize_t)a] = p[k]->failed ? NAN : p[k]->answer_error[a];
    good &= put_numbers(group, "answer_error", "1", "error of each answer", rows, (hsize_t)s->answer_count, number);
    for (hsize_t k = 0; k < rows; k++)
        text[k] = s->curve[p[k]->curve].label;
    good &= put_texts(group, "choice", rows, text);
    for (hsize_t k = 0; k < rows; k++)
        text[k] = p[k]->failure;
    good &= put_texts(group, "failure", rows, text);
    free(p);
    free(text);
    free(number);
    return good;
}

static bool put_curves(const study *s, hid_t group)
{
    const char **text = scene_allocate((size_t)s->curve_count, sizeof(const char *));
    double *number = scene_allocate((size_t)s->curve_count, sizeof *number);
    hsize_t rows = (hsize_t)s->curve_count;
    for (int c = 0; c < s->curve_count; c++)
        text[c] = s->curve[c].label;
    bool good = put_texts(group, "choice", rows, text);
    for (int c = 0; c < s->curve_count; c++)
        text[c] = s->curve[c].ladder == LADDER_STEP        ? "share of the recommended step"
                  : s->curve[c].ladder == LADDER_TOLERANCE ? "tolerance"
                                                           : s->curve[c].along;
    good &= put_texts(group, "along", rows, text);
    for (int c = 0; c < s->curve_count; c++)
        text[c] = s->curve[c].expected;
    good &= put_texts(group, "expected_order", rows, text);
    for (int c = 0; c < s->curve_count; c++)
        number[c] = s->curve[c].order;
    good &= put_numbers(group, "order", "1", "observed order of convergence in the step", rows, 1, number);
    for (int c = 0; c < s->curve_count; c++)
        number[c] = s->curve[c].step_cost_s;
    good &= put_numbers(group, "step_cost_s", "s", "median wall time of a step", rows, 1, number);
    free(text);
    free(number);
    return good;
}

static bool put_study(const study *s, hid_t file)
{
    const char **answers = scene_allocate((size_t)s->answer_count, sizeof(const char *));
    for (int a = 0; a < s->answer_count; a++)
        answers[a] = s->answer[a].text;
    hid_t points = H5Gcreate2(file, "points", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    hid_t curves = H5Gcreate2(file, "curves", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    bool good = points >= 0 && curves >= 0 && put_points(s, points) && put_curves(s, curves) &&
                put_texts(file, "answers", (hsize_t)s->answer_count, answers);
    good = good && hdf5_text_attribute(file, "title", s->scene->title) && hdf5_text_attribute(file, "reference", s->reference_text);
    good = good && hdf5_text_dataset(file, "scene", s->scene->text);
    if (points >= 0)
        H5Gclose(points);
    if (curves >= 0)
        H5Gclose(curves);
    free(answers);
    return good;
}

static status write_hdf5(const study *s, failure *why)
{
    char path[4200], reason[512];
    snprintf(path, sizeof path, "%s/accuracy.h5", s->options->run.out);
    hdf5_quiet();
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    bool good = file >= 0 && put_study(s, file);
    if (!good)
        hdf5_reason(reason, sizeof reason);
    if (file >= 0 && H5Fclose(file) < 0)
        good = false;
    return good ? STATUS_OK : fail(why, STATUS_ERROR, "%s: cannot be written: %s", path, reason);
}

/* ---- the diagram ---- */

/* tools/plot as installed beside the program, or in the sources that it was built from; false where there is none. */
static bool find_plot(char *path, size_t size)
{
    static const char *const beside[] = {"../libexec/clast/plot", "../tools/plot"};
    char program[4000];
    const char *given = getenv("CLAST_PLOT");
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (given) {
        snprintf(path, size, "%s", given);
        return access(path, X_OK) == 0;
    }
    program[length > 0 ? length : 0] = '\0';
    char *slash = strrchr(program, '/');
    for (size_t k = 0; slash && k < sizeof beside / sizeof *beside; k++) {
        snprintf(path, size, "%.*s/%s", (int)(slash - program), program, beside[k]);
        if (access(path, X_OK) == 0)
            return true;
    }
    return false;
}

/* Runs it with its messages taken into `text`; false where it failed. */
static bool draw(const char *plot, const char *from, const char *to, char *text, size_t size)
{
    int ends[2], wait_status = 1;
    text[0] = '\0';
    if (pipe(ends) != 0)
        return false;
    fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
        dup2(ends[1], STDERR_FILENO);
        dup2(ends[1], STDOUT_FILENO);
        close(ends[0]);
        execl(plot, plot, "study", from, "--out", to, (char *)NULL);
        _exit(127);
    }
    close(ends[1]);
    FILE *said = fdopen(ends[0], "r");
    char line[512];
    while (said && fgets(line, sizeof line, said))
        if (line[0] != '\n')
            snprintf(text, size, "%.*s", (int)strcspn(line, "\n"), line);
    if (said)
        fclose(said);
    return child > 0 && waitpid(child, &wait_status, 0) == child && WIFEXITED(wait_status) && WEXITSTATUS(wait_status) == 0;
}

static void draw_all(const study *s)
{
    static const char *const ending[] = {"png", "svg"};
    char plot[4200], from[4200], to[4200], said[512];
    snprintf(from, sizeof from, "%s/accuracy.h5", s->options->run.out);
    if (!find_plot(plot, sizeof plot)) {
        fprintf(stderr, "no diagram is drawn: the program `plot` is not beside this one; the tables are in %s\n", s->options->run.out);
        return;
    }
    for (int k = 0; k < 2; k++) {
        snprintf(to, sizeof to, "%s/accuracy.%s", s->options->run.out, ending[k]);
        if (!draw(plot, from, to, said, sizeof said)) {
            fprintf(stderr, "no diagram is drawn: %s; the tables are in %s\n", said[0] ? said : "the program `plot` cannot be run",
                    s->options->run.out);
            return;
        }
    }
}

status study_write(const study *s, failure *why)
{
    TRY(write_csv(s, why));
    TRY(write_hdf5(s, why));
    draw_all(s);
    return STATUS_OK;
}

/* ---- the summary ---- */

/* The point of a curve nearest to the recommended step; of other ladders the one of least error. */
static const study_point *typical(const study *s, int curve)
{
    const study_point *best = NULL;
    for (int k = 0; k < s->point_count; k++) {
        const study_point *p = &s->point[k];
        if (p->curve != curve || p->failed || p->hidden)
            continue;
        bool step = s->curve[curve].ladder == LADDER_STEP;
        if (!best || (step ? fabs(log(p->parameter)) < fabs(log(best->parameter)) : p->error < best->error))
            best = p;
    }
    return best;
}

static void print_curve(const study *s, int c)
{
    const study_curve *curve = &s->curve[c];
    const study_point *p = typical(s, c);
    char order[32], cost[32];
    snprintf(order, sizeof order, isnan(curve->order) ? "-" : "%.2f", curve->order);
    snprintf(cost, sizeof cost, isnan(curve->step_cost_s) ? "-" : "%.3g", 1e6 * curve->step_cost_s);
    printf("%-34s %6s  %-38s %9s", curve->label, order, curve->expected[0] ? curve->expected : "-", cost);
    if (!p)
        printf("  no run ended well\n");
    else if (s->seeds > 1)
        printf("  %.2e +- %.1e in %.3g s (%.3g)\n", p->error, p->bar, p->time_s, p->parameter);
    else
        printf("  %.2e in %.3g s (%.3g)\n", p->error, p->time_s, p->parameter);
}

static void print_order(int width, double order)
{
    if (isnan(order))
        printf("  %*s", width, "-");
    else
        printf("  %*.2f", width, order);
}

/* Answers converge with orders of their own: the worst one's hides the others'. */
static void print_orders(const study *s)
{
    if (s->answer_count < 2 || s->seeds > 1 || s->curve[0].ladder != LADDER_STEP)
        return;
    printf("\norder by answer");
    for (int a = 0; a < s->answer_count; a++)
        printf("  %s", s->answer[a].text);
    printf("\n");
    for (int c = 0; c < s->curve_count; c++) {
        if (s->curve[c].ladder != LADDER_STEP || s->curve[c].other_model)
            continue;
        printf("%-34s", s->curve[c].label);
        for (int a = 0; a < s->answer_count; a++)
            print_order((int)strlen(s->answer[a].text), s->curve[c].answer_order[a]);
        printf("\n");
    }
}

static void print_front(const study *s)
{
    int next = -1;
    double before = 0.0;
    printf("\nPareto front, from quick to accurate:\n");
    for (;;) {
        next = -1;
        for (int k = 0; k < s->point_count; k++)
            if (s->point[k].front && s->point[k].time_s > before && (next < 0 || s->point[k].time_s < s->point[next].time_s))
                next = k;
        if (next < 0)
            break;
        const study_point *p = &s->point[next];
        before = p->time_s;
        printf("  %9.3g s  %9.3g particle-steps  error %8.2e  %s, %.3g\n", p->time_s, p->steps * (double)s->grains, study_error(p),
               s->curve[p->curve].label, p->parameter);
    }
}

static void print_cheapest(const study *s)
{
    double tolerance = s->options->tolerance, least = INFINITY;
    double *time = scene_allocate((size_t)s->point_count, sizeof *time), *error = scene_allocate((size_t)s->point_count, sizeof *error);
    char settings[2048];
    for (int k = 0; k < s->point_count; k++) {
        time[k] = s->point[k].time_s;
        error[k] = study_error(&s->point[k]);
        least = fmin(least, error[k]);
    }
    int best = wp_cheapest(time, error, s->point_count, tolerance);
    free(time);
    free(error);
    if (best < 0) {
        printf("\ncheapest within %g: none of these settings; the least error is %.2e\n", tolerance, least);
        return;
    }
    settings_of(s, &s->point[best], settings, sizeof settings);
    printf("\ncheapest within %g: %s (error %.2e, %.3g s)\n", tolerance, settings, study_error(&s->point[best]), s->point[best].time_s);
}

void study_print(const study *s)
{
    int failed = 0;
    printf("reference: %s\n", s->reference_text);
    for (int a = 0; a < s->answer_count; a++)
        printf("  %s: errors are shares of %.6g; the reference is uncertain by %.1e of it\n", s->answer[a].text, s->scale[a],
               s->reference_floor[a] / s->scale[a]);
    if (s->closed_forms_hold && s->scene->study.closed_form_count > 0)
        printf("  %d of the answers are compared with closed forms instead\n", s->scene->study.closed_form_count);
    printf("\n%-34s %6s  %-38s %9s  %s\n", "choice", "order", "expected", "us a step",
           "error near the recommended step, or least error (parameter)");
    for (int c = 0; c < s->curve_count; c++)
        print_curve(s, c);
    print_orders(s);
    for (int k = 0; k < s->point_count; k++)
        failed += s->point[k].failed;
    if (failed)
        printf("%d of %d settings could not be run; accuracy.csv says why\n", failed, s->point_count);
    print_front(s);
    if (!isnan(s->options->tolerance))
        print_cheapest(s);
}
