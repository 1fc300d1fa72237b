/* The two stages with a record or a grain to a work-item: the form for GPUs. Its twin is by_blocks.cl, and both give the same bits. */

/* A kernel that calls one(launch, k, wall) for every record; walls have work-groups of their own. */
#define RECORD_KERNEL(name, one)                                                                   \
    __kernel void name(const clast_launch launch PAIR_DECLARE)                                     \
    {                                                                                              \
        one(&launch, get_global_id(0), (int)get_group_id(0) >= launch.first_wall_group PAIR_PASS); \
    }

__kernel void pair_stage(const clast_launch launch, __global const clast_control *restrict control PAIR_DECLARE)
{
    if (control->halt_step <= launch.step)
        return;
    int group = launch.first_group + (int)get_group_id(0), k = CLAST_BLOCK * group + (int)get_local_id(0);
    if (group < launch.first_wall_group)
        pair_of_grains(&launch, k PAIR_PASS);
    else
        pair_of_wall(&launch, k PAIR_PASS);
}

/* The grain at a place in a block. */
INLINE void particle_item(const clast_launch *launch, __global clast_control *control, int block, int lane PARTICLE_DECLARE)
{
    vec3 f, t;
    grain_heat h;
    moving m;
    particle_gather(launch, block, lane, &f, &t, &h PARTICLE_PASS);
    moving_load(launch, CLAST_BLOCK * block + lane, &m PARTICLE_PASS);
    if (particle_step(launch, CLAST_BLOCK * block + lane, &m, f, t, &h PARTICLE_PASS))
        particle_halt(launch, control);
}

__kernel void particle_stage(const clast_launch launch, __global clast_control *restrict control PARTICLE_DECLARE)
{
    if (control->halt_step <= launch.step)
        return;
    particle_item(&launch, control, launch.first_group + (int)get_group_id(0), get_local_id(0) PARTICLE_PASS);
}

/* ---- a team: the work-items of one work-group ---- */

typedef struct team_member {
    int place, meetings, taken;
} team_member;

INLINE bool team_join(__global clast_team *team, int most, int only, team_member *me)
{
    me->place = (int)get_local_id(0);
    me->meetings = me->taken = 0;
    return true;
}

/* They have met behind every piece. */
#define team_meet(team, most, me)         \
    do {                                  \
        (me)->meetings++;                 \
        (me)->taken = 0;                  \
    } while (0)
#define team_leave(team)

/* All of them take all of a phase. */
INLINE int team_next(__global clast_team *team, team_member *me, int *of, int count)
{
    return me->taken++ == 0 ? 0 : -1;
}

#define PIECE_UNITS(piece) ((piece).count)
/* Units from..to of pieces first..end, as a member takes them. */
typedef struct team_share {
    int first, end, from, to;
} team_share;

INLINE team_share team_share_of(__global const clast_phases *phases, __global const clast_piece *pieces, int phase, int unit)
{
    __global const clast_phase *of = &phases->phase[phase];
    team_share share;
    share.first = of->streams ? phases->stream[of->first] : of->first;
    share.end = of->streams ? phases->stream[of->end] : of->end;
    share.from = 0;
    share.to = INT_MAX;
    return share;
}

INLINE void team_pairs(const team_member *me, const clast_launch *launch, const clast_launch *for_walls, int from, int to PAIR_DECLARE)
{
    int end = CLAST_BLOCK * (launch->first_group + to), walls = min(end, CLAST_BLOCK * launch->first_wall_group);
    int k = CLAST_BLOCK * (launch->first_group + from) + me->place;
    for (; k < walls; k += LOOP_ITEMS)
        pair_of_grains(launch, k PAIR_PASS);
    for (; k < end; k += LOOP_ITEMS)
        pair_of_wall(for_walls, k PAIR_PASS);
    barrier(CLK_GLOBAL_MEM_FENCE);
}

INLINE void team_grains(const team_member *me, const clast_launch *launch, __global clast_control *control, int from, int to PARTICLE_DECLARE)
{
    for (int i = CLAST_BLOCK * from + me->place; i < CLAST_BLOCK * to; i += LOOP_ITEMS)
        particle_item(launch, control, launch->first_group + i / CLAST_BLOCK, i % CLAST_BLOCK PARTICLE_PASS);
    barrier(CLK_GLOBAL_MEM_FENCE);
}
