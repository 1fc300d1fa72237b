/* Sums, contacts and fields, read from the device when they are due. */
#include "laws/laws.h"
#include "simulation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CHUNK 256
#define PARTICLE_SUMS 12

status observe_partial(simulation *sim, int64_t doubles, failure *why)
{
    if (doubles <= sim->partial_capacity)
        return STATUS_OK;
    store_release(sim, &sim->partial, 8 * (uint64_t)sim->partial_capacity);
    sim->partial_capacity = doubles;
    return store_buffer(sim, &sim->partial, 8 * (uint64_t)doubles, "sums", why);
}

status observe_where(simulation *sim, failure *why)
{
    if (!sim->particles_stale)
        return STATUS_OK;
    const cl_int none = -1;
    clast_launch launch = launch_values(sim);
    cl_kernel kernel = launch_kernel(sim, "table_where");
    TRY_CL(clEnqueueFillBuffer(sim->device->queue, sim->where, &none, sizeof none, 0, 4 * (size_t)sim->id_count, 0, NULL, NULL), "indices of ids");
    TRY(launch_set(kernel, "table_where", why, "Lmm", &launch, store_find(sim, "id")->mem, sim->where));
    TRY(launch_run(sim, kernel, "table_where", sim->count, sim->block, why));
    sim->particles_stale = false;
    return STATUS_OK;
}

static status read_partial(simulation *sim, int64_t doubles, double **out, failure *why)
{
    *out = malloc(sizeof **out * (size_t)(doubles + 1));
    if (!*out)
        return fail(why, STATUS_ERROR, "out of memory");
    return store_get(sim, sim->partial, FIELD_EXACT, 0, doubles, *out, why);
}

/* Potential energy and angular momentum about the scene's origin, from those about the device's. */
static void move_sums(const simulation *sim, double *sum)
{
    const double *o = sim->origin, *p = sum + 4;
    for (int c = 0; c < 3 && sim->mixed; c++) {
        sum[2] -= sum[3] * sim->gravity[c] * o[c];
        sum[7 + c] += o[(c + 1) % 3] * p[(c + 2) % 3] - o[(c + 2) % 3] * p[(c + 1) % 3];
    }
}

/* Velocities, spins and the ledger at the time of the positions; contacts' histories, too, where a stage ends. */
static status synchronise(simulation *sim, bool ends, failure *why)
{
    const char *on_records = ends ? "pair_catch_up" : "pair_probe";
    clast_launch launch = launch_values(sim);
    cl_kernel records = launch_kernel(sim, on_records), now = launch_kernel(sim, "particle_synchronise");
    launch.kick = 0.5 * sim->lag;
    TRY(simulation_pose_now(sim, why));
    TRY(launch_set(records, on_records, why, "L", &launch));
    TRY(launch_run(sim, records, on_records, sim->table.record_count, sim->block, why));
    TRY(launch_set(now, "particle_synchronise", why, "Lmmmi", &launch, sim->velocity_now, sim->spin_now, sim->ledger_now, (cl_int)ends));
    return launch_run(sim, now, "particle_synchronise", sim->count, sim->block, why);
}

status observe_velocities(simulation *sim, cl_mem *velocity, cl_mem *spin, failure *why)
{
    stored_field *turning = sim->live.law[SLOT_ROTATION] ? store_find(sim, "spin") : NULL;
    *velocity = store_find(sim, "velocity")->mem;
    *spin = turning ? turning->mem : NULL;
    if (!live_keeps_half_steps(&sim->live))
        return STATUS_OK;
    TRY(synchronise(sim, false, why));
    *velocity = sim->velocity_now;
    *spin = turning ? sim->spin_now : NULL;
    return STATUS_OK;
}

status observe_end_half_steps(simulation *sim, failure *why)
{
    stored_field *spin = sim->live.law[SLOT_ROTATION] ? store_find(sim, "spin") : NULL, *growth = store_find(sim, "growth");
    TRY(synchronise(sim, true, why));
    TRY(store_copy(sim, sim->velocity_now, store_find(sim, "velocity")->mem, 0, 0, field_bytes(sim, &field_velocity), why));
    if (spin)
        TRY(store_copy(sim, sim->spin_now, spin->mem, 0, 0, field_bytes(sim, spin->field), why));
    /* the work of the last growth stands in the ledger now */
    return growth ? store_fill(sim, growth->mem, field_bytes(sim, growth->field), why) : STATUS_OK;
}

static status sum_particles(simulation *sim, cl_mem velocity, cl_mem spin, particle_sums *out, failure *why)
{
    int64_t chunks = (sim->id_count + CHUNK - 1) / CHUNK;
    clast_launch launch = launch_values(sim);
    cl_kernel kernel = launch_kernel(sim, "observe_particles");
    double *partial = NULL, sum[PARTICLE_SUMS] = {0};
    memset(out, 0, sizeof *out);
    TRY(observe_where(sim, why));
    TRY(observe_partial(sim, chunks * PARTICLE_SUMS, why));
    TRY(launch_set(kernel, "observe_particles", why, spin ? "Lmmmmmmim" : "Lmmmmmmi", &launch, sim->where, store_find(sim, "position")->mem,
                   velocity, store_find(sim, "radius")->mem, store_find(sim, "mass")->mem, sim->partial, (cl_int)sim->id_count, spin));
    TRY(launch_run(sim, kernel, "observe_particles", chunks, 1, why));
    status result = read_partial(sim, chunks * PARTICLE_SUMS, &partial, why);
    for (int64_t c = 0; c < chunks && result == STATUS_OK; c++)
        for (int q = 0; q < PARTICLE_SUMS; q++)
            sum[q] = q == 10 ? fmax(sum[q], partial[c * PARTICLE_SUMS + q]) : sum[q] + partial[c * PARTICLE_SUMS + q];
    free(partial);
    TRY(result);
    move_sums(sim, sum);
    *out = (particle_sums){sum[0], sum[1], sum[2], sum[3], {sum[4], sum[5], sum[6]}, {sum[7], sum[8], sum[9]}, sqrt(sum[10]), sum[11]};
    return STATUS_OK;
}

status observe_particle_sums(simulation *sim, particle_sums *out, failure *why)
{
    cl_mem velocity, spin;
    TRY(observe_velocities(sim, &velocity, &spin, why));
    return sum_particles(sim, velocity, spin, out, why);
}

status observe_stored_sums(simulation *sim, particle_sums *out, failure *why)
{
    stored_field *spin = sim->live.law[SLOT_ROTATION] ? store_find(sim, "spin") : NULL;
    return sum_particles(sim, store_find(sim, "velocity")->mem, spin ? spin->mem : NULL, out, why);
}

/* End of the records that stand for contacts; those that fill up the last work-group behind it repeat grain 0 and face 0. */
static int64_t records_end(const simulation *sim)
{
    return sim->table.wall_base + sim->table.wall_record_count;
}

/* One component of a record array, on the host. */
static status read_component(simulation *sim, cl_mem mem, int component, double **out, failure *why)
{
    int64_t records = sim->table.record_count;
    *out = malloc(sizeof **out * (size_t)(records + 1));
    if (!*out)
        return fail(why, STATUS_ERROR, "out of memory");
    return store_get(sim, mem, FIELD_REAL, component * sim->table.record_stride, records, *out, why);
}

static status run_over(simulation *sim, const char *name, double dt, failure *why)
{
    clast_launch launch = launch_values(sim);
    cl_kernel kernel = launch_kernel(sim, name);
    TRY(simulation_pose_now(sim, why));
    launch.dt = dt;
    launch.step = -1; /* before any at which a batch has halted */
    TRY(heat_sum_areas(sim, &launch, why));
    TRY(launch_pass(kernel, name, &launch, why));
    return launch_run(sim, kernel, name, sim->table.record_count, sim->block, why);
}

static status run_on_records(simulation *sim, const char *name, failure *why)
{
    return run_over(sim, name, 0.0, why);
}

/* Over a step as it will be: a contact that slides stands at its limit without one, and may seem to stick. */
status observe_flows(simulation *sim, failure *why)
{
    return run_over(sim, "pair_probe", sim->dt, why);
}

static status read_ints(simulation *sim, cl_mem mem, int64_t count, int32_t **out, failure *why)
{
    *out = malloc(sizeof **out * (size_t)(count + 1));
    if (!*out)
        return fail(why, STATUS_ERROR, "out of memory");
    return store_read(sim, mem, 0, 4 * (uint64_t)count, *out, why);
}

/* The records in the order of their owners' permanent ids, and of a grain as its partners' ids have it, walls last: sums in this order do not
 * depend on when the table was built, as the order does in which records stand. */
typedef struct record_order {
    int32_t *record;
    int64_t count;
} record_order;

/* Records by the permanent id of one of their grains; those of the same one stay in their order. `start`: room for a number more than there are ids. */
static void sort_records(const int32_t *from, int64_t count, const int32_t *grain, const int32_t *id, int64_t ids, int64_t *start, int32_t *to)
{
    memset(start, 0, sizeof *start * (size_t)(ids + 1));
    for (int64_t n = 0; n < count; n++)
        start[id[grain[from[n]]] + 1]++;
    for (int64_t i = 0; i < ids; i++)
        start[i + 1] += start[i];
    for (int64_t n = 0; n < count; n++)
        to[start[id[grain[from[n]]]]++] = from[n];
}

static void order_found(const simulation *sim, const int32_t *owner, const int32_t *other, const int32_t *id, int64_t *start, int32_t *room,
                        record_order *out)
{
    const contact_table *t = &sim->table;
    for (int64_t k = 0; k < t->pair_count; k++)
        room[k] = (int32_t)k;
    sort_records(room, t->pair_count, other, id, sim->id_count, start, out->record);
    out->count = t->pair_count;
    for (int64_t k = t->wall_base; k < records_end(sim); k++)
        out->record[out->count++] = (int32_t)k;
    memcpy(room, out->record, sizeof *room * (size_t)out->count);
    sort_records(room, out->count, owner, id, sim->id_count, start, out->record);
}

static status order_records(simulation *sim, record_order *out, failure *why)
{
    const contact_table *t = &sim->table;
    size_t records = sizeof *out->record * (size_t)(t->record_count + 1);
    int32_t *owner = NULL, *other = NULL, *id = NULL, *room = malloc(records);
    int64_t *start = malloc(sizeof *start * ((size_t)sim->id_count + 1));
    *out = (record_order){.record = malloc(records)};
    status result = start && room && out->record ? STATUS_OK : fail(why, STATUS_ERROR, "out of memory");
    if (result == STATUS_OK)
        result = read_ints(sim, t->owner[t->now], t->record_count, &owner, why);
    if (result == STATUS_OK)
        result = read_ints(sim, t->other[t->now], t->record_count, &other, why);
    if (result == STATUS_OK)
        result = read_ints(sim, store_find(sim, "id")->mem, sim->stride, &id, why);
    if (result == STATUS_OK)
        order_found(sim, owner, other, id, start, room, out);
    free(owner);
    free(other);
    free(id);
    free(room);
    free(start);
    return result;
}

status observe_contact_sums(simulation *sim, contact_sums *out, failure *why)
{
    double *ratio = NULL, *energy = NULL;
    record_order order;
    memset(out, 0, sizeof *out);
    TRY(run_on_records(sim, "observe_records", why));
    cl_mem force = store_find(sim, "force")->mem;
    status result = read_component(sim, force, 0, &ratio, why);
    if (result == STATUS_OK)
        result = read_component(sim, force, 1, &energy, why);
    status ordered = order_records(sim, &order, why);
    result = result == STATUS_OK ? ordered : result;
    for (int64_t n = 0; n < order.count && result == STATUS_OK; n++) {
        int32_t k = order.record[n];
        out->elastic += energy[k]; /* a bond stores some where the surfaces are apart, too */
        if (ratio[k] > 0.0) {
            out->overlap_max = fmax(out->overlap_max, ratio[k]);
            out->contacts++;
            out->pairs += k < sim->table.wall_base;
        }
    }
    free(order.record);
    free(ratio);
    free(energy);
    return result;
}

typedef struct record_arrays {
    int32_t *owner, *other, *id;
    double *bonded; /* NULL where no bond law is live */
    double *growth; /* of necks that sinter; NULL without */
    record_order order;
    double *overlap, *radius, *force[3], *torque[3], *heat, *position; /* position: [grain][3]; heat: NULL without conduction */
} record_arrays;

static void free_records(record_arrays *r)
{
    free(r->owner);
    free(r->other);
    free(r->id);
    free(r->overlap);
    free(r->bonded);
    free(r->growth);
    free(r->order.record);
    free(r->radius);
    free(r->position);
    free(r->heat);
    for (int c = 0; c < 3; c++) {
        free(r->force[c]);
        free(r->torque[c]);
    }
}

static status read_grains(simulation *sim, const stored_field *stored, double **out, failure *why)
{
    *out = malloc(sizeof **out * (size_t)(stored->field->components * sim->stride + 1));
    if (!*out)
        return fail(why, STATUS_ERROR, "out of memory");
    return store_get_grains(sim, stored, sim->stride, *out, why);
}

static status read_records(simulation *sim, record_arrays *r, failure *why)
{
    contact_table *t = &sim->table;
    cl_mem force = store_find(sim, "force")->mem;
    stored_field *torque = sim->live.law[SLOT_ROTATION] ? store_find(sim, "torque") : NULL;
    stored_field *heat = sim->live.law[SLOT_CONDUCTION] ? store_find(sim, "heat") : NULL;
    memset(r, 0, sizeof *r);
    TRY(order_records(sim, &r->order, why));
    TRY(run_on_records(sim, "observe_records", why));
    TRY(read_component(sim, force, 2, &r->overlap, why));
    stored_field *bonded = sim->live.law[SLOT_BOND] ? store_find(sim, "bonded") : NULL;
    if (bonded)
        TRY(read_component(sim, bonded->mem, 0, &r->bonded, why));
    if (sim->live.law[SLOT_BOND] == &law_sintering)
        TRY(read_component(sim, store_find(sim, "neck_growth")->mem, 0, &r->growth, why));
    if (sim->live.law[SLOT_DIMENSIONS]) { /* what is always 0 is not written: what stood there before must go */
        TRY(store_fill(sim, force, field_bytes(sim, &field_force), why));
        TRY(torque ? store_fill(sim, torque->mem, field_bytes(sim, torque->field), why) : STATUS_OK);
    }
    TRY(run_on_records(sim, "pair_probe", why));
    TRY(read_ints(sim, t->owner[t->now], t->record_count, &r->owner, why));
    TRY(read_ints(sim, t->other[t->now], t->record_count, &r->other, why));
    TRY(read_ints(sim, store_find(sim, "id")->mem, sim->stride, &r->id, why));
    TRY(read_grains(sim, store_find(sim, "radius"), &r->radius, why));
    TRY(read_grains(sim, store_find(sim, "position"), &r->position, why));
    if (heat)
        TRY(read_component(sim, heat->mem, 0, &r->heat, why));
    for (int c = 0; c < 3; c++) {
        TRY(read_component(sim, force, c, &r->force[c], why));
        if (torque)
            TRY(read_component(sim, torque->mem, 3 + c, &r->torque[c], why));
    }
    return STATUS_OK;
}

/* Without spin a wall's force is along the normal, through the grain's centre. */
static void torque_without_spin(const simulation *sim, const record_arrays *r, int64_t k, const clast_face *face, double *torque)
{
    double arm[3];
    int64_t i = r->owner[k];
    (void)sim;
    for (int c = 0; c < 3; c++)
        arm[c] = r->position[3 * i + c] - face->pivot[c];
    for (int c = 0; c < 3; c++)
        torque[c] = -(arm[(c + 1) % 3] * r->force[(c + 2) % 3][k] - arm[(c + 2) % 3] * r->force[(c + 1) % 3][k]);
}

static bool is_bonded(const record_arrays *r, int64_t k)
{
    return r->bonded && llround(fabs(r->bonded[k])) % 2 == 1;
}

/* Bodies that bonds or cohesion hold act on each other where they are apart, too. */
static bool is_live(const record_arrays *r, int64_t k)
{
    return r->overlap[k] > 0.0 || is_bonded(r, k) || r->force[0][k] != 0.0 || r->force[1][k] != 0.0 || r->force[2][k] != 0.0;
}

static live_contact make_contact(const simulation *sim, const record_arrays *r, int64_t k)
{
    live_contact contact = {.i = r->id[r->owner[k]], .j = -1, .wall = -1, .overlap = r->overlap[k], .bonded = is_bonded(r, k)};
    bool wall = k >= sim->table.wall_base;
    double ri = r->radius[r->owner[k]], sign = 1.0, effective = ri;
    if (wall) {
        const clast_face *face = &sim->face_rows[r->other[k]];
        contact.wall = face->wall;
        if (r->torque[0])
            for (int c = 0; c < 3; c++)
                contact.torque_wall[c] = r->torque[c][k];
        else
            torque_without_spin(sim, r, k, face, contact.torque_wall);
    } else {
        double rj = r->radius[r->other[k]];
        effective = ri * rj / (ri + rj);
        contact.j = r->id[r->other[k]];
        if (contact.i > contact.j) {
            int32_t swap = contact.i;
            contact.i = contact.j;
            contact.j = swap;
            sign = -1.0;
        }
    }
    contact.area = M_PI * effective * contact.overlap;
    if (r->growth && contact.bonded) /* of the neck, whose radius over 2 r* is the sixth root */
        contact.area = 4.0 * M_PI * effective * effective * cbrt(r->growth[k]);
    contact.heat = r->heat ? sign * r->heat[k] : 0.0;
    for (int c = 0; c < 3; c++)
        contact.force[c] = sign * r->force[c][k];
    return contact;
}

static int by_ids(const void *a, const void *b)
{
    const live_contact *p = a, *q = b;
    if (p->i != q->i)
        return p->i < q->i ? -1 : 1;
    if ((p->j < 0) != (q->j < 0))
        return p->j < 0 ? 1 : -1;
    if (p->j != q->j)
        return p->j < q->j ? -1 : 1;
    return (p->wall > q->wall) - (p->wall < q->wall);
}

status observe_contacts(simulation *sim, bool walls_only, live_contact **out, int64_t *count, failure *why)
{
    record_arrays r;
    *out = NULL;
    *count = 0;
    status result = read_records(sim, &r, why);
    int64_t first = walls_only ? sim->table.wall_base : 0;
    if (result == STATUS_OK && !(*out = malloc(sizeof **out * (size_t)(records_end(sim) - first + 1))))
        result = fail(why, STATUS_ERROR, "out of memory");
    for (int64_t k = first; k < records_end(sim) && result == STATUS_OK; k++)
        if (is_live(&r, k) || (r.heat && r.heat[k] != 0.0)) /* held grains conduct and do not press */
            (*out)[(*count)++] = make_contact(sim, &r, k);
    if (result == STATUS_OK)
        qsort(*out, (size_t)*count, sizeof **out, by_ids);
    free_records(&r);
    return result;
}

static void add_totals(const simulation *sim, const record_arrays *r, double *const own[3], double *const opposite[3], double *out)
{
    for (int64_t n = 0; n < r->order.count; n++) {
        int64_t k = r->order.record[n];
        if (!is_live(r, k))
            continue;
        for (int c = 0; c < 3; c++) {
            out[3 * (int64_t)r->id[r->owner[k]] + c] += own[c][k];
            if (k < sim->table.wall_base)
                out[3 * (int64_t)r->id[r->other[k]] + c] += opposite ? opposite[c][k] : -own[c][k];
        }
    }
}

status observe_totals(simulation *sim, bool torque, double **out, failure *why)
{
    record_arrays r;
    double *own[3] = {NULL, NULL, NULL};
    status result = read_records(sim, &r, why);
    bool turns = torque && r.torque[0];
    *out = malloc(sizeof **out * (size_t)(3 * sim->id_count + 1));
    if (result == STATUS_OK && !*out)
        result = fail(why, STATUS_ERROR, "out of memory");
    for (int c = 0; turns && c < 3 && result == STATUS_OK; c++)
        result = read_component(sim, store_find(sim, "torque")->mem, c, &own[c], why);
    for (int64_t n = 0; n < 3 * sim->id_count && result == STATUS_OK; n++)
        (*out)[n] = NAN;
    for (int64_t i = 0; i < sim->count && result == STATUS_OK; i++)
        for (int c = 0; c < 3; c++)
            (*out)[3 * (int64_t)r.id[i] + c] = 0.0;
    if (result == STATUS_OK && (!torque || turns))
        add_totals(sim, &r, turns ? own : r.force, turns ? r.torque : NULL, *out);
    for (int c = 0; c < 3; c++)
        free(own[c]);
    free_records(&r);
    return result;
}

status observe_virial(simulation *sim, double *stress, failure *why)
{
    record_arrays r;
    const domain *d = &sim->scene->domain;
    memset(stress, 0, 9 * sizeof *stress);
    status result = read_records(sim, &r, why);
    for (int64_t n = 0; n < r.order.count && result == STATUS_OK; n++) {
        int64_t k = r.order.record[n];
        if (k >= sim->table.wall_base || !is_live(&r, k))
            continue;
        double branch[3];
        for (int c = 0; c < 3; c++) {
            double length = d->given && d->periodic[c] ? d->high_m[c] - d->low_m[c] : 0.0;
            branch[c] = r.position[3 * (int64_t)r.owner[k] + c] - r.position[3 * (int64_t)r.other[k] + c];
            if (length > 0.0)
                branch[c] -= length * rint(branch[c] / length);
        }
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                stress[3 * a + b] += r.force[a][k] * branch[b];
    }
    free_records(&r);
    return result;
}

status observe_field(simulation *sim, const char *name, double **out, failure *why)
{
    stored_field *stored = store_find(sim, name);
    if (!stored)
        return fail(why, STATUS_ERROR, "internal: no field named %s", name);
    int components = stored->field->components;
    stored_field from = *stored;
    cl_mem velocity, spin;
    if (strcmp(name, "velocity") == 0 || strcmp(name, "spin") == 0) {
        TRY(observe_velocities(sim, &velocity, &spin, why));
        from.mem = name[0] == 'v' ? velocity : spin ? spin : stored->mem;
    }
    if (strcmp(name, "temperature") == 0)
        TRY(heat_temperatures(sim, &from.mem, why));
    int32_t *id = NULL;
    double *rows = NULL;
    *out = malloc(sizeof **out * (size_t)(sim->id_count * components + 1));
    status result = *out ? read_ints(sim, store_find(sim, "id")->mem, sim->stride, &id, why) : fail(why, STATUS_ERROR, "out of memory");
    for (int64_t n = 0; result == STATUS_OK && n < sim->id_count * components; n++)
        (*out)[n] = NAN;
    if (result == STATUS_OK)
        result = read_grains(sim, &from, &rows, why);
    if (result == STATUS_OK && live_keeps_half_steps(&sim->live))
        result = ledger_add_half_step(sim, stored->field, rows, why);
    for (int64_t i = 0; i < sim->count && result == STATUS_OK; i++)
        memcpy(*out + (int64_t)id[i] * components, rows + i * components, sizeof *rows * (size_t)components);
    free(rows);
    free(id);
    return result;
}
