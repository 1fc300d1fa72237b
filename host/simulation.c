/* Makes what a run holds on the device, and takes it apart. */
#include "simulation.h"

#include "bond_figures.h"
#include "frozen.h"
#include "laws/fields.h"
#include "laws/laws.h"
#include "ledger.h"
#include "precision.h"
#include "property.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void measure_bed(simulation *sim, const bed *bed)
{
    const scene *scene = sim->scene;
    sim->radius_min = sim->table.radius_min = INFINITY;
    for (int64_t i = 0; i < bed->count; i++) {
        double rest = bed->radius[i], r = rest * expansion_factor(scene, bed->material[i], bed->temperature[i]),
               density = scene_material(scene, bed->material[i], &property_density);
        sim->radius_min = fmin(sim->radius_min, r);
        sim->radius_max = fmax(sim->radius_max, r);
        sim->table.radius_min = fmin(sim->table.radius_min, rest);
        sim->table.radius_max = fmax(sim->table.radius_max, rest);
        sim->mean_radius += r / (double)bed->count;
        sim->mean_mass += 4.0 / 3.0 * M_PI * density * rest * rest * rest / (double)bed->count;
    }
    for (int c = 0; c < 3; c++) {
        bool periodic = scene->domain.given && scene->domain.periodic[c];
        sim->bed_low[c] = periodic ? scene->domain.low_m[c] : bed->low[c];
        sim->bed_high[c] = periodic ? scene->domain.high_m[c] : bed->high[c];
    }
}

/* The origin of the device's positions in mixed precision: a bed's length below the bed, so that its coordinates share their binary place
 * (kernels/precision/mixed.cl). On a coarse grid of powers of two, which keeps the scene's numbers round. */
static void choose_origin(simulation *sim)
{
    double extent = 8.0 * sim->radius_max;
    for (int c = 0; c < 3; c++)
        extent = fmax(extent, 1.25 * (sim->bed_high[c] - sim->bed_low[c] + 2.0 * sim->radius_max));
    double length = exp2(ceil(log2(extent)));
    for (int c = 0; sim->mixed && isfinite(length) && c < (sim->all.law[SLOT_DIMENSIONS] ? 2 : 3); c++)
        sim->origin[c] = 0.125 * length * floor((sim->bed_low[c] - sim->radius_max) / (0.125 * length)) - length;
}

static status check_periods(const simulation *sim, failure *why)
{
    const domain *d = &sim->scene->domain;
    double least = 2.0 * (2.0 * sim->radius_max + sim->table.skin + sim->reach);
    for (int c = 0; d->given && c < 3; c++)
        if (d->periodic[c] && d->high_m[c] - d->low_m[c] < least)
            return fail(why, STATUS_BAD_INPUT,
                        "%s:%d:%d: domain: the periodic length along %c is %g m; it must be at least %g m (two largest diameters and the "
                        "skin, twice)",
                        sim->scene->path, d->at.line, d->at.column, "xyz"[c], d->high_m[c] - d->low_m[c], least);
    return STATUS_OK;
}

/* A sphere touches a cylinder that it just fits into all along a circle, and no cone holds one that its wider end does not let in. */
static status check_round_walls(const simulation *sim, failure *why)
{
    for (int w = 0; w < sim->scene->wall_count; w++) {
        const wall *wall = &sim->scene->wall[w];
        if ((wall->shape != WALL_CYLINDER && wall->shape != WALL_CONE) || wall->outside)
            continue;
        double wide = fmax(wall->radii_m[0], wall->radii_m[1]), widen = wall->radii_m[1] - wall->radii_m[0];
        double most = wide * wall->length_m / hypot(wall->length_m, widen);
        if (sim->radius_max >= most)
            return fail(why, STATUS_BAD_INPUT,
                        "%s:%d:%d: the wall `%s` holds spheres of a radius below %g m inside; the largest particle has %g m; "
                        "widen the wall, or write `side: outside` if it stands beside the particles",
                        sim->scene->path, wall->at.line, wall->at.column, wall->name, most, sim->radius_max);
    }
    return STATUS_OK;
}

static status upload_vectors(simulation *sim, const char *name, const double (*value)[3], int64_t count, failure *why)
{
    return store_put_grains(sim, store_find(sim, name), count, &value[0][0], why);
}

/* Radii at the temperatures of the grains; their own are those at the reference temperature. */
static status upload_expanded(simulation *sim, const bed *bed, double *radius, failure *why)
{
    stored_field *reference = store_find(sim, field_reference_radius.name);
    if (!reference)
        return STATUS_OK;
    TRY(store_put_grains(sim, reference, sim->stride, radius, why));
    for (int64_t i = 0; i < bed->count; i++) {
        double factor = expansion_factor(sim->scene, bed->material[i], bed->temperature[i]);
        if (!(factor > 0.0))
            return fail(why, STATUS_BAD_INPUT,
                        "%s: a particle of the material `%s` at %g K would have %g of its radius; expansion_1_k and "
                        "reference_temperature_k must leave it positive",
                        sim->scene->path, sim->scene->material[bed->material[i]].name, bed->temperature[i], factor);
        radius[i] *= factor;
    }
    return STATUS_OK;
}

/* Grains that pad the last block have unit mass and radius, so that nothing divides by zero. */
static status upload_scalars(simulation *sim, const bed *bed, failure *why)
{
    double *radius = malloc((size_t)sim->stride * sizeof *radius), *mass = malloc((size_t)sim->stride * sizeof *mass);
    int32_t *id = malloc((size_t)sim->stride * sizeof *id), *material = calloc((size_t)sim->stride, sizeof *material);
    status result = radius && mass && id && material ? STATUS_OK : fail(why, STATUS_ERROR, "out of memory");
    for (int64_t i = 0; result == STATUS_OK && i < sim->stride; i++) {
        bool real = i < bed->count;
        double r = real ? bed->radius[i] : 1.0;
        radius[i] = r;
        mass[i] = real ? 4.0 / 3.0 * M_PI * scene_material(sim->scene, bed->material[i], &property_density) * r * r * r : 1.0;
        id[i] = (int32_t)i;
        material[i] = real ? bed->material[i] : 0;
    }
    uint64_t n = (uint64_t)sim->stride;
    if (result == STATUS_OK)
        result = upload_expanded(sim, bed, radius, why);
    if (result == STATUS_OK)
        result = store_put_grains(sim, store_find(sim, "radius"), sim->stride, radius, why);
    if (result == STATUS_OK)
        result = store_put_grains(sim, store_find(sim, "mass"), sim->stride, mass, why);
    if (result == STATUS_OK)
        result = store_write(sim, store_find(sim, "id")->mem, 0, 4 * n, id, why);
    if (result == STATUS_OK && store_find(sim, "material"))
        result = store_write(sim, store_find(sim, "material")->mem, 0, 4 * n, material, why);
    free(radius);
    free(mass);
    free(id);
    free(material);
    return result;
}

static status upload_bed(simulation *sim, const bed *bed, failure *why)
{
    TRY(upload_vectors(sim, "position", (const double(*)[3])bed->position, bed->count, why));
    TRY(upload_vectors(sim, "velocity", (const double(*)[3])bed->velocity, bed->count, why));
    if (store_find(sim, "scalar") && bed->scalar)
        TRY(store_put_grains(sim, store_find(sim, "scalar"), bed->count, bed->scalar, why));
    if (store_find(sim, "spin"))
        TRY(upload_vectors(sim, "spin", (const double(*)[3])bed->spin, bed->count, why));
    TRY(upload_scalars(sim, bed, why));
    TRY(heat_upload_bed(sim, bed, why));
    stored_field *orientation = store_find(sim, "orientation");
    if (!orientation)
        return STATUS_OK;
    double upright[4] = {1.0, 0.0, 0.0, 0.0};
    if (sim->mixed)
        precision_split(upright, 4);
    TRY_CL(clEnqueueFillBuffer(sim->device->queue, orientation->mem, upright, sizeof upright, 0, sizeof upright * (size_t)sim->stride, 0,
                               NULL, NULL),
           "orientation");
    return STATUS_OK;
}

static status create_bodies(simulation *sim, failure *why)
{
    const scene *scene = sim->scene;
    sim->wall_body = calloc((size_t)scene->wall_count + 1, sizeof *sim->wall_body);
    sim->group_body = calloc((size_t)scene->group_count + 1, sizeof *sim->group_body);
    if (!sim->wall_body || !sim->group_body)
        return fail(why, STATUS_ERROR, "out of memory");
    for (int w = 0; w < scene->wall_count; w++) {
        moving_body_init(&sim->wall_body[w], scene_wall_motion(scene, w));
        sim->face_count += wall_face_count(&scene->wall[w]);
    }
    for (int g = 0; g < scene->group_count; g++) {
        moving_body_init(&sim->group_body[g], &scene->group[g].motion);
        sim->group_held[g] = scene->group[g].fixed || scene->group[g].motion.count > 0;
    }
    sim->mover_count = sim->all.law[SLOT_MOTION] ? scene->group_count : 0;
    return servo_create(sim, why);
}

/* Of those that are sorted with the grains. */
static uint64_t widest_field(const simulation *sim)
{
    uint64_t widest = 0;
    for (int f = 0; f < sim->field_count; f++) {
        uint64_t bytes = field_bytes(sim, sim->field[f].field);
        if (sim->field[f].field->extent == PER_PARTICLE && sim->field[f].field->role == FIELD_STATE && bytes > widest)
            widest = bytes;
    }
    return widest;
}

static status create_buffers(simulation *sim, failure *why)
{
    TRY(store_fields(sim, why));
    TRY(store_buffer(sim, &sim->built_position, field_bytes(sim, &field_position), "positions at the last table", why));
    TRY(store_fill(sim, sim->built_position, field_bytes(sim, &field_position), why));
    uint64_t widest = widest_field(sim);
    if (widest > field_bytes(sim, &field_position))
        TRY(store_buffer(sim, &sim->scratch4, widest, "sorting", why));
    if (live_keeps_half_steps(&sim->all)) {
        TRY(store_buffer(sim, &sim->velocity_now, field_bytes(sim, &field_velocity), "synchronised velocities", why));
        TRY(store_buffer(sim, &sim->spin_now, store_find(sim, "spin") ? field_bytes(sim, &field_spin) : 0, "synchronised spins", why));
        if (sim->all.law[SLOT_LEDGER])
            TRY(store_buffer(sim, &sim->ledger_now, LEDGER_FIELDS * field_bytes(sim, &field_dissipated), "the ledger's last half step",
                             why));
    }
    TRY(store_buffer(sim, &sim->where, 4 * (uint64_t)sim->stride, "indices of ids", why));
    TRY(store_buffer(sim, &sim->control, sizeof(clast_control), "control words", why));
    TRY(store_fill(sim, sim->control, sizeof(clast_control), why));
    int width = live_constant_count(&sim->all);
    int64_t constants = (int64_t)width * live_class_count(&sim->all, sim->scene);
    TRY(store_buffer(sim, &sim->constants, store_item(sim, FIELD_REAL) * (uint64_t)constants, "contact constants", why));
    TRY(heat_create(sim, why));
    return table_create(sim, why);
}

/* True where the choice names a device, and none that it names has fp64. */
static bool lacks_fp64(const char *choice)
{
    device_info *list;
    int count, index;
    failure unused;
    if (device_list(&list, &count, &unused) != STATUS_OK)
        return false;
    bool lacks = device_choose(list, count, choice, true, &index, &unused) != STATUS_OK &&
                 device_choose(list, count, choice, false, &index, &unused) == STATUS_OK;
    free(list);
    return lacks;
}

status simulation_open_device(scene *scene, const char *choice, device *out, failure *why)
{
    status result = device_open(choice, scene->precision != PRECISION_MIXED, out, why);
    if (result != STATUS_DEVICE || scene->precision != PRECISION_AUTO || !lacks_fp64(choice))
        return result;
    scene->precision = PRECISION_MIXED;
    return device_open(choice, false, out, why);
}

status simulation_create(const scene *scene, const bed *bed, device *device, const char *kernels_directory, simulation **out, failure *why)
{
    simulation *sim = calloc(1, sizeof *sim);
    *out = sim;
    if (!sim)
        return fail(why, STATUS_ERROR, "out of memory");
    sim->scene = scene;
    sim->device = device;
    sim->block = device->tuning.block;
    sim->kernels_directory = kernels_directory ? strdup(kernels_directory) : NULL;
    sim->id_count = sim->count = bed->count;
    sim->stride = (bed->count + sim->block - 1) / sim->block * sim->block;
    sim->group_held = calloc((size_t)scene->group_count + 1, sizeof *sim->group_held);
    live_laws_of(scene, bed, &sim->all);
    sim->all.blocks = scene->table.kernel_form == KERNEL_BLOCKS || (scene->table.kernel_form == KERNEL_AUTO && device->info.cpu);
    sim->mixed = sim->all.law[SLOT_PRECISION] != NULL;
    live_for_blocks(&sim->all);
    sim->all.loop_items = step_loop_items(sim);
    sim->all.lanes = (int)device->info.float_lanes / (sim->mixed || device->info.float_lanes < 2 ? 1 : 2);
    measure_bed(sim, bed);
    choose_origin(sim);
    sim->reach = bonds_reach(scene, &sim->all, sim->radius_max);
    sim->table.skin_is_given = !isnan(scene->table.skin_m);
    sim->table.skin = sim->table.skin_is_given ? scene->table.skin_m : 0.1 * sim->mean_radius;
    sim->batch_limit = scene->table.batch_steps > 0 ? scene->table.batch_steps : device->tuning.batch_steps;
    sim->batch_limit = sim->batch_limit > BATCH_STEPS_MAX ? BATCH_STEPS_MAX : sim->batch_limit;
    sim->stage = -1;
    TRY(bond_check(scene, bed, why));
    TRY(check_periods(sim, why));
    TRY(check_round_walls(sim, why));
    TRY(create_bodies(sim, why));
    sim->group_of_id = malloc(sizeof *sim->group_of_id * (size_t)(bed->count + 1));
    if (!sim->group_of_id || !sim->group_held)
        return fail(why, STATUS_ERROR, "out of memory");
    memcpy(sim->group_of_id, bed->group, sizeof *sim->group_of_id * (size_t)bed->count);
    TRY(create_buffers(sim, why));
    return upload_bed(sim, bed, why);
}

void simulation_free(simulation *sim)
{
    if (!sim)
        return;
    if (sim->device && sim->device->queue)
        clFinish(sim->device->queue);
    launch_close(sim);
    table_free(sim);
    servo_free(sim);
    heat_free(sim);
    frozen_free(sim);
    step_plan_free(&sim->plan);
    step_loop_free(sim);
    for (int f = 0; f < sim->field_count; f++)
        store_release(sim, &sim->field[f].mem, 0);
    cl_mem *const rest[] = {&sim->where,          &sim->partial,  &sim->control,      &sim->faces,    &sim->movers,    &sim->constants,
                            &sim->built_position, &sim->scratch4, &sim->velocity_now, &sim->spin_now, &sim->ledger_now};
    for (size_t m = 0; m < sizeof rest / sizeof *rest; m++)
        store_release(sim, rest[m], 0);
    free(sim->outbox.copy);
    free(sim->wall_body);
    free(sim->group_body);
    free(sim->group_held);
    free(sim->group_of_id);
    free(sim->face_rows);
    free(sim->mover_rows);
    free(sim->kernels_directory);
    free(sim);
}
