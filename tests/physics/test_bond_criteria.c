/* When contacts bond, by each criterion, and what temperature does to a bond: softening, and necks that set. */
#include "bond_case.h"

static void test_scalar_and_time(void **state)
{
    (void)state;
    text t = head("{slot: normal, law: hertz}, {slot: bond, law: adhesion, criterion: scalar_above}", 1, NULL);
    put(&t, "interactions: [{between: default, normal_damping_ratio: 0, bond_equilibrium_overlap_m: %.17g, bond_damping_ratio: 1, bond_threshold: 0.5}]\n",
        equilibrium);
    put(&t, "particles:\n");
    const double scalar[3][2] = {{0.4, 0.9}, {0.6, 0.7}, {0.9, 0.4}};
    for (int p = 0; p < 3; p++)
        put(&t, "  - {name: p%d, material: m0, generator: list, scalar: %g, items: [{radius_m: 0.001, position_m: [-0.001, %g, 0], velocity_m_s: [1.5, 0, "
                "0]}, {radius_m: 0.001, position_m: [0.001, %g, 0], velocity_m_s: [-1.5, 0, 0], scalar: %g}]}\n",
            p, scalar[p][0], LANE * p, LANE * p, scalar[p][1]);
    physics_case c = case_open(&t);
    case_run(&c, 1000, 2e-7);
    assert_true(overlap_of(&c, 0) < 0.0);
    assert_true(overlap_of(&c, 1) > 0.0);
    assert_true(overlap_of(&c, 2) < 0.0);
    assert_int_equal(bonds_of(&c).made, 1);
    case_close(&c);

    t = head("{slot: normal, law: hertz}, {slot: bond, law: adhesion, criterion: at_time, time_s: 2.0e-6}", 1, NULL);
    put(&t, "interactions: [{between: default, normal_damping_ratio: 0, bond_equilibrium_overlap_m: %.17g, bond_damping_ratio: 1}]\nparticles:\n",
        equilibrium);
    put_pair(&t, 0, 0, 0.8 * equilibrium, 0.0); /* flies apart before: deeper than critical for some microseconds */
    put_pair(&t, 0, 1, -3e-4, 3.0);             /* comes together after */
    c = case_open(&t);
    case_run(&c, 9, 2e-7);
    assert_int_equal(bonds_of(&c).made, 0);
    bool deep = overlap_of(&c, 0) > 4.0 / 9.0 * equilibrium;
    case_run(&c, 2, 2e-7);
    assert_int_equal(bonds_of(&c).made, deep ? 1 : 0);
    case_run(&c, 2000, 2e-7);
    assert_int_equal(bonds_of(&c).made, deep ? 1 : 0);
    assert_true(overlap_of(&c, 1) < 0.0);
    case_close(&c);
    assert_true(deep);
}

/* Temperatures 900 K and 1100 K, and a threshold between, on either side of the mean. */
static void test_temperatures(void **state)
{
    (void)state;
    const struct {
        const char *criterion;
        double threshold;
        int bonds;
    } row[] = {{"both_above", 890, 1}, {"both_above", 910, 0}, {"mean_above", 990, 1}, {"mean_above", 1010, 0}, {"hottest_above", 1090, 1},
               {"hottest_above", 1110, 0}};
    for (int n = 0; n < COUNT_OF(row); n++) {
        char effects[256];
        snprintf(effects, sizeof effects, "{slot: normal, law: hertz}, {slot: bond, law: adhesion, criterion: %s}", row[n].criterion);
        text t = {0};
        put(&t, "effects: [%s]\nmaterials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: %g, poissons_ratio: 0, specific_heat_j_kgk: 100}]\n", effects,
            density, young);
        put(&t, "interactions: [{between: default, bond_equilibrium_overlap_m: %.17g, bond_damping_ratio: 1, bond_threshold: %g}]\n", equilibrium,
            row[n].threshold);
        put(&t, "particles: [{name: p, material: m, generator: list, items: [{radius_m: 0.001, position_m: [0, 0, 0], temperature_k: 900}, {radius_m: "
                "0.001, position_m: [0.00196, 0, 0], temperature_k: 1100}]}]\n");
        physics_case c = case_open(&t);
        case_run(&c, 1000, 2e-7);
        assert_int_equal(bonds_of(&c).alive, row[n].bonds);
        case_close(&c);
    }
}

/* Two grains at a temperature at which moduli are at exp(-0.5): the equilibrium stays, or with a constant adhesion grows as (E0/E)^2. */
static void test_softened(void **state)
{
    (void)state;
    for (int constant = 0; constant < 2; constant++) {
        double at_rest = constant ? equilibrium * exp(1.0) : equilibrium;
        text t = {0};
        put(&t, "effects: [{slot: normal, law: hertz}, {slot: modulus, law: exponential_softening}, {slot: bond, law: adhesion, adhesion_follows_modulus: %s}]\n",
            constant ? "false" : "true");
        put(&t, "materials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: %g, poissons_ratio: 0, specific_heat_j_kgk: 100, "
                "softening_temperature_k: 500, softening_rate: 0.5}]\n", density, young);
        put(&t, "interactions: [{between: default, bond_equilibrium_overlap_m: %.17g, bond_damping_ratio: 0.7}]\n", equilibrium);
        put(&t, "particles: [{name: p, material: m, generator: list, temperature_k: 1000, items: [{radius_m: 0.001, position_m: [0, 0, 0]}, {radius_m: "
                "0.001, position_m: [%.17g, 0, 0]}]}]\n", 2.0 * radius - 0.9 * at_rest);
        physics_case c = case_open(&t);
        case_run(&c, 6000, 2e-7);
        RELATIVE(overlap_of(&c, 0), at_rest, 1e-5);
        case_close(&c);
    }
}

/* ---- necks that set ---- */

/* BM Eq. 8, 13 and 14 for Hertz and an exponent of 1, per adhesion k: of a solid neck, which resists from d_crit on with the stiffness at rest. */
#define D_CRITICAL (4.0 / 9.0 * equilibrium)

static double pull_off(double k)
{
    return 4.0 / 27.0 * k * equilibrium;
}

static double resistance(double k)
{
    return 0.5 * k;
}

/* A grain hangs on a held one under a load of `share` pull-off forces, bonded at rest in the first step. `more`: of the interaction. */
static physics_case hung_neck(const char *bond, double share, double xi, const char *more)
{
    text t = {0};
    put(&t, "gravity_m_s2: [%.17g, 0, 0]\neffects: [{slot: normal, law: hertz}, {slot: bond, law: adhesion, clamps: none, while_met: liquid, %s}]\n",
        share * pull_off(bm_adhesion) / sphere_mass(density, radius), bond);
    put(&t, "materials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: %g, poissons_ratio: 0, specific_heat_j_kgk: 100}]\n", density, young);
    put(&t, "interactions: [{between: default, bond_equilibrium_overlap_m: %.17g, bond_damping_ratio: %g%s}]\ncontact_table: {skin_m: 2.0e-6}\nparticles:\n",
        equilibrium, xi, more);
    static const char kelvin[] = "{time_s: [0, 4.0e-6, 5.0e-6, 1.0e-3, 1.1e-3], value: [1100, 1100, 900, 900, 1100]}";
    bool warm = strstr(bond, "above");
    for (int n = 0; n < 2; n++)
        put(&t, "  - {name: p%d, material: m, generator: list%s%s%s, items: [{radius_m: %g, position_m: [%.17g, 0, 0]}]}\n", n,
            n == 0 ? ", motion: fixed" : "", warm ? ", thermal: prescribed, temperature_k: " : "", warm ? kelvin : "", radius,
            n * (2.0 * radius - equilibrium));
    return case_open(&t);
}

/* Four times the load that a liquid neck bears draws a solid one over a gap, over many tables; none loses it. */
static void test_solid_neck_resists(void **state)
{
    (void)state;
    double apart = 3.0 * pull_off(bm_adhesion) / resistance(bm_adhesion) - D_CRITICAL;
    assert_true(apart > 10.0 * 2.0e-6);
    physics_case c = hung_neck("criterion: at_time", 4.0, 0.7, "");
    case_run(&c, 6000, 2e-7);
    RELATIVE(-overlap_of(&c, 0), apart, within(1e-6, LAW * 4.0)); /* the load against what a force is known by */
    assert_int_equal(bonds_of(&c).alive, 1);
    assert_true(c.sim->rebuilds > 5);
    double stiffness = resistance(bm_adhesion), mass = sphere_mass(density, radius), a = 2.0 * stiffness / mass;
    double b = 2.0 * 1.4 * sqrt(mass * stiffness) / mass * (case_verlet() ? 2.0 : 1.0);
    RELATIVE(case_limit(&c).live_s, (sqrt(b * b + 4.0 * a) - b) / a, 1e-5);
    case_close(&c);
    c = hung_neck("criterion: always", 1.02, 0.7, ""); /* liquid at all times: it ends at the critical overlap */
    case_run(&c, 6000, 2e-7);
    assert_int_equal(bonds_of(&c).alive, 0);
    case_close(&c);
}

/* It breaks where the load over the area of the neck at rest, pi r* d_eq, passes the strength. */
static void test_solid_neck_breaks(void **state)
{
    (void)state;
    const double share[] = {0.98, 1.02};
    for (int n = 0; n < 2; n++) {
        char more[64];
        snprintf(more, sizeof more, ", bond_tensile_strength_pa: %.17g", share[n] * 4.0 * pull_off(bm_adhesion) / (PI * R_PAIR * equilibrium));
        physics_case c = hung_neck("criterion: at_time", 4.0, 3.0, more);
        case_run(&c, 40000, 5e-8);
        assert_int_equal(bonds_of(&c).alive, n);
        assert_int_equal(bonds_of(&c).made, 1);
        case_close(&c);
    }
}

/* Liquid for 4 us, solid below 1000 K, where it bears one and a half times the load; molten again after a millisecond, and gone. */
static void test_neck_sets_and_melts(void **state)
{
    (void)state;
    double d = D_CRITICAL - 0.5 * pull_off(bm_adhesion) / resistance(bm_adhesion);
    physics_case c = hung_neck("criterion: both_above, ", 1.5, 0.7, ", bond_threshold: 1000");
    case_run(&c, 5000, 2e-7);
    RELATIVE(overlap_of(&c, 0), d, within(1e-5, LAW * 8.0));
    assert_int_equal(bonds_of(&c).alive, 1);
    case_run(&c, 500, 2e-7);
    assert_int_equal(bonds_of(&c).alive, 0);
    assert_int_equal(bonds_of(&c).broken, 1);
    case_close(&c);
}

/* Energy of spring and adhesion above the critical overlap, of the line below. */
static double neck_energy(double k2, double k, double d)
{
    double to = fmax(d, D_CRITICAL), drawn = to - d;
    return k2 * pow(to, 2.5) / 2.5 - 0.5 * k * to * to + drawn * (pull_off(k) + 0.5 * resistance(k) * drawn);
}

/* A grain thrown off a wall without damping: energy stays, and the neck holds up to a gap of one radius. */
static void test_solid_neck_at_a_wall(void **state)
{
    (void)state;
    double k2 = 4.0 / 3.0 * young * sqrt(radius), k = k2 * sqrt(equilibrium), mass = sphere_mass(density, radius);
    for (int n = 0; n < 2; n++) {
        double reached = n == 0 ? 0.9 * radius : 1.1 * radius, given = neck_energy(k2, k, -reached) - neck_energy(k2, k, equilibrium);
        text t = head("{slot: normal, law: hertz}, {slot: bond, law: adhesion, criterion: at_time, while_met: liquid}", 1, NULL);
        put(&t, "interactions: [{between: default, bond_equilibrium_overlap_m: %.17g, bond_damping_ratio: 0}]\n", equilibrium);
        put(&t, "walls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}]\n");
        put(&t, "particles: [{name: p, material: m0, generator: list, items: [{radius_m: %g, position_m: [0, 0, %.17g], velocity_m_s: [0, 0, %.17g]}]}]\n",
            radius, radius - equilibrium, sqrt(2.0 * given / mass));
        physics_case c = case_open(&t);
        double omega = sqrt(resistance(k) / mass), dt = 1e-3 / omega;
        case_run(&c, 1, dt);
        double before = case_sums(&c).kinetic + case_contact_sums(&c).elastic;
        for (int part = 0; part < 15 && n == 0; part++) {
            case_run(&c, 100, dt);
            /* symplectic: of order dt; in mixed precision the increments of a step are known to a float */
            NEAR(case_sums(&c).kinetic + case_contact_sums(&c).elastic, before, 2e-3 * given);
        }
        case_run(&c, n == 0 ? 71 : 1571, dt); /* a quarter of a swing */
        assert_int_equal(bonds_of(&c).alive, n == 0);
        if (n == 0)
            RELATIVE(case_get(&c, "position", 0, 2) - radius, reached, 1e-2);
        case_close(&c);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scalar_and_time),    cmocka_unit_test(test_temperatures),      cmocka_unit_test(test_softened),
        cmocka_unit_test(test_solid_neck_resists), cmocka_unit_test(test_solid_neck_breaks), cmocka_unit_test(test_neck_sets_and_melts),
        cmocka_unit_test(test_solid_neck_at_a_wall),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
