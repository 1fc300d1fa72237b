/* integrator: semi-implicit Euler, velocity first (TM sec. 4). Velocity and spin are those of the step's end. */
#define INTEGRATOR_PAIR_FIELDS(READ, WRITE)
#define INTEGRATOR_PAST_VELOCITY(i, v) (v)
#define INTEGRATOR_ROWS 0
#define INTEGRATOR_ROWS_FILL(i, to)
#define INTEGRATOR_EXACT_ROWS_FILL(i, to)
#define INTEGRATOR_PRECISE_VELOCITY_OF_ROWS(rows, n, lane, v) (v)
#define INTEGRATOR_PRECISE_SPIN_OF_ROWS(rows, n, lane, w) (w)
#define INTEGRATOR_VELOCITY_OF_ROWS(rows, n, lane, v) (v)
#define INTEGRATOR_SPIN_OF_ROWS(rows, n, lane, w) (w)
#define INTEGRATOR_ASK_FOR(i)
#define INTEGRATOR_PAST_SPIN(i, w) (w)
#define INTEGRATOR_ELAPSED(launch) (launch)->dt
#define INTEGRATOR_PARTICLE_FIELDS(READ, WRITE)
#define INTEGRATOR_VELOCITY(i, v) (v)
#define INTEGRATOR_SPIN(i, w) (w)
#define INTEGRATOR_KEEP_VELOCITY(i, v)
#define INTEGRATOR_KEEP_SPIN(i, w)
#define INTEGRATOR_AHEAD(kept, ahead) (kept)
/* Springs as sums of energy see them: those that gave the last forces. */
#define INTEGRATOR_CATCH_UP(c, s, out)
#define INTEGRATOR_DAMPING_LAG R(1.0)

INLINE precise3 integrate_velocity(precise3 velocity, vec3 acceleration, real dt)
{
    return precise3_add_scaled(velocity, dt, precise3_from(acceleration));
}

INLINE precise3 integrate_position(precise3 position, precise3 velocity, real dt)
{
    return precise3_add_scaled(position, dt, velocity);
}
