/* Adhesion bonds against closed forms, reference solutions (high-order integration of BM's equations, relative error below 1e-8) and
 * conservation. All of BM 5.1: E* 5e8 Pa, r 1 mm, equilibrium overlap 5e-5 m; pairs stand in lanes that do not see each other. */
#include "bond_case.h"
#include "cluster.h"

#include "bond_figures.h"

/* ---- BM 5.1 ---- */

typedef struct published {
    double time, light, critical; /* overlap (um) at xi_bond 0.25 and 1 */
} published;
static const published printed_clamps[] = {{5e-6, 12.53096, 12.53096}, {20e-6, 31.05755, 29.81637}, {30e-6, 50.25345, 42.14510},
                                           {100e-6, 53.11299, 49.84027}, {500e-6, 50.00023, 50.0}};
static const published no_clamps[] = {{5e-6, 12.53096, 12.53096}, {20e-6, 31.05755, 29.81637}, {30e-6, 49.91269, 40.76569},
                                      {100e-6, 52.14098, 49.99488}, {500e-6, 50.00002, 50.0}};

static void check_curve(const char *effects, const published *row, double most_light, double most_critical, double dt, double tolerance)
{
    text t = head(effects, 2, NULL);
    put(&t, "interactions:\n  - {between: default, normal_damping_ratio: 0, bond_stiffness: 0}\n");
    put(&t, "  - {between: [m0, m0], bond_equilibrium_overlap_m: %.17g, bond_damping_ratio: 0.25}\n", equilibrium);
    put(&t, "  - {between: [m1, m1], bond_equilibrium_overlap_m: %.17g, bond_damping_ratio: 1}\nparticles:\n", equilibrium);
    put_pair(&t, 0, 0, 0.0, 2.6);
    put_pair(&t, 1, 1, 0.0, 2.6);
    physics_case c = case_open(&t);
    double deepest[2] = {0.0, 0.0};
    int look = (int)lround(5e-7 / dt);
    for (int n = 0, next = 0; next < 5; n += look) {
        case_run(&c, look, dt);
        for (int p = 0; p < 2; p++)
            deepest[p] = fmax(deepest[p], overlap_of(&c, p));
        while (next < 5 && c.sim->time > row[next].time - 0.5 * dt) {
            RELATIVE(1e6 * overlap_of(&c, 0), row[next].light, tolerance);
            RELATIVE(1e6 * overlap_of(&c, 1), row[next].critical, tolerance);
            next++;
        }
    }
    RELATIVE(1e6 * deepest[0], most_light, tolerance);
    RELATIVE(1e6 * deepest[1], most_critical, tolerance);
    bond_sums sums = bonds_of(&c);
    assert_int_equal(sums.alive, 2);
    assert_int_equal(sums.made, 2);
    assert_int_equal(sums.broken, 0);
    RELATIVE(overlap_of(&c, 1), equilibrium, 1e-6);
    case_close(&c);
}

static void test_curves_at_the_printed_step(void **state)
{
    (void)state;
    check_curve(ADHESION, printed_clamps, 61.809, 53.945, 5e-7, 1e-2);
    check_curve(ADHESION_FREE, no_clamps, 60.492, 50.000, 5e-7, 1e-2);
}

static void test_curves_at_a_small_step(void **state)
{
    (void)state;
    check_curve(ADHESION, printed_clamps, 61.809, 53.945, 5e-9, 5e-4);
    check_curve(ADHESION_FREE, no_clamps, 60.492, 50.000, 5e-9, 5e-4);
}

static void test_figures(void **state)
{
    (void)state;
    double mass = 0.5 * sphere_mass(density, radius), adhesion = 4.0 / 3.0 * MODULUS * sqrt(R_PAIR) * sqrt(equilibrium);
    RELATIVE(adhesion, bm_adhesion, 1e-8);
    RELATIVE(sqrt((2.0 * MODULUS * sqrt(R_PAIR * equilibrium) - adhesion) / mass), 1.12171e5, 1e-5);
    static const double published_velocity[9][2] = {{500, 5.149},  {1000, 3.641}, {2000, 2.574}, {3000, 2.102}, {4000, 1.820},
                                                    {5000, 1.628}, {6000, 1.486}, {7000, 1.376}, {8000, 1.287}};
    for (int n = 0; n < 9; n++) {
        text t = head(ADHESION, 1, &published_velocity[n][0]);
        put(&t, "interactions: [{between: default, normal_damping_ratio: 0, bond_stiffness: %.17g, bond_damping_ratio: 0.25}]\nparticles:\n", adhesion);
        put_pair(&t, 0, 0, 0.0, 1.0);
        put(&t, "stages: [{until: {steps: 1}}]\n");
        scene *s = NULL;
        bed b;
        MUST(scene_read_text(t.at, "case.yaml", 0, NULL, &s, why));
        MUST(bed_generate(s, &b, why));
        int count;
        bond_figures *f = bond_figures_of(s, &b, 0, &count);
        assert_int_equal(count, 1);
        RELATIVE(f->equilibrium, equilibrium, 1e-12);
        RELATIVE(f->critical, 4.0 / 9.0 * equilibrium, 1e-12);
        RELATIVE(f->pull_off, 4.0 / 27.0 * adhesion * equilibrium, 1e-12);
        NEAR(f->velocity, published_velocity[n][1], 6e-4);
        RELATIVE(f->velocity, 2.574435 * sqrt(2000.0 / published_velocity[n][0]), 1e-6);
        BETWEEN(f->breaks_from / f->velocity, 2.8, 3.1);
        free(f);
        bed_free(&b);
        scene_free(s);
        free(t.at);
    }
}

/* ---- equilibrium: any exponent, any way of giving it, any law of repulsion, and a wall ---- */

#define EXPONENTS 5

/* Released at 0.9 of the equilibrium, above the critical overlap, which is at most (1.25/1.5)^4 = 0.48 of it. */
static void check_equilibrium(const char *effects, const char *form, double factor)
{
    static const double exponent[EXPONENTS] = {0.25, 0.5, 0.75, 1.0, 1.25};
    text t = head(effects, EXPONENTS, NULL);
    put(&t, "interactions:\n  - {between: default, normal_damping_ratio: 0, bond_stiffness: 0, repulsion_stiffness: %.17g}\n",
        4.0 / 3.0 * MODULUS * sqrt(R_PAIR));
    for (int m = 0; m < EXPONENTS; m++) {
        double value = factor;
        if (strcmp(form, "bond_stiffness") == 0)
            value = 4.0 / 3.0 * MODULUS * sqrt(R_PAIR) * pow(equilibrium, 1.5 - exponent[m]);
        else if (strcmp(form, "bond_normalised_stiffness_n") == 0) /* BM Eq. 18 */
            value = 4.0 / 3.0 * MODULUS * R_PAIR * R_PAIR * pow(equilibrium / R_PAIR, 1.5 - exponent[m]);
        put(&t, "  - {between: [m%d, m%d], bond_exponent: %g, %s: %.17g, bond_damping_ratio: 0.7}\n", m, m, exponent[m], form, value);
    }
    put(&t, "particles:\n");
    for (int m = 0; m < EXPONENTS; m++)
        put_pair(&t, m, m, 0.9 * equilibrium, 0.0);
    physics_case c = case_open(&t);
    case_run(&c, 3000, 2e-7);
    for (int m = 0; m < EXPONENTS; m++)
        RELATIVE(overlap_of(&c, m), equilibrium, within(1e-6, LAW / (1.5 - exponent[m]))); /* d^1.5 against d^a */
    assert_int_equal(bonds_of(&c).alive, EXPONENTS);
    case_close(&c);
}

static void test_equilibrium(void **state)
{
    (void)state;
    check_equilibrium(ADHESION, "bond_equilibrium_overlap_m", equilibrium);
    check_equilibrium(ADHESION, "bond_equilibrium_strain", equilibrium / R_PAIR);
    check_equilibrium(ADHESION, "bond_stiffness", 0.0);
    check_equilibrium(ADHESION, "bond_normalised_stiffness_n", 0.0);
    check_equilibrium("{slot: normal, law: power}, {slot: bond, law: adhesion}", "bond_equilibrium_overlap_m", equilibrium);
}

static void test_wall_and_weight(void **state)
{
    (void)state;
    /* Hung from a ceiling: k2 d^1.5 - k d = -m g near equilibrium, with k2 of a wall and k from the equilibrium overlap. */
    double g = 1.0e5, weight = g * sphere_mass(density, radius), k2 = 4.0 / 3.0 * young * sqrt(radius), k = k2 * sqrt(equilibrium), d = equilibrium;
    for (int n = 0; n < 50; n++)
        d -= (k2 * pow(d, 1.5) - k * d + weight) / (1.5 * k2 * sqrt(d) - k);
    text t = head(ADHESION, 1, NULL);
    put(&t, "gravity_m_s2: [0, 0, %g]\ninteractions: [{between: default, bond_equilibrium_overlap_m: %.17g, bond_damping_ratio: 0.7}]\n", -g, equilibrium);
    put(&t, "walls: [{name: ceiling, shape: plane, point_m: [0, 0, 0.001], normal: [0, 0, -1]}]\n");
    put(&t, "particles:\n  - {name: one, material: m0, generator: list, items: [{radius_m: 0.001, position_m: [0, 0, %.17g]}]}\n", equilibrium);
    physics_case c = case_open(&t);
    case_run(&c, 6000, 2e-7);
    RELATIVE(case_get(&c, "position", 0, 2), d, 1e-6);
    assert_true(d < 0.99 * equilibrium);
    case_close(&c);
}

/* ---- bonding and breaking ---- */

static double separation_speed(physics_case *c, int pair)
{
    double *v = case_field(c, "velocity");
    double rate = v[6 * pair + 3] - v[6 * pair];
    free(v);
    return rate;
}

/* BM Eq. 21: the kinetic energy is what Hertz's spring takes up to the critical overlap. */
static void test_critical_velocity(void **state)
{
    (void)state;
    double critical = 4.0 / 9.0 * equilibrium, energy = 8.0 / 15.0 * MODULUS * sqrt(R_PAIR) * pow(critical, 2.5);
    double velocity = sqrt(2.0 * energy / (0.5 * sphere_mass(density, radius)));
    RELATIVE(velocity, 2.574435, 1e-6);
    static const double share[] = {0.9, 1.0 - 2e-5, 1.0 + 2e-5, 1.1};
    text t = head(ADHESION, 1, NULL);
    put(&t, "interactions: [{between: default, normal_damping_ratio: 0, bond_equilibrium_overlap_m: %.17g, bond_damping_ratio: 1}]\nparticles:\n",
        equilibrium);
    for (int n = 0; n < 4; n++)
        put_pair(&t, 0, n, 0.0, velocity * share[n]);
    physics_case c = case_open(&t);
    case_run(&c, 14000, 2e-9); /* until those that bounce are apart: the step must not miss the deepest */
    assert_int_equal(bonds_of(&c).made, 2);
    case_run(&c, 12000, 2e-8);
    for (int n = 0; n < 2; n++) /* restitution 1 */
        RELATIVE(separation_speed(&c, n), velocity * share[n], 1e-4);
    for (int n = 2; n < 4; n++)
        RELATIVE(overlap_of(&c, n), equilibrium, 1e-4);
    assert_int_equal(bonds_of(&c).alive, 2);
    case_close(&c);
}

/* Beyond 7.61 m/s (clamps, xi 0.25) the bond does not survive its first swing; the figure of `clast check` says where. */
static void test_breaks_again(void **state)
{
    (void)state;
    text t = head(ADHESION, 1, NULL);
    put(&t, "interactions: [{between: default, normal_damping_ratio: 0, bond_equilibrium_overlap_m: %.17g, bond_damping_ratio: 0.25}]\nparticles:\n",
        equilibrium);
    put_pair(&t, 0, 0, 0.0, 1.0);
    char *copy = strdup(t.at);
    physics_case first = case_open(&t);
    int count;
    bond_figures *f = bond_figures_of(first.scene, &first.bed, 0, &count);
    double border = f->breaks_from;
    free(f);
    case_close(&first);
    put(&t, "%s", copy);
    free(copy);
    put_pair(&t, 0, 1, 0.0, 0.995 * border);
    put_pair(&t, 0, 2, 0.0, 1.005 * border);
    physics_case c = case_open(&t);
    case_run(&c, 20000, 1e-8);
    assert_true(overlap_of(&c, 1) > 0.0);
    assert_true(overlap_of(&c, 2) < 0.0);
    bond_sums sums = bonds_of(&c);
    assert_int_equal(sums.made, 2);
    assert_int_equal(sums.broken, 1);
    case_close(&c);
}

/* A grain hangs on a held one: the bond bears 4/27 k d_eq and no more. */
static void test_pull_off(void **state)
{
    (void)state;
    double mass = sphere_mass(density, radius), pull = 4.0 / 27.0 * bm_adhesion * equilibrium;
    const double share[] = {0.98, 1.02};
    for (int n = 0; n < 2; n++) {
        text t = head(ADHESION_FREE, 1, NULL);
        put(&t, "gravity_m_s2: [%.17g, 0, 0]\n", share[n] * pull / mass);
        put(&t, "interactions: [{between: default, bond_equilibrium_overlap_m: %.17g, bond_damping_ratio: 5}]\nparticles:\n", equilibrium);
        put(&t, "  - {name: held, material: m0, generator: list, motion: fixed, items: [{radius_m: %g, position_m: [0, 0, 0]}]}\n", radius);
        put(&t, "  - {name: hung, material: m0, generator: list, items: [{radius_m: %g, position_m: [%.17g, 0, 0]}]}\n", radius,
            2.0 * radius - equilibrium);
        physics_case c = case_open(&t);
        case_run(&c, 20000, 5e-8);
        assert_int_equal(bonds_of(&c).alive, n == 0);
        case_close(&c);
    }
}

static void test_strengths(void **state)
{
    (void)state;
    /* Tension T on the area pi r* d: the pair hangs with net pull F at overlap d; it breaks where F > T pi r* d. */
    double mass = sphere_mass(density, radius), pull = 0.3, k2 = 4.0 / 3.0 * MODULUS * sqrt(R_PAIR), k = bm_adhesion, d = equilibrium;
    for (int n = 0; n < 50; n++)
        d -= (k2 * pow(d, 1.5) - k * d + pull) / (1.5 * k2 * sqrt(d) - k);
    const double tension = pull / (PI * R_PAIR * d);
    const double share[] = {0.97, 1.03};
    for (int n = 0; n < 2; n++) {
        text t = head(ADHESION_FREE, 1, NULL);
        put(&t, "gravity_m_s2: [%.17g, 0, 0]\n", pull / mass);
        put(&t, "interactions: [{between: default, bond_equilibrium_overlap_m: %.17g, bond_damping_ratio: 5, bond_tensile_strength_pa: %.17g}]\n",
            equilibrium, share[n] * tension);
        put(&t, "particles:\n  - {name: held, material: m0, generator: list, motion: fixed, items: [{radius_m: %g, position_m: [0, 0, 0]}]}\n", radius);
        put(&t, "  - {name: hung, material: m0, generator: list, items: [{radius_m: %g, position_m: [%.17g, 0, 0]}]}\n", radius,
            2.0 * radius - equilibrium);
        physics_case c = case_open(&t);
        case_run(&c, 20000, 5e-8);
        bond_sums sums = bonds_of(&c);
        assert_int_equal(sums.alive, n == 1);
        assert_int_equal(sums.made, 1);
        case_close(&c);
    }
}

/* A grain bonded at rest to a held one spins at w: the point of contact swings with u0 = w arm on the spring of friction, k_t = 8 G* sqrt(r* d_eq)
 * with G* = G/2, whose force reaches u0 sqrt(k_t m_t) with 1/m_t = 1/m + arm^2/j. The bond breaks where that passes S pi r* d_eq. */
static void test_shear_strength(void **state)
{
    (void)state;
    double mass = sphere_mass(density, radius), arm = radius - 0.5 * equilibrium, u0 = 0.05;
    double moving = 1.0 / (1.0 / mass + arm * arm / (0.4 * mass * radius * radius)), k = 8.0 * (0.25 * young) * sqrt(R_PAIR * equilibrium);
    const double stress = u0 * sqrt(k * moving) / (PI * R_PAIR * equilibrium), share[] = {0.98, 1.02};
    for (int n = 0; n < 2; n++) {
        text t = head("{slot: normal, law: hertz}, {slot: tangential, law: mindlin}, {slot: bond, law: adhesion}", 1, NULL);
        put(&t, "interactions: [{between: default, normal_damping_ratio: 0, friction_static: 10, bond_equilibrium_overlap_m: %.17g, bond_damping_ratio: 1, "
                "bond_shear_strength_pa: %.17g}]\nparticles:\n", equilibrium, share[n] * stress);
        for (int g = 0; g < 2; g++)
            put(&t, "  - {name: p%d, material: m0, generator: list%s, items: [{radius_m: %g, position_m: [%.17g, 0, 0], spin_rad_s: [0, 0, %.17g]}]}\n", g,
                g == 0 ? ", motion: fixed" : "", radius, g * (2.0 * radius - equilibrium), g * u0 / arm);
        physics_case c = case_open(&t);
        case_run(&c, 1000, 1e-8);
        assert_int_equal(bonds_of(&c).alive, n);
        assert_int_equal(bonds_of(&c).made, 1);
        case_close(&c);
    }
}

/* ---- energy, momentum, symmetry ---- */

static void test_energy_never_rises(void **state)
{
    (void)state;
    text t = head(ADHESION_FREE, 1, NULL);
    put(&t, "interactions: [{between: default, normal_damping_ratio: 0, bond_equilibrium_overlap_m: %.17g, bond_damping_ratio: 0.3}]\nparticles:\n",
        equilibrium);
    put_pair(&t, 0, 0, 0.5 * equilibrium, 1.0);
    physics_case c = case_open(&t);
    case_run(&c, 1, 1e-9); /* the bond is made */
    double before = case_sums(&c).kinetic + case_contact_sums(&c).elastic, scale = 0.25 * sphere_mass(density, radius), lost = before;
    for (int n = 0; n < 400; n++) {
        case_run(&c, 100, 1e-9);
        double now = case_sums(&c).kinetic + case_contact_sums(&c).elastic;
        /* a symplectic step's own ripple, of order dt; and the energy of the spring less that of the bond, each up to five times as much */
        assert_true(now <= before + 1e-6 * scale + within(0.0, LAW) * 5.0 * fabs(case_contact_sums(&c).elastic));
        before = now;
    }
    lost -= before;
    assert_true(lost > 0.3 * scale);
    /* at rest: E_Hertz - k d^2/2 at the equilibrium */
    case_run(&c, 4000, 1e-7);
    double rest = 8.0 / 15.0 * MODULUS * sqrt(R_PAIR) * pow(equilibrium, 2.5) - 0.5 * bm_adhesion * equilibrium * equilibrium;
    RELATIVE(case_sums(&c).kinetic + case_contact_sums(&c).elastic, rest, 1e-6);
    case_close(&c);
}

#define ROUGH "{slot: normal, law: hertz}, {slot: tangential, law: mindlin}, {slot: rolling, law: elastic_plastic}, {slot: bond, law: adhesion}"

static text tumbling_head(void)
{
    text t = {0};
    put(&t, "effects: [" ROUGH "]\nmaterials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: %g, poissons_ratio: 0}]\n", density, young);
    put(&t, "interactions: [{between: default, normal_damping_ratio: 0.1, friction_static: 0.5, rolling_friction: 0.1, bond_equilibrium_strain: 0.05, "
            "bond_damping_ratio: 0.3}]\n");
    return t;
}

/* A bonded cluster of 27 that tumbles freely, 10^5 steps. */
static void test_cluster_keeps_momentum(void **state)
{
    (void)state;
    cluster grains = {.count = 27};
    for (int n = 0; n < 27; n++) {
        grains.radius[n] = radius;
        const double at[3] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1}, w[3] = {300.0, -200.0, 500.0};
        for (int k = 0; k < 3; k++)
            grains.position[n][k] = 1.975 * radius * at[k];
        for (int k = 0; k < 3; k++) {
            int p = (k + 1) % 3, q = (k + 2) % 3;
            grains.velocity[n][k] = w[p] * grains.position[n][q] - w[q] * grains.position[n][p] + (k == 0 ? 0.3 : 0.1);
            grains.spin[n][k] = w[k];
        }
    }
    text t = tumbling_head();
    put(&t, "contact_table: {skin_m: 1.0e-4}\n");
    put_cluster(&t, &grains);
    physics_case c = case_open(&t);
    double mass = sphere_mass(density, radius), linear = 27.0 * mass, angular = 27.0 * mass * 4e-3 * 2.0;
    case_run(&c, 20, 1e-6);
    assert_int_equal(bonds_of(&c).alive, 54); /* edges of a lattice of 3 x 3 x 3 */
    particle_sums before = case_sums(&c);
    double *x0 = case_field(&c, "position");
    for (int part = 0; part < 10; part++) {
        case_run(&c, 10000, 1e-6);
        particle_sums now = case_sums(&c);
        for (int k = 0; k < 3; k++) {
            NEAR(now.momentum[k], before.momentum[k], turning_error(1e-13, 62.0, 1e5) * linear);
            NEAR(now.angular[k], before.angular[k], turning_error(1e-12, 62.0, 1e5) * angular);
        }
    }
    assert_int_equal(bonds_of(&c).alive, 54);
    double *x = case_field(&c, "position");
    assert_true(fabs(x[0] - x0[0]) > 5.0 * radius); /* it has flown far, and turned */
    free(x);
    free(x0);
    case_close(&c);
}

/* The grains in another order, and other radii: the same motion. */
static void test_swapped(void **state)
{
    (void)state;
    double v[2][2];
    for (int order = 0; order < 2; order++) {
        text t = head(ADHESION, 1, NULL);
        put(&t, "interactions: [{between: default, normal_damping_ratio: 0.05, bond_equilibrium_strain: 0.05, bond_damping_ratio: 0.4}]\n");
        put(&t, "particles:\n  - name: p\n    material: m0\n    generator: list\n    items:\n");
        for (int n = 0; n < 2; n++) {
            bool left = n == order;
            put_grain(&t, left ? 1.0e-3 : 1.4e-3, (double[]){left ? -1.0e-3 : 1.4e-3, 0, 0}, (double[]){left ? 2.0 : -2.0, 0, 0}, (double[]){0, 0, 0});
        }
        physics_case c = case_open(&t);
        case_run(&c, 300, 2e-7);
        assert_int_equal(bonds_of(&c).alive, 1);
        for (int n = 0; n < 2; n++)
            v[order][n == order] = case_get(&c, "velocity", n, 0);
        case_close(&c);
    }
    assert_true(v[0][0] == v[1][0] && v[0][1] == v[1][1]);
}

/* ---- rebuilds and checkpoints ---- */

static text falling_cluster(double skin)
{
    cluster grains = cluster_make(4, radius, 1.5, 100.0, 11);
    text t = tumbling_head();
    put(&t, "contact_table: {skin_m: %g}\n", skin);
    put_cluster(&t, &grains);
    return t;
}

static void test_bits(void **state)
{
    (void)state;
    double *reference = NULL;
    bond_sums expected = {0, 0, 0};
    for (int n = 0; n < 4; n++) {
        text t = falling_cluster(n == 1 ? 2.0e-5 : 2.0e-4);
        physics_case c = case_open(&t);
        for (int part = 0; part < 30; part++) {
            case_run(&c, 50, 1e-6);
            if (n == 2)
                MUST(table_build(c.sim, false, why));
            if (n == 3 && part == 12) /* stopped and taken up again */
                case_stop_and_resume(&c);
        }
        double *x = case_field(&c, "position");
        bond_sums sums = bonds_of(&c);
        if (n == 0) {
            reference = x;
            expected = sums;
            assert_true(sums.made > 20 && sums.broken > 3 && sums.alive > 3);
            continue;
        }
        assert_memory_equal(x, reference, 8 * 3 * 64);
        assert_int_equal(sums.made, expected.made);
        assert_int_equal(sums.alive, expected.alive);
        assert_int_equal(sums.broken, expected.broken);
        free(x);
        case_close(&c);
    }
    free(reference);
}

/* ---- refusals ---- */

static void refused(const char *effects, const char *interaction, const char *piece)
{
    text t = head(effects, 1, NULL);
    put(&t, "interactions: [%s]\nparticles:\n", interaction);
    put_pair(&t, 0, 0, 0.0, 1.0);
    put(&t, "stages: [{until: {steps: 1}}]\n");
    scene *s = NULL;
    bed b = {0};
    simulation *sim = NULL;
    failure why = {.text = ""};
    status result = scene_read_text(t.at, "case.yaml", 0, NULL, &s, &why);
    if (result == STATUS_OK) {
        MUST(bed_generate(s, &b, why));
        result = simulation_create(s, &b, case_device(), NULL, &sim, &why);
    }
    assert_int_equal(result, STATUS_BAD_INPUT);
    if (!strstr(why.text, piece))
        fail_msg("`%s` does not hold `%s`", why.text, piece);
    simulation_free(sim);
    bed_free(&b);
    scene_free(s);
    free(t.at);
}

static void test_refused(void **state)
{
    (void)state;
    refused(ADHESION, "{between: default, bond_stiffness: 1e5, bond_exponent: 1.5}", "bond_exponent 1.5 >= 1.5");
    refused("{slot: normal, law: linear}, {slot: bond, law: adhesion}", "{between: default, normal_stiffness_n_m: 1e6, bond_stiffness: 1e5}",
            "bond_exponent 1 >= 1 of");
    refused(ADHESION, "{between: default, bond_equilibrium_overlap_m: 3e-4}", "0.3 of the radius");
    refused(ADHESION, "{between: default, bond_equilibrium_overlap_m: 3e-5, bond_stiffness: 1e5}", "keep one");
    refused("{slot: normal, law: hertz}, {slot: bond, law: adhesion, criterion: scalar_above}", "{between: default, bond_equilibrium_overlap_m: 3e-5}",
            "add `bond_threshold`");
    refused("{slot: bond, law: adhesion}", "{between: default, bond_equilibrium_overlap_m: 3e-5}", "needs a normal law");
}

/* ---- step limit ---- */

/* At rest in equilibrium: k* = a k2 d^(a-1) - k and 2 xi sqrt(m* k*), counted twice between two grains; velocity Verlet bears half the damping. */
static void test_step_limit(void **state)
{
    (void)state;
    text t = head(ADHESION, 1, NULL);
    put(&t, "interactions: [{between: default, bond_equilibrium_overlap_m: %.17g, bond_damping_ratio: 0.5}]\nparticles:\n", equilibrium);
    put_pair(&t, 0, 0, equilibrium, 0.0);
    physics_case c = case_open(&t);
    case_run(&c, 1, 1e-9);
    double stiffness = 2.0 * MODULUS * sqrt(R_PAIR * equilibrium) - bm_adhesion, mass = 0.5 * sphere_mass(density, radius);
    double omega = sqrt(stiffness / mass);
    double xi = case_verlet() ? 1.0 : 0.5;
    RELATIVE(case_limit(&c).live_s, 2.0 * (sqrt(1.0 + xi * xi) - xi) / omega, 1e-6);
    assert_true(case_limit(&c).limit_s <= case_limit(&c).live_s);
    case_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_figures),           cmocka_unit_test(test_curves_at_the_printed_step),
        cmocka_unit_test(test_curves_at_a_small_step), cmocka_unit_test(test_equilibrium),
        cmocka_unit_test(test_wall_and_weight),   cmocka_unit_test(test_critical_velocity),
        cmocka_unit_test(test_breaks_again),      cmocka_unit_test(test_pull_off),
        cmocka_unit_test(test_strengths),         cmocka_unit_test(test_shear_strength),        
        cmocka_unit_test(test_energy_never_rises), cmocka_unit_test(test_cluster_keeps_momentum),
        cmocka_unit_test(test_swapped),           cmocka_unit_test(test_bits),
        cmocka_unit_test(test_refused),           cmocka_unit_test(test_step_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
