#include "bed_group.h"
#include "laws/laws.h"
#include "results.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static bool row_is_live(const results_particles *p, int64_t row)
{
    return !isnan(p->position[3 * row]) && !isnan(p->position[3 * row + 1]) && !isnan(p->position[3 * row + 2]);
}

static status take_rows(const scene *s, int group, const results_particles *p, bed *b, failure *why)
{
    const particle_group *g = &s->group[group];
    if (!p->position)
        return bed_refuse(s, group, why, "%s holds no positions", g->path);
    if (!p->radius && !bed_radius_given(g))
        return bed_refuse(s, group, why, "%s holds no radii and the group gives no radius_m", g->path);
    int64_t live = 0, first;
    for (int64_t row = 0; row < p->count; row++)
        live += row_is_live(p, row);
    if (live == 0)
        return bed_refuse(s, group, why, "%s holds no particles in frame %" PRId64, g->path, g->frame);
    TRY(bed_extend(s, group, live, b, &first, why));
    if (!p->radius)
        TRY(bed_draw_radii(s, group, b, first, why));
    int64_t i = first;
    for (int64_t row = 0; row < p->count; row++) {
        if (!row_is_live(p, row))
            continue;
        memcpy(b->position[i], p->position + 3 * row, sizeof b->position[i]);
        if (p->velocity)
            memcpy(b->velocity[i], p->velocity + 3 * row, sizeof b->velocity[i]);
        if (p->spin)
            memcpy(b->spin[i], p->spin + 3 * row, sizeof b->spin[i]);
        if (p->temperature && !isnan(p->temperature[row]))
            b->temperature[i] = p->temperature[row];
        if (p->radius)
            b->radius[i] = p->radius[row] / (p->radius_varies ? expansion_factor(s, g->material, b->temperature[i]) : 1.0);
        i++;
    }
    return STATUS_OK;
}

status bed_result(const scene *s, int group, bed *b, failure *why)
{
    const particle_group *g = &s->group[group];
    if (!g->path)
        return bed_refuse(s, group, why, "the result generator needs a path");
    results_particles p = {0};
    failure unread;
    status result = results_read_particles(g->path, g->frame, &p, &unread);
    if (result == STATUS_BAD_INPUT)
        return bed_refuse(s, group, why, "%s", unread.text);
    if (result != STATUS_OK)
        return fail(why, result, "%s", unread.text);
    result = take_rows(s, group, &p, b, why);
    results_particles_free(&p);
    return result;
}
