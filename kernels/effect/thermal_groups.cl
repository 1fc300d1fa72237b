/* thermal groups: grains whose temperature is prescribed, or that are given heat. Reads the row of the grain's group, -1 for free grains. */
#ifndef THERMAL_GROUPS
#define THERMAL_GROUPS 1
#endif
#define THERMAL_GROUP_PARTICLE_FIELDS(READ, WRITE) READ(int, thermal_group) READ(clast_group_heat, group_heat)
#define THERMAL_GROUP_ROW(launch) (group_heat + (launch)->heat_row * THERMAL_GROUPS)
#define THERMAL_GROUP_HEAT(launch, i) thermal_group_heat(THERMAL_GROUP_ROW(launch), thermal_group[i])
#define THERMAL_GROUP_TEMPERATURE(launch, i, t) thermal_group_temperature(THERMAL_GROUP_ROW(launch), thermal_group[i], t)
/* True where the temperature is prescribed. */
#define THERMAL_GROUP_HOLDS(launch, i) thermal_group_holds(THERMAL_GROUP_ROW(launch), thermal_group[i])

INLINE bool thermal_group_holds(__global const clast_group_heat *row, int group)
{
    return group >= 0 && row[group].prescribed;
}

/* W */
INLINE real thermal_group_heat(__global const clast_group_heat *row, int group)
{
    return group >= 0 ? number(row[group].heat) : R(0.0);
}

/* At the end of the step. */
INLINE precise thermal_group_temperature(__global const clast_group_heat *row, int group, precise free)
{
    if (group >= 0 && row[group].prescribed)
        return precise_load(row[group].temperature);
    return free;
}
