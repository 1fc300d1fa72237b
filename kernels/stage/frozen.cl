/* Heat on the contact network as it stands, for stages in which nothing moves: what the records conduct is found once, and then temperatures
 * alone change. A slot of a grain holds its link (the other grain, -1 - face for a wall, the grain itself where nothing is conducted) and the
 * link's conductance; sums run in slot order. Stages of a step are kept as rises above the temperature at its start, so that a grain at rest
 * stays at rest to the last bit, and nothing is lost to rounding. In programs of frozen stages only (docs/theory.md, "Heat while nothing
 * moves"). */

/* Heat that walls give as prescribed: it does not depend on temperatures. Reads the records' flows. */
__kernel void heat_frozen_given(const clast_launch launch, __global const int *restrict other, __global const clast_wall_heat *restrict walls,
                                __global real *restrict given PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    real sum = R(0.0);
    uint last = slot_offset[i / CLAST_BLOCK + 1];
    for (uint s = slot_offset[i / CLAST_BLOCK] + i % CLAST_BLOCK; s < last && slots[s] != 0; s += CLAST_BLOCK) {
        int k = (slots[s] > 0 ? slots[s] : -slots[s]) - 1;
        if (k >= launch.first_wall_group * CLAST_BLOCK && walls[other[k]].kind == CLAST_WALL_FLUX)
            sum += CONDUCTION_GATHER(&launch, k, R(1.0));
    }
    given[i] = sum;
}

/* Reads the records' conductances. */
__kernel void heat_frozen_links(const clast_launch launch, __global const int *restrict owner, __global const int *restrict other,
                                __global int *restrict link, __global real *restrict conductance PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    uint last = slot_offset[i / CLAST_BLOCK + 1];
    for (uint s = slot_offset[i / CLAST_BLOCK] + i % CLAST_BLOCK; s < last; s += CLAST_BLOCK) {
        int entry = slots[s], k = (entry > 0 ? entry : -entry) - 1;
        real conducts = entry != 0 ? CONDUCTION_GATHER(&launch, k, R(1.0)) : R(0.0);
        conductance[s] = conducts;
        link[s] = i;
        if (conducts != R(0.0))
            link[s] = k >= launch.first_wall_group * CLAST_BLOCK ? -1 - other[k] : (entry > 0 ? other[k] : owner[k]);
    }
}

#define FROZEN_DECLARE                                                                                                                   \
    __global const int *restrict link, __global const real *restrict conductance, __global const real *restrict given,                  \
        __global const clast_wall_heat *restrict walls, __global const real *restrict rises
#define FROZEN_PASS link, conductance, given, walls, rises

/* Flows into grain i, W, by path, where its temperature and the others' have risen by `rises`; the grain as it then is. */
INLINE void frozen_flows(const clast_launch *launch, int i, grain *g, grain_heat *h, FROZEN_DECLARE PARTICLE_DECLARE)
{
    precise here = TEMPERATURE_PRECISE(i);
    real rise = rises[i], contacts = R(0.0), from_walls = given[i];
    uint last = slot_offset[i / CLAST_BLOCK + 1];
    particle_grain(launch, i, g PARTICLE_PASS);
    for (uint s = slot_offset[i / CLAST_BLOCK] + i % CLAST_BLOCK; s < last; s += CLAST_BLOCK) {
        int j = link[s];
        if (j >= 0) {
            contacts += conductance[s] * (rounded(precise_sub(TEMPERATURE_PRECISE(j), here)) + (rises[j] - rise));
        } else {
            precise wall = precise_load(walls[launch->heat_row * launch->face_count - 1 - j].temperature);
            from_walls += conductance[s] * (rounded(precise_sub(wall, here)) - rise);
        }
    }
    g->temperature = rounded(precise_add(here, precise_from(rise)));
    real apart = g->surroundings - g->temperature;
    h->contacts = contacts + from_walls;
    h->walls = from_walls;
    h->absorbed = SOURCE_HEAT(launch, i, g);
    h->sources = h->absorbed + generation_heat(g) + THERMAL_GROUP_HEAT(launch, i);
    h->convection = convection_coefficient(g, g->temperature) * apart;
    h->radiation = radiation_coefficient(g, g->temperature) * apart;
}

/* K/s */
INLINE real frozen_rate(const grain *g, const grain_heat *h)
{
    return (h->contacts + h->sources + (h->convection + h->radiation)) / temperature_capacity(g);
}

/* The rise of grain i, or that which is prescribed for it in a row of the tables. */
INLINE real frozen_held(const clast_launch *launch, int i, real rise PARTICLE_DECLARE)
{
    precise here = TEMPERATURE_PRECISE(i);
    return THERMAL_GROUP_HOLDS(launch, i) ? rounded(precise_sub(THERMAL_GROUP_TEMPERATURE(launch, i, here), here)) : rise;
}

/* One stage of a step: after = mu rises + nu before + slope rate(rises) + start_slope rate(0). The first stage finds rate(0). Its flows count
 * for the tally with the weight that they have in the step as a whole. */
__kernel void heat_frozen_stage(const clast_launch launch, FROZEN_DECLARE, __global const real *restrict before, __global real *restrict after,
                                __global real *restrict start, __global real *restrict kept, const real mu, const real nu, const real slope,
                                const real start_slope, const real weight, const int row_after, const int first PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    grain g;
    grain_heat h;
    clast_launch then = launch;
    then.heat_row = row_after;
    frozen_flows(&launch, i, &g, &h, FROZEN_PASS PARTICLE_PASS);
    real rate = frozen_rate(&g, &h), start_rate = first ? rate : start[i];
    start[i] = start_rate;
    after[i] = frozen_held(&then, i, mu * rises[i] + nu * before[i] + slope * rate + start_slope * start_rate PARTICLE_PASS);
    HEAT_TALLY_KEEP(kept, i, &h, weight, first);
}

/* Estimate of the error of a step: that of its end against the trapezoidal rule (Sommeijer, Shampine & Verwer 1998, Eq. 2.8). */
__kernel void heat_frozen_error(const clast_launch launch, FROZEN_DECLARE, __global const real *restrict start, __global real *restrict error,
                                __global real *restrict rates, const real step PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    grain g;
    grain_heat h;
    frozen_flows(&launch, i, &g, &h, FROZEN_PASS PARTICLE_PASS);
    bool free = i < launch.particle_count && !THERMAL_GROUP_HOLDS(&launch, i);
    real rate = frozen_rate(&g, &h), off = R(0.4) * step * (start[i] + rate) - R(0.8) * rises[i];
    error[i] = free ? fabs(off) : R(0.0);
    rates[i] = free ? fabs(rate) : R(0.0);
}

#define FROZEN_FINDINGS 4

/* Per chunk of grains: largest error, largest rate, largest temperature, and the smallest with its sign turned. What is not a number shows in
 * the error. */
__kernel void heat_frozen_findings(const clast_launch launch, __global const real *restrict rises, __global const real *restrict error,
                                   __global const real *restrict rates, __global exact *restrict partial PARTICLE_DECLARE)
{
    int chunk = get_global_id(0), first = chunk * OBSERVE_CHUNK, end = min(first + OBSERVE_CHUNK, launch.particle_count);
    real worst = R(0.0), fastest = R(0.0);
    precise hot = precise_from(R(-1e30)), cold = hot;
    for (int i = first; i < end; i++) {
        precise t = precise_add(TEMPERATURE_PRECISE(i), precise_from(rises[i]));
        worst = error[i] <= worst ? worst : (error[i] >= R(0.0) ? error[i] : R(1e30));
        fastest = rates[i] <= fastest ? fastest : rates[i];
        hot = precise_max(hot, t);
        cold = precise_max(cold, precise_sub(precise_from(R(0.0)), t));
    }
    __global exact *out = partial + FROZEN_FINDINGS * chunk;
    out[0] = precise_store(precise_from(worst));
    out[1] = precise_store(precise_from(fastest));
    out[2] = precise_store(hot);
    out[3] = precise_store(cold);
}

/* Temperatures take the rises of a step; what prescribed ones took comes from a source. */
__kernel void heat_frozen_accept(const clast_launch launch, __global const real *restrict rises, __global const real *restrict kept PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    grain g;
    grain_heat h;
    particle_grain(&launch, i, &g PARTICLE_PASS);
    HEAT_TALLY_KEPT(kept, i, &h);
    if (THERMAL_GROUP_HOLDS(&launch, i))
        h.sources = temperature_capacity(&g) * rises[i] - (h.contacts + h.convection + h.radiation);
    TEMPERATURE_STORE(i, temperature_after(TEMPERATURE_PRECISE(i), rises[i]));
    HEAT_TALLY_ADD(i, &h);
}

/* Per chunk the largest rate at which what draws a grain's temperature, 1/s, up to surfaces at `hottest`: half of Gershgorin's bound of the
 * spectrum. Radiation enters by its slope, that of surroundings as hot as the surface. */
__kernel void heat_frozen_spectrum(const clast_launch launch, __global const real *restrict conductance, __global exact *restrict partial,
                                   const real hottest PARTICLE_DECLARE)
{
    int chunk = get_global_id(0), first = chunk * OBSERVE_CHUNK, end = min(first + OBSERVE_CHUNK, launch.particle_count);
    real most = R(0.0);
    for (int i = first; i < end; i++) {
        grain g;
        real sum = R(0.0);
        uint last = slot_offset[i / CLAST_BLOCK + 1];
        particle_grain(&launch, i, &g PARTICLE_PASS);
        for (uint s = slot_offset[i / CLAST_BLOCK] + i % CLAST_BLOCK; s < last; s += CLAST_BLOCK)
            sum += conductance[s];
        sum += convection_coefficient(&g, g.temperature);
        g.surroundings = hottest;
        sum += radiation_coefficient(&g, hottest);
        most = fmax(most, sum / temperature_capacity(&g));
    }
    partial[chunk] = precise_store(precise_from(most));
}
