/* integrator: semi-implicit Euler, velocity first (TM sec. 4). */
INLINE vec3 integrate_velocity(vec3 velocity, vec3 acceleration, real dt)
{
    return add_scaled(velocity, dt, acceleration);
}

INLINE vec3 integrate_position(vec3 position, vec3 velocity, real dt)
{
    return add_scaled(position, dt, velocity);
}
