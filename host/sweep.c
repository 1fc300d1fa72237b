#include "sweep.h"

#include "bed.h"
#include "results.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define RUNS_MAX 100000
/* Grains up to which a run is small: it gains little from a second core. */
#define SMALL_BED 20000

/* Set by the signal handler alone. */
static volatile sig_atomic_t interrupted;

static void note_signal(int signal_number)
{
    (void)signal_number;
    interrupted = 1;
}

typedef struct axis {
    char *path; /* with the = */
    int count;
    char **value;
} axis;

typedef struct member {
    pid_t child; /* 0: not started, or done */
    bool started, done;
    int status;
    double begun, wall_s;
    char result[4096], log[4096];
} member;

typedef struct sweep {
    const sweep_options *options;
    axis *axis;
    member *member;
    int count, done, jobs;
} sweep;

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

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
        char **value = realloc(out->value, sizeof *value * (size_t)(out->count + 1));
        if (length == 0)
            return fail(why, STATUS_BAD_INPUT, "--sweep %s: value %d is empty; write PATH=A,B,C", text, out->count + 1);
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

static status make_folder(const char *path, failure *why)
{
    struct stat found;
    if (mkdir(path, 0777) == 0)
        return STATUS_OK;
    if (errno == EEXIST && stat(path, &found) == 0 && S_ISDIR(found.st_mode))
        return STATUS_OK;
    return fail(why, STATUS_BAD_INPUT, "%s: cannot be made a folder for the runs of a sweep: %s", path, strerror(errno == EEXIST ? ENOTDIR : errno));
}

/* ---- running ---- */

static void run_member(const sweep *s, int run)
{
    failure why = {{0}};
    run_options options = s->options->run;
    char threads[32];
    int log = open(s->member[run].log, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (log >= 0)
        dup2(log, STDERR_FILENO);
    if (s->jobs > 1) { /* runs side by side share the cores of a CPU device out */
        long cores = sysconf(_SC_NPROCESSORS_ONLN) / s->jobs;
        snprintf(threads, sizeof threads, "%ld", cores > 1 ? cores : 1);
        setenv("POCL_MAX_PTHREAD_COUNT", threads, 0);
    }
    options.out = s->member[run].result;
    options.set_count += s->options->count;
    options.sets = sets_of(s, run);
    options.quiet = true;
    run_catch_signals();
    status result = options.sets ? run_scene(&options, &why) : fail(&why, STATUS_ERROR, "out of memory");
    if (result != STATUS_OK)
        fprintf(stderr, "%s\n", why.text);
    fflush(NULL);
    _exit((int)result);
}

static status start_member(sweep *s, int run, failure *why)
{
    member *m = &s->member[run];
    fflush(NULL);
    m->begun = seconds();
    m->started = true;
    m->child = fork();
    if (m->child < 0) {
        m->child = 0;
        return fail(why, STATUS_ERROR, "a run of the sweep cannot be started: %s", strerror(errno));
    }
    if (m->child == 0)
        run_member(s, run);
    return STATUS_OK;
}

static void last_line(const char *path, char *text, size_t size)
{
    FILE *file = fopen(path, "r");
    char line[2048];
    text[0] = '\0';
    while (file && fgets(line, sizeof line, file))
        if (line[0] != '\n')
            snprintf(text, size, "%s", line);
    if (file)
        fclose(file);
    text[strcspn(text, "\n")] = '\0';
}

static void note_end(sweep *s, int run, int wait_status)
{
    member *m = &s->member[run];
    char what[1024], line[2048];
    m->child = 0;
    m->done = true;
    m->wall_s = seconds() - m->begun;
    m->status = WIFEXITED(wait_status) ? WEXITSTATUS(wait_status) : STATUS_ERROR;
    s->done++;
    describe(s, run, what, sizeof what);
    last_line(m->log, line, sizeof line);
    if (m->status != STATUS_OK)
        fprintf(stderr, "[%d/%d] %s: failed (exit code %d): %s\n", s->done, s->count, what, m->status, line);
    else if (!s->options->run.quiet)
        fprintf(stderr, "[%d/%d] %s: %.3g s\n", s->done, s->count, what, m->wall_s);
}

static void stop_members(const sweep *s)
{
    for (int r = 0; r < s->count; r++)
        if (s->member[r].child > 0)
            kill(s->member[r].child, SIGTERM);
}

static status run_members(sweep *s, failure *why)
{
    int next = 0, running = 0;
    bool stopped = false;
    while (running > 0 || (next < s->count && !interrupted)) {
        for (; running < s->jobs && next < s->count && !interrupted; running++)
            TRY(start_member(s, next++, why));
        int wait_status;
        pid_t child = waitpid(-1, &wait_status, 0);
        if (interrupted && !stopped) {
            stop_members(s);
            stopped = true;
        }
        for (int r = 0; r < s->count && child > 0; r++)
            if (s->member[r].child == child) {
                note_end(s, r, wait_status);
                running--;
                break;
            }
        if (child < 0 && errno != EINTR)
            return fail(why, STATUS_ERROR, "waiting for the runs of the sweep: %s", strerror(errno));
    }
    return STATUS_OK;
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
    if (interrupted)
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
    TRY(make_folder(o->run.out, why));
    for (int r = 0; r < s->count; r++) {
        snprintf(s->member[r].result, sizeof s->member[r].result, "%s/%03d.h5", o->run.out, r + 1);
        snprintf(s->member[r].log, sizeof s->member[r].log, "%s/%03d.log", o->run.out, r + 1);
    }
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    s->jobs = o->jobs > 0 ? o->jobs : grains <= SMALL_BED && cores > 1 ? (int)cores : 1;
    s->jobs = s->jobs > s->count ? s->count : s->jobs;
    return STATUS_OK;
}

status sweep_run(const sweep_options *options, failure *why)
{
    sweep s = {.options = options};
    struct sigaction action = {.sa_handler = note_signal};
    interrupted = 0;
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
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
