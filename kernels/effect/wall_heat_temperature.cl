/* wall heat: walls of prescribed temperature, which may vary in time, a row a step; others are adiabatic. Reads wall_heat by face. */
#define WALL_HEAT_PAIR_FIELDS(READ, WRITE) READ(clast_wall_heat, wall_heat)
#define WALL_HEAT_ROW(launch, face) (wall_heat + (launch)->heat_row * (launch)->face_count + (face))
#define WALL_HEAT_FLOW(launch, face, c, conductance) wall_heat_flow(WALL_HEAT_ROW(launch, face), c, conductance)
/* 1 where the wall has a temperature of its own. */
#define WALL_HEAT_CONDUCTS(launch, face) (WALL_HEAT_ROW(launch, face)->kind == CLAST_WALL_TEMPERATURE ? R(1.0) : R(0.0))

INLINE real wall_heat_flow(__global const clast_wall_heat *wall, const contact *c, real conductance)
{
    return wall->kind == CLAST_WALL_TEMPERATURE ? conductance * (number(wall->temperature) - c->temperature_i) : R(0.0);
}
