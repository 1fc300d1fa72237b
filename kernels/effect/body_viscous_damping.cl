/* body: background drag, dv/dt = -c v and dw/dt = -c w. Reads BODY_DAMPING = c (1/s). */
#ifndef BODY_DAMPING
#define BODY_DAMPING R(1.0)
#endif

INLINE vec3 body_force(vec3 force, vec3 velocity, real inertia)
{
    return add_scaled(force, -BODY_DAMPING * inertia, velocity);
}
