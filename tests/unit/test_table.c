/* The contact table as the device builds it, against every pair on the host. */
#include "table_case.h"

/* ---- the set of pairs ---- */

static void test_random(void **state)
{
    (void)state;
    const char *yaml = MATERIAL NORMAL SKIN("0.004");
    check_bed(yaml, random_bed(1000, 0.03, 0.03, 1), 400);
    check_bed(yaml, random_bed(1000, 0.02, 0.04, 2), 400);
    check_bed(yaml, random_bed(1500, 0.002, 0.1, 3), 1000); /* size ratio 50 */
    check_bed(yaml, random_bed(400, 5e-5, 0.5, 4), 500);    /* more sizes than levels */
}

/* Of grains of one level, away from borders, the first finds the pair: nothing stands behind what a grain finds itself that the grain waits for. */
static void test_first_finds(void **state)
{
    (void)state;
    sim_case c;
    case_open_bed(&c, MATERIAL NORMAL SKIN("0.004"), random_bed(1500, 0.03, 0.05, 6));
    table_copy h = copy_table(c.sim);
    int64_t finder = 0;
    assert_true(h.pairs > 1500);
    for (int64_t k = 0; k < h.pairs; k++) {
        int64_t low = h.owner[k] < h.other[k] ? h.owner[k] : h.other[k];
        assert_true(low >= finder);
        finder = low;
    }
    free_copy(&h);
    case_close(&c);
}

/* A boulder in sand: its block alone is wide. */
static void test_boulder(void **state)
{
    (void)state;
    bed b = random_bed(1500, 0.008, 0.008, 5);
    b.radius[700] = 0.4;
    for (int c = 0; c < 3; c++)
        b.position[700][c] = 0.5;
    sim_case c;
    case_open_bed(&c, MATERIAL NORMAL SKIN("0.002"), b);
    check_table(c.sim);
    table_copy h = copy_table(c.sim);
    int wide = 0;
    for (int64_t block = 0; block < h.blocks; block++)
        wide += (h.slot_offset[block + 1] - h.slot_offset[block]) / CLAST_BLOCK > 100;
    assert_int_equal(wide, 1);
    free_copy(&h);
    case_close(&c);
}

static void test_periodic(void **state)
{
    (void)state;
    static const char *const yaml[] = {
        MATERIAL NORMAL SKIN("0.004") PERIODIC("x"),    MATERIAL NORMAL SKIN("0.004") PERIODIC("y"),
        MATERIAL NORMAL SKIN("0.004") PERIODIC("z"),    MATERIAL NORMAL SKIN("0.004") PERIODIC("x, y"),
        MATERIAL NORMAL SKIN("0.004") PERIODIC("x, z"), MATERIAL NORMAL SKIN("0.004") PERIODIC("x, y, z"),
    };
    for (size_t s = 0; s < sizeof yaml / sizeof *yaml; s++) {
        check_bed(yaml[s], random_bed(600, 0.03, 0.03, 10 + s), 100);
        check_bed(yaml[s], random_bed(600, 0.004, 0.2, 20 + s), 500); /* few cells a direction: each neighbour once */
        check_bed(yaml[s], random_bed(300, 0.1, 0.2, 30 + s), 500);
    }
    /* the smallest box that is allowed: 2 (2 r_max + skin) */
    check_bed(MATERIAL NORMAL SKIN("0.1") PERIODIC("x, y, z"), random_bed(40, 0.05, 0.19999, 40), 100);
}

/* Grains on the faces, edges and corners of a periodic box, and exactly one length apart. */
static void test_periodic_edges(void **state)
{
    (void)state;
    bed b = case_bed(54);
    for (int64_t i = 0; i < 54; i++) {
        for (int c = 0, n = (int)(i % 27); c < 3; c++, n /= 3)
            b.position[i][c] = 0.5 * (n % 3) + (i < 27 ? 0.0 : 1e-9 * (double)(1 - n % 3));
        b.radius[i] = 0.06;
    }
    check_bed(MATERIAL NORMAL SKIN("0.01") PERIODIC("x, y, z"), b, 27);
}

static void test_clustered(void **state)
{
    (void)state;
    uint64_t seed = 50;
    bed b = random_bed(600, 0.002, 0.004, 51);
    for (int64_t i = 0; i < 600; i++)
        for (int c = 0; c < 3; c++)
            b.position[i][c] = (double)(i % 3) * 100.0 + case_random(&seed, 0.0, 0.03); /* three heaps, far apart */
    check_bed(MATERIAL NORMAL SKIN("0.001"), b, 600);
    b = random_bed(300, 0.5, 0.9, 52); /* all in one cell */
    check_bed(MATERIAL NORMAL SKIN("0.01"), b, 300 * 299 / 2 - 2000);
    b = case_bed(130); /* all in one place */
    for (int64_t i = 0; i < 130; i++)
        b.radius[i] = 0.01;
    check_bed(MATERIAL NORMAL SKIN("0.01"), b, 130 * 129 / 2);
}

static void test_nothing_near(void **state)
{
    (void)state;
    bed b = case_bed(200);
    for (int64_t i = 0; i < 200; i++) {
        b.position[i][0] = (double)i;
        b.radius[i] = 0.1;
    }
    check_bed(MATERIAL NORMAL SKIN("0.01"), b, 0);
    for (int64_t count = 1; count <= 2; count++) {
        b = case_bed(count);
        b.radius[0] = b.radius[count - 1] = 0.1;
        b.position[count - 1][1] = 0.205 * (double)(count - 1);
        check_bed(MATERIAL NORMAL SKIN("0.01"), b, (int)count - 1);
        b = case_bed(count);
        b.radius[0] = b.radius[count - 1] = 0.1;
        check_bed(MATERIAL NORMAL SKIN("0.01") PERIODIC("x, y, z"), b, (int)count - 1);
    }
}

/* One grain without walls takes steps, meets none, and flies on. */
static void test_one_grain_flies(void **state)
{
    (void)state;
    sim_case c;
    bed b = case_bed(1);
    b.radius[0] = 0.01;
    b.velocity[0][0] = 2.0;
    case_open_bed(&c, MATERIAL FRICTION SKIN("0.001") "gravity_m_s2: [0, 0, -10]\n", b);
    simulation_set_step(c.sim, 1e-4);
    MUST(simulation_advance(c.sim, 1000, why));
    double *x = case_field(c.sim, "position");
    assert_true(fabs(x[0] - 2.0 * 0.1) < 1e-12);
    assert_true(fabs(x[2] + 10.0 * 1e-8 * 0.5 * 1000.0 * 1001.0) < 1e-12);
    free(x);
    check_table(c.sim);
    case_close(&c);
}

/* ---- walls ---- */

static void test_walls(void **state)
{
    (void)state;
    sim_case c;
    const char *const yaml[] = {MATERIAL NORMAL SKIN("0.01") WALLS, MATERIAL NORMAL SKIN("0.01") WALLS PERIODIC("x, y")};
    for (int s = 0; s < 2; s++) {
        case_open_bed(&c, yaml[s], random_bed(900, 0.005, 0.08, 60));
        assert_int_equal(c.sim->face_count, 1 + 5 + 1 + 1);
        assert_true(c.sim->table.wall_record_count > 300);
        check_table(c.sim);
        case_close(&c);
    }
    /* walls without any pair, and one grain */
    bed b = case_bed(1);
    b.radius[0] = 0.05;
    b.position[0][2] = 0.2;
    case_open_bed(&c, yaml[0], b);
    assert_int_equal(c.sim->table.pair_count, 0);
    assert_true(c.sim->table.wall_record_count >= 3);
    check_table(c.sim);
    case_close(&c);
}

/* Every pair and every wall that touches has its record, whatever has moved since the table was built. */
static void check_nothing_missed(simulation *sim)
{
    table_copy h = copy_table(sim);
    int64_t width = h.count + sim->face_count;
    MUST(simulation_pose_now(sim, why));
    signed char *found = mark_records(&h, sim->face_count);
    for (int64_t i = 0; i < h.count; i++) {
        for (int64_t j = 0; j < i; j++) {
            double touch = h.radius[i] + h.radius[j];
            if (distance2(sim, &h.position[3 * i], &h.position[3 * j]) < touch * touch && !found[i * width + j])
                fail_msg("step %lld: grains %d and %d touch unseen", (long long)sim->step, h.id[i], h.id[j]);
        }
        for (int f = 0; f < sim->face_count; f++)
            if (face_distance(&sim->face_rows[f], &h.position[3 * i]) < h.radius[i] && !found[i * width + h.count + f])
                fail_msg("step %lld: grain %d and face %d touch unseen", (long long)sim->step, h.id[i], f);
    }
    free(found);
    free_copy(&h);
}

#define MOVING_WALLS                                                                                                                     \
    "walls:\n"                                                                                                                           \
    "  - {name: piston, shape: plane, point_m: [-0.05, 0, 0], normal: [1, 0, 0], motion: [{type: constant, velocity_m_s: [2, 0, 0]}]}\n" \
    "  - {name: paddle, shape: rectangle, corners_m: [[0.1, 0.5, 0.1], [0.9, 0.5, 0.1], [0.1, 0.5, 0.9]],"                               \
    " motion: [{type: rotation, point_m: [0.5, 0.5, 0.5], axis: [0, 0, 1], rate_rad_s: 9}]}\n"                                           \
    "  - {name: plate, shape: disc, center_m: [0.5, 0.5, 0.5], normal: [0, 0, 1], radius_m: 0.4,"                                        \
    " motion: [{type: sinusoid, direction: [0, 0, 1], amplitude_m: 0.3, frequency_hz: 3}]}\n"

static void test_moving_walls(void **state)
{
    (void)state;
    sim_case c;
    uint64_t seed = 70;
    bed b = random_bed(300, 0.01, 0.05, 71);
    for (int64_t i = 0; i < 300; i++)
        for (int k = 0; k < 3; k++)
            b.velocity[i][k] = case_random(&seed, -1.0, 1.0);
    case_open_bed(&c, MATERIAL NORMAL SKIN("0.01") MOVING_WALLS PERIODIC("y, z"), b);
    simulation_set_step(c.sim, 1e-4);
    for (int n = 0; n < 60; n++) {
        MUST(simulation_advance(c.sim, 17, why));
        check_nothing_missed(c.sim);
    }
    assert_true(c.sim->rebuilds > 20);
    MUST(simulation_pose_now(c.sim, why));
    MUST(table_build(c.sim, false, why));
    check_table(c.sim);
    case_close(&c);
}

/* Walls that sweep through grains that nothing moves: the walls alone ask for tables. */
static void test_sweeping_walls(void **state)
{
    (void)state;
    sim_case c;
    case_open_bed(&c, "effects: [{slot: body, law: viscous_damping, coefficient: 0}]\n" MATERIAL SKIN("0.01") MOVING_WALLS,
                  random_bed(300, 0.01, 0.05, 74));
    simulation_set_step(c.sim, 1e-4);
    for (int n = 0; n < 60; n++) {
        MUST(simulation_advance(c.sim, 17, why));
        check_nothing_missed(c.sim);
    }
    assert_true(c.sim->rebuilds > 20 && c.sim->rebuilds < 1000);
    case_close(&c);
}

/* A bed that flies as a whole needs no table on the way, and comes to no harm. */
static void test_drift(void **state)
{
    (void)state;
    sim_case c;
    uint64_t seed = 72;
    bed b = random_bed(300, 0.03, 0.03, 73);
    for (int64_t i = 0; i < 300; i++)
        b.velocity[i][1] = 50.0 + case_random(&seed, -0.01, 0.01);
    case_open_bed(&c,
                  "domain: {low_m: [-100, -100, -100], high_m: [100, 100, 100], periodic: [x, y, z]}\n"
                  "effects: [{slot: body, law: viscous_damping, coefficient: 0}]\n" MATERIAL SKIN("0.01"),
                  b);
    simulation_set_step(c.sim, 1e-4);
    MUST(simulation_advance(c.sim, 1000, why));
    check_nothing_missed(c.sim);
    assert_true(c.sim->rebuilds <= 2);
    case_close(&c);
}

/* ---- grains that moved ---- */

static void place_far(int32_t id, double *x)
{
    for (int c = 0; c < 3; c++)
        x[c] += id % 3 == c ? 1e6 * (id % 2 ? 1.0 : -1.0) : -37.0;
}

static void test_far_outside(void **state)
{
    (void)state;
    sim_case c;
    case_open_bed(&c, MATERIAL NORMAL SKIN("0.01") WALLS, random_bed(600, 0.02, 0.06, 80));
    move_grains(c.sim, place_far);
    check_table(c.sim);
    assert_true(c.sim->table.pair_count > 50);
    case_close(&c);
}
int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random),
        cmocka_unit_test(test_first_finds),
        cmocka_unit_test(test_boulder),
        cmocka_unit_test(test_periodic),
        cmocka_unit_test(test_periodic_edges),
        cmocka_unit_test(test_clustered),
        cmocka_unit_test(test_nothing_near),
        cmocka_unit_test(test_one_grain_flies),
        cmocka_unit_test(test_walls),
        cmocka_unit_test(test_moving_walls),
        cmocka_unit_test(test_sweeping_walls),
        cmocka_unit_test(test_drift),
        cmocka_unit_test(test_far_outside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
