/* environment: temperature and velocity of the gas, the same everywhere; both may vary in time, a row a step. */
#define ENVIRONMENT_PARTICLE_FIELDS(READ, WRITE) READ(clast_environment, environment)
#define ENVIRONMENT_AT(launch, g) environment_at(environment + (launch)->heat_row, g)

INLINE void environment_at(__global const clast_environment *row, grain *g)
{
    g->surroundings = number(row->temperature);
    g->gas = from3(row->gas_velocity);
}
