/* Normal laws against closed forms: Hertz without and with damping, between grains and at a wall, and the linear law. */
#include "case.h"

#define LANE 0.1 /* between impacts that do not see each other, m */

/* Impacts of equal pairs along x with E, nu, density, radius, relative speed. */
typedef struct pair_material {
    double young, poisson, density, radius;
} pair_material;

static const pair_material sand = {1.0e9, 0.3, 2500.0, 1.0e-3};

static double pair_modulus(const pair_material *m)
{
    return m->young / (2.0 * (1.0 - m->poisson * m->poisson));
}

static double wall_modulus(const pair_material *m)
{
    return m->young / (1.0 - m->poisson * m->poisson);
}

static text head(const pair_material *m, const char *law, const char *interaction)
{
    text t = {0};
    put(&t, "effects: [{slot: normal, law: %s}]\n", law);
    put(&t, "materials: [{name: m, density_kg_m3: %.17g, youngs_modulus_pa: %.17g, poissons_ratio: %.17g}]\n", m->density, m->young,
        m->poisson);
    put(&t, "interactions: [%s]\n", interaction);
    return t;
}

/* Two grains that touch at t = 0 and approach at v, in the lane at y. */
static void put_pair(text *t, double radius, double y, double v)
{
    put_grain(t, radius, (double[]){-radius, y, 0}, (double[]){0.5 * v, 0, 0}, (double[]){0, 0, 0});
    put_grain(t, radius, (double[]){radius, y, 0}, (double[]){-0.5 * v, 0, 0}, (double[]){0, 0, 0});
}

static physics_case one_pair(const pair_material *m, double v)
{
    text t = head(m, "hertz", "{between: default, normal_damping_ratio: 0}");
    put(&t, "particles:\n  - name: pair\n    material: m\n    generator: list\n    items:\n");
    put_pair(&t, m->radius, 0.0, v);
    return case_open(&t);
}

/* Follows the only contact of the case to its end: deepest overlap (with the parabola through the three largest samples), largest force,
 * and the time at which the overlap returns to zero. `wall`: the gap is the height above z = 0. */
typedef struct impact {
    double overlap, force, duration;
} impact;

static double overlap_now(physics_case *c, bool wall)
{
    double *x = case_field(c, "position");
    double overlap = wall ? c->bed.radius[0] - x[2] : c->bed.radius[0] + c->bed.radius[1] - fabs(x[3] - x[0]);
    free(x);
    return overlap;
}

static double force_now(physics_case *c)
{
    int64_t count;
    live_contact *contacts = case_contacts(c, &count);
    double force = count ? sqrt(pow(contacts->force[0], 2) + pow(contacts->force[1], 2) + pow(contacts->force[2], 2)) : 0.0;
    assert_true(count <= 1);
    free(contacts);
    return force;
}

static impact follow(physics_case *c, bool wall, double dt, int most)
{
    impact result = {0};
    double before = 0.0, earlier = 0.0;
    for (int s = 1; s <= most; s++) {
        case_run(c, 1, dt);
        double overlap = overlap_now(c, wall);
        if (before > earlier && before >= overlap) {
            result.overlap = before + pow(overlap - earlier, 2) / (8.0 * (2.0 * before - earlier - overlap));
            result.force = force_now(c);
        }
        if (overlap <= 0.0) {
            result.duration = dt * ((double)s - overlap / (overlap - before));
            return result;
        }
        earlier = before;
        before = overlap;
    }
    fail_msg("no end of the contact within %d steps", most);
    return result;
}

/* A step of a 1000th of the contact; the scheme is of second order there, (omega dt)^2/24 = 4e-7. */
#define STEPS 1000

static void check_impact(physics_case *c, bool wall, double modulus, double radius, double mass, double v)
{
    double overlap = hertz_overlap(modulus, radius, mass, v), duration = hertz_duration(modulus, radius, mass, v);
    impact seen = follow(c, wall, duration / STEPS, 2 * STEPS);
    RELATIVE(seen.overlap, overlap, 2e-6);
    RELATIVE(seen.force, 4.0 / 3.0 * modulus * sqrt(radius) * pow(overlap, 1.5), 1e-5);
    RELATIVE(seen.duration, duration, 1e-5);
}

static void test_elastic_pair(void **state)
{
    (void)state;
    double v = 1.0, r = 0.5 * sand.radius, m = 0.5 * sphere_mass(sand.density, sand.radius), modulus = pair_modulus(&sand);
    physics_case c = one_pair(&sand, v);
    check_impact(&c, false, modulus, r, m, v);
    RELATIVE(hertz_overlap(modulus, r, m, v), 1.0980510e-5, 1e-7);
    RELATIVE(4.0 / 3.0 * modulus * sqrt(r) * pow(hertz_overlap(modulus, r, m, v), 1.5), 0.59605471, 1e-7);
    RELATIVE(hertz_duration(modulus, r, m, v), 3.2318663e-5, 1e-7);
    RELATIVE(2.86826570 * pow(m * m / (r * modulus * modulus * v), 0.2), hertz_duration(modulus, r, m, v), 1e-8);
    RELATIVE(case_get(&c, "velocity", 0, 0), -0.5 * v, 1e-6);
    RELATIVE(case_get(&c, "velocity", 1, 0), 0.5 * v, 1e-6);
    case_close(&c);
}

static void test_elastic_wall(void **state)
{
    (void)state;
    double v = 0.7;
    text t = head(&sand, "hertz", "{between: default, normal_damping_ratio: 0}");
    put(&t, "walls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}]\n");
    put(&t, "particles:\n  - name: one\n    material: m\n    generator: list\n    items:\n");
    put_grain(&t, sand.radius, (double[]){0, 0, sand.radius}, (double[]){0, 0, -v}, (double[]){0, 0, 0});
    physics_case c = case_open(&t);
    check_impact(&c, true, wall_modulus(&sand), sand.radius, sphere_mass(sand.density, sand.radius), v);
    RELATIVE(case_get(&c, "velocity", 0, 2), v, 1e-6);
    case_close(&c);
}

/* Two materials, two radii: r*, m*, E* of an unequal pair. */
static void test_unequal_pair(void **state)
{
    (void)state;
    double r1 = 1.0e-3, r2 = 2.5e-3, v = 2.0;
    double modulus = 1.0 / ((1.0 - 0.3 * 0.3) / 1.0e9 + (1.0 - 0.1 * 0.1) / 7.0e9);
    double m1 = sphere_mass(2500.0, r1), m2 = sphere_mass(1200.0, r2);
    text t = {0};
    put(&t, "effects: [{slot: normal, law: hertz}]\n"
            "materials:\n  - {name: a, density_kg_m3: 2500, youngs_modulus_pa: 1.0e9, poissons_ratio: 0.3}\n"
            "  - {name: b, density_kg_m3: 1200, youngs_modulus_pa: 7.0e9, poissons_ratio: 0.1}\n"
            "interactions: [{between: default, normal_damping_ratio: 0}]\n"
            "particles:\n  - name: one\n    material: a\n    generator: list\n    items:\n");
    put_grain(&t, r1, (double[]){-r1, 0, 0}, (double[]){v, 0, 0}, (double[]){0, 0, 0});
    put(&t, "  - name: other\n    material: b\n    generator: list\n    items:\n");
    put_grain(&t, r2, (double[]){r2, 0, 0}, (double[]){0, 0, 0}, (double[]){0, 0, 0});
    physics_case c = case_open(&t);
    check_impact(&c, false, modulus, r1 * r2 / (r1 + r2), m1 * m2 / (m1 + m2), v);
    RELATIVE(case_get(&c, "velocity", 0, 0), (m1 - m2) / (m1 + m2) * v, 1e-6);
    RELATIVE(case_get(&c, "velocity", 1, 0), 2.0 * m1 / (m1 + m2) * v, 1e-6);
    case_close(&c);
}

/* Chung and Ooi (2011), test 1. */
static void test_chung_and_ooi(void **state)
{
    (void)state;
    const pair_material glass = {4.8e10, 0.2, 2800.0, 0.01};
    double v = 20.0, r = 0.5 * glass.radius, m = 0.5 * sphere_mass(glass.density, glass.radius);
    physics_case c = one_pair(&glass, v);
    impact seen = follow(&c, false, hertz_duration(pair_modulus(&glass), r, m, v) / STEPS, 2 * STEPS);
    NEAR(seen.overlap, 274.1e-6, 0.05e-6);
    NEAR(seen.force, 10.697e3, 0.5);
    NEAR(seen.duration, 40.34e-6, 0.005e-6);
    case_close(&c);
}

/* ---- restitution ---- */

static const double speeds[] = {0.03, 1.0, 30.0};

/* Pairs with the same ratio of overlap to step: each speed runs with its own step, in a case of its own. */
static double restitution_seen(const pair_material *m, const char *law, const char *interaction, double v, double contact, int steps)
{
    text t = head(m, law, interaction);
    put(&t, "particles:\n  - name: pair\n    material: m\n    generator: list\n    items:\n");
    put_pair(&t, m->radius, 0.0, v);
    physics_case c = case_open(&t);
    case_run(&c, 8 * steps, contact / steps);
    double *u = case_field(&c, "velocity"), e = (u[3] - u[0]) / v;
    assert_int_equal(case_contact_sums(&c).contacts, 0);
    free(u);
    case_close(&c);
    return e;
}

/* The damped scheme is of first order: a 4000th of the contact leaves about xi/4000. */
static void test_restitution(void **state)
{
    (void)state;
    const double table[][2] = {{0.1, 0.724674}, {0.3, 0.423113}, {0.5, 0.273152}, {1.0, 0.119583}};
    double r = 0.5 * sand.radius, m = 0.5 * sphere_mass(sand.density, sand.radius);
    for (int k = 0; k < COUNT_OF(table); k++) {
        double xi = table[k][0], b = xi * sqrt(1.2), seen[COUNT_OF(speeds)];
        NEAR(hertz_restitution(xi), table[k][1], 1e-6);
        if (b < 1.0) /* the clamp ends the contact earlier than a damper that pulls would, so more is kept */
            assert_true(hertz_restitution(xi) > exp(-PI * b / sqrt(1.0 - b * b)));
        for (int s = 0; s < COUNT_OF(speeds); s++) {
            char interaction[128];
            snprintf(interaction, sizeof interaction, "{between: default, normal_damping_ratio: %.17g}", xi);
            seen[s] = restitution_seen(&sand, "hertz", interaction, speeds[s], hertz_duration(pair_modulus(&sand), r, m, speeds[s]), 4000);
            NEAR(seen[s], table[k][1], 3e-4);
            NEAR(seen[s], seen[0], within(1e-10, 2.0 * LAW)); /* independent of the speed: with the same share of the contact to a step, to rounding */
        }
    }
}

static void test_largest_damped_overlap(void **state)
{
    (void)state;
    const double table[][2] = {{0.1, 0.879138}, {0.3, 0.708896}, {0.5, 0.595061}, {1.0, 0.427630}};
    double v = 1.0, r = 0.5 * sand.radius, m = 0.5 * sphere_mass(sand.density, sand.radius), modulus = pair_modulus(&sand);
    for (int k = 0; k < COUNT_OF(table); k++) {
        char interaction[128];
        snprintf(interaction, sizeof interaction, "{between: default, normal_damping_ratio: %.17g}", table[k][0]);
        text t = head(&sand, "hertz", interaction);
        put(&t, "particles:\n  - name: pair\n    material: m\n    generator: list\n    items:\n");
        put_pair(&t, sand.radius, 0.0, v);
        physics_case c = case_open(&t);
        impact seen = follow(&c, false, hertz_duration(modulus, r, m, v) / 4000, 40000);
        NEAR(seen.overlap / hertz_overlap(modulus, r, m, v), table[k][1], 3e-4);
        case_close(&c);
    }
}

static void test_inverse_restitution(void **state)
{
    (void)state;
    const double table[][2] = {{0.9, 0.031280}, {0.5, 0.233034}, {0.3, 0.453915}};
    double r = 0.5 * sand.radius, m = 0.5 * sphere_mass(sand.density, sand.radius);
    for (int k = 0; k < COUNT_OF(table); k++) {
        char interaction[128];
        double e = table[k][0];
        NEAR(hertz_damping_ratio(e), table[k][1], 1e-6);
        NEAR(hertz_restitution(hertz_damping_ratio(e)), e, 1e-9);
        snprintf(interaction, sizeof interaction, "{between: default, restitution: %.17g}", e);
        NEAR(restitution_seen(&sand, "hertz", interaction, 1.0, hertz_duration(pair_modulus(&sand), r, m, 1.0), 4000), e, 3e-4);
    }
}

/* ---- linear law ---- */

static const double stiffness = 1.0e5;

/* Half a period of the undamped spring, amplitude v/omega. */
static void test_linear_elastic(void **state)
{
    (void)state;
    double v = 1.0, m = 0.5 * sphere_mass(sand.density, sand.radius), omega = sqrt(stiffness / m);
    text t = head(&sand, "linear", "{between: default, normal_damping_ratio: 0, normal_stiffness_n_m: 1.0e5}");
    put(&t, "particles:\n  - name: pair\n    material: m\n    generator: list\n    items:\n");
    put_pair(&t, sand.radius, 0.0, v);
    physics_case c = case_open(&t);
    impact seen = follow(&c, false, PI / omega / STEPS, 2 * STEPS);
    RELATIVE(seen.duration, PI / omega, 1e-5);
    RELATIVE(seen.overlap, v / omega, 1e-5);
    RELATIVE(seen.force, v * sqrt(stiffness * m), 1e-5);
    case_close(&c);
}

/* e = exp(-xi phi/sqrt(1 - xi^2)), where the clamped force ends at the phase tan(phi) = 2 xi sqrt(1 - xi^2)/(2 xi^2 - 1). */
static void test_linear_restitution(void **state)
{
    (void)state;
    const double ratios[] = {0.05, 0.3, 0.9};
    double m = 0.5 * sphere_mass(sand.density, sand.radius), omega = sqrt(stiffness / m);
    for (int k = 0; k < COUNT_OF(ratios); k++) {
        char interaction[128];
        double xi = ratios[k], root = sqrt(1.0 - xi * xi);
        double e = exp(-xi / root * atan2(2.0 * xi * root, 2.0 * xi * xi - 1.0));
        NEAR(linear_restitution(xi), e, 1e-14);
        NEAR(linear_damping_ratio(e), xi, 1e-10);
        snprintf(interaction, sizeof interaction, "{between: default, normal_damping_ratio: %.17g, normal_stiffness_n_m: %.17g}", xi,
                 stiffness);
        /* the damper acts at once at the first touch: first order, xi omega dt = xi pi/8000 */
        NEAR(restitution_seen(&sand, "linear", interaction, 1.0, PI / omega, 8000), e, 1e-3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_elastic_pair),        cmocka_unit_test(test_elastic_wall),   cmocka_unit_test(test_unequal_pair),
        cmocka_unit_test(test_chung_and_ooi),       cmocka_unit_test(test_restitution),    cmocka_unit_test(test_largest_damped_overlap),
        cmocka_unit_test(test_inverse_restitution), cmocka_unit_test(test_linear_elastic), cmocka_unit_test(test_linear_restitution),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
