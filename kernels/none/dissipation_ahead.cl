/* dissipation, where the velocities that the laws see are those at the time of the forces, or where nobody asks. */
#define DISSIPATION_AHEAD_PAIR_FIELDS(READ, WRITE)
#define DISSIPATION_PARTICLE_FIELDS(READ, WRITE)
#define DISSIPATION_AHEAD(i) v3(R(0.0), R(0.0), R(0.0))
#define DISSIPATION_AHEAD_SPIN(i) v3(R(0.0), R(0.0), R(0.0))
#define DISSIPATION_KEEP(i, step)
