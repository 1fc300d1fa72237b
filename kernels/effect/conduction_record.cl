/* What all laws of conduction share: a record holds the heat that flows into its owner, W. A law gives the conductance, W/K. */
#define CONDUCTION_PAIR_FIELDS(READ, WRITE) WRITE(real, heat)
#define CONDUCTION_PARTICLE_FIELDS(READ, WRITE) READ(real, heat)
#define CONDUCTION_STORE(launch, k, flow) heat[k] = (flow)
#define CONDUCTION_GATHER(launch, k, sign) ((sign)*heat[k])
