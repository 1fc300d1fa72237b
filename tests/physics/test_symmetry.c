/* A scene that is mirrored, turned, or written in another order gives the mirrored, turned, reordered result; nothing happens at rest. */
#include "cluster.h"

static const double radius = 1.0e-3, speed = 0.3, dt = 5.0e-6;

#define EFFECTS \
    "effects:\n  - {slot: normal, law: hertz}\n  - {slot: tangential, law: mindlin}\n  - {slot: rolling, law: elastic_plastic}\n"
#define MATERIAL "materials: [{name: m, density_kg_m3: 2500, youngs_modulus_pa: 1.0e7, poissons_ratio: 0.3}]\n"
#define ROUGH \
    "interactions: [{between: default, normal_damping_ratio: 0.1, friction_static: 0.5, friction_dynamic: 0.4, rolling_friction: 0.1}]\n"

static text head(void)
{
    text t = {0};
    put(&t, EFFECTS MATERIAL ROUGH);
    return t;
}

/* A cluster that falls on a plane through the origin with normal n, pulled along g. */
static physics_case falling(const cluster *bed, const double *n, const double *g)
{
    text t = head();
    put(&t, "gravity_m_s2: [%.17g, %.17g, %.17g]\n", g[0], g[1], g[2]);
    put(&t, "walls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [%.17g, %.17g, %.17g]}]\n", n[0], n[1], n[2]);
    put_cluster(&t, bed);
    physics_case c = case_open(&t);
    return c;
}

/* Runs a case and makes sure that there was something to see: more contacts, looked at every 100 steps, than grains. */
static void run_touching(physics_case *c, int steps)
{
    int64_t touching = 0;
    for (int part = 0; part < steps / 100; part++) {
        case_run(c, 100, dt);
        touching += case_contact_sums(c).contacts;
    }
    if (touching <= c->bed.count)
        fail_msg("only %d contacts seen between %d grains", (int)touching, (int)c->bed.count);
}

static cluster lifted(void)
{
    cluster bed = cluster_make(3, radius, speed, 200.0, 11);
    for (int n = 0; n < bed.count; n++) {
        bed.position[n][2] += 5.0 * radius;
        bed.velocity[n][2] -= 0.5;
    }
    return bed;
}

/* Rounding grows in collisions, by a factor of ten or so each; over the 1500 steps a grain has a few. Of a double's 1e-16 much less is left than
 * is asked for; of what a law rounds in a float, three collisions make a thousand times as much. */
static double grown(void)
{
    return within(1e-7, LAW * 1000.0);
}

static void check_image(const double m[9], double determinant, double tolerance)
{
    const double up[3] = {0, 0, 1}, down[3] = {1, 0.5, -9.81};
    double n[3], g[3];
    cluster bed = lifted(), other = cluster_image(&bed, m, determinant);
    image(m, 1.0, up, n);
    image(m, 1.0, down, g);
    physics_case a = falling(&bed, up, down), b = falling(&other, n, g);
    run_touching(&a, 1500);
    case_run(&b, 1500, dt);
    double *xa = case_field(&a, "position"), *xb = case_field(&b, "position"), *wa = case_field(&a, "spin"), *wb = case_field(&b, "spin");
    NEAR(image_error(xa, xb, bed.count, m, 1.0), 0.0, tolerance * radius);
    NEAR(image_error(wa, wb, bed.count, m, determinant), 0.0, tolerance * speed / radius);
    free(xa);
    free(xb);
    free(wa);
    free(wb);
    case_close(&a);
    case_close(&b);
}

static void test_mirror(void **state)
{
    (void)state;
    const double x[9] = {-1, 0, 0, 0, 1, 0, 0, 0, 1}, z[9] = {1, 0, 0, 0, 1, 0, 0, 0, -1}, swap[9] = {0, 1, 0, 1, 0, 0, 0, 0, 1};
    check_image(x, -1.0, grown());
    check_image(z, -1.0, grown());
    check_image(swap, -1.0, grown());
}

static void test_rotation(void **state)
{
    (void)state;
    const double quarter[9] = {0, 0, 1, 1, 0, 0, 0, 1, 0};
    check_image(quarter, 1.0, grown());
    double a = 0.7, b = 1.1; /* about z, then about x */
    const double turn[9] = {cos(a), -sin(a), 0, cos(b) * sin(a), cos(b) * cos(a), -sin(b), sin(b) * sin(a), sin(b) * cos(a), cos(b)};
    check_image(turn, 1.0, grown());
}

/* Grains written in the reverse order. */
static void test_order(void **state)
{
    (void)state;
    const double up[3] = {0, 0, 1}, down[3] = {1, 0.5, -9.81};
    cluster bed = lifted(), reverse = bed;
    int last = bed.count - 1;
    for (int n = 0; n < bed.count; n++) {
        reverse.radius[n] = bed.radius[last - n];
        memcpy(reverse.position[n], bed.position[last - n], sizeof bed.position[n]);
        memcpy(reverse.velocity[n], bed.velocity[last - n], sizeof bed.velocity[n]);
        memcpy(reverse.spin[n], bed.spin[last - n], sizeof bed.spin[n]);
    }
    physics_case a = falling(&bed, up, down), b = falling(&reverse, up, down);
    case_run(&a, 1500, dt);
    case_run(&b, 1500, dt);
    double *xa = case_field(&a, "position"), *xb = case_field(&b, "position"), *wa = case_field(&a, "spin"), *wb = case_field(&b, "spin");
    for (int n = 0; n < bed.count; n++)
        for (int k = 0; k < 3; k++) {
            NEAR(xb[3 * (last - n) + k], xa[3 * n + k], grown() * radius);
            NEAR(wb[3 * (last - n) + k], wa[3 * n + k], grown() * speed / radius);
        }
    free(xa);
    free(xb);
    free(wa);
    free(wb);
    case_close(&a);
    case_close(&b);
}

/* Swapping the two of an impact (unequal, frictional, spinning) swaps the result to the bit: the smaller one owns the contact either way.
 * */
static void test_swapped_pair(void **state)
{
    (void)state;
    double *field[2][2];
    for (int s = 0; s < 2; s++) {
        text t = head();
        put(&t, "particles:\n  - name: p\n    material: m\n    generator: list\n    items:\n");
        for (int k = 0; k < 2; k++) {
            bool small = k == s;
            put_grain(&t, small ? 1.0e-3 : 1.7e-3, (double[]){small ? -1.0e-3 : 1.7e-3, 1e-4, 0}, (double[]){small ? 0.3 : -0.1, 0.1, 0.05},
                      (double[]){small ? 30 : -20, 50, 10});
        }
        physics_case c = case_open(&t);
        case_run(&c, 500, dt);
        assert_int_equal(case_contact_sums(&c).contacts, 0);
        field[s][0] = case_field(&c, "velocity");
        field[s][1] = case_field(&c, "spin");
        case_close(&c);
    }
    for (int f = 0; f < 2; f++) {
        assert_memory_equal(field[0][f], field[1][f] + 3, 3 * sizeof(double));
        assert_memory_equal(field[0][f] + 3, field[1][f], 3 * sizeof(double));
        free(field[0][f]);
        free(field[1][f]);
    }
}

/* Apart, and just touching, without gravity: bits unchanged. */
static void test_rest(void **state)
{
    (void)state;
    text t = head();
    put(&t, "walls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}]\n");
    put(&t, "particles:\n  - name: p\n    material: m\n    generator: lattice\n    counts: [3, 3, 3]\n    spacing_m: 2.0e-3\n    radius_m: "
            "1.0e-3\n"
            "    origin_m: [0, 0, 1.0e-3]\n");
    physics_case c = case_open(&t);
    double *before = case_field(&c, "position");
    case_run(&c, 1000, dt);
    double *after = case_field(&c, "position"), *v = case_field(&c, "velocity"), *w = case_field(&c, "spin");
    /* 3 (2 k + 1) 1e-3 is not exact: neighbours may overlap by a rounding, 1e-18 m, and give a force that does not move them */
    for (int n = 0; n < 81; n++) {
        NEAR(after[n], before[n], 1e-18);
        NEAR(v[n], 0.0, 1e-16);
        NEAR(w[n], 0.0, 1e-16);
    }
    free(before);
    free(after);
    free(v);
    free(w);
    case_close(&c);
}

static void test_rest_apart(void **state)
{
    (void)state;
    cluster bed = cluster_make(3, radius, 0.0, 0.0, 3);
    text t = head();
    put_cluster(&t, &bed);
    physics_case c = case_open(&t);
    double *before = case_field(&c, "position");
    for (int n = 0; n < 3 * bed.count; n++)
        NEAR(before[n], bed.position[n / 3][n % 3], kept(0.0, 12.0 * radius, 1.0));
    case_run(&c, 1000, dt);
    double *x = case_field(&c, "position"), *v = case_field(&c, "velocity");
    assert_memory_equal(x, before, 3 * sizeof(double) * (size_t)bed.count);
    for (int n = 0; n < 3 * bed.count; n++)
        assert_true(v[n] == 0.0);
    free(before);
    free(x);
    free(v);
    case_close(&c);
}

/* ---- two dimensions, periodic directions ---- */

static void test_plane_stays_plane(void **state)
{
    (void)state;
    text t = head();
    put(&t, "dimensions: 2\ngravity_m_s2: [0.3, -9.81, 0]\nwalls: [{name: tray, shape: box, low_m: [0, 0, -0.01], high_m: [0.02, 0.02, "
            "0.01], open: [y_high]}]\n");
    put(&t, "particles:\n  - name: p\n    material: m\n    generator: lattice\n    lattice: triangular\n    counts: [6, 1, 4]\n    "
            "spacing_m: 2.3e-3\n"
            "    radius_m: 1.0e-3\n    origin_m: [2.0e-3, 1.5e-3, 0]\n    spin_rad_s: [0, 0, 50]\n    velocity_m_s: [0.2, -0.3, 0]\n");
    physics_case c = case_open(&t);
    run_touching(&c, 8000);
    double *x = case_field(&c, "position"), *v = case_field(&c, "velocity"), *w = case_field(&c, "spin");
    for (int n = 0; n < c.bed.count; n++) {
        assert_true(x[3 * n + 2] == 0.0 && v[3 * n + 2] == 0.0);
        assert_true(w[3 * n] == 0.0 && w[3 * n + 1] == 0.0 && w[3 * n + 2] != 0.0);
    }
    free(x);
    free(v);
    free(w);
    case_close(&c);
}

/* Programs of two dimensions leave out what is 0, and nothing else: the same grains in three give the same numbers, forces and torques included. */
static physics_case tray(int dimensions)
{
    text t = head();
    put(&t, "dimensions: %d\ngravity_m_s2: [0.3, -9.81, 0]\nwalls: [{name: tray, shape: box, low_m: [0, 0, -0.01], high_m: [0.02, 0.02, 0.01], open: "
            "[y_high]}]\nparticles:\n  - name: p\n    material: m\n    generator: list\n    items:\n", dimensions);
    for (int n = 0; n < 24; n++)
        put_grain(&t, (n % 3 ? 1.0 : 0.8) * radius, (double[]){2.2 * radius * (1 + n % 8), 2.2 * radius * (1 + n / 8), 0},
                  (double[]){0.2 * cos(n), -0.3 + 0.2 * sin(n), 0}, (double[]){0, 0, 50.0 * cos(3 * n)});
    return case_open(&t);
}

static void test_plane_is_part_of_space(void **state)
{
    (void)state;
    double *x[2], *w[2], *total[2][2];
    int count = 0;
    for (int d = 0; d < 2; d++) {
        physics_case c = tray(2 + d);
        run_touching(&c, 1500);
        count = c.bed.count;
        x[d] = case_field(&c, "position");
        w[d] = case_field(&c, "spin");
        for (int torque = 0; torque < 2; torque++)
            MUST(observe_totals(c.sim, torque, &total[d][torque], why));
        case_close(&c);
    }
    double pushed = 0.0, turned = 0.0;
    for (int n = 0; n < 3 * count; n++) {
        pushed = fmax(pushed, fabs(total[1][0][n]));
        turned = fmax(turned, fabs(total[1][1][n]));
    }
    assert_true(pushed > 0.0 && turned > 0.0);
    for (int n = 0; n < 3 * count; n++) {
        NEAR(x[0][n], x[1][n], grown() * radius);
        NEAR(w[0][n], w[1][n], grown() * speed / radius);
        NEAR(total[0][0][n], total[1][0][n], 100.0 * grown() * pushed);
        NEAR(total[0][1][n], total[1][1][n], 100.0 * grown() * turned);
    }
    for (int d = 0; d < 2; d++) {
        free(x[d]);
        free(w[d]);
        free(total[d][0]);
        free(total[d][1]);
    }
}

/* A cluster cut by the faces of a periodic box moves as the one in the open. */
static void test_periodic(void **state)
{
    (void)state;
    cluster bed = cluster_make(3, radius, speed, 200.0, 5);
    double length = 0.02, *x[2], *v[2];
    for (int s = 0; s < 2; s++) {
        cluster wrapped = bed;
        text t = head();
        if (s) {
            put(&t, "domain: {low_m: [0, 0, 0], high_m: [%g, %g, %g], periodic: [x, y, z]}\n", length, length, length);
            for (int n = 0; n < bed.count; n++)
                for (int k = 0; k < 3; k++)
                    wrapped.position[n][k] = fmod(bed.position[n][k] + length, length);
        }
        put_cluster(&t, &wrapped);
        physics_case c = case_open(&t);
        run_touching(&c, 1500);
        x[s] = case_field(&c, "position");
        v[s] = case_field(&c, "velocity");
        case_close(&c);
    }
    for (int n = 0; n < 3 * bed.count; n++) {
        double apart = x[1][n] - x[0][n];
        NEAR(apart - length * rint(apart / length), 0.0, grown() * radius);
        NEAR(v[1][n], v[0][n], grown() * speed);
        assert_true(x[1][n] >= 0.0 && x[1][n] < length);
    }
    for (int s = 0; s < 2; s++) {
        free(x[s]);
        free(v[s]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mirror),
        cmocka_unit_test(test_rotation),
        cmocka_unit_test(test_order),
        cmocka_unit_test(test_swapped_pair),
        cmocka_unit_test(test_rest),
        cmocka_unit_test(test_rest_apart),
        cmocka_unit_test(test_plane_stays_plane),
        cmocka_unit_test(test_plane_is_part_of_space),
        cmocka_unit_test(test_periodic),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
