/* bonding: a contact may bond while the temperatures of its two bodies are above the threshold of their materials: both of them, their mean, or
 * the higher one. A wall has that of the grain. Reads the temperatures of the contact, BONDING_THRESHOLD (K). */
#ifndef BONDING_THRESHOLD
#define BONDING_THRESHOLD 0
#endif
/* 0: both; 1: the mean; 2: the higher one. */
#ifndef BONDING_TEMPERATURE
#define BONDING_TEMPERATURE 0
#endif
#define BONDING_PAIR_FIELDS(READ, WRITE)
#define BONDING_COMES(loaded) true
#define BONDING_LOAD(launch, k) R(0.0)

INLINE real bonding_value(const contact *c, real loaded)
{
    real a = c->temperature_i, b = c->temperature_j;
    (void)loaded;
    if (BONDING_TEMPERATURE == 1)
        return R(0.5) * (a + b);
    if (BONDING_TEMPERATURE == 2)
        return a > b ? a : b;
    return a < b ? a : b;
}
