/* The reported step limit: the closed form of a single contact, the edge between bounded and growing swings, and a calm pile at the
 * recommended step. */
#include "on_plane.h"

/* omega dt = 2 (sqrt(1 + xi^2) - xi); velocity Verlet extrapolates what a damper is given, and xi counts twice */
static double edge(double stiffness, double damping, double mass)
{
    double omega = sqrt(stiffness / mass), xi = (case_verlet() ? 1.0 : 0.5) * damping / (mass * omega);
    return 2.0 * (sqrt(1.0 + xi * xi) - xi) / omega;
}

static double normal_edge(double xi)
{
    double m = lane_mass(), e = plane_modulus(), d = rest_overlap(0.0);
    return edge(2.0 * e * sqrt(radius * d), 2.0 * xi * sqrt(2.0 * e * m * sqrt(radius)) * pow(d, 0.25), m);
}

/* A tangential force moves the contact point with 1/m + (s r)^2/j, 3.5/m for s = 1. */
static double sliding_edge(double xi, double s)
{
    double m = lane_mass(), g8 = 8.0 * plane_shear_modulus(), d = rest_overlap(0.0);
    return edge(g8 * sqrt(radius * d), 2.0 * xi * sqrt(g8 * m * sqrt(radius)) * pow(d, 0.25), m / (1.0 + 2.5 * s * s));
}

static const double ratios[] = {0.0, 0.1, 0.5, 1.0};

#define NORMAL  "  - {slot: normal, law: hertz}\n"
#define SLIDING NORMAL "  - {slot: tangential, law: mindlin}\n"

static physics_case one_lane(const char *effects, double xi, double vx)
{
    char words[160];
    lane only = {words, vx, 0, 0, 0, 0};
    snprintf(words, sizeof words, "normal_damping_ratio: %.17g, friction_static: 100", xi);
    return lanes_open(effects, 0.0, &only, 1);
}

/* The largest eigenvalue of a contact with sliding is a double one, which comes from the cosine of a third of an angle near pi: it is known
 * to the root of a rounding. */
static void test_closed_form(void **state)
{
    (void)state;
    double single = within(1e-8, LAW), twofold = case_mixed() ? sqrt(LAW * FLOAT_ROUNDING) : 1e-8;
    for (int k = 0; k < COUNT_OF(ratios); k++) {
        physics_case c = one_lane(NORMAL, ratios[k], 0.0);
        RELATIVE(case_limit(&c).live_s, normal_edge(ratios[k]), single);
        assert_true(case_limit(&c).limit_s <= case_limit(&c).live_s);
        assert_true(case_limit(&c).recommended_s <= 0.7 * case_limit(&c).limit_s * (1.0 + 1e-12));
        case_close(&c);
        c = one_lane(SLIDING, ratios[k], 0.0);
        RELATIVE(case_limit(&c).live_s, sliding_edge(ratios[k], 1.0), twofold);
        assert_true(sliding_edge(ratios[k], 1.0) < normal_edge(ratios[k]));
        case_close(&c);
    }
}

/* Swing about rest after 400 steps of `dt`, over what it was given: of the height, or of the way of the contact. */
static double swing(const char *effects, double xi, double dt)
{
    bool slides = strstr(effects, "tangential");
    double v = 1.0e-9, most = 0.0;
    physics_case c = one_lane(effects, xi, slides ? v : 0.0);
    if (!slides) { /* rest is met to rounding only: give it a kick through gravity instead */
        case_run(&c, 1, dt);
        c.sim->gravity[2] *= 1.0 + 1.0e-7;
    }
    double rest = case_get(&c, "position", 0, 2);
    for (int s = 0; s < 400; s++) {
        case_run(&c, 1, dt);
        double now = slides ? vx_of(&c, 0) - radius * wy_of(&c, 0) : (case_get(&c, "position", 0, 2) - rest) / dt;
        if (s >= 350)
            most = fmax(most, fabs(now));
    }
    double unit = slides ? v : rest_overlap(0.0) * 1.0e-7 / dt;
    case_close(&c);
    return most / unit;
}

static void test_edge_of_stability(void **state)
{
    (void)state;
    double s = arm_share(0.0);
    for (int k = 0; k < COUNT_OF(ratios); k++) {
        double normal = normal_edge(ratios[k]), sliding = sliding_edge(ratios[k], s);
        BETWEEN(swing(NORMAL, ratios[k], 0.97 * normal), 0.0, 100.0);
        BETWEEN(swing(NORMAL, ratios[k], 1.03 * normal), 1000.0, INFINITY);
        BETWEEN(swing(SLIDING, ratios[k], 0.97 * sliding), 0.0, 100.0);
        BETWEEN(swing(SLIDING, ratios[k], 1.03 * sliding), 1000.0, INFINITY);
    }
}

/* A pile between critically damped contacts, run as a stage runs it: the step follows what is recommended. */
static double pile_energy(double share, int steps)
{
    text t = {0};
    put(&t, "gravity_m_s2: [0, 0, %g]\neffects:\n%s  - {slot: rolling, law: elastic_plastic}\n", -G, SLIDING);
    put(&t, "materials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: %g, poissons_ratio: %g}]\n", density, young, poisson);
    put(&t, "interactions: [{between: default, normal_damping_ratio: 1, friction_static: 0.5, rolling_friction: 0.1}]\n"
            "walls: [{name: w, shape: box, low_m: [0, 0, 0], high_m: [0.0061, 0.0061, 0.1], open: [z_high]}]\n"
            "particles: [{name: p, material: m, generator: random, count: 60, radius_m: {distribution: uniform, low: 0.7e-3, high: 1.0e-3},"
            " region: {low_m: [0, 0, 0], high_m: [0.0061, 0.0061, 0.02]}}]\n");
    physics_case c = case_open(&t);
    for (int part = 0; part < steps / 200; part++)
        case_run(&c, 200, share * case_limit(&c).recommended_s);
    particle_sums sums = case_sums(&c);
    case_close(&c);
    return sums.kinetic / (G * sums.weight_radius);
}

static void test_calm_pile(void **state)
{
    (void)state;
    BETWEEN(pile_energy(1.0, case_verlet() ? 160000 : 80000), 0.0, 1e-8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_closed_form),
        cmocka_unit_test(test_edge_of_stability),
        cmocka_unit_test(test_calm_pile),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
