/* Velocity and spin at the time of the positions, where the integrator keeps them half a step behind: what output and sums read. The forces
 * are those of the next step (pair_probe); launch.kick is half of the step that was taken last. */
__kernel void particle_synchronise(const clast_launch launch, __global exact *restrict velocity_now, __global exact *restrict spin_now PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    real r = GRAIN_RADIUS(i), m = mass[i], inertia = R(0.4) * m * r * r, kick = number(launch.kick);
    vec3 f, t;
    precise3 v = PRECISE_GRAIN3(velocity, i), w = ROTATION_PRECISE(&launch, i);
    grain_heat h;
    bool held = MOTION_GRAIN(i) >= 0;
    particle_gather(&launch, get_group_id(0), get_local_id(0), &f, &t, &h PARTICLE_PASS);
    f = body_force(add_scaled(f, m, from3(launch.gravity)), rounded3(v), m);
    t = body_force(t, rounded3(w), inertia);
    precise3 v1 = integrate_velocity(INTEGRATOR_VELOCITY(i, v), scale(R(1.0) / m, f), kick);
    precise3 w1 = rotation_advance(INTEGRATOR_SPIN(i, w), t, inertia, kick);
    v1 = held ? v : v1;
    w1 = held ? w : w1;
    SET_GRAIN3(velocity_now, i, v1);
    INTEGRATOR_SPIN_NOW(i, w1);
}
