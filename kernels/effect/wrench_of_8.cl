/* rotation: what a record gives its two bodies, where no law gives moments: force and the owner's arm, then the lever n x f_t and the other body's arm
 * (stage/wrenches_together.cl). */
#define WRENCH_NUMBERS 8
#define WRENCH_PUT(on_other)                      \
    ROW_SET_POLAR3(wrenches, 0, lane, total);     \
    ROW_NUMBER(wrenches, 3, lane) = c.arm_i;      \
    ROW_SET_AXIAL3(wrenches, 4, lane, lever);     \
    ROW_NUMBER(wrenches, 7, lane) = c.arm_j
#define WRENCH_FOURTH 3
#define WRENCH_LAST_ROWS (void)0
#define WRENCHES_OF_QUARTER(q, part)                                      \
    vstore16((float16)(f0.part, t0.part, f1.part, t1.part), 2 * (q), to); \
    vstore16((float16)(f2.part, t2.part, f3.part, t3.part), 2 * (q) + 1, to)
#define WRENCH_SHARE(wrench, sign, side) (vload8(0, wrench) * (float8)((float4)(sign), (float4)((side)[3])))
