/* The two stages with a record or a grain to a work-item: the form for GPUs. Its twin is by_blocks.cl, and both give the same bits. */

/* Records of pairs in a loop: work-item `me` of `items` takes its share. */
INLINE void pair_sweep(const clast_launch *launch, int me, int items, int records PAIR_DECLARE)
{
#pragma clang loop vectorize(assume_safety)
    for (int k = me; k < records; k += items)
        pair_of_grains(launch, k PAIR_PASS);
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

INLINE void particle_sweep(const clast_launch *launch, __global clast_control *control, int me, int items, int grains PARTICLE_DECLARE)
{
    for (int i = me; i < grains; i += items)
        particle_item(launch, control, i / CLAST_BLOCK, i % CLAST_BLOCK PARTICLE_PASS);
}

__kernel void particle_stage(const clast_launch launch, __global clast_control *restrict control PARTICLE_DECLARE)
{
    if (control->halt_step <= launch.step)
        return;
    particle_item(&launch, control, launch.first_group + (int)get_group_id(0), get_local_id(0) PARTICLE_PASS);
}
