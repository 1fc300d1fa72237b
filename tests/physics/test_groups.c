/* Grains that are held or moved as prescribed: they follow their motion exactly, count as infinitely heavy, and leave one another alone. */
#include "case.h"

static const double young = 1.0e9, density = 2500.0, radius = 1.0e-3;
static const double none[3] = {0, 0, 0};

static text head(double damping)
{
    text t = {0};
    put(&t,
        "effects: [{slot: normal, law: hertz}]\nmaterials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: %g, poissons_ratio: 0.3}]\n",
        density, young);
    put(&t, "interactions: [{between: default, normal_damping_ratio: %g}]\nparticles:\n", damping);
    return t;
}

static void put_group(text *t, const char *name, const char *motion, const double *x, const double *v)
{
    put(t, "  - name: %s\n    material: m\n    generator: list\n    motion: %s\n    items:\n", name, motion);
    put_grain(t, radius, x, v, none);
}

/* r* = r/2 and E* of the pair, but m* = m. */
static double duration(double v)
{
    return hertz_duration(young / (2.0 * (1.0 - 0.09)), 0.5 * radius, sphere_mass(density, radius), v);
}

static void test_fixed(void **state)
{
    (void)state;
    double v = 1.0;
    text t = head(0.0);
    put_group(&t, "held", "fixed", (double[]){radius, 0, 0}, none);
    put_group(&t, "flying", "free", (double[]){-radius, 0, 0}, (double[]){v, 0, 0});
    physics_case c = case_open(&t);
    case_run(&c, 500, duration(v) / 1000);
    NEAR(case_get(&c, "velocity", 1, 0), 0.0, 4e-3 * v); /* turning point at half the duration */
    NEAR(case_get(&c, "position", 1, 0), -radius + hertz_overlap(young / (2.0 * 0.91), 0.5 * radius, sphere_mass(density, radius), v),
         1e-6 * radius);
    case_run(&c, 510, duration(v) / 1000);
    RELATIVE(case_get(&c, "velocity", 1, 0), -v, 2e-6);
    double *x = case_field(&c, "position"), *u = case_field(&c, "velocity");
    NEAR(x[0], radius, kept(0.0, 8.0 * radius, 1.0));
    assert_true(x[1] == 0.0 && x[2] == 0.0 && u[0] == 0.0 && u[1] == 0.0 && u[2] == 0.0);
    free(x);
    free(u);
    case_close(&c);
}

/* Damping knows the mass of the free one alone: restitution is that of the ratio. */
static void test_damped_hit(void **state)
{
    (void)state;
    double v = 1.0;
    text t = head(0.3);
    put_group(&t, "held", "fixed", (double[]){radius, 0, 0}, none);
    put_group(&t, "flying", "free", (double[]){-radius, 0, 0}, (double[]){v, 0, 0});
    physics_case c = case_open(&t);
    case_run(&c, 12000, duration(v) / 4000);
    NEAR(case_get(&c, "velocity", 1, 0), -hertz_restitution(0.3) * v, 3e-4);
    case_close(&c);
}

static void test_prescribed_hits(void **state)
{
    (void)state;
    double u = 0.8;
    text t = head(0.0);
    put_group(&t, "pushed", "[{type: constant, velocity_m_s: [0.8, 0, 0]}]", (double[]){-radius, 0, 0}, none);
    put_group(&t, "hit", "free", (double[]){radius, 0, 0}, none);
    physics_case c = case_open(&t);
    case_run(&c, 1010, duration(u) / 1000);
    RELATIVE(case_get(&c, "velocity", 1, 0), 2.0 * u, 2e-6);
    NEAR(case_get(&c, "position", 0, 0), -radius + u * c.sim->time, kept(1e-15, 8.0 * radius, 1010));
    NEAR(case_get(&c, "velocity", 0, 0), u, within(0.0, 1.0) * u);
    case_close(&c);
}

/* Sum of terms: a sinusoid and a constant; a rotation about a moving axis; a table. Positions are those of the closed form at every time.
 * */
static void test_paths(void **state)
{
    (void)state;
    const double omega = 2.0 * PI * 40.0, rate = 30.0, dt = 1.0e-4;
    text t = head(0.0);
    put_group(&t, "swung",
              "[{type: sinusoid, direction: [0, 3, 4], amplitude_m: 0.002, frequency_hz: 40}, {type: constant, velocity_m_s: [0.1, 0, 0]}]",
              none, none);
    put_group(&t, "turned",
              "[{type: rotation, point_m: [0.1, 0, 0], axis: [0, 0, 2], rate_rad_s: 30}, {type: constant, velocity_m_s: [0, 0, 0.2]}]",
              (double[]){0.12, 0, 0.01}, none);
    put_group(&t, "tabled", "[{type: table, time_s: [0.01, 0.03], velocity_m_s: [[0, 0, 0], [0, 0.4, 0]]}]", (double[]){0.2, 0, 0}, none);
    put(&t, "output: {fields: [position, spin]}\n");
    physics_case c = case_open(&t);
    for (int part = 0; part < 5; part++) {
        case_run(&c, 100, dt);
        double *x = case_field(&c, "position"), *v = case_field(&c, "velocity"), time = c.sim->time, place = kept(1e-12, 0.4, time / dt), speed = within(1e-10, LAW);
        NEAR(x[0], 0.1 * time, place);
        NEAR(x[1], 0.6 * 0.002 * sin(omega * time), place);
        NEAR(x[2], 0.8 * 0.002 * sin(omega * time), place);
        NEAR(v[2], 0.8 * 0.002 * omega * cos(omega * time), speed);
        NEAR(x[3], 0.1 + 0.02 * cos(rate * time), place);
        NEAR(x[4], 0.02 * sin(rate * time), place);
        NEAR(x[5], 0.01 + 0.2 * time, place);
        NEAR(v[3], -0.02 * rate * sin(rate * time), speed);
        NEAR(case_get(&c, "spin", 1, 2), rate, 1e-12);
        double since = fmax(0.0, fmin(time, 0.03) - 0.01), after = fmax(0.0, time - 0.03);
        NEAR(x[7], 0.5 * 0.4 / 0.02 * since * since + 0.4 * after, place);
        free(x);
        free(v);
    }
    case_close(&c);
}

/* Held and moved grains that overlap give no force; a free one between them feels both. */
static void test_prescribed_pair(void **state)
{
    (void)state;
    text t = head(0.0);
    put_group(&t, "a", "fixed", none, none);
    put_group(&t, "b", "[{type: constant, velocity_m_s: [0, 0, 0]}]", (double[]){1.5e-3, 0, 0}, none);
    physics_case c = case_open(&t);
    assert_int_equal(case_contact_sums(&c).contacts, 0);
    double *f = case_totals(&c, false);
    for (int k = 0; k < 6; k++)
        assert_true(f[k] == 0.0);
    free(f);
    assert_true(isfinite(case_limit(&c).limit_s)); /* they may come to move */
    case_close(&c);
    t = head(0.0);
    put_group(&t, "a", "fixed", none, none);
    put_group(&t, "b", "fixed", (double[]){1.5e-3, 0, 0}, none);
    c = case_open(&t);
    assert_false(isfinite(case_limit(&c).limit_s)); /* nothing can: no contact bounds the step */
    case_close(&c);
}

/* Stages: moved, then let go with the speed it has, then held where it is. */
static void test_stages(void **state)
{
    (void)state;
    const double dt = 1.0e-4;
    text t = head(0.0);
    put_group(&t, "p", "[{type: constant, velocity_m_s: [0.5, 0, 0]}]", none, none);
    put(&t, "gravity_m_s2: [0, 0, -10]\nstages:\n  - {name: a, until: {steps: 100}}\n  - {name: b, until: {steps: 100}, change: "
            "{particles: [{name: p, motion: free}]}}\n"
            "  - {name: c, until: {steps: 100}, change: {particles: [{name: p, motion: fixed}]}}\n"
            "  - {name: d, until: {steps: 100}, change: {particles: [{name: p, motion: free}]}}\n");
    physics_case c = case_open(&t);
    case_run(&c, 100, dt);
    case_stage(&c, 1);
    case_run(&c, 100, dt);
    double *v = case_field(&c, "velocity"), *x = case_field(&c, "position");
    NEAR(v[0], 0.5, 1e-15);
    double step = c.sim->dt, rounds = within(0.0, LAW); /* of an increment of the velocity */
    NEAR(v[2], -1000.0 * step, 1e-12 + 0.1 * rounds);
    NEAR(x[0], 100.0 * step, kept(1e-14, 0.02, 200));
    double fall = 10.0 * step * step * 100.0 * (case_verlet() ? 100.0 : 101.0) / 2.0;
    NEAR(x[2], -fall, 1e-14 + fall * rounds);
    free(v);
    free(x);
    case_stage(&c, 2);
    case_run(&c, 100, dt);
    v = case_field(&c, "velocity");
    x = case_field(&c, "position");
    assert_true(v[0] == 0.0 && v[2] == 0.0);
    NEAR(x[2], -fall, 1e-14 + fall * rounds);
    free(v);
    free(x);
    case_stage(&c, 3);
    case_run(&c, 100, dt);
    NEAR(case_get(&c, "velocity", 0, 2), -1000.0 * step, 1e-12 + 0.1 * rounds);
    NEAR(case_get(&c, "velocity", 0, 0), 0.0, 0.0);
    case_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fixed), cmocka_unit_test(test_damped_hit),      cmocka_unit_test(test_prescribed_hits),
        cmocka_unit_test(test_paths), cmocka_unit_test(test_prescribed_pair), cmocka_unit_test(test_stages),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
