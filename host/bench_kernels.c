/* Every kernel that a run launches, by the device's own clock: steps of the settled bed, a contact table, and what is looked at between steps. */
#include "bench.h"
#include "settled_bed.h"
#include "simulation.h"
#include "traffic.h"

#include <errno.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define KERNEL_STEPS  50
#define WARM_UP_STEPS 100
#define TABLES        3

typedef enum bench_phase { PHASE_STEP, PHASE_TABLE, PHASE_BETWEEN, PHASES } bench_phase;
static const char *const phase_names[PHASES] = {"step", "table", "between steps"};

typedef struct kernel_figures {
    const char *name; /* the simulation's own */
    bench_phase phase;
    int64_t launches;
    double seconds, bytes;
} kernel_figures;

typedef struct seen_launch {
    const char *name;
    bench_phase phase;
    double bytes;
    cl_event event;
} seen_launch;

typedef struct kernels_bench {
    const bench_options *options;
    device device;
    simulation *sim;
    launch_watch watch;
    bench_phase phase;
    seen_launch *seen;
    size_t seen_count, seen_capacity;
    status seen_result;
    failure seen_why;
    kernel_figures kernel[SIMULATION_KERNELS_MAX];
    int kernel_count;
    int64_t rounds[PHASES]; /* steps, tables, looks */
    double copy_speed, step_bytes;
    int64_t particles;
    char device_text[1024];
} kernels_bench;

/* ---- collecting ---- */

static bool is_of_table(const char *name)
{
    return strncmp(name, "table_", 6) == 0 || strncmp(name, "scan_", 5) == 0;
}

/* What a launch moves depends on the table as it is now; its time is known later. */
static void see_launch(void *context, const char *name, cl_kernel kernel, size_t items, cl_event event)
{
    kernels_bench *b = context;
    double bytes = 0.0;
    if (b->seen_count == b->seen_capacity) {
        size_t capacity = 2 * b->seen_capacity + 1024;
        seen_launch *more = realloc(b->seen, capacity * sizeof *more);
        if (!more) {
            clReleaseEvent(event);
            b->seen_result = fail(&b->seen_why, STATUS_ERROR, "out of memory");
            return;
        }
        b->seen = more;
        b->seen_capacity = capacity;
    }
    if (b->seen_result == STATUS_OK)
        b->seen_result = traffic_of_launch(b->sim, kernel, name, items, &bytes, &b->seen_why);
    b->seen[b->seen_count++] = (seen_launch){name, is_of_table(name) ? PHASE_TABLE : b->phase, bytes, event};
}

static kernel_figures *figures_of(kernels_bench *b, const char *name, bench_phase phase)
{
    for (int k = 0; k < b->kernel_count; k++)
        if (strcmp(b->kernel[k].name, name) == 0 && b->kernel[k].phase == phase)
            return &b->kernel[k];
    if (b->kernel_count == SIMULATION_KERNELS_MAX)
        return NULL;
    b->kernel[b->kernel_count] = (kernel_figures){.name = name, .phase = phase};
    return &b->kernel[b->kernel_count++];
}

static status take_time(kernels_bench *b, const seen_launch *seen, bool counts, failure *why)
{
    cl_ulong start = 0, end = 0;
    TRY_CL(clGetEventProfilingInfo(seen->event, CL_PROFILING_COMMAND_START, sizeof start, &start, NULL), "reading a kernel's time");
    TRY_CL(clGetEventProfilingInfo(seen->event, CL_PROFILING_COMMAND_END, sizeof end, &end, NULL), "reading a kernel's time");
    kernel_figures *k = counts ? figures_of(b, seen->name, seen->phase) : NULL;
    if (!k)
        return STATUS_OK;
    k->launches++;
    k->seconds += 1e-9 * (double)(end - start);
    k->bytes += seen->bytes;
    return STATUS_OK;
}

/* Waits for what was launched and takes its times, or drops them. */
static status take_times(kernels_bench *b, bool counts, failure *why)
{
    TRY_CL(clFinish(b->device.queue), "waiting for the kernels");
    status result = b->seen_result;
    if (result != STATUS_OK)
        *why = b->seen_why;
    for (size_t n = 0; n < b->seen_count; n++) {
        if (result == STATUS_OK)
            result = take_time(b, &b->seen[n], counts, why);
        clReleaseEvent(b->seen[n].event);
    }
    b->seen_count = 0;
    return result;
}

/* ---- what is launched ---- */

static status look_between_steps(simulation *sim, failure *why)
{
    particle_sums sums;
    contact_sums contacts;
    step_limit limit;
    guard_finding finding;
    bond_sums bonds;
    heat_sums heat;
    TRY(observe_particle_sums(sim, &sums, why));
    TRY(observe_contact_sums(sim, &contacts, why));
    TRY(limit_find(sim, &limit, why));
    TRY(guard_check(sim, &finding, why));
    if (sim->live.law[SLOT_BOND])
        TRY(bonds_count(sim, &bonds, why));
    return sim->live.law[SLOT_TEMPERATURE] ? heat_observe(sim, &heat, why) : STATUS_OK;
}

static status run_phase(kernels_bench *b, bench_phase phase, failure *why)
{
    b->phase = phase;
    if (phase == PHASE_STEP)
        return simulation_advance(b->sim, b->rounds[phase], why);
    for (int64_t n = 0; n < b->rounds[phase]; n++)
        TRY(phase == PHASE_TABLE ? table_build(b->sim, false, why) : look_between_steps(b->sim, why));
    return STATUS_OK;
}

static status measure(kernels_bench *b, failure *why)
{
    simulation *sim = b->sim;
    b->rounds[PHASE_STEP] = b->options->steps > 0 ? b->options->steps : KERNEL_STEPS;
    b->rounds[PHASE_TABLE] = b->rounds[PHASE_BETWEEN] = TABLES;
    TRY(simulation_begin_stage(sim, 0, why));
    simulation_set_step(sim, bench_step(b->options));
    sim->watch = &b->watch;
    TRY(simulation_advance(sim, WARM_UP_STEPS, why));
    for (bench_phase phase = PHASE_TABLE; phase < PHASES; phase++)
        TRY(run_phase(b, phase, why));
    TRY(take_times(b, false, why)); /* so far they were compiled */
    for (bench_phase phase = PHASE_STEP; phase < PHASES; phase++) {
        int64_t tables = sim->rebuilds;
        TRY(run_phase(b, phase, why));
        b->rounds[PHASE_TABLE] += phase == PHASE_STEP ? sim->rebuilds - tables : 0;
    }
    TRY(take_times(b, true, why));
    sim->watch = NULL;
    step_traffic traffic;
    TRY(traffic_of_step(sim, &traffic, why));
    b->step_bytes = traffic.pair_bytes + traffic.particle_bytes;
    return traffic_copy_speed(&b->device, b->step_bytes, &b->copy_speed, why);
}

/* ---- reporting ---- */

static double phase_seconds(const kernels_bench *b, bench_phase phase)
{
    double sum = 0.0;
    for (int k = 0; k < b->kernel_count; k++)
        sum += b->kernel[k].phase == phase ? b->kernel[k].seconds : 0.0;
    return sum / (double)b->rounds[phase];
}

static int by_phase_and_time(const void *a, const void *b)
{
    const kernel_figures *x = a, *y = b;
    return x->phase != y->phase ? (x->phase > y->phase) - (x->phase < y->phase) : (x->seconds < y->seconds) - (x->seconds > y->seconds);
}

static void print_kernels(kernels_bench *b)
{
    char effects[128];
    bench_phase phase = PHASES;
    bench_name_effects(b->options->effects, effects, sizeof effects);
    printf("Kernels of the settled bed of %lld grains with contact, friction%s%s in %s precision on %s\n", (long long)b->particles,
           effects[0] ? ", " : "", effects, b->sim->mixed ? "mixed" : "double", b->device_text);
    printf("A copy of %.3g MB, as many as a step moves, reaches %.3g GB/s. Times are the device's; bytes count every array of a kernel's "
           "arguments once.\n",
           1e-6 * b->step_bytes, 1e-9 * b->copy_speed);
    for (int k = 0; k < b->kernel_count; k++) {
        const kernel_figures *f = &b->kernel[k];
        double rounds = (double)b->rounds[f->phase], each = f->seconds / rounds;
        if (f->phase != phase) {
            phase = f->phase;
            printf("\n%s: %.4g us\n  %-28s%10s%12s%10s%9s%8s%12s\n", phase_names[phase], 1e6 * phase_seconds(b, phase), "", "launches",
                   "us", "share", "MB", "GB/s", "of a copy");
        }
        printf("  %-28s%10.4g%12.4g%8.1f %%%9.3g%8.3g%10.0f %%\n", f->name, (double)f->launches / rounds, 1e6 * each,
               100.0 * each / phase_seconds(b, phase), 1e-6 * f->bytes / rounds, 1e-9 * f->bytes / f->seconds,
               100.0 * f->bytes / f->seconds / b->copy_speed);
    }
}

static status write_json(const kernels_bench *b, failure *why)
{
    json_t *list = json_array();
    for (int k = 0; k < b->kernel_count; k++) {
        const kernel_figures *f = &b->kernel[k];
        double rounds = (double)b->rounds[f->phase];
        json_array_append_new(list, json_pack("{s:s, s:s, s:f, s:f, s:f, s:f, s:f, s:f}", "kernel", f->name, "phase", phase_names[f->phase],
                                              "launches", (double)f->launches / rounds, "seconds", f->seconds / rounds, "share",
                                              f->seconds / rounds / phase_seconds(b, f->phase), "bytes", f->bytes / rounds, "bytes_per_s",
                                              f->bytes / f->seconds, "share_of_copy", f->bytes / f->seconds / b->copy_speed));
    }
    char effects[128];
    bench_name_effects(b->options->effects, effects, sizeof effects);
    json_t *root = json_pack("{s:s, s:s, s:s, s:I, s:f, s:f, s:o}", "device", b->device_text, "precision",
                             b->sim->mixed ? "mixed" : "double", "effects", effects, "particles", (json_int_t)b->particles, "step_bytes",
                             b->step_bytes, "copy_bytes_per_s", b->copy_speed, "kernels", list);
    bool whole = root && json_dump_file(root, b->options->json_path, JSON_INDENT(1)) == 0;
    json_decref(root);
    return whole ? STATUS_OK : fail(why, STATUS_ERROR, "%s: cannot be written: %s", b->options->json_path, strerror(errno));
}

static status write_csv(const kernels_bench *b, failure *why)
{
    FILE *file = fopen(b->options->csv_path, "w");
    if (!file)
        return fail(why, STATUS_ERROR, "%s: cannot be written: %s", b->options->csv_path, strerror(errno));
    fprintf(file, "# device: %s; precision: %s; particles: %lld; copy: %.4g GB/s\n", b->device_text, b->sim->mixed ? "mixed" : "double",
            (long long)b->particles, 1e-9 * b->copy_speed);
    fprintf(file, "phase,kernel,launches,us,share,bytes,gb_per_s,share_of_copy\n");
    for (int k = 0; k < b->kernel_count; k++) {
        const kernel_figures *f = &b->kernel[k];
        double rounds = (double)b->rounds[f->phase];
        fprintf(file, "%s,%s,%.4g,%.2f,%.4f,%.0f,%.3f,%.3f\n", phase_names[f->phase], f->name, (double)f->launches / rounds,
                1e6 * f->seconds / rounds, f->seconds / rounds / phase_seconds(b, f->phase), f->bytes / rounds,
                1e-9 * f->bytes / f->seconds, f->bytes / f->seconds / b->copy_speed);
    }
    return fclose(file) == 0 ? STATUS_OK : fail(why, STATUS_ERROR, "%s: writing stopped: %s", b->options->csv_path, strerror(errno));
}

static status report(kernels_bench *b, failure *why)
{
    qsort(b->kernel, (size_t)b->kernel_count, sizeof *b->kernel, by_phase_and_time);
    print_kernels(b);
    if (b->options->json_path)
        TRY(write_json(b, why));
    return b->options->csv_path ? write_csv(b, why) : STATUS_OK;
}

static status run_bench(kernels_bench *b, failure *why)
{
    settled_bed of;
    TRY(settled_bed_make(b->options->particles, b->options->effects, &b->options->sizes, &b->device, b->options->kernels, &of, why));
    of.scene->precision = b->options->mixed ? PRECISION_MIXED : PRECISION_DOUBLE;
    of.scene->table.step_form = STEP_TWO_KERNELS;
    b->particles = of.bed.count;
    status result = simulation_create(of.scene, &of.bed, &b->device, b->options->kernels, &b->sim, why);
    if (result == STATUS_OK)
        result = measure(b, why);
    if (result == STATUS_OK)
        result = report(b, why);
    simulation_free(b->sim);
    settled_bed_free(&of);
    return result;
}

/* In place of the device's queue one that takes times. */
static status take_times_of_queue(device *d, failure *why)
{
    cl_int code;
    cl_command_queue queue = clCreateCommandQueue(d->context, d->info.id, CL_QUEUE_PROFILING_ENABLE, &code);
    TRY_CL(code, "making a queue that takes times");
    clReleaseCommandQueue(d->queue);
    d->queue = queue;
    return STATUS_OK;
}

status bench_kernels(const bench_options *options, failure *why)
{
    kernels_bench *b = calloc(1, sizeof *b);
    if (!b)
        return fail(why, STATUS_ERROR, "out of memory");
    b->options = options;
    b->watch = (launch_watch){see_launch, b};
    status result = bench_check_writable(options->json_path, why);
    if (result == STATUS_OK)
        result = bench_check_writable(options->csv_path, why);
    if (result == STATUS_OK)
        result = device_open(options->device, !options->mixed, &b->device, why);
    if (result == STATUS_OK) {
        device_describe(&b->device.info, b->device_text, sizeof b->device_text);
        result = take_times_of_queue(&b->device, why);
        if (result == STATUS_OK)
            result = run_bench(b, why);
        device_close(&b->device);
    }
    free(b->seen);
    free(b);
    return result;
}
