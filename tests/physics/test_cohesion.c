/* Cohesion by the work of adhesion w against its closed forms: pull-off forces, what a bounce loses to JKR's hysteresis, energy. */
#include "case.h"

static const double radius = 1.0e-4, density = 2500.0, young = 1.0e7, work = 0.5;
#define MODULUS (young / (2.0 * (1.0 - 0.09))) /* of two, nu 0.3 */
#define R_PAIR  (0.5 * radius)

static text head(const char *law, double gravity, double xi)
{
    text t = {0};
    put(&t, "gravity_m_s2: [%.17g, 0, 0]\neffects: [{slot: normal, law: hertz}, {slot: cohesion, law: %s}]\n", gravity, law);
    put(&t, "materials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: %g, poissons_ratio: 0.3}]\n", density, young);
    put(&t, "interactions: [{between: default, normal_damping_ratio: %g, work_of_adhesion_j_m2: %g}]\nparticles:\n", xi, work);
    return t;
}

/* A grain hangs on a held one with a share of the pull-off force, from `overlap` on. */
static bool holds(const char *law, double share, double pull, double overlap)
{
    text t = head(law, share * pull / sphere_mass(density, radius), 1.0);
    put(&t, "  - {name: held, material: m, generator: list, motion: fixed, items: [{radius_m: %g, position_m: [0, 0, 0]}]}\n", radius);
    put(&t, "  - {name: hung, material: m, generator: list, items: [{radius_m: %g, position_m: [%.17g, 0, 0]}]}\n", radius, 2.0 * radius - overlap);
    physics_case c = case_open(&t);
    case_run(&c, 10000, 5e-7); /* passing the top takes milliseconds */
    bool near = case_get(&c, "position", 1, 0) < 2.1 * radius;
    case_close(&c);
    return near;
}

static void test_pull_off(void **state)
{
    (void)state;
    double jkr = 1.5 * PI * work * R_PAIR, dmt = 2.0 * PI * work * R_PAIR;
    /* overlap at which JKR's force is 0: a^3 = 6 pi w r*^2/E*, d = a^2/(3 r*) */
    double rest = pow(6.0 * PI * work * R_PAIR * R_PAIR / MODULUS, 2.0 / 3.0) / (3.0 * R_PAIR);
    assert_true(holds("jkr", 0.98, jkr, rest));
    assert_false(holds("jkr", 1.02, jkr, rest));
    assert_true(holds("sjkr", 0.97, jkr, rest));
    assert_false(holds("sjkr", 1.02, jkr, rest));
    assert_true(holds("dmt", 0.95, dmt, 0.2 * rest));
    assert_false(holds("dmt", 1.02, dmt, 0.2 * rest));
}

/* Energy of the contact as a function of its radius, J: the integral of the force over the overlap. */
static double energy(double a)
{
    return 8.0 * MODULUS * pow(a, 5) / (15.0 * R_PAIR * R_PAIR) - 4.0 / (3.0 * R_PAIR) * sqrt(2.0 * PI * work * MODULUS) * pow(a, 3.5) +
           PI * work * a * a;
}

/* Without damping a bounce loses what the neck takes between touch (d = 0, a^3 = 2 pi w r*^2/E*) and letting go (a_c^3 = pi w r*^2/(8 E*)): the
 * area of the loop. Below that speed the two stay together. */
static void test_hysteresis(void **state)
{
    (void)state;
    double touch = cbrt(2.0 * PI * work * R_PAIR * R_PAIR / MODULUS), leave = cbrt(PI * work * R_PAIR * R_PAIR / (8.0 * MODULUS));
    double loop = energy(leave) - energy(touch), mass = 0.5 * sphere_mass(density, radius), least = sqrt(2.0 * loop / mass);
    RELATIVE(loop, 7.09 * cbrt(pow(work, 5) * pow(R_PAIR, 4) / (MODULUS * MODULUS)), 2e-2); /* Thornton and Ning 1998, for their modulus */
    const double share[] = {0.97, 1.03, 1.5, 3.0};
    text t = head("jkr", 0.0, 0.0);
    for (int n = 0; n < COUNT_OF(share); n++) {
        put(&t, "  - name: p%d\n    material: m\n    generator: list\n    items:\n", n);
        for (int side = -1; side < 2; side += 2)
            put_grain(&t, radius, (double[]){side * 1.0001 * radius, n * 1e-3, 0}, (double[]){-0.5 * side * share[n] * least, 0, 0}, (double[]){0, 0, 0});
    }
    physics_case c = case_open(&t);
    case_run(&c, 60000, 5e-9);
    for (int n = 0; n < COUNT_OF(share); n++) {
        double gap = case_get(&c, "position", 2 * n + 1, 0) - case_get(&c, "position", 2 * n, 0) - 2.0 * radius;
        double apart = case_get(&c, "velocity", 2 * n + 1, 0) - case_get(&c, "velocity", 2 * n, 0);
        if (share[n] < 1.0) {
            assert_true(gap < 0.1 * radius);
            continue;
        }
        assert_true(gap > 0.1 * radius);
        NEAR(apart, least * sqrt(share[n] * share[n] - 1.0), 2e-2 * least);
    }
    case_close(&c);
}

/* While the neck holds, kinetic and elastic energy together stay (2nd order in the step). */
static void test_energy(void **state)
{
    (void)state;
    static const char *const laws[] = {"jkr", "dmt", "sjkr"};
    for (int l = 0; l < 3; l++) {
        text t = head(laws[l], 0.0, 0.0);
        put(&t, "  - name: p\n    material: m\n    generator: list\n    items:\n");
        put_grain(&t, radius, (double[]){-0.999 * radius, 0, 0}, (double[]){0.05, 0, 0}, (double[]){0, 0, 0});
        put_grain(&t, 1.5 * radius, (double[]){1.499 * radius, 0, 0}, (double[]){-0.05, 0, 0}, (double[]){0, 0, 0});
        physics_case c = case_open(&t);
        case_run(&c, 1, 1e-9);
        double kinetic = case_sums(&c).kinetic, before = kinetic + case_contact_sums(&c).elastic, most = kinetic;
        for (int n = 0; n < 100; n++) {
            case_run(&c, 20, 2e-9);
            double now = case_sums(&c).kinetic;
            most = fmax(most, now);
            NEAR(now + case_contact_sums(&c).elastic, before, 2e-3 * most);
        }
        assert_true(most > 1.01 * kinetic);
        case_close(&c);
    }
}

/* Bonds and cohesion in one scene: a bonded grain hangs by the beam alone, W/k below where it was made, though the neck of JKR would reach there;
 * its neighbour without a bond hangs by cohesion; and one whose bond has broken, too. */
static void test_beside_bonds(void **state)
{
    (void)state;
    double weight = 0.5 * 1.5 * PI * work * R_PAIR, young_bond = 3.75e5, stiffness = young_bond * PI * radius * radius / (2.0 * radius);
    text t = {0};
    put(&t, "gravity_m_s2: [%.17g, 0, 0]\neffects: [{slot: normal, law: hertz}, {slot: cohesion, law: jkr}, {slot: bond, law: parallel, criterion: "
            "at_time}]\n", weight / sphere_mass(density, radius));
    static const char *const material[] = {"strong", "loose", "weak"};
    put(&t, "materials:\n");
    for (int n = 0; n < 3; n++)
        put(&t, "  - {name: %s, density_kg_m3: %g, youngs_modulus_pa: %g, poissons_ratio: 0.3}\n", material[n], density, young);
    put(&t, "interactions: [{between: default, normal_damping_ratio: 1, work_of_adhesion_j_m2: %g, bond_youngs_modulus_pa: %g, bond_damping_ratio: 1}, "
            "{between: [loose, loose], bond_youngs_modulus_pa: 0}, {between: [weak, weak], bond_tensile_strength_pa: %.17g}]\nparticles:\n", work, young_bond, 0.5 * weight / (PI * radius * radius));
    for (int n = 0; n < 3; n++) {
        put(&t, "  - {name: held%d, material: %s, generator: list, motion: fixed, items: [{radius_m: %g, position_m: [0, %g, 0]}]}\n", n, material[n],
            radius, n * 1e-3);
        put(&t, "  - {name: hung%d, material: %s, generator: list, items: [{radius_m: %g, position_m: [%.17g, %g, 0]}]}\n", n, material[n], radius,
            2.0 * radius - 1e-8, n * 1e-3);
    }
    physics_case c = case_open(&t);
    case_run(&c, 20000, 2e-7);
    bond_sums sums;
    MUST(bonds_count(c.sim, &sums, why));
    assert_int_equal(sums.made, 2);
    assert_int_equal(sums.alive, 1);
    RELATIVE(case_get(&c, "position", 1, 0) - 2.0 * radius, weight / stiffness - 1e-8, 1e-4);
    double free_gap = case_get(&c, "position", 3, 0) - 2.0 * radius, broken_gap = case_get(&c, "position", 5, 0) - 2.0 * radius;
    assert_true(free_gap < 0.5 * weight / stiffness && free_gap > -1e-5);
    NEAR(broken_gap, free_gap, 1e-9);
    case_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pull_off),
        cmocka_unit_test(test_hysteresis),
        cmocka_unit_test(test_energy),
        cmocka_unit_test(test_beside_bonds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
