/* What the limit of the thermal step, observables and methods for frozen beds read of heat. In programs with a temperature only. */

/* Every record's conductance where its heat stands, W/K; 0 at a wall that has no temperature of its own. */
INLINE void heat_conductance(const clast_launch *launch, int k, bool wall PAIR_DECLARE)
{
    contact c;
    wall_touch touch;
    if (wall)
        contact_of_wall(launch, k, &c, &touch PAIR_PASS);
    else
        contact_of_grains(launch, k, &c PAIR_PASS);
    c.dt = R(0.0);
    c.value = contact_constants + c.class * CONTACT_CONSTANTS;
    bond_state bond;
    BOND_LOAD(launch, k, bond);
    bond_geometry(&c, &bond); /* a neck may conduct */
    real conductance = wall ? WALL_HEAT_CONDUCTS(launch, other[k]) * conduction_wall_conductance(&c) : conduction_conductance(&c);
    CONDUCTION_STORE(launch, k, conductance);
}

RECORD_KERNEL(heat_conductances, heat_conductance)

/* Per chunk of grains the smallest m c/(sum of what draws its temperature towards others'): by conduction, convection, radiation to a surface
 * at most `hottest`, and by all. Reads the records' conductances. */
#define HEAT_LIMITS 4

BODY void heat_limit_unit(int chunk, const clast_launch *launch, __global exact *restrict partial, const real hottest PARTICLE_DECLARE)
{
    int first = chunk * OBSERVE_CHUNK, end = min(first + OBSERVE_CHUNK, launch->particle_count);
    real least[HEAT_LIMITS] = {R(1e30), R(1e30), R(1e30), R(1e30)};
    for (int i = first; i < end; i++) {
        grain g;
        particle_grain(launch, i, &g PARTICLE_PASS);
        real conduction = R(0.0);
        uint last = slot_offset[i / CLAST_BLOCK + 1];
        for (uint s = slot_offset[i / CLAST_BLOCK] + i % CLAST_BLOCK; s < last && slots[s] != 0; s += CLAST_BLOCK)
            conduction += CONDUCTION_GATHER(launch, (slots[s] > 0 ? slots[s] : -slots[s]) - 1, R(1.0));
        real convection = convection_coefficient(&g, g.temperature), radiation = radiation_coefficient(&g, hottest);
        const real rates[HEAT_LIMITS] = {conduction, convection, radiation, conduction + convection + radiation};
        for (int q = 0; q < HEAT_LIMITS; q++)
            least[q] = rates[q] > R(0.0) ? fmin(least[q], temperature_capacity_least(&g) / rates[q]) : least[q];
    }
    for (int q = 0; q < HEAT_LIMITS; q++)
        partial[HEAT_LIMITS * chunk + q] = precise_store(precise_from(least[q]));
}

__kernel void heat_limit(const clast_launch launch, __global exact *restrict partial, const real hottest PARTICLE_DECLARE)
{
    heat_limit_unit(get_global_id(0), &launch, partial, hottest PARTICLE_PASS);
}

/* Sums in the order of permanent ids: heat content, sum of temperatures, number of grains, the smallest with its sign turned and the largest temperature, and what each
 * path has brought, where that is kept. `ahead`: with what the records hold of the half step to come (particle_heat_ahead). */
#define HEAT_SUMS (5 + CLAST_TALLIES)

BODY void heat_sums_unit(int chunk, const clast_launch *launch, __global const int *restrict where, __global exact *restrict partial,
                         const int id_count, const int ahead PARTICLE_DECLARE)
{
    int first = chunk * OBSERVE_CHUNK, end = min(first + OBSERVE_CHUNK, id_count);
    precise sum[HEAT_SUMS];
    for (int q = 0; q < HEAT_SUMS; q++)
        sum[q] = precise_from(R(0.0));
    sum[3] = precise_from(R(-1e30));
    for (int n = first; n < end; n++) {
        int i = where[n];
        if (i < 0)
            continue;
        grain g;
        particle_grain(launch, i, &g PARTICLE_PASS);
        grain_heat h = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
        precise t = ahead ? particle_heat_ahead(launch, i, &g, &h PARTICLE_PASS) : TEMPERATURE_PRECISE(i);
        sum[0] = precise_add(sum[0], temperature_content(&g, t));
        sum[1] = precise_add(sum[1], t);
        sum[2] = precise_add(sum[2], precise_from(R(1.0)));
        sum[3] = precise_max(sum[3], precise_sub(precise_from(R(0.0)), t));
        sum[4] = precise_max(sum[4], t);
        for (int q = 0; q < CLAST_TALLIES; q++)
            sum[5 + q] = precise_add(sum[5 + q], HEAT_TALLY_OF(i, q));
        sum[5 + CLAST_TALLY_DISSIPATION] = precise_add(sum[5 + CLAST_TALLY_DISSIPATION], precise_from(h.rubbed));
        sum[5 + CLAST_TALLY_SOURCES] = precise_add(sum[5 + CLAST_TALLY_SOURCES], precise_from(h.sources));
    }
    for (int q = 0; q < HEAT_SUMS; q++)
        partial[HEAT_SUMS * chunk + q] = precise_store(sum[q]);
}

__kernel void heat_sums(const clast_launch launch, __global const int *restrict where, __global exact *restrict partial,
                        const int id_count, const int ahead PARTICLE_DECLARE)
{
    heat_sums_unit(get_global_id(0), &launch, where, partial, id_count, ahead PARTICLE_PASS);
}

/* Every grain's temperature with what the records hold of the half step to come. */
__kernel void heat_ahead(const clast_launch launch, __global exact *restrict ahead PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    grain g;
    grain_heat h = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
    particle_grain(&launch, i, &g PARTICLE_PASS);
    ahead[i] = precise_store(particle_heat_ahead(&launch, i, &g, &h PARTICLE_PASS));
}

/* What draws every grain's temperature towards the environment's, from a surface at most `hottest`, W/K. */
__kernel void heat_surfaces(const clast_launch launch, __global exact *restrict coefficient, const real hottest PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    grain g;
    if (i >= launch.particle_count)
        return;
    particle_grain(&launch, i, &g PARTICLE_PASS);
    coefficient[i] = precise_store(precise_from(convection_coefficient(&g, g.temperature) + radiation_coefficient(&g, hottest)));
}

/* What waits for its step comes due: at the end of a stage in which heat advances in every n-th step. */
__kernel void heat_flush(const clast_launch launch PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    grain g;
    grain_heat h = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
    if (i >= launch.particle_count)
        return;
    particle_grain(&launch, i, &g PARTICLE_PASS);
    particle_heat(&launch, i, &g, &h PARTICLE_PASS);
}
