/* bonding: contacts bond in one step of the run, and in no other. Reads BONDING_THRESHOLD. */
#ifndef BONDING_THRESHOLD
#define BONDING_THRESHOLD 0
#endif
#define BONDING_PAIR_FIELDS(READ, WRITE)
/* For the limit of the step the launch tells whether that step is still to come. */
#define BONDING_COMES(loaded) ((loaded) > R(0.5))
#define BONDING_LOAD(launch, k) ((launch)->bonding != 0 ? R(1.0) : R(0.0))

INLINE real bonding_value(const contact *c, real loaded)
{
    (void)c;
    return loaded;
}
