/* Friction on a plane against closed forms: sliding, rolling, the change between them, static and dynamic coefficients, oblique impacts. */
#include "on_plane.h"

static const char *const mindlin = "  - {slot: normal, law: hertz}\n  - {slot: tangential, law: mindlin}\n";
static const char *const mindlin_radius = "  - {slot: normal, law: hertz}\n  - {slot: tangential, law: mindlin, lever_arm: radius}\n";

#define DT 1.0e-5

/* With arm s r the sphere slides for t = v0/(mu g (1 + 5 s^2/2)), then rolls; s = 1 gives 5 v0/7 after 2 v0/(7 mu g). */
static void check_slide_to_roll(const char *effects, double s)
{
    const lane lanes[] = {{"normal_damping_ratio: 0.3, friction_static: 0.3", 1.0, 0, 0, 0, 0},
                          {"normal_damping_ratio: 0.3, friction_static: 0.1", 0.4, 0, 0, 0, 0},
                          {"normal_damping_ratio: 0.3, friction_static: 0.3", -1.0, 0, 0, 0, 0}};
    const double mu[] = {0.3, 0.1, 0.3}, v0[] = {1.0, 0.4, -1.0}, early = 0.05, late = 0.2;
    physics_case c = lanes_open(effects, 0.0, lanes, 3);
    case_run(&c, (int64_t)round(early / DT), DT);
    for (int k = 0; k < 3; k++) { /* the spring takes up to mu N/k = 2e-6 m of way to load */
        NEAR(vx_of(&c, k), v0[k] - copysign(mu[k] * G * early, v0[k]), mu[k] * G * 2.0 * DT);
        NEAR(wy_of(&c, k) * radius, copysign(2.5 * mu[k] * G * s * early, v0[k]), 2.5 * mu[k] * G * 2.0 * DT);
    }
    case_run(&c, (int64_t)round((late - early) / DT), DT);
    for (int k = 0; k < 3; k++) {
        double t = fabs(v0[k]) / (mu[k] * G * (1.0 + 2.5 * s * s)), v = v0[k] * 2.5 * s * s / (1.0 + 2.5 * s * s);
        RELATIVE(vx_of(&c, k), v, 1e-6);
        RELATIVE(wy_of(&c, k) * radius * s, v, 1e-5);
        NEAR(x_of(&c, k), 0.5 * (v0[k] + v) * t + v * (late - t), 1e-5);
        if (s == 1.0) {
            RELATIVE(v, 5.0 * v0[k] / 7.0, 1e-14);
            RELATIVE(0.5 * fabs(v0[k] + v) * t, 12.0 * v0[k] * v0[k] / (49.0 * mu[k] * G), 1e-14);
        }
    }
    case_close(&c);
}

static void test_slide_to_roll(void **state)
{
    (void)state;
    check_slide_to_roll(mindlin_radius, 1.0);
    check_slide_to_roll(mindlin, arm_share(0.0));
}

/* Rolls with g sin(al)/(1 + 2/(5 s^2)) while tan(al) <= mu (1 + 5 s^2/2), else slides: 2 per cent to either side of that, and far from it.
 * */
static void test_incline(void **state)
{
    (void)state;
    double slope = 20.0 * PI / 180.0, s = arm_share(slope), edge = tan(slope) / (1.0 + 2.5 * s * s), time = 0.3;
    double mu[] = {0.5, 1.02 * edge, 0.98 * edge, 0.02};
    char words[4][256];
    lane lanes[4] = {{0}};
    for (int k = 0; k < 4; k++) {
        snprintf(words[k], sizeof words[k], "normal_damping_ratio: 0.3, tangential_damping_ratio: 1, friction_static: %.17g", mu[k]);
        lanes[k].interaction = words[k];
    }
    physics_case c = lanes_open(mindlin, slope, lanes, 4);
    case_run(&c, (int64_t)round(time / DT), DT);
    for (int k = 0; k < 4; k++) {
        bool rolls = tan(slope) <= mu[k] * (1.0 + 2.5 * s * s);
        assert_int_equal(rolls, k < 2);
        double a = rolls ? G * sin(slope) / (1.0 + 0.4 / (s * s)) : G * (sin(slope) - mu[k] * cos(slope));
        double spin = rolls ? a / (s * radius) : 2.5 * mu[k] * G * cos(slope) * s / radius;
        /* until the spring bears its share the sphere slides freely, over some 1e-6 m: 1e-3 s */
        NEAR(vx_of(&c, k), a * time, 1e-3 * a * time);
        NEAR(wy_of(&c, k), spin * time, 1e-3 * spin * time);
        NEAR(x_of(&c, k), 0.5 * a * time * time, 2e-3 * a * time * time);
        if (rolls)
            RELATIVE(a, 5.0 / 7.0 * G * sin(slope), 1e-3);
        NEAR(case_get(&c, "velocity", k, 1), 0.0, 0.0);
    }
    case_close(&c);
}

/* ---- static and dynamic ---- */

#define TWO "normal_damping_ratio: 0.3, tangential_damping_ratio: 0.3, friction_static: 0.6, friction_dynamic: 0.2"

/* Sliding obeys mu_d from the first step on and to its end: a test without memory would average the two. */
static void test_dynamic_friction(void **state)
{
    (void)state;
    const lane lanes[] = {{TWO, 1.0, 0, 0, 0, 0}, {TWO, 0.6, 0.8, 0, 0, 0}};
    double s = arm_share(0.0), early = 0.1, late = 0.4;
    physics_case c = lanes_open(mindlin, 0.0, lanes, 2);
    case_run(&c, (int64_t)round(early / DT), DT);
    NEAR(vx_of(&c, 0), 1.0 - 0.2 * G * early, 0.2 * G * 2.0 * DT);
    NEAR(vx_of(&c, 1), 0.6 * (1.0 - 0.2 * G * early), 0.2 * G * 2.0 * DT);
    NEAR(case_get(&c, "velocity", 1, 1), 0.8 * (1.0 - 0.2 * G * early), 0.2 * G * 2.0 * DT);
    case_run(&c, (int64_t)round((late - early) / DT), DT);
    RELATIVE(vx_of(&c, 0), 2.5 * s * s / (1.0 + 2.5 * s * s), 1e-5);
    RELATIVE(vx_of(&c, 1), 0.6 * 2.5 * s * s / (1.0 + 2.5 * s * s), 1e-5);
    case_close(&c);
}

/* On a slope between the two limits what rolls goes on rolling, and what slides goes on sliding. */
static void test_sliding_stays_sliding(void **state)
{
    (void)state;
    const lane lanes[] = {{"normal_damping_ratio: 0.3, friction_static: 0.5, friction_dynamic: 0.05", 0, 0, 0, 0, 0},
                          {"normal_damping_ratio: 0.3, friction_static: 0.5, friction_dynamic: 0.05", 0.05, 0, 0, 0, 0}};
    double slope = 20.0 * PI / 180.0, s = arm_share(slope), time = 0.2;
    physics_case c = lanes_open(mindlin, slope, lanes, 2);
    case_run(&c, (int64_t)round(time / DT), DT);
    RELATIVE(vx_of(&c, 0), G * sin(slope) / (1.0 + 0.4 / (s * s)) * time, 1e-3);
    RELATIVE(vx_of(&c, 1), 0.05 + G * (sin(slope) - 0.05 * cos(slope)) * time, 1e-4);
    RELATIVE(wy_of(&c, 1), 2.5 * 0.05 * G * cos(slope) * s / radius * time, 1e-3);
    case_close(&c);
}

/* The static limit: a sphere on a slope holds while the force that it needs is below mu_s N, here with tan(al) 5 per cent to either side of
 * 3.5 mu_s. Strong damping keeps the sum of spring and damper from overshooting. */
static void test_static_limit(void **state)
{
    (void)state;
    double slope = 30.0 * PI / 180.0, s = arm_share(slope), edge = tan(slope) / (1.0 + 2.5 * s * s), time = 0.1;
    char words[2][256];
    lane lanes[2] = {{0}};
    for (int k = 0; k < 2; k++) {
        double mu = edge * (k ? 0.95 : 1.05);
        snprintf(words[k], sizeof words[k],
                 "normal_damping_ratio: 0.3, tangential_damping_ratio: 3, friction_static: %.17g, friction_dynamic: %.17g", mu, 0.5 * mu);
        lanes[k].interaction = words[k];
    }
    physics_case c = lanes_open(mindlin, slope, lanes, 2);
    case_run(&c, (int64_t)round(time / DT), DT);
    RELATIVE(vx_of(&c, 0), G * sin(slope) / (1.0 + 0.4 / (s * s)) * time, 2e-3);
    RELATIVE(vx_of(&c, 1), G * (sin(slope) - 0.475 * edge * cos(slope)) * time, 5e-3);
    case_close(&c);
}

/* ---- oblique impacts ---- */

typedef struct oblique {
    double v_in, v_out, rw_out;
} oblique;

static void check_oblique(const char *shear_modulus, const oblique *rows, int count)
{
    const double young = 7.0e10, density = 2700.0, mu = 0.3, vn = 1.0;
    double duration = hertz_duration(young / (1.0 - 0.09), radius, sphere_mass(density, radius), vn);
    text t = {0};
    put(&t,
        "effects:\n  - {slot: normal, law: hertz}\n"
        "  - {slot: tangential, law: mindlin, shear_modulus: %s, lever_arm: radius, unloading: printed}\n",
        shear_modulus);
    put(&t, "materials:\n");
    for (int k = 0; k < LANES; k++) /* one is used: as many as the other cases have, which share the program */
        put(&t, "  - {name: m%d, density_kg_m3: %g, youngs_modulus_pa: %g, poissons_ratio: 0.3}\n", k, density, young);
    put(&t, "interactions: [{between: default, normal_damping_ratio: 0, friction_static: %g}]\n", mu);
    put(&t, "walls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}]\n");
    put(&t, "particles:\n  - name: p\n    material: m0\n    generator: list\n    items:\n");
    for (int k = 0; k < count; k++)
        put_grain(&t, radius, (double[]){0, 4.0 * radius * k, radius}, (double[]){rows[k].v_in, 0, -vn}, (double[]){0, 0, 0});
    physics_case c = case_open(&t);
    case_run(&c, 2200, duration / 2000);
    for (int k = 0; k < count; k++) {
        double v = rows[k].v_in;
        bool slides = v >= 7.0 * mu * vn;
        NEAR(vx_of(&c, k), slides ? v - 2.0 * mu * vn : rows[k].v_out, 2e-5);
        NEAR(-wy_of(&c, k) * radius, slides ? -5.0 * mu * vn : rows[k].rw_out, 5e-5);
        RELATIVE(case_get(&c, "velocity", k, 2), vn, 2e-6);
    }
    case_close(&c);
}

static void test_oblique_printed(void **state)
{
    (void)state;
    const oblique rows[] = {{0.4, 0.364043, -0.089893}, {1.0, 0.688185, -0.779538}, {2.1, 1.5, -1.5}, {3.0, 2.4, -1.5}};
    check_oblique("printed", rows, 4);
}

static void test_oblique_mindlin(void **state)
{
    (void)state;
    const oblique rows[] = {{0.4, 0.317133, -0.207167}, {1.0, 0.613960, -0.965101}, {2.1, 1.5, -1.5}, {3.0, 2.4, -1.5}};
    check_oblique("mindlin", rows, 4);
}

/* Two free spheres: half the relative normal speed each, full slip. */
static void test_oblique_pair(void **state)
{
    (void)state;
    double vn = 1.0, vt = 2.0, mu = 0.1, stiffer = 1.0e6;
    double duration = hertz_duration(0.5 * stiffer * plane_modulus(), 0.5 * radius, 0.5 * lane_mass(), vn);
    text t = {0};
    put(&t, "effects:\n%s\nmaterials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: %g, poissons_ratio: %g}]\n", mindlin_radius, density,
        young * stiffer, poisson);
    put(&t, "interactions: [{between: default, normal_damping_ratio: 0, friction_static: %g}]\n", mu);
    put(&t, "particles:\n  - name: p\n    material: m\n    generator: list\n    items:\n");
    put_grain(&t, radius, (double[]){-radius, 0, 0}, (double[]){0.5 * vn, 0.5 * vt, 0}, (double[]){0, 0, 0});
    put_grain(&t, radius, (double[]){radius, 0, 0}, (double[]){-0.5 * vn, -0.5 * vt, 0}, (double[]){0, 0, 0});
    physics_case c = case_open(&t);
    case_run(&c, 2200, duration / 2000);
    /* impulse 2 m* vn = m vn across, mu of it along; the pair turns by vt T/(2 r) = 1e-4 meanwhile, which tilts the impulse */
    double turn = vt * duration / (2.0 * radius);
    NEAR(case_get(&c, "velocity", 0, 1), 0.5 * vt - mu * vn, turn * vn);
    NEAR(case_get(&c, "velocity", 1, 1), -0.5 * vt + mu * vn, turn * vn);
    NEAR(case_get(&c, "spin", 0, 2) * radius, -2.5 * mu * vn, 5.0 * mu * turn * vn);
    NEAR(case_get(&c, "spin", 1, 2) * radius, -2.5 * mu * vn, 5.0 * mu * turn * vn);
    case_close(&c);
}

/* Linear springs that stick: the surface swings with sqrt(3.5 k_t/m) for half a period pi sqrt(m/k_n) of the normal spring. */
static void test_linear_stick(void **state)
{
    (void)state;
    const double ratios[] = {0.1, 2.0 / 7.0, 0.8};
    char words[3][128];
    double kn = 1.0e5, v = 0.3, m = lane_mass(), half = PI * sqrt(m / kn);
    text t = {0};
    put(&t, "effects:\n  - {slot: normal, law: linear}\n  - {slot: tangential, law: coulomb_linear, lever_arm: radius}\nmaterials:\n");
    for (int k = 0; k < 3; k++)
        put(&t, "  - {name: m%d, density_kg_m3: %.17g, youngs_modulus_pa: %.17g, poissons_ratio: %.17g}\n", k, density, young, poisson);
    put(&t, "interactions:\n  - {between: default, normal_stiffness_n_m: 1.0e5, tangential_stiffness_n_m: 1.0e5, normal_damping_ratio: 0, "
            "friction_static: 1000}\n");
    for (int k = 0; k < 3; k++) {
        snprintf(words[k], sizeof words[k], "tangential_stiffness_n_m: %.17g", ratios[k] * kn);
        put(&t, "  - {between: [m%d, floor], %s}\n", k, words[k]);
    }
    put(&t, "walls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}]\nparticles:\n");
    for (int k = 0; k < 3; k++) {
        put(&t, "  - name: p%d\n    material: m%d\n    generator: list\n    items:\n", k, k);
        put_grain(&t, radius, (double[]){0, 4.0 * radius * k, radius}, (double[]){v, 0, -1}, (double[]){0, 0, 0});
    }
    physics_case c = case_open(&t);
    case_run(&c, 2100, half / 2000);
    for (int k = 0; k < 3; k++) {
        double out = v * cos(PI * sqrt(3.5 * ratios[k]));
        NEAR(vx_of(&c, k), v - 2.0 / 7.0 * (v - out), 3e-3 * v);
        NEAR(wy_of(&c, k) * radius, 5.0 / 7.0 * (v - out), 3e-3 * v);
        RELATIVE(case_get(&c, "velocity", k, 2), 1.0, 2e-3);
    }
    case_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_slide_to_roll),         cmocka_unit_test(test_incline),      cmocka_unit_test(test_dynamic_friction),
        cmocka_unit_test(test_sliding_stays_sliding), cmocka_unit_test(test_static_limit), cmocka_unit_test(test_oblique_printed),
        cmocka_unit_test(test_oblique_mindlin),       cmocka_unit_test(test_oblique_pair), cmocka_unit_test(test_linear_stick),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
