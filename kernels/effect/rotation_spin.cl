/* rotation: spin and torque, TM Eq. 1 with j = (2/5) m r^2. Reads and writes spin; a record's torque holds that on its owner, then that on
 * the other body. */
#define ROTATION_PAIR_FIELDS(READ, WRITE) READ(real, spin) WRITE(real, torque)
#define ROTATION_PARTICLE_FIELDS(READ, WRITE) WRITE(real, spin) READ(real, torque)
#define ROTATION_OBSERVE_FIELDS(READ, WRITE) READ(real, spin)
#define ROTATION_LIMIT_FIELDS(READ, WRITE) READ(real, torque)
#define ROTATION_LOAD(launch, i) LOAD3(spin, (launch)->particle_stride, i)
#define ROTATION_STORE(launch, i, w) STORE3(spin, (launch)->particle_stride, i, w)
#define ROTATION_STORE_TORQUE(launch, k, owner_torque, other_torque)                   \
    do {                                                                               \
        STORE3(torque, (launch)->record_stride, k, owner_torque);                      \
        STORE3(torque + 3 * (launch)->record_stride, (launch)->record_stride, k, other_torque); \
    } while (0)
#define ROTATION_GATHER(launch, k, sign) \
    LOAD3(torque + ((sign) < R(0.0) ? 3 * (launch)->record_stride : 0), (launch)->record_stride, k)
/* The step limit keeps the sliding and rolling modes of a record where its torque stands. */
#define ROTATION_STORE_MODES(launch, k, a, b)                         \
    do {                                                              \
        AT(torque, (launch)->record_stride, 0, k) = (a).stiffness;    \
        AT(torque, (launch)->record_stride, 1, k) = (a).damping;      \
        AT(torque, (launch)->record_stride, 2, k) = (b).stiffness;    \
        AT(torque, (launch)->record_stride, 3, k) = (b).damping;      \
    } while (0)
#define ROTATION_LOAD_MODE(launch, k, m) AT(torque, (launch)->record_stride, m, k)

INLINE vec3 rotation_advance(vec3 spin, vec3 torque, real inertia, real dt)
{
    return add_scaled(spin, dt / inertia, torque);
}
