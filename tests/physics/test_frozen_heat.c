/* Stages in which nothing moves: heat on the contact network as it stands, against closed forms, against steps of the coupled run, and against
 * what must hold of any method: bounds, balance, order, restart. */
#include "frozen.h"
#include "heat_case.h"

#define RADIUS 3.0e-3
#define OVERLAP 3.0e-5
#define CONDUCTIVITY 100.0
#define DENSITY 3000.0
#define HEAT 100.0
#define HOT 1000.0
#define COLD 300.0
#define ROW 10

/* Everything of one program: laws that a case does not want have coefficients of zero. */
static const char laws_text[] = "effects:\n  - {slot: conduction, law: overlap_area}\n  - {slot: convection, law: newton, coefficient_w_m2k: %g}\n"
                                "  - {slot: radiation, law: stefan_boltzmann}\n  - {slot: heat_generation, law: volumetric}\n"
                                "output: {observables: [heat_sources, heat_walls, heat_convection, heat_radiation]}\n";

static void put_laws(text *t, double convection, double emissivity, double generation, const char *environment)
{
    put(t, laws_text, convection);
    put(t, "environment: {temperature_k: %s}\n", environment);
    put(t,
        "materials: [{name: m, density_kg_m3: 3000, conductivity_w_mk: 100, specific_heat_j_kgk: 100, emissivity: %g, heat_generation_w_m3: %g},\n"
        "            {name: n, density_kg_m3: 8000, conductivity_w_mk: 20, specific_heat_j_kgk: 400, emissivity: %g, heat_generation_w_m3: 0}]\n",
        emissivity, generation, emissivity);
}

/* A row of grains between two walls, each overlapping the next by OVERLAP and the walls by half of it: every conductance is the same. */
static physics_case row_between(int count, const char *hot, const char *stage)
{
    text t = {0};
    double spacing = 2.0 * RADIUS - OVERLAP;
    put_laws(&t, 0.0, 0.0, 0.0, "300");
    put(&t, "walls:\n  - {name: hot, shape: plane, point_m: [0, 0, 0], normal: [1, 0, 0], temperature_k: %s}\n", hot);
    put(&t, "  - {name: cold, shape: plane, point_m: [%.17g, 0, 0], normal: [-1, 0, 0], temperature_k: 300}\n", count * spacing);
    put(&t, "particles: [{name: row, material: m, generator: list, temperature_k: 300, items: [\n");
    for (int k = 0; k < count; k++)
        put(&t, "  {position_m: [%.17g, 0, 0], radius_m: %.17g},\n", (k + 0.5) * spacing, RADIUS);
    put(&t, "]}]\nstages: [{motion: frozen, %s}, {motion: frozen, until: {time_s: 1}, heat: {method: explicit}}]\n", stage);
    return case_open(&t);
}

static double row_conductance(void)
{
    return overlap_conductance(RADIUS, RADIUS, OVERLAP, CONDUCTIVITY, CONDUCTIVITY);
}

static double row_capacity(void)
{
    return sphere_mass(DENSITY, RADIUS) * HEAT;
}

static void advance(physics_case *c, double until)
{
    MUST(frozen_advance(c->sim, until, INT64_MAX, why));
    NEAR(c->sim->time, until, 0.0);
}

static bool mixed(const physics_case *c)
{
    return c->sim->mixed;
}

/* ---- closed forms ---- */

/* One grain between two walls: an exponential. The error follows the tolerance as its power 2/3. */
static void test_between_walls(void **state)
{
    (void)state;
    const char *const stages[] = {"until: {time_s: 9}, heat: {tolerance: 1.0e-4}", "until: {time_s: 9}, heat: {tolerance: 1.0e-6}"};
    double tau = row_capacity() / (2.0 * row_conductance()), error[2], middle = 0.5 * (HOT + COLD);
    for (int k = 0; k < 2; k++) {
        physics_case c = row_between(1, "1000", stages[k]);
        advance(&c, tau);
        error[k] = fabs(temperature_of(&c, 0) - (middle + (COLD - middle) * exp(-1.0)));
        case_close(&c);
        if (mixed(&c))
            return;
    }
    assert_true(error[0] < 100.0 * 1e-4 * (HOT - COLD) && error[1] < 100.0 * 1e-6 * (HOT - COLD));
    BETWEEN(log(error[0] / error[1]) / log(100.0), 0.5, 0.85);
}

/* Steps of Euler's method, of the order 1. */
static void test_explicit(void **state)
{
    (void)state;
    physics_case c = row_between(1, "1000", "until: {time_s: 9}, heat: {method: explicit}");
    double tau = row_capacity() / (2.0 * row_conductance()), step, middle = 0.5 * (HOT + COLD);
    MUST(frozen_limit(c.sim, &step, why));
    RELATIVE(step, tau, 1e-6);
    advance(&c, 10.0 * tau);
    int64_t steps = c.sim->stage_steps;
    assert_int_equal(steps, 12);
    NEAR(temperature_of(&c, 0), middle, 1e-3);
    case_close(&c);
}

/* The walls' heat at the end of a long stage: the conductances of n + 1 contacts in series, and a straight profile. */
static void test_row(void **state)
{
    (void)state;
    physics_case c = row_between(ROW, "1000", "until: {time_s: 3.0e4}, heat: {tolerance: 1.0e-5}");
    double flow = row_conductance() * (HOT - COLD) / (ROW + 1), within = mixed(&c) ? 1e-4 : 1e-7;
    advance(&c, 3.0e4);
    RELATIVE(flow_of(&c, 0, -1), flow, within);
    RELATIVE(flow_of(&c, ROW - 1, -2), -flow, within);
    for (int k = 0; k < ROW; k++)
        RELATIVE(temperature_of(&c, k), HOT - (HOT - COLD) * (k + 1) / (ROW + 1), mixed(&c) ? 1e-5 : 1e-7);
    /* long steps: a stage for every root of their length */
    assert_true(c.sim->stage_steps < 600);
    case_close(&c);
}

/* A wall whose temperature rises as b t drags a grain behind it: tables are read at the times of the stages. */
static void test_ramp(void **state)
{
    (void)state;
    physics_case c = row_between(1, "{time_s: [0, 100], value: [300, 1300]}", "until: {time_s: 20}, heat: {tolerance: 1.0e-7}");
    double tau = row_capacity() / (2.0 * row_conductance()), slope = 0.5 * 10.0;
    advance(&c, 20.0);
    NEAR(temperature_of(&c, 0), COLD + slope * (20.0 - tau * (1.0 - exp(-20.0 / tau))), mixed(&c) ? 1e-2 : 1e-3);
    case_close(&c);
}

/* Into the cold: T^-3 = T0^-3 + 3 eps B A t/(m C), from 3000 K. */
static void test_radiation(void **state)
{
    (void)state;
    text t = {0};
    put_laws(&t, 0.0, 1.0, 0.0, "1.0e-3");
    put(&t, "particles: [{name: g, material: m, generator: list, temperature_k: 3000, items: [{position_m: [0, 0, 0], radius_m: 5.0e-4}]}]\n"
            "stages: [{motion: frozen, until: {time_s: 1}, heat: {tolerance: 1.0e-7}}]\n");
    physics_case c = case_open(&t);
    double area = 4.0 * PI * 25e-8, mc = sphere_mass(DENSITY, 5e-4) * HEAT;
    advance(&c, 1.0);
    NEAR(temperature_of(&c, 0), pow(pow(3000.0, -3) + 3.0 * STEFAN * area / mc, -1.0 / 3.0), mixed(&c) ? 0.1 : 1e-2);
    case_close(&c);
}

/* ---- everything ---- */

/* Grains of two materials in touch with each other and with walls, all paths of heat open. */
static physics_case everything_open(const char *stages)
{
    text t = {0};
    put_laws(&t, 50.0, 0.8, 2.0e6, "{time_s: [0, 5, 10], value: [300, 700, 500]}");
    put(&t, "walls:\n  - {name: hot, shape: plane, point_m: [0, 0, 0], normal: [1, 0, 0], temperature_k: {time_s: [0, 10], value: [900, 1200]}}\n"
            "  - {name: heater, shape: plane, point_m: [0, 0, -0.00298], normal: [0, 0, 1], heat_flux_w: 0.4}\n"
            "  - {name: side, shape: plane, point_m: [0, -0.00299, 0], normal: [0, 1, 0]}\n"
            "particles:\n");
    for (int k = 0; k < 12; k++)
        put(&t, "  - {name: g%d, material: %s, generator: list, temperature_k: %g, %s items: [{position_m: [%.17g, 0, 0], radius_m: 3.0e-3}]}\n", k,
            k % 3 ? "m" : "n", 300.0 + 100.0 * (k % 5), k == 4 ? "thermal: flux, heat_flux_w: 0.05," : k == 9 ? "thermal: prescribed," : "",
            (k + 0.5) * 5.97e-3);
    put(&t, "  - {name: driven, material: n, generator: list, thermal: prescribed, temperature_k: {time_s: [0, 4, 8], value: [400, 800, 300]}, "
            "items: [{position_m: [0.01, 0.0055, 0], radius_m: 3.0e-3}]}\n");
    put(&t, "stages: %s\n", stages);
    return case_open(&t);
}

#define GRAINS 13
#define PATHS  4 /* the tallies that add up to what is stored */

/* Stored = what came in by each path, to rounding. */
static void test_balance(void **state)
{
    (void)state;
    physics_case c = everything_open("[{motion: frozen, until: {time_s: 7}}]");
    heat_sums before = case_heat(&c);
    advance(&c, 7.0);
    heat_sums after = case_heat(&c);
    double in = 0.0, most = 0.0;
    for (int q = 0; q < PATHS; q++) {
        in += after.tally[q];
        most = fmax(most, fabs(after.tally[q]));
        assert_true(fabs(after.tally[q]) > 1e-3);
    }
    NEAR(after.content - before.content, in, (mixed(&c) ? 1e-5 : 1e-9) * most);
    case_close(&c);
}

/* The coupled run with its small steps, extrapolated to a step of zero, has the same temperatures and the same heat by every path. */
static void test_coupled(void **state)
{
    (void)state;
    double coupled[2][GRAINS + PATHS], frozen[GRAINS + PATHS];
    for (int run = 0; run < 3; run++) {
        physics_case c = everything_open(run == 2 ? "[{motion: frozen, until: {time_s: 3}, heat: {tolerance: 1.0e-8}}]" : "[{until: {time_s: 3}}]");
        double *to = run == 2 ? frozen : coupled[run];
        if (mixed(&c)) {
            case_close(&c);
            return;
        }
        if (run == 2)
            advance(&c, 3.0);
        else
            case_run(&c, 2000 << run, 3.0 / (2000 << run));
        heat_sums sums = case_heat(&c);
        for (int k = 0; k < GRAINS; k++)
            to[k] = temperature_of(&c, k);
        memcpy(to + GRAINS, sums.tally, PATHS * sizeof *sums.tally);
        case_close(&c);
    }
    for (int k = 0; k < GRAINS + PATHS; k++)
        RELATIVE(frozen[k], 2.0 * coupled[1][k] - coupled[0][k], 5e-5);
}

/* A state that is saved within a frozen stage and taken up again goes on to the same bits; and the bits do not depend on where it was looked at. */
static void test_restart(void **state)
{
    (void)state;
    const char *stage = "[{motion: frozen, until: {time_s: 7}}]";
    physics_case c = everything_open(stage), d = everything_open(stage);
    bundle saved;
    MUST(frozen_advance(c.sim, 7.0, 9, why));
    assert_true(c.sim->time < 7.0);
    bundle_init(&saved);
    MUST(state_save(c.sim, &saved, why));
    MUST(state_load(d.sim, &saved, "memory", why));
    bundle_free(&saved);
    advance(&c, 7.0);
    while (d.sim->time < 7.0) {
        MUST(frozen_advance(d.sim, 7.0, 1, why));
        case_heat(&d);
    }
    const char *const names[] = {"temperature", "heat_tally"};
    for (int n = 0; n < 2; n++) {
        double *a = case_field(&c, names[n]), *b = case_field(&d, names[n]);
        assert_memory_equal(a, b, GRAINS * sizeof *a * (size_t)store_find(c.sim, names[n])->field->components);
        free(a);
        free(b);
    }
    assert_int_equal(c.sim->step, d.sim->step);
    case_close(&c);
    case_close(&d);
}

/* ---- bounds ---- */

/* A tiny hot grain between large cold ones, and surfaces at 3000 K: no temperature leaves the interval, at any step, with the automatic steps
 * of either method. */
static void test_bounds(void **state)
{
    (void)state;
    static const char *const methods[] = {"stabilised", "explicit", "implicit"};
    for (int m = 0; m < 3; m++) {
        text t = {0};
        put_laws(&t, 50.0, 1.0, 0.0, "500");
        put(&t, "particles:\n  - {name: large, material: m, generator: list, temperature_k: 300, items: [{position_m: [0, 0, 0], radius_m: 3.0e-3}, "
                "{position_m: [0, 0.00599, 0], radius_m: 3.0e-3}]}\n"
                "  - {name: tiny, material: m, generator: list, temperature_k: 3000, items: [{position_m: [0.003019, 0, 0], radius_m: 2.0e-5}]}\n");
        put(&t, "stages: [{motion: frozen, until: {time_s: 20}, heat: {method: %s, tolerance: 1.0e-3}}]\n", methods[m]);
        physics_case c = case_open(&t);
        for (int step = 0; step < (m ? 40 : 300) && c.sim->time < 20.0; step++) {
            MUST(frozen_advance(c.sim, 20.0, 1, why));
            heat_sums sums = case_heat(&c);
            double slack = mixed(&c) ? 1e-2 : 1e-8;
            BETWEEN(sums.lowest, 300.0 - slack, 3000.0);
            BETWEEN(sums.highest, 300.0, 3000.0 + slack);
        }
        assert_true(m > 0 || c.sim->time == 20.0);
        case_close(&c);
    }
}

/* A row that a wall heats at once, with steps far past Euler's limit. */
static void test_front(void **state)
{
    (void)state;
    physics_case c = row_between(40, "3000", "until: {time_s: 2000}, heat: {tolerance: 1.0e-2}");
    while (c.sim->time < 2000.0) {
        MUST(frozen_advance(c.sim, 2000.0, 1, why));
        heat_sums sums = case_heat(&c);
        BETWEEN(sums.lowest, 300.0 * (1.0 - 1e-6), 3000.0);
        BETWEEN(sums.highest, 300.0, 3000.0 * (1.0 + 1e-6));
    }
    assert_true(c.sim->dt > 10.0 * c.sim->frozen.limit);
    case_close(&c);
}

/* ---- methods that solve ---- */

/* The steady state at once: conductances in series; and a long stage comes to the same temperatures. */
static void test_steady_row(void **state)
{
    (void)state;
    physics_case c = row_between(ROW, "1000", "until: {time_s: 1}, heat: {method: steady}"), d = row_between(ROW, "1000", "until: {time_s: 4000}");
    double flow = row_conductance() * (HOT - COLD) / (ROW + 1), within = mixed(&c) ? 1e-4 : 1e-11;
    advance(&c, 1.0);
    advance(&d, 4000.0);
    RELATIVE(flow_of(&c, 0, -1), flow, within);
    RELATIVE(flow_of(&c, ROW - 1, -2), -flow, within);
    for (int k = 0; k < ROW; k++) {
        RELATIVE(temperature_of(&c, k), HOT - (HOT - COLD) * (k + 1) / (ROW + 1), mixed(&c) ? 1e-6 : 1e-12);
        RELATIVE(temperature_of(&d, k), temperature_of(&c, k), mixed(&c) ? 1e-5 : 1e-6);
    }
    case_close(&c);
    case_close(&d);
}

/* With everything on: the long transient comes to the steady state to 1e-6; tables are held at their ends by then. */
static void test_steady_everything(void **state)
{
    (void)state;
    physics_case c = everything_open("[{motion: frozen, until: {time_s: 2000}, heat: {method: steady}}]");
    physics_case d = everything_open("[{motion: frozen, until: {time_s: 2000}, heat: {tolerance: 1.0e-7}}]");
    heat_sums before = case_heat(&c);
    advance(&c, 2000.0);
    advance(&d, 2000.0);
    for (int k = 0; k < GRAINS; k++)
        RELATIVE(temperature_of(&c, k), temperature_of(&d, k), mixed(&c) ? 1e-4 : 1e-6);
    heat_sums after = case_heat(&c);
    RELATIVE(after.tally[CLAST_TALLY_SOURCES], after.content - before.content, mixed(&c) ? 1e-4 : 1e-9);
    case_close(&c);
    case_close(&d);
}

static const char two_clusters[] = "particles:\n"
                                   "  - {name: a, material: m, generator: list, temperature_k: 500, items: [{position_m: [0, 0, 0], radius_m: 3.0e-3}]}\n"
                                   "  - {name: b, material: n, generator: list, temperature_k: 300, items: [{position_m: [0.00597, 0, 0], radius_m: 3.0e-3}]}\n"
                                   "  - {name: c, material: n, generator: list, temperature_k: 700, items: [{position_m: [1, 0, 0], radius_m: 2.0e-3}]}\n";

/* Clusters without a sink end at their mean by heat capacity; one that is heated has no steady state. */
static void test_clusters(void **state)
{
    (void)state;
    for (int heated = 0; heated < 2; heated++) {
        text t = {0};
        failure refused;
        put_laws(&t, 0.0, 0.0, heated ? 1e3 : 0.0, "300");
        put(&t, "%sstages: [{motion: frozen, until: {time_s: 1}, heat: {method: steady}}]\n", two_clusters);
        physics_case c = case_open(&t);
        double a = row_capacity(), b = sphere_mass(8000, 3e-3) * 400.0;
        if (heated) {
            assert_int_equal(frozen_advance(c.sim, 1.0, 1, &refused), STATUS_BAD_INPUT);
            assert_non_null(strstr(refused.text, "there is no steady state: a cluster of particles gains"));
        } else {
            advance(&c, 1.0);
            for (int k = 0; k < 2; k++)
                RELATIVE(temperature_of(&c, k), (a * 500.0 + b * 300.0) / (a + b), mixed(&c) ? 1e-6 : 1e-12);
            NEAR(temperature_of(&c, 2), 700.0, 0.0);
        }
        case_close(&c);
    }
}

/* What heats one grain of a cluster without a sink and cools the other: H (Ta - Tb) is the power, and the heat content stays. Grains, groups and
 * walls are as many as in everything_open, whose program this is; most stand alone. */
static void test_balanced_cluster(void **state)
{
    (void)state;
    text t = {0};
    const double power = 0.5, m = row_capacity(), n = sphere_mass(8000, RADIUS) * 400.0;
    double apart = power / overlap_conductance(RADIUS, RADIUS, 3e-5, 100, 20), mean = (m * 500.0 + n * 400.0) / (m + n);
    put_laws(&t, 0.0, 0.0, 0.0, "300");
    put(&t, "walls:\n  - {name: hot, shape: plane, point_m: [-1, 0, 0], normal: [1, 0, 0], temperature_k: 900}\n"
            "  - {name: heater, shape: plane, point_m: [0, 0, -1], normal: [0, 0, 1], heat_flux_w: 0.4}\n"
            "  - {name: side, shape: plane, point_m: [0, -1, 0], normal: [0, 1, 0]}\nparticles:\n");
    for (int k = 0; k < GRAINS; k++)
        put(&t, "  - {name: g%d, material: %s, generator: list, temperature_k: %g, %s items: [{position_m: [%.17g, 0, 0], radius_m: %.17g}]}\n", k,
            k == 1 ? "n" : "m", 500.0 - 100.0 * (k == 1), k == 0 ? "thermal: flux, heat_flux_w: 0.5," : k == 1 ? "thermal: flux, heat_flux_w: -0.5," : "",
            k < 2 ? 5.97e-3 * k : 0.01 * k, RADIUS);
    put(&t, "stages: [{motion: frozen, until: {time_s: 1}, heat: {method: steady}}]\n");
    physics_case c = case_open(&t);
    advance(&c, 1.0);
    assert_true(apart > 20.0);
    RELATIVE(temperature_of(&c, 0), mean + apart * n / (m + n), mixed(&c) ? 1e-5 : 1e-11);
    RELATIVE(temperature_of(&c, 1), mean - apart * m / (m + n), mixed(&c) ? 1e-5 : 1e-11);
    NEAR(temperature_of(&c, 2), 500.0, 0.0);
    case_close(&c);
}

/* A stage that only a small rate ends, and a cluster that is heated for good: refused before it begins. */
static void test_endless(void **state)
{
    (void)state;
    const char *const ends[] = {"{steady_k_s: 1.0e-3}", "{steady_k_s: 1.0e-3, time_s: 1}", "{steady_k_s: 1.0e3}"};
    for (int k = 0; k < 3; k++) {
        text t = {0};
        failure refused;
        put_laws(&t, 0.0, 0.0, 1e6, "300");
        put(&t, "%sstages: [{name: warm, motion: frozen, until: %s}]\n", two_clusters, ends[k]);
        physics_case c = case_open(&t);
        double limit;
        MUST(frozen_limit(c.sim, &limit, why));
        assert_int_equal(frozen_refuse_endless(c.sim, &refused), k == 0 ? STATUS_BAD_INPUT : STATUS_OK);
        if (k == 0)
            assert_non_null(strstr(refused.text, "stage warm: `until: {steady_k_s: 0.001}` is never met: a cluster of particles gains"));
        case_close(&c);
    }
}

/* Into the heat of 3000 K, from 300 K: Newton's method neither overshoots nor stalls. */
static void test_steady_radiation(void **state)
{
    (void)state;
    text t = {0};
    put_laws(&t, 0.0, 1.0, 0.0, "3000");
    put(&t, "%swalls: [{name: w, shape: plane, point_m: [-0.00298, 0, 0], normal: [1, 0, 0], temperature_k: 300}]\n"
            "stages: [{motion: frozen, until: {time_s: 1}, heat: {method: steady}}]\n", two_clusters);
    physics_case c = case_open(&t);
    advance(&c, 1.0);
    double ta = temperature_of(&c, 0), tb = temperature_of(&c, 1), area = 4.0 * PI * 9e-6;
    double into_b = STEFAN * area * (pow(3000.0, 4) - pow(tb, 4)), into_a = STEFAN * area * (pow(3000.0, 4) - pow(ta, 4));
    RELATIVE(flow_of(&c, 0, 1), into_b, mixed(&c) ? 1e-2 : 1e-9); /* 3000 K in a float: to 2e-4 K, 0.7 W/K */
    RELATIVE(-flow_of(&c, 0, -1), into_a + into_b, mixed(&c) ? 1e-3 : 1e-9);
    NEAR(temperature_of(&c, 2), 3000.0, mixed(&c) ? 1e-2 : 1e-8);
    case_close(&c);
}

/* Implicit steps: the order of the tolerance, all heat accounted for, and the stabilised method's answer. */
static void test_implicit(void **state)
{
    (void)state;
    const char *const stages[] = {"until: {time_s: 9}, heat: {method: implicit, tolerance: 1.0e-4}",
                                  "until: {time_s: 9}, heat: {method: implicit, tolerance: 1.0e-6}"};
    double tau = row_capacity() / (2.0 * row_conductance()), error[2], middle = 0.5 * (HOT + COLD);
    for (int k = 0; k < 2; k++) {
        physics_case c = row_between(1, "1000", stages[k]);
        advance(&c, tau);
        error[k] = fabs(temperature_of(&c, 0) - (middle + (COLD - middle) * exp(-1.0)));
        bool coarse = mixed(&c);
        case_close(&c);
        if (coarse)
            return;
    }
    assert_true(error[0] < 100.0 * 1e-4 * (HOT - COLD) && error[1] < 100.0 * 1e-6 * (HOT - COLD));
    BETWEEN(log(error[0] / error[1]) / log(100.0), 0.5, 0.85);
}

static void test_implicit_everything(void **state)
{
    (void)state;
    physics_case c = everything_open("[{motion: frozen, until: {time_s: 2}, heat: {method: implicit}}]");
    physics_case d = everything_open("[{motion: frozen, until: {time_s: 2}}]");
    heat_sums before = case_heat(&c);
    advance(&c, 2.0);
    advance(&d, 2.0);
    heat_sums after = case_heat(&c), other = case_heat(&d);
    double in = 0.0, most = 0.0;
    for (int k = 0; k < GRAINS; k++)
        RELATIVE(temperature_of(&c, k), temperature_of(&d, k), mixed(&c) ? 1e-4 : 1e-4);
    for (int q = 0; q < PATHS; q++) {
        in += after.tally[q];
        most = fmax(most, fabs(after.tally[q]));
        RELATIVE(after.tally[q], other.tally[q], mixed(&c) ? 1e-3 : 1e-3);
    }
    NEAR(after.content - before.content, in, (mixed(&c) ? 1e-4 : 1e-9) * most);
    case_close(&c);
    case_close(&d);
}

/* ---- ends and refusals ---- */

/* The largest rate is that of the grains; a bed in balance has none. */
static void test_rate(void **state)
{
    (void)state;
    physics_case c = row_between(1, "1000", "until: {steady_k_s: 1.0e-3}");
    double tau = row_capacity() / (2.0 * row_conductance()), middle = 0.5 * (HOT + COLD);
    advance(&c, tau);
    RELATIVE(c.sim->frozen.rate, (middle - COLD) * exp(-1.0) / tau, 1e-3);
    case_close(&c);
}

static void test_moving_wall(void **state)
{
    (void)state;
    text t = {0};
    failure refused;
    put_laws(&t, 0.0, 0.0, 0.0, "300");
    put(&t, "walls: [{name: w, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1], motion: [{type: constant, velocity_m_s: [1, 0, 0]}]}]\n"
            "particles: [{name: g, material: m, generator: list, temperature_k: 300, items: [{position_m: [0, 0, 1], radius_m: 3.0e-3}]}]\n"
            "stages: [{name: warm, motion: frozen, until: {time_s: 1}}]\n");
    physics_case c = case_open(&t);
    assert_int_equal(frozen_advance(c.sim, 1.0, 1, &refused), STATUS_BAD_INPUT);
    assert_non_null(strstr(refused.text, "stage warm: motion is frozen, but a wall"));
    case_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_between_walls), cmocka_unit_test(test_explicit), cmocka_unit_test(test_row),     cmocka_unit_test(test_ramp),
        cmocka_unit_test(test_radiation),     cmocka_unit_test(test_balance),  cmocka_unit_test(test_coupled), cmocka_unit_test(test_restart),
        cmocka_unit_test(test_bounds),        cmocka_unit_test(test_front),    cmocka_unit_test(test_rate),    cmocka_unit_test(test_moving_wall),
        cmocka_unit_test(test_steady_row),    cmocka_unit_test(test_steady_everything), cmocka_unit_test(test_clusters),
        cmocka_unit_test(test_balanced_cluster), cmocka_unit_test(test_endless),
        cmocka_unit_test(test_steady_radiation), cmocka_unit_test(test_implicit), cmocka_unit_test(test_implicit_everything),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
