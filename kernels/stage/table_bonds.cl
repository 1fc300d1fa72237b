/* Bonds as the table sees them. Per chunk of records: bonds that they have had, and those that live now (the field `bonded` holds twice the
 * first, less one while the last lives, with a sign that does not matter here). */
__kernel void table_bond_sums(__global const real *restrict bonded, __global exact *restrict partial, const int pair_count,
                              const int wall_base, const int record_end)
{
    int chunk = get_global_id(0), first = chunk * SCAN_CHUNK, end = min(first + SCAN_CHUNK, record_end);
    int made = 0, alive = 0;
    for (int k = first; k < end; k++) {
        if (k >= pair_count && k < wall_base)
            continue; /* fills up a work-group */
        int count = (int)(fabs(bonded[k]) + R(0.5));
        made += (count + 1) / 2;
        alive += count % 2;
    }
    partial[2 * chunk] = precise_store(precise_from_int(made));
    partial[2 * chunk + 1] = precise_store(precise_from_int(alive));
}

/* ---- bonds that reach further than the table looks ---- */

/* New index of every grain by its old one; -1 (set before) for those that have left. */
INLINE void table_bond_inverse_unit(int i, const clast_launch *launch, __global const int *restrict order, __global int *restrict inverse)
{
    if (i < launch->particle_count)
        inverse[order[i]] = i;
}

__kernel void table_bond_inverse(const clast_launch launch, __global const int *restrict order, __global int *restrict inverse)
{
    table_bond_inverse_unit(get_global_id(0), &launch, order, inverse);
}

/* Calls TAKE(j) for every grain that i is bonded to, owns the pair with, and would not find. */
#define TABLE_FOR_BONDED(TAKE)                                                                                                \
    int old = order[i];                                                                                                       \
    uint old_end = old_slot_offset[old / CLAST_BLOCK + 1];                                                                    \
    for (uint s = old_slot_offset[old / CLAST_BLOCK] + old % CLAST_BLOCK; s < old_end; s += CLAST_BLOCK) {                    \
        int entry = old_slots[s], a = (entry > 0 ? entry : -entry) - 1;                                                       \
        if (entry == 0)                                                                                                       \
            break;                                                                                                            \
        if (a >= old_wall_base || (int)(fabs(bonded[a]) + R(0.5)) % 2 == 0)                                                   \
            continue;                                                                                                         \
        int j = inverse[entry > 0 ? old_other[a] : old_owner[a]];                                                             \
        if (j < 0)                                                                                                            \
            continue;                                                                                                         \
        if (table_owns(&g, j, radius, id) && !table_near(launch, skin, &g, j, position, radius)) {                           \
            TAKE(j);                                                                                                          \
        }                                                                                                                     \
    }

/* Adds them to what each grain finds and to its slots, and to the partners that are `kept` where there is room. */
INLINE void table_bond_count_unit(int i, const clast_launch *launch, __global const clast_grid *restrict grid,
                                  __global const exact *restrict position, __global const exact *restrict radius, __global const int *restrict id,
                                  __global const int *restrict order, __global const int *restrict inverse, __global const int *restrict old_owner,
                                  __global const int *restrict old_other, __global const uint *restrict old_slot_offset,
                                  __global const int *restrict old_slots, __global const real *restrict bonded, __global uint *restrict found_count,
                                  __global uint *restrict slot_count, __global int *restrict kept, const int room, const int old_wall_base)
{
    if (i >= launch->particle_count)
        return;
    table_grain g = table_grain_of(i, position, radius, id);
    real skin = number(grid->skin);
    uint found = found_count[i], before = found;
#define TABLE_COUNT_BONDED(j)                                   \
    if (found < (uint)room)                                     \
        kept[(size_t)i * room + found] = j;                     \
    found++;                                                    \
    atomic_inc((volatile __global uint *)&slot_count[j])
    TABLE_FOR_BONDED(TABLE_COUNT_BONDED)
    found_count[i] = found;
    atomic_add((volatile __global uint *)&slot_count[i], found - before);
}

__kernel void table_bond_count(const clast_launch launch, __global const clast_grid *restrict grid, __global const exact *restrict position,
                               __global const exact *restrict radius, __global const int *restrict id, __global const int *restrict order,
                               __global const int *restrict inverse, __global const int *restrict old_owner, __global const int *restrict old_other,
                               __global const uint *restrict old_slot_offset, __global const int *restrict old_slots,
                               __global const real *restrict bonded, __global uint *restrict found_count, __global uint *restrict slot_count,
                               __global int *restrict kept, const int room, const int old_wall_base)
{
    table_bond_count_unit(get_global_id(0), &launch, grid, position, radius, id, order, inverse, old_owner, old_other, old_slot_offset, old_slots,
                          bonded, found_count, slot_count, kept, room, old_wall_base);
}

/* Grains whose partners were not all kept have been searched for again: theirs are put where they belong among what was found. */
INLINE void table_bond_fill_unit(int i, const clast_launch *launch, __global const clast_grid *restrict grid,
                                 __global const exact *restrict position, __global const exact *restrict radius, __global const int *restrict id,
                                 __global const int *restrict order, __global const int *restrict inverse, __global const int *restrict old_owner,
                                 __global const int *restrict old_other, __global const uint *restrict old_slot_offset,
                                 __global const int *restrict old_slots, __global const real *restrict bonded,
                                 __global const uint *restrict found_start, __global int *restrict owner, __global int *restrict other,
                                 const int room, const int old_wall_base)
{
    if (i >= launch->particle_count || (int)(found_start[i + 1] - found_start[i]) <= room)
        return;
    table_grain g = table_grain_of(i, position, radius, id);
    real skin = number(grid->skin);
    uint extra = 0;
#define TABLE_TALLY_BONDED(j) extra++
    {
        TABLE_FOR_BONDED(TABLE_TALLY_BONDED)
    }
    uint first = found_start[i], k = found_start[i + 1] - extra;
#define TABLE_WRITE_BONDED(j) table_insert(i, j, true, first, k++, id, owner, other)
    {
        TABLE_FOR_BONDED(TABLE_WRITE_BONDED)
    }
}

__kernel void table_bond_fill(const clast_launch launch, __global const clast_grid *restrict grid, __global const exact *restrict position,
                              __global const exact *restrict radius, __global const int *restrict id, __global const int *restrict order,
                              __global const int *restrict inverse, __global const int *restrict old_owner, __global const int *restrict old_other,
                              __global const uint *restrict old_slot_offset, __global const int *restrict old_slots,
                              __global const real *restrict bonded, __global const uint *restrict found_start, __global int *restrict owner,
                              __global int *restrict other, const int room, const int old_wall_base)
{
    table_bond_fill_unit(get_global_id(0), &launch, grid, position, radius, id, order, inverse, old_owner, old_other, old_slot_offset, old_slots,
                         bonded, found_start, owner, other, room, old_wall_base);
}

#define TABLE_BOND_PHASES                                                                                                                        \
    TABLE_PHASE(table_bond_inverse, launch, READ(0, int), WRITE(1, int))                                                                         \
    TABLE_PHASE(table_bond_count, launch, READ(0, clast_grid), READ(1, exact), READ(2, exact), READ(3, int), READ(4, int), READ(5, int),         \
                READ(6, int), READ(7, int), READ(8, uint), READ(9, int), READ(10, real), WRITE(11, uint), WRITE(12, uint), WRITE(13, int),       \
                (int)n0, (int)n1)                                                                                                                \
    TABLE_PHASE(table_bond_fill, launch, READ(0, clast_grid), READ(1, exact), READ(2, exact), READ(3, int), READ(4, int), READ(5, int),          \
                READ(6, int), READ(7, int), READ(8, uint), READ(9, int), READ(10, real), READ(11, uint), WRITE(12, int), WRITE(13, int),         \
                (int)n0, (int)n1)
