#include "bench.h"

#include "clock.h"
#include "settled_bed.h"
#include "simulation.h"

#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define WARM_UP_STEPS 200
#define REST_STEPS    1000 /* of stages before the one that is timed, in which a bed comes to rest again */
#define PROFILE_STEPS 50

typedef struct bench_figures {
    int64_t particles, steps, rebuilds, contacts;
    double wall_s, rebuild_s, particle_steps_per_s;
    double bytes_per_particle, contacts_per_particle, records_per_particle, bonded; /* bonded: share of the contacts */
    double pair_s, particle_s; /* device time of the two stages in a step */
    double kinetic_j;
    const char *form; /* how steps are taken */
    int launches;     /* of a step; 0: one of a batch */
    int streams, chunk_records, force_records;
    char device[1024];
} bench_figures;

/* Grains that are stiffer swing faster. */
double bench_step(const bench_options *options)
{
    return BENCH_STEP_S / sqrt(options->sizes.ratio);
}

bench_options bench_options_default(void)
{
    return (bench_options){.particles = 100000, .sizes = {.ratio = 1.0}, .seconds = 240.0};
}

/* About 10^8 particle-steps, that is some seconds, but not too few or too many steps. */
static int64_t default_steps(int64_t particles)
{
    int64_t steps = 100000000 / particles;
    return steps < 100 ? 100 : steps > 2000 ? 2000 : steps;
}

/* ---- the bed as a table ---- */

static void write_rows(FILE *file, const settled_bed *of)
{
    const bed *b = &of->bed;
    fprintf(file, "# box_m: %.17g %.17g\n", of->side_m, of->side_m);
    fprintf(file, "x_m,y_m,z_m,radius_m,vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,wz_rad_s\n");
    for (int64_t i = 0; i < b->count; i++) {
        const double *x = b->position[i], *v = b->velocity[i], *w = b->spin[i];
        fprintf(file, "%.17g,%.17g,%.17g,%.17g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", x[0], x[1], x[2], b->radius[i], v[0], v[1], v[2], w[0],
                w[1], w[2]);
    }
}

/* The bed as it starts: whoever reads it warms up from the same state, without history of its contacts. */
static status export_bed(const settled_bed *of, const char *path, failure *why)
{
    FILE *file = fopen(path, "w");
    if (!file)
        return fail(why, STATUS_BAD_INPUT, "%s: cannot be written: %s", path, strerror(errno));
    write_rows(file, of);
    bool bad = ferror(file) != 0;
    if (fclose(file) != 0 || bad)
        return fail(why, STATUS_ERROR, "%s: writing stopped: %s", path, strerror(errno));
    return STATUS_OK;
}

/* ---- time by kernel ---- */

static status event_seconds(cl_event event, double *sum, failure *why)
{
    cl_ulong start = 0, end = 0;
    TRY_CL(clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_START, sizeof start, &start, NULL), "reading a kernel's time");
    TRY_CL(clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_END, sizeof end, &end, NULL), "reading a kernel's time");
    *sum += 1e-9 * (double)(end - start);
    return STATUS_OK;
}

static status take_times(const simulation *sim, cl_event *event, bench_figures *out, failure *why)
{
    for (int p = 0; p < sim->plan.count; p++)
        TRY(event_seconds(event[p], sim->plan.piece[p].pairs ? &out->pair_s : &out->particle_s, why));
    return STATUS_OK;
}

static status profile_steps(simulation *sim, cl_command_queue queue, cl_event *event, bench_figures *out, failure *why)
{
    clast_launch launch = launch_values(sim);
    clast_control control = {.halt_step = PROFILE_STEPS};
    launch.travel2 = 1.0; /* no table falls due meanwhile */
    TRY(store_write(sim, sim->control, 0, sizeof control, &control, why));
    TRY(steps_pack_grains(sim, why));
    TRY_CL(clFinish(sim->device->queue), "setting up");
    for (int s = 0; s < PROFILE_STEPS; s++) {
        TRY(step_plan_enqueue(sim, queue, launch, event, why));
        TRY_CL(clFinish(queue), "timing a step");
        status result = take_times(sim, event, out, why);
        for (int p = 0; p < sim->plan.count; p++)
            clReleaseEvent(event[p]);
        TRY(result);
    }
    out->pair_s /= PROFILE_STEPS;
    out->particle_s /= PROFILE_STEPS;
    return STATUS_OK;
}

/* Steps on a queue of its own that takes times; apart from the timed steps, which it would slow down. The state is of no use afterwards. */
static status profile(simulation *sim, bench_figures *out, failure *why)
{
    cl_int code;
    cl_command_queue queue = clCreateCommandQueue(sim->device->context, sim->device->info.id, CL_QUEUE_PROFILING_ENABLE, &code);
    TRY_CL(code, "making a queue that takes times");
    cl_event *event = calloc((size_t)sim->plan.count, sizeof *event);
    status result = event ? profile_steps(sim, queue, event, out, why) : fail(why, STATUS_ERROR, "out of memory");
    clFinish(queue);
    free(event);
    clReleaseCommandQueue(queue);
    return result;
}

/* ---- measuring ---- */

static status time_steps(simulation *sim, int64_t steps, bench_figures *out, failure *why)
{
    TRY(simulation_advance(sim, WARM_UP_STEPS, why));
    int64_t rebuilds = sim->rebuilds;
    double rebuilding = sim->rebuild_seconds, start = clock_seconds();
    TRY(simulation_advance(sim, steps, why));
    TRY_CL(clFinish(sim->device->queue), "waiting for the last step");
    out->wall_s = clock_seconds() - start;
    out->steps = steps;
    out->rebuilds = sim->rebuilds - rebuilds;
    out->rebuild_s = sim->rebuild_seconds - rebuilding;
    out->particle_steps_per_s = (double)sim->count * (double)steps / out->wall_s;
    return STATUS_OK;
}

static status measure(simulation *sim, const bench_options *options, bench_figures *out, failure *why)
{
    particle_sums sums;
    contact_sums contacts;
    int64_t steps = options->steps > 0 ? options->steps : default_steps(options->particles);
    int last = sim->scene->stage_count - 1;
    for (int stage = 0; stage < last; stage++) {
        TRY(simulation_begin_stage(sim, stage, why));
        simulation_set_step(sim, bench_step(options));
        TRY(simulation_advance(sim, REST_STEPS, why));
    }
    TRY(simulation_begin_stage(sim, last, why));
    simulation_set_step(sim, bench_step(options));
    TRY(time_steps(sim, steps, out, why));
    TRY(observe_particle_sums(sim, &sums, why));
    TRY(observe_contact_sums(sim, &contacts, why));
    out->particles = sim->count;
    out->kinetic_j = sums.kinetic;
    out->launches = step_loop_launches(sim);
    out->form = step_loop_name(sim);
    out->streams = step_loop_members(sim);
    out->chunk_records = sim->plan.chunk_records;
    out->force_records = sim->plan.force_records;
    out->bytes_per_particle = (double)sim->bytes / (double)sim->count;
    bond_sums bonds;
    TRY(bonds_count(sim, &bonds, why));
    out->bonded = contacts.contacts > 0 ? (double)bonds.alive / (double)contacts.contacts : 0.0;
    out->contacts = contacts.contacts;
    out->contacts_per_particle = 2.0 * (double)contacts.pairs / (double)sim->count;
    out->records_per_particle = (double)sim->table.record_count / (double)sim->count;
    device_describe(&sim->device->info, out->device, sizeof out->device);
    return profile(sim, out, why);
}

/* ---- reporting ---- */

void bench_name_effects(unsigned effects, char *text, size_t size)
{
    const char *word = bed_effect_words;
    text[0] = '\0';
    for (unsigned bit = 1; *word; bit <<= 1) {
        size_t length = strcspn(word, "|"), used = strlen(text);
        if (effects & bit)
            snprintf(text + used, size - used, "%s%.*s", used ? ", " : "", (int)length, word);
        word += length + (word[length] == '|');
    }
}

/* Of a contact, which two grains share or a grain has with a wall. */
static double ns_a_contact(const bench_figures *f)
{
    return f->contacts > 0 ? 1e9 * f->wall_s / ((double)f->steps * (double)f->contacts) : 0.0;
}

static void print_figures(const bench_figures *f, const bench_options *options)
{
    double n = (double)f->particles;
    char effects[128];
    bench_name_effects(options->effects, effects, sizeof effects);
    printf("Settled bed of %lld grains%s%s%s in %s precision on %s\n", (long long)f->particles, effects[0] ? " with " : "", effects,
           effects[0] ? "," : "", options->mixed ? "mixed" : "double", f->device);
    printf("  %-28s%.4g million (%.4g ns each)\n", "particle-steps a second", 1e-6 * f->particle_steps_per_s,
           1e9 / f->particle_steps_per_s);
    printf("  %-28s%.4g s for %lld steps\n", "wall time", f->wall_s, (long long)f->steps);
    printf("  %-28s%lld, %.3g %% of the wall time\n", "contact tables built", (long long)f->rebuilds, 100.0 * f->rebuild_s / f->wall_s);
    printf("  %-28s%.4g ns a grain and step\n", "pair stage", 1e9 * f->pair_s / n);
    printf("  %-28s%.4g ns a grain and step\n", "particle stage", 1e9 * f->particle_s / n);
    if (f->chunk_records > 0)
        printf("  %-28s%d of chunks of %d records, forces in %s%d\n", "streams", f->streams, f->chunk_records,
               f->force_records > 0 ? "places for " : "all of ", f->force_records > 0 ? f->force_records : (int)(f->records_per_particle * n));
    printf("  %-28s%s, ", "steps taken by", f->form);
    if (f->launches > 0)
        printf("%d launches each\n", f->launches);
    else
        printf("one launch a batch\n");
    printf("  %-28s%.4g a grain\n", "device memory, bytes", f->bytes_per_particle);
    printf("  %-28s%.3f a grain, %.3f records in the table\n", "contacts with others", f->contacts_per_particle, f->records_per_particle);
    printf("  %-28s%.4g ns each\n", "contact-steps", ns_a_contact(f));
    if (options->effects & BED_BONDS)
        printf("  %-28s%.3g %%\n", "of all contacts are bonded", 100.0 * f->bonded);
    printf("  %-28s%.3g J\n", "kinetic energy", f->kinetic_j);
}

static status write_json(const bench_figures *f, const bench_options *options, failure *why)
{
    char effects[128];
    bench_name_effects(options->effects, effects, sizeof effects);
    json_t *root = json_pack("{s:s, s:s, s:I, s:I, s:f, s:b, s:s, s:f, s:f, s:f, s:I, s:f, s:f, s:f, s:f, s:f, s:f, s:s, s:i, s:i, s:i, s:f, s:f, s:f, s:I, s:f}", "device", f->device, "precision", options->mixed ? "mixed" : "double",
                             "particles", (json_int_t)f->particles, "steps", (json_int_t)f->steps, "step_s", bench_step(options), "rolling",
                             (int)(options->effects & BED_ROLLING), "effects", effects, "wall_s", f->wall_s, "particle_steps_per_s", f->particle_steps_per_s, "bytes_per_particle",
                             f->bytes_per_particle, "rebuilds", (json_int_t)f->rebuilds, "rebuild_s", f->rebuild_s, "pair_stage_s",
                             f->pair_s, "particle_stage_s", f->particle_s, "contacts_per_particle", f->contacts_per_particle,
                             "records_per_particle", f->records_per_particle, "kinetic_energy_j", f->kinetic_j, "step_form", f->form, "launches_per_step", f->launches, "chunk_records",
                             f->chunk_records, "force_records", f->force_records, "bonded_share", f->bonded, "size_ratio", options->sizes.ratio, "large_share", options->sizes.large_share, "contacts",
                             (json_int_t)f->contacts, "ns_per_contact_step", ns_a_contact(f));
    FILE *file = root ? fopen(options->json_path, "w") : NULL;
    bool whole = file && json_dumpf(root, file, JSON_INDENT(2)) == 0 && fputc('\n', file) != EOF;
    if (file && fclose(file) != 0)
        whole = false;
    json_decref(root);
    return whole ? STATUS_OK : fail(why, STATUS_ERROR, "%s: cannot be written: %s", options->json_path, strerror(errno));
}

status bench_check_writable(const char *path, failure *why)
{
    if (!path)
        return STATUS_OK;
    FILE *file = fopen(path, "a");
    if (!file)
        return fail(why, STATUS_BAD_INPUT, "%s: cannot be written: %s", path, strerror(errno));
    fclose(file);
    return STATUS_OK;
}

static status run_bench(const bench_options *options, device *device, bench_figures *figures, failure *why)
{
    settled_bed of;
    simulation *sim = NULL;
    TRY(settled_bed_make(options->particles, options->effects, &options->sizes, device, options->kernels, &of, why));
    status result = options->export_path ? export_bed(&of, options->export_path, why) : STATUS_OK;
    of.scene->precision = options->mixed ? PRECISION_MIXED : PRECISION_DOUBLE;
    of.scene->table.step_form = options->form;
    if (result == STATUS_OK)
        result = simulation_create(of.scene, &of.bed, device, options->kernels, &sim, why);
    if (result == STATUS_OK)
        result = measure(sim, options, figures, why);
    simulation_free(sim);
    settled_bed_free(&of);
    return result;
}

status bench_bed(const bench_options *options, failure *why)
{
    device device;
    bench_figures figures = {0};
    TRY(bench_check_writable(options->export_path, why));
    TRY(bench_check_writable(options->json_path, why));
    TRY(device_open(options->device, !options->mixed, &device, why));
    status result = run_bench(options, &device, &figures, why);
    device_close(&device);
    TRY(result);
    print_figures(&figures, options);
    return options->json_path ? write_json(&figures, options, why) : STATUS_OK;
}
