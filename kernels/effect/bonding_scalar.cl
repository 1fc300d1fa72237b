/* bonding: a contact may bond while the scalar of both grains (a concentration) is above the threshold of their materials; at a wall, that of
 * the grain. Reads scalar, BONDING_THRESHOLD. */
#ifndef BONDING_THRESHOLD
#define BONDING_THRESHOLD 0
#endif
#define BONDING_PAIR_FIELDS(READ, WRITE) READ(real, scalar)
#define BONDING_COMES(loaded) true
#define BONDING_LOAD(launch, k) bonding_lower(scalar[owner[k]], scalar[BONDING_OTHER(launch, k)])
/* The other grain; the grain itself at a wall, where `other` names a face. */
#define BONDING_OTHER(launch, k) ((k) < (launch)->first_wall_group * CLAST_BLOCK ? other[k] : owner[k])

INLINE real bonding_lower(real a, real b)
{
    return a < b ? a : b;
}

INLINE real bonding_value(const contact *c, real loaded)
{
    (void)c;
    return loaded;
}
