/* Builds the contact table: sorts the grains by cell, finds the pairs, gives every grain its slots, and carries histories over.
 * A grain looks for partners in the cells behind it, and in those around it of coarser levels of the grid; pairs stand in the order of the grains that find
 * them, so that all pairs of a grain stand near it, and none behind those that it finds itself but at a periodic border (docs/performance.md). The
 * smaller grain owns a pair (ties: the smaller permanent id), and slots are sorted by the partner's permanent id, walls last: neither who a record
 * names first nor any sum depends on the order in memory. */

/* What is counted by several at a time, or by one alone: an atomic operation takes some ten times as long. The value before. */
INLINE uint table_add(bool shared, __global uint *count, uint more)
{
    if (shared)
        return atomic_add((volatile __global uint *)count, more);
    uint before = *count;
    *count = before + more;
    return before;
}

/* The cell along one direction, beyond the last one the first again. In whole numbers: pocl's floor() and a division take longer than all the rest. */
INLINE int table_wrap(real t, int cells)
{
    if (!is_number(t))
        return 0;
    if (t >= R(0.0) && t < (real)cells)
        return (int)t;
    if (!(fabs(t) < R(1e9)))
        return 0;
    int c = (int)t, rest = (c - ((real)c > t ? 1 : 0)) % cells;
    return rest < 0 ? rest + cells : rest;
}

INLINE int table_level(__global const clast_grid *grid, real r)
{
    int level = 0;
    real size = number(grid->radius_max) * R(0.5);
    while (level + 1 < grid->level_count && r <= size) {
        level++;
        size *= R(0.5);
    }
    return level;
}

/* The place of a grain among the cells of a level. */
typedef struct table_spot {
    int x, y, z;
} table_spot;

INLINE table_spot table_spot_of(__global const clast_grid *grid, int level, vec3 x)
{
    __global const clast_level *v = grid->level + level;
    table_spot spot;
    spot.x = table_wrap((x.x - number(grid->origin[0])) * number(v->inverse_size[0]), v->cells[0]);
    spot.y = table_wrap((x.y - number(grid->origin[1])) * number(v->inverse_size[1]), v->cells[1]);
    spot.z = table_wrap((x.z - number(grid->origin[2])) * number(v->inverse_size[2]), v->cells[2]);
    return spot;
}

INLINE int table_cell(__global const clast_grid *grid, int level, vec3 x)
{
    __global const clast_level *v = grid->level + level;
    table_spot spot = table_spot_of(grid, level, x);
    return v->first_cell + (spot.z * v->cells[1] + spot.y) * v->cells[0] + spot.x;
}

/* Cell and rank in it of every grain; what is outside a domain that drops its leavers goes to the last bucket. */
INLINE void table_bin_unit(int i, bool shared, const clast_launch *launch, __global const clast_grid *restrict grid, __global const exact *restrict position,
                           __global const exact *restrict radius, __global uint *restrict cell_of, __global uint *restrict rank_of,
                           __global uint *restrict cell_count)
{
    if (i >= launch->particle_count)
        return;
    vec3 x = GRAIN_POLAR3(position, i);
    int cell = table_cell(grid, table_level(grid, GRAIN_RADIUS(i)), x);
    vec3 low = from3(launch->low), high = from3(launch->high);
    bool inside = x.x >= low.x && x.x <= high.x && x.y >= low.y && x.y <= high.y && x.z >= low.z && x.z <= high.z;
    if (grid->drop_outside && !inside)
        cell = grid->cell_count;
    cell_of[i] = cell;
    rank_of[i] = table_add(shared, &cell_count[cell], 1);
}

__kernel void table_bin(const clast_launch launch, __global const clast_grid *restrict grid, __global const exact *restrict position,
                        __global const exact *restrict radius, __global uint *restrict cell_of, __global uint *restrict rank_of,
                        __global uint *restrict cell_count)
{
    table_bin_unit(get_global_id(0), true, &launch, grid, position, radius, cell_of, rank_of, cell_count);
}

INLINE void table_order_unit(int i, const clast_launch *launch, __global const uint *restrict cell_of, __global const uint *restrict rank_of,
                             __global const uint *restrict cell_start, __global int *restrict order)
{
    if (i < launch->particle_count)
        order[cell_start[cell_of[i]] + rank_of[i]] = i;
}

__kernel void table_order(const clast_launch launch, __global const uint *restrict cell_of, __global const uint *restrict rank_of,
                          __global const uint *restrict cell_start, __global int *restrict order)
{
    table_order_unit(get_global_id(0), &launch, cell_of, rank_of, cell_start, order);
}

/* The order within a cell depends on nothing but the permanent ids. */
INLINE void table_order_cells_unit(int cell, __global const uint *restrict cell_start, __global const int *restrict id,
                                   __global int *restrict order, const int cells)
{
    if (cell >= cells)
        return;
    uint first = cell_start[cell], end = cell_start[cell + 1];
    for (uint a = first + 1; a < end; a++) {
        int moved = order[a];
        uint b = a;
        for (; b > first && id[order[b - 1]] > id[moved]; b--)
            order[b] = order[b - 1];
        order[b] = moved;
    }
}

__kernel void table_order_cells(__global const uint *restrict cell_start, __global const int *restrict id, __global int *restrict order,
                                const int cells)
{
    table_order_cells_unit(get_global_id(0), cell_start, id, order, cells);
}

/* A field in the new order, whatever its type: `words` of 32 bits a grain. */
INLINE void table_permute_unit(int i, const clast_launch *launch, __global const int *restrict order, __global const uint *restrict from,
                               __global uint *restrict to, const int words)
{
    if (i >= launch->particle_count)
        return;
    size_t old = (size_t)order[i] * words, now = (size_t)i * words;
    if (words == 6) /* three numbers, as most have: a loop of known length */
        for (int w = 0; w < 6; w++)
            to[now + w] = from[old + w];
    else
        for (int w = 0; w < words; w++)
            to[now + w] = from[old + w];
}

__kernel void table_permute(const clast_launch launch, __global const int *restrict order, __global const uint *restrict from,
                            __global uint *restrict to, const int words)
{
    table_permute_unit(get_global_id(0), &launch, order, from, to, words);
}

/* A grain as others look for it. */
typedef struct table_grain {
    precise3 place;
    precise radius;
    int id;
} table_grain;

INLINE table_grain table_grain_of(int i, __global const exact *restrict position, __global const exact *restrict radius, __global const int *restrict id)
{
    table_grain g;
    g.place = PRECISE_GRAIN_POLAR3(position, i);
    g.radius = precise_load(radius[i]);
    g.id = id[i];
    return g;
}

/* True where the two are within reach; the same from either side. */
INLINE bool table_near(const clast_launch *launch, real skin, const table_grain *g, int j, __global const exact *restrict position,
                       __global const exact *restrict radius)
{
    vec3 d = apart_vector(periodic_nearest(launch, apart_of(PRECISE_GRAIN_POLAR3(position, j), g->place)));
    real reach = rounded(g->radius) + rounded(precise_load(radius[j])) + skin;
    return dot3(d, d) < reach * reach;
}

/* True where the grain owns its pair with j. */
INLINE bool table_owns(const table_grain *g, int j, __global const exact *restrict radius, __global const int *restrict id)
{
    precise radius_j = precise_load(radius[j]);
    return precise_less(g->radius, radius_j) || (!precise_less(radius_j, g->radius) && id[j] > g->id);
}

/* Cells beside a border are those at the other one; a division would cost more than the rest of a row. */
INLINE int table_beside(int c, int cells)
{
    return c < 0 ? c + cells : c >= cells ? c - cells : c;
}

/* Calls TAKE(j) for the grains in `count` cells of a row from x on. Neighbours along x stand one after the other, but for those beyond the border. */
#define TABLE_ROW(row, x, count, cells, TAKE)                                          \
    for (int at_x = table_beside(x, cells), left = (count); left > 0; at_x = 0) {      \
        int run = min(left, (cells)-at_x);                                             \
        uint last = cell_start[(row) + at_x + run];                                    \
        left -= run;                                                                   \
        for (uint j = cell_start[(row) + at_x]; j < last; j++) {                       \
            TAKE(j);                                                                   \
        }                                                                              \
    }

/* For the grains in the cell at `spot` and in all beside it. */
#define TABLE_AROUND(v, spot, TAKE)                                                                                         \
    {                                                                                                                       \
        int n0 = (v)->cells[0], n1 = (v)->cells[1], n2 = (v)->cells[2], w0 = min(n0, 3), w1 = min(n1, 3), w2 = min(n2, 3); \
        for (int z = 0; z < w2; z++)                                                                                        \
            for (int y = 0; y < w1; y++) {                                                                                  \
                int ky = table_beside((spot).y + y - (w1 == 3), n1), kz = table_beside((spot).z + z - (w2 == 3), n2);       \
                TABLE_ROW((v)->first_cell + (kz * n1 + ky) * n0, (spot).x - (w0 == 3), w0, n0, TAKE)                        \
            }                                                                                                               \
    }

/* For the grains that i finds, and perhaps some that are not near: of two grains of a level the first comes upon the second, so that a pair is seen once. */
#define TABLE_BEHIND(TAKE)                                                                                                            \
    {                                                                                                                                 \
        int own_level = table_level(grid, rounded(g.radius));                                                                         \
        for (int l = own_level; l >= 0; l--) {                                                                                        \
            __global const clast_level *v = grid->level + l;                                                                          \
            table_spot spot = table_spot_of(grid, l, rounded3(g.place));                                                              \
            int n0 = v->cells[0], n1 = v->cells[1], n2 = v->cells[2];                                                                 \
            bool within = l == own_level, few = min(n0, n1) < 3 || n2 == 2; /* few: cells before it are cells behind it too */        \
            if (!within || few)                                                                                                       \
                TABLE_AROUND(v, spot, if (!within || (int)(j) > i) TAKE)                                                              \
            else {                                                                                                                    \
                int y = table_beside(spot.y + 1, n1), z = table_beside(spot.z + 1, n2), row = v->first_cell + (spot.z * n1 + spot.y) * n0; \
                uint last = cell_start[row + min(spot.x + 2, n0)]; /* the rest of its own cell, and the next */                       \
                for (uint j = i + 1; j < last; j++) {                                                                                 \
                    TAKE(j)                                                                                                           \
                }                                                                                                                     \
                if (spot.x == n0 - 1)                                                                                                 \
                    TABLE_ROW(row, 0, 1, n0, TAKE)                                                                                    \
                TABLE_ROW(v->first_cell + (spot.z * n1 + y) * n0, spot.x - 1, 3, n0, TAKE)                                            \
                for (int side = n2 > 1 ? -1 : 2; side <= 1; side++) /* of a bed of one layer of cells there is no other */            \
                    TABLE_ROW(v->first_cell + (z * n1 + table_beside(spot.y + side, n1)) * n0, spot.x - 1, 3, n0, TAKE)               \
            }                                                                                                                         \
        }                                                                                                                             \
    }

/* Grains within reach of one, before they are counted. Whether the next one is near cannot be foretold: it is put down in any case, and stays if it is. */
#define TABLE_NEAR_ROOM 32

/* Takes note of grains that are `near`: of their slots, and where there is room of themselves. How many of i's there are then. */
OUTLINE int table_count_near(int i, bool shared, const int *near, int count, int before, __global uint *restrict slot_count, __global int *restrict kept,
                             int room)
{
    for (int n = 0; n < count; n++) {
        if (before + n < room)
            kept[(size_t)i * room + before + n] = near[n];
        table_add(shared, &slot_count[near[n]], 1);
    }
    return before + count;
}

/* Pairs that each grain finds, and slots each grain needs, whose counts must be zero before. The first `room` partners of each grain are `kept`,
 * in any order, so that most grains need not be searched for twice. */
INLINE void table_count_unit(int i, bool shared, const clast_launch *launch, __global const clast_grid *restrict grid,
                           __global const uint *restrict cell_start, __global const exact *restrict position,
                           __global const exact *restrict radius, __global const int *restrict id, __global uint *restrict found_count,
                           __global uint *restrict slot_count, __global int *restrict kept, const int room)
{
    if (i >= launch->particle_count)
        return;
    table_grain g = table_grain_of(i, position, radius, id);
    real skin = number(grid->skin);
    int near[TABLE_NEAR_ROOM], count = 0, before = 0;
#define TABLE_MEET(j)                                                                           \
    {                                                                                           \
        near[count] = (int)(j);                                                                 \
        count += table_near(launch, skin, &g, j, position, radius) ? 1 : 0;                     \
        if (count == TABLE_NEAR_ROOM) {                                                         \
            before = table_count_near(i, shared, near, count, before, slot_count, kept, room);  \
            count = 0;                                                                          \
        }                                                                                       \
    }
    TABLE_BEHIND(TABLE_MEET)
    before = table_count_near(i, shared, near, count, before, slot_count, kept, room);
    found_count[i] = (uint)before;
    table_add(shared, &slot_count[i], (uint)before);
}

__kernel void table_count(const clast_launch launch, __global const clast_grid *restrict grid, __global const uint *restrict cell_start,
                          __global const exact *restrict position, __global const exact *restrict radius, __global const int *restrict id,
                          __global uint *restrict found_count, __global uint *restrict slot_count, __global int *restrict kept,
                          const int room)
{
    table_count_unit(get_global_id(0), true, &launch, grid, cell_start, position, radius, id, found_count, slot_count, kept, room);
}

/* The partner of i in a record that it is one of. */
INLINE int table_partner_of(int i, uint k, __global const int *restrict owner, __global const int *restrict other)
{
    return owner[k] == i ? other[k] : owner[k];
}

/* Puts the pair of i and j among those that i has found, first..end, by the partner's permanent id. */
INLINE void table_insert(int i, int j, bool owns, uint first, uint end, __global const int *restrict id, __global int *restrict owner,
                         __global int *restrict other)
{
    for (; end > first && id[table_partner_of(i, end - 1, owner, other)] > id[j]; end--) {
        owner[end] = owner[end - 1];
        other[end] = other[end - 1];
    }
    owner[end] = owns ? i : j;
    other[end] = owns ? j : i;
}

/* Writes the pairs that each grain finds, sorted by the partner's permanent id. */
INLINE void table_fill_unit(int i, const clast_launch *launch, __global const clast_grid *restrict grid,
                          __global const uint *restrict cell_start, __global const exact *restrict position,
                          __global const exact *restrict radius, __global const int *restrict id, __global const uint *restrict found_start,
                          __global int *restrict owner, __global int *restrict other, __global const int *restrict kept, const int room)
{
    if (i >= launch->particle_count)
        return;
    table_grain g = table_grain_of(i, position, radius, id);
    real skin = number(grid->skin);
    uint first = found_start[i], k = first;
    int count = (int)(found_start[i + 1] - first);
#define TABLE_WRITE(j) table_insert(i, j, table_owns(&g, j, radius, id), first, k++, id, owner, other)
#define TABLE_WRITE_NEAR(j)                                       \
    {                                                             \
        if (table_near(launch, skin, &g, j, position, radius))    \
            TABLE_WRITE(j);                                       \
    }
    if (count <= room) {
        for (int m = 0; m < count; m++)
            TABLE_WRITE(kept[(size_t)i * room + m]);
    } else
        TABLE_BEHIND(TABLE_WRITE_NEAR)
}

__kernel void table_fill(const clast_launch launch, __global const clast_grid *restrict grid, __global const uint *restrict cell_start,
                         __global const exact *restrict position, __global const exact *restrict radius, __global const int *restrict id,
                         __global const uint *restrict found_start, __global int *restrict owner, __global int *restrict other,
                         __global const int *restrict kept, const int room)
{
    table_fill_unit(get_global_id(0), &launch, grid, cell_start, position, radius, id, found_start, owner, other, kept, room);
}

/* Records that fill up a work-group, behind the pairs and behind the walls, name grain 0 twice. */
INLINE void table_pad_unit(int place, __global int *restrict owner, __global int *restrict other, const int pair_end, const int wall_base,
                           const int wall_end, const int record_count)
{
    int k = pair_end + place;
    k = k < wall_base ? k : wall_end + k - wall_base;
    if (k < record_count) {
        owner[k] = 0;
        other[k] = 0;
    }
}

__kernel void table_pad(__global int *restrict owner, __global int *restrict other, const int pair_end, const int wall_base, const int wall_end,
                        const int record_count)
{
    table_pad_unit(get_global_id(0), owner, other, pair_end, wall_base, wall_end, record_count);
}

/* Slots of a block: as many rows as its fullest grain needs. */
INLINE void table_widths_unit(int block, __global const uint *restrict slot_count, __global uint *restrict width)
{
    uint most = 0;
    for (int n = 0; n < CLAST_BLOCK; n++)
        most = max(most, slot_count[block * CLAST_BLOCK + n]);
    width[block] = most * CLAST_BLOCK;
}

__kernel void table_widths(__global const uint *restrict slot_count, __global uint *restrict width)
{
    table_widths_unit(get_global_id(0), slot_count, width);
}

INLINE void table_slots_unit(int k, bool shared, __global const int *restrict owner, __global const int *restrict other,
                             __global const uint *restrict slot_offset, __global uint *restrict cursor, __global int *restrict slots,
                             const int pair_count, const int wall_base, const int record_count)
{
    if (k >= record_count || (k >= pair_count && k < wall_base))
        return;
    int i = owner[k];
    uint row = table_add(shared, &cursor[i], 1);
    slots[slot_offset[i / CLAST_BLOCK] + row * CLAST_BLOCK + i % CLAST_BLOCK] = k + 1;
    if (k >= pair_count)
        return;
    int j = other[k];
    row = table_add(shared, &cursor[j], 1);
    slots[slot_offset[j / CLAST_BLOCK] + row * CLAST_BLOCK + j % CLAST_BLOCK] = -(k + 1);
}

__kernel void table_slots(__global const int *restrict owner, __global const int *restrict other, __global const uint *restrict slot_offset,
                          __global uint *restrict cursor, __global int *restrict slots, const int pair_count, const int wall_base,
                          const int record_count)
{
    table_slots_unit(get_global_id(0), true, owner, other, slot_offset, cursor, slots, pair_count, wall_base, record_count);
}

/* What a slot is sorted by: the partner's permanent id; faces of walls after all grains. */
INLINE long table_partner(int entry, int wall_base, __global const int *restrict owner, __global const int *restrict other,
                          __global const int *restrict id)
{
    int k = (entry > 0 ? entry : -entry) - 1;
    if (k >= wall_base)
        return (1L << 32) + other[k];
    return id[entry > 0 ? other[k] : owner[k]];
}

INLINE void table_sort_slots_unit(int i, const clast_launch *launch, __global const int *restrict owner, __global const int *restrict other,
                                __global const int *restrict id, __global const uint *restrict slot_offset,
                                __global const uint *restrict slot_count, __global int *restrict slots, const int wall_base)
{
    if (i >= launch->particle_count)
        return;
    uint base = slot_offset[i / CLAST_BLOCK] + i % CLAST_BLOCK;
    for (uint a = 1; a < slot_count[i]; a++) {
        int moved = slots[base + a * CLAST_BLOCK];
        long key = table_partner(moved, wall_base, owner, other, id);
        uint b = a;
        for (; b > 0 && table_partner(slots[base + (b - 1) * CLAST_BLOCK], wall_base, owner, other, id) > key; b--)
            slots[base + b * CLAST_BLOCK] = slots[base + (b - 1) * CLAST_BLOCK];
        slots[base + b * CLAST_BLOCK] = moved;
    }
}

__kernel void table_sort_slots(const clast_launch launch, __global const int *restrict owner, __global const int *restrict other,
                               __global const int *restrict id, __global const uint *restrict slot_offset,
                               __global const uint *restrict slot_count, __global int *restrict slots, const int wall_base)
{
    table_sort_slots_unit(get_global_id(0), &launch, owner, other, id, slot_offset, slot_count, slots, wall_base);
}

/* Of every block the first and the last record of a pair that its grains take part in, side by side; wall_base and -1: none. */
INLINE void table_last_records_unit(int block, __global const uint *restrict slot_offset, __global const int *restrict slots,
                                    __global int *restrict ends, const int wall_base, const int blocks)
{
    if (block >= blocks)
        return;
    int first = wall_base, last = -1;
    for (uint s = slot_offset[block]; s < slot_offset[block + 1]; s++) {
        int k = abs(slots[s]) - 1;
        bool pair = k >= 0 && k < wall_base;
        first = pair ? min(first, k) : first;
        last = pair ? max(last, k) : last;
    }
    ends[2 * block] = first;
    ends[2 * block + 1] = last;
}

__kernel void table_last_records(__global const uint *restrict slot_offset, __global const int *restrict slots, __global int *restrict ends,
                                 const int wall_base, const int blocks)
{
    table_last_records_unit(get_global_id(0), slot_offset, slots, ends, wall_base, blocks);
}

/* Of every work-group of records the latest that a grain of theirs waits for, in terms of what `wait` says of its block. */
INLINE void table_releases_unit(int group, __global const int *restrict owner, __global const int *restrict other,
                                __global const int *restrict wait, __global int *restrict release, const int pair_count, const int groups)
{
    if (group >= groups)
        return;
    int latest = 0;
    for (int k = group * CLAST_BLOCK; k < min(group * CLAST_BLOCK + CLAST_BLOCK, pair_count); k++)
        latest = max(latest, max(wait[owner[k] / CLAST_BLOCK], wait[other[k] / CLAST_BLOCK]));
    release[group] = latest;
}

__kernel void table_releases(__global const int *restrict owner, __global const int *restrict other, __global const int *restrict wait,
                             __global int *restrict release, const int pair_count, const int groups)
{
    table_releases_unit(get_global_id(0), owner, other, wait, release, pair_count, groups);
}

/* Slots with the places of forces for those of records: chunks of records stand where `place` says, wall records behind all chunks. */
INLINE void table_place_unit(int s, __global const int *restrict slots, __global const int *restrict place, __global int *restrict placed,
                             const int count, const int wall_base, const int chunk, const int wall_shift)
{
    if (s >= count)
        return;
    int entry = slots[s], k = abs(entry) - 1;
    if (entry == 0)
        placed[s] = 0;
    else {
        int at = 1 + (k < wall_base ? place[k / chunk] * chunk + k % chunk : k - wall_shift);
        placed[s] = entry > 0 ? at : -at;
    }
}

__kernel void table_place(__global const int *restrict slots, __global const int *restrict place, __global int *restrict placed, const int count,
                          const int wall_base, const int chunk, const int wall_shift)
{
    table_place_unit(get_global_id(0), slots, place, placed, count, wall_base, chunk, wall_shift);
}

/* For every new record the old one of the same two partners: index + 1, negative where the pair has changed its owner, 0 where there was
 * none. `order` leads from new to old indices. */
INLINE void table_match_unit(int k, __global const int *restrict owner, __global const int *restrict other, __global const int *restrict order,
                             __global const int *restrict old_owner, __global const int *restrict old_other,
                             __global const uint *restrict old_slot_offset, __global const int *restrict old_slots, __global int *restrict match,
                             const int pair_count, const int wall_base, const int wall_end, const int record_count, const int old_wall_base)
{
    if (k >= record_count)
        return;
    match[k] = 0;
    if ((k >= pair_count && k < wall_base) || k >= wall_end)
        return;
    bool wall = k >= wall_base;
    int i = order[owner[k]], wanted = wall ? other[k] : order[other[k]];
    uint first = old_slot_offset[i / CLAST_BLOCK], end = old_slot_offset[i / CLAST_BLOCK + 1];
    for (uint s = first + i % CLAST_BLOCK; s < end; s += CLAST_BLOCK) {
        int entry = old_slots[s];
        if (entry == 0)
            return;
        int a = (entry > 0 ? entry : -entry) - 1;
        if ((a >= old_wall_base) != wall)
            continue;
        int partner = entry > 0 ? old_other[a] : old_owner[a];
        if (partner == wanted) {
            match[k] = entry;
            return;
        }
    }
}

__kernel void table_match(__global const int *restrict owner, __global const int *restrict other, __global const int *restrict order,
                          __global const int *restrict old_owner, __global const int *restrict old_other,
                          __global const uint *restrict old_slot_offset, __global const int *restrict old_slots, __global int *restrict match,
                          const int pair_count, const int wall_base, const int wall_end, const int record_count, const int old_wall_base)
{
    table_match_unit(get_global_id(0), owner, other, order, old_owner, old_other, old_slot_offset, old_slots, match, pair_count, wall_base,
                     wall_end, record_count, old_wall_base);
}

/* Moves a history, whose components stand `stride` apart in each buffer; `odd` ones change sign with the owner. */
INLINE void table_carry_unit(int k, __global const int *restrict match, __global const real *restrict from, __global real *restrict to,
                             const long from_stride, const long to_stride, const int record_count, const int components, const int odd)
{
    if (k >= record_count)
        return;
    int m = match[k], old = (m > 0 ? m : -m) - 1;
    for (int c = 0; c < components; c++) {
        real value = m == 0 ? R(0.0) : AT(from, from_stride, c, old);
        AT(to, to_stride, c, k) = odd && m < 0 ? -value : value;
    }
}

__kernel void table_carry(__global const int *restrict match, __global const real *restrict from, __global real *restrict to,
                          const long from_stride, const long to_stride, const int record_count, const int components, const int odd)
{
    table_carry_unit(get_global_id(0), match, from, to, from_stride, to_stride, record_count, components, odd);
}

/* Per chunk of grains the square of the largest displacement since the table was built, relative to the common one. */
__kernel void table_travel(const clast_launch launch, __global const exact *restrict position, __global const exact *restrict built_position,
                           __global exact *restrict partial)
{
    int chunk = get_global_id(0), first = chunk * SCAN_CHUNK, end = min(first + SCAN_CHUNK, launch.particle_count);
    real most = R(0.0);
    for (int i = first; i < end; i++) {
        apart3 since_built = apart_less(apart_of(PRECISE_GRAIN_POLAR3(position, i), PRECISE_GRAIN_POLAR3(built_position, i)), PRECISE_POLAR3(launch.drift));
        vec3 moved = apart_vector(periodic_nearest(&launch, since_built));
        most = fmax(most, dot3(moved, moved));
    }
    partial[chunk] = precise_store(precise_from(most));
}

/* Index of every permanent id; -1 (set before) where the grain has left. */
__kernel void table_where(const clast_launch launch, __global const int *restrict id, __global int *restrict where)
{
    int i = get_global_id(0);
    if (i < launch.particle_count)
        where[id[i]] = i;
}

/* What the host waits for of a table: pairs, records of walls and slots, side by side. */
INLINE void table_totals_unit(__global const uint *restrict found_start, __global const uint *restrict wall_start, __global const uint *restrict slot_offset,
                              __global uint *restrict totals, const int grains, const int blocks)
{
    totals[0] = found_start[grains];
    totals[1] = wall_start[grains];
    totals[2] = slot_offset[blocks];
}

__kernel void table_totals(__global const uint *restrict found_start, __global const uint *restrict wall_start, __global const uint *restrict slot_offset,
                           __global uint *restrict totals, const int grains, const int blocks)
{
    table_totals_unit(found_start, wall_start, slot_offset, totals, grains, blocks);
}
