/* Looks for what must not go on: numbers lost, overlaps and moves too large, grains outside, a step past its limit for long. */
#include "simulation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHUNK 256
#define FINDINGS 4
#define RECORD_FINDINGS 2

static status id_at(simulation *sim, double index, int32_t *id, failure *why)
{
    return store_read(sim, store_find(sim, "id")->mem, 4 * (uint64_t)index, sizeof *id, id, why);
}

static void stop(simulation *sim, guard_finding *out, int32_t id, const char *what, const char *remedy)
{
    out->stop = true;
    snprintf(out->text, sizeof out->text, "%s: stopped by a guard at t = %.9g s (step %lld), grain %d: %s; %s", sim->scene->path, sim->time,
             (long long)sim->step, id, what, remedy);
}

/* Chunks of grains, of pairs, and of pairs and walls' records, where contacts are looked at. */
typedef struct chunks {
    int64_t grains, pairs, records;
} chunks;

static int64_t chunks_of(int64_t count)
{
    return (count + CHUNK - 1) / CHUNK;
}

static chunks count_chunks(const simulation *sim)
{
    const contact_table *t = &sim->table;
    chunks c = {chunks_of(sim->count), chunks_of(t->pair_count), chunks_of(t->pair_count) + chunks_of(t->wall_record_count)};
    c.records = sim->live.law[SLOT_NORMAL] ? c.records : 0;
    return c;
}

/* What the device finds in grains, and behind it in records: both at once, since to wait costs more than to look. */
static status look(simulation *sim, double **found, failure *why)
{
    chunks c = count_chunks(sim);
    int64_t numbers = c.grains * FINDINGS + c.records * RECORD_FINDINGS;
    clast_launch launch = launch_values(sim);
    cl_kernel grains = launch_kernel(sim, "guard_particles"), records = launch_kernel(sim, "guard_records");
    memcpy(launch.drift, sim->drift_velocity, sizeof launch.drift); /* moves count as they do towards a new table */
    TRY(observe_partial(sim, numbers, why));
    TRY(launch_set(grains, "guard_particles", why, "Lmmmi", &launch, store_find(sim, "position")->mem, store_find(sim, "velocity")->mem, sim->partial,
                   (cl_int)sim->scene->domain.given));
    TRY(launch_run(sim, grains, "guard_particles", c.grains, 1, why));
    if (sim->face_count > 0 && sim->live.law[SLOT_NORMAL])
        TRY(simulation_pose_now(sim, why));
    if (c.records > 0) {
        launch = launch_values(sim);
        TRY(launch_set(records, "guard_records", why, "Lmiiii", &launch, sim->partial, (cl_int)(c.grains * FINDINGS), (cl_int)sim->table.pair_count,
                       (cl_int)c.pairs, (cl_int)sim->table.wall_record_count));
        TRY(launch_bind(sim, "guard_records", 6, why));
        TRY(launch_run(sim, records, "guard_records", c.records, 1, why));
    }
    *found = malloc(sizeof **found * (size_t)(numbers + 1));
    if (!*found)
        return fail(why, STATUS_ERROR, "out of memory");
    return store_get(sim, sim->partial, FIELD_EXACT, 0, numbers, *found, why);
}

/* *rebuilt: grains that have left were deleted, so that records are others. */
static status check_grains(simulation *sim, const double *found, bool *rebuilt, guard_finding *out, failure *why)
{
    double bad = -1, left = -1, fastest = -1, speed2 = 0.0;
    char what[256];
    int32_t id;
    for (int64_t c = 0; c < count_chunks(sim).grains; c++) {
        const double *f = found + c * FINDINGS;
        bad = bad < 0.0 ? f[0] : bad;
        left = left < 0.0 ? f[2] : left;
        if (f[3] > speed2) {
            speed2 = f[3];
            fastest = f[1];
        }
    }
    *rebuilt = false;
    if (bad >= 0.0) {
        TRY(id_at(sim, bad, &id, why));
        stop(sim, out, id, "position or velocity is not a number", "try a smaller step, and look at the last frames before");
    } else if (left >= 0.0 && sim->scene->domain.delete_leaving) {
        TRY(simulation_pose_now(sim, why));
        TRY(table_build(sim, true, why));
        *rebuilt = true;
    } else if (left >= 0.0) {
        TRY(id_at(sim, left, &id, why));
        stop(sim, out, id, "it has left the domain", "enlarge the domain, close the walls, or let leavers be deleted (domain: {leaving: delete})");
    } else if (sqrt(speed2) * sim->dt > sim->scene->guards.move_max * fmax(sim->table.skin, 0.1 * sim->mean_radius) && sim->count > 1) {
        TRY(id_at(sim, fastest, &id, why));
        snprintf(what, sizeof what, "it moves %.3g m in a step, more than move_max %g times the skin of %.3g m", sqrt(speed2) * sim->dt,
                 sim->scene->guards.move_max, sim->table.skin);
        stop(sim, out, id, what, "try a smaller step or a larger contact_table.skin_m");
    }
    return STATUS_OK;
}

#define ACTS_THROUGH "the wall `%s` is less than a grain's radius away from the domain's periodic face along %c, and does not go on behind it: a grain there would " \
                     "not feel it"

/* Walls move: they are looked at again while a stage runs. */
static void check_periodic_walls(simulation *sim, guard_finding *out)
{
    int wall;
    char axis;
    if (!guard_periodic_wall(sim, &wall, &axis))
        return;
    out->stop = true;
    snprintf(out->text, sizeof out->text, "%s: stopped by a guard at t = %.9g s (step %lld): " ACTS_THROUGH "; let it move less far, or enlarge the domain",
             sim->scene->path, sim->time, (long long)sim->step, sim->scene->wall[wall].name, axis);
}

static status name_overlap(simulation *sim, int64_t record, double most, guard_finding *out, failure *why)
{
    contact_table *t = &sim->table;
    int32_t owner, other, id;
    char what[256];
    TRY(store_read(sim, t->owner[t->now], 4 * (uint64_t)record, sizeof owner, &owner, why));
    TRY(store_read(sim, t->other[t->now], 4 * (uint64_t)record, sizeof other, &other, why));
    TRY(id_at(sim, owner, &id, why));
    if (record < t->wall_base) {
        snprintf(what, sizeof what, "overlap of %.3g of its radius, overlap_max is %g", most, sim->scene->guards.overlap_max);
        stop(sim, out, id, what, "try a smaller step, a stiffer material, or grains that do not overlap at the start");
    } else {
        snprintf(what, sizeof what, "it is %.3g of its radius deep in the wall `%s`, overlap_max is %g", most,
                 sim->scene->wall[sim->face_rows[other].wall].name, sim->scene->guards.overlap_max);
        stop(sim, out, id, what, "try a smaller step, a stiffer material, or a wall that presses less");
    }
    return STATUS_OK;
}

static status check_overlaps(simulation *sim, const double *found, guard_finding *out, failure *why)
{
    double most = 0.0, where = -1.0;
    if (sim->face_count > 0 && sim->live.law[SLOT_NORMAL])
        check_periodic_walls(sim, out);
    if (out->stop)
        return STATUS_OK;
    chunks c = count_chunks(sim);
    const double *of_records = found + c.grains * FINDINGS;
    for (int64_t k = 0; k < c.records; k++)
        if (of_records[RECORD_FINDINGS * k] > most) {
            most = of_records[RECORD_FINDINGS * k];
            where = of_records[RECORD_FINDINGS * k + 1];
        }
    return most > sim->scene->guards.overlap_max ? name_overlap(sim, (int64_t)where, most, out, why) : STATUS_OK;
}

static status check_temperatures(simulation *sim, guard_finding *out, failure *why)
{
    heat_sums heat;
    double *temperature = NULL;
    if (!sim->live.law[SLOT_TEMPERATURE] || sim->count < sim->id_count) /* rows of grains that have left are no numbers either */
        return STATUS_OK;
    TRY(heat_observe(sim, &heat, why));
    if (isfinite(heat.mean))
        return STATUS_OK;
    TRY(observe_field(sim, "temperature", &temperature, why));
    int32_t id = 0;
    while (id < sim->id_count - 1 && isfinite(temperature[id]))
        id++;
    free(temperature);
    stop(sim, out, id, "temperature is not a number", "try a smaller step, and look at the properties that heat it");
    return STATUS_OK;
}

status guard_check(simulation *sim, guard_finding *out, failure *why)
{
    double *found = NULL;
    bool rebuilt = false;
    out->stop = false;
    servo_guard(sim, out);
    if (out->stop)
        return STATUS_OK;
    status result = look(sim, &found, why);
    if (result == STATUS_OK)
        result = check_grains(sim, found, &rebuilt, out, why);
    if (result == STATUS_OK && rebuilt) {
        free(found);
        found = NULL;
        result = look(sim, &found, why);
    }
    if (result == STATUS_OK && !out->stop)
        result = check_temperatures(sim, out, why);
    if (result == STATUS_OK && !out->stop)
        result = check_overlaps(sim, found, out, why);
    free(found);
    return result;
}

/* The free grain that is deepest in a wall, in shares of its radius. */
static double deepest(const simulation *sim, const live_contact *contact, int64_t count, const double *radius, const live_contact **which)
{
    double most = 0.0;
    for (int64_t k = 0; k < count; k++) {
        int32_t id = contact[k].i;
        double share = contact[k].overlap / radius[id];
        if (share > most && !sim->group_held[sim->group_of_id[id]]) {
            most = share;
            *which = &contact[k];
        }
    }
    return most;
}

static status refuse_periodic_wall(simulation *sim, failure *why)
{
    int wall;
    char axis;
    if (sim->face_count == 0)
        return STATUS_OK;
    TRY(simulation_pose_now(sim, why));
    if (!guard_periodic_wall(sim, &wall, &axis))
        return STATUS_OK;
    return fail(why, STATUS_BAD_INPUT, "%s: stage %s: " ACTS_THROUGH "; move it inside, let it span the domain along %c, or enlarge the domain",
                sim->scene->path, sim->scene->stage[sim->stage].name, sim->scene->wall[wall].name, axis, axis);
}

status guard_walls(simulation *sim, failure *why)
{
    const scene *s = sim->scene;
    if (sim->live.law[SLOT_NORMAL] && !sim->live.frozen)
        TRY(refuse_periodic_wall(sim, why));
    live_contact *contact = NULL;
    const live_contact *which = NULL;
    double *radius = NULL;
    int64_t count;
    if (s->guards.every_steps == 0 || sim->table.wall_record_count == 0 || !sim->live.law[SLOT_NORMAL] || sim->live.frozen)
        return STATUS_OK;
    TRY(observe_contacts(sim, true, &contact, &count, why));
    status result = observe_field(sim, "radius", &radius, why);
    double most = result == STATUS_OK ? deepest(sim, contact, count, radius, &which) : 0.0;
    if (most > s->guards.overlap_max)
        result = fail(why, STATUS_BAD_INPUT,
                      "%s: stage %s: grain %d begins %.3g of its radius deep in the wall `%s`, guards.overlap_max is %g; move it away, or raise "
                      "guards.overlap_max and list {slot: body, law: viscous_damping}, so that it is pushed out gently",
                      s->path, s->stage[sim->stage].name, which->i, most, s->wall[which->wall].name, s->guards.overlap_max);
    free(contact);
    free(radius);
    return result;
}
