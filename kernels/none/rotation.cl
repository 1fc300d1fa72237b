/* rotation: grains do not turn; no spin, no torque. */
#define ROTATION_PAIR_FIELDS(READ, WRITE)
#define ROTATION_PARTICLE_FIELDS(READ, WRITE)
#define ROTATION_OBSERVE_FIELDS(READ, WRITE)
#define ROTATION_LIMIT_FIELDS(READ, WRITE)
#define ROTATION_LOAD(launch, i) v3(R(0.0), R(0.0), R(0.0))
#define ROTATION_ROWS 0
#define ROTATION_ROWS_FILL(i, to)
#define ROTATION_OF_ROWS(rows, n, lane) v3(R(0.0), R(0.0), R(0.0))
#define ROTATION_EXACT_ROWS_FILL(i, to)
#define ROTATION_PRECISE_OF_ROWS(rows, n, lane) precise3_from(v3(R(0.0), R(0.0), R(0.0)))
#define ROTATION_TO_ROWS(rows, n, lane, t) (void)(t)
#define ROTATION_ASK_FOR(i)
#define ROTATION_PRECISE(launch, i) precise3_from(v3(R(0.0), R(0.0), R(0.0)))
#define ROTATION_STORE(launch, i, w) (void)(w)
#define ROTATION_STORE_TORQUE(launch, k, owner_torque, other_torque) (void)(owner_torque), (void)(other_torque)
#define ROTATION_GATHER(launch, k, side) v3(R(0.0), R(0.0), R(0.0))
/* Without torques there is no room for the normal of a record: stiffnesses of a grain add up as if all its contacts stood in one line,
 * which is on the safe side. */
#define LIMIT_STORE(launch, k, twice, direction, n, t, r)                     \
    do {                                                                      \
        AT(force, (launch)->record_stride, 0, k) = (twice) * (n).stiffness;   \
        AT(force, (launch)->record_stride, 1, k) = (twice) * (n).damping;     \
        (void)(t);                                                            \
        (void)(r);                                                            \
    } while (0)
#define LIMIT_LOAD(launch, k, direction, n, t, r)                             \
    do {                                                                      \
        direction = v3(R(1.0), R(0.0), R(0.0));                               \
        n.stiffness = AT(force, (launch)->record_stride, 0, k);               \
        n.damping = AT(force, (launch)->record_stride, 1, k);                 \
        t.stiffness = t.damping = r.stiffness = r.damping = R(0.0);           \
    } while (0)

INLINE precise3 rotation_advance(precise3 spin, vec3 torque, real inertia, real dt)
{
    (void)torque;
    (void)inertia;
    (void)dt;
    return spin;
}
