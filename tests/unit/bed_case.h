/* Scenes of one group, and a bed checked against every pair: what the tests of the generators share. */
#ifndef CLAST_TESTS_BED_CASE_H
#define CLAST_TESTS_BED_CASE_H
#include "bed.h"

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

#define PI 3.14159265358979323846

/* A scene of one group at rest without temperatures; the caller fills in the generator. */
static inline scene case_scene(particle_group *group, int dimensions)
{
    *group = (particle_group){.name = "bed", .temperature_k = NAN, .at = {.line = 12, .column = 5}};
    return (scene){.dimensions = dimensions, .seed = 1, .group_count = 1, .group = group, .path = "scene.yaml"};
}

static inline radius_spec radius_uniform(double low, double high)
{
    return (radius_spec){.distribution = RADIUS_UNIFORM, .low = low, .high = high};
}

/* Mean volume of a sphere of uniform radius: (4/3) pi (b^4 - a^4)/(4 (b - a)). */
static inline double mean_volume_uniform(double a, double b)
{
    return 4.0 / 3.0 * PI * 0.25 * (a + b) * (a * a + b * b);
}

static inline double mean_area_uniform(double a, double b)
{
    return PI / 3.0 * (a * a + a * b + b * b);
}

static inline bed case_generate(const scene *s)
{
    bed b;
    failure why = {0};
    status result = bed_generate(s, &b, &why);
    if (result != STATUS_OK)
        fail_msg("%s", why.text);
    return b;
}

/* The scene is refused with a message that holds every one of the pieces (the last is NULL). */
static inline void case_refused(const scene *s, const char *const *pieces)
{
    bed b;
    failure why = {0};
    assert_int_equal(bed_generate(s, &b, &why), STATUS_BAD_INPUT);
    assert_int_equal(b.count, 0);
    assert_null(b.position);
    for (; *pieces; pieces++)
        if (!strstr(why.text, *pieces))
            fail_msg("no `%s` in `%s`", *pieces, why.text);
}

#define REFUSED(s, ...) case_refused(s, (const char *const[]){__VA_ARGS__, NULL})

/* Deepest overlap over all pairs and their nearest images, as a fraction of the smaller radius; exact zero where they do not touch. */
static inline double brute_force_overlap(const bed *b, const domain *box)
{
    double worst = 0.0;
    for (int64_t i = 0; i < b->count; i++)
        for (int64_t j = 0; j < i; j++) {
            double distance2 = 0.0, radii = b->radius[i] + b->radius[j];
            for (int d = 0; d < 3; d++) {
                double x = fabs(b->position[i][d] - b->position[j][d]);
                if (box->given && box->periodic[d])
                    x = fmin(x, fabs(box->high_m[d] - box->low_m[d] - x));
                distance2 += x * x;
            }
            if (distance2 < radii * radii)
                worst = fmax(worst, (radii - sqrt(distance2)) / fmin(b->radius[i], b->radius[j]));
        }
    return worst;
}

#endif
