/* Background damping and orientation against closed forms. */
#include "on_plane.h"

static const double none[3] = {0, 0, 0};

static physics_case one_grain(const char *lines, const double *v, const double *w)
{
    text t = {0};
    put(&t, "%s\nmaterials: [{name: m, density_kg_m3: 2500}]\nparticles:\n  - name: p\n    material: m\n    generator: list\n    items:\n",
        lines);
    put_grain(&t, radius, none, v, w);
    return case_open(&t);
}

/* Steps of v += dt (g - c v): v_n = g/c + (v_0 - g/c)(1 - c dt)^n, which goes to exp(-c t); velocity Verlet meets that to second order. */
static void test_viscous(void **state)
{
    (void)state;
    const double v0[3] = {2.0, 0, 0}, w0[3] = {0, 300, 0}, c = 5.0, dt = 1.0e-3;
    physics_case k = one_grain("gravity_m_s2: [0, 0, -9.81]\neffects: [{slot: body, law: viscous_damping, coefficient: 5}]", v0, w0);
    case_run(&k, 400, dt);
    double left = case_verlet() ? exp(-c * 0.4) : pow(1.0 - c * dt, 400), error = case_verlet() ? c * c * dt * dt * c * 0.4 : 1e-12;
    error = within(error, c * 0.4 * LAW); /* the exponent of what is left, an increment's roundings */
    RELATIVE(case_get(&k, "velocity", 0, 0), v0[0] * left, error);
    RELATIVE(case_get(&k, "velocity", 0, 2), -9.81 / c * (1.0 - left), error);
    RELATIVE(case_get(&k, "spin", 0, 1), w0[1] * left, error);
    RELATIVE(left, exp(-c * 0.4), 0.5 * c * dt * c * 0.4 * 1.1);
    case_close(&k);
}

/* Falls with g (1 - a), rises against g (1 + a), each component by itself; the very first kick from rest, of a step or of half a
 * one, is not damped. */
static void test_local(void **state)
{
    (void)state;
    const double up[3] = {0, 1, 1}, a = 0.3, dt = 1.0e-3, first = case_verlet() ? 0.5 : 1.0;
    const char *lines = "gravity_m_s2: [0, -2, -9.81]\neffects: [{slot: body, law: local_damping, coefficient: 0.3}]";
    physics_case k = one_grain(lines, none, none);
    case_run(&k, 100, dt);
    RELATIVE(case_get(&k, "velocity", 0, 2), -9.81 * dt * (first + (100.0 - first) * (1.0 - a)), within(1e-12, LAW));
    RELATIVE(case_get(&k, "velocity", 0, 1), -2.0 * dt * (first + (100.0 - first) * (1.0 - a)), within(1e-12, LAW));
    case_close(&k);
    k = one_grain(lines, up, none);
    case_run(&k, 50, dt);
    RELATIVE(case_get(&k, "velocity", 0, 2), 1.0 - 9.81 * (1.0 + a) * 50.0 * dt, within(1e-12, 2.0 * LAW)); /* of a start and a loss of one size */
    RELATIVE(case_get(&k, "velocity", 0, 1), 1.0 - 2.0 * (1.0 + a) * 50.0 * dt, within(1e-12, 2.0 * LAW)); /* of a start and a loss of one size */
    case_close(&k);
}

/* Equilibrium is what it is without damping, and is reached though the contact has none of its own; a brake on the spin acts 1 + a times.
 * */
static void test_local_in_contact(void **state)
{
    (void)state;
    const lane lanes[] = {{"normal_damping_ratio: 0, rolling_friction: 0.02", 0, 0, 0, 0, 100}};
    const char *effects = "  - {slot: normal, law: hertz}\n  - {slot: rolling, law: constant_torque}\n  - {slot: body, law: local_damping, "
                          "coefficient: 0.3}\n";
    physics_case c = lanes_open(effects, 0.0, lanes, 1);
    case_run(&c, 5000, 1.0e-5);
    NEAR(case_get(&c, "spin", 0, 2), 100.0 - 1.3 * 2.5 * 0.02 * G / radius * 0.05, 1e-2);
    c.sim->gravity[2] *= 2.0;
    case_run(&c, 20000, 1.0e-5);
    double rest = pow(2.0, 2.0 / 3.0) * rest_overlap(0.0);
    NEAR(case_get(&c, "position", 0, 2), radius - rest, within(1e-9, LAW) * rest);
    case_close(&c);
}

/* ---- orientation ---- */

/* After a turn by |w| t about w: (cos(|w| t/2), w/|w| sin(|w| t/2)) up to the sign of the whole. */
static void check_spin(double rate, double dt, int steps, double tolerance)
{
    const double axis[3] = {1.0 / sqrt(14.0), 2.0 / sqrt(14.0), -3.0 / sqrt(14.0)};
    physics_case c = one_grain("output: {fields: [position, orientation]}", none,
                               (double[]){rate * axis[0], rate * axis[1], rate * axis[2]});
    case_run(&c, steps, dt);
    double *q = case_field(&c, "orientation"), half = 0.5 * rate * c.sim->dt * steps, norm = 0.0;
    tolerance = within(tolerance, half * LAW); /* each step turns by an angle that is known to some roundings */
    double sign = q[0] * cos(half) + (q[1] * axis[0] + q[2] * axis[1] + q[3] * axis[2]) * sin(half) < 0.0 ? -1.0 : 1.0;
    for (int k = 0; k < 4; k++)
        norm += q[k] * q[k];
    NEAR(norm, 1.0, kept(1e-14, 1.0, LAW)); /* made anew in every step */
    NEAR(sign * q[0], cos(half), tolerance);
    for (int k = 0; k < 3; k++)
        NEAR(sign * q[k + 1], axis[k] * sin(half), tolerance);
    case_close(&c);
    free(q);
}

static void test_orientation(void **state)
{
    (void)state;
    check_spin(3.0, 1.0e-2, 100, 1e-13);     /* 3 rad */
    check_spin(100.0, 1.0e-4, 1000, 1e-12);  /* 10 rad: past the half turn at which Rodrigues' vector is singular */
    check_spin(1.0e5, 1.0e-6, 10000, 1e-10); /* 1000 rad in steps of 0.1 */
    check_spin(1.0e5, 5.0e-6, 2000, 1e-6);   /* in steps of 0.5 */
}

/* Under a torque the orientation follows the spin of each step: about a fixed axis the angle is the sum of w dt. */
static void test_orientation_of_a_rolling_grain(void **state)
{
    (void)state;
    const lane lanes[] = {{"normal_damping_ratio: 0.3, friction_static: 0.3", 1.0, 0, 0, 0, 0}};
    physics_case c = lanes_open(
        "  - {slot: normal, law: hertz}\n  - {slot: tangential, law: mindlin}\noutput: {fields: [position, orientation]}\n", 0.0, lanes, 1);
    double angle = 0.0, dt = 1.0e-5, s = arm_share(0.0);
    for (int part = 0; part < 200; part++) {
        double before = wy_of(&c, 0);
        case_run(&c, 100, dt);
        angle += 0.5 * (before + wy_of(&c, 0)) * 100.0 * dt;
    }
    /* rolling without slip since t1 = v0/(mu g (1 + 5 s^2/2)), sliding with w = 5 mu g s t/(2 r) before */
    double t1 = 1.0 / (0.3 * G * (1.0 + 2.5 * s * s)), w1 = 2.5 * 0.3 * G * s / radius * t1;
    RELATIVE(angle, 0.5 * w1 * t1 + w1 * (0.2 - t1), 1e-3);
    double *q = case_field(&c, "orientation");
    double turned = fmod(angle, 2.0 * PI), seen = 2.0 * atan2(q[2], q[0]);
    NEAR(sin(0.5 * (turned - seen)), 0.0, 5e-3);
    assert_true(q[1] == 0.0 && q[3] == 0.0);
    assert_true(angle > 3.0 * PI);
    free(q);
    case_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_viscous),
        cmocka_unit_test(test_local),
        cmocka_unit_test(test_local_in_contact),
        cmocka_unit_test(test_orientation),
        cmocka_unit_test(test_orientation_of_a_rolling_grain),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
