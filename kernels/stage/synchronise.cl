/* Velocity and spin at the time of the positions, where the integrator keeps them half a step behind. */

/* The histories of the contacts one step on, to where the positions are: before a stage, whose first step starts from there. */
INLINE void catch_up_record(const clast_launch *launch, int k, bool wall PAIR_DECLARE)
{
    if (wall)
        pair_of_wall(launch, k PAIR_PASS);
    else
        pair_of_grains(launch, k PAIR_PASS);
}

RECORD_KERNEL(pair_catch_up, catch_up_record)

/* What contacts dissipate in the half step heats grain i. */
INLINE void particle_heat_half_step(const clast_launch *launch, int i PARTICLE_DECLARE)
{
    grain g;
    grain_heat h = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
    if (i >= launch->particle_count)
        return;
    particle_grain(launch, i, &g PARTICLE_PASS);
    precise warmed = particle_heat_ahead(launch, i, &g, &h PARTICLE_PASS);
    if (h.rubbed == R(0.0))
        return;
    TEMPERATURE_STORE(i, warmed);
    HEAT_TALLY_ADD(i, &h);
}

/* Into velocity_now and spin_now: what output and sums read. The forces are those of the next step (pair_probe, or pair_catch_up); launch.kick is
 * half of the step that was taken last. The ledger's share of it goes into ledger_now, or, where a stage `ends`, is added to the ledger, and what
 * is dissipated to the heat. */
__kernel void particle_synchronise(const clast_launch launch, __global exact *restrict velocity_now, __global exact *restrict spin_now,
                                   __global exact *restrict ledger_now, const int ends PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    real r = GRAIN_RADIUS(i), m = mass[i], inertia = R(0.4) * m * r * r, kick = number(launch.kick);
    vec3 f, t;
    precise3 v = PRECISE_GRAIN_POLAR3(velocity, i), w = ROTATION_PRECISE(&launch, i);
    grain_heat h;
    bool held = MOTION_GRAIN(i) >= 0;
    particle_gather(&launch, get_group_id(0), get_local_id(0), &f, &t, &h PARTICLE_PASS);
    f = add_scaled(f, m, POLAR3(launch.gravity));
    vec3 damped = body_force(f, rounded3(v), m), damped_t = body_force(t, rounded3(w), inertia);
    precise3 before = INTEGRATOR_VELOCITY(i, v), turning = INTEGRATOR_SPIN(i, w);
    precise3 v1 = integrate_velocity(before, scale(R(1.0) / m, damped), kick);
    precise3 w1 = rotation_advance(turning, damped_t, inertia, kick);
    v1 = held ? v : v1;
    w1 = held ? w : w1;
    SET_GRAIN_POLAR3(velocity_now, i, v1);
    INTEGRATOR_SPIN_NOW(i, w1);
    grain_step step = {m, inertia, kick, rounded3(before), rounded3(v1), rounded3(turning), rounded3(w1), f, damped, t, damped_t, held, R(0.0)};
    (void)step;
    LEDGER_HALF_STEP(&launch, i, &step, ledger_now, ends);
    if (ends)
        particle_heat_half_step(&launch, i PARTICLE_PASS);
}
