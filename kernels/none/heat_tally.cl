/* heat tally: nobody asks where the heat came from. */
#define HEAT_TALLY_PARTICLE_FIELDS(READ, WRITE)
#define HEAT_TALLY_ADD(i, h)
#define HEAT_TALLY_OF(i, q) precise_from(R(0.0))
#define HEAT_TALLY_KEEP(kept, i, h, weight, first) (void)(weight)
#define HEAT_TALLY_KEPT(kept, i, h)                                                     \
    do {                                                                                \
        grain_heat nothing = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};         \
        *(h) = nothing;                                                                 \
    } while (0)
