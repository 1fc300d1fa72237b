/* The energy ledger: what goes in, what comes out and what is stored add up, per grain and for a bed, with an error that falls with the step;
 * and each term against its closed form. */
#include "case.h"
#include "ledger.h"

static const double young = 7.0e10, density = 2700.0, radius = 5.0e-3, nu = 0.3;

enum { NORMAL, TANGENTIAL, ROLLING, WALLS, STIFFNESS, EXPANSION, GRAVITY, BODY, GROUPS };

#define LISTED "output: {observables: [dissipated_normal]}\n"

static void put_material(text *t, const char *interactions)
{
    put(t, "materials:\n  - {name: m, density_kg_m3: %g, youngs_modulus_pa: %g, poissons_ratio: %g}\n" LISTED, density, young, nu);
    put(t, "interactions:\n  - {between: default, %s}\n", interactions);
}

/* Grains of a list above a floor, still without any. */
static void put_floor(text *t, const char *options, const char *interactions)
{
    put(t, "effects:\n  - {slot: normal, law: hertz}\n%s", options);
    put_material(t, interactions);
    put(t, "walls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}]\n"
           "particles:\n  - name: p\n    material: m\n    generator: list\n    items:\n");
}

static void read_ledger(physics_case *c, double *out)
{
    MUST(ledger_read(c->sim, out, why));
}

static double dissipated(const double *e)
{
    return e[NORMAL] + e[TANGENTIAL] + e[ROLLING] + e[BODY];
}

/* What stays constant. */
static double total(physics_case *c)
{
    double e[LEDGER_TERMS];
    particle_sums p = case_sums(c);
    read_ledger(c, e);
    return p.kinetic + p.rotational + case_contact_sums(c).elastic + dissipated(e) - e[WALLS] - e[STIFFNESS] - e[EXPANSION] - e[GRAVITY] -
           e[GROUPS];
}

static double plane_duration(void)
{
    return hertz_duration(young / (1.0 - nu * nu), radius, sphere_mass(density, radius), 1.0);
}

/* ---- one collision ---- */

/* All of the energy lost, 1/2 m* v^2 (1 - e^2), goes to the normal damper, and no more. Returns what is missing, as a share of the loss. */
static double collision_error(double steps)
{
    const double e = -1.0 + 1.423113, v = 1.0, r2 = 2.0 * radius; /* e at a damping ratio of 0.3, clamped (docs/theory.md) */
    double m1 = sphere_mass(density, radius), m2 = sphere_mass(density, r2), eff = m1 * m2 / (m1 + m2), energies[LEDGER_TERMS];
    text t = {0};
    put(&t, "effects: [{slot: normal, law: hertz}]\n");
    put_material(&t, "normal_damping_ratio: 0.3");
    put(&t, "particles:\n  - name: pair\n    material: m\n    generator: list\n    items:\n");
    put_grain(&t, radius, (double[]){0, 0, 0}, (double[]){0, 0, v}, (double[]){0, 0, 0});
    put_grain(&t, r2, (double[]){0, 0, radius + r2}, (double[]){0, 0, 0}, (double[]){0, 0, 0});
    physics_case c = case_open(&t);
    double duration = hertz_duration(0.5 * young / (1.0 - nu * nu), radius * r2 / (radius + r2), eff, v), before = case_sums(&c).kinetic;
    case_run(&c, (int64_t)(3.0 * steps), duration / steps);
    assert_int_equal(case_contact_sums(&c).contacts, 0);
    read_ledger(&c, energies);
    double lost = before - case_sums(&c).kinetic;
    RELATIVE(energies[NORMAL], 0.5 * eff * v * v * (1.0 - e * e), 2e-4 + 10.0 / (steps * steps));
    NEAR(dissipated(energies), energies[NORMAL], 0.0);
    NEAR(energies[WALLS], 0.0, 0.0);
    case_close(&c);
    return fabs(energies[NORMAL] - lost) / lost;
}

static void test_collision(void **state)
{
    (void)state;
    double coarse = collision_error(50), fine = collision_error(100);
    BETWEEN(coarse, 0.0, 2e-3);
    BETWEEN(coarse / fine, 3.5, 4.5); /* second order */
}

/* ---- impacts on a plane ---- */

enum { ANGLES = 12, SPINS = 3, IMPACTS = ANGLES * SPINS };

/* Largest imbalance of any impact, as a share of its energy, after `share` of the duration of a frictionless impact. Where a contact has ended
 * nothing that it dissipated is negative. */
static double impact_error(const char *options, const char *interactions, double steps, double share)
{
    text t = {0};
    put_floor(&t, options, interactions);
    for (int k = 0; k < IMPACTS; k++) {
        double vt = tan((k % ANGLES + 0.5) / ANGLES * 0.5 * PI), spin = (k / ANGLES - 1.0) * hypot(1.0, vt) / radius;
        put_grain(&t, radius, (double[]){0.02 * k, 0, radius}, (double[]){vt, 0, -1.0}, (double[]){0, spin, 0.3 * spin});
    }
    physics_case c = case_open(&t);
    case_run(&c, (int64_t)(share * steps), plane_duration() / steps);
    double *v = case_field(&c, "velocity"), *w = case_field(&c, "spin"), *lost = case_field(&c, "dissipated"), *work = case_field(&c, "work_contacts");
    double worst = 0.0, m = sphere_mass(density, radius), j = 0.4 * m * radius * radius;
    assert_int_equal(case_contact_sums(&c).contacts, 0);
    for (int n = 0; n < IMPACTS; n++) {
        const double *v0 = c.bed.velocity[n], *w0 = c.bed.spin[n];
        double before = 0.0, after = 0.0;
        for (int k = 0; k < 3; k++) {
            before += 0.5 * m * v0[k] * v0[k] + 0.5 * j * w0[k] * w0[k];
            after += 0.5 * m * v[3 * n + k] * v[3 * n + k] + 0.5 * j * w[3 * n + k] * w[3 * n + k];
        }
        for (int k = 0; k < 3; k++)
            BETWEEN(lost[3 * n + k] / before, -1e-6, 1.0);
        worst = fmax(worst, fabs(after - before + lost[3 * n] + lost[3 * n + 1] + lost[3 * n + 2] - work[3 * n + 1]) / before);
    }
    free(v);
    free(w);
    free(lost);
    free(work);
    case_close(&c);
    return worst;
}

#define FRICTION "  - {slot: tangential, law: mindlin}\n"

static void test_impacts(void **state)
{
    (void)state;
    const char *const scenes[][2] = {
        {FRICTION, "friction_static: 0.3, normal_damping_ratio: 0, tangential_damping_ratio: 0"},
        {FRICTION, "friction_static: 0.3, normal_damping_ratio: 0.2, tangential_damping_ratio: 0.3"},
        {FRICTION "  - {slot: rolling, law: elastic_plastic}\n", "friction_static: 0.3, normal_damping_ratio: 0.2, rolling_friction: 0.1"},
        {FRICTION "  - {slot: rolling, law: constant_torque}\n", "friction_static: 0.3, normal_damping_ratio: 0.2, rolling_friction: 0.1"},
        {"  - {slot: tangential, law: mindlin, unloading: rescaled}\n", "friction_static: 0.3, normal_damping_ratio: 0.2"},
    };
    for (int s = 0; s < COUNT_OF(scenes); s++) {
        double coarse = impact_error(scenes[s][0], scenes[s][1], 400, 4.0), fine = impact_error(scenes[s][0], scenes[s][1], 800, 4.0);
        BETWEEN(coarse, 0.0, 5e-3);
        BETWEEN(coarse / fine, 1.7, 4.5); /* first order, or better */
    }
}

/* ---- in the midst of a contact ---- */

/* Imbalance of four grains at 0.8 of a collision with the floor, as a share of their kinetic energy; the stage begins anew `stages` times on the way. */
static double midway_error(const char *options, const char *interactions, int stages, double steps)
{
    text t = {0};
    put(&t, "gravity_m_s2: [0, 0, -9.81]\n");
    put_floor(&t, options, interactions);
    for (int k = 0; k < 4; k++)
        put_grain(&t, radius, (double[]){0.02 * k, 0, radius}, (double[]){0.1 * k, 0, -1.0}, (double[]){0, 10.0 * k, 3.0 * k});
    physics_case c = case_open(&t);
    double before = total(&c), kinetic = case_sums(&c).kinetic;
    int64_t all = llround(0.8 * steps), done = 0;
    for (int s = 0; s <= stages; s++) {
        if (s > 0)
            MUST(simulation_begin_stage(c.sim, 0, why));
        case_run(&c, all * (s + 1) / (stages + 1) - done, plane_duration() / steps);
        done = all * (s + 1) / (stages + 1);
    }
    assert_true(case_contact_sums(&c).elastic > 0.02 * kinetic); /* still pressed */
    double error = fabs(total(&c) - before) / kinetic;
    case_close(&c);
    return error;
}

/* Where forces act, too, the ledger closes with the order of the integrator: 1 of semi-implicit Euler, whose velocities are those of half a step
 * before, 2 of velocity Verlet. Sliding begins and ends within a step, which leaves a small part of first order. */
static void test_midway(void **state)
{
    (void)state;
    const struct {
        const char *options, *interactions;
        bool slides;
    } scenes[] = {
        {"", "normal_damping_ratio: 0", false},
        {"", "normal_damping_ratio: 0.3", false},
        {FRICTION, "friction_static: 10, normal_damping_ratio: 0, tangential_damping_ratio: 0", false},
        {FRICTION "  - {slot: rolling, law: elastic_plastic}\n", "friction_static: 0.3, normal_damping_ratio: 0.2, rolling_friction: 0.1", true},
    };
    for (int s = 0; s < COUNT_OF(scenes); s++)
        for (int stages = 0; stages <= 3; stages += 3) {
            double coarse = midway_error(scenes[s].options, scenes[s].interactions, stages, 100);
            double fine = midway_error(scenes[s].options, scenes[s].interactions, stages, 200);
            BETWEEN(coarse, 0.0, case_verlet() ? 1e-3 : 2e-2);
            BETWEEN(coarse / fine, case_verlet() ? (scenes[s].slides ? 2.0 : 3.5) : 1.8, case_verlet() ? 8.0 : 2.2);
        }
}

/* ---- walls, gravity, groups, background damping ---- */

static const char *const soft =
    "materials: [{name: m, density_kg_m3: 2500, youngs_modulus_pa: 1.0e7, poissons_ratio: 0.3}]\n" LISTED
    "interactions: [{between: default, restitution: 0.6, friction_static: 0.4, rolling_friction: 0.05}]\n";

/* A wall, and a group, that come at the speed V against a grain at rest without damping: it leaves with 2 V, at the cost of m (2 V)^2/2. */
static void test_pushed(void **state)
{
    (void)state;
    const char *const movers[] = {
        "walls: [{name: w, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1], motion: [{type: constant, velocity_m_s: [0, 0, 0.5]}]}]\n"
        "particles:\n",
        "particles:\n  - {name: g, material: m, generator: list, motion: [{type: constant, velocity_m_s: [0, 0, 0.5]}],"
        " items: [{radius_m: 2.0e-3, position_m: [0, 0, -2.0e-3]}]}\n",
    };
    for (int k = 0; k < 2; k++) {
        text t = {0};
        double e[LEDGER_TERMS];
        put(&t, "effects: [{slot: normal, law: hertz}]\nmaterials: [{name: m, density_kg_m3: 2500, youngs_modulus_pa: 1.0e7, poissons_ratio: 0.3}]\n"
                "interactions: [{between: default}]\n" LISTED "%s  - name: p\n    material: m\n    generator: list\n    items:\n",
            movers[k]);
        put_grain(&t, 2e-3, (double[]){0, 0, 2.1e-3}, (double[]){0, 0, 0}, (double[]){0, 0, 0});
        physics_case c = case_open(&t);
        case_run(&c, 2000, 1e-6);
        read_ledger(&c, e);
        RELATIVE(e[k == 0 ? WALLS : GROUPS], 0.5 * sphere_mass(2500, 2e-3) * 4.0 * 0.25, 2e-4);
        NEAR(e[k == 0 ? GROUPS : WALLS], 0.0, 0.0);
        NEAR(e[NORMAL], 0.0, 0.0);
        case_close(&c);
    }
}

/* Free fall from rest under local damping a: g (1 - a) t^2/2 of the way, m g h by gravity, a of it dissipated. */
static void test_falling(void **state)
{
    (void)state;
    text t = {0};
    double e[LEDGER_TERMS];
    put(&t, "gravity_m_s2: [0, 0, -9.81]\neffects: [{slot: body, law: local_damping, coefficient: 0.25}]\n%s"
            "particles:\n  - name: p\n    material: m\n    generator: list\n    items:\n", soft);
    put_grain(&t, 2e-3, (double[]){0, 0, 0}, (double[]){0, 0, 0}, (double[]){0, 0, 0});
    physics_case c = case_open(&t);
    case_run(&c, 1000, 1e-4);
    read_ledger(&c, e);
    double v = 9.81 * 1e-4 * (1.0 + 0.75 * 999.0), kinetic = 0.5 * sphere_mass(2500, 2e-3) * v * v; /* no velocity to damp in the first step */
    RELATIVE(e[GRAVITY] - e[BODY], case_sums(&c).kinetic, within(1e-12, LAW));
    /* velocity Verlet damps half a step's velocity in the first of 1000 */
    RELATIVE(case_sums(&c).kinetic, kinetic, case_verlet() ? 1e-3 : within(1e-12, LAW));
    RELATIVE(e[BODY], 0.25 * e[GRAVITY], 1e-5);
    case_close(&c);
}

/* Grains on a floor that shakes up and down and to and fro: imbalance in the midst of it, as a share of the work done. */
static double shaken_error(double dt)
{
    text t = {0};
    put(&t, "gravity_m_s2: [0, 0, -9.81]\neffects:\n  - {slot: normal, law: hertz}\n" FRICTION "  - {slot: rolling, law: elastic_plastic}\n%s", soft);
    put(&t, "walls:\n  - {name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1], motion: ["
            "{type: sinusoid, direction: [0, 0, 1], amplitude_m: 1.0e-3, frequency_hz: 30}, "
            "{type: sinusoid, direction: [1, 0, 0], amplitude_m: 3.0e-3, frequency_hz: 20}]}\n"
            "particles:\n  - name: p\n    material: m\n    generator: list\n    items:\n");
    for (int k = 0; k < 3; k++)
        put_grain(&t, 2e-3, (double[]){0.1 * k, 0, 2.01e-3 + 1e-3 * k}, (double[]){0.1 * k, 0, 0}, (double[]){0, 0, 20.0 * k});
    physics_case c = case_open(&t);
    double before = total(&c), e[LEDGER_TERMS];
    case_run(&c, llround(0.06 / dt), dt);
    read_ledger(&c, e);
    double error = fabs(total(&c) - before) / (fabs(e[WALLS]) + fabs(e[GRAVITY]));
    case_close(&c);
    return error;
}

static void test_shaken(void **state)
{
    (void)state;
    BETWEEN(shaken_error(1.6e-5), 0.0, 4e-2);
    BETWEEN(shaken_error(2e-6), 0.0, 5e-3);
}

/* Layers between one that is held and one that is pulled over them: imbalance as a share of what is dissipated. */
static double sheared_error(const char *body, double dt)
{
    text t = {0};
    put(&t, "gravity_m_s2: [0, 0, -9.81]\ndomain: {low_m: [0, 0, -1], high_m: [16.0e-3, 16.0e-3, 1], periodic: [x, y]}\n"
            "effects:\n  - {slot: normal, law: hertz}\n" FRICTION "  - {slot: rolling, law: elastic_plastic}\n%s%s", body, soft);
    put(&t, "particles:\n");
    for (int layer = 0; layer < 4; layer++) {
        put(&t, "  - name: layer%d\n    material: m\n%s    generator: list\n    items:\n", layer,
            layer == 0 ? "    motion: fixed\n" : layer == 3 ? "    motion: [{type: constant, velocity_m_s: [0.3, 0.1, 0]}]\n" : "");
        for (int n = 0; n < 16; n++)
            put_grain(&t, 2e-3, (double[]){4e-3 * (n % 4 + 0.25 * layer), 4e-3 * (n / 4 + 0.2 * layer), 3.74e-3 * layer}, (double[]){0, 0, 0},
                      (double[]){0, 0, 0});
    }
    physics_case c = case_open(&t);
    double before = total(&c), e[LEDGER_TERMS];
    case_run(&c, llround(0.02 / dt), dt);
    read_ledger(&c, e);
    double error = fabs(total(&c) - before) / dissipated(e);
    assert_true(e[NORMAL] > 0.0 && e[TANGENTIAL] > 0.0 && e[ROLLING] > 0.0 && e[GROUPS] != 0.0);
    assert_true((e[BODY] > 0.0) == (body[0] != '\0'));
    case_close(&c);
    return error;
}

static void test_sheared(void **state)
{
    (void)state;
    const char *const bodies[] = {"", "  - {slot: body, law: viscous_damping, coefficient: 20}\n"};
    for (int b = 0; b < 2; b++) {
        double coarse = sheared_error(bodies[b], 2e-5), fine = sheared_error(bodies[b], 1e-5);
        BETWEEN(coarse, 0.0, 0.05);
        BETWEEN(coarse / fine, 1.8, case_verlet() ? 4.5 : 2.3); /* first order; of Verlet, first and second */
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_collision), cmocka_unit_test(test_impacts), cmocka_unit_test(test_pushed),
        cmocka_unit_test(test_falling),   cmocka_unit_test(test_shaken),  cmocka_unit_test(test_sheared), cmocka_unit_test(test_midway),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
