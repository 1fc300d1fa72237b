/* What an effect costs: the settled bed under every law that a scene may name, alone and one on another, and under what scenes ask for
 * otherwise. Each case runs in turn with the one that it is compared with, on the same bed; the time of a step is that of its launches, tables
 * left out. The step is so short that the bed stays as it is: what a law does to the bed is not its cost. */
#include "bench.h"
#include "bench_scene.h"
#include "clock.h"
#include "laws/laws.h"
#include "simulation.h"
#include "traffic.h"

#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define STILL_STEP_S 1.0e-9
#define SAMPLE_S     0.06 /* wall time of one sample, about */
#define ROUNDS       5    /* samples of a case and of its reference in one pass */
#define ROUNDS_LEAST 3
#define PASSES_MAX   6
#define SAMPLES_MAX  (ROUNDS * PASSES_MAX)
#define CASES_MAX    128

typedef struct sample_set {
    double value[SAMPLES_MAX];
    int count;
} sample_set;

typedef struct quartiles {
    double low, median, high;
} quartiles;

typedef struct bench_case {
    const char *series; /* "alone", "one by one", "setting" */
    char name[96];
    const law *live[BENCH_LAWS_MAX];
    int count;
    const bench_setting *setting;
    int reference;          /* index of the case that it is compared with, or -1 */
    bool refused, left_out; /* left_out: only a reference of others, or not asked for */
    char refusal[256];
    field_sizes sizes;
    step_traffic traffic;
    double records, step_bytes, memory; /* records a grain; bytes that move in a step; on the device, a grain */
    sample_set time, difference;        /* s a step */
} bench_case;

typedef struct effects_bench {
    const bench_options *options;
    device device;
    settled_bed of;
    bench_case *cases;
    int count, stack_first; /* first case of "one by one" */
    double start, copy_bytes, copy_speed;
    int passes;
    char device_text[1024];
} effects_bench;

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double at_share(const double *sorted, int count, double share)
{
    double place = share * (count - 1);
    int below = (int)place;
    return below + 1 < count ? sorted[below] + (place - below) * (sorted[below + 1] - sorted[below]) : sorted[below];
}

static quartiles quartiles_of(const sample_set *set)
{
    double sorted[SAMPLES_MAX];
    if (set->count == 0)
        return (quartiles){NAN, NAN, NAN};
    memcpy(sorted, set->value, sizeof *sorted * (size_t)set->count);
    qsort(sorted, (size_t)set->count, sizeof *sorted, by_value);
    return (quartiles){at_share(sorted, set->count, 0.25), at_share(sorted, set->count, 0.5), at_share(sorted, set->count, 0.75)};
}

static void add_sample(sample_set *set, double value)
{
    if (set->count < SAMPLES_MAX)
        set->value[set->count++] = value;
}

/* ---- which cases ---- */

static bench_case *add_case(effects_bench *b, const char *series, const char *name, int reference)
{
    if (b->count == CASES_MAX)
        return NULL;
    bench_case *c = &b->cases[b->count++];
    *c = (bench_case){.series = series, .reference = reference};
    snprintf(c->name, sizeof c->name, "%s", name);
    return c;
}

static void add_law(bench_case *c, const law *l)
{
    if (c && c->count < BENCH_LAWS_MAX)
        c->live[c->count++] = l;
}

/* "slot law" */
static void case_name(const law *l, const char *before, char *text, size_t size)
{
    snprintf(text, size, "%s%s %s", before, slot_name(l->slot), l->name);
}

/* Nothing, the first law of the normal slot, and every law by itself: another normal law against nothing, the rest beside the first one. */
static void list_alone(effects_bench *b, const law *contact)
{
    char name[96];
    add_case(b, "alone", "nothing", -1);
    case_name(contact, "", name, sizeof name);
    add_law(add_case(b, "alone", name, 0), contact);
    for (const law *const *l = laws; *l; l++) {
        bool replaces = (*l)->slot == contact->slot;
        if (*l == contact)
            continue;
        case_name(*l, "", name, sizeof name);
        bench_case *c = add_case(b, "alone", name, replaces ? 0 : 1);
        if (!replaces)
            add_law(c, contact);
        add_law(c, *l);
    }
}

static void list_stack(effects_bench *b, const law *const *stack, int count)
{
    char name[96];
    b->stack_first = b->count;
    for (int n = 1; n < count; n++) {
        case_name(stack[n], "+ ", name, sizeof name);
        bench_case *c = add_case(b, "one by one", name, n == 1 ? 1 : b->count - 1);
        for (int l = 0; l <= n; l++)
            add_law(c, stack[l]);
    }
}

/* Beside contact and friction. */
static void list_settings(effects_bench *b, const law *const *stack)
{
    for (const bench_setting *s = bench_settings; s->name; s++) {
        bench_case *c = add_case(b, "setting", s->name, b->stack_first);
        add_law(c, stack[0]);
        add_law(c, stack[1]);
        if (c)
            c->setting = s;
    }
}

/* One of the words, by commas, is in the name. */
static bool is_asked_for(const char *only, const char *name)
{
    for (const char *word = only; word && *word;) {
        char one[96];
        size_t length = strcspn(word, ",");
        snprintf(one, sizeof one, "%.*s", (int)(length < sizeof one ? length : sizeof one - 1), word);
        if (length > 0 && strstr(name, one))
            return true;
        word += length + (word[length] == ',');
    }
    return !only;
}

static void list_cases(effects_bench *b)
{
    const law *stack[BENCH_LAWS_MAX];
    int count = bench_stack(stack, BENCH_LAWS_MAX);
    list_alone(b, stack[0]);
    list_stack(b, stack, count);
    list_settings(b, stack);
    for (int n = 0; n < b->count; n++)
        b->cases[n].left_out = !is_asked_for(b->options->only, b->cases[n].name);
}

/* ---- measuring ---- */

typedef struct open_case {
    scene *scene;
    simulation *sim;
} open_case;

static void close_case(open_case *o)
{
    simulation_free(o->sim);
    scene_free(o->scene);
    *o = (open_case){0};
}

static status start_case(effects_bench *b, const bench_case *c, open_case *o, failure *why)
{
    contact_sums contacts;
    *o = (open_case){0};
    bool mixed = b->options->mixed || !b->device.info.fp64;
    TRY(bench_scene_make(&b->of, c->live, c->count, c->setting, mixed, &o->scene, why));
    TRY(simulation_create(o->scene, &b->of.bed, &b->device, b->options->kernels, &o->sim, why));
    TRY(simulation_begin_stage(o->sim, 0, why));
    simulation_set_step(o->sim, STILL_STEP_S);
    TRY(simulation_advance(o->sim, 4, why)); /* compiles, and lets bonds be made */
    return observe_contact_sums(o->sim, &contacts, why);
}

static status take_figures(effects_bench *b, bench_case *c, open_case *o, failure *why)
{
    double grains = (double)o->sim->count;
    TRY(traffic_of_step(o->sim, &c->traffic, why));
    c->sizes = traffic_field_sizes(o->sim);
    c->records = (double)o->sim->table.record_count / grains;
    c->step_bytes = c->traffic.pair_bytes + c->traffic.particle_bytes;
    c->memory = (double)o->sim->bytes / grains;
    if (b->copy_speed > 0.0)
        return STATUS_OK;
    b->copy_bytes = c->step_bytes; /* of the first case: they differ by a factor of two */
    return traffic_copy_speed(&b->device, b->copy_bytes, &b->copy_speed, why);
}

static status sample(open_case *o, int64_t steps, double *s, failure *why)
{
    double before = o->sim->step_seconds;
    TRY(simulation_advance(o->sim, steps, why));
    *s = (o->sim->step_seconds - before) / (double)steps;
    return STATUS_OK;
}

static int64_t steps_of_sample(open_case *o, failure *why)
{
    double s = 0.0;
    if (sample(o, 2, &s, why) != STATUS_OK || s <= 0.0)
        return 2;
    double steps = ceil(SAMPLE_S / s);
    return (int64_t)fmin(fmax(steps, 2.0), 1000.0);
}

/* The case and its reference in turn; `until` ends the rounds early where the machine is slow. */
static status run_rounds(bench_case *c, open_case *o, open_case *reference, double until, failure *why)
{
    int64_t steps = steps_of_sample(o, why);
    for (int round = 0; round < ROUNDS && (round < ROUNDS_LEAST || clock_seconds() < until); round++) {
        double mine = 0.0, theirs = 0.0;
        bool first = round % 2 == 0;
        if (first && reference)
            TRY(sample(reference, steps, &theirs, why));
        TRY(sample(o, steps, &mine, why));
        if (!first && reference)
            TRY(sample(reference, steps, &theirs, why));
        add_sample(&c->time, mine);
        if (reference)
            add_sample(&c->difference, mine - theirs);
    }
    return STATUS_OK;
}

/* Keeps a case as the reference of those to come. */
typedef struct kept_case {
    int index; /* -1: none */
    open_case open;
} kept_case;

static status keep(effects_bench *b, kept_case *k, int index, failure *why)
{
    if (k->index == index)
        return STATUS_OK;
    close_case(&k->open);
    k->index = -1;
    TRY(start_case(b, &b->cases[index], &k->open, why));
    k->index = index;
    return STATUS_OK;
}

/* A case of the stack that may not be leaves its law out of those that follow, which are compared with the one before it. */
static void leave_out(effects_bench *b, int index)
{
    bench_case *c = &b->cases[index];
    const law *gone = c->live[c->count - 1];
    for (int n = index + 1; n < b->count; n++) {
        bench_case *later = &b->cases[n];
        int kept = 0;
        if (strcmp(later->series, c->series) != 0 || strcmp(c->series, "one by one") != 0)
            continue;
        for (int l = 0; l < later->count; l++)
            if (later->live[l] != gone)
                later->live[kept++] = later->live[l];
        later->count = kept;
        if (later->reference == index)
            later->reference = c->reference;
    }
}

static status run_case(effects_bench *b, int index, kept_case *kept, double until, failure *why)
{
    bench_case *c = &b->cases[index];
    open_case o;
    failure refusal;
    status result = start_case(b, c, &o, &refusal);
    if (result == STATUS_BAD_INPUT) {
        c->refused = true;
        const char *text = strstr(refusal.text, ": ");
        snprintf(c->refusal, sizeof c->refusal, "%.250s", text ? text + 2 : refusal.text);
        leave_out(b, index);
        close_case(&o);
        return STATUS_OK;
    }
    if (result != STATUS_OK)
        *why = refusal;
    if (result == STATUS_OK && c->reference >= 0)
        result = keep(b, kept, c->reference, why);
    if (result == STATUS_OK)
        result = take_figures(b, c, &o, why);
    if (result == STATUS_OK)
        result = run_rounds(c, &o, c->reference >= 0 ? &kept->open : NULL, until, why);
    if (result == STATUS_OK && strcmp(c->series, "one by one") == 0) { /* the next one's reference */
        close_case(&kept->open);
        *kept = (kept_case){index, o};
    } else
        close_case(&o);
    return result;
}

static status run_pass(effects_bench *b, failure *why)
{
    kept_case kept = {.index = -1};
    status result = STATUS_OK;
    for (int n = 0; n < b->count && result == STATUS_OK; n++) {
        double left = b->start + b->options->seconds - clock_seconds();
        if (b->cases[n].refused || b->cases[n].left_out)
            continue;
        result = run_case(b, n, &kept, clock_seconds() + left / (b->count - n), why);
        if (isatty(2))
            fprintf(stderr, "\rpass %d: %d of %d ", b->passes + 1, n + 1, b->count);
    }
    close_case(&kept.open);
    if (isatty(2))
        fprintf(stderr, "\r%30s\r", "");
    return result;
}

/* As many passes as the time allows, each with arrays of its own: where they come to lie changes speeds as well. */
static status run_passes(effects_bench *b, failure *why)
{
    double last = 0.0;
    b->start = clock_seconds();
    do {
        double start = clock_seconds();
        TRY(run_pass(b, why));
        b->passes++;
        last = clock_seconds() - start;
    } while (b->passes < PASSES_MAX && clock_seconds() + last < b->start + b->options->seconds);
    return STATUS_OK;
}

/* ---- reporting ---- */

static double ns_a_grain(const effects_bench *b, double s)
{
    return 1e9 * s / (double)b->of.bed.count;
}

static void print_case(const effects_bench *b, const bench_case *c)
{
    if (c->left_out)
        return;
    quartiles time = quartiles_of(&c->time), more = quartiles_of(&c->difference);
    printf("  %-32s", c->name);
    if (c->refused) {
        printf(" not run: %.100s\n", c->refusal);
        return;
    }
    printf("%6.0f%7.0f%6d+%-3d%6.2f%9.0f%8.1f", c->sizes.grain, c->sizes.record, c->traffic.pair_arguments, c->traffic.particle_arguments,
           c->records, c->step_bytes / (double)b->of.bed.count, ns_a_grain(b, time.median));
    if (c->difference.count > 0)
        printf("%+8.1f %+6.1f..%+.1f", ns_a_grain(b, more.median), ns_a_grain(b, more.low), ns_a_grain(b, more.high));
    else
        printf("%8s %6s", "", "");
    printf("%*s%4.0f %%\n", c->difference.count > 0 ? 2 : 10, "", 100.0 * c->step_bytes / time.median / b->copy_speed);
}

static void print_cases(const effects_bench *b)
{
    const char *series = "";
    printf("Settled bed of %lld grains on %s\n", (long long)b->of.bed.count, b->device_text);
    printf("A copy of %.3g MB reaches %.3g GB/s. %d pass%s of up to %d rounds; times are medians, differences medians and quartiles over "
           "the rounds,\n"
           "nanoseconds a grain and step. Bytes: of the fields of a grain and of a record of the contact table, and those that move in a "
           "step, a grain.\n",
           1e-6 * b->copy_bytes, 1e-9 * b->copy_speed, b->passes, b->passes == 1 ? "" : "es", ROUNDS);
    for (int n = 0; n < b->count; n++) {
        const bench_case *c = &b->cases[n];
        if (!c->left_out && strcmp(series, c->series) != 0) {
            series = c->series;
            const char *what = strcmp(series, "alone") == 0        ? "each law alone, beside the law of contact"
                               : strcmp(series, "one by one") == 0 ? "one law on another"
                                                                   : "what scenes ask for otherwise, beside contact and friction";
            printf("\n%s\n  %-32s%6s%7s%10s%6s%9s%8s%8s %-14s%s\n", what, "", "grain", "record", "arguments", "rec.", "moved", "ns", "more",
                   "quartiles", "of a copy");
        }
        print_case(b, c);
    }
}

static json_t *json_numbers(const effects_bench *b, const sample_set *set)
{
    json_t *list = json_array();
    for (int n = 0; n < set->count; n++)
        json_array_append_new(list, json_real(ns_a_grain(b, set->value[n])));
    return list;
}

static json_t *json_case(const effects_bench *b, const bench_case *c)
{
    json_t *names = json_array();
    for (int l = 0; l < c->count; l++)
        json_array_append_new(names, json_sprintf("%s %s", slot_name(c->live[l]->slot), c->live[l]->name));
    if (c->refused)
        return json_pack("{s:s, s:s, s:o, s:s}", "series", c->series, "name", c->name, "laws", names, "refused", c->refusal);
    return json_pack("{s:s, s:s, s:o, s:s?, s:f, s:f, s:i, s:i, s:f, s:f, s:f, s:f, s:o, s:o}", "series", c->series, "name", c->name,
                     "laws", names, "reference", c->reference >= 0 ? b->cases[c->reference].name : NULL, "bytes_grain", c->sizes.grain,
                     "bytes_record", c->sizes.record, "arguments_pair_stage", c->traffic.pair_arguments, "arguments_particle_stage",
                     c->traffic.particle_arguments, "records_per_particle", c->records, "bytes_moved_per_particle_step",
                     c->step_bytes / (double)b->of.bed.count, "share_of_copy",
                     c->step_bytes / quartiles_of(&c->time).median / b->copy_speed, "device_bytes_per_particle", c->memory, "ns",
                     json_numbers(b, &c->time), "difference_ns", json_numbers(b, &c->difference));
}

static status write_json(const effects_bench *b, failure *why)
{
    json_t *list = json_array();
    for (int n = 0; n < b->count; n++)
        if (!b->cases[n].left_out)
            json_array_append_new(list, json_case(b, &b->cases[n]));
    json_t *root = json_pack("{s:s, s:I, s:f, s:i, s:o}", "device", b->device_text, "particles", (json_int_t)b->of.bed.count,
                             "copy_bytes_per_s", b->copy_speed, "passes", b->passes, "cases", list);
    bool whole = root && json_dump_file(root, b->options->json_path, JSON_INDENT(1)) == 0;
    json_decref(root);
    return whole ? STATUS_OK : fail(why, STATUS_ERROR, "%s: cannot be written: %s", b->options->json_path, strerror(errno));
}

static void write_csv_rows(FILE *file, const effects_bench *b)
{
    fprintf(file, "# device: %s; particles: %lld; copy: %.4g GB/s; passes: %d\n", b->device_text, (long long)b->of.bed.count,
            1e-9 * b->copy_speed, b->passes);
    fprintf(file, "series,name,reference,bytes_grain,bytes_record,arguments_pair_stage,arguments_particle_stage,records_per_particle,"
                  "bytes_moved_per_particle_step,ns,ns_low,ns_high,difference_ns,difference_ns_low,difference_ns_high,share_of_copy\n");
    for (int n = 0; n < b->count; n++) {
        const bench_case *c = &b->cases[n];
        if (c->refused || c->left_out)
            continue;
        quartiles t = quartiles_of(&c->time), d = quartiles_of(&c->difference);
        fprintf(file, "%s,%s,%s,%.0f,%.0f,%d,%d,%.3f,%.1f,%.2f,%.2f,%.2f,", c->series, c->name,
                c->reference >= 0 ? b->cases[c->reference].name : "", c->sizes.grain, c->sizes.record, c->traffic.pair_arguments,
                c->traffic.particle_arguments, c->records, c->step_bytes / (double)b->of.bed.count, ns_a_grain(b, t.median),
                ns_a_grain(b, t.low), ns_a_grain(b, t.high));
        if (c->difference.count > 0)
            fprintf(file, "%.2f,%.2f,%.2f", ns_a_grain(b, d.median), ns_a_grain(b, d.low), ns_a_grain(b, d.high));
        else
            fprintf(file, ",,");
        fprintf(file, ",%.3f\n", c->step_bytes / t.median / b->copy_speed);
    }
}

static status write_csv(const effects_bench *b, failure *why)
{
    FILE *file = fopen(b->options->csv_path, "w");
    if (file)
        write_csv_rows(file, b);
    if (!file || fclose(file) != 0)
        return fail(why, STATUS_ERROR, "%s: cannot be written: %s", b->options->csv_path, strerror(errno));
    return STATUS_OK;
}

/* ---- scenes instead of times ---- */

static status write_scene(const effects_bench *b, int index, failure *why)
{
    const bench_case *c = &b->cases[index];
    char path[4096], *text = bench_scene_text(&b->of, c->live, c->count, c->setting, b->options->mixed);
    snprintf(path, sizeof path, "%s/%02d_%s_%s.yaml", b->options->scenes, index, c->series, c->name);
    for (char *p = path + strlen(b->options->scenes); *p; p++)
        *p = *p == ' ' || *p == '+' ? '_' : *p;
    FILE *file = text ? fopen(path, "w") : NULL;
    bool whole = file && fputs(text, file) != EOF;
    if (file && fclose(file) != 0)
        whole = false;
    free(text);
    return whole ? STATUS_OK : fail(why, STATUS_BAD_INPUT, "%s: cannot be written: %s", path, strerror(errno));
}

static status write_scenes(const effects_bench *b, failure *why)
{
    for (int n = 0; n < b->count; n++)
        if (!b->cases[n].left_out)
            TRY(write_scene(b, n, why));
    return STATUS_OK;
}

static status run_bench(effects_bench *b, failure *why)
{
    TRY(settled_bed_make(b->options->particles, 0, NULL, &b->device, b->options->kernels, &b->of, why));
    memset(b->of.bed.spin, 0, sizeof *b->of.bed.spin * (size_t)b->of.bed.count); /* a bed that spins follows its spins under any law */
    list_cases(b);
    status result = b->options->scenes ? write_scenes(b, why) : run_passes(b, why);
    if (result == STATUS_OK && !b->options->scenes)
        print_cases(b);
    if (result == STATUS_OK && b->options->json_path)
        result = write_json(b, why);
    if (result == STATUS_OK && b->options->csv_path)
        result = write_csv(b, why);
    settled_bed_free(&b->of);
    return result;
}

status bench_effects(const bench_options *options, failure *why)
{
    effects_bench b = {.options = options};
    TRY(bench_check_writable(options->json_path, why));
    TRY(bench_check_writable(options->csv_path, why));
    TRY(device_open(options->device, false, &b.device, why));
    device_describe(&b.device.info, b.device_text, sizeof b.device_text);
    b.cases = calloc(CASES_MAX, sizeof *b.cases);
    status result = b.cases ? run_bench(&b, why) : fail(why, STATUS_ERROR, "out of memory");
    free(b.cases);
    device_close(&b.device);
    return result;
}
