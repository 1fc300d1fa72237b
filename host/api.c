/* The public C API on top of the parts. */
#include "plan.h"
#include "run.h"
#include "simulation.h"

#include <clast/clast.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct clast_bed {
    scene *scene;
    bed bed;
    device device;
    simulation *sim;
};

static clast_status report(status code, const failure *why, char *message)
{
    if (message)
        snprintf(message, CLAST_MESSAGE_SIZE, "%s", code == STATUS_OK ? "" : why->text);
    return (clast_status)code;
}

const char *clast_version(void)
{
    return CLAST_VERSION;
}

static run_options options_of(const clast_run_options *o)
{
    return (run_options){.scene_path = o->scene,
                         .checkpoint_path = o->checkpoint,
                         .out = o->out,
                         .device = o->device,
                         .kernels = o->kernels,
                         .set_count = o->set_count,
                         .sets = o->sets,
                         .quiet = o->quiet};
}

clast_status clast_run(const clast_run_options *options, char *message)
{
    failure why = {""};
    run_options o = options_of(options);
    if (!o.scene_path || !o.out)
        return report(fail(&why, STATUS_BAD_INPUT, "clast_run needs a scene and a results file"), &why, message);
    return report(run_scene(&o, &why), &why, message);
}

clast_status clast_resume(const clast_run_options *options, char *message)
{
    failure why = {""};
    run_options o = options_of(options);
    if (!o.checkpoint_path)
        return report(fail(&why, STATUS_BAD_INPUT, "clast_resume needs a checkpoint"), &why, message);
    return report(run_resume(&o, &why), &why, message);
}

clast_status clast_check(const char *path, char *const *sets, int set_count, const char *device, bool json, bool probe, char *message)
{
    failure why = {""};
    return report(plan_command(path, set_count, sets, device, NULL, json, probe, &why), &why, message);
}

char *clast_scene_reference(void)
{
    return scene_reference();
}

clast_status clast_devices(clast_device *list, int max, int *count, char *message)
{
    failure why = {""};
    device_info *found = NULL;
    status result = device_list(&found, count, &why);
    for (int d = 0; result == STATUS_OK && d < *count && d < max; d++) {
        const device_info *info = &found[d];
        list[d] = (clast_device){.cpu = info->cpu,
                                 .gpu = info->gpu,
                                 .fp64 = info->fp64,
                                 .memory_bytes = info->memory_bytes,
                                 .buffer_bytes = info->buffer_bytes,
                                 .compute_units = info->compute_units};
        memcpy(list[d].name, info->name, sizeof list[d].name);
        memcpy(list[d].driver, info->driver, sizeof list[d].driver);
    }
    free(found);
    return report(result, &why, message);
}

/* ---- a bed in memory ---- */

static status begin(clast_bed *b, int stage, failure *why)
{
    step_limit limit;
    if (stage < 0 || stage >= b->scene->stage_count)
        return fail(why, STATUS_BAD_INPUT, "%s: there is no stage %d; the scene has %d", b->scene->path, stage, b->scene->stage_count);
    TRY(simulation_begin_stage(b->sim, stage, why));
    TRY(limit_find(b->sim, &limit, why));
    double given = b->scene->stage[stage].step_s;
    double step = isnan(given) ? limit.recommended_s : given;
    simulation_set_step(b->sim, isfinite(step) ? step : 1e-6);
    return STATUS_OK;
}

static status open_bed(clast_bed *b, const char *path, char *const *sets, int set_count, const char *device_choice, failure *why)
{
    TRY(scene_read(path, set_count, sets, &b->scene, why));
    TRY(bed_generate(b->scene, &b->bed, why));
    TRY(simulation_open_device(b->scene, device_choice, &b->device, why));
    TRY(simulation_create(b->scene, &b->bed, &b->device, NULL, &b->sim, why));
    return begin(b, 0, why);
}

clast_status clast_bed_open(const char *path, char *const *sets, int set_count, const char *device_choice, clast_bed **out, char *message)
{
    failure why = {""};
    clast_bed *b = calloc(1, sizeof *b);
    *out = NULL;
    if (!b)
        return report(fail(&why, STATUS_ERROR, "out of memory"), &why, message);
    status result = open_bed(b, path, sets, set_count, device_choice, &why);
    if (result == STATUS_OK)
        *out = b;
    else
        clast_bed_close(b);
    return report(result, &why, message);
}

void clast_bed_close(clast_bed *b)
{
    if (!b)
        return;
    simulation_free(b->sim);
    bed_free(&b->bed);
    scene_free(b->scene);
    device_close(&b->device);
    free(b);
}

clast_status clast_bed_begin_stage(clast_bed *b, int stage, char *message)
{
    failure why = {""};
    return report(begin(b, stage, &why), &why, message);
}

clast_status clast_bed_limit(clast_bed *b, double *limit_s, double *recommended_s, char *message)
{
    failure why = {""};
    step_limit limit = {.limit_s = NAN, .recommended_s = NAN};
    status result = limit_find(b->sim, &limit, &why);
    *limit_s = limit.limit_s;
    *recommended_s = limit.recommended_s;
    return report(result, &why, message);
}

void clast_bed_set_step(clast_bed *b, double step_s)
{
    simulation_set_step(b->sim, step_s);
}

clast_status clast_bed_advance(clast_bed *b, int64_t steps, char *message)
{
    failure why = {""};
    return report(simulation_advance(b->sim, steps, &why), &why, message);
}

double clast_bed_time(const clast_bed *b)
{
    return b->sim->time;
}

int64_t clast_bed_step(const clast_bed *b)
{
    return b->sim->step;
}

int64_t clast_bed_count(const clast_bed *b)
{
    return b->sim->id_count;
}

static const stored_field *grain_field(clast_bed *b, const char *name)
{
    const stored_field *stored = store_find(b->sim, name);
    return stored && stored->field->extent == PER_PARTICLE && stored->field->type != FIELD_INT ? stored : NULL;
}

int clast_bed_components(clast_bed *b, const char *name)
{
    const stored_field *stored = grain_field(b, name);
    return stored ? stored->field->components : 0;
}

clast_status clast_bed_field(clast_bed *b, const char *name, double *out, char *message)
{
    failure why = {""};
    double *value = NULL;
    const stored_field *stored = grain_field(b, name);
    if (!stored)
        return report(fail(&why, STATUS_BAD_INPUT, "this bed has no field %s", name), &why, message);
    status result = observe_field(b->sim, name, &value, &why);
    if (result == STATUS_OK)
        memcpy(out, value, sizeof *out * (size_t)b->sim->id_count * (size_t)stored->field->components);
    free(value);
    return report(result, &why, message);
}

clast_status clast_bed_contacts(clast_bed *b, clast_contact **out, int64_t *count, char *message)
{
    failure why = {""};
    live_contact *live = NULL;
    *out = NULL;
    *count = 0;
    status result = observe_contacts(b->sim, false, &live, count, &why);
    if (result == STATUS_OK && !(*out = malloc(sizeof **out * (size_t)(*count + 1))))
        result = fail(&why, STATUS_ERROR, "out of memory");
    for (int64_t k = 0; k < *count && result == STATUS_OK; k++) {
        (*out)[k] = (clast_contact){live[k].i, live[k].j, live[k].wall, live[k].overlap, live[k].area, {0, 0, 0}};
        memcpy((*out)[k].force, live[k].force, sizeof live[k].force);
    }
    free(live);
    return report(result, &why, message);
}
