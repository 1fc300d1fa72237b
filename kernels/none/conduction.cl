/* conduction: none. */
#define CONDUCTION_PAIR_FIELDS(READ, WRITE)
#define CONDUCTION_PARTICLE_FIELDS(READ, WRITE)
#define CONDUCTION_STORE(launch, k, flow) (void)(flow)
#define CONDUCTION_GATHER(launch, k, sign) R(0.0)
#define CONDUCTION_ROWS 0
#define CONDUCTION_TO_ROWS(rows, n, lane, h) (void)(h)
#define CONDUCTION_OF_ROWS(rows, n, lane, h) (h).contacts = (h).walls = R(0.0)

INLINE real conduction_conductance(const contact *c)
{
    (void)c;
    return R(0.0);
}

INLINE real conduction_wall_conductance(const contact *c)
{
    (void)c;
    return R(0.0);
}
