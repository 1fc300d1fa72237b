/* body: local non-viscous damping (Cundall 1987): F_k (1 - a sign(F_k v_k)), for forces and torques alike. Reads BODY_DAMPING = a. */
#ifndef BODY_DAMPING
#define BODY_DAMPING R(0.2)
#endif

INLINE real body_component(real force, real velocity)
{
    real power = force * velocity;
    real sign = power > R(0.0) ? R(1.0) : (power < R(0.0) ? R(-1.0) : R(0.0));
    return force * (R(1.0) - BODY_DAMPING * sign);
}

INLINE vec3 body_force(vec3 force, vec3 velocity, real inertia)
{
    (void)inertia;
    return v3(body_component(force.x, velocity.x), body_component(force.y, velocity.y), body_component(force.z, velocity.z));
}
