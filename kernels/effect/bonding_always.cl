/* bonding: every contact may bond (those for which the scene gives no bond have a threshold that nothing reaches).
 * Reads BONDING_THRESHOLD. */
#ifndef BONDING_THRESHOLD
#define BONDING_THRESHOLD 0
#endif
#define BONDING_PAIR_FIELDS(READ, WRITE)
#define BONDING_COMES(loaded) true
#define BONDING_LOAD(launch, k) R(1.0)

INLINE real bonding_value(const contact *c, real loaded)
{
    (void)c;
    return loaded;
}
