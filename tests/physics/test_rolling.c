/* Rolling resistance on a plane against closed forms: both laws braking to a stop and on a slope, and the elastic-plastic law's own swing.
 * */
#include "on_plane.h"

#define EFFECTS(rolling)  "  - {slot: normal, law: hertz}\n  - {slot: tangential, law: mindlin}\n  - {slot: rolling, law: " rolling "}\n"
#define ROUGH(resistance) "normal_damping_ratio: 0.3, friction_static: 0.5, rolling_friction: " resistance

#define DT                1.0e-5

static const double v0 = 0.2;

/* Of a rolling sphere whose friction acts at the arm s r: j w' = f s r - mu_r r N and m v' = -f, v = w s r. */
static double brake(double resistance, double s)
{
    return resistance * G / (s * (1.0 + 0.4 / (s * s)));
}

/* v0^2/(2 a) = 7 v0^2/(10 mu_r g) after v0/a = 7 v0/(5 mu_r g), and rest from then on. */
static void check_stop(const char *effects, double tremble)
{
    double s = arm_share(0.0), w = v0 / (radius * s), resistance[] = {0.02, 0.05, 0.1};
    const lane lanes[] = {
        {ROUGH("0.02"), v0, 0, 0, w, 0}, {ROUGH("0.05"), v0, 0, 0, w, 0}, {ROUGH("0.1"), v0, 0, 0, w, 0}, {ROUGH("0.1"), 0, v0, -w, 0, 0}};
    physics_case c = lanes_open(effects, 0.0, lanes, 4);
    double early = 0.2;
    case_run(&c, (int64_t)round(early / DT), DT);
    for (int k = 0; k < 3; k++)
        NEAR(vx_of(&c, k), v0 - brake(resistance[k], s) * early, 2e-4 * v0);
    NEAR(case_get(&c, "velocity", 3, 1), v0 - brake(0.1, s) * early, 2e-4 * v0);
    case_run(&c, (int64_t)round(0.5 / DT), DT);
    for (int k = 1; k < 3; k++) {
        double way = v0 * v0 / (2.0 * brake(resistance[k], s));
        RELATIVE(way, 7.0 * v0 * v0 / (10.0 * resistance[k] * G), 5e-3);
        NEAR(x_of(&c, k), way, 1e-3 * way);
        NEAR(vx_of(&c, k), 0.0, tremble);
    }
    NEAR(case_get(&c, "position", 3, 1) - 12.0 * radius, v0 * v0 / (2.0 * brake(0.1, s)), 1e-3 * v0 * v0 / (2.0 * brake(0.1, s)));
    NEAR(case_get(&c, "velocity", 3, 0), 0.0, 0.0);
    case_close(&c);
}

static void test_stop_elastic_plastic(void **state)
{
    (void)state;
    check_stop(EFFECTS("elastic_plastic"), 1e-9);
}

static void test_stop_constant_torque(void **state)
{
    (void)state;
    check_stop(EFFECTS("constant_torque"), 2e-4);
}

/* At rest while tan(al) <= mu_r/s, else (5/7) g (sin(al) - mu_r cos(al)): 5 per cent to either side, and far from it. */
static void test_incline(void **state)
{
    (void)state;
    double slope = 15.0 * PI / 180.0, s = arm_share(slope), edge = s * tan(slope), time = 0.3;
    double resistance[] = {0.4, 1.05 * edge, 0.95 * edge, 0.05};
    char words[4][256];
    lane lanes[4] = {{0}};
    for (int k = 0; k < 4; k++) {
        snprintf(words[k], sizeof words[k],
                 "normal_damping_ratio: 0.3, tangential_damping_ratio: 0.5, rolling_damping_ratio: 2, friction_static: 0.5, "
                 "rolling_friction: %.17g",
                 resistance[k]);
        lanes[k].interaction = words[k];
    }
    physics_case c = lanes_open(EFFECTS("elastic_plastic"), slope, lanes, 4);
    case_run(&c, (int64_t)round(time / DT), DT);
    for (int k = 0; k < 4; k++) {
        double a = k < 2 ? 0.0 : (G * sin(slope) - resistance[k] * G * cos(slope) / s) / (1.0 + 0.4 / (s * s));
        double free = 5.0 / 7.0 * G * sin(slope);
        /* until its spring bears mu_r r N the sphere rolls freely, over an angle of mu_r r N/k_r */
        double angle = resistance[k] * radius * lane_mass() * G * cos(slope) /
                       (8.0 * plane_shear_modulus() * sqrt(radius * rest_overlap(slope)) * radius * radius);
        double ahead = sqrt(2.0 * free * angle * radius);
        NEAR(vx_of(&c, k), a * time, k < 2 ? 1e-9 : ahead);
        NEAR(x_of(&c, k), 0.5 * a * time * time, k < 2 ? 10.0 * angle * radius : ahead * time);
        if (k >= 2)
            NEAR(a, 5.0 / 7.0 * G * (sin(slope) - resistance[k] * cos(slope)), 2e-3 * free);
    }
    case_close(&c);
}

/* Without friction and below the limit the sphere swings on its rolling spring: j w'' + c w' + k w = 0 with k = 8 G* sqrt(r d) r^2 and
 * c = 2 xi sqrt(8 G* j* sqrt(r)) r d^(1/4), j* = 7/5 m r^2. Twist (about z) swings like the rest, or turns freely where it is left out. */
static double swing(double shear, double xi, double w0, double time)
{
    double d = rest_overlap(0.0), m = lane_mass(), j = 0.4 * m * radius * radius, g8 = 8.0 * shear;
    double k = g8 * sqrt(radius * d) * radius * radius,
           c = 2.0 * xi * sqrt(g8 * 1.4 * m * radius * radius * sqrt(radius)) * radius * pow(d, 0.25);
    double delta = 0.5 * c / j, omega = sqrt(k / j - delta * delta);
    return w0 * exp(-delta * time) * (cos(omega * time) - delta / omega * sin(omega * time));
}

static double swing_period(void)
{
    double k = 8.0 * plane_shear_modulus() * sqrt(radius * rest_overlap(0.0)) * radius * radius;
    return 2.0 * PI * sqrt(0.4 * lane_mass() * radius * radius / k);
}

#define SWING(xi) "normal_damping_ratio: 0.3, rolling_damping_ratio: " xi ", rolling_friction: 100"

static void check_swing(const char *effects, bool twist, double shear)
{
    double w0 = 1.0, dt = swing_period() / 4000.0, ratio[] = {0.0, 0.1, 0.1, 0.1};
    const lane lanes[] = {
        {SWING("0"), 0, 0, 0, w0, 0}, {SWING("0.1"), 0, 0, 0, w0, 0}, {SWING("0.1"), 0, 0, w0, 0, 0}, {SWING("0.1"), 0, 0, 0, 0, w0}};
    const int axis[] = {1, 1, 0, 2};
    physics_case c = lanes_open(effects, 0.0, lanes, 4);
    for (int part = 1; part <= 6; part++) {
        case_run(&c, 700, dt);
        for (int k = 0; k < 4; k++)
            NEAR(case_get(&c, "spin", k, axis[k]), k == 3 && !twist ? w0 : swing(shear, ratio[k], w0, 700.0 * part * dt), 2e-3 * w0);
    }
    case_close(&c);
}

static void test_swing(void **state)
{
    (void)state;
    check_swing(EFFECTS("elastic_plastic"), true, plane_shear_modulus());
}

/* Mindlin's modulus at a wall: 1/G* = (2 - nu)/G. */
static void test_swing_without_twist(void **state)
{
    (void)state;
    check_swing(EFFECTS("elastic_plastic, twist: left_out, shear_modulus: mindlin"), false, plane_shear_modulus() / (2.0 - poisson));
}

/* A spin about the normal is braked with mu_r r N: j w' = -mu_r r m g. */
static void test_twist_brake(void **state)
{
    (void)state;
    double w0 = 100.0, time = 0.05;
    const lane lanes[] = {{"normal_damping_ratio: 0.3, rolling_friction: 0.01", 0, 0, 0, 0, w0},
                          {"normal_damping_ratio: 0.3, rolling_friction: 0.02", 0, 0, 0, 0, -w0}};
    physics_case c = lanes_open(EFFECTS("elastic_plastic"), 0.0, lanes, 2);
    case_run(&c, (int64_t)round(time / DT), DT);
    NEAR(case_get(&c, "spin", 0, 2), w0 - 2.5 * 0.01 * G / radius * time, 2e-4 * w0);
    NEAR(case_get(&c, "spin", 1, 2), -w0 + 2.5 * 0.02 * G / radius * time, 2e-4 * w0);
    case_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stop_elastic_plastic),
        cmocka_unit_test(test_stop_constant_torque),
        cmocka_unit_test(test_incline),
        cmocka_unit_test(test_swing),
        cmocka_unit_test(test_swing_without_twist),
        cmocka_unit_test(test_twist_brake),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
