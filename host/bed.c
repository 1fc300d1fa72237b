#include "bed.h"

#include "bed_group.h"
#include "random.h"
#include "radius.h"
#include "sphere_grid.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

status bed_refuse(const scene *s, int group, failure *why, const char *format, ...)
{
    const particle_group *g = &s->group[group];
    char where[1024], text[2048];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    const char *path = s->path ? s->path : "scene", *name = g->name ? g->name : "?";
    if (g->at.line > 0)
        snprintf(where, sizeof where, "%s:%d:%d", path, g->at.line, g->at.column);
    else
        snprintf(where, sizeof where, "%s", path);
    return fail(why, STATUS_BAD_INPUT, "%s: particles[%s]: %s", where, name, text);
}

static bool grow(void **array, int64_t count, size_t each)
{
    void *grown = realloc(*array, (size_t)count * each);
    if (grown)
        *array = grown;
    return grown != NULL;
}

status bed_extend(const scene *s, int group, int64_t count, bed *b, int64_t *first, failure *why)
{
    const particle_group *g = &s->group[group];
    if (count < 1)
        return bed_refuse(s, group, why, "the group has %" PRId64 " particles; it needs at least 1", count);
    if (count > INT32_MAX - b->count)
        return bed_refuse(s, group, why, "%" PRId64 " particles on top of the %" PRId64 " before; a scene holds at most %d", count,
                          b->count, INT32_MAX);
    int64_t all = b->count + count;
    if (!grow((void **)&b->position, all, sizeof *b->position) || !grow((void **)&b->velocity, all, sizeof *b->velocity) ||
        !grow((void **)&b->spin, all, sizeof *b->spin) || !grow((void **)&b->radius, all, sizeof *b->radius) ||
        !grow((void **)&b->scalar, all, sizeof *b->scalar) || !grow((void **)&b->temperature, all, sizeof *b->temperature) || !grow((void **)&b->material, all, sizeof *b->material) ||
        !grow((void **)&b->group, all, sizeof *b->group))
        return fail(why, STATUS_ERROR, "out of memory for %" PRId64 " particles", all);
    *first = b->count;
    for (int64_t i = *first; i < all; i++) {
        memset(b->position[i], 0, sizeof b->position[i]);
        memcpy(b->velocity[i], g->velocity_m_s, sizeof b->velocity[i]);
        memcpy(b->spin[i], g->spin_rad_s, sizeof b->spin[i]);
        b->radius[i] = 0.0;
        b->temperature[i] = g->temperature_k;
        b->scalar[i] = g->scalar;
        b->material[i] = g->material;
        b->group[i] = group;
    }
    b->count = all;
    return STATUS_OK;
}

bool bed_radius_given(const particle_group *group)
{
    return group->radius_m.distribution != RADIUS_NUMBER || group->radius_m.value > 0.0;
}

status bed_draw_radii(const scene *s, int group, bed *b, int64_t first, failure *why)
{
    radius_sampler sampler;
    failure inner;
    status result = radius_sampler_init(&s->group[group].radius_m, &sampler, &inner);
    if (result != STATUS_OK) {
        bed_refuse(s, group, why, "%s", inner.text);
        return result;
    }
    for (int64_t i = first; i < b->count; i++)
        b->radius[i] = radius_draw(&sampler, s->seed, (uint32_t)group, (uint32_t)(i - first));
    radius_sampler_free(&sampler);
    return STATUS_OK;
}

/* What an item leaves out (NAN) is the group's. */
static void take_given(double *value, const double *given, int count)
{
    for (int d = 0; d < count; d++)
        if (!isnan(given[d]))
            value[d] = given[d];
}

status bed_list(const scene *s, int group, bed *b, failure *why)
{
    const particle_group *g = &s->group[group];
    int64_t first;
    TRY(bed_extend(s, group, g->item_count, b, &first, why));
    if (bed_radius_given(g))
        TRY(bed_draw_radii(s, group, b, first, why));
    for (int k = 0; k < g->item_count; k++) {
        const particle_item *item = &g->item[k];
        int64_t i = first + k;
        memcpy(b->position[i], item->position_m, sizeof b->position[i]);
        take_given(b->velocity[i], item->velocity_m_s, 3);
        take_given(b->spin[i], item->spin_rad_s, 3);
        take_given(&b->radius[i], &item->radius_m, 1);
        take_given(&b->temperature[i], &item->temperature_k, 1);
        take_given(&b->scalar[i], &item->scalar, 1);
    }
    return STATUS_OK;
}

static status check_flat(const scene *s, const bed *b, int64_t i, int64_t index, failure *why)
{
    const char *const name[] = {"z", "vz", "wx", "wy"};
    const double value[] = {b->position[i][2], b->velocity[i][2], b->spin[i][0], b->spin[i][1]};
    for (int k = 0; k < 4; k++)
        if (value[k] != 0.0)
            return bed_refuse(s, b->group[i], why, "particle %" PRId64 " has %s = %g; in a scene of 2 dimensions that must be 0", index,
                              name[k], value[k]);
    return STATUS_OK;
}

static status check_numbers(const scene *s, const bed *b, int64_t i, int64_t index, failure *why)
{
    int group = b->group[i];
    for (int d = 0; d < 3; d++) {
        if (!isfinite(b->position[i][d]))
            return bed_refuse(s, group, why, "particle %" PRId64 " has %c = %g m; positions must be finite", index, "xyz"[d],
                              b -> position[i][d]);
        if (!isfinite(b->velocity[i][d]))
            return bed_refuse(s, group, why, "particle %" PRId64 " has v%c = %g m/s; velocities must be finite", index, "xyz"[d],
                              b -> velocity[i][d]);
        if (!isfinite(b->spin[i][d]))
            return bed_refuse(s, group, why, "particle %" PRId64 " has w%c = %g rad/s; spins must be finite", index, "xyz"[d],
                              b -> spin[i][d]);
    }
    if (!(b->radius[i] > 0.0 && isfinite(b->radius[i])))
        return bed_refuse(s, group, why, "particle %" PRId64 " has radius %g m; it must be above 0 and finite", index, b->radius[i]);
    if (isinf(b->temperature[i]) || b->temperature[i] <= 0.0)
        return bed_refuse(s, group, why, "particle %" PRId64 " has temperature %g K; it must be above 0", index, b->temperature[i]);
    if (isnan(b->temperature[i]) && scene_has_temperature(s))
        return bed_refuse(s, group, why, "particle %" PRId64 " has no temperature; add `temperature_k` to the group", index);
    return s->dimensions == 2 ? check_flat(s, b, i, index, why) : STATUS_OK;
}

/* Wraps along periodic directions; along the others a centre on the face is still inside. */
static status place_in_domain(const scene *s, bed *b, int64_t i, int64_t index, failure *why)
{
    const domain *box = &s->domain;
    sphere_space space = sphere_space_of(box);
    for (int d = 0; d < 3 && box->given; d++) {
        double *x = &b->position[i][d];
        if (d == 2 && s->dimensions == 2)
            continue;
        *x = sphere_wrap(&space, d, *x);
        if (!(*x >= box->low_m[d] && *x <= box->high_m[d]))
            return bed_refuse(s, b->group[i], why, "particle %" PRId64 " is at %c = %.9g m, outside the domain (%.9g to %.9g m)", index,
                              "xyz"[d], *x, box -> low_m[d], box -> high_m[d]);
    }
    return STATUS_OK;
}

static status check_group(const scene *s, bed *b, int64_t first, failure *why)
{
    for (int64_t i = first; i < b->count; i++) {
        TRY(check_numbers(s, b, i, i - first, why));
        TRY(place_in_domain(s, b, i, i - first, why));
    }
    return STATUS_OK;
}

static status generate_group(const scene *s, int group, bed *b, failure *why)
{
    switch (s->group[group].generator) {
    case GENERATOR_LIST:
        return bed_list(s, group, b, why);
    case GENERATOR_LATTICE:
        return bed_lattice(s, group, b, why);
    case GENERATOR_RANDOM:
        return bed_random(s, group, b, why);
    case GENERATOR_CSV:
        return bed_csv(s, group, b, why);
    case GENERATOR_RESULT:
        return bed_result(s, group, b, why);
    }
    return fail(why, STATUS_ERROR, "unknown generator %d", (int)s->group[group].generator);
}

static void measure_box(bed *b)
{
    for (int d = 0; d < 3; d++) {
        b->low[d] = INFINITY;
        b->high[d] = -INFINITY;
        for (int64_t i = 0; i < b->count; i++) {
            b->low[d] = fmin(b->low[d], b->position[i][d]);
            b->high[d] = fmax(b->high[d], b->position[i][d]);
        }
    }
}

/* As in a gas at rest, around the velocities that the grains have. */
static void spread_velocities(const scene *s, int group, bed *b, int64_t first)
{
    double spread = s->group[group].velocity_spread_m_s, mean[3] = {0};
    int64_t count = b->count - first;
    int dimensions = s->dimensions == 2 ? 2 : 3;
    if (!(spread > 0.0))
        return;
    for (int pass = 0; pass < 2; pass++)
        for (int64_t i = first; i < b->count; i++) {
            random_stream stream = random_start(s->seed, (uint32_t)group, RANDOM_VELOCITY, (uint32_t)(i - first));
            for (int c = 0; c < dimensions; c++) {
                double draw = spread * random_normal(&stream);
                if (pass == 0)
                    mean[c] += draw / (double)count;
                else
                    b->velocity[i][c] += draw - mean[c];
            }
        }
}

status bed_generate(const scene *s, bed *out, failure *why)
{
    *out = (bed){0};
    status result = STATUS_OK;
    if (s->group_count < 1)
        return fail(why, STATUS_BAD_INPUT, "%s: the scene has no particles; `particles:` needs at least one group",
                    s->path ? s->path : "scene");
    for (int group = 0; group < s->group_count && result == STATUS_OK; group++) {
        int64_t first = out->count;
        result = generate_group(s, group, out, why);
        if (result == STATUS_OK)
            spread_velocities(s, group, out, first);
        if (result == STATUS_OK)
            result = check_group(s, out, first, why);
    }
    if (result == STATUS_OK)
        measure_box(out);
    else
        bed_free(out);
    return result;
}

void bed_free(bed *b)
{
    free(b->position);
    free(b->velocity);
    free(b->spin);
    free(b->radius);
    free(b->temperature);
    free(b->scalar);
    free(b->material);
    free(b->group);
    memset(b, 0, sizeof *b);
}
