/* The contact table on the device: see kernels/stage/table.cl. The host drives the launches and grows what is too small. */
#include "clock.h"
#include "laws/fields.h"
#include "precision.h"
#include "simulation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SCAN_CHUNK 1024
/* Numbers that one thread of a CPU sums up sooner than launches are made. */
#define SCAN_WHOLE 20000
/* Reserve on growth, so that a bed that gets denser does not allocate at every table. */
#define RESERVE 1.08
/* Steps after a table at which it is asked whether a smaller skin would do; then twice as many. */
#define FIRST_SKIN_LOOK 100

enum { WORK_A, WORK_B, WORK_C, WORK_D, WORK_E };

static int64_t round_up(int64_t value, int64_t step)
{
    return (value + step - 1) / step * step;
}

status table_create(simulation *sim, failure *why)
{
    contact_table *t = &sim->table;
    int64_t blocks = sim->stride / sim->block;
    t->record_stride = 0;
    for (int w = 0; w < 5; w++)
        TRY(store_buffer(sim, &t->work[w], 4 * (uint64_t)(sim->stride + 1), "the contact table", why));
    for (int g = 0; g < 2; g++) {
        TRY(store_buffer(sim, &t->slot_offset[g], 4 * (uint64_t)(blocks + 1), "the contact table", why));
        TRY(store_fill(sim, t->slot_offset[g], 4 * (uint64_t)(blocks + 1), why));
    }
    TRY(store_buffer(sim, &t->totals, sizeof t->found, "the contact table", why));
    TRY(store_buffer(sim, &t->width, 4 * (uint64_t)(blocks + 1), "the contact table", why));
    return store_buffer(sim, &t->grid, sizeof(clast_grid), "the contact table", why);
}

static void release_pair(simulation *sim, cl_mem *mem, uint64_t bytes)
{
    store_release(sim, &mem[0], bytes);
    store_release(sim, &mem[1], bytes);
}

void table_free(simulation *sim)
{
    contact_table *t = &sim->table;
    table_list_free(sim);
    release_pair(sim, t->owner, 0);
    release_pair(sim, t->other, 0);
    release_pair(sim, t->slots, 0);
    release_pair(sim, t->slot_offset, 0);
    cl_mem *const rest[] = {&t->match,      &t->placed,     &t->work[0], &t->work[1], &t->work[2], &t->work[3], &t->work[4],
                            &t->cell_count, &t->cell_start, &t->sums,    &t->grid,    &t->width,   &t->totals};
    for (size_t m = 0; m < sizeof rest / sizeof *rest; m++)
        store_release(sim, rest[m], 0);
}

/* Cells of one level along one direction. A periodic length is divided evenly; else cells start at the bed's low corner and wrap, so that
 * grains beyond the corner are found too. */
static void set_level(const simulation *sim, double size, double low[3], double high[3], clast_level *level)
{
    const domain *d = &sim->scene->domain;
    double cells[3], total = 1.0, most = 2.0 * (double)sim->id_count + 64.0;
    for (int c = 0; c < 3 && sim->mixed; c++) /* floats place a grain into a cell to a share of the cell: what they may miss is added */
        size = fmax(size, size * (1.0 + 0x1p-20 * (high[c] - low[c]) / size));
    for (int c = 0; c < 3; c++) {
        cells[c] = floor((high[c] - low[c]) / size);
        bool periodic = d->given && d->periodic[c];
        cells[c] = fmin(fmax(periodic ? cells[c] : cells[c] + 1.0, 1.0), 1e6);
        total *= cells[c];
    }
    for (int c = 0; c < 3 && total > most; c++) {
        double shrink = fmin(cells[c], fmax(1.0, floor(cells[c] * pow(most / total, 1.0 / (3 - c)))));
        total *= shrink / cells[c];
        cells[c] = shrink;
    }
    for (int c = 0; c < 3; c++) {
        bool periodic = d->given && d->periodic[c];
        level->cells[c] = (clast_i32)cells[c];
        level->inverse_size[c] = periodic ? cells[c] / (high[c] - low[c]) : 1.0 / size;
    }
}

cl_mem table_radii(simulation *sim)
{
    stored_field *reference = store_find(sim, field_reference_radius.name);
    return (reference ? reference : store_find(sim, "radius"))->mem;
}

status table_growth(simulation *sim, double *growth, failure *why)
{
    size_t n = (size_t)sim->count;
    *growth = 0.0;
    if (!sim->all.law[SLOT_RADIUS] || n == 0)
        return STATUS_OK;
    double *radius = malloc(2 * sizeof *radius * n);
    status result = radius ? store_get_grains(sim, store_find(sim, "radius"), sim->count, radius, why)
                           : fail(why, STATUS_ERROR, "out of memory");
    if (result == STATUS_OK)
        result = store_get_grains(sim, store_find(sim, field_reference_radius.name), sim->count, radius + n, why);
    for (size_t i = 0; i < n && result == STATUS_OK; i++)
        *growth = fmax(*growth, radius[i] - radius[n + i]);
    free(radius);
    return result;
}

static void set_grid(simulation *sim, bool drop_outside)
{
    contact_table *t = &sim->table;
    clast_grid *g = &t->grid_host;
    memset(g, 0, sizeof *g);
    g->radius_max = t->radius_max;
    g->skin = t->skin + sim->reach + 2.0 * t->growth;
    g->wall_share = bonds_are_kept(sim) ? 1.0 : 0.0;
    g->drop_outside = drop_outside;
    memcpy(g->origin, sim->bed_low, sizeof g->origin);
    int levels = 1;
    while (levels < CLAST_LEVELS_MAX && t->radius_max / pow(2.0, levels) > t->radius_min)
        levels++;
    g->level_count = levels;
    for (int l = 0; l < levels; l++) {
        set_level(sim, 2.0 * t->radius_max / pow(2.0, l) + g->skin, sim->bed_low, sim->bed_high, &g->level[l]);
        g->level[l].first_cell = g->cell_count;
        g->cell_count += g->level[l].cells[0] * g->level[l].cells[1] * g->level[l].cells[2];
    }
}

static status grow(simulation *sim, cl_mem *mem, uint64_t old_bytes, uint64_t bytes, failure *why)
{
    store_release(sim, mem, old_bytes);
    return store_buffer(sim, mem, bytes, "the contact table", why);
}

/* Chunk sums of the longest scan: over cells, or over grains. */
static uint64_t sum_bytes(const simulation *sim, int64_t cells)
{
    int64_t most = cells + 1 > sim->stride ? cells + 1 : sim->stride;
    return 4 * (uint64_t)(most / SCAN_CHUNK + 2);
}

static status fit_cells(simulation *sim, failure *why)
{
    contact_table *t = &sim->table;
    int64_t cells = t->grid_host.cell_count + 1;
    if (cells > t->cell_capacity) {
        int64_t now = cells + cells / 8;
        TRY(grow(sim, &t->cell_count, 4 * (uint64_t)(t->cell_capacity + 1), 4 * (uint64_t)(now + 1), why));
        TRY(grow(sim, &t->cell_start, 4 * (uint64_t)(t->cell_capacity + 1), 4 * (uint64_t)(now + 1), why));
        TRY(grow(sim, &t->sums, sum_bytes(sim, t->cell_capacity), sum_bytes(sim, now), why));
        t->cell_capacity = now;
    }
    return STATUS_OK;
}

/* result[0..count] from values[0..count). */
static status scan(simulation *sim, cl_mem values, cl_mem result, int64_t count, failure *why)
{
    contact_table *t = &sim->table;
    int chunks = (int)((count + SCAN_CHUNK - 1) / SCAN_CHUNK);
    if (sim->device->info.cpu && count <= SCAN_WHOLE) {
        return table_do(sim, "scan_whole", 1, 1, why, "mmi", values, result, (cl_int)count);
    }
    TRY(table_do(sim, "scan_chunks", chunks, 1, why, "mmi", values, t->sums, (cl_int)count));
    TRY(table_do(sim, "scan_sums", 1, 1, why, "mi", t->sums, chunks));
    return table_do(sim, "scan_write", chunks, 1, why, "mmmi", values, t->sums, result, (cl_int)count);
}

/* order[new] = old in work C; sim->count falls by what left the domain. */
static status sort_grains(simulation *sim, const clast_launch *launch, failure *why)
{
    contact_table *t = &sim->table;
    int cells = t->grid_host.cell_count;
    cl_mem position = store_find(sim, "position")->mem, radius = table_radii(sim), id = store_find(sim, "id")->mem;
    TRY(table_do_fill(sim, t->cell_count, 4 * (uint64_t)(cells + 1), 0, why));
    TRY(table_do(sim, "table_bin", sim->count, sim->block, why, "Lmmmmmm", launch, t->grid, position, radius, t->work[WORK_A],
                 t->work[WORK_B], t->cell_count));
    TRY(scan(sim, t->cell_count, t->cell_start, cells + 1, why));
    TRY(table_do(sim, "table_order", sim->count, sim->block, why, "Lmmmm", launch, t->work[WORK_A], t->work[WORK_B], t->cell_start,
                 t->work[WORK_C]));
    TRY(table_do(sim, "table_order_cells", cells + 1, sim->block, why, "mmmi", t->cell_start, id, t->work[WORK_C], cells + 1));
    if (t->grid_host.drop_outside) {
        cl_uint kept;
        TRY(table_flush(sim, why));
        TRY(store_read(sim, t->cell_start, 4 * (uint64_t)cells, sizeof kept, &kept, why));
        TRY(simulation_count_leavers(sim, kept, why));
    }
    return STATUS_OK;
}

/* By way of the positions at the last table, which are written anew in the end, and what is wider by way of room of its own. What is as
 * large as positions changes places with them instead of being copied back. */
static status permute_field(simulation *sim, const clast_launch *launch, stored_field *stored, failure *why)
{
    uint64_t bytes = store_item(sim, stored->field->type) * (uint64_t)stored->field->components,
             like_position = field_bytes(sim, &field_position);
    bool wide = field_bytes(sim, stored->field) > like_position, alike = field_bytes(sim, stored->field) == like_position;
    cl_mem from = stored->mem, scratch = wide ? sim->scratch4 : sim->built_position;
    TRY(table_do(sim, "table_permute", sim->count, sim->block, why, "Lmmmi", launch, sim->table.work[WORK_C], from, scratch,
                 (cl_int)(bytes / 4)));
    if (!alike)
        return table_do_copy(sim, scratch, from, bytes * (uint64_t)sim->count, why);
    stored->mem = scratch;
    sim->built_position = from;
    return STATUS_OK;
}

static status permute_fields(simulation *sim, const clast_launch *launch, failure *why)
{
    for (int f = 0; f < sim->field_count; f++) {
        const field *field = sim->field[f].field;
        if (field->extent == PER_PARTICLE && field->role == FIELD_STATE)
            TRY(permute_field(sim, launch, &sim->field[f], why));
    }
    return STATUS_OK;
}

/* Partners a grain that fit into the force array, which nobody reads while a table is built. */
static int kept_partners(const simulation *sim)
{
    int64_t words = (int64_t)store_item(sim, FIELD_REAL) / 4 * field_force.components;
    int64_t room = words * sim->table.record_stride / sim->stride;
    return room > 32 ? 32 : (int)room;
}

static bool has_walls(const simulation *sim)
{
    return sim->live.law[SLOT_WALLS] != NULL;
}

/* Owned pairs into work A, their starts into D, wall records' starts into E, slots of every grain into B, and where those of a block begin. What
 * the host needs to know of them is read at once: to wait costs more than many a kernel. */
static status count_records(simulation *sim, const clast_launch *launch, failure *why)
{
    contact_table *t = &sim->table;
    int64_t blocks = sim->stride / sim->block;
    cl_mem position = store_find(sim, "position")->mem, radius = table_radii(sim), id = store_find(sim, "id")->mem,
           offset = t->slot_offset[1 - t->now];
    TRY(table_do_fill(sim, t->work[WORK_A], 4 * (uint64_t)sim->stride, 0, why));
    TRY(table_do_fill(sim, t->work[WORK_B], 4 * (uint64_t)sim->stride, 0, why));
    TRY(table_do(sim, "table_count", sim->count, sim->block, why, "Lmmmmmmmmi", launch, t->grid, t->cell_start, position, radius, id,
                 t->work[WORK_A], t->work[WORK_B], store_find(sim, "force")->mem, kept_partners(sim)));
    TRY(bonds_keep(sim, launch, kept_partners(sim), false, why));
    TRY(scan(sim, t->work[WORK_A], t->work[WORK_D], sim->stride, why));
    if (has_walls(sim)) {
        TRY(table_do(sim, "table_count_walls", sim->stride, sim->block, why, "Lmmmmmm", launch, t->grid, position, radius, sim->faces,
                     t->work[WORK_A], t->work[WORK_B]));
        TRY(scan(sim, t->work[WORK_A], t->work[WORK_E], sim->stride, why));
    }
    TRY(table_do(sim, "table_widths", blocks, 1, why, "mm", t->work[WORK_B], t->width));
    TRY(scan(sim, t->width, offset, blocks, why));
    cl_mem walls_start = t->work[has_walls(sim) ? WORK_E : WORK_D];
    TRY(table_do(sim, "table_totals", 1, 1, why, "mmmmii", t->work[WORK_D], walls_start, offset, t->totals, (cl_int)sim->stride,
                 (cl_int)blocks));
    TRY(table_flush(sim, why));
    TRY(store_read(sim, t->totals, 0, sizeof t->found, t->found, why));
    t->pair_count = (int)t->found[0];
    t->wall_record_count = has_walls(sim) ? (int)t->found[1] : 0;
    t->slot_count = (int)t->found[2];
    t->wall_base = (int)round_up(t->pair_count, sim->block);
    t->record_count = (int)round_up(t->wall_base + t->wall_record_count, sim->block);
    return STATUS_OK;
}

/* The generation that is not in use, and what both share, hold at least `records` and `slots`. Histories move in carry_histories. */
static status fit_records(simulation *sim, failure *why)
{
    contact_table *t = &sim->table;
    int64_t need = t->record_count + 1; /* one that is nobody's (kernels/stage/wrenches_together.cl) */
    if (need <= t->record_capacity && t->record_capacity > 0)
        return STATUS_OK;
    int64_t capacity = round_up((int64_t)((double)need * RESERVE) + sim->block, sim->block);
    int next = 1 - t->now;
    uint64_t old = 4 * (uint64_t)t->record_capacity, bytes = 4 * (uint64_t)capacity;
    TRY(grow(sim, &t->owner[next], old, bytes, why));
    TRY(grow(sim, &t->other[next], old, bytes, why));
    TRY(grow(sim, &t->match, old, bytes, why));
    t->record_capacity = capacity;
    t->record_stride = capacity;
    return STATUS_OK;
}

static status fit_slots(simulation *sim, int64_t slots, failure *why)
{
    contact_table *t = &sim->table;
    int next = 1 - t->now;
    if (slots > t->slot_capacity) {
        t->slot_capacity = (int64_t)((double)slots * RESERVE) + sim->block;
        t->slots_outgrown[0] = t->slots_outgrown[1] = true;
    }
    if (!t->slots_outgrown[next] && t->slots[next])
        return STATUS_OK;
    TRY(grow(sim, &t->slots[next], 4 * (uint64_t)t->slots_held[next], 4 * (uint64_t)t->slot_capacity, why));
    t->slots_held[next] = t->slot_capacity;
    t->slots_outgrown[next] = false;
    return STATUS_OK;
}

static status fill_records(simulation *sim, const clast_launch *launch, int room, failure *why)
{
    contact_table *t = &sim->table;
    int next = 1 - t->now;
    cl_mem position = store_find(sim, "position")->mem, radius = table_radii(sim), id = store_find(sim, "id")->mem;
    TRY(table_do(sim, "table_fill", sim->count, sim->block, why, "Lmmmmmmmmmi", launch, t->grid, t->cell_start, position, radius, id,
                 t->work[WORK_D], t->owner[next], t->other[next], store_find(sim, "force")->mem, room));
    TRY(bonds_keep(sim, launch, room, true, why));
    int end = t->wall_base + t->wall_record_count;
    if (has_walls(sim)) {
        TRY(table_do(sim, "table_fill_walls", sim->count, sim->block, why, "Lmmmmmmmi", launch, t->grid, position, radius, sim->faces,
                     t->work[WORK_E], t->owner[next], t->other[next], t->wall_base));
    }
    return table_do(sim, "table_pad", t->wall_base - t->pair_count + t->record_count - end, sim->block, why, "mmiiii", t->owner[next],
                    t->other[next], t->pair_count, t->wall_base, end, t->record_count);
}

static status fill_slots(simulation *sim, const clast_launch *launch, failure *why)
{
    contact_table *t = &sim->table;
    int next = 1 - t->now, end = t->wall_base + t->wall_record_count;
    cl_mem id = store_find(sim, "id")->mem;
    TRY(fit_slots(sim, t->slot_count, why));
    TRY(table_do_fill(sim, t->slots[next], 4 * (uint64_t)t->slot_count, 0, why));
    TRY(table_do_fill(sim, t->work[WORK_A], 4 * (uint64_t)sim->stride, 0, why));
    TRY(table_do(sim, "table_slots", end, sim->block, why, "mmmmmiii", t->owner[next], t->other[next], t->slot_offset[next],
                 t->work[WORK_A], t->slots[next], t->pair_count, t->wall_base, end));
    return table_do(sim, "table_sort_slots", sim->count, sim->block, why, "Lmmmmmmi", launch, t->owner[next], t->other[next], id,
                    t->slot_offset[next], t->work[WORK_B], t->slots[next], t->wall_base);
}

static status carry_history(simulation *sim, const stored_field *stored, cl_mem from, int64_t old_stride, failure *why)
{
    contact_table *t = &sim->table;
    int components = stored->field->components;
    return table_do(sim, "table_carry", t->record_count, sim->block, why, "mmmlliii", t->match, from, stored->mem, (clast_i64)old_stride,
                    (clast_i64)t->record_stride, t->record_count, components, components > 1);
}

/* Every history of the old records into the new ones. Where nothing grew it changes places with the force array, which nobody reads while a table is
 * built, or where it is smaller is copied there first: a history has three components at most. */
static status carry_histories(simulation *sim, int64_t old_stride, failure *why)
{
    contact_table *t = &sim->table;
    bool grown = old_stride != t->record_stride;
    if (grown)
        TRY(table_flush(sim, why));
    for (int f = 0; f < sim->field_count; f++) {
        stored_field *stored = &sim->field[f];
        const field *field = stored->field;
        if (field->extent != PER_RECORD && field->extent != PER_RECORD_BLOCK)
            continue;
        uint64_t old_bytes = field_bytes_at(sim, field, old_stride);
        cl_mem old = stored->mem;
        if (field->role != FIELD_HISTORY) {
            if (grown)
                TRY(grow(sim, &stored->mem, old_bytes, field_bytes(sim, field), why));
            continue;
        }
        stored_field *force = store_find(sim, "force");
        bool alike = !grown && old_bytes == field_bytes(sim, &field_force);
        cl_mem from = grown || alike ? old : force->mem;
        status result = STATUS_OK;
        if (grown)
            result = store_buffer(sim, &stored->mem, field_bytes(sim, field), field->name, why);
        else if (alike) {
            stored->mem = force->mem;
            force->mem = old;
        } else
            result = table_do_copy(sim, old, from, old_bytes, why);
        if (result == STATUS_OK)
            result = carry_history(sim, stored, from, old_stride, why);
        if (result == STATUS_OK && grown)
            result = table_flush(sim, why);
        if (grown)
            store_release(sim, &old, old_bytes);
        TRY(result);
    }
    return STATUS_OK;
}

static status match_records(simulation *sim, int old_wall_base, failure *why)
{
    contact_table *t = &sim->table;
    int next = 1 - t->now;
    if (!t->built)
        return table_do_fill(sim, t->match, 4 * (uint64_t)t->record_count, 0, why);
    return table_do(sim, "table_match", t->record_count, sim->block, why, "mmmmmmmmiiiii", t->owner[next], t->other[next], t->work[WORK_C],
                    t->owner[t->now], t->other[t->now], t->slot_offset[t->now], t->slots[t->now], t->match, t->pair_count, t->wall_base,
                    t->wall_base + t->wall_record_count, t->record_count, old_wall_base);
}

/* The generation left behind is brought to the size of the other one once it is free. */
static status fit_spare_generation(simulation *sim, int64_t old_capacity, failure *why)
{
    contact_table *t = &sim->table;
    if (old_capacity == t->record_capacity)
        return STATUS_OK;
    int spare = 1 - t->now;
    TRY(grow(sim, &t->owner[spare], 4 * (uint64_t)old_capacity, 4 * (uint64_t)t->record_capacity, why));
    return grow(sim, &t->other[spare], 4 * (uint64_t)old_capacity, 4 * (uint64_t)t->record_capacity, why);
}

static status finish(simulation *sim, failure *why)
{
    contact_table *t = &sim->table;
    t->now = 1 - t->now;
    t->built = true;
    sim->particles_stale = true;
    sim->built_time = sim->time;
    sim->rebuild_step = sim->step;
    servo_note_table(sim);
    t->skin_look = FIRST_SKIN_LOOK;
    TRY(table_do_copy(sim, store_find(sim, "position")->mem, sim->built_position, field_bytes(sim, &field_position), why));
    stored_field *built = store_find(sim, field_built_radius.name);
    if (built)
        TRY(table_do_copy(sim, store_find(sim, "radius")->mem, built->mem, field_bytes(sim, built->field), why));
    TRY(step_plan_make(sim, why));
    TRY(table_flush(sim, why));
    TRY(simulation_choose_drift(sim, why));
    return launch_bind_stages(sim, why);
}

status table_build(simulation *sim, bool drop_outside, failure *why)
{
    contact_table *t = &sim->table;
    double start = clock_seconds();
    int old_wall_base = t->old_wall_base = t->wall_base;
    int64_t old_stride = t->record_stride, old_capacity = t->record_capacity;
    t->list.count = t->list.memories = 0; /* what an error has left */
    t->list.launched = false;
    TRY(bonds_before(sim, why));
    TRY(table_growth(sim, &t->growth, why));
    set_grid(sim, drop_outside);
    TRY(fit_cells(sim, why));
    clast_grid grid = t->grid_host;
    if (sim->mixed)
        precision_split_grid(&grid, sim->origin);
    TRY(table_give_grid(sim, &grid, why));
    clast_launch launch = launch_values(sim);
    TRY(sort_grains(sim, &launch, why));
    launch.particle_count = (clast_i32)sim->count;
    TRY(permute_fields(sim, &launch, why));
    TRY(count_records(sim, &launch, why));
    int room = kept_partners(sim);
    TRY(fit_records(sim, why));
    TRY(fill_records(sim, &launch, room, why));
    TRY(fill_slots(sim, &launch, why));
    TRY(match_records(sim, old_wall_base, why));
    TRY(carry_histories(sim, old_stride, why));
    TRY(finish(sim, why));
    TRY(fit_spare_generation(sim, old_capacity, why));
    TRY(bonds_after(sim, why));
    sim->rebuilds++;
    sim->rebuild_seconds += clock_seconds() - start;
    return STATUS_OK;
}

status table_travel(simulation *sim, double *out, failure *why)
{
    int64_t chunks = (sim->count + SCAN_CHUNK - 1) / SCAN_CHUNK;
    clast_launch launch = launch_values(sim);
    cl_kernel kernel = launch_kernel(sim, "table_travel");
    double *most = malloc(sizeof *most * (size_t)(chunks + 1));
    *out = 0.0;
    if (!most)
        return fail(why, STATUS_ERROR, "out of memory");
    for (int c = 0; c < 3; c++)
        launch.drift[c] = sim->drift_velocity[c] * (sim->time - sim->built_time);
    status result = observe_partial(sim, chunks + 1, why);
    if (result == STATUS_OK)
        result = launch_set(kernel, "table_travel", why, "Lmmm", &launch, store_find(sim, "position")->mem, sim->built_position,
                            sim->partial);
    if (result == STATUS_OK)
        result = launch_run(sim, kernel, "table_travel", chunks, 1, why);
    if (result == STATUS_OK)
        result = store_get(sim, sim->partial, FIELD_EXACT, 0, chunks, most, why);
    for (int64_t c = 0; c < chunks && result == STATUS_OK; c++)
        *out = fmax(*out, most[c]);
    free(most);
    *out = sqrt(*out);
    return result;
}

uint64_t table_bytes(const simulation *sim)
{
    const contact_table *t = &sim->table;
    return 4 * (uint64_t)(5 * (sim->stride + 1) + 5 * t->record_capacity + t->slots_held[0] + t->slots_held[1] + t->placed_held +
                          2 * t->cell_capacity);
}
