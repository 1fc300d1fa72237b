/* Walls: prescribed motions against their closed forms, faces, edges and corners of rectangles and discs, seams, boxes, and what the wall
 * feels. */
#include "case.h"

static const double young = 1.0e7, density = 2500.0, radius = 1.0e-3;

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

/* Far from everything: cases with as many walls share a program. */
#define TWO_MORE                                                                         \
    "  - {name: far, shape: rectangle, corners_m: [[9, 0, 0], [10, 0, 0], [9, 1, 0]]}\n" \
    "  - {name: farther, shape: rectangle, corners_m: [[19, 0, 0], [20, 0, 0], [19, 1, 0]]}\n"

static void put_group(text *t)
{
    put(t, "particles:\n  - name: p\n    material: m\n    generator: list\n    items:\n");
}

static const double none[3] = {0, 0, 0};

#define FRICTION "  - {slot: tangential, law: mindlin}\n"
#define ROLLING  "  - {slot: rolling, law: elastic_plastic}\n"

/* ---- motions ---- */

/* An elastic hit by a wall that comes up at u: the grain at rest leaves with 2 u. */
static void test_constant(void **state)
{
    (void)state;
    double u = 0.5, duration = hertz_duration(modulus(), radius, sphere_mass(density, radius), u);
    text t = head("", "normal_damping_ratio: 0");
    put(&t,
        "walls: [{name: w, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1], motion: [{type: constant, velocity_m_s: [3, 0, %g]}]}]\n",
        u);
    put_group(&t);
    put_grain(&t, radius, (double[]){0, 0, radius}, none, none);
    physics_case c = case_open(&t);
    case_run(&c, 1100, duration / 1000);
    RELATIVE(case_get(&c, "velocity", 0, 2), 2.0 * u, 2e-6);
    assert_true(case_get(&c, "velocity", 0, 0) == 0.0);
    case_close(&c);
}

/* A grain that lies on a plate is carried by it, and follows it while the acceleration stays below g: position within the overlap's
 * variation. */
#define CARRY_DT 1.0e-5
static physics_case carried(const char *motion)
{
    double m = sphere_mass(density, radius);
    text t = head("", "normal_damping_ratio: 0.5");
    put(&t, "gravity_m_s2: [0, 0, -9.81]\nwalls: [{name: w, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1], motion: [%s]}]\n", motion);
    put_group(&t);
    put_grain(&t, radius, (double[]){0, 0, radius - hertz_rest(modulus(), radius, m * 9.81)}, none, none);
    return case_open(&t);
}

static void test_sinusoid(void **state)
{
    (void)state;
    const double amplitude = 1.0e-4, frequency = 20.0, phase = -0.5 * PI, omega = 2.0 * PI * frequency; /* 1.58 m/s2 */
    char motion[256];
    snprintf(motion, sizeof motion,
             "{type: sinusoid, direction: [0, 0, 1], amplitude_m: %g, frequency_hz: %g, phase_rad: %.17g}, "
             "{type: constant, velocity_m_s: [0, 0, 0.01]}",
             amplitude, frequency, phase);
    physics_case c = carried(motion);
    /* the wall starts at -A: let the grain drop on it and calm down */
    case_run(&c, 5000, CARRY_DT);
    for (int k = 0; k < 20; k++) {
        case_run(&c, 250, CARRY_DT);
        double t = c.sim->time, m = sphere_mass(density, radius), lift = -amplitude * omega * omega * sin(omega * t + phase);
        double wall = amplitude * sin(omega * t + phase) + 0.01 * t;
        /* quasi-static on the moving plate: the frame of the plate has the weight m (g + a) */
        NEAR(case_get(&c, "position", 0, 2), wall + radius - hertz_rest(modulus(), radius, m * (9.81 + lift)), 5e-9);
        NEAR(case_get(&c, "velocity", 0, 2), amplitude * omega * cos(omega * t + phase) + 0.01, 2e-5);
    }
    case_close(&c);
}

/* Velocity linear between the rows of the table, constant outside: the way is its integral. */
static void test_table(void **state)
{
    (void)state;
    physics_case c = carried("{type: table, time_s: [0.02, 0.04, 0.07], velocity_m_s: [[0, 0, 0], [0, 0, 0.05], [0, 0, -0.01]]}");
    const double at[] = {0.02, 0.03, 0.04, 0.05, 0.08},
                 way[] = {0.0, 0.5 * 0.01 * 0.025, 0.5 * 0.02 * 0.05, 0.5 * 0.02 * 0.05 + 0.01 * 0.5 * (0.05 + 0.03),
                          0.5 * 0.02 * 0.05 + 0.03 * 0.5 * (0.05 - 0.01) - 0.01 * 0.01};
    const double speed[] = {0.0, 0.025, 0.05, 0.03, -0.01}, lift[] = {0.0, 2.5, -2.0, -2.0, 0.0};
    for (int k = 0; k < COUNT_OF(at); k++) {
        case_run(&c, (int64_t)round((at[k] - c.sim->time) / CARRY_DT), CARRY_DT);
        double rest = radius - hertz_rest(modulus(), radius, sphere_mass(density, radius) * 9.81);
        double most = hertz_rest(modulus(), radius, sphere_mass(density, radius) * (9.81 + fabs(lift[k]))) + rest - radius;
        NEAR(case_get(&c, "position", 0, 2), rest + way[k], 2.0 * most + 2e-8);
        NEAR(case_get(&c, "velocity", 0, 2), speed[k], 2e-4);
    }
    case_close(&c);
}

/* A grain on a turntable of a rough plane sees the velocity of the wall at its own place. At first it slides: a = mu g along omega x r. */
static void test_rotation(void **state)
{
    (void)state;
    double rate = 20.0, arm = 0.05, mu = 0.3, m = sphere_mass(density, radius), dt = 1.0e-6, time = 1.0e-3;
    text t = head(FRICTION, "normal_damping_ratio: 0.5, friction_static: 0.3");
    put(&t,
        "gravity_m_s2: [0, 0, -9.81]\nwalls: [{name: w, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1], "
        "motion: [{type: rotation, point_m: [0.01, 0, 0], axis: [0, 0, 1], rate_rad_s: %g}, {type: constant, velocity_m_s: [0.5, 0, "
        "0]}]}]\n",
        rate);
    put_group(&t);
    double z = radius - hertz_rest(modulus(), radius, m * 9.81);
    put_grain(&t, radius, (double[]){0.01 + arm, 0, z}, none, none);
    put_grain(&t, radius, (double[]){0.01, -arm, z}, none, none);
    physics_case c = case_open(&t);
    case_run(&c, (int64_t)round(time / dt), dt);
    /* wall velocity: (0.5, rate arm) under the first, (0.5 + rate arm, 0) under the second */
    double length = hypot(0.5, rate * arm);
    NEAR(case_get(&c, "velocity", 0, 0), mu * 9.81 * time * 0.5 / length, 3e-2 * mu * 9.81 * time);
    NEAR(case_get(&c, "velocity", 0, 1), mu * 9.81 * time * rate * arm / length, 3e-2 * mu * 9.81 * time);
    NEAR(case_get(&c, "velocity", 1, 0), mu * 9.81 * time, 3e-2 * mu * 9.81 * time);
    NEAR(case_get(&c, "velocity", 1, 1), 0.0, 3e-2 * mu * 9.81 * time);
    case_close(&c);
}

/* A plane that swings like a paddle about the y axis: its face comes with omega r, so that the grain leaves with twice that. */
static void test_paddle(void **state)
{
    (void)state;
    double rate = 10.0, arm = 0.05, u = rate * arm, duration = hertz_duration(modulus(), radius, sphere_mass(density, radius), u);
    text t = head("", "normal_damping_ratio: 0");
    put(&t,
        "walls: [{name: w, shape: rectangle, corners_m: [[0, -0.02, 0], [0.1, -0.02, 0], [0, 0.02, 0]], "
        "motion: [{type: rotation, point_m: [0, 0, 0], axis: [0, -1, 0], rate_rad_s: %g}]}]\n",
        rate);
    put_group(&t);
    put_grain(&t, radius, (double[]){arm, 0, radius}, none, none);
    physics_case c = case_open(&t);
    case_run(&c, 1200, duration / 1000);
    double turned = rate * duration; /* 0.003 */
    NEAR(case_get(&c, "velocity", 0, 2), 2.0 * u, 2.0 * turned * u);
    NEAR(case_get(&c, "velocity", 0, 0), -2.0 * u * 0.5 * turned, turned * u);
    case_close(&c);
}

/* ---- faces, edges, corners ---- */

typedef struct placed {
    double x[3], toward[3]; /* centre; direction from the nearest point to the centre */
    double distance;
} placed;

/* Force on each grain, all apart, against Hertz at its distance from the nearest point. */
static void check_forces(const char *walls, const placed *rows, int count)
{
    text t = head("", "normal_damping_ratio: 0");
    put(&t, "%s", walls);
    put_group(&t);
    for (int k = 0; k < count; k++)
        put_grain(&t, radius, rows[k].x, none, none);
    physics_case c = case_open(&t);
    double *force = case_totals(&c, false);
    for (int k = 0; k < count; k++) {
        double length = sqrt(rows[k].toward[0] * rows[k].toward[0] + rows[k].toward[1] * rows[k].toward[1] +
                             rows[k].toward[2] * rows[k].toward[2]);
        double expected = hertz(radius - rows[k].distance);
        for (int a = 0; a < 3; a++)
            NEAR(force[3 * k + a], expected * rows[k].toward[a] / length, within(1e-9, LAW) * hertz(0.1 * radius));
    }
    free(force);
    case_close(&c);
}

static void test_rectangle(void **state)
{
    (void)state;
    const double near = 0.95e-3, d = 0.95e-3 / sqrt(2.0), e = 0.95e-3 / sqrt(3.0);
    const placed rows[] = {
        {{0.02, 0.02, near}, {0, 0, 1}, near},              /* face, from above */
        {{0.08, 0.02, -near}, {0, 0, -1}, near},            /* and from below */
        {{0.05, 0.05 + near, 0}, {0, 1, 0}, near},          /* edge, in the plane */
        {{0.03, 0.05 + d, d}, {0, 1, 1}, near},             /* edge, from the side */
        {{0.10 + d, 0.03, -d}, {1, 0, -1}, near},           /* another edge, from below */
        {{0.10 + e, 0.05 + e, e}, {1, 1, 1}, near},         /* corner */
        {{-d, -d, 0}, {-1, -1, 0}, near},                   /* the opposite corner, in the plane */
        {{0.06, 0.05 + 1.1e-3, 0}, {0, 1, 0}, 1.1e-3},      /* just off an edge */
        {{0.02 + 5e-3, 0.02, 1.01e-3}, {0, 0, 1}, 1.01e-3}, /* just off the face */
    };
    check_forces("walls: [{name: w, shape: rectangle, corners_m: [[0, 0, 0], [0.1, 0, 0], [0, 0.05, 0]]}]\n", rows, COUNT_OF(rows));
}

static void test_disc(void **state)
{
    (void)state;
    const double near = 0.95e-3, d = 0.95e-3 / sqrt(2.0), c = cos(0.7), s = sin(0.7);
    const placed rows[] = {
        {{0.005, 0.003, near}, {0, 0, 1}, near},
        {{-0.008, 0.001, -near}, {0, 0, -1}, near},
        {{(0.02 + near) * c, (0.02 + near) * s, 0}, {c, s, 0}, near},
        {{-(0.02 + d) * c, -(0.02 + d) * s, d}, {-c, -s, 1}, near},
    };
    check_forces("walls: [{name: w, shape: disc, center_m: [0, 0, 0], normal: [0, 0, 1], radius_m: 0.02}]\n", rows, COUNT_OF(rows));
}

/* In a corner of a box three faces press at once, each with its own normal, and an open side does not. */
static void test_box(void **state)
{
    (void)state;
    double gap = 0.95e-3;
    text t = head("", "normal_damping_ratio: 0");
    put(&t, "walls: [{name: w, shape: box, low_m: [0, 0, 0], high_m: [0.02, 0.03, 0.04], open: [z_high]}]\n");
    put_group(&t);
    put_grain(&t, radius, (double[]){gap, gap, gap}, none, none);
    put_grain(&t, radius, (double[]){0.02 - gap, 0.03 - gap, gap}, none, none);
    put_grain(&t, radius, (double[]){0.01, 0.015, gap}, none, none);
    put_grain(&t, radius, (double[]){gap, 0.03 - gap, 0.03}, none, none);
    put_grain(&t, radius, (double[]){0.01, 0.015, 0.0405}, none, none); /* in the open mouth */
    physics_case c = case_open(&t);
    double *f = case_totals(&c, false), n = hertz(radius - gap);
    const double sign[5][3] = {{1, 1, 1}, {-1, -1, 1}, {0, 0, 1}, {1, -1, 0}, {0, 0, 0}};
    for (int k = 0; k < 5; k++)
        for (int a = 0; a < 3; a++)
            NEAR(f[3 * k + a], sign[k][a] * n, within(1e-9, LAW) * n);
    int64_t count;
    live_contact *contacts = case_contacts(&c, &count);
    assert_int_equal(count, 9);
    free(contacts);
    free(f);
    case_close(&c);
}

/* ---- seams ---- */

/* Two coplanar rectangles act as one plane wherever the grain stands, seam included. Four meet at the origin. */
static void test_coplanar_seam(void **state)
{
    (void)state;
    const double near = 0.95e-3;
    placed rows[16];
    int count = 0;
    for (int k = 0; k < 8; k++) /* across the seam x = 0 */
        rows[count++] = (placed){{1.0e-4 * (k - 4) * (k % 2 ? 3.0 : 1.0), 0.004 * (k + 1), near}, {0, 0, 1}, near};
    rows[count++] = (placed){{0, -0.01, near}, {0, 0, 1}, near};
    rows[count++] = (placed){{0, 0, near}, {0, 0, 1}, near};
    rows[count++] = (placed){{0.01, 0, -near}, {0, 0, -1}, near};
    rows[count++] = (placed){{0.02, 1e-18, near}, {0, 0, 1}, near};
    check_forces("walls:\n"
                 "  - {name: a, shape: rectangle, corners_m: [[0, 0, 0], [0.05, 0, 0], [0, 0.05, 0]]}\n"
                 "  - {name: b, shape: rectangle, corners_m: [[0, 0, 0], [-0.05, 0, 0], [0, 0.05, 0]]}\n"
                 "  - {name: c, shape: rectangle, corners_m: [[0, 0, 0], [-0.05, 0, 0], [0, -0.05, 0]]}\n"
                 "  - {name: d, shape: rectangle, corners_m: [[0, 0, 0], [0.05, 0, 0], [0, -0.05, 0]]}\n",
                 rows, count);
}

/* A convex ridge along y between two slopes of 45 degrees: above it one contact, with the ridge. */
static void test_convex_ridge(void **state)
{
    (void)state;
    const double near = 0.95e-3, d = near / sqrt(2.0);
    const placed rows[] = {
        {{0, 0, near}, {0, 0, 1}, near},                                           /* straight above the ridge */
        {{near * sin(0.3), 0.01, near * cos(0.3)}, {sin(0.3), 0, cos(0.3)}, near}, /* leaning, still on the ridge */
        {{d, 0.02, d}, {1, 0, 1}, near},                                           /* where ridge and face meet */
        {{0.01 + d, 0.03, -0.01 + d}, {1, 0, 1}, near},                            /* on the right face */
        {{-0.01 - d, 0.03, -0.01 + d}, {-1, 0, 1}, near},                          /* on the left face */
    };
    check_forces("walls:\n"
                 "  - {name: a, shape: rectangle, corners_m: [[0, -0.05, 0], [0.05, -0.05, -0.05], [0, 0.05, 0]]}\n"
                 "  - {name: b, shape: rectangle, corners_m: [[0, -0.05, 0], [-0.05, -0.05, -0.05], [0, 0.05, 0]]}\n" TWO_MORE,
                 rows, COUNT_OF(rows));
}

/* Along a line across a seam the force never jumps; over coplanar faces it never changes. */
static void test_force_over_seam(void **state)
{
    (void)state;
    const double depth = 5.0e-5, apart = 1.0e-5;
    for (int ridge = 0; ridge < 2; ridge++) {
        double drop = ridge ? -0.01 : 0.0, before = 0.0;
        text t = head("", "normal_damping_ratio: 0");
        put(&t, "walls:\n  - {name: a, shape: rectangle, corners_m: [[0, -0.05, 0], [0.05, -0.05, %g], [0, 0.5, 0]]}\n", drop);
        put(&t, "  - {name: b, shape: rectangle, corners_m: [[0, -0.05, 0], [-0.05, -0.05, %g], [0, 0.5, 0]]}\n" TWO_MORE, drop);
        put_group(&t);
        for (int s = 0; s < 60; s++)
            put_grain(&t, radius, (double[]){(s - 30) * apart, 4.0e-3 * s, radius - depth}, none, none);
        physics_case c = case_open(&t);
        int64_t count;
        live_contact *contacts = case_contacts(&c, &count);
        assert_int_equal(count, 60);
        for (int s = 0; s < 60; s++) {
            double f = sqrt(pow(contacts[s].force[0], 2) + pow(contacts[s].force[2], 2));
            if (!ridge)
                RELATIVE(f, hertz(depth), within(1e-9, LAW));
            if (s > 0) /* a slope of 0.2, or round the ridge: at most 0.25 of the way in depth */
                NEAR(f, before, 1.5 * hertz(depth) * 0.25 * apart / depth);
            before = f;
        }
        free(contacts);
        case_close(&c);
    }
}

/* A grain that rolls over the seam of two coplanar plates rolls as on one plane. */
static void test_rolling_over_seam(void **state)
{
    (void)state;
    double x[2], w[2], m = sphere_mass(density, radius), z = radius - hertz_rest(modulus(), radius, m * 9.81);
    for (int s = 0; s < 2; s++) {
        text t = head(FRICTION ROLLING, "normal_damping_ratio: 0.3, friction_static: 0.5, rolling_friction: 0.01");
        put(&t, "gravity_m_s2: [0, 0, -9.81]\n");
        put(&t, s ? "walls:\n  - {name: a, shape: rectangle, corners_m: [[0.004, -0.05, 0], [0.05, -0.05, 0], [0.004, 0.05, 0]]}\n"
                    "  - {name: b, shape: rectangle, corners_m: [[0.004, -0.05, 0], [-0.05, -0.05, 0], [0.004, 0.05, 0]]}\n"
                  : "walls: [{name: a, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}]\n");
        put_group(&t);
        put_grain(&t, radius, (double[]){0, 0, z}, (double[]){0.2, 0, 0}, (double[]){0, 0.2 / radius, 0});
        physics_case c = case_open(&t);
        case_run(&c, 4000, 1.0e-5);
        x[s] = case_get(&c, "position", 0, 0);
        w[s] = case_get(&c, "spin", 0, 1);
        NEAR(case_get(&c, "position", 0, 2), z, 1e-3 * (radius - z));
        case_close(&c);
    }
    assert_true(x[0] > 0.006);
    /* the springs start anew on the second plate: the spring's way, about 1e-7 m, is lost once */
    NEAR(x[1], x[0], 1e-6);
    RELATIVE(w[1], w[0], 1e-3);
}

/* ---- what the wall feels ---- */

/* Force and torque on the walls and on the grains: opposite, contact by contact, the torque about the wall's pivot. */
static void test_reaction(void **state)
{
    (void)state;
    text t = head(FRICTION ROLLING, "normal_damping_ratio: 0.3, friction_static: 0.5, rolling_friction: 0.2");
    put(&t, "walls:\n  - {name: floor, shape: plane, point_m: [0, 0, 0], normal: [0.6, 0, 0.8]}\n"
            "  - {name: plate, shape: rectangle, corners_m: [[0.01, -0.02, 0], [0.03, -0.02, 0.001], [0.01, 0.02, 0]]}\n");
    put_group(&t);
    put_grain(&t, radius, (double[]){0.6 * radius, 0.01, 0.8 * radius}, (double[]){-0.4, 0.3, -0.5}, (double[]){100, 50, -70});
    put_grain(&t, radius, (double[]){0.02, 0.004, 0.0005 + radius}, (double[]){0.2, 0.1, -0.4}, (double[]){-30, 40, 80});
    physics_case c = case_open(&t);
    case_run(&c, 20, 5.0e-6);
    int64_t count;
    live_contact *contacts = case_contacts(&c, &count);
    double *force = case_totals(&c, false), *torque = case_totals(&c, true), *x = case_field(&c, "position");
    assert_int_equal(count, 2);
    for (int k = 0; k < 2; k++) {
        const live_contact *now = &contacts[k];
        const double *f = force + 3 * now->i, *m = torque + 3 * now->i, *at = x + 3 * now->i;
        assert_true(now->overlap > 0.0 && now->j == -1 && now->wall == now->i);
        for (int a = 0; a < 3; a++) {
            int b = (a + 1) % 3, d = (a + 2) % 3;
            NEAR(now->force[a], f[a], within(1e-12, LAW) * fabs(f[2]));
            /* the grain's torque about the origin and the wall's about its pivot, the origin, cancel: x cross f + m + m_wall = 0 */
            NEAR(now->torque_wall[a], -(at[b] * f[d] - at[d] * f[b]) - m[a], within(1e-12, LAW) * fabs(f[2]) * 0.02);
        }
        assert_true(fabs(m[0]) + fabs(m[1]) + fabs(m[2]) > 1e-3 * radius * fabs(f[2]));
    }
    free(contacts);
    free(force);
    free(torque);
    free(x);
    case_close(&c);
}

/* A bed at rest: the floor bears its weight, once. */
static void test_weight(void **state)
{
    (void)state;
    text t = head("", "normal_damping_ratio: 0.5");
    put(&t, "gravity_m_s2: [0, 0, -9.81]\nwalls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}]\n");
    put(&t, "particles:\n  - name: p\n    material: m\n    generator: lattice\n    counts: [3, 3, 1]\n    spacing_m: 3.0e-3\n    radius_m: "
            "1.0e-3\n"
            "    origin_m: [0, 0, 1.0e-3]\n");
    physics_case c = case_open(&t);
    case_run(&c, 4000, 1.0e-5);
    int64_t count;
    live_contact *contacts = case_contacts(&c, &count);
    double total = 0.0, weight = 9.0 * sphere_mass(density, radius) * 9.81;
    for (int64_t k = 0; k < count; k++)
        total += contacts[k].force[2];
    assert_int_equal(count, 9);
    assert_int_equal(case_contact_sums(&c).contacts, 9);
    RELATIVE(total, weight, within(1e-9, LAW));
    /* and the springs hold 8/15 E* sqrt(r) d^(5/2) each */
    RELATIVE(case_contact_sums(&c).elastic,
             9.0 * 8.0 / 15.0 * modulus() * sqrt(radius) * pow(hertz_rest(modulus(), radius, weight / 9.0), 2.5), within(1e-8, LAW));
    free(contacts);
    case_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_constant),
        cmocka_unit_test(test_sinusoid),
        cmocka_unit_test(test_table),
        cmocka_unit_test(test_rotation),
        cmocka_unit_test(test_paddle),
        cmocka_unit_test(test_rectangle),
        cmocka_unit_test(test_disc),
        cmocka_unit_test(test_box),
        cmocka_unit_test(test_coplanar_seam),
        cmocka_unit_test(test_convex_ridge),
        cmocka_unit_test(test_force_over_seam),
        cmocka_unit_test(test_rolling_over_seam),
        cmocka_unit_test(test_reaction),
        cmocka_unit_test(test_weight),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
