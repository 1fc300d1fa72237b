/* Walls do not repeat with a periodic domain: where grains go through a periodic face, none may stand so near that a grain would touch its image on
 * the other side, which it does not feel. Walls that are the same all along the direction, from face to face, are their own images. */
#include "simulation.h"

#include <math.h>

#define PARALLEL 1e-9

typedef struct reach {
    double low[3], high[3];
} reach;

static reach reach_of_round(const clast_face *f)
{
    reach r;
    double length = f->slant[0] * f->slant_length;
    for (int c = 0; c < 3; c++) {
        double across = sqrt(fmax(0.0, 1.0 - f->normal[c] * f->normal[c])), end = f->origin[c] + length * f->normal[c];
        r.low[c] = fmin(f->origin[c] - across * f->extent[0], end - across * f->extent[1]);
        r.high[c] = fmax(f->origin[c] + across * f->extent[0], end + across * f->extent[1]);
    }
    return r;
}

static reach reach_of(const clast_face *f)
{
    reach r;
    if (f->shape == CLAST_FACE_ROUND || f->shape == CLAST_FACE_ROUND_FAR)
        return reach_of_round(f);
    for (int c = 0; c < 3; c++) {
        double half = INFINITY; /* a plane along this direction */
        if (f->shape == CLAST_FACE_RECTANGLE)
            half = fabs(f->e1[c]) * f->extent[0] + fabs(f->e2[c]) * f->extent[1];
        else if (f->shape == CLAST_FACE_DISC)
            half = f->extent[0] * sqrt(fmax(0.0, 1.0 - f->normal[c] * f->normal[c]));
        else if (fabs(f->normal[c]) > 1.0 - PARALLEL)
            half = 0.0;
        r.low[c] = f->origin[c] - half;
        r.high[c] = f->origin[c] + half;
    }
    return r;
}

/* Its own image, or one that no grain goes past. */
static bool repeats(const clast_face *f, const reach *r, const domain *d, int c)
{
    double slack = 1e-6 * (d->high_m[c] - d->low_m[c]), along = fabs(f->normal[c]);
    bool spans = r->low[c] <= d->low_m[c] + slack && r->high[c] >= d->high_m[c] - slack;
    if (f->shape == CLAST_FACE_ROUND || f->shape == CLAST_FACE_ROUND_FAR)
        return spans && along > 1.0 - PARALLEL && f->extent[0] == f->extent[1];
    if (along < PARALLEL)
        return spans && (f->shape == CLAST_FACE_PLANE ||
                         (f->shape == CLAST_FACE_RECTANGLE && fmax(fabs(f->e1[c]), fabs(f->e2[c])) > 1.0 - PARALLEL));
    bool bars = along > 1.0 - PARALLEL;
    for (int o = 0; o < 3; o++)
        bars = bars && (o == c || (r->low[o] <= d->low_m[o] + slack && r->high[o] >= d->high_m[o] - slack));
    return bars;
}

/* A tilted plane comes near the domain's face at `at` where the face's corners do not all stand clear of it. */
static bool plane_is_near(const clast_face *f, const domain *d, int c, double at, double near)
{
    double middle = f->normal[c] * (at - f->origin[c]), half = 0.0;
    for (int o = 0; o < 3; o++)
        if (o != c) {
            middle += f->normal[o] * (0.5 * (d->low_m[o] + d->high_m[o]) - f->origin[o]);
            half += fabs(f->normal[o]) * 0.5 * (d->high_m[o] - d->low_m[o]);
        }
    return fabs(middle) <= half + near;
}

static bool is_near(const simulation *sim, const clast_face *f, int c)
{
    const domain *d = &sim->scene->domain;
    double near = sim->radius_max;
    reach r = reach_of(f);
    if (repeats(f, &r, d, c))
        return false;
    if (f->shape == CLAST_FACE_PLANE)
        return plane_is_near(f, d, c, d->low_m[c], near) || plane_is_near(f, d, c, d->high_m[c], near);
    for (int o = 0; o < 3; o++)
        if (r.low[o] > d->high_m[o] + near || r.high[o] < d->low_m[o] - near)
            return false;
    return r.low[c] < d->low_m[c] + near || r.high[c] > d->high_m[c] - near;
}

bool guard_periodic_wall(const simulation *sim, int *wall, char *axis)
{
    const domain *d = &sim->scene->domain;
    for (int c = 0; c < 3; c++)
        for (int f = 0; d->given && d->periodic[c] && f < sim->face_count; f++)
            if (is_near(sim, &sim->face_rows[f], c)) {
                *wall = sim->face_rows[f].wall;
                *axis = "xyz"[c];
                return true;
            }
    return false;
}
