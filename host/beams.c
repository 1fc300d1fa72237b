/* Beams that heat: their rows in time, and how deep grains lie below the bed's surface as the beams see it. */
#include "laws/laws.h"
#include "precision.h"
#include "simulation.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define QUANTUM 1e-6            /* of heights, in mean diameters */
#define COLUMNS_MAX 100000000.0 /* what a surface may take on the device: 0.4 GB */

/* ---- the scene's beams ---- */

int scene_beam_count(const scene *s)
{
    int count = 0;
    for (int e = 0; e < s->effect_count; e++)
        count += s->effect[e].law->slot == SLOT_SOURCE;
    return count;
}

const effect *scene_beam(const scene *s, int index)
{
    for (int e = 0; e < s->effect_count; e++)
        if (s->effect[e].law->slot == SLOT_SOURCE && index-- == 0)
            return &s->effect[e];
    return NULL;
}

/* Beams of one direction look at the bed from one side. */
static bool same_direction(const effect *a, const effect *b)
{
    double along = 0.0;
    for (int c = 0; c < 3; c++)
        along += a->beam.direction[c] * b->beam.direction[c];
    return along > 1.0 - 1e-12;
}

int scene_beam_side(const scene *s, int index)
{
    const effect *beam = scene_beam(s, index);
    int side = 0;
    for (int b = 0; b < index; b++) {
        const effect *earlier = scene_beam(s, b);
        if (same_direction(earlier, beam))
            return scene_beam_side(s, b);
        side = fmax(side, scene_beam_side(s, b) + 1);
    }
    return side;
}

int scene_beam_sides(const scene *s)
{
    int sides = 0;
    for (int b = 0; b < scene_beam_count(s); b++) {
        int side = scene_beam_side(s, b);
        sides = side + 1 > sides ? side + 1 : sides;
    }
    return sides;
}

/* ---- in time ---- */

double beam_power(const effect *beam, double time)
{
    return quantity_at(&beam->beam.power, time);
}

bool beams_vary(const simulation *sim)
{
    for (int b = 0; sim->live.law[SLOT_SOURCE] && b < sim->beams.count; b++)
        if (scene_beam(sim->scene, b)->beam.power.count > 1)
            return true;
    return false;
}

static clast_beam beam_row(const scene *s, int index, double time)
{
    const effect *e = scene_beam(s, index);
    double radius = 0.5 * e->option[SOURCE_DIAMETER], area = M_PI * radius * radius;
    bool gaussian = e->option[SOURCE_PROFILE] == CLAST_BEAM_GAUSSIAN, laser = e->law == &law_laser;
    clast_beam row = {.intensity = (gaussian ? 2.0 : 1.0) * beam_power(e, time) / area,
                      .radius = radius,
                      .reach = laser ? e->option[SOURCE_REACH] : 1.0 / e->option[SOURCE_REACH],
                      .law = laser ? 0 : 1,
                      .profile = gaussian ? CLAST_BEAM_GAUSSIAN : CLAST_BEAM_TOP_HAT,
                      .side = scene_beam_side(s, index)};
    for (int c = 0; c < 3; c++) {
        row.position[c] = quantity_component(&e->beam.position, time, c);
        row.direction[c] = e->beam.direction[c];
    }
    return row;
}

void beams_fill_row(simulation *sim, int row, double time)
{
    beam_tables *t = &sim->beams;
    for (int b = 0; t->rows && b < t->count; b++)
        t->rows[row * t->count + b] = beam_row(sim->scene, b, time);
}

status beams_fit_rows(simulation *sim, int rows, failure *why)
{
    beam_tables *t = &sim->beams;
    if (t->count == 0)
        return STATUS_OK;
    store_release(sim, &t->device_rows, sizeof *t->rows * (uint64_t)(t->count * t->row_count));
    free(t->rows);
    t->row_count = rows;
    t->rows = calloc((size_t)(t->count * rows), sizeof *t->rows);
    if (!t->rows)
        return fail(why, STATUS_ERROR, "out of memory");
    return store_buffer(sim, &t->device_rows, sizeof *t->rows * (uint64_t)(t->count * rows), "beams", why);
}

status beams_write_rows(simulation *sim, int rows, failure *why)
{
    beam_tables *t = &sim->beams;
    if (t->rows && sim->mixed)
        precision_split_beams(t->rows, (int64_t)t->count * rows, sim->origin); /* in place: rows are filled anew for every batch */
    return t->rows ? store_write(sim, t->device_rows, 0, sizeof *t->rows * (uint64_t)(t->count * rows), t->rows, why) : STATUS_OK;
}

void beams_deliver(simulation *sim, double time, double dt)
{
    for (int b = 0; sim->live.law[SLOT_SOURCE] && b < sim->beams.count; b++)
        sim->beams.delivered += beam_power(scene_beam(sim->scene, b), time) * dt;
}

/* ---- depth ---- */

/* The smallest of the sources' intervals. */
static int64_t surface_interval(const scene *s)
{
    double least = 1e15;
    for (int b = 0; b < scene_beam_count(s); b++)
        least = fmin(least, scene_beam(s, b)->option[SOURCE_INTERVAL]);
    return (int64_t)least;
}

static void orthonormal(const double n[3], double a[3], double b[3])
{
    int least = 0;
    for (int c = 1; c < 3; c++)
        least = fabs(n[c]) < fabs(n[least]) - 1e-9 ? c : least;
    double length = 0.0;
    for (int c = 0; c < 3; c++) {
        a[c] = (c == least ? 1.0 : 0.0) - n[least] * n[c];
        length += a[c] * a[c];
    }
    for (int c = 0; c < 3; c++)
        a[c] /= sqrt(length);
    for (int c = 0; c < 3; c++)
        b[c] = n[(c + 1) % 3] * a[(c + 2) % 3] - n[(c + 2) % 3] * a[(c + 1) % 3];
}

status beams_create(simulation *sim, failure *why)
{
    beam_tables *t = &sim->beams;
    if (!sim->all.law[SLOT_SOURCE])
        return STATUS_OK;
    t->count = scene_beam_count(sim->scene);
    t->sides = scene_beam_sides(sim->scene);
    t->interval = surface_interval(sim->scene);
    for (int b = 0; b < t->count; b++) {
        const effect *e = scene_beam(sim->scene, b);
        clast_columns *c = &t->columns[scene_beam_side(sim->scene, b)];
        memcpy(c->direction, e->beam.direction, sizeof c->direction);
        orthonormal(c->direction, c->across, c->beside);
        for (int k = 0; k < 3; k++)
            c->origin[k] = 0.5 * (sim->bed_low[k] + sim->bed_high[k]);
        c->inverse_width = 0.5 / sim->mean_radius;
        c->inverse_quantum = 0.5 / (sim->mean_radius * QUANTUM);
    }
    TRY(store_buffer(sim, &t->device_columns, sizeof t->columns, "columns of the surface", why));
    TRY(store_buffer(sim, &t->bounds, 4 * sizeof(cl_int) * CLAST_BEAM_SIDES_MAX, "columns of the surface", why));
    TRY(store_buffer(sim, &t->meets, sizeof(cl_int) * (uint64_t)t->count, "beams that meet the bed", why));
    return store_clear_ints(sim, t->meets, 0, t->count, why);
}

void beams_free(simulation *sim)
{
    beam_tables *t = &sim->beams;
    store_release(sim, &t->device_rows, sizeof *t->rows * (uint64_t)(t->count * t->row_count));
    store_release(sim, &t->device_columns, 0);
    store_release(sim, &t->bounds, 0);
    store_release(sim, &t->meets, 0);
    store_release(sim, &t->surface, 4 * (uint64_t)t->surface_held);
    free(t->rows);
}

/* One of the kernels that take launch, columns and further arrays, over all grains. */
static status run_grains(simulation *sim, const char *name, int own, failure *why)
{
    TRY(launch_bind(sim, name, own, why));
    return launch_run(sim, launch_kernel(sim, name), name, sim->count, sim->block, why);
}

static status write_columns(simulation *sim, failure *why)
{
    clast_columns columns[CLAST_BEAM_SIDES_MAX];
    memcpy(columns, sim->beams.columns, sizeof columns);
    if (sim->mixed)
        precision_split_columns(columns, CLAST_BEAM_SIDES_MAX, sim->origin);
    return store_write(sim, sim->beams.device_columns, 0, sizeof columns, columns, why);
}

static status find_columns(simulation *sim, failure *why)
{
    beam_tables *t = &sim->beams;
    cl_int bounds[4 * CLAST_BEAM_SIDES_MAX];
    clast_launch launch = launch_values(sim);
    double total = 0.0;
    for (int s = 0; s < CLAST_BEAM_SIDES_MAX; s++) {
        bounds[4 * s] = bounds[4 * s + 2] = INT_MAX;
        bounds[4 * s + 1] = bounds[4 * s + 3] = INT_MIN;
    }
    TRY(write_columns(sim, why));
    TRY(store_write(sim, t->bounds, 0, sizeof bounds, bounds, why));
    TRY(launch_set(launch_kernel(sim, "beam_bounds"), "beam_bounds", why, "Lmm", &launch, t->device_columns, t->bounds));
    TRY(run_grains(sim, "beam_bounds", 3, why));
    TRY(store_read(sim, t->bounds, 0, sizeof bounds, bounds, why));
    for (int s = 0; s < t->sides; s++) {
        clast_columns *c = &t->columns[s];
        const cl_int *b = bounds + 4 * s;
        double wide = (double)b[1] - b[0] + 1.0, deep = (double)b[3] - b[2] + 1.0;
        if (total + wide * deep > COLUMNS_MAX)
            return fail(why, STATUS_GUARD, "the bed is spread over more than %.0e columns a mean diameter wide, too many to find its surface for the sources; "
                        "confine it by walls, or let a domain delete what leaves", COLUMNS_MAX);
        c->first_u = b[0];
        c->first_v = b[2];
        c->count_u = (cl_int)wide;
        c->count_v = (cl_int)deep;
        c->first = (cl_int)total;
        total += wide * deep;
    }
    if ((int64_t)total > t->surface_held) {
        store_release(sim, &t->surface, 4 * (uint64_t)t->surface_held);
        t->surface_held = (int64_t)(1.2 * total) + 64;
        TRY(store_buffer(sim, &t->surface, 4 * (uint64_t)t->surface_held, "the bed's surface", why));
    }
    return write_columns(sim, why);
}

status beams_find_depths(simulation *sim, failure *why)
{
    beam_tables *t = &sim->beams;
    if (!sim->live.law[SLOT_SOURCE] || sim->count == 0)
        return STATUS_OK;
    const cl_int lowest = INT_MIN;
    clast_launch launch = launch_values(sim);
    TRY(simulation_pose_now(sim, why));
    TRY(find_columns(sim, why));
    TRY_CL(clEnqueueFillBuffer(sim->device->queue, t->surface, &lowest, sizeof lowest, 0, 4 * (size_t)t->surface_held, 0, NULL, NULL), "clearing a buffer");
    TRY(launch_set(launch_kernel(sim, "beam_surface"), "beam_surface", why, "Lmm", &launch, t->device_columns, t->surface));
    TRY(run_grains(sim, "beam_surface", 3, why));
    TRY(launch_set(launch_kernel(sim, "beam_depth"), "beam_depth", why, "Lmmm", &launch, t->device_columns, t->surface, store_find(sim, "depth")->mem));
    return run_grains(sim, "beam_depth", 4, why);
}

int64_t beams_steps_allowed(const simulation *sim, int64_t steps)
{
    if (!sim->live.law[SLOT_SOURCE])
        return steps;
    int64_t left = sim->beams.interval - sim->step % sim->beams.interval;
    return left < steps ? left : steps;
}

status beams_before_batch(simulation *sim, failure *why)
{
    if (!sim->live.law[SLOT_SOURCE] || sim->step % sim->beams.interval != 0)
        return STATUS_OK;
    return beams_find_depths(sim, why);
}

status beams_met(simulation *sim, bool *met, failure *why)
{
    cl_int *meets = calloc((size_t)sim->beams.count + 1, sizeof *meets);
    if (!meets)
        return fail(why, STATUS_ERROR, "out of memory");
    status result = store_read(sim, sim->beams.meets, 0, 4 * (uint64_t)sim->beams.count, meets, why);
    for (int b = 0; b < sim->beams.count; b++)
        met[b] = meets[b] != 0;
    free(meets);
    return result;
}
