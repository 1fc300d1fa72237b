/* What records give their two bodies, in mixed precision and three dimensions, side by side: in 8 numbers or 12 (effect/wrench_of_8.cl, wrench_of_12.cl). So the
 * sum over a grain's slots reads a line of a cache a record instead of six, and takes a third of the operations, without a branch that nobody could foretell
 * (docs/performance.md). The pair stage makes rows, as many as numbers, and turns sixteen records of them at a time.
 *
 * The record at place p stands at p + 1 in the array of torques, which observers write as they would without, and steps write anew. The place before is
 * nobody's: it is 0, and what an empty slot leads to. Sums are those of wrenches_apart.cl to the bit. */
#define WRENCH_DECLARE , real *wrenches
#define WRENCH_PASS , wrenches
#define WRENCH_ROWS real wrenches[WRENCH_NUMBERS * CLAST_BLOCK]
#define WRENCHES_STORE(place, kind) wrenches_store(torque + WRENCH_NUMBERS * ((size_t)(place) + 1), wrenches, kind)
#define WRENCH_OF_NOBODY wrench_clear(torque)

INLINE void wrench_clear(__global real *to)
{
    for (int n = 0; n < WRENCH_NUMBERS; n++)
        to[n] = R(0.0);
}

/* Four rows of sixteen records, so that number n of record 4 q + m stands at n in quarter q of the mth result. */
#define FOUR_ROWS(m0, m1, m2, m3, n)                                                                                                 \
    float16 m0, m1, m2, m3;                                                                                                          \
    do {                                                                                                                             \
        float16 a = vload16(0, ROW(from, n)), b = vload16(0, ROW(from, (n) + 1)), c = vload16(0, ROW(from, (n) + 2)), d = vload16(0, ROW(from, (n) + WRENCH_FOURTH)); \
        QUARTERS_TURNED(m0, m1, m2, m3, a, b, c, d);                                                                                 \
    } while (0)
INLINE void wrenches_turn(__global real *to, const real *from)
{
    FOUR_ROWS(f0, f1, f2, f3, 0);
    FOUR_ROWS(t0, t1, t2, t3, 4);
    WRENCH_LAST_ROWS;
    /* records 4 q to 4 q + 3, whose quarters have that name */
    WRENCHES_OF_QUARTER(0, s0123);
    WRENCHES_OF_QUARTER(1, s4567);
    WRENCHES_OF_QUARTER(2, s89ab);
    WRENCHES_OF_QUARTER(3, scdef);
}

/* A block of records to its place. `kind`: of every lot; NULL: none is quiet. Of those that are zeros stand there, and are written once more where
 * others share their sixteen. */
INLINE void wrenches_store(__global real *to, real *rows, const int *kind)
{
    for (int lane = 0; lane < CLAST_BLOCK; lane += 16) {
        bool wanted = !kind;
        for (int k = lane; kind && k < lane + 16; k += LOT)
            wanted |= kind[k / LOT] != LOT_QUIET;
        for (int k = lane; kind && wanted && k < lane + 16; k++)
            for (int n = 0; n < WRENCH_NUMBERS && kind[k / LOT] == LOT_QUIET; n++)
                ROW_NUMBER(rows, n, k) = R(0.0);
        if (wanted)
            wrenches_turn(to + WRENCH_NUMBERS * lane, rows + lane);
    }
}

/* A record's share of what acts on a grain: its force with a sign, and the lever with the arm of the grain's side, or the torque on that side. */
INLINE float8 wrench_added(float8 sum, __global const real *wrench, float sign, __global const real *side)
{
#pragma OPENCL FP_CONTRACT OFF
    return sum + WRENCH_SHARE(wrench, sign, side);
}

/* Force and torque of eight grains, whose slots stand side by side, into rows. */
INLINE void eight_gather(const clast_launch *launch, int first, uint slot, uint end, real *to PARTICLE_DECLARE)
{
    float8 g0 = (float8)(0.0f), g1 = g0, g2 = g0, g3 = g0, g4 = g0, g5 = g0, g6 = g0, g7 = g0;
    uint places[8], sides[8];
    float signs[8];
    /* one by one from where they stand: taken out of a register they would cost two operations each */
    const volatile uint *place = places, *side = sides;
    const volatile float *sign = signs;
    bool some = false;
    for (int n = 0; n < 8; n++)
        some |= TOUCHED_TAKE(launch, first + n);
    for (; some && slot < end; slot += CLAST_BLOCK) {
        int8 entry = vload8(0, slots + slot), other = entry >> 31;
        uint8 at = WRENCH_NUMBERS * as_uint8((entry ^ other) - other);
        if (!any(entry != 0))
            break;
        vstore8(at, 0, places);
        vstore8(at + as_uint8(other & 4), 0, sides);
        vstore8(as_float8((other << 31) | 0x3f800000), 0, signs);
#define EIGHT_ADD(n) g##n = wrench_added(g##n, torque + place[n], sign[n], torque + side[n])
        EIGHT_ADD(0);
        EIGHT_ADD(1);
        EIGHT_ADD(2);
        EIGHT_ADD(3);
        EIGHT_ADD(4);
        EIGHT_ADD(5);
        EIGHT_ADD(6);
        EIGHT_ADD(7);
    }
    float16 n0, n1, n2, n3;
    (void)n3;
    QUARTERS_TURNED(n0, n1, n2, n3, (float16)(g0, g4), (float16)(g1, g5), (float16)(g2, g6), (float16)(g3, g7));
    vstore8((float8)(n0.s0123, n0.s89ab), 0, ROW(to, ROW_FORCE));
    vstore8((float8)(n1.s0123, n1.s89ab), 0, ROW(to, ROW_FORCE + 1));
    vstore8((float8)(n2.s0123, n2.s89ab), 0, ROW(to, ROW_FORCE + 2));
    vstore8((float8)(n0.s4567, n0.scdef), 0, ROW(to, ROW_TORQUE));
    vstore8((float8)(n1.s4567, n1.scdef), 0, ROW(to, ROW_TORQUE + 1));
    vstore8((float8)(n2.s4567, n2.scdef), 0, ROW(to, ROW_TORQUE + 2));
}

/* Force and torque of a unit of grains into rows. */
INLINE void grains_gather(const clast_launch *launch, int first, real *rows PARTICLE_DECLARE)
{
    uint slot = slot_offset[first / CLAST_BLOCK] + first % CLAST_BLOCK, end = slot_offset[first / CLAST_BLOCK + 1];
    for (int lane = 0; lane < PARTICLE_LANES; lane += 8)
        eight_gather(launch, first + lane, slot + lane, end, rows + lane PARTICLE_PASS);
}
