/* Observed order of convergence: free flight 1 (velocity Verlet: exact), elastic contacts 2, damped contacts between 1 and 1.25 (the damper
 * goes as d^(1/4)); a smooth damper under velocity Verlet 2. */
#include "case.h"

static const double young = 1.0e9, density = 2500.0, radius = 1.0e-3, speed = 1.0;

static double duration(void)
{
    return hertz_duration(young / (1.0 - 0.09), radius, sphere_mass(density, radius), speed);
}

/* Of a linear spring that half a swing takes as long. */
static double stiffness(void)
{
    return sphere_mass(density, radius) * pow(PI / duration(), 2);
}

/* Height of a grain that touches the floor at t = 0 with `speed`, after `share` of the undamped duration in `steps` steps. */
static double height_under(const char *law, double ratio, double share, int steps)
{
    text t = {0};
    double ahead = strcmp(law, "linear") == 0 ? 1.0e-12 : 0.0; /* touching, so that the damper of the linear law does not set in later */
    put(&t,
        "effects: [{slot: normal, law: %s}]\nmaterials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: %g, poissons_ratio: 0.3}]\n", law,
        density, young);
    put(&t, "interactions: [{between: default, normal_damping_ratio: %g, normal_stiffness_n_m: %g}]\n", ratio, stiffness());
    put(&t, "walls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}]\n");
    put(&t, "particles:\n  - name: p\n    material: m\n    generator: list\n    items:\n");
    put_grain(&t, radius, (double[]){0, 0, radius - ahead}, (double[]){0, 0, -speed}, (double[]){0, 0, 0});
    physics_case c = case_open(&t);
    case_run(&c, steps, share * duration() / steps);
    double z = case_get(&c, "position", 0, 2);
    case_close(&c);
    return z;
}

static double height(double ratio, double share, int steps)
{
    return height_under("hertz", ratio, share, steps);
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
    double g = 9.81, time = 0.1, error = within(0.0, 0.5 * LAW) * 0.5 * g * time * time, z[2]; /* of gravity's share */
    for (int k = 0; k < 2; k++) {
        int steps = 100 << k;
        text t = {0};
        put(&t, "gravity_m_s2: [0, 0, %g]\nmaterials: [{name: m, density_kg_m3: %g}]\n", -g, density);
        put(&t, "particles:\n  - name: p\n    material: m\n    generator: list\n    items:\n");
        put_grain(&t, radius, (double[]){0, 0, 0}, (double[]){0.5, 0, 1}, (double[]){0, 0, 0});
        physics_case c = case_open(&t);
        case_run(&c, steps, time / steps);
        time = steps * c.sim->dt; /* the step may have been rounded */
        z[k] = case_get(&c, "position", 0, 2);
        /* x_n = v0 t - g dt^2 n (n + 1)/2 */
        NEAR(z[k], time - 0.5 * g * time * time * (1.0 + (case_verlet() ? 0.0 : 1.0 / steps)), fmax(1e-14, error));
        NEAR(case_get(&c, "velocity", 0, 2), 1.0 - g * time, within(1e-13, 0.5 * LAW) * g * time);
        NEAR(case_get(&c, "position", 0, 0), 0.5 * time, kept(1e-14, 0.1, steps));
        case_close(&c);
    }
    double exact = time - 0.5 * g * time * time;
    if (!case_verlet())
        NEAR(log2((z[0] - exact) / (z[1] - exact)), 1.0, 1e-6 + 2.0 * error / fabs(z[1] - exact));
}

/* Under velocity Verlet a parabola is exact, whatever the steps and where they change; under gravity that a stage changes too. */
static void test_parabola(void **state)
{
    (void)state;
    const double g = 9.81, dt = 1.0e-3;
    if (!case_verlet())
        return;
    text t = {0};
    put(&t, "gravity_m_s2: [0, 0, %g]\nmaterials: [{name: m, density_kg_m3: %g}]\n", -g, density);
    put(&t, "particles:\n  - name: p\n    material: m\n    generator: list\n    items:\n");
    put_grain(&t, radius, (double[]){0, 0, 0}, (double[]){0.5, 0, 1}, (double[]){0, 0, 0});
    put(&t, "stages: [{name: a, until: {steps: 1}}, {name: b, until: {steps: 1}, change: {gravity_m_s2: [0, 0, 2]}}]\n");
    physics_case c = case_open(&t);
    case_run(&c, 30, dt);
    case_run(&c, 1, 1.7 * dt);
    case_run(&c, 64, 0.1 * dt);
    case_run(&c, 7, 3.0 * dt);
    double time = c.sim->time, v = 1.0 - g * time, z = time - 0.5 * g * time * time, rounds = within(0.0, LAW) * g * time;
    RELATIVE(time, 30 * dt + 1.7 * dt + 6.4 * dt + 21 * dt, within(1e-15, 1.0));
    NEAR(case_get(&c, "position", 0, 2), z, 1e-15 + rounds * time);
    NEAR(case_get(&c, "velocity", 0, 2), v, 2e-15 + rounds);
    case_stage(&c, 1);
    case_run(&c, 50, 2.0 * dt);
    double more = c.sim->time - time;
    NEAR(case_get(&c, "position", 0, 2), z + v * more + more * more, 1e-15 + 2.0 * rounds * c.sim->time);
    NEAR(case_get(&c, "velocity", 0, 2), v + 2.0 * more, 2e-15 + 2.0 * rounds);
    case_close(&c);
}

static void test_elastic(void **state)
{
    (void)state;
    /* Of the overlap, 1e-6 of which is the difference of the finer two runs, a float knows 1e-7: steps four times as long make that 16 times as
     * large, and leave more of the higher orders (a contact that sets in goes as d^1.5), in double too. */
    int longer = case_mixed() ? 4 : 1;
    double high = case_mixed() ? 2.2 : 2.1;
    BETWEEN(order(0.0, 0.6, 200 / longer), 1.9, high);
    BETWEEN(order(0.0, 0.9, 400 / longer), 1.9, 2.1);
}

static void test_damped(void **state)
{
    (void)state;
    BETWEEN(order(0.1, 0.7, 400), 0.95, 1.3);
    BETWEEN(order(0.3, 0.7, 400), 0.95, 1.3);
    BETWEEN(order(1.0, 1.0, 400), 0.95, 1.3);
}

/* A damper in proportion to the speed: m z'' = -k z - c z' from the first touch, before the clamp ends it. */
static void test_smooth_damper(void **state)
{
    (void)state;
    double x[3], xi = 0.2, omega = PI / duration(), t = 0.5 * duration(), damped = omega * sqrt(1.0 - xi * xi);
    for (int k = 0; k < 3; k++)
        x[k] = radius - height_under("linear", xi, 0.5, 100 << k);
    BETWEEN(log2((x[0] - x[1]) / (x[1] - x[2])), case_verlet() ? 1.9 : 0.9, case_verlet() ? 2.1 : 1.1);
    RELATIVE(x[2], speed / damped * exp(-xi * omega * t) * sin(damped * t), case_verlet() ? 1e-4 : 3e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_free_flight),
        cmocka_unit_test(test_elastic),
        cmocka_unit_test(test_damped),
        cmocka_unit_test(test_smooth_damper),
        cmocka_unit_test(test_parabola),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
