/* Hard cases of heat, bonds, and of everything at once: what must hold stands at the top of each scene. */
#include "hard_case.h"

#define G 9.81

enum { NORMAL, TANGENTIAL, ROLLING, WALLS, STIFFNESS, EXPANSION, GRAVITY, BODY, GROUPS };

static heat_sums heat_of(physics_case *c)
{
    heat_sums sums;
    MUST(heat_observe(c->sim, &sums, why));
    return sums;
}

static bool is_mixed(const char *precision)
{
    return strcmp(precision, "mixed") == 0;
}

/* ---- heat ---- */

/* A column softens to its floor: the overlaps are those of Hertz's law there, and no grain ever moves faster than it sinks. */
static void softening(const char *precision)
{
    physics_case c = hard_open("softening", precision, NULL);
    double e = 1.0e7 / (1.0 - 0.09), m = sphere_mass(7800.0, 1.0e-3), most = 0.0;
    while (c.sim->time < (hard_long() ? 0.4 : 0.04)) {
        hard_auto(&c, 1000, 1.0);
        most = fmax(most, hard_unrest(&c));
    }
    hard_margin(&c, "softening under load", "largest motion over the sum of m g r", most, 0.1);
    hard_margin(&c, "softening under load", "motion at the end over the sum of m g r", hard_unrest(&c), hard_long() ? 1e-8 : 1e-5);
    for (int k = 0; k < 4; k++) {
        double weight = (4 - k) * m * G, overlap = k == 0 ? hertz_rest(e, 1.0e-3, weight) : hertz_rest(0.5 * e, 0.5e-3, weight);
        double found = k == 0 ? hard_overlap(&c, 0, -1) : hard_overlap(&c, k - 1, k);
        hard_margin(&c, "softening under load", "overlap against Hertz at the floor modulus, share", fabs(found / overlap - 1.0),
                    hard_long() ? 1e-4 : 0.05);
    }
    case_close(&c);
}

static void heating(const char *precision)
{
    physics_case c = hard_open("heating", precision, NULL);
    double past = 0.0, before = 1.0;
    while (c.sim->time < (hard_long() ? 0.5 : 0.04)) {
        hard_auto(&c, 200, 1.0);
        heat_sums heat = heat_of(&c);
        past = fmax(past, fmax(heat.highest / 3000.0 - 1.0, before / heat.lowest - 1.0));
        before = heat.lowest;
    }
    hard_margin(&c, "heating from 1 K to 3000 K", "share of a temperature beyond what heats it", past, is_mixed(precision) ? 1e-6 : 1e-12);
    hard_margin(&c, "heating from 1 K to 3000 K", "coldest grain short of 3000 K at the end, share", 1.0 - before / 3000.0,
                hard_long() ? 1e-6 : 0.7);
    case_close(&c);
}

static void radiation(const char *precision)
{
    physics_case c = hard_open("radiation", precision, NULL);
    double past = 0.0;
    step_limit limit = case_limit(&c);
    if (!(limit.heat.all < INFINITY && limit.limit_s <= limit.heat.all))
        fail_msg("the step of %g s is not within that of radiation, %g s", limit.limit_s, limit.heat.all);
    for (int part = 0; part < (hard_long() ? 200 : 15); part++) {
        hard_auto(&c, 200, 1.0);
        past = fmax(past, heat_of(&c).highest / 5000.0 - 1.0);
    }
    hard_margin(&c, "radiation at 5000 K", "share of a temperature beyond 5000 K", past, is_mixed(precision) ? 1e-6 : 1e-12);
    /* alone: dT/dt = 3 B (T_e^4 - T^4) / (rho c r), at rest in t ~ rho c r / (12 B T_e^3), 3.5e-8 s here */
    double gone = c.sim->time * 12.0 * 5.670367e-8 * pow(5000.0, 3) / (1000.0 * 1.0 * 1.0e-6);
    hard_margin(&c, "radiation at 5000 K", "smallest grain short of 5000 K after many times of its own, share",
                gone > 20.0 ? fabs(case_get(&c, "temperature", 0, 0) / 5000.0 - 1.0) : 1.0, 1e-6);
    case_close(&c);
}

static void parting(const char *precision)
{
    physics_case c = hard_open("parting", precision, NULL);
    double content = heat_of(&c).content, past = 0.0, wrong = 0.0;
    double *before = case_field(&c, "temperature");
    for (int part = 0; part < 200; part++) {
        hard_auto(&c, part < 100 ? 1 : 20, 1.0);
        double *now = case_field(&c, "temperature");
        heat_sums heat = heat_of(&c);
        past = fmax(past, fmax(heat.highest / 3000.0 - 1.0, 1.0 - heat.lowest));
        for (int n = 0; n < 8; n++) {
            double rise = (now[n] - before[n]) / 3000.0;
            wrong = fmax(wrong, n < 4 ? rise : -rise); /* the hot ones do not get hotter, nor the cold ones colder */
            before[n] = now[n];
        }
        free(now);
    }
    free(before);
    hard_margin(&c, "conduction as contacts open", "share of a temperature beyond the range of both", past,
                is_mixed(precision) ? 1e-6 : 1e-14);
    hard_margin(&c, "conduction as contacts open", "heat that flows the wrong way, share", wrong, is_mixed(precision) ? 1e-7 : 1e-15);
    hard_margin(&c, "conduction as contacts open", "heat lost or made, share", fabs(heat_of(&c).content / content - 1.0),
                is_mixed(precision) ? 0x1p-22 : 1e-13);
    case_close(&c);
}

/* ---- bonds ---- */

/* Beams without dampers: what they store and give back never adds up to more than there was. */
static void bonded_chain(const char *precision)
{
    physics_case c = hard_open("bonded_chain", precision, NULL);
    hard_auto(&c, 2, 1.0); /* bonds are made */
    particle_sums before = case_sums(&c);
    bond_sums bonds;
    double energy = before.kinetic + before.rotational, most = 0.0, scale = sqrt(2.0 * before.mass * before.kinetic), change = 0.0,
           limit = case_limit(&c).live_s;
    for (int part = 0; part < 50; part++) {
        case_run(&c, (hard_long() ? 1000000 : 10000) / 50, 0.98 * limit);
        hard_guard(&c);
        particle_sums now = case_sums(&c);
        most = fmax(most, (now.kinetic + now.rotational) / energy);
        for (int k = 0; k < 3; k++)
            change = fmax(change, fabs(now.momentum[k] - before.momentum[k]) / scale);
    }
    MUST(bonds_count(c.sim, &bonds, why));
    hard_margin(&c, "bonds at 0.98 of the step limit", "largest energy of motion over that of the start", most, 1.1);
    hard_margin(&c, "bonds at 0.98 of the step limit", "change of momentum over sqrt(2 M T)", change, is_mixed(precision) ? 1e-5 : 1e-11);
    hard_margin(&c, "bonds at 0.98 of the step limit", "bonds lost", (double)(10 - bonds.alive), 0.0);
    case_close(&c);
}

static void sticky_pile(const char *precision)
{
    physics_case c = hard_open("sticky_pile", precision, NULL);
    hard_settle(&c, 1e-9, 400000);
    double *from = case_field(&c, "position"), most = 0.0;
    for (int part = 0; part < 10; part++) {
        hard_auto(&c, hard_long() ? 100000 : 1000, 1.0);
        most = fmax(most, hard_unrest(&c));
    }
    hard_margin(&c, "pile of adhesive bonds", "motion at rest over the sum of m g r", most, 1e-8);
    hard_margin(&c, "pile of adhesive bonds", "move after rest over the smallest radius", hard_move(&c, from), 1e-5);
    free(from);
    case_close(&c);
}

/* ---- grains that swell until they jam ---- */

/* Sum of the forces of a wall on its grains, and of their sizes. */
static double force_of_wall(physics_case *c, int wall, double sum[3])
{
    int64_t count;
    live_contact *live = case_contacts(c, &count);
    double sizes = 0.0;
    memset(sum, 0, 3 * sizeof *sum);
    for (int64_t k = 0; k < count; k++) {
        if (live[k].wall != wall)
            continue;
        const double *f = live[k].force;
        sizes += sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
        for (int a = 0; a < 3; a++)
            sum[a] += f[a];
    }
    free(live);
    return sizes;
}

static void swells(physics_case *c, const char *name, double motion)
{
    double e[LEDGER_TERMS], overlap = 0.0, energy = hard_energy(c);
    while (c->sim->time < (hard_long() ? 0.1 : 0.012)) {
        hard_auto(c, 400, 1.0);
        overlap = fmax(overlap, case_contact_sums(c).overlap_max);
    }
    MUST(ledger_read(c->sim, e, why));
    particle_sums sums = case_sums(c);
    double moves = sums.kinetic + sums.rotational, elastic = case_contact_sums(c).elastic;
    double lost = e[NORMAL] + e[TANGENTIAL] + e[ROLLING], fed = e[EXPANSION] + e[WALLS];
    hard_margin(c, name, "largest overlap over the smaller radius", overlap, 0.3);
    hard_margin(c, name, "motion at the end over what is stored", moves / elastic, motion);
    hard_margin(c, name, "energy that is missing over the work of expansion", fabs(hard_energy(c) - energy + lost - fed) / e[EXPANSION],
                0.02);
}

static void jam_box(const char *precision)
{
    physics_case c = hard_open("jam_box", precision, NULL);
    swells(&c, "swelling in a closed box", 1e-12);
    double *x = case_field(&c, "position"), *r = case_field(&c, "radius"), deep = 0.0, force[3], sizes = force_of_wall(&c, 0, force);
    for (int64_t n = 0; n < c.bed.count; n++)
        for (int a = 0; a < 3; a++)
            deep = fmax(deep, 1.0 - fmin(x[3 * n + a], 8.0e-3 - x[3 * n + a]) / r[n]);
    hard_margin(&c, "swelling in a closed box", "depth in a wall over the radius", deep, 0.3);
    /* faces that bear the same are what rest means */
    hard_margin(&c, "swelling in a closed box", "force of all its walls over the sum of its forces",
                fmax(fmax(fabs(force[0]), fabs(force[1])), fabs(force[2])) / sizes, hard_long() || !is_mixed(precision) ? 1e-6 : 1e-4);
    free(x);
    free(r);
    case_close(&c);
}

static void jam_periodic(const char *precision)
{
    physics_case c = hard_open("jam_periodic", precision, NULL);
    swells(&c, "swelling in a periodic box", 1e-12);
    particle_sums sums = case_sums(&c);
    double most = 0.0;
    for (int a = 0; a < 3; a++)
        most = fmax(most, fabs(sums.momentum[a]));
    /* of grains that move by their size in the time that they swell; rounding adds up over all that jammed contacts exchange, 1e5 times as much */
    hard_margin(&c, "swelling in a periodic box", "momentum over that of 1 mm in 5 ms", most / (sums.mass * 0.2),
                is_mixed(precision) ? 1e-4 : 1e-12);
    case_close(&c);
}

static void jam_servo(const char *precision)
{
    physics_case c = hard_open("jam_servo", precision, NULL);
    swells(&c, "swelling under a lid", 1e-3); /* grains that bear nothing fly on, and there is no gravity that ends it */
    double lid[3];
    force_of_wall(&c, 1, lid);
    hard_margin(&c, "swelling under a lid", "force on the lid from its pressure, share", fabs(fabs(lid[2]) / (2.0e4 * 6.4e-5) - 1.0),
                !hard_long()          ? 1e-2
                : is_mixed(precision) ? 1e-4
                                      : 1e-6);
    case_close(&c);
}

/* ---- everything ---- */

static void everything(const char *precision)
{
    physics_case c = hard_open("everything", precision, NULL);
    double e[LEDGER_TERMS], lowest = INFINITY;
    heat_sums start = heat_of(&c), heat = start;
    double energy = hard_energy(&c);
    while (c.sim->time < (hard_long() ? 5.0 : 0.06)) {
        hard_auto(&c, 1000, 1.0);
        heat = heat_of(&c);
        lowest = fmin(lowest, heat.lowest);
    }
    bond_sums bonds;
    MUST(bonds_count(c.sim, &bonds, why));
    assert_true(bonds.made > 0);
    MUST(ledger_read(c.sim, e, why));
    double through = heat.tally[CLAST_TALLY_SOURCES] + fabs(heat.tally[CLAST_TALLY_CONVECTION]) + fabs(heat.tally[CLAST_TALLY_RADIATION]) +
                     fabs(heat.tally[CLAST_TALLY_WALLS]) + heat.tally[CLAST_TALLY_DISSIPATION];
    double gained = heat.tally[CLAST_TALLY_SOURCES] + heat.tally[CLAST_TALLY_CONVECTION] + heat.tally[CLAST_TALLY_RADIATION] +
                    heat.tally[CLAST_TALLY_WALLS] + heat.tally[CLAST_TALLY_DISSIPATION];
    double dissipated = e[NORMAL] + e[TANGENTIAL] + e[ROLLING], lost = dissipated + e[BODY];
    hard_margin(&c, "everything at once", "heat that is missing over what went through",
                fabs(heat.content - start.content - gained) / through, is_mixed(precision) ? 1e-5 : 1e-10);
    hard_margin(&c, "everything at once", "heat of dissipation against the ledger's, share",
                fabs(heat.tally[CLAST_TALLY_DISSIPATION] / dissipated - 1.0), is_mixed(precision) ? 1e-4 : 1e-9);
    hard_margin(&c, "everything at once", "energy that is missing over what was dissipated",
                fabs(hard_energy(&c) - energy + lost - e[WALLS] - e[STIFFNESS] - e[EXPANSION] - e[GROUPS]) / lost, 0.05);
    hard_margin(&c, "everything at once", "coldest grain below 290 K, K", 290.0 - lowest, 0.0);
    case_close(&c);
}

IN_EVERY_PRECISION(softening)
IN_EVERY_PRECISION(heating)
IN_EVERY_PRECISION(radiation)
IN_EVERY_PRECISION(parting)
IN_EVERY_PRECISION(bonded_chain)
IN_EVERY_PRECISION(sticky_pile)
IN_EVERY_PRECISION(jam_box)
IN_EVERY_PRECISION(jam_periodic)
IN_EVERY_PRECISION(jam_servo)
IN_EVERY_PRECISION(everything)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(softening_all),  cmocka_unit_test(heating_all),      cmocka_unit_test(radiation_all),
        cmocka_unit_test(parting_all),    cmocka_unit_test(bonded_chain_all), cmocka_unit_test(sticky_pile_all),
        cmocka_unit_test(everything_all), cmocka_unit_test(jam_box_all),      cmocka_unit_test(jam_periodic_all),
        cmocka_unit_test(jam_servo_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
