/* Random small scenes, put together from the descriptors of the laws: each keeps the invariants or is refused with a message.
 *
 *     fuzz_scenes [--seed S] [--structures N] [--sets M] [--seconds T] [--out DIR]     N choices of laws, shapes and precision, M sets of numbers each
 *     fuzz_scenes SCENE.yaml...                                                         scenes from files, one by one
 *
 * A scene that fails is made smaller, line by line, as long as it fails in the same way, and is left in DIR (default: here) as fuzz-S.yaml.
 * fuzz-running.yaml is the scene under way, in case the program itself ends. Programs are compiled once for each structure. */
#include "bed.h"
#include "device.h"
#include "frozen.h"
#include "ledger.h"
#include "scene.h"
#include "simulation.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define LINES_MAX 64
#define STEPS     600
#define LOOK      100

/* ---- random numbers ---- */

static uint64_t bits(uint64_t *state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static double uniform(uint64_t *state, double low, double high)
{
    return low + (high - low) * (double)(bits(state) >> 11) * 0x1p-53;
}

static double decades(uint64_t *state, double low, double high)
{
    return pow(10.0, uniform(state, low, high));
}

static bool chance(uint64_t *state, double share)
{
    return uniform(state, 0.0, 1.0) < share;
}

static int below(uint64_t *state, int count)
{
    return (int)(bits(state) % (uint64_t)count);
}

/* ---- a scene, as lines that can be left out one by one ---- */

typedef struct lines {
    int count;
    char *line[LINES_MAX];
} lines;

static void put(lines *t, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void put(lines *t, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    if (t->count == LINES_MAX || vasprintf(&t->line[t->count], format, values) < 0)
        abort();
    t->count++;
    va_end(values);
}

static char *join(const lines *t, const bool *left_out)
{
    size_t length = 1;
    for (int k = 0; k < t->count; k++)
        length += strlen(t->line[k]) + 1;
    char *text = calloc(length, 1);
    for (int k = 0; text && k < t->count; k++)
        if (!left_out || !left_out[k]) {
            strcat(text, t->line[k]);
            strcat(text, "\n");
        }
    return text;
}

static void lines_free(lines *t)
{
    for (int k = 0; k < t->count; k++)
        free(t->line[k]);
    t->count = 0;
}

/* ---- numbers for properties ---- */

/* Decades (or, where `even`, the range itself) that numbers are drawn from. A property that is not here follows its own default and range. */
static const struct {
    const char *key;
    double low, high;
    bool even;
} ranges[] = {
    {"density_kg_m3", 2.5, 4.0, false},
    {"youngs_modulus_pa", 6.0, 11.0, false},
    {"poissons_ratio", 0.0, 0.49, true},
    {"conductivity_w_mk", -2.0, 2.5, false},
    {"specific_heat_j_kgk", 0.0, 3.0, false},
    {"film_thickness_m", -8.0, -5.0, false},
    {"real_modulus_pa", 10.0, 11.5, false},
    {"heat_generation_w_m3", 2.0, 7.0, false},
    {"softening_temperature_k", 200, 600, true},
    {"softening_rate", 0.0, 5.0, true},
    {"modulus_floor_pa", 4.0, 6.0, false},
    {"restitution", 0.05, 1.0, true},
    {"normal_damping_ratio", 0.0, 1.5, true},
    {"friction_static", 0.0, 1.5, true},
    {"friction_dynamic", 0.0, 1.0, true},
    {"rolling_friction", 0.0, 0.5, true},
    {"normal_stiffness_n_m", 2.0, 6.0, false},
    {"tangential_stiffness_n_m", 2.0, 5.0, false},
    {"repulsion_stiffness", 7.0, 9.0, false},
    {"repulsion_exponent", 1.0, 2.0, true},
    {"bond_stiffness", 1.0, 4.0, false},
    {"bond_equilibrium_overlap_m", -8, -5.5, 0},
    {"bond_normalised_stiffness_n", -1, 1, 0},
    {"bond_equilibrium_strain", -4, -2, 0},
    {"bond_exponent", 0.5, 1.2, true},
    {"bond_threshold", 250, 450, true},
    {"bond_tensile_strength_pa", 4.0, 7.0, false},
    {"bond_shear_strength_pa", 4.0, 7.0, false},
    {"bond_youngs_modulus_pa", 6.0, 9.0, false},
    {"bond_shear_modulus_pa", 6.0, 9.0, false},
    {"bond_radius_ratio", 0.1, 1.0, true},
    {"bond_gap_ratio", -6.0, -1.5, false},
    {"work_of_adhesion_j_m2", -4.0, -0.5, false},
    {"expansion_1_k", -6.0, -4.0, false},
    {"reference_temperature_k", 200, 400, true},
    {"bond_damping_ratio", 0.0, 1.5, true},
    {"surface_energy_j_m2", -1.0, 0.5, false},
    {"boundary_diffusion_m3_s", -26.0, -18.0, false},
    {"atomic_volume_m3", -29.5, -28.0, false},
    {"activation_energy_j_mol", 2.0, 5.3, false},
    {"tangential_damping_ratio", 0, 1.5, true},
    {"rolling_damping_ratio", 0, 1.5, true},
};

static double draw(const char *key, double low, double high, double fallback, uint64_t *state)
{
    for (size_t k = 0; k < sizeof ranges / sizeof *ranges; k++)
        if (strcmp(ranges[k].key, key) == 0)
            return ranges[k].even ? uniform(state, ranges[k].low, ranges[k].high) : decades(state, ranges[k].low, ranges[k].high);
    if (low >= 0.0 && high <= 1.0)
        return uniform(state, low, high);
    double value = isfinite(fallback) && fallback != 0.0 ? fallback * decades(state, -1.0, 1.0) : decades(state, -1.0, 2.0);
    return fmin(high, fmax(low, value));
}

/* Properties of which a pair gives only one. */
static bool left_out(const char *key, uint64_t *state, const char *bond, const char *damping)
{
    static const char *const bonds[] = {"bond_stiffness", "bond_equilibrium_overlap_m", "bond_normalised_stiffness_n",
                                        "bond_equilibrium_strain"};
    for (int k = 0; k < 4; k++)
        if (strcmp(key, bonds[k]) == 0)
            return strcmp(key, bond) != 0;
    if (strcmp(key, "restitution") == 0 || strcmp(key, "normal_damping_ratio") == 0)
        return strcmp(key, damping) != 0;
    if (strstr(key, "strength") || strstr(key, "film") || strcmp(key, "friction_dynamic") == 0 || strstr(key, "_damping_ratio"))
        return chance(state, 0.5);
    return false;
}

static void put_properties(char *text, size_t size, const property *const *list, uint64_t *state)
{
    static const char *const bonds[] = {"bond_stiffness", "bond_equilibrium_overlap_m", "bond_normalised_stiffness_n",
                                        "bond_equilibrium_strain"};
    const char *bond = bonds[below(state, 4)], *damping = chance(state, 0.5) ? "restitution" : "normal_damping_ratio";
    for (; *list; list++) {
        size_t used = strlen(text);
        if (!left_out((*list)->key, state, bond, damping))
            snprintf(text + used, size - used, ", %s: %.6g", (*list)->key,
                     draw((*list)->key, (*list)->low, (*list)->high, (*list)->fallback, state));
    }
}

/* ---- structures: what decides the program ---- */

/* `shape` decides laws and shapes, `state` their numbers. */
static void put_option(char *text, size_t size, const law_option *o, uint64_t *shape, uint64_t *state)
{
    size_t used = strlen(text);
    if (o->choices) {
        char words[256], *rest = NULL, *word[16];
        int count = 0;
        snprintf(words, sizeof words, "%s", o->choices);
        for (char *w = strtok_r(words, "|", &rest); w && count < 16; w = strtok_r(NULL, "|", &rest))
            word[count++] = w;
        snprintf(text + used, size - used, ", %s: %s", o->key, word[below(shape, count)]);
    } else if (strcmp(o->key, "time_s") == 0 || strcmp(o->key, "depth_m") == 0) {
        snprintf(text + used, size - used, ", %s: %.6g", o->key, chance(state, 0.5) ? 0.0 : decades(state, -5.0, -3.0));
    } else if (strstr(o->key, "every_steps")) {
        snprintf(text + used, size - used, ", %s: %d", o->key, 1 + below(state, 200));
    } else {
        snprintf(text + used, size - used, ", %s: %.6g", o->key, draw(o->key, o->low, o->high, o->fallback, state));
    }
}

static void put_effect(lines *t, slot_id slot, uint64_t *shape, uint64_t *state)
{
    const law *choice[32];
    int count = 0;
    char text[1024] = "";
    for (int k = 0; laws[k]; k++)
        if (laws[k]->slot == slot && count < 32)
            choice[count++] = laws[k];
    if (count == 0)
        return;
    const law *one = choice[below(shape, count)];
    if (strcmp(one->name, "pipe_network") == 0) /* of two dimensions */
        one = choice[0];
    for (const law_option *o = one->options; o < one->options + LAW_OPTIONS_MAX && o->key; o++)
        if (slot != SLOT_SOURCE || (strcmp(o->key, "diameter_m") != 0 && strcmp(o->key, "depth_max_m") != 0))
            put_option(text, sizeof text, o, shape, state);
    if (slot == SLOT_SOURCE)
        snprintf(text + strlen(text), sizeof text - strlen(text),
                 ", name: beam, diameter_m: %.6g, direction: [%.3f, 0.1, -1]%s, path: {time_s: [0, 0.01], position_m: [[0, 0, 0], [0.01, "
                 "0.01, 0]], power_w: [%.6g, 0]}",
                 decades(state, -3.5, -1.5), uniform(state, -0.5, 0.5), strcmp(one->name, "burner") == 0 ? ", depth_max_m: 2.0e-3" : "",
                 decades(state, -4.0, 0.0));
    put(t, "  - {slot: %s, law: %s%s}", slot_name(slot), one->name, text);
}

static void put_walls(lines *t, bool periodic, uint64_t *shape, uint64_t *state)
{
    static const char *const heats[] = {"", ", temperature_k: 350", ", heat_flux_w: 1.0e-4", ""};
    const char *heat = heats[below(shape, 4)];
    if (chance(shape, 0.2))
        return;
    put(t, "walls:");
    if (periodic)
        put(t, "  - {name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]%s}", heat);
    else
        put(t, "  - {name: box, shape: box, low_m: [0, 0, 0], high_m: [0.01, 0.01, 0.02]%s%s}", heat,
            chance(shape, 0.5) ? ", open: [z_high]" : "");
    if (chance(shape, 0.3))
        put(t,
            "  - {name: plate, shape: disc, center_m: [0.005, 0.005, 0.001], radius_m: 0.003, normal: [0, 0.2, 1], motion: [{type: "
            "sinusoid, direction: [0, 0, 1], amplitude_m: %.6g, frequency_hz: %.6g}]}",
            decades(state, -6.0, -3.3), decades(state, 0.0, 2.0));
    if (!periodic && chance(shape, 0.2))
        put(t, "  - {name: tube, shape: cylinder, side: inside, axis_point_m: [0.005, 0.005, -0.01], axis: [0, 0, 1], radius_m: 0.0051, "
               "length_m: 0.05}");
    if (chance(shape, 0.15))
        put(t,
            "  - {name: lid, shape: plane, point_m: [0, 0, 0.02], normal: [0, 0, -1], servo: {direction: [0, 0, -1], pressure_pa: %.6g, "
            "speed_max_m_s: 0.5, area_m2: 1.0e-4}}",
            decades(state, 0.0, 3.0));
}

static void put_particles(lines *t, uint64_t *shape, uint64_t *state, int materials)
{
    bool spread = chance(shape, 0.7), two = chance(shape, 0.4);
    double mean = decades(state, -3.5, -3.0);
    put(t, "particles:");
    for (int g = 0; g <= two; g++) {
        const char *thermal = !g                   ? ""
                              : chance(shape, 0.2) ? ", thermal: flux, heat_flux_w: 1.0e-4"
                              : chance(shape, 0.2) ? ", motion: fixed"
                                                   : "";
        char radius[128];
        snprintf(radius, sizeof radius, spread ? "{distribution: uniform, low: %.6g, high: %.6g}" : "%.6g", mean,
                 mean * uniform(state, 1.1, 3.0));
        put(t,
            "  - {name: g%d, material: m%d, generator: random, count: %d, radius_m: %s, region: {low_m: [0, 0, %g], high_m: [0.01, 0.01, "
            "%g]}, velocity_m_s: [%.3f, %.3f, %.3f], spin_rad_s: [%.1f, %.1f, %.1f], temperature_k: %.1f%s}",
            g, g % materials, 2 + below(state, 12), radius, g * 0.01, g * 0.01 + 0.009, uniform(state, -1, 1), uniform(state, -1, 1),
            uniform(state, -1, 1), uniform(state, -100, 100), uniform(state, -100, 100), uniform(state, -100, 100),
            uniform(state, 100, 600), thermal);
    }
}

static void put_stages(lines *t, uint64_t *shape, bool heat)
{
    static const char *const methods[] = {"explicit", "stabilised", "implicit", "steady"};
    put(t, "stages:");
    put(t, "  - {name: go, until: {steps: %d}}", STEPS);
    if (heat && chance(shape, 0.4))
        put(t, "  - {name: still, until: {time_s: 1.0e-3}, motion: frozen, heat: {method: %s}}", methods[below(shape, 4)]);
    else if (chance(shape, 0.3))
        put(t, "  - {name: on, until: {steps: %d}, change: {gravity_m_s2: [1, 0, -5]}}", STEPS / 2);
}

static void make(uint64_t structure, uint64_t numbers, lines *t)
{
    uint64_t shape = structure * 7919u + 13u, state = numbers * 104729u + structure;
    bool periodic = chance(&shape, 0.25);
    int materials = chance(&shape, 0.3) ? 2 : 1;
    static const char *const gases[] = {"conductivity_w_mk: 0.025", "specific_heat_j_kgk: 1000", "viscosity_pa_s: 1.8e-5",
                                        "density_kg_m3: 1.2"};
    put(t, "seed: %d", 1 + below(&state, 1000000));
    put(t, "precision: %s", chance(&shape, 0.5) ? "mixed" : "double");
    put(t, "integrator: %s", chance(&shape, 0.3) ? "velocity_verlet" : "semi_implicit_euler");
    if (chance(&shape, 0.8))
        put(t, "gravity_m_s2: [%.3f, 0, %.3f]", uniform(&state, -3, 3), uniform(&state, -30, 0));
    put(t, "environment: {temperature_k: %.1f, gas: {%s, %s, %s, %s}}", uniform(&state, 100, 1000), gases[0], gases[1], gases[2], gases[3]);
    if (periodic)
        put(t, "domain: {low_m: [0, 0, -0.01], high_m: [0.01, 0.01, 0.05], periodic: [x, y], leaving: delete}");
    put(t, "effects:");
    bool normal = chance(&shape, 0.95), heat = false;
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++) {
        bool needs_normal = slot == SLOT_TANGENTIAL || slot == SLOT_ROLLING || slot == SLOT_BOND || slot == SLOT_COHESION;
        bool taken = slot == SLOT_NORMAL ? normal : chance(&shape, slot == SLOT_TANGENTIAL || slot == SLOT_ROLLING ? 0.6 : 0.3);
        if (!slot_is_listed(slot) || !taken || (needs_normal && !normal && chance(&shape, 0.9)))
            continue;
        put_effect(t, slot, &shape, &state);
        heat = heat || slot == SLOT_CONDUCTION || slot == SLOT_CONVECTION || slot == SLOT_RADIATION;
    }
    put(t, "materials:");
    for (int m = 0; m < materials; m++) {
        char text[4096] = "";
        put_properties(text, sizeof text, material_properties(), &state);
        put(t, "  - {name: m%d%s}", m, text);
    }
    char text[4096] = "";
    put_properties(text, sizeof text, interaction_properties(), &state);
    put(t, "interactions:");
    put(t, "  - {between: default%s}", text);
    put_walls(t, periodic, &shape, &state);
    put_particles(t, &shape, &state, materials);
    put_stages(t, &shape, heat);
    if (chance(&shape, 0.3))
        put(t, "output: {observables: [dissipated_normal, kinetic_energy]}");
}

/* ---- running one ---- */

typedef enum verdict { KEPT, REFUSED, STOPPED, BROKEN } verdict;

typedef struct outcome {
    verdict verdict;
    char what[64]; /* the invariant */
    char text[1024];
} outcome;

typedef struct fuzz_case {
    scene *scene;
    bed bed;
    simulation *sim;
    double energy, momentum[3], impulse, low, high; /* of the start */
    bool keeps_energy, keeps_momentum, keeps_range;
} fuzz_case;

static device the_device;

static void broken(outcome *o, const char *what, const char *format, ...) __attribute__((format(printf, 3, 4)));
static void broken(outcome *o, const char *what, const char *format, ...)
{
    va_list values;
    if (o->verdict == BROKEN)
        return;
    va_start(values, format);
    o->verdict = BROKEN;
    snprintf(o->what, sizeof o->what, "%s", what);
    vsnprintf(o->text, sizeof o->text, format, values);
    va_end(values);
}

static bool free_motion(const scene *s)
{
    for (int g = 0; g < s->group_count; g++)
        if (strstr(s->text, "motion: fixed"))
            return false;
    for (int w = 0; w < s->wall_count; w++)
        if (scene_wall_moves(s, w))
            return false;
    return !scene_has_servo(s);
}

static void what_holds(fuzz_case *c)
{
    const law *const *live = c->sim->all.law;
    bool passive = free_motion(c->scene) && !c->scene->domain.delete_leaving;
    c->keeps_energy = passive && !live[SLOT_BOND] && !live[SLOT_COHESION] && !live[SLOT_MODULUS] && !live[SLOT_RADIUS];
    c->keeps_momentum = passive && c->scene->wall_count == 0 && !live[SLOT_BODY];
    c->keeps_range = live[SLOT_TEMPERATURE] && !live[SLOT_SOURCE] && !live[SLOT_HEAT_GENERATION] && !live[SLOT_DISSIPATION_HEAT] &&
                     live[SLOT_WALL_HEAT] == NULL && !live[SLOT_THERMAL_GROUPS] && !live[SLOT_RADIUS];
}

static status energy_of(fuzz_case *c, double *out, particle_sums *sums, failure *why)
{
    contact_sums contacts = {0};
    TRY(observe_particle_sums(c->sim, sums, why));
    if (c->sim->live.law[SLOT_NORMAL])
        TRY(observe_contact_sums(c->sim, &contacts, why));
    *out = sums->kinetic + sums->rotational + sums->gravitational + contacts.elastic;
    return STATUS_OK;
}

static status begin(fuzz_case *c, failure *why)
{
    particle_sums sums;
    heat_sums heat;
    what_holds(c);
    TRY(energy_of(c, &c->energy, &sums, why));
    memcpy(c->momentum, sums.momentum, sizeof c->momentum);
    c->impulse = sqrt(2.0 * sums.mass * sums.kinetic) + 1e-30;
    if (c->sim->all.law[SLOT_TEMPERATURE]) {
        TRY(heat_observe(c->sim, &heat, why));
        double around = quantity_at(&c->scene->environment.temperature_k, 0.0);
        c->low = fmin(heat.lowest, isnan(around) ? INFINITY : around);
        c->high = fmax(heat.highest, isnan(around) ? -INFINITY : around);
    }
    return STATUS_OK;
}

static status look(fuzz_case *c, outcome *o, failure *why)
{
    double energy, g = sqrt(pow(c->sim->gravity[0], 2) + pow(c->sim->gravity[1], 2) + pow(c->sim->gravity[2], 2));
    particle_sums sums;
    guard_finding found;
    found.stop = false;
    if (!c->sim->live.frozen)
        TRY(guard_check(c->sim, &found, why));
    if (found.stop) {
        o->verdict = STOPPED;
        snprintf(o->text, sizeof o->text, "%.1000s", found.text);
        if (strstr(found.text, "not a number"))
            broken(o, "numbers", "%.1000s", found.text);
        return STATUS_OK;
    }
    TRY(energy_of(c, &energy, &sums, why));
    double eps = c->sim->mixed ? 1e-5 : 1e-9;
    if (!isfinite(energy))
        broken(o, "numbers", "the energy is not a number at step %lld", (long long)c->sim->step);
    /* collisions may be sampled as coarsely as ten steps each: what a contact stores then is out by some per cent of what moves */
    double moving = sums.kinetic + sums.rotational + g * sums.weight_radius;
    if (c->keeps_energy && c->sim->stage == 0 && energy > c->energy + 0.3 * fmax(moving, fabs(c->energy)) + eps)
        broken(o, "energy", "energy has risen from %.6g to %.6g J at step %lld (%.3g of it in motion)", c->energy, energy,
               (long long)c->sim->step, moving);
    for (int k = 0; k < 3 && c->keeps_momentum && c->sim->stage == 0; k++) {
        double expected = c->momentum[k] + sums.mass * c->sim->gravity[k] * c->sim->time;
        double scale = c->impulse + sums.mass * g * c->sim->time + sqrt(2.0 * sums.mass * sums.kinetic);
        if (fabs(sums.momentum[k] - expected) > (c->sim->mixed ? 1e-4 : 1e-10) * scale)
            broken(o, "momentum", "momentum %d is %.9g, not %.9g, at step %lld", k, sums.momentum[k], expected, (long long)c->sim->step);
    }
    if (!c->sim->all.law[SLOT_TEMPERATURE] || c->sim->count == 0)
        return STATUS_OK;
    heat_sums heat;
    TRY(heat_observe(c->sim, &heat, why));
    if (!isfinite(heat.mean) || !(heat.lowest > 0.0))
        broken(o, "temperatures", "temperatures run from %.6g to %.6g K at step %lld", heat.lowest, heat.highest, (long long)c->sim->step);
    double slack = eps * c->high + (c->sim->stage ? 1e-4 * (c->high - c->low) : 0.0); /* frozen stages are exact to their tolerance */
    if (c->keeps_range && (heat.lowest < c->low - slack || heat.highest > c->high + slack))
        broken(o, "temperatures", "temperatures run from %.9g to %.9g K at step %lld, and began between %.9g and %.9g", heat.lowest,
               heat.highest, (long long)c->sim->step, c->low, c->high);
    return STATUS_OK;
}

static status advance(simulation *sim, int64_t steps, failure *why)
{
    step_limit limit;
    for (int64_t done = 0; done < steps; done += LOOK) {
        TRY(limit_find(sim, &limit, why));
        simulation_set_step(sim, isfinite(limit.recommended_s) ? limit.recommended_s : 1e-5);
        TRY(simulation_advance(sim, LOOK < steps - done ? LOOK : steps - done, why));
    }
    return STATUS_OK;
}

static bool same_bits(simulation *a, simulation *b, const char *field, failure *why, status *result)
{
    double *x = NULL, *y = NULL;
    bool same = true;
    if (!store_find(a, field))
        return true;
    *result = observe_field(a, field, &x, why);
    if (*result == STATUS_OK)
        *result = observe_field(b, field, &y, why);
    if (*result == STATUS_OK)
        same = memcmp(x, y, sizeof *x * (size_t)a->id_count * (size_t)store_find(a, field)->field->components) == 0;
    free(x);
    free(y);
    return same;
}

/* A run that goes on from a saved state is the run that went on. */
static status resumes(fuzz_case *c, outcome *o, failure *why)
{
    static const char *const fields[] = {"position", "velocity", "spin", "temperature", "radius"};
    simulation *again = NULL;
    bundle state;
    bundle_init(&state);
    status result = state_save(c->sim, &state, why);
    if (result == STATUS_OK)
        result = simulation_create(c->scene, &c->bed, &the_device, NULL, &again, why);
    if (result == STATUS_OK)
        result = state_load(again, &state, "saved state", why);
    if (result == STATUS_OK)
        result = simulation_advance(c->sim, LOOK, why);
    if (result == STATUS_OK)
        result = simulation_advance(again, LOOK, why);
    for (int f = 0; f < 5 && result == STATUS_OK; f++)
        if (!same_bits(c->sim, again, fields[f], why, &result) && result == STATUS_OK)
            broken(o, "resume", "the %s of a run that goes on from a saved state differs", fields[f]);
    simulation_free(again);
    bundle_free(&state);
    return result;
}

static status run_frozen(fuzz_case *c, const scene_stage *stage, failure *why)
{
    double end = c->sim->time + stage->until_time_s;
    for (int k = 0; k < 1000 && c->sim->time < end; k++)
        TRY(frozen_advance(c->sim, end, 1, why));
    return STATUS_OK;
}

static status run_stages(fuzz_case *c, outcome *o, failure *why)
{
    for (int s = 0; s < c->scene->stage_count && o->verdict == KEPT; s++) {
        const scene_stage *stage = &c->scene->stage[s];
        TRY(simulation_begin_stage(c->sim, s, why));
        if (s == 0)
            TRY(begin(c, why));
        if (stage->frozen) {
            TRY(run_frozen(c, stage, why));
            TRY(look(c, o, why));
            continue;
        }
        int64_t steps = stage->until_steps > 0 ? stage->until_steps : STEPS;
        for (int64_t done = 0; done < steps && o->verdict == KEPT; done += 2 * LOOK) {
            TRY(advance(c->sim, 2 * LOOK, why));
            TRY(look(c, o, why));
        }
        if (o->verdict == KEPT)
            TRY(resumes(c, o, why));
    }
    return STATUS_OK;
}

/* `scene_text`: what a scene file holds. */
static outcome run_text(const char *text, const char *name)
{
    fuzz_case c = {0};
    outcome o = {.verdict = KEPT};
    failure why = {""};
    bool generated = false;
    status result = scene_read_text(text, name, 0, NULL, &c.scene, &why);
    if (result == STATUS_OK) {
        result = bed_generate(c.scene, &c.bed, &why);
        generated = result == STATUS_OK;
    }
    if (result == STATUS_OK)
        result = simulation_create(c.scene, &c.bed, &the_device, NULL, &c.sim, &why);
    if (result == STATUS_OK)
        result = run_stages(&c, &o, &why);
    if (result != STATUS_OK && o.verdict != BROKEN) {
        o.verdict = result == STATUS_BAD_INPUT ? REFUSED : STOPPED;
        snprintf(o.text, sizeof o.text, "%.1000s", why.text);
        if (!why.text[0] || (result != STATUS_BAD_INPUT && result != STATUS_GUARD))
            broken(&o, "message", "ends with status %d and says: %.900s", result, why.text);
        if (result != STATUS_OK && strstr(why.text, "nan"))
            broken(&o, "message", "speaks of what is not a number: %.900s", why.text);
    }
    simulation_free(c.sim);
    if (generated)
        bed_free(&c.bed);
    scene_free(c.scene);
    return o;
}

/* ---- making a failure smaller ---- */

static void shrink(const lines *t, const char *what, bool *left)
{
    bool smaller = true;
    memset(left, 0, sizeof(bool) * LINES_MAX);
    while (smaller) {
        smaller = false;
        for (int k = t->count - 1; k >= 0; k--) {
            if (left[k])
                continue;
            left[k] = true;
            char *text = join(t, left);
            outcome o = run_text(text, "smaller.yaml");
            free(text);
            if (o.verdict == BROKEN && strcmp(o.what, what) == 0)
                smaller = true;
            else
                left[k] = false;
        }
    }
}

static void write_scene(const char *folder, const char *name, const char *comment, const char *text)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    if (!file)
        return;
    for (const char *c = comment; *c; c++)
        fprintf(file, "%s%c", c == comment ? "# " : "", *c == '\n' ? ' ' : *c);
    fprintf(file, "%s%s", *comment ? "\n" : "", text);
    fclose(file);
}

static bool one_scene(uint64_t structure, uint64_t numbers, const char *folder, int counts[4])
{
    lines t = {0};
    bool left[LINES_MAX];
    make(structure, numbers, &t);
    char *text = join(&t, NULL);
    write_scene(folder, "fuzz-running.yaml", "", text);
    outcome o = run_text(text, "fuzz.yaml");
    counts[o.verdict]++;
    if (getenv("CLAST_FUZZ_SAYS") && o.verdict != KEPT)
        printf("%llu/%llu: %s\n", (unsigned long long)structure, (unsigned long long)numbers, o.text);
    if (o.verdict == BROKEN) {
        char name[64], *small;
        printf("structure %llu, numbers %llu, %s: %s\n", (unsigned long long)structure, (unsigned long long)numbers, o.what, o.text);
        fflush(stdout);
        shrink(&t, o.what, left);
        small = join(&t, left);
        snprintf(name, sizeof name, "fuzz-%llu-%llu.yaml", (unsigned long long)structure, (unsigned long long)numbers);
        write_scene(folder, name, o.text, small);
        printf("  made smaller: %s/%s\n", folder, name);
        free(small);
    }
    free(text);
    lines_free(&t);
    return o.verdict != BROKEN;
}

static int run_file(const char *path)
{
    FILE *file = fopen(path, "r");
    char text[65536];
    if (!file) {
        fprintf(stderr, "%s: cannot be read\n", path);
        return 2;
    }
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    outcome o = run_text(text, path);
    printf("%s: %s %s\n", path, o.verdict == BROKEN ? o.what : o.verdict == KEPT ? "keeps the invariants" : "refused or stopped:", o.text);
    return o.verdict == BROKEN;
}

int main(int argc, char **argv)
{
    failure why;
    uint64_t seed = 1, structures = 3, sets = 12;
    double seconds = INFINITY;
    const char *folder = ".";
    int counts[4] = {0}, failed = 0, files = 0;
    setvbuf(stdout, NULL, _IOLBF, 0);
    if (device_open(NULL, true, &the_device, &why) != STATUS_OK) {
        fprintf(stderr, "%s\n", why.text);
        return 3;
    }
    for (int k = 1; k < argc; k++) {
        const char *value = k + 1 < argc ? argv[k + 1] : "";
        if (strcmp(argv[k], "--seed") == 0)
            seed = strtoull(value, NULL, 10), k++;
        else if (strcmp(argv[k], "--structures") == 0)
            structures = strtoull(value, NULL, 10), k++;
        else if (strcmp(argv[k], "--sets") == 0)
            sets = strtoull(value, NULL, 10), k++;
        else if (strcmp(argv[k], "--seconds") == 0)
            seconds = strtod(value, NULL), k++;
        else if (strcmp(argv[k], "--out") == 0)
            folder = value, k++;
        else
            failed += run_file(argv[k]) != 0, files++;
    }
    if (files > 0)
        return failed > 0;
    time_t start = time(NULL);
    for (uint64_t s = seed; s < seed + structures && difftime(time(NULL), start) < seconds; s++)
        for (uint64_t n = 1; n <= sets && difftime(time(NULL), start) < seconds; n++)
            failed += !one_scene(s, n, folder, counts);
    printf("%d scenes kept the invariants, %d were refused, %d were stopped by a guard, %d broke an invariant\n", counts[KEPT],
           counts[REFUSED], counts[STOPPED], counts[BROKEN]);
    char running[4096];
    snprintf(running, sizeof running, "%s/fuzz-running.yaml", folder);
    remove(running);
    return failed > 0;
}
