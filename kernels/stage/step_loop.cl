/* Many steps in one work-group, for beds so small that launches would cost more than the work: both stages by the bodies that the two kernels
 * run, barriers between them. The group has LOOP_ITEMS work-items. On a CPU that is one (pocl does not vectorise between barriers that stand in a
 * loop); on a GPU they fill a multiprocessor. Halts exactly as the two kernels do. */
/* A stage's arguments under names of its own: what both stages use stands twice in the signature, and neither sees the other's. */
#define DECLARE_LOOP_PAIR(type, name) , __global type *pair_##name
#define DECLARE_LOOP_PARTICLE(type, name) , __global type *particle_##name
#define PASS_LOOP_PAIR(type, name) , pair_##name
#define PASS_LOOP_PARTICLE(type, name) , particle_##name

__kernel void step_loop(__global const clast_launch *restrict launches, __global clast_control *control, const int steps, const int records,
                        const int wall_base PAIR_FIELDS(DECLARE_LOOP_PAIR, DECLARE_LOOP_PAIR)
                            PARTICLE_FIELDS(DECLARE_LOOP_PARTICLE, DECLARE_LOOP_PARTICLE))
{
    int me = LOOP_ITEMS > 1 ? (int)get_local_id(0) : 0;
    for (int s = 0; s < steps && control->halt_step > s; s++) {
        const clast_launch launch = launches[s];
        pair_sweep(&launch, me, LOOP_ITEMS, wall_base PAIR_FIELDS(PASS_LOOP_PAIR, PASS_LOOP_PAIR));
        const clast_launch for_walls = launches[s];
        for (int k = wall_base + me; k < records; k += LOOP_ITEMS)
            pair_of_wall(&for_walls, k PAIR_FIELDS(PASS_LOOP_PAIR, PASS_LOOP_PAIR));
        barrier(CLK_GLOBAL_MEM_FENCE);
        particle_sweep(&launch, control, me, LOOP_ITEMS, launch.particle_count PARTICLE_FIELDS(PASS_LOOP_PARTICLE, PASS_LOOP_PARTICLE));
        barrier(CLK_GLOBAL_MEM_FENCE);
    }
}
