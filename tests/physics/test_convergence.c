/* Observed order of convergence: free flight 1, elastic contacts 2, damped contacts between 1 and 1.25 (the damper goes as d^(1/4)). */
#include "case.h"

static const double young = 1.0e9, density = 2500.0, radius = 1.0e-3, speed = 1.0;

static double duration(void)
{
    return hertz_duration(young / (1.0 - 0.09), radius, sphere_mass(density, radius), speed);
}

/* Height of a grain that touches the floor at t = 0 with `speed`, after `share` of the undamped duration in `steps` steps. */
static double height(double ratio, double share, int steps)
{
    text t = {0};
    put(&t,
        "effects: [{slot: normal, law: hertz}]\nmaterials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: %g, poissons_ratio: 0.3}]\n",
        density, young);
    put(&t, "interactions: [{between: default, normal_damping_ratio: %g}]\n", ratio);
    put(&t, "walls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}]\n");
    put(&t, "particles:\n  - name: p\n    material: m\n    generator: list\n    items:\n");
    put_grain(&t, radius, (double[]){0, 0, radius}, (double[]){0, 0, -speed}, (double[]){0, 0, 0});
    physics_case c = case_open(&t);
    case_run(&c, steps, share * duration() / steps);
    double z = case_get(&c, "position", 0, 2);
    case_close(&c);
    return z;
}

/* From three runs, the step halved each time. */
static double order(double ratio, double share, int steps)
{
    double coarse = height(ratio, share, steps), middle = height(ratio, share, 2 * steps), fine = height(ratio, share, 4 * steps);
    return log2(fabs((coarse - middle) / (middle - fine)));
}

static void test_free_flight(void **state)
{
    (void)state;
    double g = 9.81, time = 0.1, z[2];
    for (int k = 0; k < 2; k++) {
        int steps = 100 << k;
        text t = {0};
        put(&t, "gravity_m_s2: [0, 0, %g]\nmaterials: [{name: m, density_kg_m3: %g}]\n", -g, density);
        put(&t, "particles:\n  - name: p\n    material: m\n    generator: list\n    items:\n");
        put_grain(&t, radius, (double[]){0, 0, 0}, (double[]){0.5, 0, 1}, (double[]){0, 0, 0});
        physics_case c = case_open(&t);
        case_run(&c, steps, time / steps);
        z[k] = case_get(&c, "position", 0, 2);
        /* x_n = v0 t - g dt^2 n (n + 1)/2 */
        NEAR(z[k], time - 0.5 * g * time * time * (1.0 + 1.0 / steps), 1e-14);
        NEAR(case_get(&c, "velocity", 0, 2), 1.0 - g * time, 1e-13);
        NEAR(case_get(&c, "position", 0, 0), 0.5 * time, 1e-14);
        case_close(&c);
    }
    double exact = time - 0.5 * g * time * time;
    NEAR(log2((z[0] - exact) / (z[1] - exact)), 1.0, 1e-6);
}

static void test_elastic(void **state)
{
    (void)state;
    BETWEEN(order(0.0, 0.6, 200), 1.9, 2.1);
    BETWEEN(order(0.0, 0.9, 400), 1.9, 2.1);
}

static void test_damped(void **state)
{
    (void)state;
    BETWEEN(order(0.1, 0.7, 400), 0.95, 1.3);
    BETWEEN(order(0.3, 0.7, 400), 0.95, 1.3);
    BETWEEN(order(1.0, 1.0, 400), 0.95, 1.3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_free_flight),
        cmocka_unit_test(test_elastic),
        cmocka_unit_test(test_damped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
