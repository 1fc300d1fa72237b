/* motion: grains of some groups are held or moved as prescribed. Such a grain counts as infinitely heavy. */
#define MOTION_PAIR_FIELDS(READ, WRITE) READ(int, mover)
#define MOTION_PARTICLE_FIELDS(READ, WRITE) READ(int, mover) READ(clast_mover, movers)
#define MOTION_ROW(launch) (movers + (launch)->mover_row * (launch)->mover_count)
#define MOTION_GRAIN(i) mover[i]

INLINE real motion_mass(int mover, real mass)
{
    return mover >= 0 ? R(1e30) : mass;
}

/* Two grains that are both moved as prescribed do not act on each other. */
INLINE real motion_overlap(int mover_i, int mover_j, real overlap)
{
    return mover_i >= 0 && mover_j >= 0 ? R(0.0) : overlap;
}

INLINE vec3 motion_position(__global const clast_mover *movers, int mover, vec3 free, vec3 start)
{
    if (mover < 0)
        return free;
    clast_mover m = movers[mover];
    vec3 axis = from3(m.axis), arm = sub(start, from3(m.pivot));
    vec3 swing = cross3(axis, arm);
    vec3 turned = add_scaled(scale((real)m.sine, swing), (real)m.versine, cross3(axis, swing));
    return add(add(start, turned), from3(m.shift));
}

INLINE vec3 motion_velocity(__global const clast_mover *movers, int mover, vec3 free, vec3 x)
{
    if (mover < 0)
        return free;
    clast_mover m = movers[mover];
    return add(from3(m.velocity), cross3(from3(m.spin), sub(x, from3(m.pivot_end))));
}

INLINE vec3 motion_spin(__global const clast_mover *movers, int mover, vec3 free)
{
    if (mover < 0)
        return free;
    clast_mover m = movers[mover];
    return from3(m.spin);
}
