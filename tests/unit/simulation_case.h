/* A bed on the device from a few lines of YAML, or with grains put there by the test: what the tests of the simulation share. */
#ifndef CLAST_TESTS_SIMULATION_CASE_H
#define CLAST_TESTS_SIMULATION_CASE_H
#include "settings.h"
#include "simulation.h"
#include "tuning.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
/* cmocka has a macro called fail, so it comes last */
#include <cmocka.h>

typedef struct sim_case {
    scene *scene;
    bed bed;
    simulation *sim;
} sim_case;

/* One device a program; opened at first use. */
static inline device *case_device(void)
{
    static device opened;
    static bool open;
    failure why;
    if (!open && device_open("cpu", true, &opened, &why) != STATUS_OK && device_open(NULL, true, &opened, &why) != STATUS_OK)
        fail_msg("%s", why.text);
    if (!open)
        opened.tuning = tuning_default(&opened.info); /* what a user's machine has been tuned to is not what is tested */
    open = true;
    return &opened;
}

#define MUST(call)                                    \
    do {                                              \
        failure must_why = {.text = ""};              \
        failure *why = &must_why;                     \
        if ((call) != STATUS_OK)                      \
            fail_msg("%s: %s", #call, must_why.text); \
        (void)why;                                    \
    } while (0)

static inline uint64_t case_random_bits(uint64_t *state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* Uniform in [low, high). */
static inline double case_random(uint64_t *state, double low, double high)
{
    return low + (high - low) * (double)(case_random_bits(state) >> 11) * 0x1p-53;
}

static inline bed case_bed(int64_t count)
{
    size_t n = (size_t)count + 1;
    bed b = {.count = count,
             .position = calloc(n, sizeof *b.position),
             .velocity = calloc(n, sizeof *b.velocity),
             .spin = calloc(n, sizeof *b.spin),
             .radius = calloc(n, sizeof *b.radius),
             .temperature = calloc(n, sizeof *b.temperature),
             .material = calloc(n, sizeof *b.material),
             .group = calloc(n, sizeof *b.group)};
    assert_non_null(b.position && b.velocity && b.spin && b.radius && b.temperature && b.material && b.group ? b.position : NULL);
    return b;
}

static inline void case_measure(bed *b)
{
    for (int c = 0; c < 3; c++) {
        b->low[c] = INFINITY;
        b->high[c] = -INFINITY;
        for (int64_t i = 0; i < b->count; i++) {
            b->low[c] = fmin(b->low[c], b->position[i][c]);
            b->high[c] = fmax(b->high[c], b->position[i][c]);
        }
    }
}

/* The scene's own grains, ready for the first step of stage 0. */
static inline void case_open(sim_case *c, const char *yaml)
{
    settings set;
    settings_read(&set);
    MUST(scene_read_text(yaml, "case.yaml", set.count, set.at, &c->scene, why));
    MUST(bed_generate(c->scene, &c->bed, why));
    MUST(simulation_create(c->scene, &c->bed, case_device(), NULL, &c->sim, why));
    MUST(simulation_begin_stage(c->sim, 0, why));
}

/* The grains of `b`, which the case then owns; the scene's own one only makes it complete. */
static inline void case_open_bed(sim_case *c, const char *yaml, bed b)
{
    c->bed = b;
    case_measure(&c->bed);
    MUST(scene_read_text(yaml, "case.yaml", 0, NULL, &c->scene, why));
    MUST(simulation_create(c->scene, &c->bed, case_device(), NULL, &c->sim, why));
    MUST(simulation_begin_stage(c->sim, 0, why));
}

static inline void case_close(sim_case *c)
{
    simulation_free(c->sim);
    bed_free(&c->bed);
    scene_free(c->scene);
    memset(c, 0, sizeof *c);
}

/* Elements first..first + count - 1 of an array on the device. Caller frees. */
static inline void *case_read(simulation *sim, cl_mem mem, int64_t first, int64_t count, size_t size)
{
    void *data = malloc(size * (size_t)(count + 1));
    assert_non_null(data);
    if (count > 0)
        MUST(store_read(sim, mem, size * (uint64_t)first, size * (uint64_t)count, data, why));
    return data;
}

/* A particle field with its components side by side, in the order of the device. Caller frees. */
static inline double *case_field(simulation *sim, const char *name)
{
    stored_field *stored = store_find(sim, name);
    assert_non_null(stored);
    int components = stored->field->components;
    double *rows = malloc(sizeof *rows * (size_t)(sim->stride * components + 1));
    assert_non_null(rows);
    MUST(store_get(sim, stored->mem, stored->field->type, 0, sim->stride * components, rows, why));
    return rows;
}

#endif
