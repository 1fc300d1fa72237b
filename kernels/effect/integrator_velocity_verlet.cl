/* integrator: velocity Verlet in its leapfrog form (Swope et al. 1982). half_velocity is kept half a step behind the positions and is what
 * advances them, and the histories of contacts; `velocity`, which the laws are given, is ahead of it by half a step of the last acceleration.
 * Behind this file comes one of integrator_half_spin.cl and integrator_no_spin.cl. Reads and writes half_velocity. */
#define INTEGRATOR_PAST_VELOCITY(i, v) GRAIN_POLAR3(half_velocity, i)
#define INTEGRATOR_VELOCITY_OF_ROWS(rows, n, lane, v) ROW_POLAR3(rows, n, lane)
#define INTEGRATOR_PRECISE_VELOCITY_OF_ROWS(rows, n, lane, v) ROW_PRECISE_POLAR3(rows, n, lane)
#define INTEGRATOR_ELAPSED(launch) (launch)->lag
#define INTEGRATOR_VELOCITY(i, v) PRECISE_GRAIN_POLAR3(half_velocity, i)
#define INTEGRATOR_KEEP_VELOCITY(i, v) SET_GRAIN_POLAR3(half_velocity, i, v)
/* Springs as sums of energy see them: stretched up to the positions as they are. */
#define INTEGRATOR_CATCH_UP(c, s, out) contact_springs(c, s, out)
#define INTEGRATOR_AHEAD(kept, ahead) (ahead)
/* The extrapolation makes a damper count twice towards the limit of the step (docs/theory.md). */
#define INTEGRATOR_DAMPING_LAG R(2.0)

INLINE precise3 integrate_velocity(precise3 velocity, vec3 acceleration, real dt)
{
    return precise3_add_scaled(velocity, dt, precise3_from(acceleration));
}

INLINE precise3 integrate_position(precise3 position, precise3 velocity, real dt)
{
    return precise3_add_scaled(position, dt, velocity);
}
