#include "scene.h"

#include "law.h"
#include "numbers.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STEPS 600

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

char *lines_join(const lines *t, const bool *left_out)
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

void lines_free(lines *t)
{
    for (int k = 0; k < t->count; k++)
        free(t->line[k]);
    t->count = 0;
}

/* `shape` decides what the program is made of, laws and shapes; `state` decides stages, motions and numbers. */
typedef struct world {
    lines *t;
    uint64_t shape, state;
    bool flat; /* two dimensions: up is y, else z */
    enum { CLOSED, SIDEWAYS, EVERYWHERE } periodic;
    int materials;
    bool heat, warm, modulus, box, plate, lid, two, slot[SLOT_COUNT]; /* what the scene has */
    double side, low; /* grains begin within these of the sides and above the floor, clear of its walls */
} world;

/* [along, across, up] as the scene wants it. Holds for eight calls. */
static const char *place(const world *w, double along, double across, double up)
{
    static char text[8][96];
    static int turn;
    char *at = text[turn = (turn + 1) % 8];
    if (w->flat)
        snprintf(at, sizeof *text, "[%.6g, %.6g, 0]", along, up);
    else
        snprintf(at, sizeof *text, "[%.6g, %.6g, %.6g]", along, across, up);
    return at;
}

/* ---- effects ---- */

/* Where a program has them as constants, the options of a law are of the structure. */
static void put_option(world *w, char *text, size_t size, const law *of, const law_option *o)
{
    size_t used = strlen(text);
    uint64_t *state = of->constants ? &w->shape : &w->state;
    if (o->choices) {
        char words[256], *rest = NULL, *word[16];
        int count = 0;
        snprintf(words, sizeof words, "%s", o->choices);
        for (char *one = strtok_r(words, "|", &rest); one && count < 16; one = strtok_r(NULL, "|", &rest))
            word[count++] = one;
        snprintf(text + used, size - used, ", %s: %s", o->key, word[below(&w->shape, count)]);
    } else if (strcmp(o->key, "time_s") == 0 || strcmp(o->key, "depth_m") == 0) {
        snprintf(text + used, size - used, ", %s: %.6g", o->key, chance(state, 0.5) ? 0.0 : decades(state, -5.0, -3.0));
    } else if (strstr(o->key, "every_steps")) {
        snprintf(text + used, size - used, ", %s: %d", o->key, 1 + below(state, 200));
    } else {
        snprintf(text + used, size - used, ", %s: %.6g", o->key, draw(o->key, o->low, o->high, o->fallback, state));
    }
}

static void put_effect(world *w, slot_id slot)
{
    const law *choice[32];
    int count = 0;
    char text[1024] = "";
    for (int k = 0; laws[k]; k++)
        if (laws[k]->slot == slot && count < 32)
            choice[count++] = laws[k];
    if (count == 0)
        return;
    const law *one = choice[below(&w->shape, count)];
    if (!w->flat && strcmp(one->name, "pipe_network") == 0) /* of two dimensions */
        one = choice[0];
    for (const law_option *o = one->options; o < one->options + LAW_OPTIONS_MAX && o->key; o++)
        if (slot != SLOT_SOURCE || (strcmp(o->key, "diameter_m") != 0 && strcmp(o->key, "depth_max_m") != 0))
            put_option(w, text, sizeof text, one, o);
    if (slot == SLOT_SOURCE)
        snprintf(text + strlen(text), sizeof text - strlen(text),
                 ", name: beam, diameter_m: %.6g, direction: %s%s, path: {time_s: [0, 0.01], position_m: [%s, %s], power_w: [%.6g, 0]}",
                 decades(&w->state, -3.5, -1.5), place(w, uniform(&w->state, -0.5, 0.5), 0.1, -1.0),
                 strcmp(one->name, "burner") == 0 ? ", depth_max_m: 2.0e-3" : "", place(w, 0.0, 0.0, 0.0), place(w, 0.01, 0.01, 0.0),
                 decades(&w->state, -4.0, 0.0));
    put(w->t, "  - {slot: %s, law: %s%s}", slot_name(slot), one->name, text);
    w->slot[slot] = true;
    w->modulus = w->modulus || (slot == SLOT_MODULUS && strcmp(one->name, "table") == 0);
    w->heat = w->heat || slot == SLOT_CONDUCTION || slot == SLOT_CONVECTION || slot == SLOT_RADIATION;
    w->warm = w->warm || w->heat || slot == SLOT_MODULUS || slot == SLOT_RADIUS || slot == SLOT_SOURCE;
}

static void put_effects(world *w)
{
    bool normal = chance(&w->shape, 0.95);
    put(w->t, "effects:");
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++) {
        bool needs_normal = slot == SLOT_TANGENTIAL || slot == SLOT_ROLLING || slot == SLOT_BOND || slot == SLOT_COHESION;
        bool taken = slot == SLOT_NORMAL ? normal : chance(&w->shape, slot == SLOT_TANGENTIAL || slot == SLOT_ROLLING ? 0.6 : 0.3);
        if (slot_is_listed(slot) && taken && (!needs_normal || normal || chance(&w->shape, 0.1)))
            put_effect(w, slot);
    }
}

static void put_matter(world *w)
{
    put(w->t, "materials:");
    for (int m = 0; m < w->materials; m++) {
        char text[8192] = "";
        put_properties(text, sizeof text, material_properties(), w->warm, w->modulus, &w->shape, &w->state);
        put(w->t, "  - {name: m%d%s}", m, text);
    }
    char text[8192] = "";
    put_properties(text, sizeof text, interaction_properties(), w->warm, false, &w->shape, &w->state);
    put(w->t, "interactions:");
    put(w->t, "  - {between: default%s}", text);
}

/* ---- walls ---- */

static const char *motion(world *w)
{
    static char text[256];
    if (chance(&w->state, 0.6))
        snprintf(text, sizeof text, "[{type: sinusoid, direction: %s, amplitude_m: %.6g, frequency_hz: %.6g}]", place(w, 0.0, 0.0, 1.0),
                 decades(&w->state, -6.0, -3.3), decades(&w->state, 0.0, 2.0));
    else if (chance(&w->state, 0.5))
        snprintf(text, sizeof text, "[{type: rotation, point_m: %s, axis: [0, %d, %d], rate_rad_s: %.6g}]", place(w, 0.005, 0.005, 0.001),
                 !w->flat, w->flat, uniform(&w->state, -50, 50));
    else
        snprintf(text, sizeof text, "[{type: constant, velocity_m_s: %s}]", place(w, uniform(&w->state, -0.1, 0.1), 0.0, 0.05));
    return text;
}

/* Round walls around the bed, in place of a box. */
static void put_round(world *w)
{
    w->side = 0.0015;
    if (chance(&w->shape, 0.6)) {
        put(w->t, "  - {name: tube, shape: cylinder, side: inside, axis_point_m: [0.005, 0.005, -0.01], axis: [0, 0, 1], radius_m: 0.0051, "
                  "length_m: 0.05}");
        put(w->t, "  - {name: bottom, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}");
    } else {
        put(w->t, "  - {name: funnel, shape: cone, side: inside, axis_point_m: [0.005, 0.005, -0.002], axis: [0, 0, 1], radius_m: [0.003, "
                  "0.012], length_m: 0.02}");
        w->low = 0.006;
    }
}

/* Obstacles under the grains. */
static void put_obstacles(world *w)
{
    double up = w->periodic == EVERYWHERE ? 0.005 : 0.001; /* clear of the domain's lower face where that is periodic */
    if (w->plate && w->flat)
        put(w->t,
            "  - {name: plate, shape: rectangle, corners_m: [[0.003, %g, -0.01], [0.007, %g, -0.01], [0.003, %g, 0.01]], motion: "
            "%s}",
            up, up, up, motion(w));
    else if (w->plate)
        put(w->t, "  - {name: plate, shape: disc, center_m: [0.005, 0.005, %g], radius_m: 0.003, normal: [0, 0.2, 1], motion: %s}", up,
            motion(w));
    bool peg = chance(&w->shape, 0.25);
    if (peg)
        put(w->t, "  - {name: peg, shape: cylinder, side: outside, axis_point_m: [0.005, %g, %g], axis: [0, %d, %d], radius_m: 1.0e-3, length_m: 0.02}",
            w->flat ? up : -0.005, w->flat ? -0.01 : up, !w->flat, w->flat);
    if (w->plate || peg)
        w->low = fmax(w->low, up + 0.0011);
}

static void put_walls(world *w)
{
    static const char *const heats[] = {"", ", temperature_k: 350", ", heat_flux_w: 1.0e-4",
                                        ", temperature_k: {time_s: [0, 0.001], value: [300, 500]}"};
    const char *heat = heats[below(&w->shape, 4)];
    bool grouped = w->periodic == CLOSED && chance(&w->shape, 0.2);
    w->plate = chance(&w->shape, w->periodic == EVERYWHERE ? 0.3 : 0.35);
    if (w->periodic == EVERYWHERE ? !w->plate : chance(&w->shape, 0.15)) {
        w->plate = false;
        return;
    }
    if (grouped)
        put(w->t, "wall_groups: [{name: press, servo: {direction: %s, force_n: %.6g, speed_max_m_s: 0.2}}]", place(w, 0.0, 0.0, -1.0),
            decades(&w->state, -4.0, 0.0));
    put(w->t, "walls:");
    if (w->periodic == SIDEWAYS)
        put(w->t, "  - {name: floor, shape: plane, point_m: [0, 0, 0], normal: %s%s}", place(w, 0.0, 0.0, 1.0), heat);
    bool round = !w->flat && w->periodic == CLOSED && chance(&w->shape, 0.25);
    w->box = w->periodic == CLOSED && !round;
    if (round)
        put_round(w);
    else if (w->box)
        put(w->t, "  - {name: box, shape: box, low_m: [0, 0, %g], high_m: [0.01, %g, %g]%s%s}", w->flat ? -0.01 : 0.0,
            w->flat ? 0.02 : 0.01, w->flat ? 0.01 : 0.02, heat,
            chance(&w->shape, 0.5) ? (w->flat ? ", open: [y_high]" : ", open: [z_high]") : "");
    put_obstacles(w);
    if (grouped)
        for (int k = 0; k < 2; k++)
            put(w->t, "  - {name: press%d, shape: plane, point_m: %s, normal: %s, group: press}", k, place(w, 0.0, 0.0, 0.02 + 1e-3 * k),
                place(w, 0.0, 0.0, -1.0));
    w->lid = w->periodic != EVERYWHERE && !grouped && chance(&w->shape, 0.2);
    if (w->lid)
        put(w->t,
            "  - {name: lid, shape: plane, point_m: %s, normal: %s, servo: {direction: %s, pressure_pa: %.6g, speed_max_m_s: 0.5, area_m2: "
            "1.0e-4}}",
            place(w, 0.0, 0.0, 0.02), place(w, 0.0, 0.0, -1.0), place(w, 0.0, 0.0, -1.0), decades(&w->state, 0.0, 3.0));
}

/* ---- grains ---- */

static const char *extras(world *w)
{
    static char text[256];
    if (w->warm && chance(&w->shape, 0.2))
        return ", thermal: flux, heat_flux_w: 1.0e-4";
    if (w->warm && chance(&w->shape, 0.15))
        return ", thermal: prescribed";
    if (chance(&w->shape, 0.2))
        return ", motion: fixed";
    if (chance(&w->shape, 0.15)) {
        snprintf(text, sizeof text, ", motion: %s", motion(w));
        return text;
    }
    return "";
}

static void put_particles(world *w)
{
    bool spread = chance(&w->shape, 0.7);
    double mean = decades(&w->state, -3.5, -3.0);
    w->two = chance(&w->shape, 0.5);
    put(w->t, "particles:");
    for (int g = 0; g <= w->two; g++) {
        char radius[128];
        uint64_t *s = &w->state;
        snprintf(radius, sizeof radius, spread ? "{distribution: uniform, low: %.6g, high: %.6g}" : "%.6g", mean,
                 mean * uniform(s, 1.1, 3.0));
        put(w->t,
            "  - {name: g%d, material: m%d, generator: random, count: %d, radius_m: %s, region: {low_m: %s, high_m: %s}, velocity_m_s: %s, "
            "velocity_spread_m_s: %.3f, spin_rad_s: [%.1f, %.1f, %.1f], temperature_k: %.1f%s}",
            g, g % w->materials, 2 + below(s, 12), radius, place(w, w->side, w->side, g * 0.01 + (g ? 0.0 : w->low)),
            place(w, 0.01 - w->side, 0.01 - w->side, g * 0.01 + 0.009), place(w, uniform(s, -1, 1), uniform(s, -1, 1), uniform(s, -1, 1)),
            chance(s, 0.5) ? 0.0 : uniform(s, 0, 1), w->flat ? 0.0 : uniform(s, -100, 100), w->flat ? 0.0 : uniform(s, -100, 100),
            uniform(s, -100, 100), uniform(s, 100, 600), g ? extras(w) : "");
    }
}

/* ---- stages ---- */

static void put_change(world *w)
{
    if (w->plate && chance(&w->state, 0.5))
        put(w->t, "  - {name: other, until: {steps: %d}, change: {walls: [{name: plate, motion: %s}]}}", STEPS / 2, motion(w));
    else if (w->lid && chance(&w->state, 0.7))
        put(w->t, "  - {name: held, until: {steps: %d}, change: {walls: [{name: lid, servo: off}]}}", STEPS / 2);
    else if (w->box && w->heat && chance(&w->state, 0.5))
        put(w->t, "  - {name: hot, until: {steps: %d}, change: {walls: [{name: box, temperature_k: 700}]}}", STEPS / 2);
    else if (w->two && chance(&w->state, 0.4))
        put(w->t, "  - {name: loose, until: {steps: %d}, change: {particles: [{name: g1, motion: %s}]}}", STEPS / 2,
            chance(&w->state, 0.5) ? "free" : "fixed");
    else if (chance(&w->state, 0.3))
        put(w->t,
            "  - {name: slippery, until: {steps: %d}, change: {interactions: [{between: default, friction_static: 0.01, rolling_friction: "
            "0}]}}",
            STEPS / 2);
    else
        put(w->t, "  - {name: tilted, until: {steps: %d}, change: {gravity_m_s2: %s}}", STEPS / 2, place(w, 1.0, 0.0, -5.0));
}

static void put_stages(world *w)
{
    static const char *const methods[] = {"explicit", "stabilised", "implicit", "steady"};
    static const slot_id off[] = {SLOT_TANGENTIAL, SLOT_ROLLING, SLOT_CONDUCTION, SLOT_RADIATION, SLOT_BODY, SLOT_COHESION, SLOT_SOURCE};
    put(w->t, "stages:");
    if (w->heat && chance(&w->shape, 0.25))
        put(w->t, "  - {name: go, until: {steps: %d}, heat: {every_steps: %d}}", STEPS, 1 + below(&w->state, 20));
    else
        put(w->t, "  - {name: go, until: {steps: %d}}", STEPS);
    bool frozen = w->heat && chance(&w->state, 0.4);
    if (frozen)
        put(w->t, "  - {name: still, until: {time_s: 1.0e-3}, motion: frozen, heat: {method: %s}}", methods[below(&w->state, 4)]);
    if (chance(&w->state, frozen ? 0.5 : 0.35))
        put_change(w);
    slot_id without = off[below(&w->shape, 7)];
    if (chance(&w->shape, 0.4) && w->slot[without])
        put(w->t, "  - {name: without, until: {steps: %d}, effects_off: [%s]}", STEPS / 2, slot_name(without));
}

/* How contacts are searched and steps are enqueued: nothing of it may change what comes out. */
static void put_table(world *w)
{
    static const char *const forms[] = {"step_form: one_group", "step_form: two_kernels", "kernel_form: items", "kernel_form: blocks",
                                        "batch_steps: 1",       "batch_steps: 7",         "chunk_records: 64",  "skin_m: 1.0e-4"};
    if (chance(&w->shape, 0.4))
        put(w->t, "contact_table: {%s}", forms[below(&w->shape, 8)]);
}

void random_scene(uint64_t structure, uint64_t numbers, lines *t)
{
    world w = {.t = t, .shape = structure * 7919u + 13u, .state = numbers * 104729u + structure};
    w.flat = chance(&w.shape, 0.2);
    w.periodic = chance(&w.shape, 0.65) ? CLOSED : chance(&w.shape, 0.6) ? SIDEWAYS : EVERYWHERE;
    w.materials = chance(&w.shape, 0.3) ? 2 : 1;
    put(t, "seed: %d", 1 + below(&w.state, 1000000));
    if (w.flat)
        put(t, "dimensions: 2");
    put(t, "precision: %s", chance(&w.shape, 0.5) ? "mixed" : "double");
    put(t, "integrator: %s", chance(&w.shape, 0.4) ? "velocity_verlet" : "semi_implicit_euler");
    if (chance(&w.shape, 0.8))
        put(t, "gravity_m_s2: %s", place(&w, uniform(&w.state, -3, 3), 0.0, uniform(&w.state, -30, 0)));
    put(t,
        "environment: {temperature_k: %.1f, gas: {conductivity_w_mk: 0.025, specific_heat_j_kgk: 1000, viscosity_pa_s: 1.8e-5, "
        "density_kg_m3: 1.2}}",
        uniform(&w.state, 100, 1000));
    if (w.periodic == SIDEWAYS)
        put(t, "domain: {low_m: %s, high_m: %s, periodic: [%s], leaving: delete}", w.flat ? "[0, -0.01, -0.01]" : "[0, 0, -0.01]",
            w.flat ? "[0.01, 0.05, 0.01]" : "[0.01, 0.01, 0.05]", w.flat ? "x" : "x, y");
    else if (w.periodic == EVERYWHERE)
        put(t, "domain: {low_m: %s, high_m: %s, periodic: [%s]}", w.flat ? "[0, 0, -0.01]" : "[0, 0, 0]",
            w.flat ? "[0.01, 0.02, 0.01]" : "[0.01, 0.01, 0.02]", w.flat ? "x, y" : "x, y, z");
    put_effects(&w);
    put_matter(&w);
    put_walls(&w);
    put_particles(&w);
    put_stages(&w);
    put_table(&w);
    if (chance(&w.shape, 0.3))
        put(t, "output: {observables: [dissipated_normal, kinetic_energy]}");
}
