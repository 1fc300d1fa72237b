#include "sweep.h"

#include "bed.h"
#include "crew.h"
#include "results.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define RUNS_MAX 100000

typedef struct axis {
    char *path; /* with the = */
    int count;
    char **value;
} axis;

typedef struct member {
    bool done;
    int status;
    double wall_s;
    char result[4096], log[4096];
} member;

typedef struct sweep {
    const sweep_options *options;
    axis *axis;
    member *member;
    int count, done, jobs;
} sweep;

static void sweep_free(sweep *s)
{
    for (int a = 0; s->axis && a < s->options->count; a++) {
        for (int v = 0; v < s->axis[a].count; v++)
            free(s->axis[a].value[v]);
        free(s->axis[a].value);
        free(s->axis[a].path);
    }
    free(s->axis);
    free(s->member);
}

/* ---- what to run ---- */

/* Length of the value that text starts with: up to a comma outside all brackets and quotes. */
static size_t value_length(const char *text)
{
    int depth = 0;
    char quote = 0;
    size_t n = 0;
    for (; text[n] && (text[n] != ',' || depth > 0 || quote); n++) {
        if (quote)
            quote = text[n] == quote ? 0 : quote;
        else if (text[n] == '"' || text[n] == '\'')
            quote = text[n];
        else if (text[n] == '[' || text[n] == '{')
            depth++;
        else if (text[n] == ']' || text[n] == '}')
            depth--;
    }
    return n;
}

static status read_axis(const char *text, axis *out, failure *why)
{
    const char *equals = strchr(text, '=');
    if (!equals || equals == text)
        return fail(why, STATUS_BAD_INPUT, "--sweep %s: write PATH=A,B,C", text);
    out->path = strndup(text, (size_t)(equals - text) + 1);
    for (const char *at = equals + 1;;) {
        size_t length = value_length(at);
        if (length == 0)
            return fail(why, STATUS_BAD_INPUT, "--sweep %s: value %d is empty; write PATH=A,B,C", text, out->count + 1);
        char **value = realloc(out->value, sizeof *value * (size_t)(out->count + 1));
        if (!value || !out->path)
            return fail(why, STATUS_ERROR, "out of memory");
        out->value = value;
        out->value[out->count++] = strndup(at, length);
        if (at[length] == '\0')
            return STATUS_OK;
        at += length + 1;
    }
}

static const char *value_of(const sweep *s, int run, int which)
{
    for (int a = s->options->count - 1; a > which; a--)
        run /= s->axis[a].count;
    return s->axis[which].value[run % s->axis[which].count];
}

/* --set strings of a run, the swept ones last; caller frees the list and the swept strings, which start at set_count. */
static char **sets_of(const sweep *s, int run)
{
    const run_options *base = &s->options->run;
    char **sets = calloc((size_t)(base->set_count + s->options->count) + 1, sizeof *sets);
    for (int k = 0; sets && k < base->set_count; k++)
        sets[k] = base->sets[k];
    for (int a = 0; sets && a < s->options->count; a++)
        if (asprintf(&sets[base->set_count + a], "%s%s", s->axis[a].path, value_of(s, run, a)) < 0)
            sets[base->set_count + a] = NULL;
    return sets;
}

static void free_sets(const sweep *s, char **sets)
{
    for (int a = 0; sets && a < s->options->count; a++)
        free(sets[s->options->run.set_count + a]);
    free(sets);
}

static void describe(const sweep *s, int run, char *text, size_t size)
{
    text[0] = '\0';
    for (int a = 0; a < s->options->count; a++) {
        size_t used = strlen(text);
        snprintf(text + used, size - used, "%s%s%s", a ? " " : "", s->axis[a].path, value_of(s, run, a));
    }
}

/* Every scene is read before any is run; the grains of the first tell how large the runs are. */
static status check_scenes(sweep *s, int64_t *grains, failure *why)
{
    const run_options *base = &s->options->run;
    for (int r = 0; r < s->count; r++) {
        scene *scene = NULL;
        bed bed;
        char **sets = sets_of(s, r);
        status result = sets ? scene_read(base->scene_path, base->set_count + s->options->count, sets, &scene, why)
                             : fail(why, STATUS_ERROR, "out of memory");
        free_sets(s, sets);
        if (result == STATUS_OK && r == 0 && (result = bed_generate(scene, &bed, why)) == STATUS_OK) {
            *grains = bed.count;
            bed_free(&bed);
        }
        scene_free(scene);
        TRY(result);
    }
    return STATUS_OK;
}

/* ---- running ---- */

static const char *log_of(void *context, int run)
{
    return ((const sweep *)context)->member[run].log;
}

static status run_member(void *context, int run, failure *why)
{
    const sweep *s = context;
    run_options options = s->options->run;
    options.out = s->member[run].result;
    options.set_count += s->options->count;
    options.sets = sets_of(s, run);
    options.quiet = true;
    return options.sets ? run_scene(&options, why) : fail(why, STATUS_ERROR, "out of memory");
}

static void note_end(void *context, int run, status result, double wall_s)
{
    sweep *s = context;
    member *m = &s->member[run];
    char what[1024], line[2048];
    m->done = true;
    m->wall_s = wall_s;
    m->status = (int)result;
    s->done++;
    describe(s, run, what, sizeof what);
    crew_last_line(m->log, line, sizeof line);
    if (m->status != STATUS_OK)
        fprintf(stderr, "[%d/%d] %s: failed (exit code %d): %s\n", s->done, s->count, what, m->status, line);
    else if (!s->options->run.quiet)
        fprintf(stderr, "[%d/%d] %s: %.3g s\n", s->done, s->count, what, m->wall_s);
}

static status run_members(sweep *s, failure *why)
{
    const crew runs = {.count = s->count, .jobs = s->jobs, .context = s, .log = log_of, .work = run_member, .ended = note_end};
    return crew_run(&runs, why);
}

/* ---- the table ---- */

/* A cell of the table: quoted where it must be. */
static void put_cell(FILE *file, const char *text)
{
    if (!strpbrk(text, ",\"\n")) {
        fputs(text, file);
        return;
    }
    fputc('"', file);
    for (; *text; text++) {
        if (*text == '"')
            fputc('"', file);
        fputc(*text, file);
    }
    fputc('"', file);
}

/* Columns are the observables of the first run that ended well; other runs of the scene have the same, unless what they observe was swept. */
static status write_table(const sweep *s, failure *why)
{
    char path[4200];
    results_ends columns = {0};
    snprintf(path, sizeof path, "%s/sweep.csv", s->options->run.out);
    FILE *file = fopen(path, "w");
    if (!file)
        return fail(why, STATUS_BAD_INPUT, "%s: cannot be written: %s", path, strerror(errno));
    for (int r = 0; r < s->count && columns.count == 0; r++)
        if (s->member[r].done && s->member[r].status == STATUS_OK)
            TRY(results_read_ends(s->member[r].result, &columns, why));
    fputs("result", file);
    for (int a = 0; a < s->options->count; a++) {
        char name[1024];
        snprintf(name, sizeof name, "%.*s", (int)strlen(s->axis[a].path) - 1, s->axis[a].path);
        fputc(',', file);
        put_cell(file, name);
    }
    fputs(",exit_code,wall_s", file);
    for (int c = 0; c < columns.count; c++)
        fprintf(file, ",%s", columns.name[c]);
    fputc('\n', file);
    for (int r = 0; r < s->count; r++) {
        const member *m = &s->member[r];
        results_ends ends = {0};
        failure unread;
        fputs(strrchr(m->result, '/') + 1, file);
        for (int a = 0; a < s->options->count; a++) {
            fputc(',', file);
            put_cell(file, value_of(s, r, a));
        }
        if (m->done)
            fprintf(file, ",%d,%.3f", m->status, m->wall_s);
        else
            fputs(",,", file);
        if (m->done)
            (void)results_read_ends(m->result, &ends, &unread);
        for (int c = 0; c < columns.count; c++) {
            int found = results_find_end(&ends, columns.name[c]);
            fputc(',', file);
            if (found >= 0)
                fprintf(file, "%.17g", ends.value[found]);
        }
        results_free_ends(&ends);
        fputc('\n', file);
    }
    results_free_ends(&columns);
    bool bad = ferror(file) != 0;
    return fclose(file) == 0 && !bad ? STATUS_OK : fail(why, STATUS_ERROR, "%s: writing stopped: %s", path, strerror(errno));
}

static status outcome(const sweep *s, failure *why)
{
    if (crew_interrupted())
        return fail(why, STATUS_INTERRUPTED, "interrupted after %d of %d runs; the runs under way have written checkpoints", s->done, s->count);
    int failed = 0, first = -1;
    for (int r = 0; r < s->count; r++)
        if (s->member[r].status != STATUS_OK) {
            first = failed++ == 0 ? r : first;
        }
    if (failed == 0)
        return STATUS_OK;
    return fail(why, (status)s->member[first].status, "%d of %d runs failed; their messages are in %s/*.log", failed, s->count, s->options->run.out);
}

static status prepare(sweep *s, failure *why)
{
    const sweep_options *o = s->options;
    int64_t grains = 0;
    double product = 1.0;
    s->axis = calloc((size_t)o->count + 1, sizeof *s->axis);
    if (!s->axis)
        return fail(why, STATUS_ERROR, "out of memory");
    for (int a = 0; a < o->count; a++) {
        TRY(read_axis(o->sweeps[a], &s->axis[a], why));
        product *= s->axis[a].count;
    }
    if (product > RUNS_MAX)
        return fail(why, STATUS_BAD_INPUT, "the sweep makes %.0f runs; at most %d are allowed", product, RUNS_MAX);
    s->count = (int)product;
    s->member = calloc((size_t)s->count, sizeof *s->member);
    if (!s->member)
        return fail(why, STATUS_ERROR, "out of memory");
    TRY(check_scenes(s, &grains, why));
    TRY(crew_folder(o->run.out, why));
    for (int r = 0; r < s->count; r++) {
        snprintf(s->member[r].result, sizeof s->member[r].result, "%s/%03d.h5", o->run.out, r + 1);
        snprintf(s->member[r].log, sizeof s->member[r].log, "%s/%03d.log", o->run.out, r + 1);
    }
    s->jobs = crew_jobs(o->jobs, grains, s->count);
    return STATUS_OK;
}

status sweep_run(const sweep_options *options, failure *why)
{
    sweep s = {.options = options};
    crew_catch_signals();
    status result = prepare(&s, why);
    if (result == STATUS_OK)
        result = run_members(&s, why);
    if (result == STATUS_OK)
        result = write_table(&s, why);
    if (result == STATUS_OK)
        result = outcome(&s, why);
    sweep_free(&s);
    return result;
}
