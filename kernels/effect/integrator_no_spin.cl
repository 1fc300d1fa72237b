/* integrator: velocity Verlet of grains that do not turn. */
#define INTEGRATOR_PAIR_FIELDS(READ, WRITE) READ(exact, half_velocity)
#define INTEGRATOR_PAST_SPIN(i, w) (w)
#define INTEGRATOR_ROWS 3
#define INTEGRATOR_ROWS_FILL(i, to) rows_polar3(half_velocity, i, to)
#define INTEGRATOR_SPIN_OF_ROWS(rows, n, lane, w) (w)
#define INTEGRATOR_EXACT_ROWS_FILL(i, to) rows_exact_polar3(half_velocity, i, to)
#define INTEGRATOR_PRECISE_SPIN_OF_ROWS(rows, n, lane, w) (w)
#define INTEGRATOR_ASK_FOR(i) ASK_FOR(half_velocity + 3 * (i))
#define INTEGRATOR_PARTICLE_FIELDS(READ, WRITE) WRITE(exact, half_velocity)
#define INTEGRATOR_SPIN(i, w) (w)
#define INTEGRATOR_KEEP_SPIN(i, w) (void)(w)
#define INTEGRATOR_SPIN_NOW(i, w) (void)(w)
