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

/* The grain as it is at the start of the step: rises of the step are counted in heat over its capacity, so that what is stored is what flows in
 * though the capacity depends on temperature. */
INLINE grain frozen_start(int i, const grain *g PARTICLE_DECLARE)
{
    grain start = *g;
    start.temperature = TEMPERATURE_OF_GRAIN(i);
    return start;
}

/* K/s, counted so. */
INLINE real frozen_rate(const grain *start, const grain_heat *h)
{
    return (h->contacts + h->sources + (h->convection + h->radiation)) / temperature_capacity(start);
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
    grain at_start = frozen_start(i, &g PARTICLE_PASS);
    real rate = frozen_rate(&at_start, &h), start_rate = first ? rate : start[i];
    start[i] = start_rate;
    real lift = mu * temperature_lift(&at_start, rises[i]) + nu * temperature_lift(&at_start, before[i]) + slope * rate + start_slope * start_rate;
    after[i] = frozen_held(&then, i, temperature_drop(&at_start, lift) PARTICLE_PASS);
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
    grain at_start = frozen_start(i, &g PARTICLE_PASS);
    real rate = frozen_rate(&at_start, &h), off = R(0.4) * step * (start[i] + rate) - R(0.8) * temperature_lift(&at_start, rises[i]);
    error[i] = free ? off : R(0.0);
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
        real off = is_number(error[i]) ? fabs(error[i]) : R(1e30);
        worst = off > worst ? off : worst;
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

/* Temperatures take the rises of a step; what prescribed ones took (or `all`: in a jump to the steady state) comes from a source. */
__kernel void heat_frozen_accept(const clast_launch launch, __global const real *restrict rises, __global const real *restrict kept, const int all PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    grain g;
    grain_heat h;
    particle_grain(&launch, i, &g PARTICLE_PASS);
    HEAT_TALLY_KEPT(kept, i, &h);
    if (all || THERMAL_GROUP_HOLDS(&launch, i))
        h.sources = temperature_heat(&g, rises[i]) - (h.contacts + h.convection + h.radiation);
    precise after = temperature_after(TEMPERATURE_PRECISE(i), rises[i]);
    TEMPERATURE_STORE(i, after);
    MODULUS_STORE(i, &g, after);
    RESISTIVITY_STORE(i, &g, after);
    real grown = RADIUS_STORE(i, &g, after);
    precise3 w = ROTATION_PRECISE(&launch, i);
    INTEGRATOR_KEEP_SPIN(i, RADIUS_SPIN(i, INTEGRATOR_SPIN(i, w), grown));
    ROTATION_STORE(&launch, i, RADIUS_SPIN(i, w, grown));
    GROWTH_KEEP(i, GROWTH_OF(i) + grown);
    HEAT_TALLY_ADD(i, &h);
}

/* What conductances depend on, at the temperatures that a share of the rises leads to. */
__kernel void heat_frozen_probe(const clast_launch launch, __global const real *restrict rises, const real share PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    grain g;
    particle_grain(&launch, i, &g PARTICLE_PASS);
    precise then = temperature_after(TEMPERATURE_PRECISE(i), share * rises[i]);
    (void)then;
    RESISTIVITY_STORE(i, &g, then);
    (void)RADIUS_STORE(i, &g, then);
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
        most = fmax(most, sum / temperature_capacity_least(&g));
    }
    partial[chunk] = precise_store(precise_from(most));
}

/* ---- linear systems: steps of implicit methods, and the steady state ---- */

/* What flows into a grain at its rise less what a step stores of it, sigma m c (rise - known), W, with what is known counted in heat as
 * frozen_start has it; and of the matrix of what that changes by:
 * the part that a grain has with its own surroundings (`slope`), and the whole diagonal. A diagonal of zero: the temperature is given. With
 * `chord` radiation's slope is at least that of the line to the surroundings, so that no step goes past them. */
__kernel void heat_frozen_residual(const clast_launch launch, FROZEN_DECLARE, __global const real *restrict known, __global const int *restrict fixed,
                                   __global real *restrict residual, __global real *restrict slope, __global real *restrict diagonal, const real sigma,
                                   const int chord PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    grain g, like;
    grain_heat h;
    frozen_flows(&launch, i, &g, &h, FROZEN_PASS PARTICLE_PASS);
    real stored = sigma * temperature_capacity(&g), links = R(0.0), straight = radiation_coefficient(&g, g.temperature);
    like = g;
    like.surroundings = g.temperature;
    real tangent = radiation_coefficient(&like, g.temperature);
    real own = stored + convection_coefficient(&g, g.temperature) + (chord && straight > tangent ? straight : tangent);
    uint last = slot_offset[i / CLAST_BLOCK + 1];
    for (uint s = slot_offset[i / CLAST_BLOCK] + i % CLAST_BLOCK; s < last; s += CLAST_BLOCK) {
        own += link[s] < 0 ? conductance[s] : R(0.0);
        links += link[s] < 0 ? R(0.0) : conductance[s];
    }
    bool given_here = i >= launch.particle_count || fixed[i] || THERMAL_GROUP_HOLDS(&launch, i);
    grain at_start = frozen_start(i, &g PARTICLE_PASS);
    real kept_heat = sigma * temperature_capacity(&at_start) * (temperature_lift(&at_start, rises[i]) - known[i]);
    real rest = h.contacts + h.sources + (h.convection + h.radiation) - kept_heat;
    residual[i] = given_here ? R(0.0) : rest;
    slope[i] = given_here ? R(0.0) : own;
    diagonal[i] = given_here ? R(0.0) : own + links;
}

/* Conjugate gradients with the diagonal as preconditioner (Hestenes & Stiefel 1952). Dot products: one number a work-group, folded in the order
 * of the groups; the scalars stay on the device. */
#define FROZEN_SUM(value, partial)                               \
    __local real part[CLAST_BLOCK];                              \
    part[get_local_id(0)] = (value);                             \
    barrier(CLK_LOCAL_MEM_FENCE);                                \
    if (get_local_id(0) == 0) {                                  \
        real all = R(0.0);                                       \
        for (int n = 0; n < CLAST_BLOCK; n++)                    \
            all += part[n];                                      \
        partial[get_group_id(0)] = all;                          \
    }

INLINE real frozen_scaled(real residual, real diagonal)
{
    return diagonal > R(0.0) ? residual / diagonal : R(0.0);
}

__kernel __attribute__((reqd_work_group_size(CLAST_BLOCK, 1, 1))) void heat_frozen_cg_begin(__global const real *restrict residual,
                                                                                            __global const real *restrict diagonal,
                                                                                            __global real *restrict x, __global real *restrict p,
                                                                                            __global real *restrict partial)
{
    int i = get_global_id(0);
    real z = frozen_scaled(residual[i], diagonal[i]);
    x[i] = R(0.0);
    p[i] = z;
    FROZEN_SUM(residual[i] * z, partial)
}

__kernel __attribute__((reqd_work_group_size(CLAST_BLOCK, 1, 1))) void
heat_frozen_cg_apply(__global const uint *restrict slot_offset, __global const int *restrict link, __global const real *restrict conductance,
                     __global const real *restrict slope, __global const real *restrict diagonal, __global const real *restrict p,
                     __global real *restrict q, __global real *restrict partial)
{
    int i = get_global_id(0);
    real here = p[i], sum = slope[i] * here;
    uint last = slot_offset[i / CLAST_BLOCK + 1];
    for (uint s = slot_offset[i / CLAST_BLOCK] + i % CLAST_BLOCK; s < last; s += CLAST_BLOCK)
        sum += link[s] < 0 ? R(0.0) : conductance[s] * (here - p[link[s] < 0 ? i : link[s]]);
    sum = diagonal[i] > R(0.0) ? sum : R(0.0);
    q[i] = sum;
    FROZEN_SUM(here * sum, partial)
}

#define FROZEN_RZ 0
#define FROZEN_ALPHA 1
#define FROZEN_BETA 2
#define FROZEN_RZ_START 3

__kernel __attribute__((reqd_work_group_size(CLAST_BLOCK, 1, 1))) void heat_frozen_cg_update(__global const real *restrict scalar,
                                                                                             __global const real *restrict p,
                                                                                             __global const real *restrict q,
                                                                                             __global const real *restrict diagonal,
                                                                                             __global real *restrict x, __global real *restrict residual,
                                                                                             __global real *restrict partial)
{
    int i = get_global_id(0);
    real r = residual[i] - scalar[FROZEN_ALPHA] * q[i];
    x[i] += scalar[FROZEN_ALPHA] * p[i];
    residual[i] = r;
    FROZEN_SUM(r * frozen_scaled(r, diagonal[i]), partial)
}

__kernel void heat_frozen_cg_turn(__global const real *restrict scalar, __global const real *restrict residual, __global const real *restrict diagonal,
                                  __global real *restrict p)
{
    int i = get_global_id(0);
    p[i] = frozen_scaled(residual[i], diagonal[i]) + scalar[FROZEN_BETA] * p[i];
}

/* One work-group. `what`: 0 the first r z, 1 p q, 2 the next r z. */
__kernel __attribute__((reqd_work_group_size(CLAST_BLOCK, 1, 1))) void heat_frozen_cg_fold(__global const real *restrict partial, const int groups,
                                                                                           __global real *restrict scalar, const int what)
{
    __local real part[CLAST_BLOCK];
    int lane = get_local_id(0);
    precise sum = precise_from(R(0.0));
    for (int n = lane; n < groups; n += CLAST_BLOCK)
        sum = precise_add(sum, precise_from(partial[n]));
    part[lane] = rounded(sum);
    barrier(CLK_LOCAL_MEM_FENCE);
    if (lane == 0) {
        precise all = precise_from(R(0.0));
        for (int n = 0; n < CLAST_BLOCK; n++)
            all = precise_add(all, precise_from(part[n]));
        real value = rounded(all), before = scalar[FROZEN_RZ];
        if (what == 1) {
            scalar[FROZEN_ALPHA] = value > R(0.0) ? before / value : R(0.0);
        } else {
            scalar[FROZEN_BETA] = what == 2 && before > R(0.0) ? value / before : R(0.0);
            scalar[FROZEN_RZ] = value;
            scalar[FROZEN_RZ_START] = what == 0 ? value : scalar[FROZEN_RZ_START];
        }
    }
}

/* A correction, within the interval given. */
__kernel void heat_frozen_correct(const clast_launch launch, __global const real *restrict correction, __global real *restrict rises, const real low,
                                  const real high PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    precise here = TEMPERATURE_PRECISE(i);
    real least = rounded(precise_sub(precise_from(low), here)), most = rounded(precise_sub(precise_from(high), here)), rise = rises[i] + correction[i];
    rise = rise < least ? least : (rise > most ? most : rise);
    rises[i] = correction[i] != R(0.0) ? rise : rises[i];
}

/* Rises of prescribed grains in the row of the tables; others stay. */
__kernel void heat_frozen_hold(const clast_launch launch, __global real *restrict rises PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    rises[i] = frozen_held(&launch, i, rises[i] PARTICLE_PASS);
}

/* For the host's search of clusters without a sink: what draws a grain to fixed temperatures (W/K), its capacity (J/K) and what heats it (W). */
__kernel void heat_frozen_sinks(const clast_launch launch, FROZEN_DECLARE, __global real *restrict sink, __global real *restrict capacity,
                                __global real *restrict source PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    grain g;
    grain_heat h;
    frozen_flows(&launch, i, &g, &h, FROZEN_PASS PARTICLE_PASS);
    real sum = convection_coefficient(&g, g.temperature) + radiation_coefficient(&g, g.temperature);
    uint last = slot_offset[i / CLAST_BLOCK + 1];
    for (uint s = slot_offset[i / CLAST_BLOCK] + i % CLAST_BLOCK; s < last; s += CLAST_BLOCK)
        sum += link[s] < 0 ? conductance[s] : R(0.0);
    sink[i] = THERMAL_GROUP_HOLDS(&launch, i) ? R(1.0) : sum;
    capacity[i] = temperature_capacity(&g);
    source[i] = h.sources + given[i];
}

/* What a rise of `error` stores at sigma, W; 0 where the temperature is given. */
__kernel void heat_frozen_store(const clast_launch launch, __global const real *restrict error, __global const real *restrict diagonal,
                                __global real *restrict residual, const real sigma PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    grain g;
    particle_grain(&launch, i, &g PARTICLE_PASS);
    residual[i] = diagonal[i] > R(0.0) ? sigma * temperature_capacity(&g) * error[i] : R(0.0);
}

/* A share of the heat that rises stand for, counted as frozen_start has it. */
__kernel void heat_frozen_scale(const clast_launch launch, __global const real *restrict from, __global real *restrict to, const real factor PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    grain g;
    particle_grain(&launch, i, &g PARTICLE_PASS);
    to[i] = factor * temperature_lift(&g, from[i]);
}
