/* integrator: velocity Verlet of grains that do not turn. */
#define INTEGRATOR_PAIR_FIELDS(READ, WRITE) READ(exact, half_velocity)
#define INTEGRATOR_PAST_SPIN(i, w) (w)
#define INTEGRATOR_PARTICLE_FIELDS(READ, WRITE) WRITE(exact, half_velocity)
#define INTEGRATOR_SPIN(i, w) (w)
#define INTEGRATOR_KEEP_SPIN(i, w) (void)(w)
#define INTEGRATOR_SPIN_NOW(i, w) (void)(w)
