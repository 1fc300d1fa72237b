/* The state of a run in permanent-id order: what a checkpoint holds, and what the last good state is kept as. Where the table was built does
 * not matter for the bits, so it is built anew on loading; the histories of live contacts come along by the ids of the partners. */
#include "frozen.h"
#include "simulation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static status read_column(simulation *sim, cl_mem mem, int64_t first, int64_t count, int size, void **out, failure *why)
{
    *out = malloc((size_t)size * (size_t)(count + 1));
    if (!*out)
        return fail(why, STATUS_ERROR, "out of memory");
    return store_read(sim, mem, (uint64_t)size * (uint64_t)first, (uint64_t)size * (uint64_t)count, *out, why);
}

/* An array on the device in mixed precision as doubles: `part` 0 the floats there or the high ones of pairs, 1 the low ones. */
static double float_at(const char *array, bool pairs, int part, int64_t at)
{
    float value;
    memcpy(&value, array + 4 * (pairs ? 2 * at + part : at), sizeof value);
    return value;
}

/* In mixed precision pairs make two entries, high and low parts, since a double does not always hold both. */
static status save_field(simulation *sim, const stored_field *stored, const int32_t *id, bundle *out, failure *why)
{
    const field *field = stored->field;
    bool numbers = field->type != FIELD_INT, pairs = sim->mixed && field->type == FIELD_EXACT;
    int c = field->components;
    char *rows = NULL;
    status result = read_column(sim, stored->mem, 0, sim->stride, (int)store_item(sim, field->type) * c, (void **)&rows, why);
    for (int part = 0; part < 1 + pairs && result == STATUS_OK; part++) {
        char name[64];
        snprintf(name, sizeof name, "particles/%s%s", field->name, part ? "_low" : "");
        char *to = bundle_add(out, name, numbers ? BUNDLE_F64 : BUNDLE_I32, sim->id_count, c, NULL);
        size_t size = (numbers ? sizeof(double) : sizeof(int32_t)) * (size_t)c;
        for (int64_t i = 0; i < sim->count; i++) {
            double *row = (double *)(to + size * (size_t)id[i]);
            if (numbers && sim->mixed)
                for (int k = 0; k < c; k++)
                    row[k] = float_at(rows, pairs, part, i * c + k);
            else
                memcpy(row, rows + size * (size_t)i, size);
        }
    }
    free(rows);
    return result;
}

static status read_numbers(simulation *sim, cl_mem mem, int64_t first, int64_t count, double **out, failure *why)
{
    *out = malloc(sizeof **out * (size_t)(count + 1));
    if (!*out)
        return fail(why, STATUS_ERROR, "out of memory");
    return store_get(sim, mem, FIELD_REAL, first, count, *out, why);
}

/* Records with any history: ids of the owner and the other (or face, as -1 - face), and all components side by side. */
static status save_histories(simulation *sim, const int32_t *id, bundle *out, failure *why)
{
    contact_table *t = &sim->table;
    int32_t *owner = NULL, *other = NULL;
    double *column[64];
    int columns = 0;
    status result = read_column(sim, t->owner[t->now], 0, t->record_count, 4, (void **)&owner, why);
    if (result == STATUS_OK)
        result = read_column(sim, t->other[t->now], 0, t->record_count, 4, (void **)&other, why);
    for (int f = 0; f < sim->field_count && result == STATUS_OK; f++)
        for (int c = 0; sim->field[f].field->role == FIELD_HISTORY && c < sim->field[f].field->components && result == STATUS_OK; c++)
            result = read_numbers(sim, sim->field[f].mem, c * t->record_stride, t->record_count, &column[columns++], why);
    int64_t live = 0;
    for (int pass = 0; pass < 2 && result == STATUS_OK; pass++) {
        int32_t *pair = pass ? bundle_add(out, "contacts/pair", BUNDLE_I32, live, 2, NULL) : NULL;
        double *history = pass ? bundle_add(out, "contacts/history", BUNDLE_F64, live, columns, NULL) : NULL;
        live = 0;
        for (int64_t k = 0; k < t->wall_base + t->wall_record_count; k++) { /* what fills up the last work-group is no contact */
            bool any = false;
            for (int c = 0; c < columns; c++)
                any = any || column[c][k] != 0.0;
            if (!any)
                continue;
            if (pass) {
                pair[2 * live] = id[owner[k]];
                pair[2 * live + 1] = k >= t->wall_base ? -1 - other[k] : id[other[k]];
                for (int c = 0; c < columns; c++)
                    history[live * columns + c] = column[c][k];
            }
            live++;
        }
    }
    for (int c = 0; c < columns; c++)
        free(column[c]);
    free(owner);
    free(other);
    return result;
}

static void save_bodies(const moving_body *body, int count, const char *name, bundle *out)
{
    double *row = bundle_add(out, name, BUNDLE_F64, count, 14, NULL);
    for (int b = 0; b < count; b++, row += 14) {
        memcpy(row, body[b].rotation, sizeof body[b].rotation);
        memcpy(row + 9, body[b].shift, sizeof body[b].shift);
        row[12] = body[b].start;
        row[13] = body[b].from_origin;
    }
}

status state_save(simulation *sim, bundle *out, failure *why)
{
    int32_t *id = NULL;
    bundle_add_i64(out, "run/step", sim->step);
    bundle_add_i64(out, "run/stage", sim->stage);
    bundle_add_i64(out, "run/stage_steps", sim->stage_steps);
    bundle_add_i64(out, "run/segment_step", sim->segment_step);
    bundle_add_f64(out, "run/time", sim->time);
    bundle_add_f64(out, "run/segment_time", sim->segment_time);
    bundle_add_f64(out, "run/dt", sim->dt);
    if (live_keeps_half_steps(&sim->all))
        bundle_add_f64(out, "run/lag", sim->lag);
    if (sim->all.law[SLOT_HEAT_STEPS])
        bundle_add_f64(out, "run/heat_since", sim->heat.since);
    if (sim->live.frozen) {
        const double progress[5] = {sim->frozen.low, sim->frozen.high, sim->frozen.next, sim->frozen.rate, sim->frozen.hottest};
        bundle_add(out, "run/frozen", BUNDLE_F64, 5, 1, progress);
    }
    bundle_add_f64(out, "run/skin", sim->table.skin);
    bundle_add_i64(out, "run/left_count", sim->left_count);
    bundle_add_f64(out, "run/left_mass", sim->left_mass);
    bundle_add(out, "run/left_energy", BUNDLE_F64, LEDGER_TERMS, 1, sim->left_energy);
    bundle_add_i64(out, "run/rebuilds", sim->rebuilds);
    bond_sums bonds;
    TRY(bonds_count(sim, &bonds, why));
    bundle_add_i64(out, "run/bonds_made", bonds.made);
    bundle_add_i64(out, "run/bonding_done", sim->bonding_done);
    bundle_add_i64(out, "run/mixed", sim->mixed);
    bundle_add(out, "run/origin", BUNDLE_F64, 3, 1, sim->origin);
    if (sim->all.law[SLOT_SOURCE])
        bundle_add_f64(out, "run/delivered", sim->beams.delivered);
    save_bodies(sim->wall_body, sim->scene->wall_count, "bodies/walls", out);
    save_bodies(sim->group_body, sim->scene->group_count, "bodies/groups", out);
    servo_save(sim, out);
    int32_t *held = bundle_add(out, "bodies/held", BUNDLE_I32, sim->scene->group_count, 1, NULL);
    for (int g = 0; g < sim->scene->group_count; g++)
        held[g] = sim->group_held[g];
    TRY(read_column(sim, store_find(sim, "id")->mem, 0, sim->stride, 4, (void **)&id, why));
    int32_t *present = bundle_add(out, "particles/present", BUNDLE_I32, sim->id_count, 1, NULL);
    for (int64_t i = 0; i < sim->count; i++)
        present[id[i]] = 1;
    bundle_add(out, "particles/group", BUNDLE_I32, sim->id_count, 1, sim->group_of_id);
    status result = STATUS_OK;
    for (int f = 0; f < sim->field_count && result == STATUS_OK; f++)
        if (sim->field[f].field->extent == PER_PARTICLE && sim->field[f].field->role == FIELD_STATE)
            result = save_field(sim, &sim->field[f], id, out, why);
    if (result == STATUS_OK)
        result = save_histories(sim, id, out, why);
    free(id);
    return result;
}

/* ---- and back ---- */

static status load_number(const bundle *in, const char *path, const char *name, bundle_type type, double *real, int64_t *integer, failure *why)
{
    const bundle_entry *entry;
    TRY(bundle_get(in, path, name, type, 1, 1, &entry, why));
    if (type == BUNDLE_F64)
        *real = *(double *)entry->data;
    else
        *integer = *(int64_t *)entry->data;
    return STATUS_OK;
}

static void put_floats(char *to, const bundle_entry *const *entry, bool pairs, int64_t first, int count)
{
    for (int64_t n = first; n < first + count; n++)
        for (int part = 0; part < 1 + pairs; part++, to += sizeof(float)) {
            float value = (float)((const double *)entry[part]->data)[n];
            memcpy(to, &value, sizeof value);
        }
}

/* Grains that are present come first, in the order of their ids. */
static status load_field(simulation *sim, const stored_field *stored, const bundle *in, const char *path, const int32_t *present, failure *why)
{
    const field *field = stored->field;
    const bundle_entry *entry[2] = {NULL, NULL};
    bool numbers = field->type != FIELD_INT, pairs = sim->mixed && field->type == FIELD_EXACT;
    int c = field->components;
    for (int part = 0; part < 1 + pairs; part++) {
        char name[64];
        snprintf(name, sizeof name, "particles/%s%s", field->name, part ? "_low" : "");
        TRY(bundle_get(in, path, name, numbers ? BUNDLE_F64 : BUNDLE_I32, sim->id_count, c, &entry[part], why));
    }
    size_t size = (size_t)store_item(sim, field->type) * (size_t)c;
    char *rows = malloc(size * (size_t)sim->count + 1), *to = rows;
    if (!rows)
        return fail(why, STATUS_ERROR, "out of memory");
    for (int64_t n = 0; n < sim->id_count; n++) {
        if (!present[n])
            continue;
        if (numbers && sim->mixed)
            put_floats(to, entry, pairs, n * c, c);
        else
            memcpy(to, (const char *)entry[0]->data + size * (size_t)n, size);
        to += size;
    }
    status result = store_write(sim, stored->mem, 0, size * (uint64_t)sim->count, rows, why);
    free(rows);
    return result;
}

static status load_bodies(moving_body *body, int count, const char *name, const bundle *in, const char *path, failure *why)
{
    const bundle_entry *entry;
    TRY(bundle_get(in, path, name, BUNDLE_F64, count, 14, &entry, why));
    const double *row = entry->data;
    for (int b = 0; b < count; b++, row += 14) {
        memcpy(body[b].rotation, row, sizeof body[b].rotation);
        memcpy(body[b].shift, row + 9, sizeof body[b].shift);
        body[b].start = row[12];
        body[b].from_origin = row[13] != 0.0;
    }
    return STATUS_OK;
}

/* The motions that the stages so far have given to walls and groups. */
static void replay_motions(simulation *sim, int stage)
{
    for (int s = 0; s <= stage; s++) {
        const scene_stage *now = &sim->scene->stage[s];
        for (int c = 0; c < now->wall_change_count; c++)
            if (now->wall_change[c].motion_given)
                sim->wall_body[now->wall_change[c].wall].motion = &now->wall_change[c].motion;
        for (int c = 0; c < now->wall_group_change_count; c++)
            for (int w = 0; now->wall_group_change[c].motion_given && w < sim->scene->wall_count; w++)
                if (sim->scene->wall[w].group == now->wall_group_change[c].group)
                    sim->wall_body[w].motion = &now->wall_group_change[c].motion;
        for (int c = 0; c < now->group_change_count; c++)
            sim->group_body[now->group_change[c].group].motion = &now->group_change[c].motion;
    }
}

typedef struct saved_contact {
    int32_t owner, other;
    int64_t row;
} saved_contact;

static int by_partners(const void *a, const void *b)
{
    const saved_contact *p = a, *q = b;
    if (p->owner != q->owner)
        return p->owner < q->owner ? -1 : 1;
    return (p->other > q->other) - (p->other < q->other);
}

static status write_histories(simulation *sim, const saved_contact *saved, int64_t count, const double *history, int columns, failure *why)
{
    contact_table *t = &sim->table;
    int32_t *owner = NULL, *other = NULL, *id = NULL;
    double *column = malloc(sizeof *column * (size_t)(t->record_count + 1));
    int64_t *row = malloc(sizeof *row * (size_t)(t->record_count + 1));
    status result = column && row ? STATUS_OK : fail(why, STATUS_ERROR, "out of memory");
    if (result == STATUS_OK)
        result = read_column(sim, t->owner[t->now], 0, t->record_count, 4, (void **)&owner, why);
    if (result == STATUS_OK)
        result = read_column(sim, t->other[t->now], 0, t->record_count, 4, (void **)&other, why);
    if (result == STATUS_OK)
        result = read_column(sim, store_find(sim, "id")->mem, 0, sim->stride, 4, (void **)&id, why);
    for (int64_t k = 0; k < t->record_count && result == STATUS_OK; k++) {
        saved_contact key = {id[owner[k]], k >= t->wall_base ? -1 - other[k] : id[other[k]], 0};
        const saved_contact *found = key.owner == key.other ? NULL : bsearch(&key, saved, (size_t)count, sizeof *saved, by_partners);
        row[k] = found ? found->row : -1;
    }
    for (int f = 0, at = 0; f < sim->field_count && result == STATUS_OK; f++)
        for (int c = 0; sim->field[f].field->role == FIELD_HISTORY && c < sim->field[f].field->components && result == STATUS_OK; c++, at++) {
            for (int64_t k = 0; k < t->record_count; k++)
                column[k] = row[k] < 0 ? 0.0 : history[row[k] * columns + at];
            result = store_put(sim, sim->field[f].mem, FIELD_REAL, c * t->record_stride, t->record_count, column, why);
        }
    free(owner);
    free(other);
    free(id);
    free(column);
    free(row);
    return result;
}

static status load_histories(simulation *sim, const bundle *in, const char *path, failure *why)
{
    const bundle_entry *pair, *history;
    int columns = 0;
    for (int f = 0; f < sim->field_count; f++)
        columns += sim->field[f].field->role == FIELD_HISTORY ? sim->field[f].field->components : 0;
    TRY(bundle_get(in, path, "contacts/pair", BUNDLE_I32, -1, 2, &pair, why));
    TRY(bundle_get(in, path, "contacts/history", BUNDLE_F64, pair->rows, columns, &history, why));
    saved_contact *saved = malloc(sizeof *saved * (size_t)(pair->rows + 1));
    if (!saved)
        return fail(why, STATUS_ERROR, "out of memory");
    const int32_t *ids = pair->data;
    for (int64_t k = 0; k < pair->rows; k++)
        saved[k] = (saved_contact){ids[2 * k], ids[2 * k + 1], k};
    qsort(saved, (size_t)pair->rows, sizeof *saved, by_partners);
    status result = write_histories(sim, saved, pair->rows, history->data, columns, why);
    free(saved);
    return result;
}

/* How the steps of a stage in which nothing moves were going. */
static status load_frozen(simulation *sim, const bundle *in, const char *path, failure *why)
{
    const bundle_entry *entry;
    TRY(bundle_get(in, path, "run/frozen", BUNDLE_F64, 5, 1, &entry, why));
    const double *progress = entry->data;
    frozen_restart(sim);
    sim->frozen.low = progress[0];
    sim->frozen.high = progress[1];
    sim->frozen.next = progress[2];
    sim->frozen.rate = progress[3];
    sim->frozen.hottest = progress[4];
    return STATUS_OK;
}

static status load_run(simulation *sim, const bundle *in, const char *path, int64_t *stage, failure *why)
{
    const bundle_entry *origin;
    int64_t mixed;
    TRY(load_number(in, path, "run/step", BUNDLE_I64, NULL, &sim->step, why));
    TRY(load_number(in, path, "run/stage", BUNDLE_I64, NULL, stage, why));
    TRY(load_number(in, path, "run/stage_steps", BUNDLE_I64, NULL, &sim->stage_steps, why));
    TRY(load_number(in, path, "run/segment_step", BUNDLE_I64, NULL, &sim->segment_step, why));
    TRY(load_number(in, path, "run/time", BUNDLE_F64, &sim->time, NULL, why));
    TRY(load_number(in, path, "run/segment_time", BUNDLE_F64, &sim->segment_time, NULL, why));
    TRY(load_number(in, path, "run/dt", BUNDLE_F64, &sim->dt, NULL, why));
    if (live_keeps_half_steps(&sim->all))
        TRY(load_number(in, path, "run/lag", BUNDLE_F64, &sim->lag, NULL, why));
    if (sim->all.law[SLOT_HEAT_STEPS])
        TRY(load_number(in, path, "run/heat_since", BUNDLE_F64, &sim->heat.since, NULL, why));
    TRY(load_number(in, path, "run/skin", BUNDLE_F64, &sim->table.skin, NULL, why));
    TRY(load_number(in, path, "run/left_count", BUNDLE_I64, NULL, &sim->left_count, why));
    TRY(load_number(in, path, "run/left_mass", BUNDLE_F64, &sim->left_mass, NULL, why));
    const bundle_entry *left;
    TRY(bundle_get(in, path, "run/left_energy", BUNDLE_F64, LEDGER_TERMS, 1, &left, why));
    memcpy(sim->left_energy, left->data, sizeof sim->left_energy);
    TRY(load_number(in, path, "run/rebuilds", BUNDLE_I64, NULL, &sim->rebuilds, why));
    int64_t done;
    TRY(load_number(in, path, "run/bonds_made", BUNDLE_I64, NULL, &sim->bonds_gone, why));
    TRY(load_number(in, path, "run/bonding_done", BUNDLE_I64, NULL, &done, why));
    sim->bonding_done = done != 0;
    TRY(load_number(in, path, "run/mixed", BUNDLE_I64, NULL, &mixed, why));
    if ((mixed != 0) != sim->mixed)
        return fail(why, STATUS_BAD_INPUT, "%s: the checkpoint is of a run in %s precision, this one is in %s; a run goes on in the precision it began in",
                    path, mixed ? "mixed" : "double", sim->mixed ? "mixed" : "double");
    TRY(bundle_get(in, path, "run/origin", BUNDLE_F64, 3, 1, &origin, why));
    memcpy(sim->origin, origin->data, sizeof sim->origin);
    if (sim->all.law[SLOT_DIMENSIONS])
        sim->origin[2] = 0.0;
    if (sim->all.law[SLOT_SOURCE])
        TRY(load_number(in, path, "run/delivered", BUNDLE_F64, &sim->beams.delivered, NULL, why));
    if (*stage < 0 || *stage >= sim->scene->stage_count)
        return fail(why, STATUS_BAD_INPUT, "%s: run/stage is %lld, the scene has %d stages; the checkpoint is of another scene", path, (long long)*stage,
                    sim->scene->stage_count);
    if (sim->scene->stage[*stage].frozen)
        TRY(load_frozen(sim, in, path, why));
    return STATUS_OK;
}

/* A skin that holds every pair with a history: bonds reach further than a new table would look. */
static status skin_of_histories(simulation *sim, const bundle *in, const char *path, double *skin, failure *why)
{
    const bundle_entry *pair, *position, *radius;
    const domain *d = &sim->scene->domain;
    *skin = sim->table.skin;
    TRY(bundle_get(in, path, "contacts/pair", BUNDLE_I32, -1, 2, &pair, why));
    TRY(bundle_get(in, path, "particles/position", BUNDLE_F64, sim->id_count, 3, &position, why));
    TRY(bundle_get(in, path, "particles/radius", BUNDLE_F64, sim->id_count, 1, &radius, why));
    const double *x = position->data, *r = radius->data;
    for (int64_t k = 0; k < pair->rows; k++) {
        int32_t i = ((int32_t *)pair->data)[2 * k], j = ((int32_t *)pair->data)[2 * k + 1];
        double distance = 0.0;
        for (int c = 0; c < 3 && j >= 0; c++) {
            double apart = x[3 * i + c] - x[3 * j + c], length = d->given && d->periodic[c] ? d->high_m[c] - d->low_m[c] : 0.0;
            apart -= length > 0.0 ? length * rint(apart / length) : 0.0;
            distance += apart * apart;
        }
        if (j >= 0)
            *skin = fmax(*skin, 1.000001 * (sqrt(distance) - r[i] - r[j]));
    }
    return STATUS_OK;
}

status state_load(simulation *sim, const bundle *in, const char *path, failure *why)
{
    const bundle_entry *present, *held;
    int64_t stage;
    TRY(load_run(sim, in, path, &stage, why));
    TRY(bundle_get(in, path, "particles/present", BUNDLE_I32, sim->id_count, 1, &present, why));
    TRY(bundle_get(in, path, "bodies/held", BUNDLE_I32, sim->scene->group_count, 1, &held, why));
    TRY(load_bodies(sim->wall_body, sim->scene->wall_count, "bodies/walls", in, path, why));
    TRY(load_bodies(sim->group_body, sim->scene->group_count, "bodies/groups", in, path, why));
    for (int g = 0; g < sim->scene->group_count; g++)
        sim->group_held[g] = ((int32_t *)held->data)[g] != 0;
    sim->count = 0;
    for (int64_t n = 0; n < sim->id_count; n++)
        sim->count += ((int32_t *)present->data)[n] != 0;
    for (int f = 0; f < sim->field_count; f++)
        if (sim->field[f].field->extent == PER_PARTICLE && sim->field[f].field->role == FIELD_STATE)
            TRY(load_field(sim, &sim->field[f], in, path, present->data, why));
    replay_motions(sim, (int)stage);
    TRY(servo_load(sim, in, path, (int)stage, why));
    int64_t made = sim->bonds_gone; /* of all, with those of the records to come */
    double skin = sim->table.skin;
    TRY(skin_of_histories(sim, in, path, &sim->table.skin, why));
    bool wider = sim->table.skin > skin;
    TRY(simulation_enter_stage(sim, (int)stage, why));
    TRY(load_histories(sim, in, path, why));
    sim->table.skin = skin;
    sim->bonds_gone = made;
    TRY(bonds_after(sim, why));
    return wider ? table_build(sim, false, why) : STATUS_OK;
}
