/* Rows: one number of a block of records or grains side by side, which vector code reads in order, made from grains that stand anywhere
 * (by_blocks.cl). Which arrays those of a pair come from, and in what order they stand, is told in rows_gathered.cl or rows_packed.cl. */
#define ROW(rows, n) ((rows) + (n) * CLAST_BLOCK)
#define ROW_NUMBER(rows, n, lane) (rows)[(n) * CLAST_BLOCK + (lane)]
#define ROW_POLAR3(rows, n, lane) v3(ROW_NUMBER(rows, n, lane), ROW_NUMBER(rows, (n) + 1, lane), SPACE_NUMBER(ROW_NUMBER(rows, (n) + 2, lane)))
#define ROW_AXIAL3(rows, n, lane) \
    v3(SPACE_NUMBER(ROW_NUMBER(rows, n, lane)), SPACE_NUMBER(ROW_NUMBER(rows, (n) + 1, lane)), ROW_NUMBER(rows, (n) + 2, lane))
#define ROW_PRECISE_POLAR3(rows, n, lane)                                                  \
    precise3_of(ROW_PRECISE(rows, n, lane), ROW_PRECISE(rows, (n) + EXACT_REALS, lane),     \
                SPACE_PRECISE(ROW_PRECISE(rows, (n) + 2 * EXACT_REALS, lane)))
#define ROW_PRECISE_AXIAL3(rows, n, lane)                                                                              \
    precise3_of(SPACE_PRECISE(ROW_PRECISE(rows, n, lane)), SPACE_PRECISE(ROW_PRECISE(rows, (n) + EXACT_REALS, lane)),   \
                ROW_PRECISE(rows, (n) + 2 * EXACT_REALS, lane))
#define ROW_SET_POLAR3(rows, n, lane, v)                      \
    do {                                                      \
        ROW_NUMBER(rows, n, lane) = (v).x;                    \
        ROW_NUMBER(rows, (n) + 1, lane) = (v).y;              \
        SPACE_STORE(ROW_NUMBER(rows, (n) + 2, lane) = (v).z); \
    } while (0)
#define ROW_SET_AXIAL3(rows, n, lane, v)                      \
    do {                                                      \
        SPACE_STORE(ROW_NUMBER(rows, n, lane) = (v).x);       \
        SPACE_STORE(ROW_NUMBER(rows, (n) + 1, lane) = (v).y); \
        ROW_NUMBER(rows, (n) + 2, lane) = (v).z;              \
    } while (0)

/* A lot: records that go through the laws together. In a loose bed most that stand in the table do not touch, and where none of a lot does, none needs
 * to (PAIRS_ACT_APART: some law acts on two apart, or sums over steps; host/live.c). */
#define LOT (LANES < 4 ? 4 : LANES)
#define LOTS (CLAST_BLOCK / LOT)
/* What is to be done with a lot. */
#define LOT_OF_PAIRS     1 /* two of it may touch, or nobody is to look: only then are the rest of its rows filled */
#define LOT_OF_STRANGERS 2
#define LOT_QUIET        3 /* strangers still, whose zeros stand there */
#define LOT_BIT(lot)     (1u << ((lot) % 32)) /* blocks of more lots have none that are quiet */

/* Rows of grains that move: what acts on them, and what moves of them with all its bits. */
#define ROW_FORCE 0
#define ROW_TORQUE 3
#define ROW_HEAT (ROW_TORQUE + ROTATION_ROWS)
#define ROW_PLACE (ROW_HEAT + CONDUCTION_ROWS)
#define ROW_BUILT (ROW_PLACE + 3 * EXACT_REALS)
#define ROW_TRAVEL (ROW_BUILT + 3 * EXACT_REALS)
#define ROW_TURNING (ROW_TRAVEL + 3 * EXACT_REALS)
#define ROW_KEPT (ROW_TURNING + ROTATION_ROWS * EXACT_REALS)
#define ROWS_OF_MOTION (ROW_KEPT + INTEGRATOR_ROWS * EXACT_REALS)
/* Grains of a work-item: half a block, so that small beds have work for several threads. */
#define PARTICLE_LANES (CLAST_BLOCK / 2)

/* x, y and z of four grains, from three of the four numbers that are loaded of each; the fourth is the next grain's (arrays have room behind
 * the last). Bits only: a stored number has 64 in either precision. */
INLINE void rows_turn(__global const exact *field, int4 i, ulong4 *x, ulong4 *y, ulong4 *z)
{
    __global const ulong *from = (__global const ulong *)field;
    ulong4 a = vload4(0, from + 3 * (size_t)i.s0), b = vload4(0, from + 3 * (size_t)i.s1);
    ulong4 c = vload4(0, from + 3 * (size_t)i.s2), d = vload4(0, from + 3 * (size_t)i.s3);
    ulong4 even_ab = (ulong4)(a.s0, b.s0, a.s2, b.s2), odd_ab = (ulong4)(a.s1, b.s1, a.s3, b.s3);
    ulong4 even_cd = (ulong4)(c.s0, d.s0, c.s2, d.s2), odd_cd = (ulong4)(c.s1, d.s1, c.s3, d.s3);
    *x = (ulong4)(even_ab.s01, even_cd.s01);
    *y = (ulong4)(odd_ab.s01, odd_cd.s01);
    *z = (ulong4)(even_ab.s23, even_cd.s23);
}

/* Three rows of numbers as they are nearest to reals. */
INLINE void rows_polar3(__global const exact *field, int4 i, real *to)
{
    ulong4 x, y, z;
    rows_turn(field, i, &x, &y, &z);
    row_rounded(x, to);
    row_rounded(y, ROW(to, 1));
    SPACE_STORE(row_rounded(z, ROW(to, 2)));
}

INLINE void rows_axial3(__global const exact *field, int4 i, real *to)
{
    ulong4 x, y, z;
    rows_turn(field, i, &x, &y, &z);
    SPACE_STORE(row_rounded(x, to));
    SPACE_STORE(row_rounded(y, ROW(to, 1)));
    row_rounded(z, ROW(to, 2));
}

/* A row of numbers, one a grain. */
INLINE void rows_number(__global const exact *field, int4 i, real *to)
{
    __global const ulong *from = (__global const ulong *)field;
    row_rounded((ulong4)(from[i.s0], from[i.s1], from[i.s2], from[i.s3]), to);
}

/* Three numbers with all their bits. */
INLINE void rows_exact_polar3(__global const exact *field, int4 i, real *to)
{
    ulong4 x, y, z;
    rows_turn(field, i, &x, &y, &z);
    row_exact(x, to, CLAST_BLOCK);
    row_exact(y, ROW(to, EXACT_REALS), CLAST_BLOCK);
    SPACE_STORE(row_exact(z, ROW(to, 2 * EXACT_REALS), CLAST_BLOCK));
}

INLINE void rows_exact_axial3(__global const exact *field, int4 i, real *to)
{
    ulong4 x, y, z;
    rows_turn(field, i, &x, &y, &z);
    SPACE_STORE(row_exact(x, to, CLAST_BLOCK));
    SPACE_STORE(row_exact(y, ROW(to, EXACT_REALS), CLAST_BLOCK));
    row_exact(z, ROW(to, 2 * EXACT_REALS), CLAST_BLOCK);
}

/* Pocl's prefetch() does nothing. `near`: 3 the first cache, 2 the second. */
#define PREFETCH(address, to_change, near) __builtin_prefetch((const void *)(size_t)(address), to_change, near)
#define ASK_FOR(address) PREFETCH(address, 0, 2)
#define ASK_FOR_SOON(address) PREFETCH(address, 0, 3)
#define ASK_TO_CHANGE(address) PREFETCH(address, 1, 3)
