/* Moduli that fall with temperature: the closed form, every law of a contact with it, and the work that it does. */
#include "case.h"
#include "ledger.h"

static const double young = 2.0e8, density = 2700.0, radius = 5.0e-3, nu = 0.3;

/* TM Eq. 42 with floor and rate. */
static double factor(double temperature, double critical, double rate, double floor)
{
    return fmax(floor, fmin(1.0, exp(rate * (1.0 - temperature / critical))));
}

/* Pairs in line, 1 um deep, of two materials at prescribed temperatures: the force is Hertz's with 1/E* = sum (1 - nu^2)/E(T). */
static void test_closed_form(void **state)
{
    (void)state;
    const double temperatures[][2] = {{300, 300}, {500, 500}, {500, 300}, {900, 450}, {300, 2000}, {2000, 2000}};
    const double nu2 = 0.2, young2 = 5e7, d = 1e-6;
    enum { PAIRS = COUNT_OF(temperatures) };
    text t = {0};
    put(&t, "effects:\n  - {slot: normal, law: hertz}\n  - {slot: modulus, law: exponential_softening}\nmaterials:\n"
            "  - {name: a, density_kg_m3: 1000, youngs_modulus_pa: %g, poissons_ratio: %g, specific_heat_j_kgk: 100, softening_temperature_k: 400}\n"
            "  - {name: b, density_kg_m3: 1000, youngs_modulus_pa: %g, poissons_ratio: %g, specific_heat_j_kgk: 100, softening_temperature_k: 350,"
            " softening_rate: 2.5, modulus_floor_pa: %g}\n"
            "interactions: [{between: default, normal_damping_ratio: 0}]\nparticles:\n", young, nu, young2, nu2, 0.1 * young2);
    for (int p = 0; p < PAIRS; p++)
        for (int k = 0; k < 2; k++) {
            put(&t, "  - {name: g%d%c, material: %c, generator: list, thermal: prescribed, temperature_k: %g, items: [{radius_m: %g, position_m: [%.17g, %g, 0]}]}\n",
                p, "ab"[k], "ab"[k], temperatures[p][k], radius, k * (2.0 * radius - d), 0.05 * p);
        }
    physics_case c = case_open(&t);
    for (int again = 0; again < 2; again++) { /* as set by the host, and by the device */
        int64_t count;
        live_contact *contacts = case_contacts(&c, &count);
        assert_int_equal(count, PAIRS);
        for (int p = 0; p < PAIRS; p++) {
            double ea = factor(temperatures[p][0], 400, 1, 0) * young, eb = factor(temperatures[p][1], 350, 2.5, 0.1) * young2;
            double modulus = 1.0 / ((1 - nu * nu) / ea + (1 - nu2 * nu2) / eb);
            RELATIVE(fabs(contacts[p].force[0]), 4.0 / 3.0 * modulus * sqrt(0.5 * radius) * pow(contacts[p].overlap, 1.5), within(1e-9, LAW + 3.0 * 4.0)); /* exponents up to 4 */
        }
        free(contacts);
        case_run(&c, 1, 1e-12);
    }
    case_close(&c);
}

/* Impacts of hot grains that soften are those of cold ones whose modulus is as low: normal and tangential springs, rolling, all damping. */
static void impact(const char *slots, double temperature, double scaled, double *out)
{
    text t = {0};
    put(&t, "effects:\n  - {slot: normal, law: hertz}\n  - {slot: tangential, law: mindlin}\n  - {slot: rolling, law: elastic_plastic}\n%s"
            "materials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: %.17g, poissons_ratio: %g, specific_heat_j_kgk: 100, softening_temperature_k: 400}]\n"
            "interactions: [{between: default, normal_damping_ratio: 0.3, friction_static: 0.4, rolling_friction: 0.2}]\n"
            "walls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}]\n"
            "particles:\n  - name: p\n    material: m\n    temperature_k: %g\n    generator: list\n    items:\n",
        slots, density, scaled * young, nu, temperature);
    for (int k = 0; k < 4; k++)
        put_grain(&t, radius, (double[]){0.05 * k, 0, radius}, (double[]){0.4 * k, 0.1, -1}, (double[]){30.0 * k, 10, 5});
    put_grain(&t, radius, (double[]){0, 0.05, 0.05}, (double[]){1, 0, 0.2}, (double[]){0, 10, 5});
    put_grain(&t, 2 * radius, (double[]){3 * radius, 0.05, 0.05}, (double[]){0, 0, 0}, (double[]){20, 10, 5});
    physics_case c = case_open(&t);
    case_run(&c, 1500, 1e-6);
    assert_int_equal(case_contact_sums(&c).contacts, 0);
    double *v = case_field(&c, "velocity"), *w = case_field(&c, "spin");
    memcpy(out, v, 18 * sizeof *v);
    memcpy(out + 18, w, 18 * sizeof *w);
    free(v);
    free(w);
    case_close(&c);
}

static void test_impacts(void **state)
{
    (void)state;
    double hot[36], cold[36], stiff[36];
    impact("  - {slot: modulus, law: exponential_softening}\n", 700.0, 1.0, hot);
    impact("", 700.0, factor(700, 400, 1, 0), cold);
    impact("", 700.0, 1.0, stiff);
    double apart = 0.0;
    for (int k = 0; k < 36; k++) {
        /* two runs, and speeds of a metre a second, spins of as much over a radius */
        NEAR(hot[k], cold[k], 1e-9 * (1.0 + fabs(cold[k])) + within(0.0, 2.0 * LAW) * (k < 18 ? 1.0 : 1.0 / radius));
        apart = fmax(apart, fabs(hot[k] - stiff[k]));
    }
    assert_true(apart > 1e-3);
}

/* A sphere that is heated on a hot floor, and sinks in: mechanical energy, with the work of the softening, stays the same. */
static double imbalance(double dt)
{
    text t = {0};
    double e[LEDGER_TERMS];
    put(&t, "gravity_m_s2: [0, 0, -9.8]\neffects:\n  - {slot: normal, law: hertz}\n  - {slot: conduction, law: overlap_area}\n"
            "  - {slot: modulus, law: exponential_softening}\n"
            "materials: [{name: m, density_kg_m3: 3000, youngs_modulus_pa: 1.0e6, poissons_ratio: 0.3, conductivity_w_mk: 60,"
            " specific_heat_j_kgk: 5, softening_temperature_k: 300, softening_rate: 2}]\n"
            "output: {observables: [work_stiffness]}\n"
            "interactions: [{between: default, normal_damping_ratio: 1}]\n"
            "walls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1], temperature_k: 700}]\n"
            "particles:\n  - name: p\n    material: m\n    temperature_k: 300\n    generator: list\n    items:\n");
    put_grain(&t, 1e-3, (double[]){0, 0, 1e-3}, (double[]){0, 0, 0}, (double[]){0, 0, 0});
    physics_case c = case_open(&t);
    case_run(&c, llround(0.2 / dt), dt);
    MUST(ledger_read(c.sim, e, why));
    double soft = factor(case_get(&c, "temperature", 0, 0), 300, 2, 0), elastic = case_contact_sums(&c).elastic;
    RELATIVE(case_get(&c, "modulus_factor", 0, 0), soft, within(1e-12, LAW));
    BETWEEN(soft, 0.05, 0.5);
    assert_true(e[4] < -0.1 * elastic);
    double gap = case_sums(&c).kinetic + elastic + e[0] - e[4] - e[6]; /* dissipated_normal, work_stiffness, work_gravity */
    case_close(&c);
    return gap / elastic;
}

static void test_work(void **state)
{
    (void)state;
    double coarse = imbalance(4e-5), fine = imbalance(2e-5);
    BETWEEN(fabs(coarse), 0.0, 3e-3);
    BETWEEN(coarse / fine, 1.8, 4.5); /* first order, or better */
}

/* A grain beside surroundings at 300 or 2000 K: T' = 3 h (TE - T)/(rho c r), and its modulus changes at the rate beta T'/T* above T*. The step that is
 * taken lets a stiffness grow by no more, until the next look, than the share that is kept from the limit. */
static void test_limit(void **state)
{
    (void)state;
    const double temperatures[] = {500, 500, 350}, surroundings[] = {300, 2000, 300}, h = 1e8, critical = 400, rate = 2;
    for (int k = 0; k < 3; k++) {
        text t = {0};
        put(&t, "environment: {temperature_k: %g}\neffects:\n  - {slot: normal, law: hertz}\n  - {slot: modulus, law: exponential_softening}\n"
                "  - {slot: convection, law: newton, coefficient_w_m2k: %g}\n"
                "materials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: %g, poissons_ratio: %g, specific_heat_j_kgk: 1.0e3, softening_temperature_k: %g, softening_rate: %g}]\n"
                "interactions: [{between: default, normal_damping_ratio: 0.3}]\n"
                "particles:\n  - name: p\n    material: m\n    temperature_k: %g\n    generator: list\n    items:\n",
            surroundings[k], h, density, young, nu, critical, rate, temperatures[k]);
        put_grain(&t, radius, (double[]){0, 0, 0}, (double[]){0, 0, 0}, (double[]){0, 0, 0});
        put_grain(&t, radius, (double[]){0, 0.1, 0}, (double[]){0, 0, 0}, (double[]){0, 0, 0});
        physics_case c = case_open(&t);
        step_limit limit = case_limit(&c);
        double heating = 3.0 * h * fabs(surroundings[k] - temperatures[k]) / (density * 1e3 * radius), expected = critical / (rate * heating);
        if (k < 2) {
            RELATIVE(limit.heat.stiffness, expected, within(1e-9, 8.0 * LAW / (rate / critical))); /* a quotient over one kelvin */
            double step = 2.0 * log(1.0 / 0.7) / 200.0 * limit.heat.stiffness;
            assert_true(step < 0.1 * fmin(limit.heat.all, limit.expected_s));
            RELATIVE(limit.recommended_s, step, 1e-12);
        } else {
            assert_true(isinf(limit.heat.stiffness) && limit.recommended_s > 0.0);
        }
        case_close(&c);
    }
}

/* A hot grain slides over a floor at u: friction heats it by mu g u/c a second, and its modulus changes at beta T'/T*. */
static void test_limit_by_friction(void **state)
{
    (void)state;
    const double critical = 400, rate = 2, mu = 0.3, speed = 5, capacity = 1e3, m = sphere_mass(density, radius);
    const double modulus = young / (1.0 - nu * nu) * factor(500, critical, rate, 0), overlap = hertz_rest(modulus, radius, m * 9.8);
    text t = {0};
    put(&t, "gravity_m_s2: [0, 0, -9.8]\neffects:\n  - {slot: normal, law: hertz}\n  - {slot: tangential, law: mindlin}\n"
            "  - {slot: modulus, law: exponential_softening}\n  - {slot: dissipation_heat, law: fraction, fraction: 1}\n"
            "materials: [{name: m, density_kg_m3: %g, youngs_modulus_pa: %g, poissons_ratio: %g, specific_heat_j_kgk: %g, softening_temperature_k: %g, softening_rate: %g}]\n"
            "interactions: [{between: default, normal_damping_ratio: 0.3, friction_static: %g}]\n"
            "walls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}]\n"
            "particles:\n  - name: p\n    material: m\n    temperature_k: 500\n    generator: list\n    items:\n",
        density, young, nu, capacity, critical, rate, mu);
    put_grain(&t, radius, (double[]){0, 0, radius - overlap}, (double[]){speed, 0, 0}, (double[]){0, 0, 0});
    physics_case c = case_open(&t);
    case_run(&c, 200, 0.05 * sqrt(m / (2.0 * modulus * sqrt(radius * overlap))));
    double *v = case_field(&c, "velocity"), *w = case_field(&c, "spin"), slip = v[0] - w[1] * radius;
    BETWEEN(slip, 0.9 * speed, speed);
    /* the floor has its overlap, and with it the normal force, to rounding of lengths */
    RELATIVE(case_limit(&c).heat.stiffness, critical / (rate * mu * 9.8 * slip / capacity), 2e-2);
    free(v);
    free(w);
    case_close(&c);
}

/* dT/dt of TM 5.1 for a sphere that rests at every moment: its overlap is that of its weight at the modulus of its temperature. */
static double heating(double temperature, double m, double *overlap)
{
    const double r = 1e-3, modulus = 1e6 / (1.0 - nu * nu) * factor(temperature, 400, 1, 0);
    *overlap = hertz_rest(modulus, r, m * 9.8);
    double conductance = 60.0 * PI * (2.0 * r * *overlap - *overlap * *overlap) / (2.0 * (r - *overlap));
    return conductance * (700.0 - temperature) / (m * 100.0);
}

/* Temperature of that sphere after a time, by Runge and Kutta's method. */
static double heated(double from, double time, double m)
{
    const double step = 1e-3;
    double now = from, unused;
    for (int n = 0; n < lround(time / step); n++) {
        double a = heating(now, m, &unused), b = heating(now + 0.5 * step * a, m, &unused), c = heating(now + 0.5 * step * b, m, &unused);
        now += step / 6.0 * (a + 2.0 * b + 2.0 * c + heating(now + step * c, m, &unused));
    }
    return now;
}

/* TM 5.1: a sphere on a floor of 700 K sinks in as it softens: 479.7878 K after 2 s if it rests from the start. Here the last part of that. */
static void test_hot_floor(void **state)
{
    (void)state;
    const double m = sphere_mass(3000.0, 1e-3), from = heated(300.0, 1.7, m), expected = heated(300.0, 2.0, m);
    double overlap, start;
    NEAR(expected, 479.7878, 1e-4);
    NEAR(heated(300.0, 12.0, m), 697.1671, 1e-4);
    heating(from, m, &start);
    heating(expected, m, &overlap);
    text t = {0};
    put(&t, "gravity_m_s2: [0, 0, -9.8]\n"
            "effects: [{slot: normal, law: hertz}, {slot: conduction, law: overlap_area}, {slot: modulus, law: exponential_softening}]\n"
            "materials: [{name: m, density_kg_m3: 3000, youngs_modulus_pa: 1.0e6, poissons_ratio: %g, conductivity_w_mk: 60, specific_heat_j_kgk: 100, softening_temperature_k: 400}]\n"
            "interactions: [{between: default, normal_damping_ratio: 1}]\n"
            "walls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1], temperature_k: 700}]\n"
            "particles: [{name: s, material: m, generator: list, temperature_k: %.17g, items: [{position_m: [0, 0, %.17g], radius_m: 1.0e-3}]}]\n", nu, from, 1e-3 - start);
    physics_case c = case_open(&t);
    case_run(&c, 6000, 5e-5);
    NEAR(case_get(&c, "temperature", 0, 0), expected, 0.02);
    RELATIVE(1e-3 - case_get(&c, "position", 0, 2), overlap, 1e-3);
    case_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_closed_form),
        cmocka_unit_test(test_impacts),
        cmocka_unit_test(test_work), cmocka_unit_test(test_limit), cmocka_unit_test(test_limit_by_friction), cmocka_unit_test(test_hot_floor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
