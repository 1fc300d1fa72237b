/* Rows of one of the two grains of a record from its fields. Numbers that are wanted with all their bits take EXACT_REALS rows. */
/* Blocks by which grains are asked for before their records: half a dozen lines a grain would not stay in the first cache. */
#define GRAINS_AHEAD 3
#define ROW_POSITION 0
#define ROW_RADIUS (3 * EXACT_REALS)
#define ROW_MASS (ROW_RADIUS + EXACT_REALS)
#define ROW_VELOCITY (ROW_MASS + 1)
#define ROW_SPIN (ROW_VELOCITY + 3)
#define ROW_PAST (ROW_SPIN + ROTATION_ROWS)
#define ROW_TEMPERATURE (ROW_PAST + INTEGRATOR_ROWS)
#define ROWS_OF_GRAIN (ROW_TEMPERATURE + TEMPERATURE_ROWS)

/* All that may be wanted of grain i. */
INLINE void grain_ask_for(size_t i PAIR_DECLARE)
{
    ASK_FOR(position + 3 * i);
    ASK_FOR(velocity + 3 * i);
    ASK_FOR(radius + i);
    ASK_FOR(mass + i);
    ROTATION_ASK_FOR(i);
    INTEGRATOR_ASK_FOR(i);
    TEMPERATURE_ASK_FOR(i);
}

/* Of the grains `which` of a block of records on one side what tells whether they may touch; `all`: the rest is wanted in any case. */
INLINE void rows_fill_places(__global const int *which, const bool all, real *to PAIR_DECLARE)
{
    (void)all;
    __global const ulong *radii = (__global const ulong *)radius;
    for (int lane = 0; lane < CLAST_BLOCK; lane += 4) {
        int4 i = vload4(0, which + lane);
        rows_exact_polar3(position, i, ROW(to + lane, ROW_POSITION));
        row_exact((ulong4)(radii[i.s0], radii[i.s1], radii[i.s2], radii[i.s3]), ROW(to + lane, ROW_RADIUS), CLAST_BLOCK);
    }
}

/* The rest of ROWS_FILLED of them. */
#define ROWS_FILLED 4
INLINE void rows_fill_rest(__global const int *which, const bool all, real *to PAIR_DECLARE)
{
    (void)all;
    int4 i = vload4(0, which);
    vstore4((real4)(mass[i.s0], mass[i.s1], mass[i.s2], mass[i.s3]), 0, ROW(to, ROW_MASS));
    rows_polar3(velocity, i, ROW(to, ROW_VELOCITY));
    ROTATION_ROWS_FILL(i, ROW(to, ROW_SPIN));
    INTEGRATOR_ROWS_FILL(i, ROW(to, ROW_PAST));
    TEMPERATURE_ROWS_FILL(i, ROW(to, ROW_TEMPERATURE));
}

/* Nothing of a grain is kept twice. */
INLINE void grains_pack(int first, int count PARTICLE_DECLARE)
{
    (void)first;
    (void)count;
}
