/* What all laws of conduction share: a record holds the heat that flows into its owner, W. A law gives the conductance, W/K. */
#define CONDUCTION_PAIR_FIELDS(READ, WRITE) WRITE(real, heat)
#define CONDUCTION_PARTICLE_FIELDS(READ, WRITE) READ(real, heat)
#define CONDUCTION_STORE(launch, k, flow) heat[k] = (flow)
#define CONDUCTION_GATHER(launch, k, sign) ((sign)*heat[k])
#define CONDUCTION_ROWS 2
#define CONDUCTION_TO_ROWS(rows, n, lane, h) ROW_NUMBER(rows, n, lane) = (h).contacts, ROW_NUMBER(rows, (n) + 1, lane) = (h).walls
#define CONDUCTION_OF_ROWS(rows, n, lane, h) (h).contacts = ROW_NUMBER(rows, n, lane), (h).walls = ROW_NUMBER(rows, (n) + 1, lane)
