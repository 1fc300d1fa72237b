/* heat tally: nobody asks where the heat came from. */
#define HEAT_TALLY_PARTICLE_FIELDS(READ, WRITE)
#define HEAT_TALLY_ADD(i, h)
#define HEAT_TALLY_OF(i, q) precise_from(R(0.0))
