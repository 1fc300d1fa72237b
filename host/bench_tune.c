/* What is fastest on a device: the work-group, the chunks that a large bed goes through its stages in, the steps of a batch, and up to which size
 * a bed does better in one work-group. Each choice is tried on the settled bed, the candidates in turn for some rounds on beds that are
 * set up anew some times; another than the usual one is taken only where it is faster each time. */
#include "bench.h"
#include "settled_bed.h"
#include "simulation.h"
#include "tuning.h"

#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SETTINGS        3 /* times that every bed is set up anew: where its arrays come to lie changes its speed by more than most choices do */
#define ROUNDS          5
#define SAMPLES         (SETTINGS * ROUNDS)
#define SAMPLE_S        0.04
#define CANDIDATES_MAX  8
#define GAIN_LEAST      0.03 /* of the time of a step, for another choice than the usual one */
#define SMALL_BED       2000 /* where batches count */
#define CHUNK_BED_LEAST 50000
#define LOOP_BEDS       5
#define LOOP_FACTOR     1.5 /* between the usual size and what is found, for it to be taken: near it both forms are as fast */

typedef struct candidate {
    int value;
    double s[SAMPLES], median, low, high; /* time of a step, setting by setting; quartiles */
} candidate;

typedef struct trial {
    const char *name, *unit;
    int64_t particles;
    int usual, chosen;
    candidate candidate[CANDIDATES_MAX];
    int count;
} trial;

typedef struct tune_bench {
    const bench_options *options;
    device device;
    tuning usual, found;
    trial trial[4 + LOOP_BEDS];
    int trial_count;
} tune_bench;

typedef struct open_bed {
    settled_bed of;
    simulation *sim;
    int64_t steps; /* of a sample */
} open_bed;

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* ---- one bed ---- */

static void close_bed(open_bed *b)
{
    simulation_free(b->sim);
    settled_bed_free(&b->of);
    *b = (open_bed){0};
}

static status sample(open_bed *b, double *s, failure *why)
{
    double before = b->sim->step_seconds;
    TRY(simulation_advance(b->sim, b->steps, why));
    *s = (b->sim->step_seconds - before) / (double)b->steps;
    return STATUS_OK;
}

static status start_bed(tune_bench *t, int64_t particles, const tuning *with, step_form form, open_bed *out, failure *why)
{
    double s = 0.0;
    *out = (open_bed){.steps = 4};
    TRY(settled_bed_make(particles, BED_ROLLING, NULL, &t->device, t->options->kernels, &out->of, why));
    out->of.scene->precision = t->options->mixed || !t->device.info.fp64 ? PRECISION_MIXED : PRECISION_DOUBLE;
    out->of.scene->table.step_form = form;
    t->device.tuning = *with;
    TRY(simulation_create(out->of.scene, &out->of.bed, &t->device, t->options->kernels, &out->sim, why));
    TRY(simulation_begin_stage(out->sim, 0, why));
    simulation_set_step(out->sim, BENCH_STEP_S);
    TRY(simulation_advance(out->sim, 100, why)); /* compiles; and the skin adapts to a bed at rest */
    TRY(sample(out, &s, why));
    out->steps = (int64_t)fmin(fmax(ceil(SAMPLE_S / s), 4.0), 20000.0);
    return STATUS_OK;
}

/* What the run of a bed of some size comes to (host/step_loop.c). */
static step_form form_of_large_beds(const tune_bench *b)
{
    return b->device.info.cpu && b->device.info.compute_units > 1 ? STEP_TEAM : STEP_TWO_KERNELS;
}

/* ---- one choice ---- */

static double median_of(const double *s, int count)
{
    double sorted[SAMPLES];
    memcpy(sorted, s, sizeof *sorted * (size_t)count);
    qsort(sorted, (size_t)count, sizeof *sorted, by_value);
    return sorted[count / 2];
}

static void order(candidate *c)
{
    double sorted[SAMPLES];
    memcpy(sorted, c->s, sizeof sorted);
    qsort(sorted, SAMPLES, sizeof *sorted, by_value);
    c->low = sorted[SAMPLES / 4];
    c->median = sorted[SAMPLES / 2];
    c->high = sorted[SAMPLES - 1 - SAMPLES / 4];
}

static status run_rounds(trial *t, int setting, open_bed *beds, failure *why)
{
    for (int round = 0; round < ROUNDS; round++)
        for (int n = 0; n < t->count; n++) {
            int c = round % 2 == 0 ? n : t->count - 1 - n;
            TRY(sample(&beds[c], &t->candidate[c].s[setting * ROUNDS + round], why));
        }
    return STATUS_OK;
}

/* Faster than the usual one in every setting. */
static bool always_faster(const candidate *best, const candidate *usual)
{
    for (int setting = 0; setting < SETTINGS; setting++)
        if (median_of(best->s + setting * ROUNDS, ROUNDS) > (1.0 - GAIN_LEAST) * median_of(usual->s + setting * ROUNDS, ROUNDS))
            return false;
    return best->median < (1.0 - GAIN_LEAST) * usual->median;
}

/* The fastest, or the usual one where it is not faster in every setting. */
static void choose(trial *t)
{
    const candidate *usual = NULL, *best = &t->candidate[0];
    for (int c = 0; c < t->count; c++) {
        order(&t->candidate[c]);
        usual = t->candidate[c].value == t->usual ? &t->candidate[c] : usual;
        best = t->candidate[c].median < best->median ? &t->candidate[c] : best;
    }
    t->chosen = !usual || always_faster(best, usual) ? best->value : t->usual;
}

static trial *add_trial(tune_bench *b, const char *name, const char *unit, int64_t particles, int usual)
{
    trial *t = &b->trial[b->trial_count++];
    *t = (trial){.name = name, .unit = unit, .particles = particles, .usual = usual, .chosen = usual};
    return t;
}

static void set_choice(tuning *of, const char *name, int value)
{
    if (strcmp(name, "block") == 0)
        of->block = value;
    else if (strcmp(name, "chunk_records") == 0)
        of->chunk_records = value;
    else
        of->batch_steps = value;
}

/* One setting: a bed for each candidate, all at a time, so that all see the same minutes; set up in another order each time. */
static status try_setting(tune_bench *b, trial *t, int setting, failure *why)
{
    open_bed beds[CANDIDATES_MAX] = {{.sim = NULL}};
    status result = STATUS_OK;
    for (int n = 0; n < t->count && result == STATUS_OK; n++) {
        int c = (n + setting * 2) % t->count;
        tuning with = b->found;
        set_choice(&with, t->name, t->candidate[c].value);
        result = start_bed(b, t->particles, &with, form_of_large_beds(b), &beds[c], why);
    }
    if (result == STATUS_OK)
        result = run_rounds(t, setting, beds, why);
    for (int c = 0; c < t->count; c++)
        close_bed(&beds[c]);
    return result;
}

static status try_values(tune_bench *b, const char *name, const char *unit, int64_t particles, int usual, const int *values, int count,
                         failure *why)
{
    trial *t = add_trial(b, name, unit, particles, usual);
    for (t->count = 0; t->count < count; t->count++)
        t->candidate[t->count].value = values[t->count];
    for (int setting = 0; setting < SETTINGS; setting++)
        TRY(try_setting(b, t, setting, why));
    choose(t);
    set_choice(&b->found, name, t->chosen);
    return STATUS_OK;
}

static status try_blocks(tune_bench *b, failure *why)
{
    static const int values[] = {32, 64, 128, 256, 512};
    size_t most = 0;
    int count = 0;
    TRY_CL(clGetDeviceInfo(b->device.info.id, CL_DEVICE_MAX_WORK_GROUP_SIZE, sizeof most, &most, NULL),
           "asking for the largest work-group");
    while (count < (int)(sizeof values / sizeof *values) && (size_t)values[count] <= most)
        count++;
    return try_values(b, "block", "grains or records a work-group", b->options->particles, b->usual.block, values, count, why);
}

/* Beds that go through the stages whole in any case say nothing of chunks. */
static status try_chunks(tune_bench *b, failure *why)
{
    if (b->options->particles < CHUNK_BED_LEAST)
        return STATUS_OK;
    static const int values[] = {0, 8192, 16384, 32768, 65536, 131072};
    return try_values(b, "chunk_records", "records a chunk; 0: none", b->options->particles, b->usual.chunk_records, values, 6, why);
}

static status try_batches(tune_bench *b, failure *why)
{
    static const int values[] = {8, 16, 32, 64, 128, 256, 512};
    return try_values(b, "batch_steps", "steps a batch", SMALL_BED, b->usual.batch_steps, values, 7, why);
}

/* ---- the loop in one work-group ---- */

static status try_forms(tune_bench *b, trial *t, int setting, double *records, failure *why)
{
    const step_form forms[] = {form_of_large_beds(b), STEP_ONE_GROUP};
    open_bed beds[2] = {{.sim = NULL}};
    status result = STATUS_OK;
    for (int n = 0; n < 2 && result == STATUS_OK; n++) {
        int c = (n + setting) % 2;
        result = start_bed(b, t->particles, &b->found, forms[c], &beds[c], why);
    }
    if (result == STATUS_OK)
        result = run_rounds(t, setting, beds, why);
    *records = beds[1].sim ? beds[1].sim->table.record_count : 0;
    close_bed(&beds[0]);
    close_bed(&beds[1]);
    return result;
}

/* Beds of rising size, each in both forms; beyond the first at which the loop loses none is tried. Between it and the last at which it wins the
 * sizes at which the times are equal are found from the logarithms of their ratios. */
static status try_loop(tune_bench *b, failure *why)
{
    static const int64_t sizes[LOOP_BEDS] = {250, 500, 1000, 2000, 4000};
    double records[LOOP_BEDS], ratio[LOOP_BEDS]; /* time of the loop to that of two kernels */
    int tried = 0;
    for (; tried < LOOP_BEDS && (tried == 0 || ratio[tried - 1] < 1.0); tried++) {
        trial *t = add_trial(b, "loop", "1: in one work-group", sizes[tried], 0);
        t->count = 2;
        t->candidate[1].value = 1;
        for (int setting = 0; setting < SETTINGS; setting++)
            TRY(try_forms(b, t, setting, &records[tried], why));
        order(&t->candidate[0]);
        order(&t->candidate[1]);
        ratio[tried] = t->candidate[1].median / t->candidate[0].median;
        t->chosen = ratio[tried] < 1.0;
    }
    int last = tried - 1, usual = b->usual.loop_records;
    if (ratio[last] < 1.0)
        b->found.loop_records = (int)records[last];
    else if (last == 0)
        b->found.loop_records = 0;
    else {
        double share = -log(ratio[last - 1]) / (log(ratio[last]) - log(ratio[last - 1]));
        b->found.loop_records = (int)(records[last - 1] * pow(records[last] / records[last - 1], share));
    }
    if (b->found.loop_records > usual / LOOP_FACTOR && b->found.loop_records < usual * LOOP_FACTOR)
        b->found.loop_records = usual;
    return STATUS_OK;
}

/* ---- reporting ---- */

static void print_trial(const trial *t)
{
    printf("%s (%s), %lld grains, us a step\n", t->name, t->unit, (long long)t->particles);
    for (int c = 0; c < t->count; c++) {
        const candidate *one = &t->candidate[c];
        printf("  %8d%12.4g  %.4g..%.4g%s%s\n", one->value, 1e6 * one->median, 1e6 * one->low, 1e6 * one->high,
               one->value == t->usual ? "  usual" : "", one->value == t->chosen ? "  taken" : "");
    }
}

static void print_choice(const char *name, int usual, int found)
{
    printf("  %-16s%8d", name, found);
    printf(found == usual ? "  as usual\n" : "  instead of %d\n", usual);
}

static void print_choices(const tune_bench *b, const char *path)
{
    char text[1024];
    device_describe(&b->device.info, text, sizeof text);
    printf("Tuned for %s:\n", text);
    print_choice("block", b->usual.block, b->found.block);
    print_choice("chunk_records", b->usual.chunk_records, b->found.chunk_records);
    print_choice("batch_steps", b->usual.batch_steps, b->found.batch_steps);
    print_choice("loop_records", b->usual.loop_records, b->found.loop_records);
    printf("Kept in %s; later runs take it from there. `clast bench tune --forget` drops it, CLAST_TUNING=off leaves it aside.\n", path);
}

static json_t *json_trial(const trial *t)
{
    json_t *list = json_array();
    for (int c = 0; c < t->count; c++)
        json_array_append_new(list, json_pack("{s:i, s:f, s:f, s:f}", "value", t->candidate[c].value, "s", t->candidate[c].median, "s_low",
                                              t->candidate[c].low, "s_high", t->candidate[c].high));
    return json_pack("{s:s, s:I, s:i, s:i, s:o}", "name", t->name, "particles", (json_int_t)t->particles, "usual", t->usual, "taken",
                     t->chosen, "candidates", list);
}

static status write_json(const tune_bench *b, failure *why)
{
    json_t *list = json_array();
    for (int t = 0; t < b->trial_count; t++)
        json_array_append_new(list, json_trial(&b->trial[t]));
    json_t *root = json_pack("{s:s, s:{s:i, s:i, s:i, s:i}, s:o}", "device", b->device.info.name, "tuning", "block", b->found.block,
                             "chunk_records", b->found.chunk_records, "batch_steps", b->found.batch_steps, "loop_records",
                             b->found.loop_records, "trials", list);
    bool whole = root && json_dump_file(root, b->options->json_path, JSON_INDENT(1)) == 0;
    json_decref(root);
    return whole ? STATUS_OK : fail(why, STATUS_ERROR, "%s: cannot be written: %s", b->options->json_path, strerror(errno));
}

static void warn_of_load(void)
{
    double load = 0.0;
    if (getloadavg(&load, 1) == 1 && load > 0.5)
        fprintf(stderr, "other programs are busy here (load %.1f): what is found may be their noise; tune on an idle machine\n", load);
}

static status tune(tune_bench *b, failure *why)
{
    warn_of_load();
    static status (*const tries[])(tune_bench *, failure *) = {try_blocks, try_chunks, try_batches, try_loop};
    char path[4096] = "";
    b->usual = b->found = tuning_default(&b->device.info);
    for (size_t t = 0; t < sizeof tries / sizeof *tries; t++) {
        int before = b->trial_count;
        TRY(tries[t](b, why));
        for (int n = before; n < b->trial_count; n++)
            print_trial(&b->trial[n]);
        fflush(stdout);
    }
    TRY(tuning_store(&b->device.info, &b->found, path, sizeof path, why));
    print_choices(b, path);
    return b->options->json_path ? write_json(b, why) : STATUS_OK;
}

static status forget(const device *d, failure *why)
{
    char path[4096] = "";
    TRY(tuning_forget(&d->info, path, sizeof path, why));
    printf("%s is gone; later runs take what is usual\n", path);
    return STATUS_OK;
}

status bench_tune(const bench_options *options, failure *why)
{
    tune_bench *b = calloc(1, sizeof *b);
    if (!b)
        return fail(why, STATUS_ERROR, "out of memory");
    b->options = options;
    status result = bench_check_writable(options->json_path, why);
    if (result == STATUS_OK)
        result = device_open(options->device, false, &b->device, why);
    if (result == STATUS_OK) {
        result = options->forget ? forget(&b->device, why) : tune(b, why);
        device_close(&b->device);
    }
    free(b);
    return result;
}
