/* Heat that advances in every n-th step of motion: what it brings, that nothing is lost, and that it is the same in the limit. */
#include "case.h"
#include "heat_case.h"

/* What a run in mixed precision may be off by, relative: so many roundings of a float. */
static double floats(double roundings)
{
    const char *set = getenv("CLAST_TEST_SET");
    return set && strstr(set, "mixed") ? roundings * 0x1p-24 : 0.0;
}

/* A bouncing row between hot walls that rubs, conducts, is cooled and heated. */
static physics_case lively(int every)
{
    text t = {0};
    put(&t, "environment: {temperature_k: 280}\n"
            "effects:\n  - {slot: normal, law: hertz}\n  - {slot: tangential, law: mindlin}\n  - {slot: conduction, law: overlap_area}\n  - {slot: dissipation_heat, law: fraction}\n"
            "  - {slot: convection, law: newton, coefficient_w_m2k: 40}\n  - {slot: radiation, law: stefan_boltzmann}\n  - {slot: heat_generation, law: volumetric}\n"
            "materials: [{name: m, density_kg_m3: 2000, youngs_modulus_pa: 1.0e6, poissons_ratio: 0.3, conductivity_w_mk: 20, specific_heat_j_kgk: 0.5,"
            " emissivity: 0.5, heat_generation_w_m3: 1.0e6}]\n"
            "interactions: [{between: default, normal_damping_ratio: 0.1, friction_static: 0.3}]\n"
            "output: {observables: [heat_walls, heat_sources]}\n"
            "walls: [{name: box, shape: box, low_m: [-1.1e-3, -1.2e-3, -1.2e-3], high_m: [7.1e-3, 1.2e-3, 1.2e-3], temperature_k: 500}]\n"
            "stages:\n  - {name: go, until: {steps: 1}, heat: {every_steps: %d}}\n  - {name: on, until: {steps: 1}}\n"
            "particles:\n  - {name: p, material: m, temperature_k: 300, generator: lattice, counts: [4, 1, 1], spacing_m: 2.0e-3, radius_m: 9.9e-4, velocity_m_s: [0.3, 0.1, 0.05]}\n", every);
    return case_open(&t);
}

static double lively_end(int every, double *balance)
{
    physics_case c = lively(every);
    double before = case_heat(&c).content;
    case_run(&c, 4003, 2e-6); /* no multiple: some heat waits */
    heat_sums sums = case_heat(&c);
    double worst = fabs(sums.content - before - sums.tally[0] - sums.tally[1] - sums.tally[2] - sums.tally[3] - sums.tally[5]);
    case_stage(&c, 1); /* and comes due with the stage's end */
    sums = case_heat(&c);
    worst = fmax(worst, fabs(sums.content - before - sums.tally[0] - sums.tally[1] - sums.tally[2] - sums.tally[3] - sums.tally[5]));
    *balance = worst / (sums.content - before);
    double mean = sums.mean;
    case_close(&c);
    return mean;
}

/* The balance closes whatever n, and the temperatures go to those of n = 1 in proportion to n. */
static void test_every_steps(void **state)
{
    (void)state;
    double balance[4], mean[4];
    const int every[4] = {1, 5, 10, 20};
    for (int k = 0; k < 4; k++) {
        mean[k] = lively_end(every[k], &balance[k]);
        BETWEEN(balance[k], 0.0, 1e-9 + floats(100));
        assert_true(mean[k] > 305.0);
    }
    assert_true(mean[1] != mean[0]);
    BETWEEN(fabs(mean[1] - mean[0]), 0.0, 1e-3 * (mean[0] - 300.0));
    if (floats(1) == 0.0)
        BETWEEN((mean[3] - mean[0]) / (mean[2] - mean[0]), 1.6, 2.6); /* (20 - 1)/(10 - 1) = 2.1 */
}

/* The step's limit by heat is that of one step of heat, shared by n steps; batches change no bit. */
static void test_every_steps_limit(void **state)
{
    (void)state;
    double limit[2], end[2];
    for (int k = 0; k < 2; k++) {
        physics_case c = lively(k ? 7 : 1);
        limit[k] = case_limit(&c).heat.all;
        case_close(&c);
        c = lively(7);
        c.sim->batch_limit = k ? 3 : 64;
        for (int n = 0; n < 40; n++)
            case_run(&c, k ? 25 : 25, 2e-6);
        simulation_set_step(c.sim, 1.5e-6);
        case_run(&c, 100, 1.5e-6);
        end[k] = temperature_of(&c, 1);
        case_close(&c);
    }
    RELATIVE(limit[1], limit[0], 1e-12);
    assert_true(end[0] == end[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_steps),
        cmocka_unit_test(test_every_steps_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
