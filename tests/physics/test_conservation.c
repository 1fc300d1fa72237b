/* Momentum and angular momentum of isolated clusters that collide, slide, roll and spin: kept to rounding by action and reaction at one
 * contact point; with the radius as lever arm they drift as TM's printed equation makes them. */
#include "cluster.h"

static const double young = 1.0e7, density = 2500.0, radius = 1.0e-3;

static text cluster_head(const char *effects, double rolling_friction)
{
    text t = {0};
    put(&t, "effects:\n%s", effects);
    put(&t, "materials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: %g, poissons_ratio: 0.3}]\n", density, young);
    put(&t,
        "interactions: [{between: default, normal_damping_ratio: 0.1, tangential_damping_ratio: 0.2, rolling_damping_ratio: 0.1, "
        "friction_static: 0.5, "
        "friction_dynamic: 0.4, rolling_friction: %g, normal_stiffness_n_m: 500, tangential_stiffness_n_m: 300}]\n",
        rolling_friction);
    return t;
}

static double size(const double *a)
{
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

/* 64 grains through 8,000 steps. The sums' terms are of the size of sum m |v| and of sum m |x| |v|; each of the thousands of contact-steps
 * rounds at 1e-16 of its own force. In mixed precision the way from the contacts' forces to a kick rounds: of impulses that add up to a few
 * times the momenta of all. */
static void check_kept(const char *effects)
{
    cluster bed = cluster_make(4, radius, 0.2, 100.0, 7);
    text t = cluster_head(effects, 0.1);
    put_cluster(&t, &bed);
    physics_case c = case_open(&t);
    double linear = 0.0, angular = 0.0;
    for (int n = 0; n < bed.count; n++) {
        double m = sphere_mass(density, bed.radius[n]);
        linear += m * size(bed.velocity[n]);
        angular += m * size(bed.velocity[n]) * size(bed.position[n]) + 0.4 * m * bed.radius[n] * bed.radius[n] * size(bed.spin[n]);
    }
    particle_sums before = case_sums(&c);
    int64_t touching = 0;
    for (int part = 0; part < 80; part++) {
        case_run(&c, 100, 5.0e-6);
        touching += case_contact_sums(&c).contacts;
        particle_sums now = case_sums(&c);
        for (int k = 0; k < 3; k++) {
            NEAR(now.momentum[k], before.momentum[k], within(1e-14, LAW) * linear);
            NEAR(now.angular[k], before.angular[k], within(1e-13, 2.0 * LAW) * angular);
        }
    }
    assert_true(touching > 100); /* of 80 looks; a contact lasts about one */
    assert_true(case_sums(&c).kinetic < 0.9 * before.kinetic);
    case_close(&c);
}

static void test_kept_with_history(void **state)
{
    (void)state;
    check_kept("  - {slot: normal, law: hertz}\n  - {slot: tangential, law: mindlin}\n  - {slot: rolling, law: elastic_plastic}\n");
}

static void test_kept_by_the_other_laws(void **state)
{
    (void)state;
    check_kept("  - {slot: normal, law: linear}\n  - {slot: tangential, law: coulomb_linear}\n  - {slot: rolling, law: constant_torque}\n");
}

/* Two spheres that slide on each other: with arms r the torques are r1 n x f and r2 n x f, the pair of forces turns with r1 + r2 - d, and
 * d (n x f) is left over. */
static double drift(const char *arm, double *expected)
{
    char effects[256];
    snprintf(effects, sizeof effects,
             "  - {slot: normal, law: hertz}\n  - {slot: tangential, law: mindlin%s}\n  - {slot: rolling, law: elastic_plastic}\n", arm);
    text t = cluster_head(effects, 0.0);
    put(&t, "particles:\n  - name: p\n    material: m\n    generator: list\n    items:\n");
    double r1 = 1.0e-3, r2 = 2.0e-3;
    put_grain(&t, r1, (double[]){-r1, 1.0e-3, 0}, (double[]){0.2, 0, 0}, (double[]){0, 0, 900});
    put_grain(&t, r2, (double[]){r2, 1.0e-3, 0}, (double[]){-0.2, 0, 0}, (double[]){0, 0, 900});
    physics_case c = case_open(&t);
    const char *kicked = case_verlet() ? "half_spin" : "spin";
    double before = case_sums(&c).angular[2], dt = 1.0e-7;
    *expected = 0.0;
    for (int s = 0; s < 4000; s++) { /* d (n x f_t) dt of each step, with the force that the step uses: read back from the change of spin */
        double *x = case_field(&c, "position"), *w = case_field(&c, kicked), spin = w[2];
        double overlap = fmax(0.0, r1 + r2 - hypot(x[3] - x[0], x[4] - x[1]));
        free(x);
        free(w);
        case_run(&c, 1, dt);
        double torque = 0.4 * sphere_mass(density, r1) * r1 * r1 * (case_get(&c, kicked, 0, 2) - spin);
        *expected += overlap * torque / r1;
    }
    double change = case_sums(&c).angular[2] - before;
    assert_int_equal(case_contact_sums(&c).contacts, 0);
    case_close(&c);
    return change;
}

static void test_drift_with_radius(void **state)
{
    (void)state;
    double expected, kept, l = 0.4 * sphere_mass(density, 2.0e-3) * 4.0e-6 * 900.0;
    kept = drift("", &expected);
    NEAR(kept, 0.0, within(1e-14, LAW) * l);
    double drifted = drift(", lever_arm: radius", &expected);
    assert_true(fabs(expected) > 1e-6 * l);
    NEAR(drifted, expected, fmax(1e-8 * fabs(expected), within(0.0, LAW) * l));
}

/* ---- large and small ---- */

#define SHELL  150
#define LAYERS 3
#define BOULDER 50.0

/* Fibonacci's points on a sphere; layers one behind the other, so that the outer grains run into those that come back. */
static text boulder_and_grains(double *linear, double *angular)
{
    text t = cluster_head("  - {slot: normal, law: hertz}\n  - {slot: tangential, law: mindlin}\n  - {slot: rolling, law: elastic_plastic}\n", 0.1);
    const double none[3] = {0, 0, 0}, spin[3] = {20, 10, -30}, big = BOULDER * radius, m = sphere_mass(density, radius), speed = 0.5;
    put(&t, "particles:\n  - name: p\n    material: m\n    generator: list\n    items:\n");
    put_grain(&t, big, none, none, spin);
    *linear = SHELL * LAYERS * m * speed;
    *angular = *linear * 1.2 * big + 0.4 * sphere_mass(density, big) * big * big * size(spin);
    for (int k = 0; k < SHELL * LAYERS; k++) {
        double z = 1.0 - (2.0 * (k % SHELL) + 1.0) / SHELL, turn = PI * (3.0 - sqrt(5.0)) * (k % SHELL), wide = sqrt(1.0 - z * z);
        double way[3] = {wide * cos(turn), wide * sin(turn), z}, x[3], v[3];
        for (int c = 0; c < 3; c++) {
            x[c] = (big + (1.1 + 2.2 * (k / SHELL)) * radius) * way[c];
            v[c] = -speed * way[c];
        }
        put_grain(&t, radius, x, v, none);
    }
    return t;
}

/* Pairs that overlap, by trying all. */
static int64_t overlapping(physics_case *c, int64_t *of_boulder)
{
    double *x = case_field(c, "position"), *r = case_field(c, "radius");
    int64_t count = 0, n = SHELL * LAYERS + 1;
    *of_boulder = 0;
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = i + 1; j < n; j++) {
            double d[3] = {x[3 * i] - x[3 * j], x[3 * i + 1] - x[3 * j + 1], x[3 * i + 2] - x[3 * j + 2]};
            bool touch = size(d) < r[i] + r[j];
            count += touch;
            *of_boulder += touch && i == 0;
        }
    free(x);
    free(r);
    return count;
}

/* Grains from all sides strike a spinning boulder of fifty times their radius and each other: no contact is missed, and momentum and angular
 * momentum are kept. */
static void test_boulder(void **state)
{
    (void)state;
    double linear, angular;
    text t = boulder_and_grains(&linear, &angular);
    physics_case c = case_open(&t);
    particle_sums before = case_sums(&c);
    int64_t most = 0, among_grains = 0, of_boulder, count;
    for (int part = 0; part < 60; part++) {
        case_run(&c, 15, 1.0e-5);
        int64_t expected = overlapping(&c, &of_boulder), found = 0;
        live_contact *live = case_contacts(&c, &count);
        for (int64_t k = 0; k < count; k++)
            found += live[k].overlap > 0.0;
        free(live);
        assert_int_equal(found, expected);
        most = of_boulder > most ? of_boulder : most;
        among_grains += expected - of_boulder;
        particle_sums now = case_sums(&c);
        for (int k = 0; k < 3; k++) {
            NEAR(now.momentum[k], before.momentum[k], within(1e-14, LAW) * linear);
            NEAR(now.angular[k], before.angular[k], within(1e-13, 2.0 * LAW) * angular);
        }
    }
    assert_true(most > SHELL / 2);
    assert_true(among_grains > SHELL / 2);
    assert_true(case_sums(&c).kinetic < before.kinetic);
    case_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_kept_with_history),
        cmocka_unit_test(test_kept_by_the_other_laws),
        cmocka_unit_test(test_drift_with_radius),
        cmocka_unit_test(test_boulder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
