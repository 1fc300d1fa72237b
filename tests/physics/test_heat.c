/* Heat of single grains: convection, radiation, generation, prescribed temperatures and flows; and the balance of all of it. */
#include "heat_case.h"

#define STEEL "  - {name: a, density_kg_m3: 7800, conductivity_w_mk: 60, specific_heat_j_kgk: 600, emissivity: 1, heat_generation_w_m3: 1.0e6}\n" \
              "  - {name: b, density_kg_m3: 3000, conductivity_w_mk: 20, specific_heat_j_kgk: 100, emissivity: 0.3, heat_generation_w_m3: 0}\n"
#define R 0.5e-3
#define NEWTON "  - {slot: convection, law: newton, coefficient_w_m2k: 50}"
#define RADIATION "  - {slot: radiation, law: stefan_boltzmann}"

static double capacity(void)
{
    return sphere_mass(7800, R) * 600.0;
}

static double area(void)
{
    return 4.0 * PI * R * R;
}

/* Temperature of one grain after `time`, extrapolated to a step of zero (the step is of first order). */
static double cooled(const char *effects, const char *environment, double start, double time, int steps)
{
    double after[2];
    for (int half = 0; half < 2; half++) {
        const hot_grain grain = {"a", R, 0, start};
        physics_case c = row_open(effects, STEEL, environment, &grain, 1);
        case_run(&c, steps << half, time / (steps << half));
        after[half] = temperature_of(&c, 0);
        case_close(&c);
    }
    return 2.0 * after[1] - after[0];
}

static void test_newton(void **state)
{
    (void)state;
    double tau = capacity() / (50.0 * area());
    RELATIVE(cooled(NEWTON, "environment: {temperature_k: 273}\n", 3000, 5.0, 2000), 273.0 + 2727.0 * exp(-5.0 / tau), 1e-6);
}

static void test_still_gas(void **state)
{
    (void)state;
    double tau = capacity() / (0.025 / R * area());
    RELATIVE(cooled("  - {slot: convection, law: still_gas}", "environment: {temperature_k: 273, gas: {conductivity_w_mk: 0.025}}\n", 3000, 5.0, 2000),
             273.0 + 2727.0 * exp(-5.0 / tau), 1e-6);
}

/* TM Eqs. 38-40 with the velocity relative to the gas. */
static void test_nusselt(void **state)
{
    (void)state;
    double k = 0.025, cp = 1000.0, mu = 1.8e-5, rho = 1.2, speed = sqrt(3.0 * 3.0 + 4.0 * 4.0), re = rho * speed * 2.0 * R / mu;
    double h = (2.0 + (0.4 * sqrt(re) + 0.06 * pow(re, 2.0 / 3.0)) * pow(cp * mu / k, 0.4)) * k / (2.0 * R), tau = capacity() / (h * area());
    RELATIVE(cooled("  - {slot: convection, law: nusselt}",
                    "environment: {temperature_k: 273, gas: {conductivity_w_mk: 0.025, specific_heat_j_kgk: 1000, viscosity_pa_s: 1.8e-5, "
                    "density_kg_m3: 1.2, velocity_m_s: [3, 0, -4]}}\n",
                    3000, 1.0, 2000),
             273.0 + 2727.0 * exp(-1.0 / tau), 1e-6);
}

/* Into the cold: T^-3 = T0^-3 + 3 eps B A t/(m C). */
static void test_radiation(void **state)
{
    (void)state;
    double expected = pow(pow(3000.0, -3) + 3.0 * STEFAN * area() * 0.5 / capacity(), -1.0 / 3.0);
    RELATIVE(cooled(RADIATION, "environment: {temperature_k: 1.0e-3}\n", 3000, 0.5, 4000), expected, 1e-6);
}

static void test_both(void **state)
{
    (void)state;
    NEAR(cooled(NEWTON "\n" RADIATION, "environment: {temperature_k: 273}\n", 3000, 0.1, 4000), 2558.91379, 1e-4);
    NEAR(cooled(NEWTON "\n" RADIATION, "environment: {temperature_k: 273}\n", 3000, 1.0, 4000), 1527.93631, 1e-3);
}

static void test_generation(void **state)
{
    (void)state;
    double rise = 10.0 * 1e6 / (7800.0 * 600.0);
    NEAR(cooled("  - {slot: heat_generation, law: volumetric}", "", 300, 10.0, 100), 300.0 + rise, 3e-10 + within(0.0, LAW) * rise);
}

/* From 3000 K and from 4 K, at the largest step that the limit allows, temperatures go to the environment's and not past it. */
static void test_bounds(void **state)
{
    (void)state;
    const hot_grain grains[] = {{"a", R, 0, 3000}, {"a", R, 1, 4}, {"b", 1e-6, 2, 3000}};
    physics_case c = row_open(NEWTON "\n" RADIATION, STEEL, "environment: {temperature_k: 1200}\n", grains, 3);
    step_limit limit = case_limit(&c);
    double m = sphere_mass(3000, 1e-6), rate = 4.0 * PI * 1e-12 * (50.0 + 0.3 * STEFAN * (1200.0 + 3000.0) * (1200.0 * 1200.0 + 3000.0 * 3000.0));
    RELATIVE(limit.limit_s, m * 100.0 / rate, within(1e-9, LAW));
    double before[3] = {3000, 4, 3000}, last = within(0.0, LAW) * 1800.0; /* the first step of all goes all the way */
    for (int k = 0; k < 50; k++) {
        case_run(&c, 1, limit.limit_s);
        for (int i = 0; i < 3; i++) {
            double now = temperature_of(&c, i);
            assert_true(fabs(now - 1200.0) <= last || (fabs(now - 1200.0) <= fabs(before[i] - 1200.0) && (now - 1200.0) * (before[i] - 1200.0) >= 0.0));
            before[i] = now;
        }
    }
    case_close(&c);
}

/* The environment as a table in time: a ramp b t drags a grain behind it; and along an axis. */
static void test_environment(void **state)
{
    (void)state;
    double tau = capacity() / (50.0 * area()), slope = 100.0, after[2];
    for (int half = 0; half < 2; half++) {
        const hot_grain grain = {"a", R, 0, 300};
        physics_case c = row_open(NEWTON, STEEL, "environment: {temperature_k: {time_s: [0, 10], value: [300, 1300]}}\n", &grain, 1);
        case_run(&c, 3000 << half, 3.0 / (3000 << half));
        after[half] = temperature_of(&c, 0);
        case_close(&c);
    }
    RELATIVE(2.0 * after[1] - after[0], 300.0 + slope * (3.0 - tau * (1.0 - exp(-3.0 / tau))), 1e-6);

    const hot_grain grains[] = {{"a", R, -1, 400}, {"a", R, 0.25, 400}, {"a", R, 2, 400}, {"a", R, 9, 400}};
    const double expected[] = {300, 325, 450, 500};
    physics_case c = row_open(NEWTON, STEEL, "environment: {temperature_k: {axis: x, at_m: [0, 1, 3], value: [300, 400, 500]}}\n", grains, 4);
    case_run(&c, 1, 1e-3);
    for (int k = 0; k < 4; k++)
        NEAR(temperature_of(&c, k) - 400.0, 1e-3 / tau * (expected[k] - 400.0), 1e-10 + within(0.0, LAW) * 1e-3 / tau * 100.0);
    case_close(&c);
}

/* Prescribed by a table, and heated by a flow; what the first takes comes from a source. */
static void test_groups(void **state)
{
    (void)state;
    text t = {0};
    put(&t, "effects:\n  - {slot: heat_generation, law: volumetric}\nmaterials:\n%s"
            "output: {observables: [heat_sources]}\nparticles:\n"
            "  - {name: p, material: b, generator: list, thermal: prescribed, temperature_k: {time_s: [0, 1, 2], value: [300, 500, 400]}, items: [{position_m: [0, 0, 0], radius_m: 1.0e-3}]}\n"
            "  - {name: f, material: b, generator: list, thermal: flux, heat_flux_w: 0.01, temperature_k: 300, items: [{position_m: [1, 0, 0], radius_m: 1.0e-3}]}\n"
            "  - {name: g, material: b, generator: list, temperature_k: 350, items: [{position_m: [2, 0, 0], radius_m: 1.0e-3}]}\n",
        STEEL);
    physics_case c = case_open(&t);
    double mc = sphere_mass(3000, 1e-3) * 100.0;
    NEAR(temperature_of(&c, 0), 300.0, 0.0);
    case_run(&c, 150, 1e-2);
    double time = c.sim->time; /* a step may be rounded */
    NEAR(time, 1.5, within(1e-12, 2.0));
    NEAR(temperature_of(&c, 0), 500.0 - 100.0 * (time - 1.0), 1e-9);
    NEAR(temperature_of(&c, 1), 300.0 + 0.01 * time / mc, 3e-10 + within(0.0, LAW) * 0.01 * time / mc);
    NEAR(temperature_of(&c, 2), 350.0, 0.0);
    RELATIVE(case_heat(&c).tally[CLAST_TALLY_SOURCES], 0.01 * time + 100.0 * (3.0 - time) * mc, within(1e-10, LAW));
    case_close(&c);
}

/* A wall's flow is shared by area of contact, all of it; none flows where nothing touches. */
static void test_wall_flux(void **state)
{
    (void)state;
    text t = {0};
    const double radius[] = {1e-3, 2e-3, 1.5e-3}, depth[] = {1e-5, 4e-5, 2e-5};
    put(&t, "effects:\n  - {slot: conduction, law: overlap_area}\nmaterials:\n%s"
            "output: {observables: [heat_walls]}\n"
            "walls:\n  - {name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1], heat_flux_w: 0.5}\n"
            "  - {name: lid, shape: plane, point_m: [0, 0, 1], normal: [0, 0, -1], heat_flux_w: 7}\nparticles:\n",
        STEEL);
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        put(&t, "  - {name: g%d, material: a, generator: list, temperature_k: 300, items: [{position_m: [%g, 0, %.17g], radius_m: %.17g}]}\n", k, 0.1 * k,
            radius[k] - depth[k], radius[k]);
        sum += depth[k] * (2.0 * radius[k] - depth[k]);
    }
    physics_case c = case_open(&t);
    for (int k = 0; k < 3; k++)
        RELATIVE(flow_of(&c, k, -1), 0.5 * depth[k] * (2.0 * radius[k] - depth[k]) / sum, within(1e-8, LAW));
    double before = case_heat(&c).content;
    case_run(&c, 100, 1e-3);
    RELATIVE(case_heat(&c).content - before, 0.05, within(1e-10, LAW));
    RELATIVE(case_heat(&c).tally[CLAST_TALLY_WALLS], 0.05, within(1e-10, LAW));
    case_close(&c);
}

/* ---- the whole ---- */

#define EVERYTHING                                                                                              \
    "  - {slot: normal, law: hertz}\n  - {slot: conduction, law: overlap_area}\n" NEWTON "\n" RADIATION "\n"     \
    "  - {slot: heat_generation, law: volumetric}\n  - {slot: modulus, law: exponential_softening}\n"                \
    "  - {slot: radius, law: linear_expansion}\n  - {slot: dissipation_heat, law: fraction}\n"                      \
    "  - {slot: source, law: laser, name: spot, profile: gaussian, diameter_m: 4.0e-3, direction: [0, 0, -1], attenuation_1_m: 800, "  \
    "path: {time_s: [0, 0.02], position_m: [[-2.0e-3, 0, 0], [2.0e-3, 0, 0]], power_w: [20, 40]}}\n"

static physics_case everything_open(int batch)
{
    text t = {0};
    put(&t, "gravity_m_s2: [0, 0, -9.81]\neffects:\n" EVERYTHING "contact_table: {batch_steps: %d}\nmaterials:\n", batch);
    put(&t, "  - {name: a, density_kg_m3: 7800, conductivity_w_mk: 60, specific_heat_j_kgk: 600, emissivity: 1, heat_generation_w_m3: 1.0e7, youngs_modulus_pa: 1.0e6, poissons_ratio: 0.3, absorptance: 0.5, softening_temperature_k: 350, expansion_1_k: 2.0e-5}\n"
            "  - {name: b, density_kg_m3: 3000, conductivity_w_mk: 20, specific_heat_j_kgk: 100, emissivity: 0.3, heat_generation_w_m3: 0, youngs_modulus_pa: 1.0e6, poissons_ratio: 0.3, absorptance: 0.5, softening_temperature_k: 350, expansion_1_k: 0}\n"
            "interactions: [{between: default, restitution: 0.3}]\n"
            "environment: {temperature_k: {time_s: [0, 0.01, 0.03], value: [300, 900, 600]}}\n"
            "walls:\n  - {name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1], temperature_k: {time_s: [0, 0.02], value: [700, 1000]}}\n"
            "  - {name: side, shape: plane, point_m: [-4.0e-3, 0, 0], normal: [1, 0, 0], heat_flux_w: 0.3}\n"
            "  - {name: other, shape: plane, point_m: [0.02, 0, 0], normal: [-1, 0, 0]}\n"
            "output: {observables: [heat_sources, heat_walls, heat_convection, heat_radiation, heat_dissipation]}\nparticles:\n"
            "  - {name: a, material: a, generator: random, count: 60, temperature_k: 400, radius_m: {distribution: uniform, low: 8.0e-4, high: 1.2e-3},\n"
            "     region: {low_m: [-4.0e-3, -4.0e-3, 0], high_m: [4.0e-3, 4.0e-3, 1.2e-2]}}\n"
            "  - {name: b, material: b, generator: list, temperature_k: 1500, thermal: flux, heat_flux_w: 0.02, items: [{position_m: [0, 0, 0.02], radius_m: 1.0e-3}]}\n"
            "  - {name: held, material: b, generator: list, temperature_k: 600, thermal: prescribed, items: [{position_m: [1.0e-2, 0, 1.0e-3], radius_m: 1.0e-3}]}\n");
    return case_open(&t);
}

/* Stored = what came in by each path, to rounding, with everything on in a bed that falls and collides. In double a rounding of either sign of every
 * grain's temperature in every step, and of the sum with every grain: eight times what these come to on average. */
static void test_balance(void **state)
{
    (void)state;
    const double steps = 3000.0, grains = 62.0;
    physics_case c = everything_open(64);
    heat_sums before = case_heat(&c);
    case_run(&c, (int64_t)steps, 1e-5);
    heat_sums after = case_heat(&c);
    double in = 0.0, most = 0.0;
    for (int q = 0; q < CLAST_TALLIES; q++) {
        in += q == CLAST_TALLY_ABSORBED ? 0.0 : after.tally[q] - before.tally[q]; /* what beams bring is among the sources' */
        most = fmax(most, fabs(after.tally[q]));
        assert_true(after.tally[q] != 0.0);
    }
    double roundings = 8.0 * 0x1p-53 * after.content * (sqrt(steps / grains) + sqrt(grains));
    NEAR(after.content - before.content, in, within(roundings / most, LAW) * most);
    assert_true(case_contact_sums(&c).contacts > 20);
    case_close(&c);
}

/* The bits do not depend on the batches, nor on when tables are built. */
static void test_batches(void **state)
{
    (void)state;
    double *t[2];
    for (int k = 0; k < 2; k++) {
        physics_case c = everything_open(k ? 64 : 7);
        for (int part = 0; part < 10; part++) {
            case_run(&c, 100, 1e-5);
            if (k)
                MUST(table_build(c.sim, false, why));
        }
        t[k] = case_field(&c, "temperature");
        case_close(&c);
    }
    assert_memory_equal(t[0], t[1], 62 * sizeof **t);
    free(t[0]);
    free(t[1]);
}

/* A state that is saved and taken up again goes on to the same bits. */
static void test_restart(void **state)
{
    (void)state;
    physics_case c = everything_open(64), d = everything_open(64);
    bundle state_of;
    case_run(&c, 700, 1e-5);
    bundle_init(&state_of);
    MUST(state_save(c.sim, &state_of, why));
    MUST(state_load(d.sim, &state_of, "memory", why));
    bundle_free(&state_of);
    case_run(&c, 500, 1e-5);
    case_run(&d, 500, 1e-5);
    const char *const names[] = {"temperature", "heat_tally", "position"};
    for (size_t n = 0; n < 3; n++) {
        double *a = case_field(&c, names[n]), *b = case_field(&d, names[n]);
        assert_memory_equal(a, b, 62 * sizeof *a * (size_t)store_find(c.sim, names[n])->field->components);
        free(a);
        free(b);
    }
    case_close(&c);
    case_close(&d);
}

/* A stage may change what a wall does, and switch a law off. */
static void test_stages(void **state)
{
    (void)state;
    text t = {0};
    put(&t, "effects:\n  - {slot: conduction, law: overlap_area}\n" NEWTON "\nmaterials:\n%s"
            "environment: {temperature_k: 300}\n"
            "walls:\n  - {name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}\n"
            "particles: [{name: g, material: a, generator: list, temperature_k: 300, items: [{position_m: [0, 0, 0.99e-3], radius_m: 1.0e-3}]}]\n"
            "stages:\n  - {until: {steps: 1}}\n  - {until: {steps: 1}, change: {walls: [{name: floor, temperature_k: 500}]}, effects_off: [convection]}\n"
            "  - {until: {steps: 1}, change: {walls: [{name: floor, heat: adiabatic}]}}\n",
        STEEL);
    physics_case c = case_open(&t);
    case_run(&c, 10, 1e-4);
    NEAR(temperature_of(&c, 0), 300.0, 0.0);
    case_stage(&c, 1);
    double h = overlap_conductance(1e-3, 1e-3, 2e-5, 60, 60), mc = sphere_mass(7800, 1e-3) * 600.0;
    case_run(&c, 10, 1e-4);
    RELATIVE(500.0 - temperature_of(&c, 0), 200.0 * pow(1.0 - 1e-4 * h / mc, 10), within(1e-10, LAW));
    double warm = temperature_of(&c, 0), k = 1e-4 * 50.0 * 4.0 * PI * 1e-6 / mc;
    case_stage(&c, 2);
    case_run(&c, 10, 1e-4);
    RELATIVE(temperature_of(&c, 0) - 300.0, (warm - 300.0) * pow(1.0 - k, 10), within(1e-9, LAW));
    case_close(&c);
}

/* A grain without a temperature, where one is needed. */
static void test_no_temperature(void **state)
{
    (void)state;
    scene *s = NULL;
    bed b = {0};
    failure why;
    MUST(scene_read_text("effects: [{slot: heat_generation, law: volumetric}]\n"
                         "materials: [{name: a, density_kg_m3: 1, specific_heat_j_kgk: 1, heat_generation_w_m3: 1}]\n"
                         "particles:\n  - {name: cold, material: a, generator: list, items: [{position_m: [0, 0, 0], radius_m: 1}]}\n"
                         "stages: [{until: {steps: 1}}]\n",
                         "case.yaml", 0, NULL, &s, why));
    assert_int_equal(bed_generate(s, &b, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.text, "case.yaml:4:5: particles[cold]: particle 0 has no temperature; add `temperature_k` to the group");
    bed_free(&b);
    scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_newton),     cmocka_unit_test(test_still_gas),   cmocka_unit_test(test_nusselt), cmocka_unit_test(test_radiation),
        cmocka_unit_test(test_both),       cmocka_unit_test(test_generation),  cmocka_unit_test(test_bounds),  cmocka_unit_test(test_environment),
        cmocka_unit_test(test_groups),     cmocka_unit_test(test_wall_flux),   cmocka_unit_test(test_balance), cmocka_unit_test(test_batches),
        cmocka_unit_test(test_restart),    cmocka_unit_test(test_stages),      cmocka_unit_test(test_no_temperature),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
