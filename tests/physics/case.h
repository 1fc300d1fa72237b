/* A scene from text, run step by step and read: what the tests of the physics share. Every failure of the program ends the test with the
 * program's own message. CLAST_KERNELS names a directory of kernels to test instead of the embedded ones, CLAST_TEST_SET settings that every
 * scene is given (settings.h). */
#ifndef CLAST_TESTS_CASE_H
#define CLAST_TESTS_CASE_H
#include "bed.h"
#include "device.h"
#include "restitution.h"
#include "scene.h"
#include "settings.h"
#include "simulation.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
/* cmocka wants the headers above */
#include <cmocka.h>

#define PI          3.14159265358979323846
#define COUNT_OF(a) ((int)(sizeof(a) / sizeof *(a)))

/* ---- text ---- */

/* A scene that is put together piece by piece. */
typedef struct text {
    char *at;
    size_t length, room;
} text;

static inline void put(text *t, const char *format, ...) __attribute__((format(printf, 2, 3)));
static inline void put(text *t, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    char *piece = NULL;
    int length = vasprintf(&piece, format, values);
    va_end(values);
    assert_true(length >= 0);
    if (t->length + (size_t)length + 1 > t->room) {
        t->room = 2 * (t->length + (size_t)length + 1);
        t->at = realloc(t->at, t->room);
        assert_non_null(t->at);
    }
    memcpy(t->at + t->length, piece, (size_t)length + 1);
    t->length += (size_t)length;
    free(piece);
}

/* One row of a `list` generator. */
static inline void put_grain(text *t, double radius, const double *x, const double *v, const double *w)
{
    put(t,
        "      - {radius_m: %.17g, position_m: [%.17g, %.17g, %.17g], velocity_m_s: [%.17g, %.17g, %.17g], spin_rad_s: [%.17g, %.17g, "
        "%.17g]}\n",
        radius, x[0], x[1], x[2], v[0], v[1], v[2], w[0], w[1], w[2]);
}

/* ---- a case ---- */

typedef struct physics_case {
    scene *scene;
    bed bed;
    simulation *sim;
} physics_case;

#define MUST(call)                          \
    do {                                    \
        failure must_why_ = {{0}};          \
        failure *why = &must_why_;          \
        if ((call) != STATUS_OK)            \
            fail_msg("%s", must_why_.text); \
    } while (0)

/* One device for all cases of a program. */
static inline device *case_device(void)
{
    static device shared;
    if (!shared.context)
        MUST(device_open(NULL, true, &shared, why));
    return &shared;
}

/* Stages may be left out: one is added. Takes the text over. */
static inline physics_case case_open(text *t)
{
    physics_case c = {0};
    if (!strstr(t->at, "\nstages:"))
        put(t, "\nstages: [{name: run, until: {steps: 1}}]\n");
    settings set;
    settings_read(&set);
    MUST(scene_read_text(t->at, "case.yaml", set.count, set.at, &c.scene, why));
    MUST(bed_generate(c.scene, &c.bed, why));
    MUST(simulation_create(c.scene, &c.bed, case_device(), getenv("CLAST_KERNELS"), &c.sim, why));
    MUST(simulation_begin_stage(c.sim, 0, why));
    free(t->at);
    *t = (text){0};
    return c;
}

static inline void case_close(physics_case *c)
{
    simulation_free(c->sim);
    bed_free(&c->bed);
    scene_free(c->scene);
}

/* Stopped, and taken up again by a simulation of its own. */
static inline void case_stop_and_resume(physics_case *c)
{
    bundle saved;
    bundle_init(&saved);
    MUST(state_save(c->sim, &saved, why));
    simulation_free(c->sim);
    MUST(simulation_create(c->scene, &c->bed, case_device(), getenv("CLAST_KERNELS"), &c->sim, why));
    MUST(state_load(c->sim, &saved, "memory", why));
    bundle_free(&saved);
}

static inline void case_run(physics_case *c, int64_t steps, double dt)
{
    if (dt != c->sim->dt)
        simulation_set_step(c->sim, dt);
    MUST(simulation_advance(c->sim, steps, why));
}

static inline void case_stage(physics_case *c, int stage)
{
    MUST(simulation_begin_stage(c->sim, stage, why));
}

/* A field in the order of the scene; caller frees. */
static inline double *case_field(physics_case *c, const char *name)
{
    double *values = NULL;
    MUST(observe_field(c->sim, name, &values, why));
    return values;
}

/* Component of a field of one grain. */
static inline double case_get(physics_case *c, const char *name, int grain, int component)
{
    double *values = case_field(c, name);
    double value = values[grain * store_find(c->sim, name)->field->components + component];
    free(values);
    return value;
}

static inline particle_sums case_sums(physics_case *c)
{
    particle_sums sums;
    MUST(observe_particle_sums(c->sim, &sums, why));
    return sums;
}

static inline contact_sums case_contact_sums(physics_case *c)
{
    contact_sums sums;
    MUST(observe_contact_sums(c->sim, &sums, why));
    return sums;
}

/* Contacts as they stand; caller frees. */
static inline live_contact *case_contacts(physics_case *c, int64_t *count)
{
    live_contact *contacts = NULL;
    MUST(observe_contacts(c->sim, false, &contacts, count, why));
    return contacts;
}

/* Sum of the contacts' forces or torques on every grain; caller frees. */
static inline double *case_totals(physics_case *c, bool torque)
{
    double *totals = NULL;
    MUST(observe_totals(c->sim, torque, &totals, why));
    return totals;
}

static inline step_limit case_limit(physics_case *c)
{
    step_limit limit;
    MUST(limit_find(c->sim, &limit, why));
    return limit;
}

/* ---- numbers ---- */

#define NEAR(value, expected, tolerance)                                                                                                  \
    do {                                                                                                                                  \
        double near_value_ = (value), near_expected_ = (expected), near_tolerance_ = (tolerance);                                         \
        if (!(fabs(near_value_ - near_expected_) <= near_tolerance_))                                                                     \
            fail_msg("%s is %.15g, not %.15g (%s) to %.3g: off by %.3g", #value, near_value_, near_expected_, #expected, near_tolerance_, \
                     near_value_ - near_expected_);                                                                                       \
    } while (0)
#define RELATIVE(value, expected, tolerance) NEAR(value, expected, (tolerance)*fabs(expected))
#define BETWEEN(value, low, high)                                                                                        \
    do {                                                                                                                 \
        double between_value_ = (value);                                                                                 \
        if (!(between_value_ >= (low) && between_value_ <= (high)))                                                      \
            fail_msg("%s is %.15g, not between %.15g and %.15g", #value, between_value_, (double)(low), (double)(high)); \
    } while (0)

/* ---- bounds in mixed precision ---- */

/* What one operation of the pair arithmetic loses of its result: half the last place of a float. */
#define FLOAT_ROUNDING 0x1p-24
/* Operations one after another from overlap, slip or temperatures, given exactly, to a force, a moment or a flow, and on to the increment of
 * a velocity or a temperature: no law takes more. Increments are added up without loss, so what has taken increments of one sign is known as
 * well as one of them. Where a difference is taken on the way, the number of roundings grows by the ratio of its terms to itself. */
#define LAW 16.0

/* A bound that holds in double, or `roundings` of a float, where the scene runs in mixed precision and they are more. */
static inline double within(double in_double, double roundings)
{
    return case_mixed() ? fmax(in_double, roundings * FLOAT_ROUNDING) : in_double;
}

/* A number that is kept as two floats knows 2^-48 of its size; so many additions lose as often that. Places are counted from a bed's length
 * below the bed: `size` is twice that length. */
static inline double kept(double in_double, double size, double additions)
{
    return case_mixed() ? fmax(in_double, additions * size * 0x1p-48) : in_double;
}

/* Of a body that keeps its shape as it turns by `angle` in so many steps: roundings of either sign, a step's each, of momenta that turn as
 * much. */
static inline double turning_error(double in_double, double angle, double steps)
{
    return within(in_double, LAW * angle / sqrt(steps));
}

static inline double sphere_mass(double density, double radius)
{
    return 4.0 / 3.0 * PI * density * radius * radius * radius;
}

/* Of a Hertz collision without damping at relative speed v: largest overlap, and duration. */
static inline double hertz_overlap(double modulus, double radius, double mass, double v)
{
    return pow(15.0 * mass * v * v / (16.0 * modulus * sqrt(radius)), 0.4);
}

static inline double hertz_duration(double modulus, double radius, double mass, double v)
{
    return 2.94327518 * hertz_overlap(modulus, radius, mass, v) / v;
}

/* Overlap of a contact that holds a force. */
static inline double hertz_rest(double modulus, double radius, double force)
{
    return pow(3.0 * force / (4.0 * modulus * sqrt(radius)), 2.0 / 3.0);
}

#endif
