/* Heat from dissipation: a fraction of what a contact loses, half to each grain, all to the grain at a wall. */
#include "case.h"
#include "ledger.h"

static const double radius = 2e-3, density = 2500, capacity = 500, share = 0.6;

static double mass(double r)
{
    return sphere_mass(density, r);
}

/* Two unequal grains collide obliquely, spinning; a third hits a floor. */
static physics_case impacts(double fraction, int64_t steps, double dt)
{
    text t = {0};
    put(&t, "effects:\n  - {slot: normal, law: hertz}\n  - {slot: tangential, law: mindlin}\n  - {slot: rolling, law: elastic_plastic}\n"
            "  - {slot: dissipation_heat, law: fraction, fraction: %g}\n"
            "materials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: 1.0e8, poissons_ratio: 0.3, specific_heat_j_kgk: %g}]\n"
            "interactions: [{between: default, restitution: 0.5, friction_static: 0.4, rolling_friction: 0.1}]\n"
            "output: {observables: [dissipated_normal, heat_dissipation]}\n"
            "walls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}]\n"
            "particles:\n  - name: p\n    material: m\n    temperature_k: 300\n    generator: list\n    items:\n",
        fraction, density, capacity);
    put_grain(&t, radius, (double[]){0, 0, 0.1}, (double[]){3, 1, 0}, (double[]){0, 100, 50});
    put_grain(&t, 2 * radius, (double[]){3.01 * radius, 0, 0.1}, (double[]){0, 0, 0}, (double[]){0, 0, 20});
    put_grain(&t, radius, (double[]){0.1, 0, 1.01 * radius}, (double[]){2, 0, -3}, (double[]){0, 0, 0});
    physics_case c = case_open(&t);
    case_run(&c, steps, dt);
    return c;
}

/* After the impacts, and in the midst of them: what has heated the grains is what the ledger says has been dissipated by then. */
static void check_shares(int64_t steps, int contacts)
{
    physics_case c = impacts(share, steps, 2e-7);
    assert_int_equal(case_contact_sums(&c).contacts, contacts);
    double *temperature = case_field(&c, "temperature"), *lost = case_field(&c, "dissipated");
    double pair = 0.0, wall = 0.0, sums[LEDGER_TERMS];
    for (int k = 0; k < 3; k++) {
        pair += lost[k] + lost[3 + k]; /* the pair's owner has all of it */
        wall += lost[6 + k];
        assert_true(lost[6 + k] > 0.0);
    }
    /* a rise of 1e-3 K on 300 K is known to 1e-10 */
    RELATIVE(mass(radius) * capacity * (temperature[0] - 300.0), 0.5 * share * pair, within(1e-8, LAW));
    RELATIVE(mass(2 * radius) * capacity * (temperature[1] - 300.0), 0.5 * share * pair, within(1e-8, LAW));
    RELATIVE(mass(radius) * capacity * (temperature[2] - 300.0), share * wall, within(1e-8, LAW));
    heat_sums heat;
    MUST(heat_observe(c.sim, &heat, why));
    MUST(ledger_read(c.sim, sums, why));
    RELATIVE(heat.tally[CLAST_TALLY_DISSIPATION], share * (sums[0] + sums[1] + sums[2]), within(1e-12, LAW));
    free(temperature);
    free(lost);
    case_close(&c);
}

static void test_shares(void **state)
{
    (void)state;
    check_shares(2000, 0);
    check_shares(300, 2);
}

/* With all of it turned into heat, motion, spin and heat together keep their energy, less the work of changing stiffness, but for what the step
 * loses: of first order, but for where in a step a contact begins. */
static void test_all_energy(void **state)
{
    (void)state;
    double gap[2], lost = 0.0, e[LEDGER_TERMS];
    for (int fine = 0; fine < 2; fine++) {
        physics_case start = impacts(1.0, 0, 2e-7), c = impacts(1.0, 2000 << 3 * fine, 2e-7 / (1 << 3 * fine));
        particle_sums a = case_sums(&start), b = case_sums(&c);
        heat_sums cold, warm;
        MUST(heat_observe(start.sim, &cold, why));
        MUST(heat_observe(c.sim, &warm, why));
        assert_int_equal(case_contact_sums(&c).contacts, 0);
        lost = a.kinetic + a.rotational - b.kinetic - b.rotational;
        MUST(ledger_read(c.sim, e, why));
        gap[fine] = lost - (warm.content - cold.content);
        for (int term = 3; term < 7; term++)
            gap[fine] += e[term];
        case_close(&start);
        case_close(&c);
    }
    assert_true(lost > 1e-5);
    for (int fine = 0; fine < 2; fine++) /* an eighth of the step */
        assert_true(fabs(gap[fine]) < within(1e-3 / (1 << 3 * fine), 64.0 * LAW) * lost);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_shares), cmocka_unit_test(test_all_energy)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
