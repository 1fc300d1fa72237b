/* packed: what the pair stage reads of a grain stands once more in a packet of 16 numbers (stage/rows_packed.cl). The pair stage reads packed, the
 * particle stage writes it. */
#define PACKED_PAIR_FIELDS(READ, WRITE) READ(real, packed)
#define PACKED_PARTICLE_FIELDS(READ, WRITE) WRITE(real, packed)
