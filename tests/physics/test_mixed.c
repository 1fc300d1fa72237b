/* Mixed precision keeps what float alone would lose, over a million steps: the overlap of a grain at rest on a stiff floor, the parabola of a
 * projectile, a turn, a temperature; and a bed far from the origin is one at the origin. */
#include "case.h"

#define STEPS 1000000

static physics_case open_mixed(text *t)
{
    put(t, "\nprecision: mixed\n");
    return case_open(t);
}

/* A grain of 0.5 mm in a box of 0.1 m with walls of 200 GPa, at the corner far from the origin, where positions are known worst. Under its
 * weight m g = 4/3 E* sqrt(r) d^1.5 with E* = E/(1 - nu^2) the overlap is d = 3e-10 m, which is 3e-9 of its position. */
static void test_stiff_floor(void **state)
{
    (void)state;
    const double r = 5e-4, density = 2500.0, g = 9.81, modulus = 200e9 / (1.0 - 0.09);
    double d = hertz_rest(modulus, r, sphere_mass(density, r) * g);
    text t = {0};
    put(&t, "gravity_m_s2: [0, 0, %.17g]\n", g); /* upwards: the floor is the lid */
    put(&t, "effects: [{slot: normal, law: hertz}]\n"
            "materials: [{name: steel, density_kg_m3: 2500, youngs_modulus_pa: 2.0e11, poissons_ratio: 0.3}]\n"
            "interactions: [{between: default, restitution: 0.5}]\n"
            "walls: [{name: box, shape: box, low_m: [0, 0, 0], high_m: [0.1, 0.1, 0.1]}]\n"
            "particles:\n  - name: grain\n    material: steel\n    generator: list\n    items:\n");
    put_grain(&t, r, (double[]){0.0987654321, 0.05, 0.1 - r + 1.02 * d}, (double[]){0, 0, 0}, (double[]){0, 0, 0});
    physics_case c = open_mixed(&t);
    double limit = case_limit(&c).recommended_s;
    case_run(&c, STEPS, limit);
    for (int k = 0; k < 50; k++) { /* at any moment, not on average */
        int64_t count;
        live_contact *contact;
        case_run(&c, 7, limit);
        contact = case_contacts(&c, &count);
        assert_int_equal(count, 1);
        RELATIVE(contact[0].overlap, d, 0.01);
        free(contact);
    }
    RELATIVE(case_get(&c, "position", 0, 2), 0.1 - r + d, 1e-12 / 0.1);
    case_close(&c);
}

/* v += g dt in float loses up to 0.4 % of gravity at these speeds. Semi-implicit Euler: x = x0 + v0 t + g t (t + dt)/2. On its way the grain
 * turns by 4e-7 rad a step, of which a float near 1 knows a sixth, and is heated by 1e-6 K a step at 1000 K, where a float's last place is 6e-5 K. */
static void test_projectile(void **state)
{
    (void)state;
    const double dt = 1e-6, v0[3] = {1.3, 0.0, 4.7}, g = 9.81, w0 = 0.37, density = 2500.0, heat = 800.0, rate = 1.0;
    text t = {0};
    put(&t, "gravity_m_s2: [0, 0, %.17g]\noutput: {fields: [orientation, spin]}\neffects: [{slot: heat_generation, law: volumetric}]\n", -g);
    put(&t, "materials: [{name: m, density_kg_m3: %.17g, youngs_modulus_pa: 5.0e6, poissons_ratio: 0.3, specific_heat_j_kgk: %.17g, "
            "heat_generation_w_m3: %.17g}]\n"
            "particles:\n  - name: grain\n    material: m\n    generator: list\n    temperature_k: 1000\n    items:\n",
        density, heat, rate * density * heat);
    put_grain(&t, 1e-3, (double[]){0.1, 0.0, 0.2}, v0, (double[]){0, 0, w0});
    physics_case c = open_mixed(&t);
    case_run(&c, STEPS, dt);
    double end = STEPS * c.sim->dt, half = 0.5 * w0 * end;
    RELATIVE(end, 1.0, 0x1p-23); /* the step is a float, not below what was asked for */
    NEAR(case_get(&c, "position", 0, 0), 0.1 + v0[0] * end, 1e-5 * v0[0] * end);
    NEAR(case_get(&c, "position", 0, 2), 0.2 + v0[2] * end - 0.5 * g * end * (end + c.sim->dt), 1e-5 * 0.5 * g);
    NEAR(case_get(&c, "velocity", 0, 2), v0[2] - g * end, 1e-6 * g);
    NEAR(case_get(&c, "velocity", 0, 0), v0[0], 1e-15);
    NEAR(case_get(&c, "temperature", 0, 0), 1000.0 + rate * end, 1e-6);
    NEAR(case_get(&c, "orientation", 0, 0), cos(half), 1e-7);
    NEAR(case_get(&c, "orientation", 0, 3), sin(half), 1e-7);
    case_close(&c);
}

/* Sixty-four grains fall onto a floor and spread. `shift` moves all by whole multiples of a power of two, which doubles bear exactly. */
static double *heap_at(double shift, int steps, double *kinetic)
{
    text t = {0};
    put(&t, "gravity_m_s2: [0, 0, -9.81]\n"
            "effects: [{slot: normal, law: hertz}, {slot: tangential, law: mindlin}]\n"
            "materials: [{name: glass, density_kg_m3: 2500, youngs_modulus_pa: 5.0e6, poissons_ratio: 0.3}]\n"
            "interactions: [{between: default, restitution: 0.5, friction_static: 0.4}]\n");
    put(&t, "walls: [{name: floor, shape: plane, point_m: [0, 0, %.17g], normal: [0, 0, 1]}]\n", shift);
    put(&t, "particles:\n  - name: grain\n    material: glass\n    generator: list\n    items:\n");
    for (int n = 0; n < 64; n++)
        put_grain(&t, 0.0009765625, (double[]){shift + 0.0021 * (n % 4) + 0.0001 * (n / 16), shift + 0.0021 * (n / 4 % 4), shift + 0.0011 + 0.0021 * (n / 16)},
                  (double[]){0.01 * (n % 3), 0, 0}, (double[]){0, 0, 0});
    physics_case c = open_mixed(&t);
    case_run(&c, steps, 1e-5);
    double *x = case_field(&c, "position");
    for (int n = 0; n < 3 * 64; n++)
        x[n] -= shift;
    *kinetic = case_sums(&c).kinetic;
    case_close(&c);
    return x;
}

/* At 10^4 m a double knows a place to 2e-12 m, and with that the grains start. */
static void test_far_away(void **state)
{
    (void)state;
    double kinetic, far_kinetic, *x = heap_at(0.0, 1000, &kinetic), *y = heap_at(10000.0, 1000, &far_kinetic);
    for (int n = 0; n < 3 * 64; n++)
        NEAR(y[n], x[n], 1e-9);
    RELATIVE(far_kinetic, kinetic, 1e-5);
    free(x);
    free(y);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_projectile),
        cmocka_unit_test(test_far_away),
        cmocka_unit_test(test_stiff_floor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
