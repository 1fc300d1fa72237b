/* rotation: spin and torque, TM Eq. 1 with j = (2/5) m r^2. Reads and writes spin; a record's torque holds that on its owner, then that on
 * the other body. */
#define ROTATION_PAIR_FIELDS(READ, WRITE) READ(exact, spin) WRITE(real, torque)
#ifdef WRENCH_NUMBERS /* the particle stage keeps one of them at 0 (stage/wrenches_together.cl) */
#define ROTATION_PARTICLE_FIELDS(READ, WRITE) WRITE(exact, spin) WRITE(real, torque)
#else
#define ROTATION_PARTICLE_FIELDS(READ, WRITE) WRITE(exact, spin) READ(real, torque)
#endif
#define ROTATION_OBSERVE_FIELDS(READ, WRITE) READ(exact, spin)
#define ROTATION_LIMIT_FIELDS(READ, WRITE) READ(real, torque)
#define ROTATION_LOAD(launch, i) GRAIN_AXIAL3(spin, i)
#define ROTATION_ROWS 3
#define ROTATION_ROWS_FILL(i, to) rows_axial3(spin, i, to)
#define ROTATION_OF_ROWS(rows, n, lane) ROW_AXIAL3(rows, n, lane)
#define ROTATION_EXACT_ROWS_FILL(i, to) rows_exact_axial3(spin, i, to)
#define ROTATION_PRECISE_OF_ROWS(rows, n, lane) ROW_PRECISE_AXIAL3(rows, n, lane)
#define ROTATION_TO_ROWS(rows, n, lane, t) ROW_SET_AXIAL3(rows, n, lane, t)
#define ROTATION_ASK_FOR(i) ASK_FOR(spin + 3 * (i))
#define ROTATION_PRECISE(launch, i) PRECISE_GRAIN_AXIAL3(spin, i)
#define ROTATION_STORE(launch, i, w) SET_GRAIN_AXIAL3(spin, i, w)
#define ROTATION_STORE_TORQUE(launch, k, owner_torque, other_torque)                   \
    do {                                                                               \
        STORE_AXIAL3(torque, (launch)->record_stride, k, owner_torque);                \
        STORE_AXIAL3(torque + 3 * (launch)->record_stride, (launch)->record_stride, k, other_torque); \
    } while (0)
/* `side` has all bits set for the other body, none for the owner. */
#define ROTATION_GATHER(launch, k, side) LOAD_AXIAL3(torque + ((3 * (launch)->record_stride) & (clast_i64)(side)), (launch)->record_stride, k)
/* The step limit keeps the normal of a record where its force stands, and the modes where its torque does. */
#define LIMIT_STORE(launch, k, twice, direction, n, t, r)                     \
    do {                                                                      \
        STORE3(force, (launch)->record_stride, k, direction);                 \
        AT(torque, (launch)->record_stride, 0, k) = (twice) * (n).stiffness;  \
        AT(torque, (launch)->record_stride, 1, k) = (twice) * (n).damping;    \
        AT(torque, (launch)->record_stride, 2, k) = (twice) * (t).stiffness;  \
        AT(torque, (launch)->record_stride, 3, k) = (twice) * (t).damping;    \
        AT(torque, (launch)->record_stride, 4, k) = (twice) * (r).stiffness;  \
        AT(torque, (launch)->record_stride, 5, k) = (twice) * (r).damping;    \
    } while (0)
#define LIMIT_LOAD(launch, k, direction, n, t, r)                             \
    do {                                                                      \
        direction = LOAD3(force, (launch)->record_stride, k);                 \
        n.stiffness = AT(torque, (launch)->record_stride, 0, k);              \
        n.damping = AT(torque, (launch)->record_stride, 1, k);                \
        t.stiffness = AT(torque, (launch)->record_stride, 2, k);              \
        t.damping = AT(torque, (launch)->record_stride, 3, k);                \
        r.stiffness = AT(torque, (launch)->record_stride, 4, k);              \
        r.damping = AT(torque, (launch)->record_stride, 5, k);                \
    } while (0)

INLINE precise3 rotation_advance(precise3 spin, vec3 torque, real inertia, real dt)
{
    return precise3_add_scaled(spin, dt / inertia, precise3_from(torque));
}
