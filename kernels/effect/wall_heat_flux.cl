/* wall heat: some walls give a prescribed flow of heat, shared among the grains that touch them by area of contact; others have a prescribed
 * temperature or are adiabatic. Areas are summed beforehand as whole numbers of a small unit, so that their order does not matter, and shared
 * as the same whole numbers, so that nothing is lost. Reads wall_heat by face and wall_area by wall. */
#define WALL_HEAT_PAIR_FIELDS(READ, WRITE) READ(clast_wall_heat, wall_heat) READ(clast_i64, wall_area)
#define WALL_HEAT_ROW(launch, face) (wall_heat + (launch)->heat_row * (launch)->face_count + (face))
#define WALL_HEAT_FLOW(launch, face, c, conductance) wall_heat_flow(WALL_HEAT_ROW(launch, face), wall_area, c, conductance)
/* 1 where the wall has a temperature of its own. */
#define WALL_HEAT_CONDUCTS(launch, face) (WALL_HEAT_ROW(launch, face)->kind == CLAST_WALL_TEMPERATURE ? R(1.0) : R(0.0))

/* Area d (2 r - d) of the cut, over pi, in units of the wall's quantum. */
INLINE clast_i64 wall_heat_area(__global const clast_wall_heat *wall, const contact *c)
{
    return (clast_i64)(number(wall->quantum) * c->touch * (R(2.0) * c->radius_i - c->touch));
}

INLINE real wall_heat_flow(__global const clast_wall_heat *wall, __global const clast_i64 *wall_area, const contact *c, real conductance)
{
    if (wall->kind == CLAST_WALL_TEMPERATURE)
        return conductance * (number(wall->temperature) - c->temperature_i);
    clast_i64 all = wall->kind == CLAST_WALL_FLUX ? wall_area[wall->wall] : 0;
    return all > 0 ? number(wall->flux) * ((real)wall_heat_area(wall, c) / (real)all) : R(0.0);
}
