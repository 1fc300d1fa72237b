/* integrator: the half-step spin of velocity Verlet, as half_velocity. Reads and writes half_spin. */
#define INTEGRATOR_PAIR_FIELDS(READ, WRITE) READ(exact, half_velocity) READ(exact, half_spin)
#define INTEGRATOR_PAST_SPIN(i, w) GRAIN_AXIAL3(half_spin, i)
#define INTEGRATOR_ROWS 6
#define INTEGRATOR_ROWS_FILL(i, to)           \
    do {                                      \
        rows_polar3(half_velocity, i, to);      \
        rows_axial3(half_spin, i, ROW(to, 3));  \
    } while (0)
#define INTEGRATOR_SPIN_OF_ROWS(rows, n, lane, w) ROW_AXIAL3(rows, n, lane)
#define INTEGRATOR_EXACT_ROWS_FILL(i, to)                           \
    do {                                                            \
        rows_exact_polar3(half_velocity, i, to);                          \
        rows_exact_axial3(half_spin, i, ROW(to, 3 * EXACT_REALS));        \
    } while (0)
#define INTEGRATOR_PRECISE_SPIN_OF_ROWS(rows, n, lane, w) ROW_PRECISE_AXIAL3(rows, n, lane)
#define INTEGRATOR_ASK_FOR(i)                 \
    do {                                      \
        ASK_FOR(half_velocity + 3 * (i));     \
        ASK_FOR(half_spin + 3 * (i));         \
    } while (0)
#define INTEGRATOR_PARTICLE_FIELDS(READ, WRITE) WRITE(exact, half_velocity) WRITE(exact, half_spin)
#define INTEGRATOR_SPIN(i, w) PRECISE_GRAIN_AXIAL3(half_spin, i)
#define INTEGRATOR_KEEP_SPIN(i, w) SET_GRAIN_AXIAL3(half_spin, i, w)
#define INTEGRATOR_SPIN_NOW(i, w) SET_GRAIN_AXIAL3(spin_now, i, w)
