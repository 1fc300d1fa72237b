/* Beams that heat: TM Eq. 29 to 31, with depths counted from the top of the bed in the grain's own column. Grains are on a cubic lattice and
 * press on nothing, so that the heat of each is known. */
#include "case.h"
#include "frozen.h"

#define RADIUS    5.0e-4
#define SPACING   1.0e-3
#define DENSITY   7800.0
#define HEAT      600.0 /* specific heat */
#define ABSORBS   0.5
#define POWER     1000.0
#define DIAMETER  1.0e-2
#define FRONT     (PI * RADIUS * RADIUS)
#define CAPACITY  (HEAT * DENSITY * 4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS)
#define INTENSITY (POWER / (PI * 0.25 * DIAMETER * DIAMETER))

static void put_bed(text *t, const char *effects, const char *more, int across, int deep)
{
    put(t, "effects:\n%s", effects);
    put(t, "materials: [{name: metal, density_kg_m3: %.17g, specific_heat_j_kgk: %.17g, absorptance: %.17g}]\n", DENSITY, HEAT, ABSORBS);
    put(t, "particles: [{name: bed, material: metal, generator: lattice, counts: [%d, %d, %d], spacing_m: %.17g, radius_m: %.17g, temperature_k: 300}]\n",
        across, across, deep, SPACING, RADIUS);
    put(t, "output: {observables: [source_absorbed, source_delivered, heat_sources]}\n%s", more);
}

/* Rise of the temperature of every grain after some steps; caller frees. */
static double *rises(physics_case *c, int64_t steps, double dt)
{
    case_run(c, steps, dt);
    double *t = case_field(c, "temperature");
    for (int64_t i = 0; i < c->sim->id_count; i++)
        t[i] -= 300.0;
    return t;
}

/* Roundings, in mixed precision, of what passes to a depth that changes it by the factor e over `length`: depths are differences of places,
 * which stand within four times the size of the bed. */
static double depth_error(double length, double size)
{
    return within(0.0, LAW + 2.0 * 4.0 * size / length);
}

static heat_sums sums_of(physics_case *c)
{
    heat_sums sums;
    MUST(heat_observe(c->sim, &sums, why));
    return sums;
}

/* A laser, a pi r^2 I exp(-mu s): the top layer has s = 0; what the grains gain is what is counted as absorbed. */
static void test_laser(void **state)
{
    (void)state;
    const double mu = 2000.0, dt = 1e-3;
    text t = {0};
    char effect[512];
    snprintf(effect, sizeof effect,
             "  - {slot: source, law: laser, name: spot, diameter_m: %.17g, direction: [0, 0, -1], attenuation_1_m: %.17g, "
             "path: {time_s: [0], position_m: [[1e-3, 1e-3, 5]], power_w: [%.17g]}}\n",
             DIAMETER, mu, POWER);
    put_bed(&t, effect, "", 3, 4);
    physics_case c = case_open(&t);
    double *rise = rises(&c, 10, dt), gained = 0.0;
    for (int64_t i = 0; i < c.sim->id_count; i++) {
        double s = (double)(3 - i / 9) * SPACING; /* layers from the bottom up */
        double expected = ABSORBS * FRONT * INTENSITY * exp(-mu * s) * 10 * dt / CAPACITY;
        NEAR(rise[i], expected, 1e-11 * 300.0 + depth_error(1.0 / mu, 4.0 * SPACING) * expected);
        gained += rise[i] * CAPACITY;
    }
    NEAR(rise[35] * CAPACITY / (ABSORBS * 10 * dt), 10.0, 1e-8 + 10.0 * within(0.0, LAW)); /* TM 5.4: W on a grain of the surface */
    NEAR(sums_of(&c).tally[CLAST_TALLY_ABSORBED], gained, 1e-11 * 300.0 * 36 * CAPACITY + within(0.0, LAW) * gained);
    NEAR(c.sim->beams.delivered, POWER * 10 * c.sim->dt, 1e-12 * POWER);
    free(rise);
    case_close(&c);
}

/* A burner that reaches one radius deep heats the top layer alone; one that reaches three layers falls linearly. */
static void test_burner(void **state)
{
    (void)state;
    const double reach[] = {RADIUS, 3.0 * SPACING}, dt = 1e-3;
    for (int n = 0; n < 2; n++) {
        text t = {0};
        char effect[512];
        snprintf(effect, sizeof effect,
                 "  - {slot: source, law: burner, name: torch, diameter_m: %.17g, direction: [0, 0, -1], depth_max_m: %.17g, "
                 "path: {time_s: [0], position_m: [[1e-3, 1e-3, 0]], power_w: [%.17g]}}\n",
                 DIAMETER, reach[n], POWER);
        put_bed(&t, effect, "", 3, 4);
        physics_case c = case_open(&t);
        double *rise = rises(&c, 1, dt);
        for (int64_t i = 0; i < c.sim->id_count; i++) {
            double s = (double)(3 - i / 9) * SPACING, share = fmax(1.0 - s / reach[n], 0.0);
            double full = ABSORBS * FRONT * INTENSITY * dt / CAPACITY;
            NEAR(rise[i], full * share, 1e-11 * 300.0 + depth_error(reach[n], 4.0 * SPACING) * full);
        }
        free(rise);
        case_close(&c);
    }
}

/* A Gaussian beam of the same power: 2 P/(pi w^2) exp(-2 rho^2/w^2), w half the diameter. Along x, so that the surface is the face at low x. */
static void test_gaussian_from_the_side(void **state)
{
    (void)state;
    const double mu = 1000.0, dt = 1e-3, w = 0.5 * DIAMETER;
    text t = {0};
    char effect[512];
    snprintf(effect, sizeof effect,
             "  - {slot: source, law: laser, name: spot, profile: gaussian, diameter_m: %.17g, direction: [1, 0, 0], attenuation_1_m: %.17g, "
             "path: {time_s: [0], position_m: [[-1, 1e-3, 2e-3]], power_w: [%.17g]}}\n",
             DIAMETER, mu, POWER);
    put_bed(&t, effect, "", 3, 4);
    physics_case c = case_open(&t);
    double *rise = rises(&c, 1, dt);
    for (int64_t i = 0; i < c.sim->id_count; i++) {
        double x = (double)(i % 3) * SPACING, y = (double)(i / 3 % 3) * SPACING, z = (double)(i / 9) * SPACING;
        double rho2 = pow(y - 1e-3, 2) + pow(z - 2e-3, 2);
        double power = ABSORBS * FRONT * 2.0 * POWER / (PI * w * w) * exp(-2.0 * rho2 / (w * w)) * exp(-mu * x);
        NEAR(rise[i], power * dt / CAPACITY, 1e-11 * 300.0 + depth_error(1.0 / mu, 4.0 * SPACING) * power * dt / CAPACITY);
    }
    free(rise);
    case_close(&c);
}

/* An oblique beam onto one layer that it sees edge on: a grain's depth is counted in its own column along the beam, so each stands alone where
 * columns are apart by more than a mean diameter. */
static void test_oblique_beam_meets_the_first_grain(void **state)
{
    (void)state;
    text t = {0};
    put(&t, "effects:\n"
            "  - {slot: source, law: burner, name: torch, diameter_m: 1.0, direction: [1, 0, -1], depth_max_m: 1.0e-3, "
            "path: {time_s: [0], position_m: [[0, 0, 0]], power_w: [1000]}}\n"
            "materials: [{name: metal, density_kg_m3: 7800, specific_heat_j_kgk: 600, absorptance: 1}]\n"
            "particles: [{name: two, material: metal, generator: list, temperature_k: 300, items: [{position_m: [0, 0, 0], radius_m: 5e-4}, "
            "{position_m: [3e-3, 0, -3e-3], radius_m: 5e-4}, {position_m: [3e-3, 0, 3e-3], radius_m: 5e-4}]}]\n");
    physics_case c = case_open(&t);
    double *rise = rises(&c, 1, 1.0), expected = FRONT * 1000.0 / (PI * 0.25) / CAPACITY;
    NEAR(rise[0], expected, 1e-9 + within(0.0, LAW) * expected);
    NEAR(rise[1], 0.0, 1e-12); /* behind the first by 3 sqrt(2) mm */
    NEAR(rise[2], expected, 1e-9 + within(0.0, LAW) * expected);
    free(rise);
    case_close(&c);
}

/* Depth runs from top to top: a small grain below a large one in the same column. */
static void test_depth_of_unequal_grains(void **state)
{
    (void)state;
    const double large = 5e-4, small = 2e-4, apart = 2e-3, mu = 500.0;
    text t = {0};
    put(&t, "effects:\n"
            "  - {slot: source, law: laser, name: spot, diameter_m: 0.01, direction: [0, 0, -1], attenuation_1_m: %g, "
            "path: {time_s: [0], position_m: [[0, 0, 0]], power_w: [1000]}}\n"
            "materials: [{name: metal, density_kg_m3: 7800, specific_heat_j_kgk: 600, absorptance: 1}]\n"
            "particles: [{name: two, material: metal, generator: list, temperature_k: 300, items: [{position_m: [0, 0, 0], radius_m: %g}, "
            "{position_m: [0, 0, %g], radius_m: %g}]}]\n", mu, small, apart, large);
    physics_case c = case_open(&t);
    double *rise = rises(&c, 1, 1e-3);
    double capacity = 600.0 * 7800.0 * 4.0 / 3.0 * PI * pow(small, 3), s = apart + large - small;
    RELATIVE(rise[0], 1000.0 / (PI * 0.25e-4) * PI * small * small * exp(-mu * s) * 1e-3 / capacity, 1e-6); /* heights in millionths of a diameter */
    free(rise);
    case_close(&c);
}

/* A moving beam of varying power over a row of grains: each takes what falls on it while its centre is in the beam, step by step. */
static void test_moving_beam(void **state)
{
    (void)state;
    const double dt = 1e-3, speed = 0.02, radius = 1.1037e-3; /* no grain enters or leaves at the time of a step */
    text t = {0};
    put_bed(&t,
            "  - {slot: source, law: laser, name: scan, diameter_m: 2.2074e-3, direction: [0, 0, -1], attenuation_1_m: 1000, "
            "path: {time_s: [0, 0.25, 0.25, 0.5], position_m: [[-2e-3, 0, 0], [3e-3, 0, 0], [3e-3, 0, 0], [8e-3, 0, 0]], power_w: [0, 100, 20, 20]}}\n",
            "", 5, 1);
    physics_case c = case_open(&t);
    double *rise = rises(&c, 500, dt), delivered = 0.0;
    double step = c.sim->dt, jump = 0.25 - 0.5 * dt; /* the step may be rounded */
    for (int s = 0; s < 500; s++)
        delivered += step * (s * dt < jump ? 400.0 * s * step : 20.0);
    for (int64_t i = 0; i < c.sim->id_count; i++) {
        double x = (double)(i % 5) * SPACING, y = (double)(i / 5) * SPACING, energy = 0.0;
        for (int s = 0; s < 500; s++) {
            double time = s * step, centre = -2e-3 + speed * time, power = s * dt < jump ? 400.0 * time : 20.0;
            if (pow(x - centre, 2) + y * y <= radius * radius)
                energy += ABSORBS * FRONT * power / (PI * radius * radius) * step;
        }
        NEAR(rise[i], energy / CAPACITY, 1e-10 * 300.0 + within(0.0, LAW) * energy / CAPACITY);
    }
    NEAR(c.sim->beams.delivered, delivered, 1e-12 * delivered);
    free(rise);
    case_close(&c);
}

/* Two sources of different laws and directions add up. */
static void test_two_sources(void **state)
{
    (void)state;
    text t = {0};
    put_bed(&t,
            "  - {slot: source, law: laser, name: above, diameter_m: 0.01, direction: [0, 0, -1], attenuation_1_m: 2000, "
            "path: {time_s: [0], position_m: [[1e-3, 1e-3, 0]], power_w: [100]}}\n"
            "  - {slot: source, law: burner, name: aside, diameter_m: 0.01, direction: [-1, 0, 0], depth_max_m: 2e-3, "
            "path: {time_s: [0], position_m: [[0, 1e-3, 1e-3]], power_w: [300]}}\n",
            "", 3, 3);
    physics_case c = case_open(&t);
    double *rise = rises(&c, 1, 1e-3), area = PI * 0.25e-4;
    for (int64_t i = 0; i < c.sim->id_count; i++) {
        double below = (double)(2 - i / 9) * SPACING, behind = (double)(2 - i % 3) * SPACING;
        double power = ABSORBS * FRONT / area * (100.0 * exp(-2000.0 * below) + 300.0 * fmax(1.0 - behind / 2e-3, 0.0));
        NEAR(rise[i], power * 1e-3 / CAPACITY, 1e-11 * 300.0 + depth_error(5e-4, 3.0 * SPACING) * ABSORBS * FRONT / area * 400.0 * 1e-3 / CAPACITY);
    }
    bool met[2];
    MUST(beams_met(c.sim, met, why));
    assert_true(met[0] && met[1]);
    free(rise);
    case_close(&c);
}

/* Bits do not depend on how steps are cut into batches, nor on the sort: a falling bed under a scanning beam, depths anew every 7 steps. */
static void test_batches(void **state)
{
    (void)state;
    double *first = NULL;
    for (int n = 0; n < 2; n++) {
        text t = {0};
        put_bed(&t,
                "  - {slot: normal, law: hertz}\n"
                "  - {slot: source, law: laser, name: scan, diameter_m: 2e-3, direction: [0, 0, -1], attenuation_1_m: 1000, surface_every_steps: 7, "
                "path: {time_s: [0, 0.02], position_m: [[0, 0, 0], [3e-3, 1e-3, 0]], power_w: [100, 50]}}\n",
                n == 0 ? "gravity_m_s2: [0, 0, -10]\ncontact_table: {batch_steps: 50}\n" : "gravity_m_s2: [0, 0, -10]\ncontact_table: {batch_steps: 3, skin_m: 2e-5}\n",
                4, 2);
        char *at = strstr(t.at, "density_kg_m3");
        assert_non_null(at);
        text u = {0};
        put(&u, "%.*syoungs_modulus_pa: 1e6, poissons_ratio: 0.3, %s", (int)(at - t.at), t.at, at);
        free(t.at);
        physics_case c = case_open(&u);
        case_run(&c, 200, 1e-4);
        double *now = case_field(&c, "temperature");
        for (int64_t i = 0; first && i < c.sim->id_count; i++)
            assert_true(now[i] == first[i]);
        if (!first)
            first = now;
        else
            free(now);
        case_close(&c);
    }
    free(first);
}

/* In a stage without motion: a laser whose power rises linearly, P t/T over T, gives P T/2. */
static void test_frozen(void **state)
{
    (void)state;
    const double mu = 2000.0, time = 0.5;
    text t = {0};
    put_bed(&t,
            "  - {slot: source, law: laser, name: spot, diameter_m: 0.01, direction: [0, 0, -1], attenuation_1_m: 2000, "
            "path: {time_s: [0, 0.5], position_m: [[1e-3, 1e-3, 5], [1e-3, 1e-3, 5]], power_w: [0, 10]}}\n",
            "stages: [{motion: frozen, until: {time_s: 0.5}, heat: {tolerance: 1e-8}}]\n", 3, 3);
    physics_case c = case_open(&t);
    MUST(frozen_advance(c.sim, time, INT64_MAX, why));
    double *now = case_field(&c, "temperature"), delivered = 0.5 * 10.0 * time, gained = 0.0;
    for (int64_t i = 0; i < c.sim->id_count; i++) {
        double s = (double)(2 - i / 9) * SPACING;
        double expected = ABSORBS * FRONT / (PI * 0.25e-4) * delivered * exp(-mu * s) / CAPACITY;
        NEAR(now[i] - 300.0, expected, 1e-9 * 300.0 + depth_error(1.0 / mu, 3.0 * SPACING) * expected);
        gained += (now[i] - 300.0) * CAPACITY;
    }
    NEAR(c.sim->beams.delivered, delivered, 1e-9 * delivered);
    NEAR(sums_of(&c).tally[CLAST_TALLY_ABSORBED], gained, within(1e-9, LAW) * gained);
    free(now);
    case_close(&c);
}

/* In a stage without motion a beam with an edge passes over a grain at a tolerance that the jump of what falls on it, power (some 4 K in the whole
 * passage) from one instant to the next, asks for steps of nanoseconds: the grain takes what falls on it in the time between the two edges. */
static void test_frozen_edge(void **state)
{
    (void)state;
    const double speed = 0.02, radius = 1.1037e-3, power = 2.0;
    const char *stages = case_mixed() ? "stages: [{motion: frozen, until: {time_s: 0.5}, heat: {tolerance: 1e-7}}]\n" /* what floats tell of a step */
                                      : "stages: [{motion: frozen, until: {time_s: 0.5}, heat: {tolerance: 1e-9}}]\n";
    text t = {0};
    put_bed(&t,
            "  - {slot: source, law: laser, name: scan, diameter_m: 2.2074e-3, direction: [0, 0, -1], attenuation_1_m: 1000, "
            "path: {time_s: [0, 0.5], position_m: [[-3e-3, 0, 0], [7e-3, 0, 0]], power_w: [2, 2]}}\n",
            stages, 1, 1);
    physics_case c = case_open(&t);
    MUST(frozen_advance(c.sim, 0.5, INT64_MAX, why));
    double *now = case_field(&c, "temperature");
    double expected = ABSORBS * FRONT * power / (PI * radius * radius) * (2.0 * radius / speed) / CAPACITY;
    RELATIVE(now[0] - 300.0, expected, 1e-5 + within(0.0, 300.0 * LAW / expected));
    free(now);
    case_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_laser),
                                       cmocka_unit_test(test_burner),
                                       cmocka_unit_test(test_gaussian_from_the_side),
                                       cmocka_unit_test(test_oblique_beam_meets_the_first_grain),
                                       cmocka_unit_test(test_depth_of_unequal_grains),
                                       cmocka_unit_test(test_moving_beam),
                                       cmocka_unit_test(test_two_sources),
                                       cmocka_unit_test(test_batches),
                                       cmocka_unit_test(test_frozen),
                                       cmocka_unit_test(test_frozen_edge)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
