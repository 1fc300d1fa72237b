/* motion: grains of some groups are held or moved as prescribed. Such a grain counts as infinitely heavy. */
#define MOTION_PAIR_FIELDS(READ, WRITE) READ(int, mover)
#define MOTION_PARTICLE_FIELDS(READ, WRITE) READ(int, mover) READ(clast_mover, movers)
#define MOTION_ROW(launch) (movers + (launch)->mover_row * (launch)->mover_count)
#define MOTION_GRAIN(i) mover[i]

INLINE real motion_mass(int mover, real mass)
{
    return mover >= 0 ? HEAVY : mass;
}

/* Two grains that are both moved as prescribed do not act on each other. */
INLINE real motion_overlap(int mover_i, int mover_j, real overlap)
{
    return mover_i >= 0 && mover_j >= 0 ? R(0.0) : overlap;
}

/* Turned about the axis of the motion and shifted, with all bits: what a step loses of its turn would add up to a lag behind the walls. */
INLINE precise3 motion_position(__global const clast_mover *movers, int mover, precise3 free, precise3 start)
{
    if (mover < 0)
        return free;
    clast_mover m = movers[mover];
    precise3 axis = PRECISE3(m.axis), swing = precise3_cross(axis, precise3_sub(start, PRECISE3(m.pivot)));
    precise3 turned = precise3_add(precise3_scale(precise_load(m.sine), swing), precise3_scale(precise_load(m.versine), precise3_cross(axis, swing)));
    return precise3_add(precise3_add(start, turned), PRECISE3(m.shift));
}

INLINE precise3 motion_velocity(__global const clast_mover *movers, int mover, precise3 free, precise3 x)
{
    if (mover < 0)
        return free;
    clast_mover m = movers[mover];
    vec3 arm = rounded3(precise3_sub(x, PRECISE3(m.pivot_end)));
    return precise3_from(add(from3(m.velocity), cross3(from3(m.spin), arm)));
}

INLINE precise3 motion_spin(__global const clast_mover *movers, int mover, precise3 free)
{
    if (mover < 0)
        return free;
    clast_mover m = movers[mover];
    return PRECISE3(m.spin);
}
