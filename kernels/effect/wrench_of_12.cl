/* rotation: what a record gives its two bodies, where a law gives moments: force, torque on the owner and torque on the other, each with a number beside it
 * that says nothing (stage/wrenches_together.cl). */
#define WRENCH_NUMBERS 12
#define WRENCH_PUT(on_other)                                                                \
    do {                                                                                    \
        vec3 owners = add_scaled(out.rolling, c.arm_i, lever), others = on_other;           \
        ROW_SET_POLAR3(wrenches, 0, lane, total);                                           \
        ROW_SET_AXIAL3(wrenches, 4, lane, owners);                                          \
        ROW_SET_AXIAL3(wrenches, 8, lane, others);                                          \
    } while (0)
/* The third row serves for the fourth. */
#define WRENCH_FOURTH 2
#define WRENCH_LAST_ROWS FOUR_ROWS(m0, m1, m2, m3, 8)
#define WRENCHES_OF_QUARTER(q, part)                                          \
    vstore16((float16)(f0.part, t0.part, m0.part, f1.part), 3 * (q), to);     \
    vstore16((float16)(t1.part, m1.part, f2.part, t2.part), 3 * (q) + 1, to); \
    vstore16((float16)(m2.part, f3.part, t3.part, m3.part), 3 * (q) + 2, to)
#define WRENCH_SHARE(wrench, sign, side) ((float8)(vload4(0, wrench), vload4(1, side)) * (float8)((float4)(sign), (float4)(1.0f)))
