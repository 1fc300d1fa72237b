/* wall heat: walls are adiabatic. */
#define WALL_HEAT_PAIR_FIELDS(READ, WRITE)
#define WALL_HEAT_FLOW(launch, face, c, conductance) (void)(conductance), R(0.0)
#define WALL_HEAT_CONDUCTS(launch, face) R(0.0)
