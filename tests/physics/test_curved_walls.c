/* Cylinders and cones: faces and rims on both sides, seams with other walls, contacts against brute force, and motion on them against closed
 * forms. */
#include "case.h"

static const double young = 1.0e7, density = 2500.0, radius = 1.0e-3, gravity = 9.81;
static const double none[3] = {0, 0, 0};

static double modulus(void)
{
    return young / (1.0 - 0.09);
}

static double hertz(double overlap)
{
    return overlap > 0.0 ? 4.0 / 3.0 * modulus() * sqrt(radius) * pow(overlap, 1.5) : 0.0;
}

static text head(const char *effects, const char *interaction)
{
    text t = {0};
    put(&t, "effects:\n  - {slot: normal, law: hertz}\n%s", effects);
    put(&t, "materials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: %g, poissons_ratio: 0.3}]\n", density, young);
    put(&t, "interactions: [{between: default, %s}]\n", interaction);
    return t;
}

static void put_group(text *t)
{
    put(t, "particles:\n  - name: p\n    material: m\n    generator: list\n    items:\n");
}

#define FRICTION "  - {slot: tangential, law: mindlin}\n"

/* ---- faces and rims ---- */

typedef struct placed {
    double x[3], toward[3]; /* centre; direction from the nearest point to the centre */
    double distance;
} placed;

/* Force on each grain, all apart, against Hertz at its distance from the nearest point; `contacts` in all. */
static void check_forces(const char *walls, const placed *rows, int count, int contacts)
{
    int64_t found;
    text t = head("", "normal_damping_ratio: 0");
    put(&t, "%s", walls);
    put_group(&t);
    for (int k = 0; k < count; k++)
        put_grain(&t, radius, rows[k].x, none, none);
    physics_case c = case_open(&t);
    double *force = case_totals(&c, false);
    for (int k = 0; k < count; k++) {
        double length = sqrt(pow(rows[k].toward[0], 2) + pow(rows[k].toward[1], 2) + pow(rows[k].toward[2], 2));
        double expected = hertz(radius - rows[k].distance);
        for (int a = 0; a < 3; a++)
            NEAR(force[3 * k + a], expected * rows[k].toward[a] / length, within(1e-9, LAW) * hertz(0.1 * radius));
    }
    live_contact *live = case_contacts(&c, &found);
    assert_int_equal(found, contacts);
    free(live);
    free(force);
    case_close(&c);
}

static const double near_by = 0.95e-3, apart = 1.05e-3;

static void test_cylinder(void **state)
{
    (void)state;
    const double big = 0.02, d = near_by / sqrt(2.0), c = cos(0.7), s = sin(0.7);
    const placed rows[] = {
        {{(big - near_by) * c, (big - near_by) * s, 0.01}, {-c, -s, 0}, near_by},     /* inside */
        {{-(big + near_by) * c, -(big + near_by) * s, 0.04}, {-c, -s, 0}, near_by},   /* outside */
        {{0, big - apart, 0.02}, {0, -1, 0}, apart},                                  /* inside, not touching */
        {{big * c, big * s, 0.05 + near_by}, {0, 0, 1}, near_by},                     /* on the rim */
        {{(big - d) * s, (big - d) * c, -d}, {-s, -c, -1}, near_by},                  /* on the other rim, from within */
        {{-(big + d) * s, -(big + d) * c, 0.05 + d}, {-s, -c, 1}, near_by},           /* from without */
        {{-big * c, big * s, -apart}, {0, 0, -1}, apart},                             /* just off a rim */
        {{0, 0, 0.025}, {0, 0, 1}, big},                                              /* on the axis: touches nothing */
        {{big * s, -big * c, 0.0501 + apart * 40}, {0, 0, 1}, 1.0},                   /* far beyond the end */
    };
    check_forces("walls: [{name: w, shape: cylinder, side: inside, axis_point_m: [0, 0, 0], axis: [0, 0, 2], radius_m: 0.02, length_m: 0.05}]\n",
                 rows, COUNT_OF(rows), 5);
    check_forces("walls: [{name: w, shape: cylinder, side: outside, axis_point_m: [0, 0, 0.05], axis: [0, 0, -1], radius_m: 0.02, length_m: 0.05}]\n",
                 rows, COUNT_OF(rows), 5);
}

/* Opens from 5 mm at z = 0 to 20 mm at z = 20 mm. */
static void test_cone(void **state)
{
    (void)state;
    const double slant = hypot(0.02, 0.015), up = 0.02 / slant, off = 0.015 / slant, c = cos(2.0), s = sin(2.0), d = near_by / sqrt(2.0);
    const double z = 0.008, r = 0.005 + 0.75 * z; /* on the face; inward normal (-up radially, off along the axis) */
    const placed rows[] = {
        {{(r - near_by * up) * c, (r - near_by * up) * s, z + near_by * off}, {-up * c, -up * s, off}, near_by},
        {{-(r + near_by * up) * c, -(r + near_by * up) * s, z - near_by * off}, {-up * c, -up * s, -off}, near_by},
        {{(r - apart * up) * s, -(r - apart * up) * c, z + apart * off}, {0, 0, 1}, apart},
        {{0.005 * s, -0.005 * c, -near_by}, {0, 0, -1}, near_by},                                     /* below the narrow rim */
        {{(0.02 + d) * c, (0.02 + d) * s, 0.02 + d}, {c, s, 1}, near_by},                             /* outside of the wide one */
        {{-0.02 * c, -0.02 * s, 0.02 + near_by}, {0, 0, 1}, near_by},                                 /* above it */
    };
    check_forces("walls: [{name: w, shape: cone, side: inside, axis_point_m: [0, 0, 0], axis: [0, 0, 1], radius_m: [0.005, 0.02], length_m: 0.02}]\n",
                 rows, COUNT_OF(rows), 5);
    check_forces("walls: [{name: w, shape: cone, side: outside, axis_point_m: [0, 0, 0.02], axis: [0, 0, -1], radius_m: [0.02, 0.005], length_m: 0.02}]\n",
                 rows, COUNT_OF(rows), 5);
}

/* A drum with its ends closed: in the corner both walls press, each with its own normal; at the seam from without there is one contact. */
static void test_drum_corner(void **state)
{
    (void)state;
    const double big = 0.02, c = cos(0.4), s = sin(0.4), d = near_by / sqrt(2.0);
    int64_t count;
    text t = head("", "normal_damping_ratio: 0");
    put(&t, "walls:\n"
            "  - {name: drum, shape: cylinder, axis_point_m: [0, 0, 0], axis: [0, 1, 0], radius_m: 0.02, length_m: 0.05}\n"
            "  - {name: front, shape: disc, center_m: [0, 0, 0], normal: [0, 1, 0], radius_m: 0.02}\n"
            "  - {name: back, shape: disc, center_m: [0, 0.05, 0], normal: [0, 1, 0], radius_m: 0.02}\n");
    put_group(&t);
    put_grain(&t, radius, (double[]){(big - near_by) * c, near_by, (big - near_by) * s}, none, none);
    put_grain(&t, radius, (double[]){-(big - near_by) * c, 0.05 - near_by, (big - near_by) * s}, none, none);
    put_grain(&t, radius, (double[]){(big + d) * s, -d, (big + d) * c}, none, none);
    put_grain(&t, radius, (double[]){big * s, 0.05 + near_by, -big * c}, none, none); /* right over the seam */
    physics_case p = case_open(&t);
    double *f = case_totals(&p, false), n = hertz(radius - near_by), h = n / sqrt(2.0);
    const double expected[4][3] = {{-n * c, n, -n * s}, {n * c, -n, -n * s}, {h * s, -h, h * c}, {0, n, 0}};
    for (int k = 0; k < 4; k++)
        for (int a = 0; a < 3; a++)
            NEAR(f[3 * k + a], expected[k][a], within(1e-9, LAW) * n);
    live_contact *live = case_contacts(&p, &count);
    assert_int_equal(count, 6);
    free(live);
    free(f);
    case_close(&p);
}

/* ---- against brute force ---- */

/* Distance of a point from a wall of revolution, by a search along its length and around it: no formula of the kernels. */
static double searched_distance(const double *x, const double *base, const double *axis, double length, double first, double last)
{
    double e1[3], e2[3], pick[3] = {0, 0, 0}, best = 1e30, best_t = 0.0, best_a = 0.0;
    pick[fabs(axis[0]) < 0.7 ? 0 : 1] = 1.0;
    for (int k = 0; k < 3; k++)
        e1[k] = axis[(k + 1) % 3] * pick[(k + 2) % 3] - axis[(k + 2) % 3] * pick[(k + 1) % 3];
    double scale = 1.0 / sqrt(e1[0] * e1[0] + e1[1] * e1[1] + e1[2] * e1[2]);
    for (int k = 0; k < 3; k++)
        e1[k] *= scale;
    for (int k = 0; k < 3; k++)
        e2[k] = axis[(k + 1) % 3] * e1[(k + 2) % 3] - axis[(k + 2) % 3] * e1[(k + 1) % 3];
    double wide_t = 0.5, wide_a = PI, centre_t = 0.5, centre_a = 0.0;
    for (int level = 0; level < 26; level++) {
        for (int i = -6; i <= 6; i++)
            for (int j = -6; j <= 6; j++) {
                double t = fmin(1.0, fmax(0.0, centre_t + wide_t * i / 6.0)), a = centre_a + wide_a * j / 6.0, sum = 0.0;
                double r = first + t * (last - first);
                for (int k = 0; k < 3; k++)
                    sum += pow(base[k] + t * length * axis[k] + r * (cos(a) * e1[k] + sin(a) * e2[k]) - x[k], 2);
                if (sum < best) {
                    best = sum;
                    best_t = t;
                    best_a = a;
                }
            }
        centre_t = best_t;
        centre_a = best_a;
        wide_t *= 0.45;
        wide_a *= 0.45;
    }
    return sqrt(best);
}

/* A lattice of grains across tilted walls, one cylinder and one cone: which touch which, and by how much. */
static void test_against_brute_force(void **state)
{
    (void)state;
    const double base[2][3] = {{-0.012, 0.003, -0.011}, {0.03, 0.01, -0.005}}, length[2] = {0.021, 0.017};
    const double first[2] = {0.009, 0.0041}, last[2] = {0.009, 0.0113};
    double axis[2][3] = {{0.3, -0.2, 0.9}, {-0.5, 0.4, 0.3}};
    text t = head("", "normal_damping_ratio: 0");
    for (int w = 0; w < 2; w++) {
        double scale = 1.0 / sqrt(pow(axis[w][0], 2) + pow(axis[w][1], 2) + pow(axis[w][2], 2));
        for (int k = 0; k < 3; k++)
            axis[w][k] *= scale;
    }
    put(&t, "walls:\n  - {name: a, shape: cylinder, axis_point_m: [%.17g, %.17g, %.17g], axis: [%.17g, %.17g, %.17g], radius_m: 0.009, length_m: 0.021}\n",
        base[0][0], base[0][1], base[0][2], axis[0][0], axis[0][1], axis[0][2]);
    put(&t, "  - {name: b, shape: cone, side: outside, axis_point_m: [%.17g, %.17g, %.17g], axis: [%.17g, %.17g, %.17g], radius_m: [0.0041, 0.0113], "
            "length_m: 0.017}\n",
        base[1][0], base[1][1], base[1][2], axis[1][0], axis[1][1], axis[1][2]);
    put(&t, "contact_table: {skin_m: 1.0e-4}\n");
    put(&t, "particles: [{name: p, material: m, generator: lattice, counts: [26, 16, 16], spacing_m: 2.21e-3, origin_m: [-0.026, -0.015, -0.016], "
            "radius_m: 1.0e-3}]\n");
    physics_case c = case_open(&t);
    double *x = case_field(&c, "position");
    int64_t count, expected = 0, k = 0;
    live_contact *live = case_contacts(&c, &count);
    for (int n = 0; n < 26 * 16 * 16; n++)
        for (int w = 0; w < 2; w++) {
            double distance = searched_distance(x + 3 * n, base[w], axis[w], length[w], first[w], last[w]);
            if (fabs(distance - radius) < 1e-9 || distance > radius)
                continue;
            expected++;
            for (k = 0; k < count && !(live[k].i == n && live[k].wall == w); k++)
                ;
            if (k == count)
                fail_msg("grain %d misses wall %d, %g m away", n, w, distance);
            NEAR(live[k].overlap, radius - distance, 2e-9);
        }
    assert_int_equal(count, expected);
    assert_true(count > 200);
    free(live);
    free(x);
    case_close(&c);
}

/* ---- motion ---- */

/* Time of the first passage of x through 0 from positive side, by linear interpolation; a quarter of the period. */
static double quarter(physics_case *c, double dt, int64_t most)
{
    double before = case_get(c, "position", 0, 0);
    for (int64_t n = 0; n < most; n += 20) {
        case_run(c, 20, dt);
        double now = case_get(c, "position", 0, 0);
        if (now <= 0.0)
            return c->sim->time - 20 * dt * now / (now - before);
        before = now;
    }
    fail_msg("the grain has not come to the bottom");
    return 0.0;
}

/* A sphere in the bottom of a lying cylinder: omega^2 = g/(R - r) when it slides, 5/7 of that when it rolls. */
static void check_period(bool rolls)
{
    const double big = 0.02, amplitude = 0.04, dt = 1.0e-5, m = sphere_mass(density, radius);
    double way = big - radius + hertz_rest(modulus(), radius, m * gravity * cos(amplitude));
    text t = head(rolls ? FRICTION : "", rolls ? "normal_damping_ratio: 0.3, friction_static: 0.8" : "normal_damping_ratio: 0.3");
    put(&t, "gravity_m_s2: [0, 0, -9.81]\n"
            "walls: [{name: w, shape: cylinder, axis_point_m: [0, -0.05, 0], axis: [0, 1, 0], radius_m: 0.02, length_m: 0.1}]\n");
    put_group(&t);
    put_grain(&t, radius, (double[]){way * sin(amplitude), 0, -way * cos(amplitude)}, none, none);
    physics_case c = case_open(&t);
    double omega = sqrt(gravity / (rolls ? 1.4 : 1.0) / way);
    double expected = 0.5 * PI / omega * (1.0 + amplitude * amplitude / 16.0);
    RELATIVE(quarter(&c, dt, 40000), expected, 2e-3);
    if (rolls) /* without slip: the surface moves with the centre against the wall */
        RELATIVE(case_get(&c, "spin", 0, 1), case_get(&c, "velocity", 0, 0) / radius, 5e-3);
    case_close(&c);
}

static void test_slides_in_cylinder(void **state)
{
    (void)state;
    check_period(false);
}

static void test_rolls_in_cylinder(void **state)
{
    (void)state;
    check_period(true);
}

/* Round and round in a cone at one height: N sin a carries the weight, N cos a bends the path, v^2 = g rho/tan a (a half the opening). */
static void test_orbit_in_cone(void **state)
{
    (void)state;
    const double half = 0.5, rho = 0.02, dt = 1.0e-5, m = sphere_mass(density, radius);
    double v = sqrt(gravity * rho / tan(half)), press = m * gravity / sin(half), gap = radius - hertz_rest(modulus(), radius, press);
    double z = (rho + gap / cos(half)) / tan(half); /* of the centre: gap away from the face, measured along its normal */
    text t = head("", "normal_damping_ratio: 0");
    put(&t, "gravity_m_s2: [0, 0, -9.81]\nwalls: [{name: w, shape: cone, axis_point_m: [0, 0, 0], axis: [0, 0, 1], radius_m: [0, %.17g], length_m: 0.1}]\n",
        0.1 * tan(half));
    put_group(&t);
    put_grain(&t, radius, (double[]){rho, 0, z}, (double[]){0, v, 0}, none);
    physics_case c = case_open(&t);
    double *f = case_totals(&c, false);
    RELATIVE(f[2], m * gravity, within(1e-6, LAW));
    RELATIVE(f[0], -m * v * v / rho, 1e-6);
    free(f);
    double turn = 2.0 * PI * rho / v;
    for (int k = 0; k < 4; k++) {
        case_run(&c, (int64_t)round(turn / dt) / 2, dt);
        NEAR(case_get(&c, "position", 0, 2), z, 2e-3 * rho);
        NEAR(hypot(case_get(&c, "position", 0, 0), case_get(&c, "position", 0, 1)), rho, 2e-3 * rho);
        NEAR(case_get(&c, "position", 0, 0), k % 2 ? rho : -rho, 2e-3 * rho);
    }
    case_close(&c);
}

/* A sphere let fall into an upright cone comes to rest wedged on the axis: the two contacts that stand for the ring each bear
 * m g/(2 sin a). In mixed precision it goes on circling the axis at some roundings of its radius (4e-7 of it), which is 1.4e-3 of the force. */
static void test_wedged_in_cone(void **state)
{
    (void)state;
    const double half = 0.6, m = sphere_mass(density, radius);
    int64_t count;
    text t = head("", "normal_damping_ratio: 0.4");
    put(&t, "gravity_m_s2: [0, 0, -9.81]\nwalls: [{name: w, shape: cone, axis_point_m: [0, 0, 0], axis: [0, 0, 1], radius_m: [0, %.17g], length_m: 0.01}]\n",
        0.01 * tan(half));
    put_group(&t);
    put_grain(&t, radius, (double[]){1.0e-4, 0.5e-4, radius / sin(half) + 2e-4}, none, none);
    physics_case c = case_open(&t);
    case_run(&c, 20000, 1.0e-5);
    live_contact *live = case_contacts(&c, &count);
    assert_int_equal(count, 2);
    double press = m * gravity / (2.0 * sin(half)), overlap = hertz_rest(modulus(), radius, press);
    for (int k = 0; k < 2; k++) {
        RELATIVE(sqrt(pow(live[k].force[0], 2) + pow(live[k].force[1], 2) + pow(live[k].force[2], 2)), press, within(1e-3, 1.5 * 10.0 * radius / overlap));
        RELATIVE(live[k].force[2], 0.5 * m * gravity, within(1e-3, 1.5 * 10.0 * radius / overlap));
    }
    free(live);
    NEAR(case_get(&c, "position", 0, 2), (radius - overlap) / sin(half), 1e-3 * overlap);
    NEAR(case_get(&c, "position", 0, 0), 0.0, 1e-2 * overlap);
    NEAR(case_get(&c, "position", 0, 1), 0.0, 1e-2 * overlap);
    NEAR(case_get(&c, "velocity", 0, 2), 0.0, 1e-6);
    case_close(&c);
}

/* On the rim of a hole in a flat funnel: the two contacts on the rim, up at an angle phi from its middle with sin phi = a/r, bear
 * m g/(2 cos phi) each. */
static void test_sits_on_rim(void **state)
{
    (void)state;
    const double hole = 0.6 * radius, m = sphere_mass(density, radius);
    int64_t count;
    text t = head("", "normal_damping_ratio: 0.4");
    put(&t, "gravity_m_s2: [0, 0, -9.81]\nwalls: [{name: w, shape: cone, axis_point_m: [0, 0, 0], axis: [0, 0, 1], radius_m: [%.17g, 0.006], length_m: 0.002}]\n",
        hole);
    put_group(&t);
    put_grain(&t, radius, (double[]){0.5e-4, 1.0e-4, 0.8 * radius + 1e-4}, none, none);
    physics_case c = case_open(&t);
    case_run(&c, 20000, 1.0e-5);
    live_contact *live = case_contacts(&c, &count);
    assert_int_equal(count, 2);
    for (int k = 0; k < 2; k++) {
        RELATIVE(live[k].force[2], 0.5 * m * gravity, 1e-3);
        RELATIVE(hypot(live[k].force[0], live[k].force[1]), 0.5 * m * gravity * 0.75, 2e-3); /* tan phi */
    }
    free(live);
    case_close(&c);
}

/* In a lying cone whose lowest line is level a sphere stays where it is and presses with its weight. */
static void test_rests_on_level_line(void **state)
{
    (void)state;
    const double widen = 0.2, m = sphere_mass(density, radius), overlap = hertz_rest(modulus(), radius, m * gravity);
    double tilt = atan(widen), length = 0.1; /* the axis climbs by as much as the cone widens */
    text t = head("", "normal_damping_ratio: 0.3");
    put(&t, "gravity_m_s2: [0, 0, -9.81]\nwalls: [{name: w, shape: cone, axis_point_m: [0, 0, 0], axis: [%.17g, 0, %.17g], radius_m: [0.01, %.17g], length_m: %g}]\n",
        cos(tilt), sin(tilt), 0.01 + widen * length, length);
    put_group(&t);
    /* lowest line: s (cos, sin) + (0.01 + widen s) (sin, -cos), with tan = widen: level, at z = -0.01 cos */
    put_grain(&t, radius, (double[]){0.05, 0, -0.01 * cos(tilt) + radius - overlap}, none, none);
    physics_case c = case_open(&t);
    double *f = case_totals(&c, false);
    RELATIVE(f[2], m * gravity, within(1e-6, LAW));
    NEAR(f[0], 0.0, within(1e-9, LAW) * m * gravity);
    free(f);
    case_run(&c, 5000, 1.0e-5);
    NEAR(case_get(&c, "position", 0, 0), 0.05, 1e-9);
    NEAR(case_get(&c, "position", 0, 2), -0.01 * cos(tilt) + radius - overlap, 1e-3 * overlap);
    case_close(&c);
}

/* A drum starts to turn under a sphere at rest: while it slips, mu g drags it along and 5 mu g/(2 r) spins it up. The drum as a surface stays
 * where it is, and no table is built for it. */
static void test_drum_drags(void **state)
{
    (void)state;
    const double big = 0.05, rate = 40.0, mu = 0.3, dt = 2.0e-6, time = 2.0e-3, m = sphere_mass(density, radius);
    text t = head(FRICTION, "normal_damping_ratio: 0.5, friction_static: 0.3");
    put(&t, "gravity_m_s2: [0, 0, -9.81]\ncontact_table: {skin_m: 1.0e-4}\n"
            "walls: [{name: w, shape: cylinder, axis_point_m: [0, -0.05, 0], axis: [0, 1, 0], radius_m: 0.05, length_m: 0.1, "
            "motion: [{type: rotation, point_m: [0, 0, 0], axis: [0, 1, 0], rate_rad_s: 40}]}]\n");
    put_group(&t);
    put_grain(&t, radius, (double[]){0, 0, -(big - radius + hertz_rest(modulus(), radius, m * gravity))}, none, none);
    physics_case c = case_open(&t);
    int64_t rebuilds = c.sim->rebuilds;
    case_run(&c, (int64_t)round(time / dt), dt);
    assert_true(rate * big > 3.5 * mu * gravity * time); /* still slipping */
    /* the bottom of a drum that turns about +y moves towards -x: (0, w, 0) x (0, 0, -R) = (-w R, 0, 0) */
    RELATIVE(case_get(&c, "velocity", 0, 0), -mu * gravity * time, 1e-2);
    RELATIVE(case_get(&c, "spin", 0, 1), 2.5 * mu * gravity / radius * time, 1e-2);
    assert_int_equal(c.sim->rebuilds, rebuilds);
    case_close(&c);
}

/* A spring stretched at a wall turns with the centre's way about the axis. A sphere held by friction to a drum that turns as one with it
 * comes round with its spring as it was: it stays at rest in the drum's frame without gravity. */
static void test_carried_round(void **state)
{
    (void)state;
    const double big = 0.02, rate = 30.0, m = sphere_mass(density, radius), dt = 5.0e-6;
    /* the wall's push bends the path: N = m w^2 (R - r + d) */
    double overlap = hertz_rest(modulus(), radius, m * rate * rate * (big - radius));
    double way = big - radius + overlap;
    text t = head(FRICTION, "normal_damping_ratio: 0.3, friction_static: 0.5");
    put(&t, "walls: [{name: w, shape: cylinder, axis_point_m: [0, 0, -0.05], axis: [0, 0, 1], radius_m: 0.02, length_m: 0.1, "
            "motion: [{type: rotation, point_m: [0, 0, 0], axis: [0, 0, 1], rate_rad_s: 30}]}]\n");
    put_group(&t);
    put_grain(&t, radius, (double[]){way, 0, 0}, (double[]){0, rate * way, 0}, (double[]){0, 0, rate});
    physics_case c = case_open(&t);
    case_run(&c, (int64_t)round(2.0 * PI / rate / dt), dt);
    double angle = atan2(case_get(&c, "position", 0, 1), case_get(&c, "position", 0, 0)), expected = rate * c.sim->time - 2.0 * PI;
    NEAR(angle, expected, 2e-3);
    RELATIVE(case_get(&c, "spin", 0, 2), rate, 1e-3);
    RELATIVE(hypot(case_get(&c, "position", 0, 0), case_get(&c, "position", 0, 1)), way, 1e-4);
    case_close(&c);
}

/* A sphere on the wall of a drum that turns about an upright axis is held up by friction, whose moment about its centre the rolling spring
 * bears: m g r about the azimuth. Both springs come round with the wall, and the sphere neither slides nor rolls down. In a cone it creeps, as
 * an effect of the step: the velocity of semi-implicit Euler is that of the chord, which leaves the circle by w dt/2, and the part of that
 * along the meridian feeds the spring. */
static void check_rotor(const char *shape, double x, double z, double up, double off)
{
    const double rate = 60.0, dt = 1.0e-5, m = sphere_mass(density, radius);
    text t = {0};
    put(&t, "gravity_m_s2: [0, 0, -9.81]\neffects:\n  - {slot: normal, law: hertz}\n" FRICTION "  - {slot: rolling, law: elastic_plastic}\n");
    put(&t, "materials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: %g, poissons_ratio: 0.3}]\n", density, young);
    put(&t, "interactions: [{between: default, normal_damping_ratio: 0.3, friction_static: 0.9, rolling_friction: 0.9}]\n");
    put(&t, "walls: [{name: w, axis_point_m: [0, 0, -0.05], axis: [0, 0, 1], %s, motion: [{type: rotation, point_m: [0, 0, 0], axis: [0, 0, 1], rate_rad_s: %g}]}]\n", shape, rate);
    put_group(&t);
    put_grain(&t, radius, (double[]){x, 0, z}, (double[]){0, rate * x, 0}, (double[]){0, 0, rate});
    physics_case c = case_open(&t);
    case_run(&c, 5000, dt); /* settles */
    double before = case_get(&c, "position", 0, 2), moment, force[3];
    case_run(&c, (int64_t)round(2.25 * 2.0 * PI / rate / dt), dt);
    double creep = 0.5 * rate * rate * x * dt * off * up * 2.25 * 2.0 * PI / rate;
    NEAR(case_get(&c, "position", 0, 2), before - creep, 1e-2 * creep + 1e-8);
    RELATIVE(case_get(&c, "spin", 0, 2), rate, 1e-3);
    /* what it takes on the circle: the contact's force is m (w^2 rho inwards, g upwards) */
    double px = case_get(&c, "position", 0, 0), py = case_get(&c, "position", 0, 1), rho = hypot(px, py), *f = case_totals(&c, false), *w = case_totals(&c, true);
    force[0] = (f[0] * px + f[1] * py) / rho;
    force[1] = (-f[0] * py + f[1] * px) / rho;
    force[2] = f[2];
    moment = hypot(hypot(w[0], w[1]), w[2]);
    RELATIVE(force[0], -m * rate * rate * rho, 2e-3);
    NEAR(force[1], 0.0, 2e-3 * m * rate * rate * rho);
    RELATIVE(force[2], m * 9.81, 2e-3);
    NEAR(moment, 0.0, 2e-3 * m * 9.81 * radius);
    free(f);
    free(w);
    case_close(&c);
}

static void test_rotor(void **state)
{
    (void)state;
    const double slant = hypot(0.1, 0.02), up = 0.1 / slant, off = 0.02 / slant, gap = 0.99e-3;
    check_rotor("shape: cylinder, radius_m: 0.02, length_m: 0.1", 0.02 - gap, 0, 1, 0);
    check_rotor("shape: cone, radius_m: [0.01, 0.03], length_m: 0.1", 0.02 - gap * up, gap * off, up, off);
}

/* A piece of pipe that flies across hits a sphere at rest: 2 u, from within and from without. */
static void test_flying_pipe(void **state)
{
    (void)state;
    const double u = 0.4, duration = hertz_duration(modulus(), radius, sphere_mass(density, radius), u);
    for (int outside = 0; outside < 2; outside++) {
        text t = head("", "normal_damping_ratio: 0");
        put(&t, "walls: [{name: w, shape: cylinder, side: %s, axis_point_m: [0, 0, -0.05], axis: [0, 0, 1], radius_m: 0.02, length_m: 0.1, "
                "motion: [{type: constant, velocity_m_s: [%g, 0, 0.7]}]}]\n", outside ? "outside" : "inside", u);
        put_group(&t);
        put_grain(&t, radius, (double[]){outside ? 0.02 + radius : -0.02 + radius, 0, 0}, none, none);
        physics_case c = case_open(&t);
        case_run(&c, 1100, duration / 1000);
        RELATIVE(case_get(&c, "velocity", 0, 0), 2.0 * u, 1e-5);
        NEAR(case_get(&c, "velocity", 0, 1), 0.0, 1e-12);
        NEAR(case_get(&c, "velocity", 0, 2), 0.0, 1e-12);
        case_close(&c);
    }
}

/* A sphere that does not fit is refused, with the place of the wall. */
static void test_does_not_fit(void **state)
{
    (void)state;
    failure why = {{0}};
    scene *scene = NULL;
    bed bed = {0};
    simulation *sim = NULL;
    text t = head("", "normal_damping_ratio: 0");
    put(&t, "walls:\n  - {name: pipe, shape: cylinder, axis_point_m: [0, 0, 0], axis: [0, 0, 1], radius_m: 1.0e-3, length_m: 0.1}\n");
    put_group(&t);
    put_grain(&t, radius, none, none, none);
    put(&t, "\nstages: [{name: run, until: {steps: 1}}]\n");
    MUST(scene_read_text(t.at, "case.yaml", 0, NULL, &scene, why));
    MUST(bed_generate(scene, &bed, why));
    assert_int_equal(simulation_create(scene, &bed, case_device(), NULL, &sim, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.text, "case.yaml:6:5: the wall `pipe` holds spheres of a radius below 0.001 m inside"));
    simulation_free(sim);
    bed_free(&bed);
    scene_free(scene);
    free(t.at);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cylinder),
        cmocka_unit_test(test_cone),
        cmocka_unit_test(test_drum_corner),
        cmocka_unit_test(test_against_brute_force),
        cmocka_unit_test(test_slides_in_cylinder),
        cmocka_unit_test(test_rolls_in_cylinder),
        cmocka_unit_test(test_orbit_in_cone),
        cmocka_unit_test(test_wedged_in_cone),
        cmocka_unit_test(test_sits_on_rim),
        cmocka_unit_test(test_rests_on_level_line),
        cmocka_unit_test(test_drum_drags),
        cmocka_unit_test(test_carried_round),
        cmocka_unit_test(test_rotor),
        cmocka_unit_test(test_flying_pipe),
        cmocka_unit_test(test_does_not_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
