/* rotation: grains do not turn; no spin, no torque. */
#define ROTATION_PAIR_FIELDS(READ, WRITE)
#define ROTATION_PARTICLE_FIELDS(READ, WRITE)
#define ROTATION_OBSERVE_FIELDS(READ, WRITE)
#define ROTATION_LIMIT_FIELDS(READ, WRITE)
#define ROTATION_LOAD(launch, i) v3(R(0.0), R(0.0), R(0.0))
#define ROTATION_STORE(launch, i, w)
#define ROTATION_STORE_TORQUE(launch, k, owner_torque, other_torque)
#define ROTATION_GATHER(launch, k, sign) v3(R(0.0), R(0.0), R(0.0))
#define ROTATION_STORE_MODES(launch, k, a, b)
#define ROTATION_LOAD_MODE(launch, k, m) R(0.0)

INLINE vec3 rotation_advance(vec3 spin, vec3 torque, real inertia, real dt)
{
    (void)torque;
    (void)inertia;
    (void)dt;
    return spin;
}
