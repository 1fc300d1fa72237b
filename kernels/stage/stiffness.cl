/* How fast heat changes what contacts are made of, from the flows as they stand: for the limit of the step. In programs whose moduli or radii depend
 * on temperature. */

/* Rate at which grain i's temperature changes, K/s: what flows in and what its contacts dissipate, or what is prescribed for the end of
 * the step. */
INLINE real stiffness_heating(const clast_launch *launch, int i, const grain *g PARTICLE_DECLARE)
{
    real flow = R(0.0), rubbed = R(0.0), apart = g->surroundings - g->temperature, dt = number(launch->dt);
    uint last = slot_offset[i / CLAST_BLOCK + 1];
    for (uint s = slot_offset[i / CLAST_BLOCK] + i % CLAST_BLOCK; s < last && slots[s] != 0; s += CLAST_BLOCK)
        flow += CONDUCTION_GATHER(launch, (slots[s] > 0 ? slots[s] : -slots[s]) - 1, slots[s] > 0 ? R(1.0) : R(-1.0));
    flow += SOURCE_HEAT(launch, i, g) + generation_heat(g) + THERMAL_GROUP_HEAT(launch, i);
    flow += convection_coefficient(g, g->temperature) * apart + radiation_coefficient(g, g->temperature) * apart;
    DISSIPATION_HEAT_GATHER(launch, i, rubbed); /* J, of a step */
    flow += dt > R(0.0) ? rubbed / dt : R(0.0);
    precise here = TEMPERATURE_PRECISE(i), held = THERMAL_GROUP_TEMPERATURE(launch, i, here);
    real driven = dt > R(0.0) ? rounded(precise_sub(held, here)) / dt : R(0.0);
    return THERMAL_GROUP_HOLDS(launch, i) ? driven : flow / temperature_capacity(g);
}

/* Per chunk of grains the largest rate of change of the logarithm of a modulus, 1/s, and of a radius, m/s. */
BODY void stiffness_rate_unit(int chunk, const clast_launch *launch, __global exact *restrict partial PARTICLE_DECLARE)
{
    int first = chunk * OBSERVE_CHUNK, end = min(first + OBSERVE_CHUNK, launch->particle_count);
    real modulus = R(0.0), radial = R(0.0);
    for (int i = first; i < end; i++) {
        grain g;
        particle_grain(launch, i, &g PARTICLE_PASS);
        real rate = stiffness_heating(launch, i, &g PARTICLE_PASS);
        modulus = fmax(modulus, fabs(MODULUS_RATE(&g, rate)));
        radial = fmax(radial, fabs(RADIUS_RATE(i, &g, rate)));
    }
    partial[2 * chunk] = precise_store(precise_from(modulus));
    partial[2 * chunk + 1] = precise_store(precise_from(radial));
}

__kernel void stiffness_rate(const clast_launch launch, __global exact *restrict partial PARTICLE_DECLARE)
{
    stiffness_rate_unit(get_global_id(0), &launch, partial PARTICLE_PASS);
}
