/* dissipation heat: a fraction of what damping, sliding and rolling of a contact dissipate heats the two bodies, half each; at a wall, which is
 * rigid and loses nothing, all of it the grain. Reads DISSIPATION_FRACTION. A record holds what each grain of it gets in this step, J. */
#ifndef DISSIPATION_FRACTION
#define DISSIPATION_FRACTION R(1.0)
#endif
#define DISSIPATION_HEAT_PAIR_FIELDS(READ, WRITE) WRITE(real, dissipation_heat)
#define DISSIPATION_HEAT_PARTICLE_FIELDS(READ, WRITE) READ(real, dissipation_heat)
#define DISSIPATION_HEAT_STORE(launch, k, lost, share) \
    dissipation_heat[k] = (share)*DISSIPATION_FRACTION * ((lost).normal + (lost).tangential + (lost).rolling)
#define DISSIPATION_HEAT_GATHER(launch, i, sum)                                                                     \
    do {                                                                                                            \
        uint end = slot_offset[(i) / CLAST_BLOCK + 1];                                                              \
        for (uint s = slot_offset[(i) / CLAST_BLOCK] + (i) % CLAST_BLOCK; s < end && slots[s] != 0; s += CLAST_BLOCK) \
            sum += dissipation_heat[(slots[s] > 0 ? slots[s] : -slots[s]) - 1];                                     \
    } while (0)
