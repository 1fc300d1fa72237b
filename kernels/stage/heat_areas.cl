/* Area that touches each wall, for walls that give a prescribed flow of heat: one work-group a wall. */
__kernel __attribute__((reqd_work_group_size(CLAST_BLOCK, 1, 1))) void heat_areas(const clast_launch launch, __global const clast_control *restrict control,
                                                                                  __global clast_i64 *restrict areas, const int first,
                                                                                  const int end PAIR_DECLARE)
{
    __local clast_i64 part[CLAST_BLOCK];
    int wall = get_group_id(0), lane = get_local_id(0);
    clast_i64 sum = 0;
    for (int k = first + lane; k < end; k += CLAST_BLOCK) {
        contact c;
        wall_touch touch;
        if (WALL_HEAT_ROW(&launch, other[k])->wall != wall)
            continue;
        contact_of_wall(&launch, k, &c, &touch PAIR_PASS);
        sum += wall_heat_area(WALL_HEAT_ROW(&launch, other[k]), &c);
    }
    part[lane] = sum;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (lane == 0 && control->halt_step > launch.step) {
        clast_i64 all = 0;
        for (int n = 0; n < CLAST_BLOCK; n++)
            all += part[n];
        areas[wall] = all;
    }
}
