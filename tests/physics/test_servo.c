/* Walls that keep a force or a pressure, and walls that move as a group: at rest, on the way, and to the same bits however the steps fall
 * into batches. */
#include "case.h"

static const double young = 1.0e7, density = 2500.0, radius = 1.0e-3;
static const double none[3] = {0, 0, 0};

static double modulus(void)
{
    return young / (1.0 - 0.09);
}

static text head(const char *more)
{
    text t = {0};
    put(&t, "effects:\n  - {slot: normal, law: hertz}\n  - {slot: tangential, law: mindlin}\n");
    put(&t, "materials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: %g, poissons_ratio: 0.3}]\n", density, young);
    put(&t, "interactions: [{between: default, normal_damping_ratio: 0.3, friction_static: 0.3}]\n%s", more);
    return t;
}

/* Force of the bed on a wall. */
static void force_on(physics_case *c, int wall, double *out)
{
    live_contact *live = NULL;
    int64_t count;
    memset(out, 0, 3 * sizeof *out);
    MUST(observe_contacts(c->sim, true, &live, &count, why));
    for (int64_t k = 0; k < count; k++)
        for (int a = 0; a < 3 && live[k].wall == wall; a++)
            out[a] -= live[k].force[a];
    free(live);
}

static void put_one(text *t)
{
    put(t, "particles:\n  - name: p\n    material: m\n    generator: list\n    items:\n");
}

/* A plate comes down on a sphere on a floor, meets nothing at first and runs at its largest speed, and comes to rest with its force on it:
 * both contacts hold it by Hertz. */
static void test_force(void **state)
{
    (void)state;
    const double force = 0.02, dt = 5.0e-6;
    double f[3];
    text t = head("walls:\n"
                  "  - {name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}\n"
                  "  - {name: lid, shape: plane, point_m: [0, 0, 0.004], normal: [0, 0, -1], servo: {direction: [0, 0, -1], force_n: 0.02, "
                  "speed_max_m_s: 0.05}}\n");
    put_one(&t);
    put_grain(&t, radius, (double[]){0, 0, radius}, none, none);
    physics_case c = case_open(&t);
    const clast_servo *s = &c.sim->drives.drive[0].state;
    case_run(&c, 4000, dt);
    /* M u' = F - C u with C = F/u_max; M is the one sphere's */
    double tau = sphere_mass(density, radius) * 0.05 / force;
    RELATIVE(s->velocity, 0.05 * (1.0 - exp(-c.sim->time / tau)), 1e-3);
    RELATIVE(s->shift, 0.05 * (c.sim->time - tau * (1.0 - exp(-c.sim->time / tau))), 1e-3);
    assert_true(s->force == 0.0);
    case_run(&c, 16000, dt);
    force_on(&c, 1, f);
    RELATIVE(f[2], force, 1e-6);
    RELATIVE(s->force, force, 1e-6);
    NEAR(s->velocity, 0.0, 1e-8);
    double overlap = hertz_rest(modulus(), radius, force);
    NEAR(simulation_wall_pose(c.sim, 1).shift[2], 2.0 * radius - 2.0 * overlap - 0.004, 1e-4 * overlap);
    NEAR(case_get(&c, "position", 0, 2), radius - overlap, 1e-4 * overlap);
    case_close(&c);
}

/* A bed in a box under a lid that keeps a pressure: at rest the lid feels p A to 1 %, and so does the floor beside the bed's weight; a stage
 * raises the pressure, and the next switches the servo off: the lid stays. */
#define SPEED "0.5"
#define BED                                                                                                                        \
    "gravity_m_s2: [0, 0, -9.81]\nwalls:\n"                                                                                          \
    "  - {name: box, shape: box, low_m: [0, 0, 0], high_m: [0.012, 0.012, 0.03], open: [z_high]}\n"                                  \
    "  - {name: lid, shape: rectangle, corners_m: [[0, 0, 0.02], [0.012, 0, 0.02], [0, 0.012, 0.02]], servo: {direction: [0, 0, -1], " \
    "pressure_pa: 500, speed_max_m_s: " SPEED "}}\n"                                                                                      \
    "particles: [{name: bed, material: m, generator: random, count: 150, radius_m: {distribution: uniform, low: 8.0e-4, high: 1.2e-3}, " \
    "region: {low_m: [0, 0, 0], high_m: [0.012, 0.012, 0.02]}}]\n"                                                                  \
    "stages:\n  - {name: press, until: {steps: 1}}\n"                                                                               \
    "  - {name: more, until: {steps: 1}, change: {walls: [{name: lid, servo: {direction: [0, 0, -1], pressure_pa: 2000, speed_max_m_s: " SPEED "}}]}}\n" \
    "  - {name: off, until: {steps: 1}, change: {walls: [{name: lid, servo: off}]}}\n"

static void test_pressure(void **state)
{
    (void)state;
    const double area = 0.012 * 0.012, dt = 4.0e-6; /* that recommended for 2000 Pa under velocity Verlet */
    double lid[3], box[3], weight;
    text t = head(BED);
    physics_case c = case_open(&t);
    weight = case_sums(&c).mass * 9.81;
    for (int stage = 0; stage < 2; stage++) {
        double pressure = stage ? 2000.0 : 500.0;
        if (stage)
            case_stage(&c, 1);
        case_run(&c, stage ? 15000 : 35000, dt);
        force_on(&c, 1, lid);
        force_on(&c, 0, box);
        RELATIVE(lid[2], pressure * area, 1e-2);
        NEAR(box[2], -(pressure * area + weight), 1e-2 * (pressure * area + weight));
    }
    double height = simulation_wall_pose(c.sim, 1).shift[2];
    case_stage(&c, 2);
    case_run(&c, 2500, dt);
    assert_true(simulation_wall_pose(c.sim, 1).shift[2] == height);
    assert_true(simulation_wall_pose(c.sim, 1).velocity[2] == 0.0);
    case_close(&c);
}

/* ---- the same bits ---- */

typedef struct bits {
    double shift, velocity, *position;
} bits;

static bits run_bits(const char *table, int64_t steps, int64_t at_once)
{
    text t = head(table);
    put(&t, "%s", BED);
    physics_case c = case_open(&t);
    for (int64_t n = 0; n < steps; n += at_once)
        case_run(&c, n + at_once < steps ? at_once : steps - n, 1.0e-5);
    assert_true(c.sim->drives.drive[0].state.force > 0.0);
    bits b = {c.sim->drives.drive[0].state.shift, c.sim->drives.drive[0].state.velocity, case_field(&c, "position")};
    case_close(&c);
    return b;
}

static void test_same_bits(void **state)
{
    (void)state;
    const int64_t steps = 5000;
    const struct {
        const char *table;
        int64_t at_once;
    } other[] = {{"contact_table: {batch_steps: 7}\n", 5000}, {"contact_table: {skin_m: 3.0e-5}\n", 5000}, {"", 13}};
    bits first = run_bits("", steps, steps);
    assert_true(first.shift > 2.0e-3);
    for (int k = 0; k < COUNT_OF(other); k++) {
        bits b = run_bits(other[k].table, steps, other[k].at_once);
        assert_true(b.shift == first.shift);
        assert_true(b.velocity == first.velocity);
        assert_memory_equal(b.position, first.position, 150 * 3 * sizeof(double));
        free(b.position);
    }
    free(first.position);
}

static void test_checkpoint(void **state)
{
    (void)state;
    bundle saved;
    text t = head(BED), again = head(BED);
    physics_case c = case_open(&t), d = case_open(&again);
    case_run(&c, 3500, 1.0e-5);
    bundle_init(&saved);
    MUST(state_save(c.sim, &saved, why));
    case_run(&c, 2000, 1.0e-5);
    MUST(state_load(d.sim, &saved, "memory", why));
    case_run(&d, 2000, 1.0e-5);
    double *x = case_field(&c, "position"), *y = case_field(&d, "position");
    assert_memory_equal(x, y, 150 * 3 * sizeof(double));
    assert_true(c.sim->drives.drive[0].state.shift == d.sim->drives.drive[0].state.shift);
    free(x);
    free(y);
    bundle_free(&saved);
    case_close(&c);
    case_close(&d);
}

/* ---- groups ---- */

/* Two plates of one group press on two spheres of different height: they move as one, and the sum of their forces is kept; with the reaction
 * of the floor the momentum balance holds. */
static void test_group_servo(void **state)
{
    (void)state;
    const double force = 0.05;
    double a[3], b[3], floor_force[3];
    text t = head("wall_groups: [{name: press, servo: {direction: [0, 0, -1], force_n: 0.05, speed_max_m_s: 0.02}}]\nwalls:\n"
                  "  - {name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}\n"
                  "  - {name: left, group: press, shape: rectangle, corners_m: [[-0.01, -0.01, 0.0021], [0, -0.01, 0.0021], [-0.01, 0.01, 0.0021]]}\n"
                  "  - {name: right, group: press, shape: rectangle, corners_m: [[0, -0.01, 0.0021], [0.01, -0.01, 0.0021], [0, 0.01, 0.0021]]}\n");
    put_one(&t);
    put_grain(&t, radius, (double[]){-0.005, 0, radius}, none, none);
    put_grain(&t, 1.005 * radius, (double[]){0.005, 0, 1.005 * radius}, none, none);
    physics_case c = case_open(&t);
    case_run(&c, 20000, 1.0e-5);
    force_on(&c, 0, floor_force);
    force_on(&c, 1, a);
    force_on(&c, 2, b);
    RELATIVE(a[2] + b[2], force, 1e-4);
    RELATIVE(floor_force[2], -force, 1e-4);
    assert_true(b[2] > a[2] && a[2] > 0.0);
    assert_true(simulation_wall_pose(c.sim, 1).shift[2] == simulation_wall_pose(c.sim, 2).shift[2]);
    double overlap = -0.5 * (simulation_wall_pose(c.sim, 1).shift[2] + 0.0021 - 2.0 * radius);
    RELATIVE(a[2], 4.0 / 3.0 * modulus() * sqrt(radius) * pow(overlap, 1.5), 1e-3);
    case_close(&c);
}

/* A group with a prescribed motion turns as one body, and a stage stops it where it is. */
static void test_group_motion(void **state)
{
    (void)state;
    text t = head("wall_groups: [{name: rotor, motion: [{type: rotation, point_m: [0.01, 0, 0], axis: [0, 0, 1], rate_rad_s: 10}]}]\nwalls:\n"
                  "  - {name: a, group: rotor, shape: rectangle, corners_m: [[0, 0, 0], [0.01, 0, 0], [0, 0, 0.01]]}\n"
                  "  - {name: b, group: rotor, shape: cylinder, side: outside, axis_point_m: [0.03, 0, 0], axis: [0, 0, 1], radius_m: 0.002, length_m: 0.01}\n"
                  "stages:\n  - {name: turn, until: {steps: 1}}\n  - {name: stop, until: {steps: 1}, change: {wall_groups: [{name: rotor, motion: []}]}}\n");
    put_one(&t);
    put_grain(&t, radius, (double[]){0.5, 0, 0}, none, none);
    physics_case c = case_open(&t);
    case_run(&c, 1000, 1.0e-4);
    double x[3] = {0.03, 0, 0}, y[3], z[3];
    body_pose one = simulation_wall_pose(c.sim, 0), two = simulation_wall_pose(c.sim, 1);
    pose_point(&two, x, y);
    pose_point(&one, x, z);
    NEAR(y[0], 0.01 + 0.02 * cos(10.0 * c.sim->time), 1e-15);
    NEAR(y[1], 0.02 * sin(10.0 * c.sim->time), 1e-15);
    assert_memory_equal(y, z, sizeof y);
    case_stage(&c, 1);
    case_run(&c, 100, 1.0e-4);
    two = simulation_wall_pose(c.sim, 1);
    pose_point(&two, x, z);
    assert_memory_equal(y, z, sizeof y);
    case_close(&c);
}

/* ---- guards and refusals ---- */

static void test_guards(void **state)
{
    (void)state;
    guard_finding found = {0};
    text t = head("walls:\n  - {name: lid, shape: disc, center_m: [0, 0, 0.01], normal: [0, 0, 1], radius_m: 0.001, servo: {direction: [0, 0, -1], force_n: 1, "
                  "speed_max_m_s: 1}}\n");
    put_one(&t);
    put_grain(&t, radius, (double[]){0.02, 0, 0}, none, none);
    physics_case c = case_open(&t);
    for (int k = 0; k < 20 && !found.stop; k++) {
        case_run(&c, 100, 1.0e-5);
        MUST(guard_check(c.sim, &found, why));
    }
    assert_true(found.stop);
    assert_non_null(strstr(found.text, "the servo of the wall `lid` has moved 0.011"));
    assert_non_null(strstr(found.text, "has not found the bed"));
    BETWEEN(c.sim->time, 0.011, 0.0125);
    case_close(&c);
}

/* Two plates of a group go past the grain on both sides: the guard names the group, which moves as far as a wall alone would. */
static void test_guard_of_group(void **state)
{
    (void)state;
    guard_finding found = {0};
    text t = head("wall_groups: [{name: press, servo: {direction: [0, 0, -1], force_n: 1, speed_max_m_s: 1}}]\nwalls:\n"
                  "  - {name: left, group: press, shape: disc, center_m: [0, 0, 0.01], normal: [0, 0, 1], radius_m: 0.001}\n"
                  "  - {name: right, group: press, shape: disc, center_m: [0.04, 0, 0.01], normal: [0, 0, 1], radius_m: 0.001}\n");
    put_one(&t);
    put_grain(&t, radius, (double[]){0.02, 0, 0}, none, none);
    physics_case c = case_open(&t);
    for (int k = 0; k < 20 && !found.stop; k++) {
        case_run(&c, 100, 1.0e-5);
        MUST(guard_check(c.sim, &found, why));
    }
    assert_true(found.stop);
    assert_non_null(strstr(found.text, "the servo of the wall group `press` has moved 0.011"));
    BETWEEN(c.sim->time, 0.011, 0.0125);
    case_close(&c);
}

/* On a floor that shakes faster than half of the lid's largest speed, the lid swings to and fro in every period; a hundred in a row are too many. */
static void test_swings(void **state)
{
    (void)state;
    guard_finding found = {0};
    const double frequency = 100.0, speed = 0.09, dt = 1.0e-5;
    char walls[512];
    snprintf(walls, sizeof walls,
             "walls:\n  - {name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1], motion: [{type: sinusoid, direction: [0, 0, 1], amplitude_m: %.17g, "
             "frequency_hz: %g}]}\n  - {name: lid, shape: plane, point_m: [0, 0, 0.002], normal: [0, 0, -1], servo: {direction: [0, 0, -1], force_n: 0.1, "
             "speed_max_m_s: 0.1, travel_max_m: 1}}\n",
             speed / (2.0 * PI * frequency), frequency);
    text t = head(walls);
    put_one(&t);
    put_grain(&t, radius, (double[]){0, 0, radius}, none, none);
    physics_case c = case_open(&t);
    int looks = 0;
    for (; looks < 200 && !found.stop; looks++) {
        case_run(&c, llround(1.0 / (frequency * dt)), dt);
        MUST(guard_check(c.sim, &found, why));
    }
    assert_true(found.stop);
    BETWEEN(looks, 100, 105);
    assert_non_null(strstr(found.text, "the servo of the wall `lid` swings to and fro at more than half of its largest speed of 0.1 m/s"));
    assert_non_null(strstr(found.text, "lower speed_max_m_s"));
    case_close(&c);
}

/* Where the scene does not tell the area, `area_m2` does: p A rests on the sphere. */
static void test_given_area(void **state)
{
    (void)state;
    double f[3];
    text t = head("walls:\n  - {name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}\n"
                  "  - {name: lid, shape: plane, point_m: [0, 0, 0.0021], normal: [0, 0, -1], servo: {direction: [0, 0, -1], pressure_pa: 200, area_m2: 1.0e-4, "
                  "speed_max_m_s: 0.05}}\n");
    put_one(&t);
    put_grain(&t, radius, (double[]){0, 0, radius}, none, none);
    physics_case c = case_open(&t);
    case_run(&c, 16000, 5.0e-6);
    force_on(&c, 1, f);
    RELATIVE(f[2], 200.0 * 1.0e-4, 1e-6);
    case_close(&c);
}

static void expect_refusal(const char *walls, const char *wanted)
{
    failure why = {{0}};
    scene *scene = NULL;
    bed bed = {0};
    simulation *sim = NULL;
    text t = head(walls);
    put_one(&t);
    put_grain(&t, radius, none, none, none);
    put(&t, "\nstages: [{name: run, until: {steps: 1}}]\n");
    status result = scene_read_text(t.at, "case.yaml", 0, NULL, &scene, &why);
    if (result == STATUS_OK) {
        MUST(bed_generate(scene, &bed, why));
        result = simulation_create(scene, &bed, case_device(), NULL, &sim, &why);
    }
    if (result == STATUS_OK)
        result = simulation_begin_stage(sim, 0, &why);
    assert_int_equal(result, STATUS_BAD_INPUT);
    if (!strstr(why.text, wanted))
        fail_msg("%s\n does not hold: %s", why.text, wanted);
    simulation_free(sim);
    bed_free(&bed);
    scene_free(scene);
    free(t.at);
}

static void test_refusals(void **state)
{
    (void)state;
#define LID "walls: [{name: lid, shape: plane, point_m: [0, 0, 0.01], normal: [0, 0, -1], servo: {direction: [0, 0, "
    expect_refusal(LID "-1], pressure_pa: 5, speed_max_m_s: 0.1}}]\n", "the area that faces the bed cannot be told from the scene");
    expect_refusal(LID "-1], pressure_pa: 5, force_n: 1, speed_max_m_s: 0.1}}]\n", "give one of `pressure_pa` and `force_n`");
    expect_refusal(LID "-1], speed_max_m_s: 0.1}}]\n", "give one of `pressure_pa` and `force_n`");
    expect_refusal(LID "-1], force_n: 1, area_m2: 1, speed_max_m_s: 0.1}}]\n", "`area_m2` has no meaning where a force is kept");
    expect_refusal(LID "-1], force_n: 1}}]\n", "a servo needs the key `speed_max_m_s`");
    expect_refusal(LID "1], force_n: 1, speed_max_m_s: 0.1}}]\n", "no particle lies on that side of the wall");
    expect_refusal("wall_groups: [{name: g}]\nwalls: [{name: w, group: g, shape: disc, center_m: [0, 0, 1], normal: [0, 0, 1], radius_m: 1, motion: "
                   "[{type: constant, velocity_m_s: [0, 0, 1]}]}]\n",
                   "a wall of a group moves with it");
    expect_refusal("wall_groups: [{name: g}]\n", "no wall belongs to the wall group `g`");
    expect_refusal("walls: [{name: w, group: h, shape: disc, center_m: [0, 0, 1], normal: [0, 0, 1], radius_m: 1}]\n", "there is no wall group called `h`");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_force),      cmocka_unit_test(test_pressure),    cmocka_unit_test(test_same_bits),
        cmocka_unit_test(test_checkpoint), cmocka_unit_test(test_group_servo), cmocka_unit_test(test_group_motion),
        cmocka_unit_test(test_guards),     cmocka_unit_test(test_swings),      cmocka_unit_test(test_given_area),
        cmocka_unit_test(test_refusals),   cmocka_unit_test(test_guard_of_group),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
