/* Necks that grow: the closed form a^6 = a_0^6 + 216 D gamma r*^2 t in temperature, size, at a wall and under load; conduction through them; what
 * a checkpoint and rebuilds keep of them. Copper: Omega 1.18e-29 m3, delta D_0 5.12e-15 m3/s, Q 105 kJ/mol, gamma 1.72 J/m2. */
#include "case.h"

#define BOLTZMANN 1.380649e-23
#define GAS       8.31446261815324

static const double radius = 1.0e-7, density = 8960.0, young = 1.1e11, tension = 1.72, atom = 1.18e-29, boundary = 5.12e-15, activation = 1.05e5;
#define DT 4.0e-11

static double mobility(double temperature)
{
    return atom * boundary / (BOLTZMANN * temperature) * exp(-activation / (GAS * temperature));
}

/* d(a^6)/dt of a neck without load */
static double rate(double temperature, double r)
{
    return 216.0 * mobility(temperature) * tension * r * r;
}

static text head(const char *effects, const char *more)
{
    text t = {0};
    put(&t, "effects: [{slot: normal, law: hertz}, {slot: bond, law: sintering}%s]\n", effects);
    put(&t, "materials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: %g, poissons_ratio: 0.34, specific_heat_j_kgk: 385, conductivity_w_mk: 1.0e-6}]\n",
        density, young);
    put(&t, "interactions: [{between: default, normal_damping_ratio: 0.3, bond_damping_ratio: 1, bond_youngs_modulus_pa: %g, surface_energy_j_m2: %g, boundary_diffusion_m3_s: %g, "
            "atomic_volume_m3: %g, activation_energy_j_mol: %g%s}]\n",
        young, tension, boundary, atom, activation, more);
    return t;
}

/* Two grains that touch, in the lane y. */
static void put_pair(text *t, int lane, const double r[2], const double temperature[2])
{
    put(t, "  - {name: p%d, material: m, generator: list, items: [{radius_m: %.17g, position_m: [%.17g, %.17g, 1.0e-6], temperature_k: %.17g}, "
           "{radius_m: %.17g, position_m: [%.17g, %.17g, 1.0e-6], temperature_k: %.17g}]}\n",
        lane, r[0], -r[0], 1.0e-6 * lane, temperature[0], r[1], r[1], 1.0e-6 * lane, temperature[1]);
}

/* Sixth power of the radius of the neck of contact n, in the order of ids. */
static double sixth(physics_case *c, int n)
{
    int64_t count;
    live_contact *live = case_contacts(c, &count);
    assert_true(n < count);
    assert_true(live[n].bonded);
    double a = sqrt(live[n].area / PI);
    free(live);
    return pow(a, 6);
}

static void check_closed_form(const char *precision, double tolerance)
{
    const double pairs[4][4] = {{radius, radius, 1300, 1300}, {radius, 1.5 * radius, 1300, 1300}, {radius, radius, 1250, 1350}, {radius, radius, 1200, 1200}};
    text t = head("", "");
    put(&t, "precision: %s\nwalls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}]\nparticles:\n", precision);
    for (int p = 0; p < 4; p++)
        put_pair(&t, p, pairs[p], pairs[p] + 2);
    put(&t, "  - {name: low, material: m, generator: list, items: [{radius_m: %.17g, position_m: [1.0e-6, 0, %.17g], temperature_k: 1300}]}\n", radius, radius);
    physics_case c = case_open(&t);
    case_run(&c, 5000, DT);
    double before[5], span = 15000 * DT;
    for (int n = 0; n < 5; n++)
        before[n] = sixth(&c, n);
    case_run(&c, 15000, DT);
    for (int n = 0; n < 5; n++) {
        double effective = n == 4 ? radius : pairs[n][0] * pairs[n][1] / (pairs[n][0] + pairs[n][1]);
        double temperature = n == 4 ? 1300.0 : 0.5 * (pairs[n][2] + pairs[n][3]);
        RELATIVE(sixth(&c, n) - before[n], rate(temperature, effective) * span, tolerance);
        /* from touch on: the start takes the time in which inertia lets the pull of the surface begin to move the grains */
        RELATIVE(sixth(&c, n), rate(temperature, effective) * 20000 * DT, 1e-3);
    }
    /* Coble: the centres have come together by a^2/(4 r*), but for the damped motion that they follow with */
    double h = pow(sixth(&c, 0), 1.0 / 3.0) / (2.0 * radius);
    RELATIVE(2.0 * radius - (case_get(&c, "position", 1, 0) - case_get(&c, "position", 0, 0)), h, 5e-3);
    case_close(&c);
}

static void test_closed_form(void **state)
{
    (void)state;
    check_closed_form("double", 1e-4);
}

static void test_mixed(void **state)
{
    (void)state;
    check_closed_form("mixed", 3e-4);
    /* Steps so small that g, a float, would take a quarter more or less: 7.5e-11 each, on 7.3e-4. */
    text t = head("", ", neck_radius_ratio_least: 0.3");
    put(&t, "precision: mixed\nparticles:\n");
    put_pair(&t, 0, (double[]){radius, radius}, (double[]){1300, 1300});
    physics_case c = case_open(&t);
    case_run(&c, 500, DT);
    case_run(&c, 1, 0.01 * DT); /* under velocity Verlet histories advance by the step before */
    double before = sixth(&c, 0);
    case_run(&c, 40000, 0.01 * DT);
    RELATIVE(sixth(&c, 0) - before, rate(1300.0, 0.5 * radius) * 400 * DT, 1e-3);
    case_close(&c);
}

/* A push of as much as the pull of the surface, F = 9/4 pi gamma r*: twice as fast. A pull of half of it: half. */
static void test_load(void **state)
{
    (void)state;
    double force = 2.25 * PI * tension * 0.5 * radius, g = force / sphere_mass(density, radius);
    const double share[] = {-1.0, 0.5};
    for (int n = 0; n < 2; n++) {
        text t = head("", "");
        put(&t, "gravity_m_s2: [%.17g, 0, 0]\nparticles:\n", share[n] * g);
        put(&t, "  - {name: held, material: m, generator: list, motion: fixed, temperature_k: 1300, items: [{radius_m: %g, position_m: [0, 0, 0]}]}\n", radius);
        put(&t, "  - {name: free, material: m, generator: list, temperature_k: 1300, items: [{radius_m: %g, position_m: [%.17g, 0, 0]}]}\n", radius,
            2.0 * radius * (1.0 - 0.01));
        physics_case c = case_open(&t);
        case_run(&c, 5000, DT);
        double before = sixth(&c, 0);
        case_run(&c, 10000, DT);
        RELATIVE(sixth(&c, 0) - before, (1.0 - share[n]) * rate(1300.0, 0.5 * radius) * 10000 * DT, 1e-3);
        case_close(&c);
    }
}

/* Cold grains do not sinter: at 300 K the diffusion is exp(-32.4) of that at 1300 K. Hot ones stop at the largest neck. */
static void test_ends(void **state)
{
    (void)state;
    text t = head("", ", neck_radius_ratio_least: 0.1, neck_radius_ratio_most: 0.2");
    put(&t, "particles:\n");
    put_pair(&t, 0, (double[]){radius, radius}, (double[]){300, 300});
    put_pair(&t, 1, (double[]){radius, radius}, (double[]){1600, 1600});
    physics_case c = case_open(&t);
    case_run(&c, 5000, DT);
    RELATIVE(sixth(&c, 0), pow(0.1 * radius, 6), within(1e-9, LAW));
    assert_true(rate(1600.0, 0.5 * radius) * 5000 * DT > pow(0.2 * radius, 6));
    RELATIVE(sixth(&c, 1), pow(0.2 * radius, 6), within(1e-9, LAW));
    case_close(&c);
}

/* A growth that is no number in float, 27/8 D gamma/r*^4 = 1e39 1/s, ends at the largest neck in the first step all the same. */
static void test_faster_than_any_step(void **state)
{
    (void)state;
    const double r = 1.0e-8;
    text t = {0};
    put(&t, "effects: [{slot: normal, law: hertz}, {slot: bond, law: sintering}]\n");
    put(&t, "materials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: 2.0e9, poissons_ratio: 0.34, specific_heat_j_kgk: 385}]\n", density);
    put(&t, "interactions: [{between: default, normal_damping_ratio: 0.3, bond_damping_ratio: 1, bond_youngs_modulus_pa: 6.0e6, surface_energy_j_m2: 1.0e6, "
            "boundary_diffusion_m3_s: 1, atomic_volume_m3: 1.0e-20, activation_energy_j_mol: 20, neck_radius_ratio_least: 0.1, "
            "neck_radius_ratio_most: 0.2}]\nparticles:\n");
    put_pair(&t, 0, (double[]){r, r}, (double[]){700, 700});
    physics_case c = case_open(&t);
    case_run(&c, 10, 1e-12);
    RELATIVE(sixth(&c, 0), pow(0.2 * r, 6), within(1e-9, LAW));
    case_close(&c);
}

/* Heat flows through the neck: k pi a^2/distance, 2 a k, and the pipes of half angle asin(a/r). */
static void test_conduction(void **state)
{
    (void)state;
    static const char *const laws[] = {"overlap_area", "batchelor_obrien", "pipe_network"};
    for (int l = 0; l < 3; l++) {
        char effects[128];
        snprintf(effects, sizeof effects, ", {slot: conduction, law: %s}", laws[l]);
        text t = head(effects, "");
        put(&t, "dimensions: %d\nparticles: [{name: p, material: m, generator: list, items: [{radius_m: %g, position_m: [0, 0, 0], temperature_k: 1200}, "
                "{radius_m: %g, position_m: [%.17g, 0, 0], temperature_k: 1400}]}]\n", l == 2 ? 2 : 3, radius, radius, 2.0 * radius);
        physics_case c = case_open(&t);
        case_run(&c, 3000, DT);
        int64_t count;
        live_contact *live = case_contacts(&c, &count);
        double a = sqrt(live[0].area / PI), d = live[0].overlap, drop = case_get(&c, "temperature", 1, 0) - case_get(&c, "temperature", 0, 0);
        assert_true(a > 2.0 * sqrt(0.5 * radius * d)); /* wider than the contact that the overlap would make */
        double angle = asin(a / radius), pipe = PI * 1e-6 * 2.0 * radius / (1.5 - log(angle) + angle * angle / 36.0 + pow(angle, 4) / 2700.0);
        const double conductance[] = {1e-6 * PI * a * a / (2.0 * radius - d), 2.0 * a * 1e-6, 0.5 * pipe};
        RELATIVE(live[0].heat, conductance[l] * drop, within(1e-9, LAW + 2.0 * 1400.0 / drop));
        free(live);
        case_close(&c);
    }
}

/* A ring of grains of two sizes: the same bits whatever the table does, and across a checkpoint. */
#define RING 12

static void test_bits(void **state)
{
    (void)state;
    double *reference = NULL, neck = 0.0;
    for (int n = 0; n < 4; n++) {
        text t = head(", {slot: conduction, law: batchelor_obrien}", "");
        put(&t, "contact_table: {skin_m: %g}\nparticles:\n  - name: ring\n    material: m\n    generator: list\n    items:\n", n == 1 ? 2e-10 : 2e-8);
        for (int k = 0; k < RING; k++)
            put(&t, "      - {radius_m: %.17g, position_m: [%.17g, %.17g, 0], velocity_m_s: [%g, %g, 0], temperature_k: %g}\n",
                radius * (1.0 - 0.02 * (k % 2)), 1.98 * radius / (2.0 * sin(PI / RING)) * cos(2.0 * PI * k / RING),
                1.98 * radius / (2.0 * sin(PI / RING)) * sin(2.0 * PI * k / RING), 1.0 * (k % 3), 0.5 * (k % 4), 1200.0 + 20.0 * k);
        physics_case c = case_open(&t);
        for (int part = 0; part < 20; part++) {
            case_run(&c, 200, 0.5 * DT); /* damping counts twice under velocity Verlet */
            if (n == 2)
                MUST(table_build(c.sim, false, why));
            if (n == 3 && part == 9)
                case_stop_and_resume(&c);
        }
        double *x = case_field(&c, "position");
        bond_sums sums;
        MUST(bonds_count(c.sim, &sums, why));
        assert_int_equal(sums.alive, RING);
        if (n == 0) {
            reference = x;
            neck = sixth(&c, 5);
        } else {
            assert_memory_equal(x, reference, 8 * 3 * RING);
            assert_true(sixth(&c, 5) == neck);
            free(x);
        }
        case_close(&c);
    }
    free(reference);
}

/* A neck that has grown hangs a grain: it breaks where the weight passes its strength times pi a^2. */
static void test_strength(void **state)
{
    (void)state;
    double area = PI * pow(0.2 * radius, 2), stress = 1.0e7, g = stress * area / sphere_mass(density, radius);
    for (int n = 0; n < 2; n++) {
        char more[128];
        snprintf(more, sizeof more, ", neck_radius_ratio_least: 0.2, bond_tensile_strength_pa: %.17g", stress * (n == 0 ? 1.03 : 0.97));
        text t = head("", more);
        put(&t, "gravity_m_s2: [%.17g, 0, 0]\nparticles:\n", g);
        put(&t, "  - {name: held, material: m, generator: list, motion: fixed, temperature_k: 300, items: [{radius_m: %g, position_m: [0, 0, 0]}]}\n", radius);
        put(&t, "  - {name: free, material: m, generator: list, temperature_k: 300, items: [{radius_m: %g, position_m: [%.17g, 0, 0]}]}\n", radius, 2.0 * radius);
        physics_case c = case_open(&t);
        /* the load comes at once: a spring without damping would feel twice of it */
        case_run(&c, 4000, DT);
        bond_sums sums;
        MUST(bonds_count(c.sim, &sums, why));
        assert_int_equal(sums.alive, n == 0);
        case_close(&c);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_closed_form), cmocka_unit_test(test_mixed), cmocka_unit_test(test_load),     cmocka_unit_test(test_ends),
        cmocka_unit_test(test_faster_than_any_step),
        cmocka_unit_test(test_conduction),  cmocka_unit_test(test_bits),  cmocka_unit_test(test_strength),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
