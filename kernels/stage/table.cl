/* Builds the contact table: sorts the grains by cell, finds the pairs, gives every grain its slots, and carries histories over.
 * The smaller grain owns a pair (ties: the smaller permanent id), so a grain looks for partners in its own level of the grid and in
 * coarser ones only. Slots are sorted by the partner's permanent id, walls last, so that sums do not depend on the order in memory. */

INLINE int table_wrap(real t, int cells)
{
    real c = floor(t);
    c = c - (real)cells * floor(c / (real)cells);
    return c >= R(0.0) && c < (real)cells ? (int)c : 0;
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

INLINE int table_cell(__global const clast_grid *grid, int level, vec3 x)
{
    __global const clast_level *l = grid->level + level;
    int cx = table_wrap((x.x - number(grid->origin[0])) * number(l->inverse_size[0]), l->cells[0]);
    int cy = table_wrap((x.y - number(grid->origin[1])) * number(l->inverse_size[1]), l->cells[1]);
    int cz = table_wrap((x.z - number(grid->origin[2])) * number(l->inverse_size[2]), l->cells[2]);
    return l->first_cell + (cz * l->cells[1] + cy) * l->cells[0] + cx;
}

/* Cell and rank in it of every grain; what is outside a domain that drops its leavers goes to the last bucket. */
__kernel void table_bin(const clast_launch launch, __global const clast_grid *restrict grid, __global const exact *restrict position,
                        __global const exact *restrict radius, __global uint *restrict cell_of, __global uint *restrict rank_of,
                        __global uint *restrict cell_count)
{
    int i = get_global_id(0);
    if (i >= launch.particle_count)
        return;
    vec3 x = GRAIN3(position, i);
    int cell = table_cell(grid, table_level(grid, GRAIN_RADIUS(i)), x);
    vec3 low = from3(launch.low), high = from3(launch.high);
    bool inside = x.x >= low.x && x.x <= high.x && x.y >= low.y && x.y <= high.y && x.z >= low.z && x.z <= high.z;
    if (grid->drop_outside && !inside)
        cell = grid->cell_count;
    cell_of[i] = cell;
    rank_of[i] = atomic_inc((volatile __global uint *)&cell_count[cell]);
}

__kernel void table_order(const clast_launch launch, __global const uint *restrict cell_of, __global const uint *restrict rank_of,
                          __global const uint *restrict cell_start, __global int *restrict order)
{
    int i = get_global_id(0);
    if (i < launch.particle_count)
        order[cell_start[cell_of[i]] + rank_of[i]] = i;
}

/* The order within a cell depends on nothing but the permanent ids. */
__kernel void table_order_cells(__global const uint *restrict cell_start, __global const int *restrict id, __global int *restrict order, const int cells)
{
    int cell = get_global_id(0);
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

__kernel void table_permute_exact(const clast_launch launch, __global const int *restrict order, __global const exact *restrict from,
                                  __global exact *restrict to, const int components)
{
    int i = get_global_id(0);
    if (i >= launch.particle_count)
        return;
    size_t old = (size_t)order[i] * components, now = (size_t)i * components;
    for (int c = 0; c < components; c++)
        to[now + c] = from[old + c];
}

__kernel void table_permute_real(const clast_launch launch, __global const int *restrict order, __global const real *restrict from,
                                 __global real *restrict to, const int components)
{
    int i = get_global_id(0);
    if (i >= launch.particle_count)
        return;
    size_t old = (size_t)order[i] * components, now = (size_t)i * components;
    for (int c = 0; c < components; c++)
        to[now + c] = from[old + c];
}

__kernel void table_permute_int(const clast_launch launch, __global const int *restrict order, __global const int *restrict from,
                                __global int *restrict to)
{
    int i = get_global_id(0);
    if (i < launch.particle_count)
        to[i] = from[order[i]];
}

/* True where i owns the pair with j and the two are within reach. */
INLINE bool table_pairs(const clast_launch *launch, real skin, int i, precise3 place, precise radius_i, int id_i, int j, __global const exact *restrict position,
                        __global const exact *restrict radius, __global const int *restrict id)
{
    precise radius_j = precise_load(radius[j]);
    vec3 d = apart_vector(periodic_nearest(launch, apart_of(PRECISE_GRAIN3(position, j), place)));
    real reach = rounded(radius_i) + rounded(radius_j) + skin;
    bool owns = precise_less(radius_i, radius_j) || (!precise_less(radius_j, radius_i) && id[j] > id_i);
    return j != i && owns && dot3(d, d) < reach * reach;
}

/* Calls TAKE(j) for every grain that i pairs with, level by level and cell by cell. */
#define TABLE_FOR_PARTNERS(TAKE)                                                                                              \
    for (int l = table_level(grid, ri); l >= 0; l--) {                                                                        \
        __global const clast_level *v = grid->level + l;                                                                      \
        int n0 = v->cells[0], n1 = v->cells[1], n2 = v->cells[2];                                                             \
        int cx = table_wrap((xi.x - number(grid->origin[0])) * number(v->inverse_size[0]), n0);                               \
        int cy = table_wrap((xi.y - number(grid->origin[1])) * number(v->inverse_size[1]), n1);                               \
        int cz = table_wrap((xi.z - number(grid->origin[2])) * number(v->inverse_size[2]), n2);                               \
        int w0 = min(n0, 3), w1 = min(n1, 3), w2 = min(n2, 3);                                                                \
        for (int z = 0; z < w2; z++) {                                                                                        \
            int kz = (cz + z + (w2 == 3 ? n2 - 1 : 0)) % n2;                                                                  \
            for (int y = 0; y < w1; y++) {                                                                                    \
                int ky = (cy + y + (w1 == 3 ? n1 - 1 : 0)) % n1, row = v->first_cell + (kz * n1 + ky) * n0;                   \
                bool whole = w0 == 3 && cx > 0 && cx < n0 - 1;                                                                \
                for (int x = 0; x < (whole ? 1 : w0); x++) {                                                                  \
                    int kx = whole ? cx - 1 : (cx + x + (w0 == 3 ? n0 - 1 : 0)) % n0;                                         \
                    uint end = cell_start[row + kx + (whole ? 3 : 1)];                                                        \
                    for (uint j = cell_start[row + kx]; j < end; j++)                                                         \
                        if (table_pairs(&launch, skin, i, place, radius_i, id_i, j, position, radius, id)) {                           \
                            TAKE(j);                                                                                          \
                        }                                                                                                     \
                }                                                                                                             \
            }                                                                                                                 \
        }                                                                                                                     \
    }

/* Pairs owned by each grain, and slots each grain needs. slot_count must be zero before. The first `room` partners of each grain are `kept`, so
 * that most grains need not be searched for twice. */
__kernel void table_count(const clast_launch launch, __global const clast_grid *restrict grid, __global const uint *restrict cell_start,
                          __global const exact *restrict position, __global const exact *restrict radius, __global const int *restrict id,
                          __global uint *restrict own_count, __global uint *restrict slot_count, __global int *restrict kept, const int room)
{
    int i = get_global_id(0);
    if (i >= launch.particle_count) {
        own_count[i] = 0;
        return;
    }
    precise3 place = PRECISE_GRAIN3(position, i);
    precise radius_i = precise_load(radius[i]);
    vec3 xi = rounded3(place);
    real ri = rounded(radius_i), skin = number(grid->skin);
    int id_i = id[i];
    uint found = 0;
#define TABLE_COUNT(j)                                          \
    if (found < (uint)room)                                     \
        kept[(size_t)i * room + found] = j;                     \
    found++;                                                    \
    atomic_inc((volatile __global uint *)&slot_count[j])
    TABLE_FOR_PARTNERS(TABLE_COUNT)
    own_count[i] = found;
    atomic_add((volatile __global uint *)&slot_count[i], found);
}

/* Writes the pairs of each grain, sorted by the partner's permanent id. */
__kernel void table_fill(const clast_launch launch, __global const clast_grid *restrict grid, __global const uint *restrict cell_start,
                         __global const exact *restrict position, __global const exact *restrict radius, __global const int *restrict id,
                         __global const uint *restrict own_start, __global int *restrict owner, __global int *restrict other,
                         __global const int *restrict kept, const int room)
{
    int i = get_global_id(0);
    if (i >= launch.particle_count)
        return;
    precise3 place = PRECISE_GRAIN3(position, i);
    precise radius_i = precise_load(radius[i]);
    vec3 xi = rounded3(place);
    real ri = rounded(radius_i), skin = number(grid->skin);
    int id_i = id[i];
    uint first = own_start[i], k = first;
#define TABLE_WRITE(j)                                              \
    uint at = k++;                                                  \
    for (; at > first && id[other[at - 1]] > id[j]; at--)           \
        other[at] = other[at - 1];                                  \
    other[at] = j
    int count = (int)(own_start[i + 1] - first);
    if (count <= room) {
        for (int m = 0; m < count; m++) {
            int j = kept[(size_t)i * room + m];
            TABLE_WRITE(j);
        }
    } else {
        TABLE_FOR_PARTNERS(TABLE_WRITE)
    }
    for (uint a = first; a < k; a++)
        owner[a] = i;
}

/* Records that fill up a work-group name grain 0 twice. */
__kernel void table_pad(__global int *restrict owner, __global int *restrict other, const int first, const int end)
{
    int k = first + (int)get_global_id(0);
    if (k < end) {
        owner[k] = 0;
        other[k] = 0;
    }
}

/* Slots of a block: as many rows as its fullest grain needs. */
__kernel void table_widths(__global const uint *restrict slot_count, __global uint *restrict width)
{
    int block = get_global_id(0);
    uint most = 0;
    for (int n = 0; n < CLAST_BLOCK; n++)
        most = max(most, slot_count[block * CLAST_BLOCK + n]);
    width[block] = most * CLAST_BLOCK;
}

__kernel void table_slots(__global const int *restrict owner, __global const int *restrict other, __global const uint *restrict slot_offset,
                          __global uint *restrict cursor, __global int *restrict slots, const int pair_count, const int wall_base,
                          const int record_count)
{
    int k = get_global_id(0);
    if (k >= record_count || (k >= pair_count && k < wall_base))
        return;
    int i = owner[k];
    uint row = atomic_inc((volatile __global uint *)&cursor[i]);
    slots[slot_offset[i / CLAST_BLOCK] + row * CLAST_BLOCK + i % CLAST_BLOCK] = k + 1;
    if (k >= pair_count)
        return;
    int j = other[k];
    row = atomic_inc((volatile __global uint *)&cursor[j]);
    slots[slot_offset[j / CLAST_BLOCK] + row * CLAST_BLOCK + j % CLAST_BLOCK] = -(k + 1);
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

__kernel void table_sort_slots(const clast_launch launch, __global const int *restrict owner, __global const int *restrict other,
                               __global const int *restrict id, __global const uint *restrict slot_offset,
                               __global const uint *restrict slot_count, __global int *restrict slots, const int wall_base)
{
    int i = get_global_id(0);
    if (i >= launch.particle_count)
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

/* Of every block the last record of a pair that its grains take part in; -1: none. */
__kernel void table_last_records(__global const uint *restrict slot_offset, __global const int *restrict slots, __global int *restrict last_record,
                                 const int wall_base, const int blocks)
{
    int block = get_global_id(0);
    if (block >= blocks)
        return;
    int last = -1;
    for (uint s = slot_offset[block]; s < slot_offset[block + 1]; s++) {
        int k = abs(slots[s]) - 1;
        last = k < wall_base ? max(last, k) : last;
    }
    last_record[block] = last;
}

/* Of every work-group of records the latest that a grain of theirs waits for, in terms of what `wait` says of its block. */
__kernel void table_releases(__global const int *restrict owner, __global const int *restrict other, __global const int *restrict wait,
                             __global int *restrict release, const int pair_count, const int groups)
{
    int group = get_global_id(0);
    if (group >= groups)
        return;
    int latest = 0;
    for (int k = group * CLAST_BLOCK; k < min(group * CLAST_BLOCK + CLAST_BLOCK, pair_count); k++)
        latest = max(latest, max(wait[owner[k] / CLAST_BLOCK], wait[other[k] / CLAST_BLOCK]));
    release[group] = latest;
}

/* Slots with the places of forces for those of records: chunks of records stand where `place` says, wall records behind all chunks. */
__kernel void table_place(__global const int *restrict slots, __global const int *restrict place, __global int *restrict placed, const int count,
                          const int wall_base, const int chunk, const int wall_shift)
{
    int s = get_global_id(0);
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

/* For every new record the old one of the same two partners: index + 1, negative where the pair has changed its owner, 0 where there was
 * none. `order` leads from new to old indices. */
__kernel void table_match(__global const int *restrict owner, __global const int *restrict other, __global const int *restrict order,
                          __global const int *restrict old_owner, __global const int *restrict old_other,
                          __global const uint *restrict old_slot_offset, __global const int *restrict old_slots, __global int *restrict match,
                          const int pair_count, const int wall_base, const int record_count, const int old_wall_base)
{
    int k = get_global_id(0);
    if (k >= record_count)
        return;
    match[k] = 0;
    if (k >= pair_count && k < wall_base)
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

/* Moves a history, whose components stand `stride` apart in each buffer; `odd` ones change sign with the owner. */
__kernel void table_carry(__global const int *restrict match, __global const real *restrict from, __global real *restrict to, const long from_stride,
                          const long to_stride, const int record_count, const int components, const int odd)
{
    int k = get_global_id(0);
    if (k >= record_count)
        return;
    int m = match[k], old = (m > 0 ? m : -m) - 1;
    for (int c = 0; c < components; c++) {
        real value = m == 0 ? R(0.0) : AT(from, from_stride, c, old);
        AT(to, to_stride, c, k) = odd && m < 0 ? -value : value;
    }
}

/* Per chunk of grains the square of the largest displacement since the table was built, relative to the common one. */
__kernel void table_travel(const clast_launch launch, __global const exact *restrict position, __global const exact *restrict built_position,
                           __global exact *restrict partial)
{
    int chunk = get_global_id(0), first = chunk * SCAN_CHUNK, end = min(first + SCAN_CHUNK, launch.particle_count);
    real most = R(0.0);
    for (int i = first; i < end; i++) {
        apart3 since_built = apart_less(apart_of(PRECISE_GRAIN3(position, i), PRECISE_GRAIN3(built_position, i)), PRECISE3(launch.drift));
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
