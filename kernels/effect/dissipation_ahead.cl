/* dissipation, where the velocities that the laws see are half a step older than the forces (semi-implicit Euler): half of what a grain gained in
 * the last step carries its velocity on to the time of the forces. Reads and writes half_gain, half_turn. */
#define DISSIPATION_AHEAD_PAIR_FIELDS(READ, WRITE) READ(exact, half_gain) READ(exact, half_turn)
#define DISSIPATION_PARTICLE_FIELDS(READ, WRITE) WRITE(exact, half_gain) WRITE(exact, half_turn)
#define DISSIPATION_AHEAD(i) GRAIN_POLAR3(half_gain, i)
#define DISSIPATION_AHEAD_SPIN(i) GRAIN_AXIAL3(half_turn, i)
#define DISSIPATION_KEEP(i, step)                                                             \
    do {                                                                                      \
        vec3 gain = scale(R(0.5), sub((step)->velocity_next, (step)->velocity));              \
        vec3 turn = scale(R(0.5), sub((step)->spin_next, (step)->spin));                      \
        SET_GRAIN_POLAR3(half_gain, i, precise3_from(gain));                                                       \
        SET_GRAIN_AXIAL3(half_turn, i, precise3_from(turn));                                                       \
    } while (0)
