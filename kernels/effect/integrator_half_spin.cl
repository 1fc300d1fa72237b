/* integrator: the half-step spin of velocity Verlet, as half_velocity. Reads and writes half_spin. */
#define INTEGRATOR_PAIR_FIELDS(READ, WRITE) READ(exact, half_velocity) READ(exact, half_spin)
#define INTEGRATOR_PAST_SPIN(i, w) GRAIN3(half_spin, i)
#define INTEGRATOR_PARTICLE_FIELDS(READ, WRITE) WRITE(exact, half_velocity) WRITE(exact, half_spin)
#define INTEGRATOR_SPIN(i, w) PRECISE_GRAIN3(half_spin, i)
#define INTEGRATOR_KEEP_SPIN(i, w) SET_GRAIN3(half_spin, i, w)
#define INTEGRATOR_SPIN_NOW(i, w) SET_GRAIN3(spin_now, i, w)
