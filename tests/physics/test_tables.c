/* Properties that are tables against temperature: specific heat, conductivity, friction, Young's modulus; each against its closed form. */
#include "case.h"
#include "frozen.h"
#include "heat_case.h"

/* What a run in mixed precision may be off by, relative: so many roundings of a float. */
static double floats(double roundings)
{
    const char *set = getenv("CLAST_TEST_SET");
    return set && strstr(set, "mixed") ? roundings * 0x1p-24 : 0.0;
}

/* ---- specific heat ---- */

/* Places and values of the tests' table; its integral from a to b by Simpson's rule on the linear pieces, which is exact. */
static const double at[] = {300, 400, 450, 600}, heat[] = {400, 800, 500, 700};

static double table(double temperature)
{
    int k = 0;
    while (k < 3 && temperature >= at[k + 1])
        k++;
    if (temperature <= at[0] || k == 3)
        return heat[temperature <= at[0] ? 0 : 3];
    return heat[k] + (temperature - at[k]) / (at[k + 1] - at[k]) * (heat[k + 1] - heat[k]);
}

static double enthalpy(double temperature)
{
    double sum = 400.0 * fmin(temperature, at[0]);
    for (int k = 0; k < 3; k++) {
        double end = fmin(temperature, at[k + 1]);
        if (end > at[k])
            sum += 0.5 * (end - at[k]) * (heat[k] + table(end - 1e-12));
    }
    return sum + (temperature > at[3] ? (temperature - at[3]) * heat[3] : 0.0);
}

static double temperature_at(double content)
{
    double low = 0.0, high = 1e4;
    for (int n = 0; n < 200; n++)
        *(enthalpy(0.5 * (low + high)) > content ? &high : &low) = 0.5 * (low + high);
    return low;
}

#define HEAT_TABLE "specific_heat_j_kgk: {temperature_k: [300, 400, 450, 600], value: [400, 800, 500, 700]}"

/* Heated by constant power, from below the table to above it: at any step the temperature is that of the enthalpy, and heat is not lost. */
static void test_specific_heat(void **state)
{
    (void)state;
    const double density = 2000.0, r = 1e-3, power = 5e9; /* W/m3 */
    for (int steps = 1; steps <= 400; steps *= 20) {
        hot_grain grains[2] = {{"m", r, 0.0, 250.0}, {"c", r, 1.0, 310.0}};
        physics_case c = row_open("  - {slot: heat_generation, law: volumetric}",
                                  "  - {name: m, density_kg_m3: 2000, heat_generation_w_m3: 5.0e9, " HEAT_TABLE "}\n"
                                  "  - {name: c, density_kg_m3: 2000, heat_generation_w_m3: 5.0e9, specific_heat_j_kgk: 600}",
                                  "output: {observables: [heat_sources]}\n", grains, 2);
        double before = case_heat(&c).content, volume = 4.0 / 3.0 * PI * r * r * r;
        for (int part = 1; part <= 4; part++) {
            double time = 0.02 * part, added = power * time / density;
            case_run(&c, steps, 0.02 / steps);
            RELATIVE(temperature_of(&c, 0), temperature_at(enthalpy(250.0) + added), 1e-9 + floats(8));
            RELATIVE(temperature_of(&c, 1), 310.0 + added / 600.0, 1e-12 + floats(8));
            RELATIVE(case_heat(&c).content - before, 2.0 * power * volume * time, 1e-11 + floats(40));
            RELATIVE(case_heat(&c).tally[CLAST_TALLY_SOURCES], 2.0 * power * volume * time, 1e-12 + floats(8));
        }
        assert_true(temperature_of(&c, 0) > 450.0);
        case_close(&c);
    }
}

/* A hot and a cold grain exchange heat over the places of the table: what one loses the other gains, and they meet where the enthalpies say; by
 * steps of motion, and by the methods of a frozen stage. */
static void test_exchange(void **state)
{
    (void)state;
    const char *const stages[] = {"stages: [{name: go, until: {steps: 1}}]\n", "stages: [{name: go, until: {time_s: 40}, motion: frozen}]\n",
                                  "stages: [{name: go, until: {time_s: 40}, motion: frozen, heat: {method: implicit}}]\n",
                                  "stages: [{name: go, until: {time_s: 40}, motion: frozen, heat: {method: steady}}]\n"};
    for (int way = 0; way < COUNT_OF(stages); way++) {
        text t = {0};
        put(&t, "effects: [{slot: conduction, law: overlap_area}]\n"
                "materials: [{name: m, density_kg_m3: 2000, conductivity_w_mk: 50, " HEAT_TABLE "}]\n%s"
                "particles:\n  - {name: a, material: m, generator: list, temperature_k: 700, items: [{position_m: [0, 0, 0], radius_m: 1.0e-3}]}\n"
                "  - {name: b, material: m, generator: list, temperature_k: 280, items: [{position_m: [1.98e-3, 0, 0], radius_m: 1.0e-3}]}\n", stages[way]);
        physics_case c = case_open(&t);
        double before = case_heat(&c).content, met = temperature_at(0.5 * (enthalpy(700.0) + enthalpy(280.0)));
        if (way == 0)
            case_run(&c, 20000, 2e-3);
        else
            MUST(frozen_advance(c.sim, 40.0, 100000, why));
        RELATIVE(case_heat(&c).content, before, 1e-11 + floats(40));
        RELATIVE(temperature_of(&c, 0), met, 1e-7 + floats(16));
        RELATIVE(temperature_of(&c, 1), met, 1e-7 + floats(16));
        case_close(&c);
    }
}

/* ---- conductivity ---- */

enum { CHAIN = 24 };

/* Temperature at the other end of a chain through which a flow goes, walls' mirror images and harmonic means as the law has them. */
static double far_wall(double flow, double first, double pair, double wall, double (*k)(double))
{
    double t = first;
    for (int n = 0; n <= CHAIN; n++) {
        double low = t - 400.0, high = t;
        for (int m = 0; m < 200 && n < CHAIN; m++) {
            double middle = 0.5 * (low + high), mean = n == 0 ? k(middle) : 2.0 / (1.0 / k(t) + 1.0 / k(middle));
            *(mean * (n == 0 ? wall : pair) * (t - middle) > flow ? &low : &high) = middle;
        }
        t = n < CHAIN ? low : t - flow / (k(t) * wall);
    }
    return t;
}

static double linear_k(double temperature)
{
    return 10.0 + 20.0 * fmin(fmax((temperature - 300.0) / 400.0, 0.0), 1.0);
}

/* A chain between two walls, k linear in T. The steady flow is that of the chain's own equations, and by Kirchhoff's transform that of the mean
 * of k over the temperatures, but for what a chain of N grains differs from a rod: of the order (dk/2k)/N at the walls. */
static void test_conductivity(void **state)
{
    (void)state;
    const double r = 1e-3, d = 2e-5, hot = 700.0, cold = 300.0;
    const double pair = overlap_conductance(r, r, d, 1.0, 1.0), wall = overlap_conductance(r, r, d, 1.0, 1.0); /* W/K at k = 1; a wall's overlap is d/2 */
    const char *const laws[] = {"{slot: conduction, law: overlap_area}", "{slot: conduction, law: batchelor_obrien}"};
    const double each[2][2] = {{pair, wall}, {2.0 * sqrt(0.5 * r * d), 4.0 * sqrt(r * 0.5 * d)}};
    for (int way = 0; way < 4; way++) {
        text t = {0};
        bool steady = way < 2;
        int l = way % 2;
        put(&t, "effects: [%s]\n"
                "materials: [{name: m, density_kg_m3: 2000, specific_heat_j_kgk: 100, conductivity_w_mk: {temperature_k: [300, 700], value: [10, 30]}}]\n"
                "walls:\n  - {name: hot, shape: plane, point_m: [%.17g, 0, 0], normal: [1, 0, 0], temperature_k: %g}\n"
                "  - {name: cold, shape: plane, point_m: [%.17g, 0, 0], normal: [-1, 0, 0], temperature_k: %g}\n"
                "stages: [{name: go, until: {%s}, motion: frozen, heat: {method: %s}}]\n"
                "particles:\n  - name: p\n    material: m\n    temperature_k: 400\n    generator: list\n    items:\n",
            laws[l], 0.5 * d, hot, CHAIN * (2.0 * r - d) + 0.5 * d, cold, steady ? "steps: 1" : "time_s: 2000", steady ? "steady" : "implicit");
        for (int n = 0; n < CHAIN; n++)
            put_grain(&t, r, (double[]){r + n * (2.0 * r - d), 0, 0}, (double[]){0, 0, 0}, (double[]){0, 0, 0});
        physics_case c = case_open(&t);
        MUST(frozen_advance(c.sim, steady ? INFINITY : 2000.0, steady ? 1 : 100000, why));
        double low = 0.0, high = 1e3;
        for (int n = 0; n < 200; n++)
            *(far_wall(0.5 * (low + high), hot, each[l][0], each[l][1], linear_k) < cold ? &high : &low) = 0.5 * (low + high);
        double flow = flow_of(&c, 0, -1), kirchhoff = 20.0 * (hot - cold) / ((CHAIN - 1) / each[l][0] + 2.0 / each[l][1]);
        RELATIVE(flow, low, 1e-7 + floats(400));
        RELATIVE(-flow_of(&c, CHAIN - 1, -2), low, 1e-7 + floats(400));
        RELATIVE(flow, kirchhoff, 1.0 / CHAIN / CHAIN);
        case_close(&c);
    }
}

/* One grain between two walls of temperatures Th and Tc, k = k0 + s (T - 300): with u = (Th + Tc)/2 - T the equation is du/dt = -a (km - s u) u,
 * whose solution is u = km/(s + (km/u0 - s) exp(a km t)). The error in a frozen stage goes as the tolerance to the power 2/3, as that of constant
 * conductances does: an order of 2, though these are looked up once a step and a half. */
static void test_order_of_conductivity(void **state)
{
    (void)state;
    const double r = 1e-3, d = 1e-5, k0 = 10.0, s = 0.05, hot = 700.0, cold = 300.0, start = 320.0;
    const double capacity = sphere_mass(2000.0, r) * 100.0, each = PI * (r * r - (r - d) * (r - d)) / (2.0 * (r - d)), a = 2.0 * each / capacity;
    const double middle = 0.5 * (hot + cold), km = k0 + s * (middle - 300.0), time = 1.0 / (a * km);
    const double expected = middle - km / (s + (km / (middle - start) - s) * exp(a * km * time));
    for (int way = 0; way < 4; way++) {
        static double error[2];
        text t = {0};
        put(&t, "effects: [{slot: conduction, law: overlap_area}]\n"
                "materials: [{name: m, density_kg_m3: 2000, specific_heat_j_kgk: 100, conductivity_w_mk: {temperature_k: [300, 700], value: [10, 30]}}]\n"
                "walls:\n  - {name: hot, shape: plane, point_m: [%.17g, 0, 0], normal: [1, 0, 0], temperature_k: %g}\n"
                "  - {name: cold, shape: plane, point_m: [%.17g, 0, 0], normal: [-1, 0, 0], temperature_k: %g}\n"
                "stages: [{name: go, until: {time_s: 2000}, motion: frozen, heat: {method: %s, tolerance: %g}}]\n"
                "particles:\n  - name: p\n    material: m\n    temperature_k: %g\n    generator: list\n    items:\n",
            d - r, hot, r - d, cold, way < 2 ? "stabilised" : "implicit", way % 2 ? 1e-6 : 1e-4, start);
        put_grain(&t, r, (double[]){0, 0, 0}, (double[]){0, 0, 0}, (double[]){0, 0, 0});
        physics_case c = case_open(&t);
        MUST(frozen_advance(c.sim, time, 100000, why));
        error[way % 2] = fabs(temperature_of(&c, 0) - expected);
        assert_true(c.sim->stage_steps < (way % 2 ? 200 : 50));
        case_close(&c);
        assert_true(error[way % 2] < (way % 2 ? 1e-4 : 1e-2) * (hot - cold) + floats(1e4) * hot);
        if (way % 2 && floats(1) == 0.0)
            BETWEEN(log(error[0] / error[1]) / log(100.0), 0.5, 0.85);
    }
}

/* ---- friction ---- */

/* A grain that slides over a floor slows down at mu(T) g, T the grain's temperature; static and dynamic coefficients, a stage that changes one. */
static void test_friction(void **state)
{
    (void)state;
    const double temperatures[] = {250, 350, 425, 900}, expected[] = {0.5, 0.4, 0.2, 0.1};
    text t = {0};
    put(&t, "gravity_m_s2: [0, 0, -10]\neffects: [{slot: normal, law: hertz}, {slot: tangential, law: mindlin}]\n"
            "materials: [{name: m, density_kg_m3: 2500, youngs_modulus_pa: 1.0e8, poissons_ratio: 0.3, specific_heat_j_kgk: 100}]\n"
            "interactions: [{between: default, normal_damping_ratio: 0.5, friction_static: 0.7, friction_dynamic: {temperature_k: [300, 400, 450], value: [0.5, 0.3, 0.1]}}]\n"
            "walls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}]\n"
            "stages:\n  - {name: go, until: {steps: 1}}\n  - {name: other, until: {steps: 1}, change: {walls: [{name: floor, friction_static: 0.25, friction_dynamic: 0.05}]}}\nparticles:\n");
    for (int k = 0; k < 4; k++)
        put(&t, "  - {name: g%d, material: m, generator: list, temperature_k: %g, items: [{radius_m: 2.0e-3, position_m: [0, %g, 1.9999e-3], velocity_m_s: [2, 0, 0]}]}\n",
            k, temperatures[k], 0.1 * k);
    physics_case c = case_open(&t);
    double before[4];
    case_run(&c, 4000, 2e-6);
    for (int k = 0; k < 4; k++)
        before[k] = case_get(&c, "velocity", k, 0);
    case_run(&c, 10000, 2e-6);
    for (int k = 0; k < 4; k++)
        RELATIVE((before[k] - case_get(&c, "velocity", k, 0)) / 0.02, 10.0 * expected[k], 2e-3);
    case_stage(&c, 1);
    for (int k = 0; k < 4; k++)
        before[k] = case_get(&c, "velocity", k, 0);
    case_run(&c, 10000, 2e-6);
    for (int k = 0; k < 4; k++)
        RELATIVE((before[k] - case_get(&c, "velocity", k, 0)) / 0.02, 10.0 * 0.05, 2e-3);
    case_close(&c);
}

/* ---- modulus ---- */

/* Pairs at prescribed temperatures: Hertz with 1/E* = sum (1 - nu^2)/E(T), as the host sets it and as the device does. */
static void test_modulus(void **state)
{
    (void)state;
    const double temperatures[][2] = {{250, 300}, {450, 450}, {450, 800}, {2000, 500}}, nu = 0.3, r = 5e-3, d = 1e-6;
    enum { PAIRS = COUNT_OF(temperatures) };
    text t = {0};
    put(&t, "effects:\n  - {slot: normal, law: hertz}\n  - {slot: modulus, law: table}\nmaterials:\n"
            "  - {name: a, density_kg_m3: 1000, youngs_modulus_pa: {temperature_k: [300, 600], value: [1.0e8, 4.0e7]}, poissons_ratio: 0.3, specific_heat_j_kgk: 100}\n"
            "  - {name: b, density_kg_m3: 1000, youngs_modulus_pa: 5.0e7, poissons_ratio: 0.3, specific_heat_j_kgk: 100}\n"
            "interactions: [{between: default, normal_damping_ratio: 0}]\nparticles:\n");
    for (int p = 0; p < PAIRS; p++)
        for (int k = 0; k < 2; k++)
            put(&t, "  - {name: g%d%c, material: %c, generator: list, thermal: prescribed, temperature_k: %g, items: [{radius_m: %g, position_m: [%.17g, %g, 0]}]}\n",
                p, "ab"[k], p == 1 || k == 0 ? 'a' : 'b', temperatures[p][k], r, k * (2.0 * r - d), 0.05 * p);
    physics_case c = case_open(&t);
    for (int again = 0; again < 2; again++) {
        int64_t count;
        live_contact *contacts = case_contacts(&c, &count);
        assert_int_equal(count, PAIRS);
        for (int p = 0; p < PAIRS; p++) {
            double e[2];
            for (int k = 0; k < 2; k++)
                e[k] = p == 1 || k == 0 ? 1e8 - 6e7 * fmin(fmax((temperatures[p][k] - 300.0) / 300.0, 0.0), 1.0) : 5e7;
            double modulus = 1.0 / ((1 - nu * nu) / e[0] + (1 - nu * nu) / e[1]);
            RELATIVE(fabs(contacts[p].force[0]), 4.0 / 3.0 * modulus * sqrt(0.5 * r) * pow(contacts[p].overlap, 1.5), 1e-9 + floats(20));
        }
        free(contacts);
        case_run(&c, 1, 1e-12);
    }
    case_close(&c);
}

/* ---- what is refused ---- */

static void refuse(const char *material, const char *interaction, const char *message)
{
    char text[2048];
    failure why;
    scene *s = NULL;
    snprintf(text, sizeof text, "effects: [{slot: normal, law: hertz}, {slot: tangential, law: mindlin}]\n"
             "materials: [{name: m, density_kg_m3: 1000, poissons_ratio: 0.3%s}]\ninteractions: [{between: default, normal_damping_ratio: 0%s}]\n"
             "particles: [{name: p, material: m, generator: list, temperature_k: 300, items: [{radius_m: 1.0e-3, position_m: [0, 0, 0]}]}]\n"
             "stages: [{name: go, until: {steps: 1}}]\n", material, interaction);
    assert_int_equal(scene_read_text(text, "case.yaml", 0, NULL, &s, &why), STATUS_BAD_INPUT);
    if (!strstr(why.text, message))
        fail_msg("wanted `%s`, got `%s`", message, why.text);
}

static void test_refused(void **state)
{
    (void)state;
    const char *young = ", youngs_modulus_pa: 1.0e8, specific_heat_j_kgk: 100";
    refuse(", youngs_modulus_pa: {temperature_k: [300, 400], value: [1, 2]}", ", friction_static: 0.1", "needs the law that reads it");
    refuse(young, ", friction_static: {temperature_k: [300, 300], value: [1, 2]}", "must rise from entry to entry");
    refuse(young, ", friction_static: {temperature_k: [300, 400], value: [1]}", "give one value for each temperature");
    refuse(young, ", friction_static: {temperature_k: [300, 400], value: [1, -2]}", "everywhere in the table; it is -2");
    refuse(young, ", friction_static: {time_s: [300, 400], value: [1, 2]}", "time_s");
    refuse(young, ", rolling_friction: {temperature_k: [300], value: [1]}, friction_static: 0.1", "rolling_friction");
    refuse(", youngs_modulus_pa: 1.0e8", ", friction_static: {temperature_k: [300, 400], value: [1, 2]}", "specific_heat_j_kgk");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_specific_heat), cmocka_unit_test(test_exchange), cmocka_unit_test(test_conductivity), cmocka_unit_test(test_order_of_conductivity),
        cmocka_unit_test(test_friction),      cmocka_unit_test(test_modulus),  cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
