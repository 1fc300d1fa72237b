/* The pieces of a step, in order.
 *
 * On a GPU, and for a bed that fits the caches, two: all records, all grains. On a CPU both stages would otherwise wait for memory: the
 * forces of all records go out to it and come back. So the records are taken in chunks, and as soon as all records that a group of blocks takes
 * part in have been through the pair stage, these blocks go through the particle stage, while their forces are still in the cache. No record
 * that comes later reads these grains, so that they can move in place, and every sum is the same to the bit. A chunk whose forces have all been
 * gathered leaves its place to a later chunk of the same step, so that forces hardly leave the cache at all.
 *
 * Where several work-groups go through the steps (step_loop.c) each has chunks of its own, a stream: a part of the bed, whose grains and forces stay
 * in the caches of its core. Only blocks that take part in records of two streams wait until all streams have ended. */
#include "laws/fields.h"
#include "simulation.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* Beds with fewer chunks than this go through the stages whole. */
#define CHUNKS_LEAST 4
/* Records of a chunk for each block in a group: 16 blocks go together in the usual chunk, so that ragged borders make no small launches. */
#define CHUNK_PER_BLOCK 2048
/* A chunk of a stream in chunks that are launched. */
#define STREAM_CHUNK_SHARE 32
/* Steps between tables, times records, from which streams take off more than they cost (docs/performance.md). */
#define STREAMS_PAY 3e5

/* What a plan is made from; arrays of the host. */
typedef struct planning {
    int chunk, chunks; /* records in one, and how many */
    int streams;
    int blocks, together, groups;
    int32_t *first; /* of every block: its first record of a pair */
    int32_t *last;  /* of every block: its last record of a pair; then the chunk after which it may go, `chunks`: after all streams */
    int32_t
        *release;   /* of every work-group of records: the chunk after which its forces have been gathered; then the same of every chunk */
    int32_t *place; /* of every chunk, in chunks */
    int places;
    int32_t *block, *begin; /* blocks in the order in which they may go, and where those of every chunk begin; `chunks` has those after all streams */
} planning;

/* Records that a chunk is to have; 0: the stages go whole. */
static int chunk_records(const simulation *sim)
{
    int64_t asked = sim->scene->table.chunk_records, size = sim->block;
    int usual = sim->device->tuning.chunk_records;
    if (asked == 0)
        return usual > 0 && sim->table.wall_base >= CHUNKS_LEAST * (int64_t)usual ? usual : 0;
    while (size < asked && size < (1 << 30))
        size *= 2;
    return size < sim->table.wall_base ? (int)size : 0;
}

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

static status add_piece(step_plan *plan, bool pairs, int first, int count, int shift, failure *why)
{
    if (count <= 0)
        return STATUS_OK;
    if (plan->count == plan->capacity) {
        int capacity = 2 * plan->capacity + 16;
        clast_piece *more = realloc(plan->piece, (size_t)capacity * sizeof *more);
        if (!more)
            return fail(why, STATUS_ERROR, "out of memory");
        plan->piece = more;
        plan->capacity = capacity;
    }
    plan->piece[plan->count++] = (clast_piece){pairs ? 1 : 0, first, count, shift};
    return STATUS_OK;
}

/* First chunk of a stream. */
static int stream_begin(const planning *p, int stream)
{
    return (int)((int64_t)p->chunks * stream / p->streams);
}

static int stream_of(const planning *p, int chunk)
{
    int stream = 0;
    while (stream + 1 < p->streams && stream_begin(p, stream + 1) <= chunk)
        stream++;
    return stream;
}

static int blocks_of(const simulation *sim)
{
    return (int)((sim->count + sim->block - 1) / sim->block);
}

/* The pieces from `first` on, which work-groups share. */
static void add_shared_phase(step_plan *plan, int first)
{
    clast_phase phase = {.first = first, .end = plan->count};
    for (int p = first; p < plan->count; p++)
        phase.units += plan->piece[p].count * (plan->piece[p].pairs ? 1 : STEP_BLOCK_ITEMS);
    if (phase.units > 0)
        plan->phases.phase[plan->phases.count++] = phase;
}

static status plan_whole(simulation *sim, failure *why)
{
    step_plan *plan = &sim->plan;
    plan->chunk_records = plan->force_records = 0;
    TRY(add_piece(plan, true, 0, sim->table.record_count / sim->block, 0, why));
    add_shared_phase(plan, 0);
    int grains = plan->count;
    TRY(add_piece(plan, false, 0, blocks_of(sim), 0, why));
    add_shared_phase(plan, grains);
    return STATUS_OK;
}

/* ---- after which chunk a block may go, and until when a chunk's forces are needed ---- */

static status find_last_records(simulation *sim, planning *p, failure *why)
{
    contact_table *t = &sim->table;
    TRY(table_do(sim, "table_last_records", p->blocks, sim->block, why, "mmmii", t->slot_offset[t->now], t->slots[t->now], t->work[0],
                 t->wall_base, p->blocks));
    TRY(table_flush(sim, why));
    TRY(store_read(sim, t->work[0], 0, 8 * (uint64_t)p->blocks, p->first, why));
    for (int b = 0; b < p->blocks; b++)
        p->last[b] = p->first[2 * b + 1];
    for (int b = 0; b < p->blocks; b++)
        p->first[b] = p->first[2 * b];
    return STATUS_OK;
}

/* A group goes with its latest block, and after all streams where it takes part in two. */
static void wait_in_groups(planning *p)
{
    for (int g = 0; g < p->groups; g++) {
        int begin = g * p->together, end = smaller(begin + p->together, p->blocks), first = p->first[begin], last = 0;
        for (int b = begin; b < end; b++) {
            first = smaller(first, p->first[b]);
            last = p->last[b] > last ? p->last[b] : last;
        }
        bool within = first > last || stream_of(p, first / p->chunk) == stream_of(p, last / p->chunk);
        for (int b = begin; b < end; b++)
            p->last[b] = within ? last / p->chunk : p->chunks;
    }
}

static status find_releases(simulation *sim, planning *p, failure *why)
{
    contact_table *t = &sim->table;
    int record_groups = t->wall_base / sim->block, per_chunk = p->chunk / sim->block;
    TRY(store_write(sim, t->work[0], 0, 4 * (uint64_t)p->blocks, p->last, why));
    TRY(table_do(sim, "table_releases", record_groups, sim->block, why, "mmmmii", t->owner[t->now], t->other[t->now], t->work[0], t->match,
                 t->pair_count, record_groups));
    TRY(table_flush(sim, why));
    TRY(store_read(sim, t->match, 0, 4 * (uint64_t)record_groups, p->release, why));
    for (int c = 0; c < p->chunks; c++) {
        int last = c;
        for (int g = c * per_chunk; g < smaller((c + 1) * per_chunk, record_groups); g++)
            last = p->release[g] > last ? p->release[g] : last;
        p->release[c] = last;
    }
    return STATUS_OK;
}

/* Every chunk takes the lowest place of its stream that no earlier chunk of it needs any more. */
static status choose_places(planning *p, failure *why)
{
    int32_t *until = malloc(sizeof *until * (size_t)p->chunks); /* of every place: the chunk after which it is free */
    if (!until)
        return fail(why, STATUS_ERROR, "out of memory");
    p->places = 0;
    for (int stream = 0; stream < p->streams; stream++) {
        int base = p->places;
        for (int c = stream_begin(p, stream); c < stream_begin(p, stream + 1); c++) {
            int place = base;
            while (place < p->places && until[place] >= c)
                place++;
            until[place] = p->release[c];
            p->place[c] = place;
            p->places = place + 1 > p->places ? place + 1 : p->places;
        }
    }
    free(until);
    return STATUS_OK;
}

/* ---- the plan ---- */

static void order_blocks(const planning *p)
{
    for (int b = 0; b < p->blocks; b++)
        p->begin[p->last[b] + 2]++;
    for (int c = 0; c <= p->chunks; c++)
        p->begin[c + 2] += p->begin[c + 1];
    for (int b = 0; b < p->blocks; b++)
        p->block[p->begin[p->last[b] + 1]++] = b;
}

static status add_blocks(step_plan *plan, const planning *p, int chunk, failure *why)
{
    for (int n = p->begin[chunk], end = n; n < p->begin[chunk + 1]; n = end) {
        while (end < p->begin[chunk + 1] && p->block[end] == p->block[n] + end - n)
            end++;
        TRY(add_piece(plan, false, p->block[n], end - n, 0, why));
    }
    return STATUS_OK;
}

/* Walls first: their records stand in no order that a block could wait for. */
static status add_pieces(simulation *sim, const planning *p, int wall_shift, failure *why)
{
    step_plan *plan = &sim->plan;
    clast_phases *phases = &plan->phases;
    int wall_group = sim->table.wall_base / sim->block, end = sim->table.record_count / sim->block, per_chunk = p->chunk / sim->block;
    order_blocks(p);
    TRY(add_piece(plan, true, wall_group, end - wall_group, wall_shift, why));
    add_shared_phase(plan, 0);
    for (int c = 0; c < p->chunks; c++) {
        int first = c * per_chunk, shift = plan->force_records > 0 ? (c - p->place[c]) * p->chunk : 0, stream = stream_of(p, c);
        if (c == stream_begin(p, stream))
            phases->stream[stream] = plan->count;
        TRY(add_piece(plan, true, first, smaller(per_chunk, wall_group - first), shift, why));
        TRY(add_blocks(plan, p, c, why));
    }
    phases->stream[p->streams] = plan->count;
    phases->phase[phases->count++] = (clast_phase){.streams = 1, .end = p->streams, .units = p->streams};
    TRY(add_blocks(plan, p, p->chunks, why));
    add_shared_phase(plan, phases->stream[p->streams]);
    return STATUS_OK;
}

/* Chunks share places where the particle stage reads nothing of a record but force, torque and heat: what else it reads stands with the record. */
static bool may_share_places(const simulation *sim)
{
    if (servo_live(sim))
        return false; /* they sum the forces on walls, record by record */
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
        for (int f = 0; sim->live.law[slot] && f < LAW_ARGUMENTS_MAX; f++) {
            const field *field = sim->live.law[slot]->particle_fields[f];
            if (field && field->extent == PER_RECORD && strcmp(field->name, field_torque.name) != 0 && field != &field_heat)
                return false;
        }
    return true;
}

/* Slots that lead to the places of the forces instead of the records. */
static status place_slots(simulation *sim, const planning *p, int wall_shift, failure *why)
{
    contact_table *t = &sim->table;
    int count = t->slot_count;
    if (t->placed_held < t->slot_capacity) {
        store_release(sim, &t->placed, 4 * (uint64_t)t->placed_held);
        TRY(store_buffer(sim, &t->placed, 4 * (uint64_t)t->slot_capacity, "the contact table", why));
        t->placed_held = t->slot_capacity;
    }
    TRY(store_write(sim, t->work[0], 0, 4 * (uint64_t)p->chunks, p->place, why));
    return table_do(sim, "table_place", count, sim->block, why, "mmmiiii", t->slots[t->now], t->work[0], t->placed, count, t->wall_base,
                    p->chunk, wall_shift);
}

static status plan_chunks(simulation *sim, planning *p, failure *why)
{
    step_plan *plan = &sim->plan;
    bool may_share = may_share_places(sim) && p->chunks >= 2 * p->streams;
    TRY(find_last_records(sim, p, why));
    wait_in_groups(p);
    if (may_share) {
        TRY(find_releases(sim, p, why));
        TRY(choose_places(p, why));
    }
    int room = p->places * p->chunk, wall_base = sim->table.wall_base;
    bool pays = may_share && 2 * (int64_t)room <= wall_base;
    plan->chunk_records = p->chunk;
    plan->force_records = pays ? room : 0;
    TRY(add_pieces(sim, p, pays ? wall_base - room : 0, why));
    return pays ? place_slots(sim, p, wall_base - room, why) : STATUS_OK;
}

/* Streams take some 4 % off a step of a bed that fits the caches, and add to every table a look at its blocks, which the host waits for: a fifth of a
 * millisecond. Before anything is known of how long tables last, they may last for ever. */
static bool streams_pay(const simulation *sim)
{
    double steps = sim->loop.trials.table_steps;
    return steps <= 0.0 || steps * (double)sim->table.wall_base > STREAMS_PAY;
}

/* Several work-groups have a stream each; beds that fit the caches go in one chunk a stream. A chunk of a stream costs no launch, and may be smaller. */
static void choose_chunks(const simulation *sim, planning *p)
{
    int whole = sim->table.wall_base, members = step_loop_members(sim);
    p->chunk = chunk_records(sim);
    if (members > 1 && p->chunk > 0 && sim->scene->table.chunk_records == 0)
        p->chunk = p->chunk / STREAM_CHUNK_SHARE > sim->block ? p->chunk / STREAM_CHUNK_SHARE : sim->block;
    if (members > 1 && p->chunk == 0 && whole >= members * sim->block && streams_pay(sim))
        p->chunk = (whole + members - 1) / members + sim->block - 1;
    p->chunk -= p->chunk % sim->block;
    p->chunks = p->chunk > 0 ? (whole + p->chunk - 1) / p->chunk : 0;
    p->streams = members < p->chunks ? members : p->chunks;
}

static status plan_streams(simulation *sim, planning *of, failure *why)
{
    planning p = *of;
    p.together = p.chunk / CHUNK_PER_BLOCK > 1 && p.streams == 1 ? p.chunk / CHUNK_PER_BLOCK : 1;
    p.groups = (p.blocks + p.together - 1) / p.together;
    p.first = calloc(2 * (size_t)p.blocks + 1, sizeof *p.first);
    p.last = calloc((size_t)p.blocks + 1, sizeof *p.last);
    p.release = calloc((size_t)sim->table.wall_base / sim->block + 1, sizeof *p.release);
    p.place = calloc((size_t)p.chunks, sizeof *p.place);
    p.block = calloc((size_t)p.blocks + 1, sizeof *p.block);
    p.begin = calloc((size_t)p.chunks + 3, sizeof *p.begin);
    status result = p.first && p.last && p.release && p.place && p.block && p.begin ? plan_chunks(sim, &p, why) : fail(why, STATUS_ERROR, "out of memory");
    free(p.first);
    free(p.last);
    free(p.release);
    free(p.place);
    free(p.block);
    free(p.begin);
    return result;
}

/* What records give their grains, where it stands side by side, is found by 32 bits (kernels/stage/wrenches_together.cl). */
static status check_places(simulation *sim, failure *why)
{
    const contact_table *t = &sim->table;
    const stored_field *torque = store_find(sim, field_torque.name);
    int64_t places = sim->plan.force_records > 0 ? sim->plan.force_records + t->record_count - t->wall_base : t->record_count;
    if (!torque || torque->field->components == field_torque.components || places < UINT32_MAX / torque->field->components)
        return STATUS_OK;
    return fail(why, STATUS_ERROR,
                "%lld places of forces are more than steps by blocks can tell apart in mixed precision (%lld); take `precision: double` or `contact_table: {kernel_form: items}`",
                (long long)places, (long long)(UINT32_MAX / torque->field->components));
}

status step_plan_make(simulation *sim, failure *why)
{
    planning p = {.blocks = blocks_of(sim)};
    sim->plan.count = 0;
    sim->plan.phases.count = 0;
    choose_chunks(sim, &p);
    TRY(p.chunk == 0 ? plan_whole(sim, why) : plan_streams(sim, &p, why));
    return check_places(sim, why);
}

void step_plan_free(step_plan *plan)
{
    free(plan->piece);
    *plan = (step_plan){0};
}

/* ---- a step ---- */

static status enqueue_piece(const simulation *sim, cl_command_queue queue, const clast_piece *piece, clast_launch *launch, cl_event *event,
                            failure *why)
{
    const char *name = piece->pairs ? "pair_stage" : "particle_stage";
    cl_kernel kernel = launch_kernel(sim, name);
    size_t local = sim->live.blocks ? 1 : sim->block, share = sim->live.blocks ? (piece->pairs ? 1 : STEP_BLOCK_ITEMS) : sim->block;
    size_t items = (size_t)piece->count * share;
    cl_event watched;
    bool watch = sim->watch && !event;
    launch->first_group = piece->first;
    launch->force_shift = piece->force_shift;
    launch->first_wall_place = sim->plan.force_records > 0 ? sim->plan.force_records : sim->table.wall_base;
    TRY(launch_pass(kernel, name, launch, why));
    TRY_CL(clEnqueueNDRangeKernel(queue, kernel, 1, NULL, &items, &local, 0, NULL, watch ? &watched : event), name);
    if (watch)
        sim->watch->seen(sim->watch->context, name, kernel, (size_t)piece->count * (size_t)sim->block, watched);
    return STATUS_OK;
}

status step_plan_enqueue(const simulation *sim, cl_command_queue queue, clast_launch launch, cl_event *events, failure *why)
{
    for (int p = 0; p < sim->plan.count; p++)
        TRY(enqueue_piece(sim, queue, &sim->plan.piece[p], &launch, events ? &events[p] : NULL, why));
    return STATUS_OK;
}
