/* integrator: the half-step spin of velocity Verlet, as half_velocity. Reads and writes half_spin. */
#define INTEGRATOR_PAIR_FIELDS(READ, WRITE) READ(real, half_velocity) READ(real, half_spin)
#define INTEGRATOR_PAST_SPIN(i, w) GRAIN3(half_spin, i)
#define INTEGRATOR_PARTICLE_FIELDS(READ, WRITE) WRITE(real, half_velocity) WRITE(real, half_spin)
#define INTEGRATOR_SPIN(i, w) GRAIN3(half_spin, i)
#define INTEGRATOR_KEEP_SPIN(i, w) SET_GRAIN3(half_spin, i, w)
#define INTEGRATOR_SPIN_NOW(i, w) SET_GRAIN3(spin_now, i, w)
