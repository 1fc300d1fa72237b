/* dissipation heat: what contacts dissipate heats nobody (TM Eqs. 23-28). */
#define DISSIPATION_HEAT_PAIR_FIELDS(READ, WRITE)
#define DISSIPATION_HEAT_PARTICLE_FIELDS(READ, WRITE)
#define DISSIPATION_HEAT_STORE(launch, k, lost, share)
#define DISSIPATION_HEAT_GATHER(launch, i, sum) (void)(sum)
