/* packed: grains are read from their fields. */
#define PACKED_PAIR_FIELDS(READ, WRITE)
#define PACKED_PARTICLE_FIELDS(READ, WRITE)
