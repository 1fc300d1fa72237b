/* Velocity and spin at the time of the positions, where the integrator keeps them half a step behind: what output and sums read. The forces
 * are those of the next step (pair_probe); launch.kick is half of the step that was taken last. */
__kernel void particle_synchronise(const clast_launch launch, __global real *restrict velocity_now, __global real *restrict spin_now PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    real m = mass[i], inertia = R(0.4) * m * radius[i] * radius[i], kick = (real)launch.kick;
    vec3 f, t, v = GRAIN3(velocity, i), w = ROTATION_LOAD(&launch, i);
    grain_heat h;
    bool held = MOTION_GRAIN(i) >= 0;
    particle_gather(&launch, get_group_id(0), get_local_id(0), &f, &t, &h PARTICLE_PASS);
    f = body_force(add_scaled(f, m, from3(launch.gravity)), v, m);
    t = body_force(t, w, inertia);
    vec3 v1 = integrate_velocity(INTEGRATOR_VELOCITY(i, v), scale(R(1.0) / m, f), kick);
    vec3 w1 = rotation_advance(INTEGRATOR_SPIN(i, w), t, inertia, kick);
    v1 = v3(held ? v.x : v1.x, held ? v.y : v1.y, held ? v.z : v1.z);
    w1 = v3(held ? w.x : w1.x, held ? w.y : w1.y, held ? w.z : w1.z);
    SET_GRAIN3(velocity_now, i, v1);
    INTEGRATOR_SPIN_NOW(i, w1);
}
