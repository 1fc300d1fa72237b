#include "simulation.h"

#include "bond_figures.h"
#include "frozen.h"
#include "laws/fields.h"
#include "laws/laws.h"
#include "precision.h"
#include "property.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* ---- making one ---- */

static void measure_bed(simulation *sim, const bed *bed)
{
    const scene *scene = sim->scene;
    sim->radius_min = sim->table.radius_min = INFINITY;
    for (int64_t i = 0; i < bed->count; i++) {
        double rest = bed->radius[i], r = rest * expansion_factor(scene, bed->material[i], bed->temperature[i]), density = scene_material(scene, bed->material[i], &property_density);
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
    for (int c = 0; sim->mixed && isfinite(length) && c < 3; c++)
        sim->origin[c] = 0.125 * length * floor((sim->bed_low[c] - sim->radius_max) / (0.125 * length)) - length;
}

static status check_periods(const simulation *sim, failure *why)
{
    const domain *d = &sim->scene->domain;
    double least = 2.0 * (2.0 * sim->radius_max + sim->table.skin + sim->reach);
    for (int c = 0; d->given && c < 3; c++)
        if (d->periodic[c] && d->high_m[c] - d->low_m[c] < least)
            return fail(why, STATUS_BAD_INPUT,
                        "%s: domain: the periodic length along %c is %g m; it must be at least %g m (two largest diameters and the skin, twice)",
                        sim->scene->path, "xyz"[c], d->high_m[c] - d->low_m[c], least);
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
            return fail(why, STATUS_BAD_INPUT, "%s: a particle of the material `%s` at %g K would have %g of its radius; expansion_1_k and "
                        "reference_temperature_k must leave it positive", sim->scene->path, sim->scene->material[bed->material[i]].name,
                        bed->temperature[i], factor);
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
    TRY_CL(clEnqueueFillBuffer(sim->device->queue, orientation->mem, upright, sizeof upright, 0, sizeof upright * (size_t)sim->stride, 0, NULL, NULL),
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

static uint64_t widest_field(const simulation *sim)
{
    uint64_t widest = 0;
    for (int f = 0; f < sim->field_count; f++) {
        uint64_t bytes = field_bytes(sim, sim->field[f].field);
        if (sim->field[f].field->extent == PER_PARTICLE && bytes > widest)
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
    cl_mem *const rest[] = {&sim->where, &sim->partial, &sim->control, &sim->faces, &sim->movers, &sim->constants, &sim->built_position, &sim->scratch4,
                            &sim->velocity_now, &sim->spin_now};
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

/* ---- walls and prescribed motion ---- */

/* Rows for the steps of a batch: walls where they are at the start of each step, prescribed motions over it. What stands still has one. */
static status fit_rows(simulation *sim, failure *why)
{
    int rows = sim->walls_move || sim->groups_move || sim->heat.vary ? (int)sim->batch_limit : 1;
    if (rows <= sim->batch_rows)
        return STATUS_OK;
    uint64_t faces = sizeof(clast_face) * (uint64_t)(sim->face_count * rows), movers = sizeof(clast_mover) * (uint64_t)(sim->mover_count * rows);
    free(sim->face_rows);
    free(sim->mover_rows);
    sim->face_rows = malloc(faces + 1);
    sim->mover_rows = malloc(movers + 1);
    if (!sim->face_rows || !sim->mover_rows)
        return fail(why, STATUS_ERROR, "out of memory");
    store_release(sim, &sim->faces, sim->face_bytes);
    store_release(sim, &sim->movers, sim->mover_bytes);
    sim->face_bytes = faces;
    sim->mover_bytes = movers;
    if (sim->face_count > 0)
        TRY(store_buffer(sim, &sim->faces, faces, "walls", why));
    if (sim->mover_count > 0)
        TRY(store_buffer(sim, &sim->movers, movers, "prescribed motions", why));
    sim->batch_rows = rows;
    return heat_fit_rows(sim, rows, why);
}

/* Time after so many more steps, to the same bits whatever the batches. */
static double time_after(const simulation *sim, int64_t steps)
{
    return sim->segment_time + (double)(sim->step + steps - sim->segment_step) * sim->dt;
}

/* In mixed precision by way of a copy: the host goes on reading its own rows. */
static status send_rows(simulation *sim, int rows, failure *why)
{
    uint64_t faces = sizeof(clast_face) * (uint64_t)(sim->face_count * rows), movers = sizeof(clast_mover) * (uint64_t)(sim->mover_count * rows);
    if (!sim->mixed) {
        TRY(store_write(sim, sim->faces, 0, faces, sim->face_rows, why));
        return store_write(sim, sim->movers, 0, movers, sim->mover_rows, why);
    }
    clast_face *face = malloc(faces + 1);
    clast_mover *mover = malloc(movers + 1);
    status result = face && mover ? STATUS_OK : fail(why, STATUS_ERROR, "out of memory");
    if (result == STATUS_OK) {
        memcpy(face, sim->face_rows, faces);
        memcpy(mover, sim->mover_rows, movers);
        precision_split_faces(face, sim->face_count * rows, sim->origin);
        precision_split_movers(mover, sim->mover_count * rows, sim->origin);
        result = store_write(sim, sim->faces, 0, faces, face, why);
    }
    if (result == STATUS_OK)
        result = store_write(sim, sim->movers, 0, movers, mover, why);
    free(face);
    free(mover);
    return result;
}

static status write_rows(simulation *sim, int rows, failure *why)
{
    for (int row = 0; row < rows; row++) {
        double time = time_after(sim, row);
        clast_face *face = sim->face_rows + row * sim->face_count;
        for (int w = 0; w < sim->scene->wall_count; w++) {
            body_pose pose = moving_body_pose(&sim->wall_body[w], time);
            servo_shift(sim, w, false, &pose);
            wall_faces(&sim->scene->wall[w], &pose, sim->scene->material_count + w, w, face);
            for (int f = 0; f < wall_face_count(&sim->scene->wall[w]); f++)
                face++->drive = servo_of_wall(sim, w);
        }
        for (int g = 0; g < sim->mover_count; g++)
            sim->mover_rows[row * sim->mover_count + g] = moving_body_step(&sim->group_body[g], time, sim->dt);
        heat_fill_row(sim, row, time);
    }
    TRY(send_rows(sim, rows, why));
    TRY(servo_begin(sim, why));
    return heat_write_rows(sim, rows, why);
}

status simulation_pose_now(simulation *sim, failure *why)
{
    TRY(fit_rows(sim, why));
    return write_rows(sim, 1, why);
}

body_pose simulation_wall_pose(const simulation *sim, int wall)
{
    body_pose pose = moving_body_pose(&sim->wall_body[wall], sim->time);
    servo_shift(sim, wall, true, &pose);
    return pose;
}

/* A cylinder, a cone or a disc is where its axis is: to turn about that moves nothing. False: not such a wall. */
static bool round_travel(const wall *wall, const body_pose *before, const body_pose *now, double *out)
{
    bool disc = wall->shape == WALL_DISC;
    if (!disc && wall->shape != WALL_CYLINDER && wall->shape != WALL_CONE)
        return false;
    double a[3], b[3], e[3], f[3], moved = 0.0, tilted = 0.0;
    pose_point(before, disc ? wall->center_m : wall->axis_point_m, a);
    pose_point(now, disc ? wall->center_m : wall->axis_point_m, b);
    pose_vector(before, disc ? wall->normal : wall->axis, e);
    pose_vector(now, disc ? wall->normal : wall->axis, f);
    for (int c = 0; c < 3; c++) {
        moved += (b[c] - a[c]) * (b[c] - a[c]);
        tilted += (f[c] - e[c]) * (f[c] - e[c]);
    }
    *out = sqrt(moved) + sqrt(tilted) * (disc ? wall->radius_m : wall->length_m + fmax(wall->radii_m[0], wall->radii_m[1]));
    return true;
}

/* How far a wall may have moved, against the common drift, since the table was built: an upper bound over what the bed can touch. */
static double wall_travel(const simulation *sim, double time)
{
    double most = 0.0, span = 0.0;
    for (int c = 0; c < 3; c++)
        span += pow(sim->bed_high[c] - sim->bed_low[c] + 4.0 * sim->radius_max, 2);
    for (int w = 0; w < sim->scene->wall_count; w++) {
        const moving_body *body = &sim->wall_body[w];
        body_pose before = moving_body_pose(body, sim->built_time), now = moving_body_pose(body, time);
        double centre[3], a[3], b[3], apart = 0.0, speed = 0.0, turn = 0.0, reach = 0.0;
        if (round_travel(&sim->scene->wall[w], &before, &now, &turn)) {
            most = fmax(most, turn); /* with walls the common drift is none */
            continue;
        }
        for (int c = 0; c < 3; c++)
            centre[c] = 0.5 * (sim->bed_low[c] + sim->bed_high[c]);
        pose_point(&before, centre, a);
        pose_point(&now, centre, b);
        for (int c = 0; c < 3; c++) {
            apart += pow(b[c] - a[c] - sim->drift_velocity[c] * (time - sim->built_time), 2);
            speed += pow(now.spin[c], 2);
            reach += pow(centre[c] - now.pivot[c], 2);
        }
        turn = sqrt(speed) * (time - sim->built_time) * (sqrt(span) + sqrt(reach));
        most = fmax(most, (speed > 0.0 ? 0.0 : sqrt(apart)) + turn);
    }
    return most;
}

/* Displacements count against the bed's mean velocity where no wall or prescribed grain holds it; against rest else. */
status simulation_choose_drift(simulation *sim, failure *why)
{
    memset(sim->drift_velocity, 0, sizeof sim->drift_velocity);
    if (sim->scene->wall_count > 0 || sim->mover_count > 0 || sim->count == 0)
        return STATUS_OK;
    particle_sums sums;
    TRY(observe_stored_sums(sim, &sums, why));
    for (int c = 0; c < 3; c++)
        sim->drift_velocity[c] = sums.mass > 0.0 ? sums.momentum[c] / sums.mass : 0.0;
    return STATUS_OK;
}

/* ---- stages ---- */

/* Grains that a group holds or moves, and the velocities that they have from now on. */
static void set_movers(const simulation *sim, int32_t *id, const double (*x)[3], double (*v)[3])
{
    for (int64_t i = 0; i < sim->stride; i++) {
        int group = i < sim->count ? sim->group_of_id[id[i]] : -1;
        id[i] = group >= 0 && sim->group_held[group] ? group : -1;
        if (id[i] < 0)
            continue;
        body_pose pose = moving_body_pose(&sim->group_body[group], sim->time);
        double arm[3];
        for (int c = 0; c < 3; c++)
            arm[c] = x[i][c] - pose.pivot[c];
        for (int c = 0; c < 3; c++)
            v[i][c] = pose.velocity[c] + pose.spin[(c + 1) % 3] * arm[(c + 2) % 3] - pose.spin[(c + 2) % 3] * arm[(c + 1) % 3];
    }
}

static status upload_movers(simulation *sim, failure *why)
{
    stored_field *mover = store_find(sim, "mover");
    if (!mover)
        return STATUS_OK;
    uint64_t n = (uint64_t)sim->stride;
    stored_field *position = store_find(sim, "position"), *velocity = store_find(sim, "velocity");
    int32_t *id = malloc(n * sizeof *id);
    double(*x)[3] = malloc(n * sizeof *x), (*v)[3] = malloc(n * sizeof *v);
    status result = id && x && v ? store_read(sim, store_find(sim, "id")->mem, 0, 4 * n, id, why) : fail(why, STATUS_ERROR, "out of memory");
    if (result == STATUS_OK)
        result = store_get_grains(sim, position, sim->stride, &x[0][0], why);
    if (result == STATUS_OK)
        result = store_get_grains(sim, velocity, sim->stride, &v[0][0], why);
    if (result == STATUS_OK) {
        set_movers(sim, id, (const double(*)[3])x, v);
        result = store_write(sim, mover->mem, 0, 4 * n, id, why);
    }
    if (result == STATUS_OK)
        result = store_put_grains(sim, velocity, sim->stride, &v[0][0], why);
    free(id);
    free(x);
    free(v);
    return result;
}

static void change_bodies(simulation *sim, const scene_stage *stage)
{
    for (int c = 0; c < stage->wall_change_count; c++)
        if (stage->wall_change[c].motion_given)
            moving_body_change(&sim->wall_body[stage->wall_change[c].wall], &stage->wall_change[c].motion, sim->time);
    for (int c = 0; c < stage->wall_group_change_count; c++)
        for (int w = 0; stage->wall_group_change[c].motion_given && w < sim->scene->wall_count; w++)
            if (sim->scene->wall[w].group == stage->wall_group_change[c].group)
                moving_body_change(&sim->wall_body[w], &stage->wall_group_change[c].motion, sim->time);
    servo_change(sim, stage, false);
    for (int c = 0; c < stage->group_change_count; c++) {
        const group_change *change = &stage->group_change[c];
        moving_body_change(&sim->group_body[change->group], &change->motion, sim->time);
        sim->group_held[change->group] = !change->free;
    }
}

static void note_movers(simulation *sim)
{
    sim->groups_move = false;
    sim->walls_move = servo_live(sim);
    for (int w = 0; w < sim->scene->wall_count; w++)
        sim->walls_move = sim->walls_move || moving_body_moves(&sim->wall_body[w]);
    for (int g = 0; g < sim->mover_count; g++)
        sim->groups_move = sim->groups_move || moving_body_moves(&sim->group_body[g]);
    sim->heat.vary = heat_varies(sim);
    sim->batch_rows = 0;
}

/* History of laws that the stage switches off is gone. */
static status forget_histories(simulation *sim, failure *why)
{
    for (int f = 0; f < sim->field_count; f++) {
        const field *field = sim->field[f].field;
        if (field->role == FIELD_HISTORY && !live_uses(&sim->live, field))
            TRY(store_fill(sim, sim->field[f].mem, sim->table.record_stride > 0 ? field_bytes(sim, field) : 0, why));
    }
    return STATUS_OK;
}

static status upload_constants(simulation *sim, int stage, failure *why)
{
    int64_t count = (int64_t)live_constant_count(&sim->live) * live_class_count(&sim->live, sim->scene);
    double *constants = malloc(sizeof *constants * (size_t)count);
    if (!constants)
        return fail(why, STATUS_ERROR, "out of memory");
    live_class_constants(&sim->live, sim->scene, stage, constants);
    status result = store_put(sim, sim->constants, FIELD_REAL, 0, count, constants, why);
    free(constants);
    return result;
}

status simulation_enter_stage(simulation *sim, int stage, failure *why)
{
    const live_laws before = sim->live;
    live_laws_in_stage(sim->scene, &sim->all, stage, &sim->live);
    bool same = sim->program && memcmp(before.law, sim->live.law, sizeof before.law) == 0 && before.frozen == sim->live.frozen;
    sim->stage = stage;
    scene_gravity(sim->scene, stage, sim->gravity);
    if (!sim->live.law[SLOT_BOND])
        TRY(bonds_before(sim, why)); /* they are forgotten */
    if (!same) {
        launch_close(sim);
        TRY(launch_open(sim, why));
        step_loop_forget(sim);
    }
    TRY(forget_histories(sim, why));
    TRY(servo_enter(sim, why));
    note_movers(sim);
    TRY(upload_constants(sim, stage, why));
    TRY(heat_upload_constants(sim, stage, why));
    frozen_forget(sim);
    TRY(simulation_pose_now(sim, why));
    return table_build(sim, false, why);
}

static status end_heat_steps(simulation *sim, failure *why);

/* Half-step velocities start anew where laws, gravity or motions change: from the velocities of this moment, under the laws that led to it. */
static status end_half_steps(simulation *sim, failure *why)
{
    if (sim->stage < 0 || !live_keeps_half_steps(&sim->live))
        return STATUS_OK;
    cl_mem velocity, spin;
    TRY(observe_velocities(sim, &velocity, &spin, why));
    TRY(store_copy(sim, velocity, store_find(sim, "velocity")->mem, 0, 0, field_bytes(sim, &field_velocity), why));
    return spin ? store_copy(sim, spin, store_find(sim, "spin")->mem, 0, 0, field_bytes(sim, &field_spin), why) : STATUS_OK;
}

static status begin_half_steps(simulation *sim, failure *why)
{
    sim->lag = 0.0;
    if (!live_keeps_half_steps(&sim->all))
        return STATUS_OK;
    stored_field *half_spin = store_find(sim, "half_spin");
    uint64_t bytes = field_bytes(sim, &field_velocity);
    TRY(store_copy(sim, store_find(sim, "velocity")->mem, store_find(sim, "half_velocity")->mem, 0, 0, bytes, why));
    return half_spin ? store_copy(sim, store_find(sim, "spin")->mem, half_spin->mem, 0, 0, bytes, why) : STATUS_OK;
}

status simulation_begin_stage(simulation *sim, int stage, failure *why)
{
    TRY(end_heat_steps(sim, why));
    sim->stage_steps = 0;
    frozen_restart(sim);
    TRY(end_half_steps(sim, why));
    change_bodies(sim, &sim->scene->stage[stage]);
    TRY(upload_movers(sim, why));
    TRY(begin_half_steps(sim, why));
    TRY(softening_refresh(sim, why));
    TRY(simulation_enter_stage(sim, stage, why));
    return beams_find_depths(sim, why);
}

/* ---- steps ---- */

void simulation_set_step(simulation *sim, double dt)
{
    sim->segment_time = sim->time;
    sim->segment_step = sim->step;
    sim->dt = sim->mixed ? (double)(float)dt : dt; /* time and motion agree on it */
}


status simulation_count_leavers(simulation *sim, int64_t kept, failure *why)
{
    if (kept == sim->count)
        return STATUS_OK;
    int64_t gone = sim->count - kept;
    int32_t *order = malloc(sizeof *order * (size_t)gone);
    double *mass = malloc(sizeof *mass * (size_t)sim->stride);
    status result = order && mass ? STATUS_OK : fail(why, STATUS_ERROR, "out of memory");
    if (result == STATUS_OK)
        result = store_read(sim, sim->table.work[2], 4 * (uint64_t)kept, 4 * (uint64_t)gone, order, why);
    if (result == STATUS_OK)
        result = store_get_grains(sim, store_find(sim, "mass"), sim->stride, mass, why);
    for (int64_t k = 0; k < gone && result == STATUS_OK; k++)
        sim->left_mass += mass[order[k]];
    if (result == STATUS_OK)
        result = ledger_leave(sim, order, gone, why);
    free(order);
    free(mass);
    sim->left_count += gone;
    sim->count = kept;
    return result;
}

/* The skin that balances the pairs it adds against the tables it saves, for grains that travel `used` a step (docs/performance.md): a step
 * costs about 1 + 2.7 s/r in a dense bed and less in a loose one, and with discs two thirds of that; a table about 10 steps, and in a small bed more,
 * since it is some fifty commands; and it lasts s/(2 used) steps. The factor leans to the side of few tables, since it is the fast and loose beds that
 * need many. */
static double best_skin(const simulation *sim, double used)
{
    double commands = 1400.0 / (double)(sim->count > 140 ? sim->count : 140), weight = 24.0 * (1.0 + commands) * (sim->scene->dimensions == 2 ? 1.5 : 1.0);
    double best = fmin(fmax(sqrt(weight * used * sim->mean_radius), 0.02 * sim->mean_radius), 1.4 * sim->mean_radius);
    const domain *d = &sim->scene->domain;
    for (int c = 0; d->given && c < 3; c++)
        if (d->periodic[c])
            best = fmin(best, 0.5 * (d->high_m[c] - d->low_m[c]) - 2.0 * sim->radius_max);
    return best;
}

static void adapt_skin(simulation *sim)
{
    contact_table *t = &sim->table;
    int64_t lasted = sim->step - sim->rebuild_step;
    if (t->skin_is_given || !t->built || lasted <= 0)
        return;
    double best = best_skin(sim, 0.5 * t->skin / (double)lasted);
    t->skin = fmin(fmax(best, t->skin / 1.5), t->skin * 1.5);
}

/* A table that lasts long has too many pairs: a smaller skin may do. Says so by *rebuild. */
static status look_at_skin(simulation *sim, bool *rebuild, failure *why)
{
    contact_table *t = &sim->table;
    int64_t lasted = sim->step - sim->rebuild_step;
    double travel;
    *rebuild = false;
    if (t->skin_is_given || lasted < t->skin_look)
        return STATUS_OK;
    t->skin_look *= 2;
    TRY(table_travel(sim, &travel, why));
    double best = best_skin(sim, travel / (double)lasted);
    if (best < 0.6 * t->skin) {
        t->skin = best;
        *rebuild = true;
    }
    return STATUS_OK;
}

/* What temperatures advance by in step s of the batch to come. The same bits whatever the batches: it depends on counts of steps, and where the
 * step has changed since the last time, on that time. */
static double heat_span(const simulation *sim, int s)
{
    if (!sim->live.law[SLOT_HEAT_STEPS])
        return sim->dt;
    int64_t every = sim->scene->stage[sim->stage].heat_every;
    if ((sim->stage_steps + s + 1) % every != 0)
        return 0.0;
    bool alike = sim->step + s + 1 - every >= sim->segment_step;
    return alike ? (double)every * sim->dt : time_after(sim, s + 1) - sim->heat.since;
}

static void note_heat_steps(simulation *sim, int done)
{
    for (int s = done - 1; s >= 0 && sim->live.law[SLOT_HEAT_STEPS]; s--)
        if (heat_span(sim, s) > 0.0) {
            sim->heat.since = time_after(sim, s + 1);
            return;
        }
}

/* At the end of a stage nothing may wait. */
static status end_heat_steps(simulation *sim, failure *why)
{
    cl_kernel kernel = launch_kernel(sim, "heat_flush");
    if (kernel && sim->time > sim->heat.since) {
        TRY(simulation_pose_now(sim, why));
        clast_launch launch = launch_values(sim);
        launch.heat_span = sim->time - sim->heat.since;
        TRY(launch_pass(kernel, "heat_flush", &launch, why));
        TRY(launch_bind(sim, "heat_flush", 1, why));
        TRY(launch_run(sim, kernel, "heat_flush", sim->count, sim->block, why));
    }
    sim->heat.since = sim->time;
    return STATUS_OK;
}

clast_launch launch_of_step(const simulation *sim, int s, int bond_step)
{
    clast_launch launch = launch_values(sim);
    launch.bonding = s == bond_step;
    double since = sim->time + (double)(s + 1) * sim->dt - sim->built_time;
    launch.step = s;
    launch.lag = s == 0 ? sim->lag : sim->dt;
    launch.kick = live_keeps_half_steps(&sim->live) ? 0.5 * (launch.lag + sim->dt) : sim->dt;
    launch.face_row = sim->walls_move ? s : 0;
    launch.mover_row = sim->groups_move ? s : 0;
    launch.heat_row = sim->heat.vary ? s : 0;
    launch.heat_span = heat_span(sim, s);
    for (int c = 0; c < 3; c++)
        launch.drift[c] = sim->drift_velocity[c] * since;
    return launch;
}

static status enqueue_batch(simulation *sim, int steps, failure *why)
{
    int bond_step = bonds_step(sim, steps);
    if (step_loop_now(sim))
        return step_loop_enqueue(sim, steps, why);
    for (int s = 0; s < steps; s++) {
        clast_launch launch = launch_of_step(sim, s, bond_step);
        TRY(heat_sum_areas(sim, &launch, why));
        TRY(step_plan_enqueue(sim, sim->device->queue, launch, NULL, why));
        TRY(servo_step(sim, &launch, steps, why));
    }
    return STATUS_OK;
}

/* Steps before a wall has used up its half of the skin. */
static int steps_before_walls(const simulation *sim, int steps)
{
    if (!sim->walls_move)
        return steps;
    for (int s = 0; s < steps; s++)
        if (wall_travel(sim, sim->time + (double)s * sim->dt) > servo_share(sim) * sim->table.skin)
            return s;
    return steps;
}

/* One batch; *done of the steps asked for were taken, and *rebuild tells that a table is due before the next. */
static status run_batch(simulation *sim, int steps, int *done, bool *rebuild, failure *why)
{
    clast_control control = {steps, 0, {0, 0}};
    int bonding = bonds_step(sim, steps);
    TRY(beams_before_batch(sim, why));
    if (sim->walls_move || sim->groups_move || sim->heat.vary)
        TRY(write_rows(sim, steps, why));
    double start = seconds();
    TRY(store_write(sim, sim->control, 0, sizeof control, &control, why));
    TRY(enqueue_batch(sim, steps, why));
    TRY(store_read(sim, sim->control, 0, sizeof control, &control, why));
    TRY(servo_end(sim, why));
    *done = control.halt_step < steps ? control.halt_step : steps;
    step_loop_note(sim, *done, seconds() - start);
    sim->bonding_done = sim->bonding_done || (bonding >= 0 && bonding < *done);
    *rebuild = control.reason != 0;
    for (int s = 0; s < *done; s++)
        beams_deliver(sim, time_after(sim, s), sim->dt);
    return STATUS_OK;
}

status simulation_advance(simulation *sim, int64_t steps, failure *why)
{
    double start = seconds(), rebuilding = sim->rebuild_seconds;
    while (steps > 0) {
        int64_t most = beams_steps_allowed(sim, sim->batch_limit < steps ? sim->batch_limit : steps);
        int allowed = steps_before_walls(sim, (int)most), done = 0;
        bool rebuild = allowed == 0;
        if (allowed == 0 && sim->step == sim->rebuild_step && sim->table.built)
            allowed = 1; /* a wall that outruns the skin in one step: a table a step */
        if (allowed > 0)
            TRY(run_batch(sim, allowed, &done, &rebuild, why));
        note_heat_steps(sim, done);
        sim->step += done;
        sim->stage_steps += done;
        sim->lag = done > 0 ? sim->dt : sim->lag;
        sim->time = time_after(sim, 0);
        steps -= done;
        if (rebuild)
            adapt_skin(sim);
        else
            TRY(look_at_skin(sim, &rebuild, why));
        if (rebuild) {
            int64_t lasted = sim->step - sim->rebuild_step;
            double before = sim->rebuild_seconds;
            TRY(simulation_pose_now(sim, why));
            TRY(table_build(sim, false, why));
            step_loop_note_table(sim, lasted, sim->rebuild_seconds - before);
        }
    }
    sim->step_seconds += seconds() - start - (sim->rebuild_seconds - rebuilding);
    return STATUS_OK;
}
