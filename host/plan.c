#include "plan.h"

#include "answer.h"
#include "clock.h"
#include "frozen.h"
#include "plan_data.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PROBE_WARM_UP 20
#define PROBE_STEPS   200

/* Records a grain in a frictional bed at rest, walls and what the skin lists included, and what a record takes in the table: owner and
 * other in two generations, match, and two slots in two generations. */
#define PACKED_RECORDS     4.0
#define TABLE_RECORD_BYTES 36.0

double plan_bytes_per_particle(const plan *p, uint64_t bytes)
{
    return p->particles > 0 ? (double)bytes / (double)p->particles : 0.0;
}

static void collect_groups(const bed *bed, plan *out)
{
    for (int g = 0; g < out->group_count; g++)
        out->group[g] = (plan_group){.group = &out->scene->group[g], .radius_min = INFINITY};
    for (int64_t i = 0; i < bed->count; i++) {
        plan_group *group = &out->group[bed->group[i]];
        group->count++;
        group->radius_min = fmin(group->radius_min, bed->radius[i]);
        group->radius_max = fmax(group->radius_max, bed->radius[i]);
    }
    out->particles = bed->count;
    out->overlap_max = bed_largest_overlap(bed, &out->scene->domain, &out->overlap_i, &out->overlap_j);
}

/* Steps to the end in time or steps, whichever comes first. */
static double count_steps(const scene_stage *stage, double step_s)
{
    double by_time = isnan(stage->until_time_s) ? NAN : ceil(stage->until_time_s / step_s * (1.0 - 1e-12));
    double by_count = stage->until_steps < 0 ? NAN : (double)stage->until_steps;
    return fmin(by_time, by_count); /* fmin passes over a NAN */
}

/* Steps of a frozen stage follow from the error that they make: only the limit of Euler's method is known beforehand. */
static status plan_frozen(simulation *sim, plan_stage *stage, failure *why)
{
    stage->limit = (step_limit){.recommended_s = NAN};
    snprintf(stage->limit.binds, sizeof stage->limit.binds, "heat");
    stage->step_s = stage->steps = NAN;
    return frozen_limit(sim, &stage->limit.limit_s, why);
}

/* Limits as the scene stands at its start: what a stage finds when it begins is known only by running. */
static status collect_stages(simulation *sim, plan *out, failure *why)
{
    for (int s = 0; s < out->stage_count; s++) {
        plan_stage *stage = &out->stage[s];
        stage->stage = &out->scene->stage[s];
        TRY(simulation_begin_stage(sim, s, why));
        stage->live = sim->live;
        if (out->biot_contact)
            TRY(heat_biot(sim, out->biot_contact, out->biot_surface, why));
        if (stage->stage->frozen) {
            TRY(plan_frozen(sim, stage, why));
            continue;
        }
        TRY(limit_find(sim, &stage->limit, why));
        stage->step_s = isnan(stage->stage->step_s) ? stage->limit.recommended_s : stage->stage->step_s;
        stage->steps = count_steps(stage->stage, stage->step_s);
    }
    return STATUS_OK;
}

static void collect_arguments(const live_laws *live, const char *kernel, plan_arguments *out)
{
    out->kernel = kernel;
    out->count = launch_argument_names(live, kernel, out->name, 64);
    out->bytes = sizeof(clast_launch) + sizeof(cl_mem) * (uint64_t)(1 + out->count);
}

/* After a table has been built, so that records have their room. */
static void collect_memory(const simulation *sim, plan *out)
{
    uint64_t fields = 0;
    double record = TABLE_RECORD_BYTES, missing = PACKED_RECORDS * (double)out->particles - (double)sim->table.record_capacity;
    out->field_count = sim->field_count;
    for (int f = 0; f < sim->field_count; f++) {
        const field *of = sim->field[f].field;
        out->field[f] = (plan_field){of->name, of->extent, field_bytes(sim, of)};
        fields += out->field[f].bytes;
        if (of->extent == PER_RECORD)
            record += (double)store_item(sim, of->type) * of->components;
    }
    out->bytes = sim->bytes;
    out->table_bytes = table_bytes(sim);
    out->other_bytes = sim->bytes > fields + out->table_bytes ? sim->bytes - fields - out->table_bytes : 0;
    out->packed_bytes = sim->bytes + (uint64_t)(missing > 0.0 ? missing * record : 0.0);
    out->skin_m = sim->table.skin;
}

/* The first stage for a short while, in a simulation of its own: planning has walked the other one through all stages. */
static status run_probe(simulation *sim, plan *out, failure *why)
{
    plan_probe *probe = &out->probe;
    if (!isfinite(out->stage[0].step_s) || out->particles == 0)
        return STATUS_OK;
    TRY(simulation_begin_stage(sim, 0, why));
    simulation_set_step(sim, out->stage[0].step_s);
    TRY(simulation_advance(sim, PROBE_WARM_UP, why));
    double start = clock_seconds();
    TRY(simulation_advance(sim, PROBE_STEPS, why));
    probe->wall_s = clock_seconds() - start;
    probe->done = true;
    probe->steps = PROBE_STEPS;
    probe->particle_steps_per_s = (double)out->particles * PROBE_STEPS / probe->wall_s;
    for (int s = 0; s < out->stage_count; s++)
        probe->expected_wall_s += out->stage[s].steps * probe->wall_s / PROBE_STEPS;
    return STATUS_OK;
}

static status refuse_unstable(const plan *p, failure *why)
{
    for (int s = 0; s < p->stage_count; s++) {
        const plan_stage *stage = &p->stage[s];
        const char *name = stage->stage->name ? stage->stage->name : "";
        if (stage->stage->step_s > stage->limit.limit_s && !stage->stage->allow_unstable_step)
            return fail(why, STATUS_BAD_INPUT,
                        "%s:%d:%d: stages[%s]: the step of %g s is above the stability limit of %g s (bound by: %s); take %g s or less, or "
                        "`step_s: auto`, or force it with `allow_unstable_step: true`",
                        p->scene->path, stage->stage->at.line, stage->stage->at.column, name, stage->stage->step_s, stage->limit.limit_s,
                        stage->limit.binds, stage->limit.recommended_s);
    }
    return STATUS_OK;
}

static status allocate_biot(const scene *scene, plan *out, failure *why)
{
    if (!scene_has_heat(scene))
        return STATUS_OK;
    out->biot_contact = calloc((size_t)scene->material_count, sizeof *out->biot_contact);
    out->biot_surface = calloc((size_t)scene->material_count, sizeof *out->biot_surface);
    return out->biot_contact && out->biot_surface ? STATUS_OK : fail(why, STATUS_ERROR, "out of memory while planning");
}

static status make_plan(scene *scene, const bed *bed, simulation *sim, plan *out, failure *why)
{
    collect_groups(bed, out);
    out->unused = plan_unused(scene, bed);
    if (!out->unused)
        return fail(why, STATUS_ERROR, "out of memory while planning");
    TRY(allocate_biot(scene, out, why));
    TRY(collect_stages(sim, out, why));
    for (int s = 0; s < scene->stage_count && out->bond_count == 0; s++) {
        free(out->bond);
        out->bond = bond_figures_of(scene, bed, s, &out->bond_count);
        if (!out->bond)
            return fail(why, STATUS_ERROR, "out of memory while planning");
    }
    collect_memory(sim, out);
    collect_arguments(&sim->all, "pair_stage", &out->pair);
    collect_arguments(&sim->all, "particle_stage", &out->particle);
    return STATUS_OK;
}

static status fill_plan(scene *scene, const bed *bed, device *device, const char *kernels, bool probe, plan *out, failure *why)
{
    simulation *sim = NULL;
    status result = simulation_create(scene, bed, device, kernels, &sim, why);
    if (result == STATUS_OK)
        result = make_plan(scene, bed, sim, out, why);
    simulation_free(sim);
    if (result != STATUS_OK || !probe)
        return result;
    result = simulation_create(scene, bed, device, kernels, &sim, why);
    if (result == STATUS_OK)
        result = run_probe(sim, out, why);
    simulation_free(sim);
    return result;
}

static status plan_scene(scene *scene, const bed *bed, device *device, const char *kernels, bool json, bool probe, failure *why)
{
    plan p = {.scene = scene, .device = &device->info, .group_count = scene->group_count, .stage_count = scene->stage_count};
    p.group = calloc((size_t)scene->group_count + 1, sizeof *p.group);
    p.stage = calloc((size_t)scene->stage_count + 1, sizeof *p.stage);
    status result = p.group && p.stage ? fill_plan(scene, bed, device, kernels, probe, &p, why)
                                       : fail(why, STATUS_ERROR, "out of memory while planning");
    if (result == STATUS_OK && json)
        result = plan_write_json(&p, why);
    else if (result == STATUS_OK)
        plan_write_text(&p);
    if (result == STATUS_OK)
        result = refuse_unstable(&p, why);
    for (int k = 0; p.unused && p.unused[k]; k++)
        free(p.unused[k]);
    free(p.unused);
    free(p.biot_contact);
    free(p.biot_surface);
    free(p.bond);
    free(p.group);
    free(p.stage);
    return result;
}

status plan_command(const char *scene_path, int set_count, char *const *sets, const char *device_choice, const char *kernels, bool json,
                    bool probe, failure *why)
{
    scene *scene = NULL;
    bed bed = {0};
    device device = {0};
    TRY(scene_read(scene_path, set_count, sets, &scene, why));
    status result = set_count == 0 ? answer_check_scene(scene, why) : STATUS_OK; /* settings may take away what the study names */
    if (result == STATUS_OK)
        result = bed_generate(scene, &bed, why);
    if (result == STATUS_OK)
        result = simulation_open_device(scene, device_choice, &device, why);
    if (result == STATUS_OK)
        result = plan_scene(scene, &bed, &device, kernels, json, probe, why);
    device_close(&device);
    bed_free(&bed);
    scene_free(scene);
    return result;
}
