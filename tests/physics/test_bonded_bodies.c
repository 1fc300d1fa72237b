/* Parallel bonds: a beam against the theory of beams, strengths against their closed forms, bodies that hold together and tumble, and records
 * that no table loses however far a pair is pulled apart. */
#include "cluster.h"

static const double radius = 1.0e-3, density = 2000.0, young = 1.0e8, shear = 4.0e7; /* of the bonds */

static double area(void)
{
    return PI * radius * radius;
}

static double inertia(void)
{
    return 0.25 * PI * pow(radius, 4);
}

/* `criterion`: and further options of the law; `drag`: 1/s; `more`: further interactions. */
static text head(const char *criterion, double drag, double xi, const char *more)
{
    text t = {0};
    put(&t, "effects: [{slot: normal, law: hertz}, {slot: bond, law: parallel, %s}, {slot: body, law: viscous_damping, coefficient: %g}]\n", criterion, drag);
    put(&t, "materials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: 1.0e9, poissons_ratio: 0.2}]\n", density);
    put(&t, "interactions: [{between: default, normal_damping_ratio: 0, bond_youngs_modulus_pa: %g, bond_shear_modulus_pa: %g, bond_damping_ratio: %g%s}]\n",
        young, shear, xi, more);
    return t;
}

static int64_t alive(physics_case *c)
{
    bond_sums sums;
    MUST(bonds_count(c->sim, &sums, why));
    return sums.alive;
}

/* A chain along x, the first grain held, the rest with weight along -z: every joint bends by M L/(E I) and shears by V/(G A/L). The sum over the
 * joints is the theory of beams, q l^4/(8 E I) and the shear of the section, up to 1/n^2. */
#define LINKS 10

static void test_cantilever(void **state)
{
    (void)state;
    double g = 0.02, weight = g * sphere_mass(density, radius), length = 2.0 * radius, expected = 0.0;
    for (int k = 1; k <= LINKS; k++) {
        double moment = 0.0;
        for (int m = k; m <= LINKS; m++)
            moment += weight * (m - k + 0.5) * length;
        expected += moment * length / (young * inertia()) * (LINKS - k + 0.5) * length;
        expected += weight * (LINKS - k + 1) * length / (shear * area());
    }
    double l = LINKS * length, q = weight / length;
    RELATIVE(expected, q * pow(l, 4) / (8.0 * young * inertia()) + q * l * l / (2.0 * shear * area()), 0.15); /* a chain of ten */
    text t = head("criterion: always", 1000.0, 0.5, "");
    put(&t, "gravity_m_s2: [0, 0, %g]\nparticles:\n", -g);
    put(&t, "  - {name: held, material: m, generator: list, motion: fixed, items: [{radius_m: %g, position_m: [0, 0, 0]}]}\n", radius);
    put(&t, "  - name: beam\n    material: m\n    generator: list\n    items:\n");
    for (int k = 1; k <= LINKS; k++)
        put_grain(&t, radius, (double[]){k * length, 0, 0}, (double[]){0, 0, 0}, (double[]){0, 0, 0});
    physics_case c = case_open(&t);
    int finer = case_verlet() ? 2 : 1; /* its limit is lower where damping is strong */
    double unbonded = case_limit(&c).limit_s; /* knows the bonds that the first step makes */
    case_run(&c, 1, 2e-6 / finer);
    assert_int_equal(alive(&c), LINKS);
    RELATIVE(case_limit(&c).limit_s, unbonded, within(1e-6, 1));
    case_run(&c, 20000 * finer, 2e-6 / finer);
    /* the beam creeps to its place; in mixed precision a joint's turn is one float, which rounds half a last place in every step */
    RELATIVE(-case_get(&c, "position", LINKS, 2), expected, within(2e-4, 0.5 * 20000 * finer));
    /* what the joints store is half of what their loads give on the way, though no surfaces overlap */
    double *x = case_field(&c, "position"), work = 0.0;
    for (int k = 1; k <= LINKS; k++)
        work -= 0.5 * weight * x[3 * k + 2];
    free(x);
    RELATIVE(case_contact_sums(&c).elastic, work, within(1e-3, 20000 * finer));
    case_close(&c);
}

/* ---- strengths ---- */

/* One grain held, others bonded to it one by one; returns the bonds that live in the end. */
static int64_t loaded(const double gravity[3], int count, const double (*at)[3], const char *strength, double pascal)
{
    char more[128];
    snprintf(more, sizeof more, ", %s: %.17g", strength, pascal);
    text t = head("criterion: always", 2.0e5, 1.0, more); /* every mode creeps */
    put(&t, "gravity_m_s2: [%.17g, %.17g, %.17g]\nparticles:\n", gravity[0], gravity[1], gravity[2]);
    put(&t, "  - {name: held, material: m, generator: list, motion: fixed, items: [{radius_m: %g, position_m: [0, 0, 0]}]}\n", radius);
    put(&t, "  - name: free\n    material: m\n    generator: list\n    items:\n");
    for (int k = 0; k < count; k++)
        put_grain(&t, radius, at[k], (double[]){0, 0, 0}, (double[]){0, 0, 0});
    physics_case c = case_open(&t);
    case_run(&c, 6000, 5e-7);
    int64_t bonds = alive(&c);
    case_close(&c);
    return bonds;
}

static void check_strength(const double gravity[3], int count, const double (*at)[3], const char *strength, double stress)
{
    assert_int_equal(loaded(gravity, count, at, strength, 1.02 * stress), count);
    assert_int_equal(loaded(gravity, count, at, strength, 0.98 * stress), count - 1);
}

static void test_strengths(void **state)
{
    (void)state;
    double g = 1.0, weight = g * sphere_mass(density, radius), d = 2.0 * radius;
    const double next[2][3] = {{d, 0, 0}, {d, d, 0}};
    check_strength((double[]){g, 0, 0}, 1, next, "bond_tensile_strength_pa", weight / area());
    check_strength((double[]){0, 0, g}, 1, next, "bond_shear_strength_pa", weight / area());
    check_strength((double[]){0, 0, g}, 1, next, "bond_tensile_strength_pa", weight * radius * radius / inertia()); /* bending */
    /* an L: the second grain twists the first bond with its arm d, both shear it */
    double torsion = weight * d * radius / (2.0 * inertia()), across = 2.0 * weight / area();
    check_strength((double[]){0, 0, g}, 2, next, "bond_shear_strength_pa", torsion + across);
    assert_true(torsion > 1.5 * across);
}

/* Torsion alone: a grain spins at w about its bond to a held one and swings on the bond's twist, k = G J/L, with j = 2/5 m r^2. The shear stress
 * k theta b/J is largest where it turns back, at theta = w/omega. */
static void test_strength_in_torsion(void **state)
{
    (void)state;
    double polar = 2.0 * inertia(), k = shear * polar / (2.0 * radius), omega = sqrt(k / (0.4 * sphere_mass(density, radius) * radius * radius));
    const double theta = 0.01, stress = k * theta * radius / polar, share[] = {0.99, 1.01};
    for (int n = 0; n < 2; n++) {
        char more[64];
        snprintf(more, sizeof more, ", bond_shear_strength_pa: %.17g", share[n] * stress);
        text t = head("criterion: always", 0.0, 0.0, more);
        put(&t, "particles:\n  - {name: held, material: m, generator: list, motion: fixed, items: [{radius_m: %g, position_m: [0, 0, 0]}]}\n", radius);
        put(&t, "  - {name: free, material: m, generator: list, items: [{radius_m: %g, position_m: [%.17g, 0, 0], spin_rad_s: [%.17g, 0, 0]}]}\n", radius,
            2.0 * radius, theta * omega);
        physics_case c = case_open(&t);
        case_run(&c, 700, 5e-3 / omega); /* past both turns */
        assert_int_equal(alive(&c), n);
        if (n == 1) /* there and back: cos(3.5) of the spin */
            NEAR(case_get(&c, "spin", 1, 0), cos(3.5) * theta * omega, 1e-2 * theta * omega);
        case_close(&c);
    }
}

/* ---- bonds hold at any distance ---- */

static text soft(double skin, const char *rest)
{
    text t = {0};
    put(&t, "effects: [{slot: normal, law: hertz}, {slot: bond, law: parallel, criterion: at_time}, {slot: body, law: viscous_damping, coefficient: 0}]\n");
    put(&t, "materials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: 1.0e9, poissons_ratio: 0.2}]\n", density);
    put(&t, "interactions: [{between: default, normal_damping_ratio: 0, bond_youngs_modulus_pa: 1.0e4, bond_damping_ratio: 0, bond_gap_ratio: 0.1}]\n");
    put(&t, "contact_table: {skin_m: %g}\n%s", skin, rest);
    return t;
}

#define STRETCHED 20

/* Pairs that swing apart by 0.3 r and more, as u = (v/w) sin(w t), over many tables with a skin of 0.02 r. */
static void test_no_table_loses_a_bond(void **state)
{
    (void)state;
    double mass = 0.5 * sphere_mass(density, radius), gap = 0.05 * radius, stiffness = 1.0e4 * area() / (2.0 * radius + gap), omega = sqrt(stiffness / mass);
    double *reference = NULL;
    for (int n = 0; n < 3; n++) {
        text t = soft(n == 1 ? 2.0e-3 : 2.0e-5, "");
        put(&t, "particles:\n  - name: p\n    material: m\n    generator: list\n    items:\n");
        for (int k = 0; k < STRETCHED; k++)
            for (int side = -1; side < 2; side += 2)
                put_grain(&t, radius, (double[]){side * (radius + 0.5 * gap), 8e-3 * (k % 5), 8e-3 * (k / 5)},
                          (double[]){side * 0.15 * omega * radius * (1.0 + 0.05 * k), 0.01 * k, 0}, (double[]){0, 0, 0});
        physics_case c = case_open(&t);
        int steps = (int)(0.5 * PI / omega / 4e-7);
        case_run(&c, steps, 4e-7);
        if (n == 2) /* stopped and taken up again, where they are furthest apart */
            case_stop_and_resume(&c);
        double *x = case_field(&c, "position");
        for (int k = 0; k < STRETCHED; k++) {
            double apart = x[6 * k + 3] - x[6 * k] - 2.0 * radius - gap;
            RELATIVE(apart, 0.3 * radius * (1.0 + 0.05 * k), 1e-3);
        }
        free(x);
        case_run(&c, steps, 4e-7);
        assert_int_equal(alive(&c), STRETCHED);
        if (n != 1)
            assert_true(c.sim->rebuilds > 5);
        x = case_field(&c, "position");
        if (reference)
            assert_memory_equal(x, reference, 8 * 6 * STRETCHED);
        else
            reference = x;
        if (x != reference)
            free(x);
        case_close(&c);
    }
    free(reference);
}

/* A grain on a wall, thrown off it: held up to a gap of its radius. */
static void test_wall(void **state)
{
    (void)state;
    double mass = sphere_mass(density, radius), omega = sqrt(1.0e4 * area() / radius / mass);
    for (int n = 0; n < 2; n++) {
        double reached = n == 0 ? 0.9 : 1.1;
        text t = soft(2.0e-5, "walls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}]\n");
        put(&t, "particles: [{name: p, material: m, generator: list, items: [{radius_m: %g, position_m: [0, 0, %g], velocity_m_s: [0, 0, %.17g]}]}]\n",
            radius, radius, reached * radius * omega);
        physics_case c = case_open(&t);
        case_run(&c, (int64_t)(0.5 * PI / omega / 4e-7), 4e-7);
        assert_int_equal(alive(&c), n == 0);
        if (n == 0)
            RELATIVE(case_get(&c, "position", 0, 2), 1.9 * radius, 1e-3);
        case_close(&c);
    }
}

/* ---- necks that melt and set ---- */

/* A grain flies off a held one at v, bonded by a neck that is liquid above 1000 K. `kelvin`: temperature in time, of both. */
static physics_case drawn_neck(const char *kelvin, const char *option, double v)
{
    text t = {0};
    put(&t, "effects: [{slot: normal, law: hertz}, {slot: bond, law: parallel, criterion: both_above, while_met: %s}]\n", option);
    put(&t, "materials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: 1.0e9, poissons_ratio: 0.2, specific_heat_j_kgk: 500}]\n", density);
    put(&t, "interactions: [{between: default, normal_damping_ratio: 0, bond_youngs_modulus_pa: 1.0e4, bond_damping_ratio: 0, bond_gap_ratio: 0.1, "
            "bond_threshold: 1000}]\ncontact_table: {skin_m: 2.0e-5}\nparticles:\n");
    put(&t, "  - {name: held, material: m, generator: list, motion: fixed, thermal: prescribed, temperature_k: %s, items: [{radius_m: %g, position_m: [0, 0, "
            "0]}]}\n",
        kelvin, radius);
    put(&t, "  - {name: free, material: m, generator: list, thermal: prescribed, temperature_k: %s, items: [{radius_m: %g, position_m: [%.17g, 0, 0], "
            "velocity_m_s: [%.17g, 0, 0]}]}\n",
        kelvin, radius, 2.05 * radius, v);
    return case_open(&t);
}

static double gap_of(physics_case *c)
{
    return case_get(c, "position", 1, 0) - 2.0 * radius;
}

static void test_neck_melts_and_sets(void **state)
{
    (void)state;
    const double v = 0.01, gap = 0.05 * radius, dt = 1e-6;
    /* Solid from the start: it swings about where it was made. */
    double omega = sqrt(1.0e4 * area() / (2.0 * radius + gap) / sphere_mass(density, radius));
    physics_case c = drawn_neck("1100", "solid", v);
    case_run(&c, lround(0.5 * PI / omega / dt), dt);
    RELATIVE(gap_of(&c) - gap, v / omega, 2e-3);
    case_close(&c);
    /* Liquid for 2 ms, in which the grain flies freely; then it sets, and swings about where it is. */
    c = drawn_neck("{time_s: [0, 4.0e-3, 5.0e-3, 6.0e-3], value: [1100, 900, 900, 1100]}", "liquid", v);
    case_run(&c, 1900, dt);
    RELATIVE(gap_of(&c), gap + 1900 * c.sim->dt * v, 1e-9); /* a float in mixed precision */
    assert_int_equal(alive(&c), 1);
    double set = gap + 2e-3 * v;
    omega = sqrt(1.0e4 * area() / (2.0 * radius + set) / sphere_mass(density, radius));
    case_run(&c, 100 + lround(0.5 * PI / omega / dt), dt);
    NEAR(gap_of(&c), set + v / omega, 2.0 * v * dt);
    /* Molten again after 5.5 ms: it flies on with the velocity of the swing. */
    case_run(&c, 5510 - 2000 - lround(0.5 * PI / omega / dt), dt);
    double before = gap_of(&c), speed = case_get(&c, "velocity", 1, 0);
    NEAR(speed, v * cos(omega * 3.5e-3), 0.02 * v);
    case_run(&c, 100, dt);
    NEAR(gap_of(&c) - before, 100 * dt * speed, 1e-12);
    assert_int_equal(alive(&c), 1);
    case_close(&c);
    /* A liquid neck that is drawn further than one would be made is gone. */
    c = drawn_neck("1100", "liquid", v);
    case_run(&c, 5100, dt);
    assert_int_equal(alive(&c), 0);
    RELATIVE(gap_of(&c), gap + 5100 * c.sim->dt * v, 1e-9);
    bond_sums sums;
    MUST(bonds_count(c.sim, &sums, why));
    assert_int_equal(sums.broken, 1);
    case_close(&c);
}

/* ---- a free body ---- */

static void test_tumbling(void **state)
{
    (void)state;
    cluster grains = {.count = 27};
    for (int n = 0; n < 27; n++) {
        grains.radius[n] = radius * (1.0 - 0.01 * (n % 4));
        const double at[3] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1}, w[3] = {400.0, -300.0, 700.0};
        for (int k = 0; k < 3; k++)
            grains.position[n][k] = 2.0 * radius * at[k];
        for (int k = 0; k < 3; k++) {
            int p = (k + 1) % 3, q = (k + 2) % 3;
            grains.velocity[n][k] = w[p] * grains.position[n][q] - w[q] * grains.position[n][p] + (k == 0 ? 0.3 : 0.1);
            grains.spin[n][k] = w[k];
        }
    }
    text t = {0};
    put(&t, "effects: [{slot: normal, law: hertz}, {slot: tangential, law: mindlin}, {slot: bond, law: parallel, criterion: at_time}]\n");
    put(&t, "materials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: 1.0e9, poissons_ratio: 0.2}]\n", density);
    put(&t, "interactions: [{between: default, normal_damping_ratio: 0.1, friction_static: 0.5, bond_youngs_modulus_pa: 1.0e7, bond_damping_ratio: 0.2, "
            "bond_gap_ratio: 0.1}]\ncontact_table: {skin_m: 1.0e-4}\n");
    put_cluster(&t, &grains);
    physics_case c = case_open(&t);
    double linear = 27.0 * sphere_mass(density, radius), angular = linear * 4e-3 * 3.0;
    case_run(&c, 10, 1e-6);
    assert_int_equal(alive(&c), 54);
    particle_sums before = case_sums(&c);
    for (int part = 0; part < 10; part++) {
        case_run(&c, 10000, 1e-6);
        particle_sums now = case_sums(&c);
        for (int k = 0; k < 3; k++) {
            NEAR(now.momentum[k], before.momentum[k], turning_error(1e-13, 86.0, 1e5) * linear);
            NEAR(now.angular[k], before.angular[k], turning_error(1e-12, 86.0, 1e5) * angular);
        }
    }
    assert_int_equal(alive(&c), 54);
    case_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cantilever), cmocka_unit_test(test_strengths), cmocka_unit_test(test_strength_in_torsion), cmocka_unit_test(test_no_table_loses_a_bond),
        cmocka_unit_test(test_wall),       cmocka_unit_test(test_neck_melts_and_sets), cmocka_unit_test(test_tumbling),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
