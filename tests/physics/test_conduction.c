/* Conduction, each law alone: conductances by their formulas, two grains that level out, chains, walls, soft moduli. */
#include "heat_case.h"

#define OVERLAP_AREA "  - {slot: conduction, law: overlap_area}"
#define TWO "  - {name: a, density_kg_m3: 3000, conductivity_w_mk: 60, specific_heat_j_kgk: 100}\n" \
            "  - {name: b, density_kg_m3: 3000, conductivity_w_mk: 20, specific_heat_j_kgk: 100}\n"
#define ONE "  - {name: a, density_kg_m3: 3000, conductivity_w_mk: 100, specific_heat_j_kgk: 100}\n"

/* T' = T + dt H (T_j - T)/(m c): the difference shrinks by 1 - 2 H dt/(m c) a step, exactly. */
static void test_two_grains(void **state)
{
    (void)state;
    double r = 1e-3, d = 1e-5, after[2];
    double m = sphere_mass(3000, r), h = 60.0 * PI * (r * r - pow(r - 0.5 * d, 2)) / (2.0 * r - d), tau = m * 100.0 / (2.0 * h);
    /* through the exponent: a law's roundings of 50 K, and those of the two temperatures of which it takes the difference */
    double error = within(1e-9, 1.0 / tau * (LAW * 50.0 + 2.0 * 400.0));
    RELATIVE(tau, 0.66499582, 1e-8);
    for (int half = 0; half < 2; half++) {
        const hot_grain grains[] = {{"a", r, 0, 400}, {"a", r, 2.0 * r - d, 300}};
        physics_case c = row_open(OVERLAP_AREA, TWO, "", grains, 2);
        int steps = half ? 2000 : 1000;
        double before = case_heat(&c).content;
        case_run(&c, steps, 1.0 / steps);
        after[half] = temperature_of(&c, 0);
        NEAR(after[half], 350.0 + 50.0 * pow(1.0 - 1.0 / (tau * steps), steps), error);
        NEAR(after[half] + temperature_of(&c, 1), 700.0, 1e-10);
        RELATIVE(case_heat(&c).content, before, 1e-13);
        case_close(&c);
    }
    NEAR(2.0 * after[1] - after[0], 361.1145400, 2e-5 + 3.0 * error); /* first order */
    NEAR(2.0 * after[1] - after[0], 350.0 + 50.0 * exp(-1.0 / tau), 2e-5 + 3.0 * error);
}

/* Conductance by Eqs. 33-35; the same bits whichever grain comes first. */
static void test_unequal_grains(void **state)
{
    (void)state;
    const hot_grain ab[] = {{"a", 1e-3, 0, 400}, {"b", 2e-3, 3e-3 - 1e-5, 300}};
    const hot_grain ba[] = {{"b", 2e-3, 0, 300}, {"a", 1e-3, 3e-3 - 1e-5, 400}};
    physics_case c = row_open(OVERLAP_AREA, TWO, "", ab, 2), swapped = row_open(OVERLAP_AREA, TWO, "", ba, 2);
    double h = overlap_conductance(1e-3, 2e-3, 1e-5, 60, 20), flow = flow_of(&c, 0, 1);
    RELATIVE(h, 3.5933834e-4, 1e-7);
    RELATIVE(flow, -100.0 * h, within(1e-10, LAW));
    RELATIVE(flow_of(&swapped, 0, 1), -flow, within(1e-12, LAW)); /* positions differ in their last bits */
    case_close(&c);
    case_close(&swapped);
}

/* A film adds t/k to r_i/k_i + r_j/k_j; nothing passes where nothing conducts. */
static void test_film(void **state)
{
    (void)state;
    const char *materials = "  - {name: a, density_kg_m3: 3000, conductivity_w_mk: 60, specific_heat_j_kgk: 100, film_thickness_m: 1.0e-6,\n"
                            "     film_conductivity_w_mk: 0.05}\n"
                            "  - {name: b, density_kg_m3: 3000, conductivity_w_mk: 0, specific_heat_j_kgk: 100}\n";
    double r = 1e-3, d = 1e-5;
    const hot_grain grains[] = {{"a", r, 0, 400}, {"a", r, 2.0 * r - d, 300}, {"b", r, 4.0 * r - 2.0 * d, 300}};
    physics_case c = row_open(OVERLAP_AREA, materials, "", grains, 3);
    double area = PI * (r * r - pow(r - 0.5 * d, 2));
    double k = 2.0 * r / (2.0 * r / 60.0 + 2.0 * 1e-6 / 0.05);
    RELATIVE(flow_of(&c, 0, 1), -100.0 * k * area / (2.0 * r - d), within(1e-10, LAW));
    assert_true(isnan(flow_of(&c, 1, 2)) || fabs(flow_of(&c, 1, 2)) < 1e-25);
    case_close(&c);
}

/* n grains between two walls: the reference column, at its steady state after some thousand steps. */
#define COLUMN 10

static physics_case column_open(const char *effects, double wall_overlap)
{
    double r = 3e-3, d = 3e-5;
    hot_grain grains[COLUMN];
    char more[512];
    for (int k = 0; k < COLUMN; k++)
        grains[k] = (hot_grain){"a", r, (2.0 * r - d) * k, 300};
    double last = grains[COLUMN - 1].x;
    snprintf(more, sizeof more,
             "walls:\n  - {name: hot, shape: plane, point_m: [%.17g, 0, 0], normal: [1, 0, 0], temperature_k: 1000}\n"
             "  - {name: cold, shape: plane, point_m: [%.17g, 0, 0], normal: [-1, 0, 0], temperature_k: 300}\n",
             -(r - wall_overlap), last + r - wall_overlap);
    return row_open(effects, ONE, more, grains, COLUMN);
}

static void test_column(void **state)
{
    (void)state;
    double r = 3e-3, d = 3e-5, h = 100.0 * PI * (r * r - pow(r - 0.5 * d, 2)) / (2.0 * r - d);
    physics_case c = column_open(OVERLAP_AREA, 0.5 * d);
    double capacity = sphere_mass(3000, r) * 100.0, flow = h * 700.0 / (COLUMN + 1);
    RELATIVE(h, 4.7242291537e-3, 1e-9);
    RELATIVE(flow, 0.30063276433, 1e-9);
    RELATIVE(flow / ((2.0 * r - d) * (2.0 * r - d)) * (COLUMN + 1) * (2.0 * r - d) / 700.0, h / (2.0 * r - d), 1e-12);
    case_run(&c, 2000, 0.4 * capacity / h);
    /* grains of up to 1000 K are apart by an eleventh of 700 K; ten contacts in a row */
    double apart = 700.0 / (COLUMN + 1), error = within(1e-9, LAW + 2.0 * 1000.0 / apart);
    RELATIVE(flow_of(&c, 0, -1), flow, error); /* from the hot wall */
    for (int k = 0; k + 1 < COLUMN; k++)
        RELATIVE(flow_of(&c, k, k + 1), -flow, error);
    RELATIVE(flow_of(&c, COLUMN - 1, -2), -flow, error);
    for (int k = 0; k < COLUMN; k++)
        NEAR(temperature_of(&c, k), 1000.0 - 700.0 * (k + 1) / (COLUMN + 1), fmax(1e-6, COLUMN * apart * within(0.0, LAW + 2.0 * 1000.0 / apart)));
    case_close(&c);
}

/* The plane law conducts from the plane to the centre: twice the mirror law. An adiabatic wall conducts nothing. */
static void test_walls(void **state)
{
    (void)state;
    double r = 3e-3, d = 1.5e-5, area = PI * (r * r - (r - d) * (r - d));
    physics_case mirror = column_open(OVERLAP_AREA, d), plane = column_open("  - {slot: conduction, law: overlap_area, wall: plane}", d);
    RELATIVE(flow_of(&mirror, 0, -1), 700.0 * 100.0 * area / (2.0 * (r - d)), within(1e-9, LAW));
    RELATIVE(flow_of(&plane, 0, -1), 700.0 * 100.0 * area / (r - d), within(1e-9, LAW));
    case_close(&mirror);
    case_close(&plane);
}

static void test_batchelor_obrien(void **state)
{
    (void)state;
    const hot_grain grains[] = {{"a", 1e-3, 0, 400}, {"b", 2e-3, 3e-3 - 1e-5, 300}};
    physics_case c = row_open("  - {slot: conduction, law: batchelor_obrien}", TWO, "", grains, 2);
    double k = 2.0 / (1.0 / 60.0 + 1.0 / 20.0), a = sqrt(1e-5 * 1e-3 * 2e-3 / 3e-3);
    RELATIVE(flow_of(&c, 0, 1), -100.0 * 2.0 * a * k, within(1e-9, LAW));
    case_close(&c);
    c = column_open("  - {slot: conduction, law: batchelor_obrien}", 1.5e-5);
    RELATIVE(flow_of(&c, 0, -1), 700.0 * 4.0 * sqrt(1.5e-5 * 3e-3) * 100.0, within(1e-9, LAW));
    /* a ghost grain beyond the wall, at 2 T_w - T and half the radius: the same */
    RELATIVE(flow_of(&c, 0, -1), 1400.0 * 2.0 * sqrt(2.0 * 1.5e-5 * 1.5e-3) * 100.0, within(1e-9, LAW));
    case_close(&c);
}

static double pipe(double k, double radius, double a, double depth)
{
    double alpha = asin(a / radius);
    return depth * PI * k / (1.5 - log(alpha) + alpha * alpha / 36.0 + pow(alpha, 4) / 2700.0);
}

static void test_pipe_network(void **state)
{
    (void)state;
    const hot_grain grains[] = {{"a", 1e-3, 0, 400}, {"b", 2e-3, 3e-3 - 1e-4, 300}};
    double distance = 3e-3 - 1e-4, length = 0.5 * (distance - 3e-6 / distance), a = sqrt(1e-6 - length * length);
    for (int given = 0; given < 2; given++) {
        char effects[128];
        snprintf(effects, sizeof effects, "  - {slot: conduction, law: pipe_network%s}", given ? ", depth_m: 0.01" : "");
        physics_case c = row_open(effects, TWO, "dimensions: 2\n", grains, 2);
        double i = pipe(60, 1e-3, a, given ? 0.01 : 2e-3), j = pipe(20, 2e-3, a, given ? 0.01 : 4e-3);
        RELATIVE(flow_of(&c, 0, 1), -100.0 / (1.0 / i + 1.0 / j), within(1e-9, LAW));
        case_close(&c);
    }
}

/* ---- soft moduli ---- */

#define REAL_MODULUS 1.0e9

static void soft_material(char *text, size_t size, double modulus)
{
    snprintf(text, size,
             "  - {name: a, density_kg_m3: 3000, conductivity_w_mk: 60, specific_heat_j_kgk: 1.0e6, youngs_modulus_pa: %g,\n"
             "     poissons_ratio: 0.3, real_modulus_pa: %g}\n",
             modulus, REAL_MODULUS);
}

/* Under the same force, at overlaps that Hertz gives each modulus, the real one and a hundredth of it conduct the same. */
static void test_soft_at_rest(void **state)
{
    (void)state;
    double r = 1e-3, force = 0.01, flow[2];
    for (int soft = 0; soft < 2; soft++) {
        double modulus = soft ? 0.01 * REAL_MODULUS : REAL_MODULUS, d = hertz_rest(modulus / (2.0 * (1.0 - 0.09)), 0.5 * r, force);
        char material[512];
        soft_material(material, sizeof material, modulus);
        const hot_grain grains[] = {{"a", r, 0, 400}, {"a", r, 2.0 * r - d, 300}};
        physics_case c = row_open("  - {slot: normal, law: hertz}\n  - {slot: conduction, law: overlap_area, soft_modulus: static}", material,
                                  "interactions: [{between: default, restitution: 1}]\n", grains, 2);
        flow[soft] = flow_of(&c, 0, 1);
        if (!soft)
            RELATIVE(flow[0], -100.0 * overlap_conductance(r, r, d, 60, 60), within(1e-8, LAW));
        case_close(&c);
    }
    RELATIVE(flow[1], flow[0], within(1e-8, 2.0 * LAW));
}

/* Two grains collide; what one gives the other does not depend on the modulus of the simulation. */
static void test_soft_collision(void **state)
{
    (void)state;
    double r = 1e-3, v = 0.1, given[2];
    for (int soft = 0; soft < 2; soft++) {
        double modulus = soft ? 0.01 * REAL_MODULUS : REAL_MODULUS, m = sphere_mass(3000, r);
        double duration = hertz_duration(modulus / (2.0 * (1.0 - 0.09)), 0.5 * r, 0.5 * m, 2.0 * v);
        char material[512];
        soft_material(material, sizeof material, modulus);
        text t = {0};
        put(&t, "effects:\n  - {slot: normal, law: hertz}\n  - {slot: conduction, law: overlap_area, soft_modulus: collisional}\nmaterials:\n%s", material);
        put(&t, "interactions: [{between: default, restitution: 1}]\nparticles:\n");
        for (int k = 0; k < 2; k++)
            put(&t, "  - {name: g%d, material: a, generator: list, temperature_k: %d, items: [{position_m: [%.17g, 0, 0], radius_m: %.17g, velocity_m_s: [%g, 0, 0]}]}\n",
                k, k ? 300 : 400, 2.0 * r * k, r, k ? -v : v);
        physics_case c = case_open(&t);
        double before = temperature_of(&c, 1);
        case_run(&c, 1100, duration / 1000.0);
        given[soft] = temperature_of(&c, 1) - before;
        assert_true(given[soft] > 0.0);
        case_close(&c);
    }
    RELATIVE(given[1], given[0], 0.01);
}

/* Net exchange of an irregular cluster is zero, and no temperature leaves the interval of the first ones. */
static void test_cluster(void **state)
{
    (void)state;
    hot_grain grains[20];
    for (int k = 0; k < 20; k++)
        grains[k] = (hot_grain){k % 3 ? "a" : "b", 1e-3 * (1.0 + 0.3 * sin(7.0 * k)), 1.6e-3 * k, 300.0 + 700.0 * fabs(sin(3.0 * k))};
    physics_case c = row_open(OVERLAP_AREA, TWO, "", grains, 20);
    heat_sums before = case_heat(&c);
    step_limit limit = case_limit(&c);
    assert_non_null(strstr(limit.binds, "conduction"));
    for (int part = 0; part < 20; part++) {
        case_run(&c, 10, 0.99 * limit.limit_s);
        heat_sums now = case_heat(&c);
        assert_true(now.lowest >= before.lowest && now.highest <= before.highest);
        RELATIVE(now.content, before.content, within(1e-12, LAW)); /* a grain adds up its flows; they pass on about what there is */
    }
    assert_true(case_heat(&c).highest < before.highest - 10.0);
    case_close(&c);
}

/* A tiny hot grain beside a large cold one, at the step that the limit allows, does not overshoot. */
static void test_tiny_beside_large(void **state)
{
    (void)state;
    const hot_grain grains[] = {{"a", 1e-5, 0, 3000}, {"a", 1e-3, 1.01e-3 - 1e-6, 300}};
    physics_case c = row_open(OVERLAP_AREA, ONE, "", grains, 2);
    step_limit limit = case_limit(&c);
    RELATIVE(limit.limit_s, sphere_mass(3000, 1e-5) * 100.0 / overlap_conductance(1e-5, 1e-3, 1e-6, 100, 100), 1e-6);
    double before = 3000.0, last_place = within(0.0, 2.0) * 300.0;
    for (int k = 0; k < 20; k++) {
        case_run(&c, 1, limit.recommended_s);
        double now = temperature_of(&c, 0);
        assert_true(now < before + last_place && now > temperature_of(&c, 1) - last_place);
        before = now;
    }
    case_close(&c);
}

/* A grain sinks onto a hot floor from tangency (TM 5.1), against the same recurrences written out here; and rests there, against the
 * exponential that the reference values are. */
static void test_hot_floor(void **state)
{
    (void)state;
    double r = 1e-3, g = 9.8, e = 1e6 / (1.0 - 0.09), m = sphere_mass(3000, r), dt = 2e-5, x = 0.0, v = 0.0, temperature = 300.0;
    double rest = hertz_rest(e, r, m * g), h = 60.0 * PI * (2.0 * r * rest - rest * rest) / (2.0 * (r - rest)), tau = m * 100.0 / h;
    const double times[] = {1, 2, 8, 12, 18, 40}, expected[] = {400.1236, 475.1853, 660.0866, 687.3919, 697.7616, 699.9960};
    RELATIVE(rest, 1.918782e-6, 1e-6);
    for (int k = 0; k < 6; k++)
        NEAR(700.0 - 400.0 * exp(-times[k] / tau), expected[k], 6e-5);
    text t = {0};
    put(&t, "gravity_m_s2: [0, 0, -9.8]\neffects:\n  - {slot: normal, law: hertz}\n" OVERLAP_AREA "\nmaterials:\n"
            "  - {name: a, density_kg_m3: 3000, conductivity_w_mk: 60, specific_heat_j_kgk: 100, youngs_modulus_pa: 1.0e6, poissons_ratio: 0.3}\n"
            "interactions: [{between: default, normal_damping_ratio: 1}]\n"
            "walls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1], temperature_k: 700}]\n"
            "integrator: semi_implicit_euler\n"
            "particles: [{name: p, material: a, generator: list, temperature_k: 300, items: [{position_m: [0, 0, 1.0e-3], radius_m: 1.0e-3}]}]\n");
    physics_case c = case_open(&t);
    case_run(&c, 2000, dt);
    for (int k = 0; k < 2000; k++) {
        double d = fmax(-x, 0.0), force = d > 0.0 ? 4.0 / 3.0 * e * sqrt(r) * pow(d, 1.5) - 2.0 * sqrt(2.0 * e * m * sqrt(r)) * pow(d, 0.25) * v : 0.0;
        temperature += dt * 60.0 * PI * (2.0 * r * d - d * d) / (2.0 * (r - d)) * (700.0 - temperature) / (m * 100.0);
        v += dt * (fmax(force, 0.0) / m - g);
        x += dt * v;
    }
    if (c.scene->integrator == INTEGRATOR_SEMI_IMPLICIT_EULER)
        NEAR(temperature_of(&c, 0), temperature, 1e-6);
    /* the sinking costs about 2/omega = 0.72 ms */
    NEAR(temperature_of(&c, 0), 700.0 - 400.0 * exp(-(2000.0 * dt - 2.0 / sqrt(1.5 * g / rest)) / tau), 5e-3);
    case_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_two_grains),       cmocka_unit_test(test_unequal_grains), cmocka_unit_test(test_film),
        cmocka_unit_test(test_column),           cmocka_unit_test(test_walls),          cmocka_unit_test(test_batchelor_obrien),
        cmocka_unit_test(test_pipe_network),     cmocka_unit_test(test_soft_at_rest),   cmocka_unit_test(test_soft_collision),
        cmocka_unit_test(test_cluster),          cmocka_unit_test(test_tiny_beside_large), cmocka_unit_test(test_hot_floor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
