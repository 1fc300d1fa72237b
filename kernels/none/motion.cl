/* motion: every grain is free. */
#define MOTION_PAIR_FIELDS(READ, WRITE)
#define MOTION_PARTICLE_FIELDS(READ, WRITE)
#define MOTION_ROW(launch) ((__global const clast_mover *)0)
#define MOTION_GRAIN(i) (-1)

INLINE real motion_mass(int mover, real mass)
{
    (void)mover;
    return mass;
}

INLINE real motion_overlap(int mover_i, int mover_j, real overlap)
{
    (void)mover_i;
    (void)mover_j;
    return overlap;
}

INLINE precise3 motion_position(__global const clast_mover *movers, int mover, precise3 free, precise3 start)
{
    (void)movers;
    (void)mover;
    (void)start;
    return free;
}

INLINE precise3 motion_velocity(__global const clast_mover *movers, int mover, precise3 free, precise3 x)
{
    (void)movers;
    (void)mover;
    (void)x;
    return free;
}

INLINE precise3 motion_spin(__global const clast_mover *movers, int mover, precise3 free)
{
    (void)movers;
    (void)mover;
    return free;
}
