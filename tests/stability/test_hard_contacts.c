/* Hard cases of contact and motion: what must hold stands at the top of each scene. */
#include "hard_case.h"

#define G 9.81

/* ---- piles ---- */

/* Past rest a pile is looked at for `steps` steps with `share` of the limit (0: auto). */
static void pile_stays(physics_case *c, const char *name, double share, int64_t steps)
{
    double *from = case_field(c, "position"), most = 0.0;
    if (share > 0.0)
        simulation_set_step(c->sim, share * case_limit(c).live_s);
    for (int part = 0; part < 20; part++) {
        if (share > 0.0)
            case_run(c, steps / 20, c->sim->dt);
        else
            hard_auto(c, steps / 20, 1.0);
        hard_guard(c);
        most = fmax(most, hard_unrest(c));
    }
    hard_margin(c, name, "motion at rest over the sum of m g r", most, 1e-8);
    hard_margin(c, name, "move after rest over the smallest radius", hard_move(c, from), 1e-6);
    free(from);
}

static void pile_settles(const char *name, const char *scene, const char *precision, const char *set)
{
    physics_case c = hard_open(scene, precision, set);
    hard_settle(&c, 1e-9, 2000000);
    hard_auto(&c, 4000, 1.0);
    pile_stays(&c, name, 0.0, hard_long() ? 1000000 : 8000);
    case_close(&c);
}

static void static_pile(const char *precision)
{
    physics_case c = hard_open("stiff_pile", precision, NULL);
    hard_settle(&c, 1e-9, 2000000);
    hard_auto(&c, 4000, 1.0);
    pile_stays(&c, "static pile", 0.0, hard_long() ? 10000000 : 40000);
    pile_stays(&c, "stiff grains at 0.98 of the step limit", 0.98, hard_long() ? 1000000 : 8000);
    case_close(&c);
}
IN_EVERY_PRECISION(static_pile)

static void pile_damped_critically(const char *precision)
{
    pile_settles("critical damping in every mode", "stiff_pile", precision,
                 "materials[steel].youngs_modulus_pa=2e9;interactions[default].normal_damping_ratio=1");
}
IN_EVERY_PRECISION(pile_damped_critically)

static void pile_rough(const char *precision)
{
    pile_settles("friction of 10", "stiff_pile", precision,
                 "materials[steel].youngs_modulus_pa=2e9;interactions[default].friction_static=10");
}
IN_EVERY_PRECISION(pile_rough)

static void pile_far(const char *precision)
{
    pile_settles("pile 10 km from the origin", "far_pile", precision, NULL);
}
IN_EVERY_PRECISION(pile_far)

/* Without friction grains slide for long: only energy is looked at. */
static void pile_smooth(const char *precision)
{
    physics_case c = hard_open("stiff_pile", precision, "interactions[default].friction_static=0");
    double energy = hard_energy(&c), most = -INFINITY;
    for (int part = 0; part < 20; part++) {
        hard_auto(&c, hard_long() ? 100000 : 1000, 1.0);
        most = fmax(most, hard_energy(&c));
    }
    hard_margin(&c, "friction of 0", "largest energy over that of the start", most / energy, 1.0 + 1e-6);
    case_close(&c);
}
IN_EVERY_PRECISION(pile_smooth)

/* ---- impacts ---- */

static void fast_drop(const char *precision)
{
    physics_case c = hard_open("fast_drop", precision, NULL);
    double energy = hard_energy(&c), most = 0.0, overlap = 0.0, lowest = INFINITY;
    double m = sphere_mass(7800.0, 5.0e-3), e = 2.0e11 / (1.0 - 0.09);
    for (int k = 0; k < 250; k++) {
        hard_auto(&c, 2, 1.0);
        contact_sums sums = case_contact_sums(&c);
        overlap = fmax(overlap, sums.overlap_max);
        lowest = fmin(lowest, fmin(case_get(&c, "position", 0, 2), case_get(&c, "position", 1, 2)));
        if (sums.contacts == 0)
            most = fmax(most, hard_energy(&c));
    }
    hard_margin(&c, "impact at 100 m/s", "largest energy between contacts over that of the start", most / energy, 1.0);
    hard_margin(&c, "impact at 100 m/s", "largest overlap over that of a head-on impact of both",
                overlap * 5.0e-3 / hertz_overlap(0.5 * e, 2.5e-3, 0.5 * m, 100.0), 1.5);
    hard_margin(&c, "impact at 100 m/s", "depth in the floor over the radius", 1.0 - lowest / 5.0e-3, 0.1);
    case_close(&c);
}
IN_EVERY_PRECISION(fast_drop)

static void mass_pair(const char *precision)
{
    physics_case c = hard_open("mass_pair", precision, NULL);
    double e = 1.0e9 / (1.0 - 0.09), m = sphere_mass(7800.0, 1.0e-3);
    hard_settle(&c, hard_long() ? 1e-14 : 1e-9, 2000000);
    double between = hertz_rest(0.5 * e, 1.0e-3 * 1.0e-2 / 1.1e-2, 1000.0 * m * G), floor = hertz_rest(e, 1.0e-3, 1001.0 * m * G);
    hard_margin(&c, "masses 1000 to 1", "overlap of both against Hertz, share", fabs(hard_overlap(&c, 0, 1) / between - 1.0),
                hard_long() ? 1e-4 : 5e-3);
    hard_margin(&c, "masses 1000 to 1", "overlap at the floor against Hertz, share", fabs(hard_overlap(&c, 0, -1) / floor - 1.0),
                hard_long() ? 1e-4 : 5e-3);
    hard_margin(&c, "masses 1000 to 1", "motion at rest over the sum of m g r", hard_unrest(&c), hard_long() ? 1e-13 : 1e-9);
    case_close(&c);
}
IN_EVERY_PRECISION(mass_pair)

static void ratio_50(const char *precision)
{
    physics_case c = hard_open("ratio_50", precision, NULL);
    double energy = hard_energy(&c), most = -INFINITY, overlap = 0.0, lowest = INFINITY;
    for (int part = 0; part < (hard_long() ? 200 : 40); part++) {
        hard_auto(&c, hard_long() ? 1000 : 400, 1.0);
        most = fmax(most, hard_energy(&c) / energy);
        overlap = fmax(overlap, case_contact_sums(&c).overlap_max);
        double *x = case_field(&c, "position");
        for (int64_t n = 0; n < c.bed.count; n++)
            lowest = fmin(lowest, x[3 * n + 2] / c.bed.radius[n]);
        free(x);
    }
    hard_margin(&c, "radii 50 to 1", "largest energy over that of the start", most,
                1.0 + 1e-9 + (strcmp(precision, "mixed") == 0 ? 1e-6 : 0.0));
    hard_margin(&c, "radii 50 to 1", "largest overlap over the smaller radius", overlap, 0.05);
    hard_margin(&c, "radii 50 to 1", "depth in the floor over the radius", 1.0 - lowest, 0.05);
    case_close(&c);
}
IN_EVERY_PRECISION(ratio_50)

/* ---- overlaps at the start ---- */

static void overlapping(const char *precision)
{
    physics_case c = hard_open("overlapping", precision, NULL);
    double elastic = case_contact_sums(&c).elastic, most = 0.0;
    for (int k = 0; c.sim->time < 0.004; k++) {
        hard_auto(&c, k < 50 ? 1 : 200, 1.0);
        most = fmax(most, case_sums(&c).kinetic);
    }
    hard_margin(&c, "overlap of half a radius, damped", "largest kinetic energy over the elastic one of the start", most / elastic, 0.01);
    hard_margin(&c, "overlap of half a radius, damped", "overlap at the end over the radius", case_contact_sums(&c).overlap_max, 0.05);
    case_close(&c);
}
IN_EVERY_PRECISION(overlapping)

/* ---- friction ---- */

/* A grain that touches with a vanishing overlap meets at most what the elastic energy of that overlap and friction allow. */
static void grazing(const char *precision)
{
    physics_case c = hard_open("grazing", precision, NULL);
    double e = 2.0e11 / (1.0 - 0.09), m = sphere_mass(7800.0, 5.0e-3), energy = hard_energy(&c);
    const double depth[] = {0.0, 1e-15, 1e-12};
    double *w0 = case_field(&c, "spin");
    hard_auto(&c, 1000, 1.0);
    double *v = case_field(&c, "velocity"), *w = case_field(&c, "spin"), change = 0.0;
    for (int n = 0; n < 3; n++) {
        /* the impulse of the contact as it opens, twice for its damper: N t with t = sqrt(m / k) */
        double force = 4.0 / 3.0 * e * sqrt(5.0e-3) * pow(depth[n] + 2e-18, 1.5),
               time = sqrt(m / (2.0 * e * sqrt(5.0e-3 * (depth[n] + 2e-18))));
        double allowed = 10.0 * 10.0 * force * fmax(time, c.sim->dt) / m;
        change = fmax(change, fabs(v[3 * n] - 10.0) / allowed);
        change = fmax(change, 0.4 * 5.0e-3 * fabs(w[3 * n + 1] - w0[3 * n + 1]) / allowed);
    }
    if (strcmp(precision, "double") == 0)
        hard_margin(&c, "friction without pressure", "change of speed over that of ten times the friction's impulse", change, 1.0);
    hard_margin(&c, "friction without pressure", "energy gained, share", hard_energy(&c) / energy - 1.0, 1e-7);
    free(v);
    free(w);
    free(w0);
    case_close(&c);
}
IN_EVERY_PRECISION(grazing)

/* ---- walls, spins, free flight ---- */

static void paddle(const char *precision)
{
    physics_case c = hard_open("paddle", precision, NULL);
    double overlap = 0.0, outside = 0.0;
    while (c.sim->time < (hard_long() ? 1.0 : 0.17)) {
        hard_auto(&c, 400, 1.0);
        overlap = fmax(overlap, case_contact_sums(&c).overlap_max);
        double *x = case_field(&c, "position");
        const double high[] = {0.03, 0.01, 0.1};
        for (int64_t n = 0; n < c.bed.count; n++)
            for (int k = 0; k < 3; k++)
                outside = fmax(outside, 1.0 - fmin(x[3 * n + k], high[k] - x[3 * n + k]) / c.bed.radius[n]);
        free(x);
    }
    /* grains are wedged under its edge */
    hard_margin(&c, "wall through a bed", "largest overlap over the smaller radius", overlap, 0.2);
    hard_margin(&c, "wall through a bed", "largest depth in a wall over the radius", outside, 0.2);
    hard_margin(&c, "wall through a bed", "motion once it has passed over the sum of m g r", hard_unrest(&c), hard_long() ? 1e-6 : 10.0);
    case_close(&c);
}
IN_EVERY_PRECISION(paddle)

static void spinning(const char *precision)
{
    physics_case c = hard_open("spinning", precision, NULL);
    bool mixed = strcmp(precision, "mixed") == 0;
    const double dt = 1.0e-7;
    double worst = 0.0;
    int64_t steps = hard_long() ? 1000000 : 80000;
    for (int part = 0; part < 10; part++) {
        case_run(&c, steps / 10, dt);
        double *q = case_field(&c, "orientation");
        for (int n = 0; n < 2; n++)
            worst = fmax(worst, fabs(sqrt(q[4 * n] * q[4 * n] + q[4 * n + 1] * q[4 * n + 1] + q[4 * n + 2] * q[4 * n + 2] +
                                          q[4 * n + 3] * q[4 * n + 3]) -
                                     1.0));
        free(q);
    }
    hard_margin(&c, "spin of 1e5 rad/s", "length of the orientation from 1", worst, mixed ? 1e-6 : 1e-12);
    /* about z: half the angle turned, to what rounding of every step can add */
    double half = 0.5 * 1.0e5 * dt * (double)steps, *q = case_field(&c, "orientation");
    double w = 0.0, z = 0.0;
    for (int k = 0; k < 4; k++)
        if (k != 1 && k != 2)
            *(k == 0 ? &w : &z) = q[4 + k];
    hard_margin(&c, "spin of 1e5 rad/s", "angle turned from spin times time, share",
                2.0 * fabs(sin(half) * w - cos(half) * z) / (2.0 * half),
                mixed ? 0x1p-23 : 0x1p-50); /* spin and step are rounded to floats */
    free(q);
    case_close(&c);
}
IN_EVERY_PRECISION(spinning)

static void free_gas(const char *precision)
{
    physics_case c = hard_open("free_gas", precision, NULL);
    particle_sums before = case_sums(&c);
    double energy = hard_energy(&c), most = 0.0, momentum = 0.0, scale = sqrt(2.0 * before.mass * before.kinetic);
    int64_t steps = hard_long() ? 1000000 : 10000;
    for (int part = 0; part < 20; part++) {
        hard_auto(&c, steps / 20, 1.0);
        particle_sums now = case_sums(&c);
        for (int k = 0; k < 3; k++)
            momentum = fmax(momentum, fabs(now.momentum[k] - before.momentum[k]) / scale);
        most = fmax(most, hard_energy(&c) / energy);
    }
    /* an increment of a velocity is rounded to 2^-53 or, as a float, to 2^-24; the increments of all add up to a few times the momentum there is */
    hard_margin(&c, "free gas", "change of momentum over sqrt(2 M T)", momentum, strcmp(precision, "mixed") == 0 ? 0x1p-22 : 0x1p-50);
    hard_margin(&c, "free gas", "largest energy over that of the start", most, 1.01);
    case_close(&c);
}
IN_EVERY_PRECISION(free_gas)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(static_pile_all), cmocka_unit_test(pile_damped_critically_all),
        cmocka_unit_test(pile_rough_all),  cmocka_unit_test(pile_far_all),
        cmocka_unit_test(pile_smooth_all), cmocka_unit_test(fast_drop_all),
        cmocka_unit_test(mass_pair_all),   cmocka_unit_test(ratio_50_all),
        cmocka_unit_test(overlapping_all), cmocka_unit_test(grazing_all),
        cmocka_unit_test(paddle_all),      cmocka_unit_test(spinning_all),
        cmocka_unit_test(free_gas_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
