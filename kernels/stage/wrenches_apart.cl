/* What records give their two bodies, a component side by side for all records, as the forms with an item to a record have it too. Its twin is
 * wrenches_together.cl. */
#define WRENCH_DECLARE
#define WRENCH_PASS
#define WRENCH_ROWS (void)0
#define WRENCH_PUT PAIR_PUT
#define WRENCHES_STORE(place, kind) (void)0
#define WRENCH_OF_NOBODY (void)0

/* Force, torque and heat of a unit of grains into rows. */
INLINE void grains_gather(const clast_launch *launch, int first, real *rows PARTICLE_DECLARE)
{
    for (int lane = 0; lane < PARTICLE_LANES; lane++) {
        vec3 f = v3(R(0.0), R(0.0), R(0.0)), t = f;
        grain_heat h = {0};
        if (TOUCHED_TAKE(launch, first + lane))
            particle_gather(launch, first / CLAST_BLOCK, first % CLAST_BLOCK + lane, &f, &t, &h PARTICLE_PASS);
        ROW_SET_POLAR3(rows, ROW_FORCE, lane, f);
        ROTATION_TO_ROWS(rows, ROW_TORQUE, lane, t);
        CONDUCTION_TO_ROWS(rows, ROW_HEAT, lane, h);
    }
}
