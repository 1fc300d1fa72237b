/* What the kernels of a table do, a list of them in one launch: a phase for each by the function that the kernel calls too, and meetings of a team
 * (team.cl) in place of launches. Each member takes the same part of the grains in every phase, and has them in its caches. The host makes the list
 * (host/table_phases.c) in the order in which it would launch the kernels. */

/* Bits of a number, whatever its type. */
INLINE void table_set_unit(int w, __global uint *restrict to, const uint value)
{
    to[w] = value;
}

INLINE void table_copy_unit(int w, __global const uint *restrict from, __global uint *restrict to)
{
    to[w] = from[w];
}

/* Argument m of a phase; by their order in the kernel's own signature. */
#define READ(m, type) ((__global const type *)a##m)
#define WRITE(m, type) ((__global type *)a##m)
#define TABLE_PHASE(name, ...)            \
    case CLAST_KIND_##name:               \
        for (int i = from; i < to; i++)   \
            name##_unit(i, __VA_ARGS__);  \
        break;
/* Few phases have them all. */
#define TABLE_MEMORY(place)                                       \
    __global uint *const a##place = memory[phase->memory[place]]; \
    (void)a##place;
#define TABLE_NUMBER(place) const long n##place = phase->number[place];

/* Work-items from..to of a phase, which others may be `shared` with. */
OUTLINE void table_part(__global const clast_table_phase *phase, __global uint *const *memory, const clast_launch *given, bool shared, int from,
                        int to)
{
    const clast_launch own = *given, *launch = &own;
    CLAST_TABLE_EACH_ARGUMENT(TABLE_MEMORY)
    CLAST_TABLE_EACH_NUMBER(TABLE_NUMBER)
    switch (phase->kind) {
        TABLE_PHASE(table_set, WRITE(0, uint), (uint)n0)
        TABLE_PHASE(table_copy, READ(0, uint), WRITE(1, uint))
    case CLAST_KIND_scan_whole:
        scan_whole_unit(READ(0, uint), WRITE(1, uint), (int)n0);
        break;
        TABLE_PHASE(scan_chunks, READ(0, uint), WRITE(1, uint), (int)n0)
    case CLAST_KIND_scan_sums:
        scan_sums_unit(WRITE(0, uint), (int)n0);
        break;
        TABLE_PHASE(scan_write, READ(0, uint), READ(1, uint), WRITE(2, uint), (int)n0)
        TABLE_PHASE(table_bin, shared, launch, READ(0, clast_grid), READ(1, exact), READ(2, exact), WRITE(3, uint), WRITE(4, uint), WRITE(5, uint))
        TABLE_PHASE(table_order, launch, READ(0, uint), READ(1, uint), READ(2, uint), WRITE(3, int))
        TABLE_PHASE(table_order_cells, READ(0, uint), READ(1, int), WRITE(2, int), (int)n0)
        TABLE_PHASE(table_permute, launch, READ(0, int), READ(1, uint), WRITE(2, uint), (int)n0)
        TABLE_PHASE(table_count, shared, launch, READ(0, clast_grid), READ(1, uint), READ(2, exact), READ(3, exact), READ(4, int), WRITE(5, uint), WRITE(6, uint),
                    WRITE(7, int), (int)n0)
        TABLE_PHASE(table_fill, launch, READ(0, clast_grid), READ(1, uint), READ(2, exact), READ(3, exact), READ(4, int), READ(5, uint), WRITE(6, int),
                    WRITE(7, int), READ(8, int), (int)n0)
        TABLE_PHASE(table_pad, WRITE(0, int), WRITE(1, int), (int)n0, (int)n1, (int)n2, (int)n3)
        TABLE_PHASE(table_widths, READ(0, uint), WRITE(1, uint))
    case CLAST_KIND_table_totals:
        table_totals_unit(READ(0, uint), READ(1, uint), READ(2, uint), WRITE(3, uint), (int)n0, (int)n1);
        break;
        TABLE_PHASE(table_slots, shared, READ(0, int), READ(1, int), READ(2, uint), WRITE(3, uint), WRITE(4, int), (int)n0, (int)n1, (int)n2)
        TABLE_PHASE(table_sort_slots, launch, READ(0, int), READ(1, int), READ(2, int), READ(3, uint), READ(4, uint), WRITE(5, int), (int)n0)
        TABLE_PHASE(table_match, READ(0, int), READ(1, int), READ(2, int), READ(3, int), READ(4, int), READ(5, uint), READ(6, int), WRITE(7, int), (int)n0,
                    (int)n1, (int)n2, (int)n3, (int)n4)
        TABLE_PHASE(table_carry, READ(0, int), READ(1, real), WRITE(2, real), n0, n1, (int)n2, (int)n3, (int)n4)
        TABLE_PHASE(table_last_records, READ(0, uint), READ(1, int), WRITE(2, int), (int)n0, (int)n1)
        TABLE_PHASE(table_releases, READ(0, int), READ(1, int), READ(2, int), WRITE(3, int), (int)n0, (int)n1)
        TABLE_PHASE(table_place, READ(0, int), READ(1, int), WRITE(2, int), (int)n0, (int)n1, (int)n2, (int)n3)
        TABLE_WALL_PHASES
        TABLE_BOND_PHASES
    }
}

#define TABLE_DECLARE(place) , __global uint *memory_##place
#define TABLE_NAME(place) memory_##place,

/* The one phase `only` instead of all, where it is not -1. */
__kernel void table_phases(const clast_launch launch, __global clast_table_list *list, const int count, const int team_most,
                           const int only CLAST_TABLE_EACH_MEMORY(TABLE_DECLARE))
{
    __global uint *const memory[CLAST_TABLE_MEMORIES + 1] = {CLAST_TABLE_EACH_MEMORY(TABLE_NAME)(__global uint *) & list->grid};
    __global clast_team *team = &list->team;
    team_member me;
    if (!team_join(team, team_most, only, &me))
        return;
    int end = only < 0 ? count : only + 1;
    while (me.meetings < end) {
        __global const clast_table_phase *phase = list->phase + me.meetings;
        int of = me.place, unit;
        while ((unit = team_next(team, &me, &of, (phase->items + phase->unit_items - 1) / phase->unit_items)) >= 0)
            table_part(phase, memory, &launch, only >= 0 || me.size > 1, unit * phase->unit_items, min((unit + 1) * phase->unit_items, phase->items));
        team_meet(team, team_most, &me);
    }
    team_leave(team);
}
