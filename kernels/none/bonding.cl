/* bonding: no bonds, so nothing to ask for. */
#define BONDING_PAIR_FIELDS(READ, WRITE)
#define BONDING_LOAD(launch, k) R(0.0)
