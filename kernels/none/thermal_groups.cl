/* thermal groups: every grain's temperature is free. */
#define THERMAL_GROUP_PARTICLE_FIELDS(READ, WRITE)
#define THERMAL_GROUP_HEAT(launch, i) R(0.0)
#define THERMAL_GROUP_TEMPERATURE(launch, i, t) (t)
#define THERMAL_GROUP_HOLDS(launch, i) ((i) < 0)
