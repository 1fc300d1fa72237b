/* body: no background damping. */
INLINE vec3 body_force(vec3 force, vec3 velocity, real inertia)
{
    (void)velocity;
    (void)inertia;
    return force;
}
