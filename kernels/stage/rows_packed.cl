/* Rows of grains from their packets: what the pair stage reads of a grain, once more in 16 numbers, one line of a cache instead of the five that
 * its fields stand in, and one load instead of six. In the order of the rows: position and radius as pairs of floats, mass, velocity, spin, and the
 * temperature last (docs/performance.md). Sixteen of them are turned into rows by 64 shuffles. */
#define PACKET 16
#define ROWS_FILLED 16
/* Packets of a block fit the first cache. */
#define GRAINS_AHEAD 1
#define ROW_POSITION 0
#define ROW_RADIUS 6
#define ROW_MASS 8
#define ROW_VELOCITY 9
#define ROW_SPIN 12
#define ROW_TEMPERATURE 15
#define ROW_PAST PACKET
#define ROWS_OF_GRAIN (ROW_PAST + INTEGRATOR_ROWS)

INLINE void grain_ask_for(size_t i PAIR_DECLARE)
{
    ASK_FOR_SOON(packed + PACKET * i);
    INTEGRATOR_ASK_FOR(i);
}

/* Pairs of numbers of two vectors, in every quarter: the lower two, or the upper two. */
#define PAIRS_LOW(a, b)                                                                                                              \
    (float16)((a).s0, (b).s0, (a).s1, (b).s1, (a).s4, (b).s4, (a).s5, (b).s5, (a).s8, (b).s8, (a).s9, (b).s9, (a).sc, (b).sc, (a).sd, (b).sd)
#define PAIRS_HIGH(a, b)                                                                                                             \
    (float16)((a).s2, (b).s2, (a).s3, (b).s3, (a).s6, (b).s6, (a).s7, (b).s7, (a).sa, (b).sa, (a).sb, (b).sb, (a).se, (b).se, (a).sf, (b).sf)
#define TWOS_LOW(a, b) (float16)((a).s01, (b).s01, (a).s45, (b).s45, (a).s89, (b).s89, (a).scd, (b).scd)
#define TWOS_HIGH(a, b) (float16)((a).s23, (b).s23, (a).s67, (b).s67, (a).sab, (b).sab, (a).sef, (b).sef)
/* Four vectors whose quarters are turned each for itself: number n of the same quarter of a to d, in that quarter of the nth result. */
#define QUARTERS_TURNED(n0, n1, n2, n3, a, b, c, d)                                                                \
    do {                                                                                                           \
        float16 ab = PAIRS_LOW(a, b), cd = PAIRS_LOW(c, d);                                                        \
        n0 = TWOS_LOW(ab, cd);                                                                                     \
        n1 = TWOS_HIGH(ab, cd);                                                                                    \
        ab = PAIRS_HIGH(a, b);                                                                                     \
        cd = PAIRS_HIGH(c, d);                                                                                     \
        n2 = TWOS_LOW(ab, cd);                                                                                     \
        n3 = TWOS_HIGH(ab, cd);                                                                                    \
    } while (0)
/* Four packets: number 4 q + n of each, in quarter q of the nth result. Four times two halves: the first one's in quarters 0 and 1. */
#define FOUR_PACKETS(n0, n1, n2, n3, PACKET_OF, at)                                                                \
    float16 n0, n1, n2, n3;                                                                                        \
    do {                                                                                                           \
        float16 a = PACKET_OF(at), b = PACKET_OF((at) + 1), c = PACKET_OF((at) + 2), d = PACKET_OF((at) + 3);      \
        QUARTERS_TURNED(n0, n1, n2, n3, a, b, c, d);                                                               \
    } while (0)
#define WHOLE_PACKET(at) vload16((size_t)which[at], packed)
/* The same half of two packets. */
#define TWO_HALVES(at) (float16)(vload8(2 * (size_t)which[at] + part, packed), vload8(2 * (size_t)which[(at) + 4] + part, packed))
/* Rows n, n + 4, n + 8, n + 12 from the nth results of four fours. */
#define ROWS_OF_FOURS(n, a, b, c, d)                                                                               \
    do {                                                                                                           \
        float16 ab = (float16)((a).lo, (b).lo), cd = (float16)((c).lo, (d).lo);                                    \
        vstore16((float16)(ab.s0123, ab.s89ab, cd.s0123, cd.s89ab), 0, ROW(to, n));                                \
        vstore16((float16)(ab.s4567, ab.scdef, cd.s4567, cd.scdef), 0, ROW(to, (n) + 4));                          \
        ab = (float16)((a).hi, (b).hi), cd = (float16)((c).hi, (d).hi);                                            \
        vstore16((float16)(ab.s0123, ab.s89ab, cd.s0123, cd.s89ab), 0, ROW(to, (n) + 8));                          \
        vstore16((float16)(ab.s4567, ab.scdef, cd.s4567, cd.scdef), 0, ROW(to, (n) + 12));                  \
    } while (0)

/* All numbers of the grains `which` of 16 records on one side. */
INLINE void rows_unpack(__global const int *which, real *to PAIR_DECLARE)
{
    FOUR_PACKETS(a0, a1, a2, a3, WHOLE_PACKET, 0);
    FOUR_PACKETS(b0, b1, b2, b3, WHOLE_PACKET, 4);
    FOUR_PACKETS(c0, c1, c2, c3, WHOLE_PACKET, 8);
    FOUR_PACKETS(d0, d1, d2, d3, WHOLE_PACKET, 12);
    ROWS_OF_FOURS(0, a0, b0, c0, d0);
    ROWS_OF_FOURS(1, a1, b1, c1, d1);
    ROWS_OF_FOURS(2, a2, b2, c2, d2);
    ROWS_OF_FOURS(3, a3, b3, c3, d3);
}

/* Rows n and n + 4 of those of a half, from the nth results of two times two halves. */
#define ROWS_OF_HALVES(n, a, b)                                                                                    \
    do {                                                                                                           \
        vstore16((float16)((a).s0123, (a).s89ab, (b).s0123, (b).s89ab), 0, ROW(to, 8 * part + (n)));               \
        vstore16((float16)((a).s4567, (a).scdef, (b).s4567, (b).scdef), 0, ROW(to, 8 * part + (n) + 4));           \
    } while (0)

/* The lower half of them (0), which is what tells whether two may touch, or the upper (1). */
INLINE void rows_unpack_half(__global const int *which, const int part, real *to PAIR_DECLARE)
{
    FOUR_PACKETS(a0, a1, a2, a3, TWO_HALVES, 0);
    FOUR_PACKETS(b0, b1, b2, b3, TWO_HALVES, 8);
    ROWS_OF_HALVES(0, a0, b0);
    ROWS_OF_HALVES(1, a1, b1);
    ROWS_OF_HALVES(2, a2, b2);
    ROWS_OF_HALVES(3, a3, b3);
}

INLINE void rows_fill_places(__global const int *which, const bool all, real *to PAIR_DECLARE)
{
    for (int lane = 0; lane < CLAST_BLOCK; lane += ROWS_FILLED)
        if (all)
            rows_unpack(which + lane, to + lane PAIR_PASS);
        else
            rows_unpack_half(which + lane, 0, to + lane PAIR_PASS);
}

INLINE void rows_fill_rest(__global const int *which, const bool all, real *to PAIR_DECLARE)
{
    if (!all)
        rows_unpack_half(which, 1, to PAIR_PASS);
    for (int lane = 0; lane < ROWS_FILLED; lane += 4) {
        int4 i = vload4(0, which + lane);
        (void)i;
        INTEGRATOR_ROWS_FILL(i, ROW(to + lane, ROW_PAST));
    }
}

/* Grains that have moved, or that a batch begins with. */
INLINE void grains_pack(int first, int count PARTICLE_DECLARE)
{
    for (int i = first; i < first + count; i++) {
        /* as the floats that the numbers are stored as: read as anything else, they could be taken for those before the step */
        float8 place = vload8(0, (__global const float *)(position + 3 * (size_t)i));
        float2 size = vload2(0, (__global const float *)(radius + i));
        vec3 v = GRAIN_POLAR3(velocity, i), w = ROTATION_LOAD(launch, i);
        vstore8((float8)(place.s0123, place.s45, size), 2 * (size_t)i, packed);
        vstore8((float8)(mass[i], v.x, v.y, v.z, w.x, w.y, w.z, TEMPERATURE_OF_GRAIN(i)), 2 * (size_t)i + 1, packed);
    }
}
