#include "bed_group.h"
#include "packing.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What beds of about equal grains reach by pushing apart with room to spare; used to say how large a region would do. */
static const double sure_fraction_3d = 0.55, sure_fraction_2d = 0.75;
/* More than spheres of equal size can fill in any order; grains of many sizes may fill a little more, but not by chance. */
static const double hopeless_fraction_3d = 0.85, hopeless_fraction_2d = 0.95;

static double region_size(const packing *p)
{
    double size = 1.0;
    for (int d = 0; d < p->dimensions; d++)
        size *= p->high[d] - p->low[d];
    return size;
}

static double grains_size(const packing *p, int64_t count)
{
    double sum = 0.0;
    for (int64_t i = 0; i < count; i++) {
        double r = p->radius[i];
        sum += p->dimensions == 2 ? 3.141592653589793 * r * r : 4.0 / 3.0 * 3.141592653589793 * r * r * r;
    }
    return sum;
}

/* A region that spans a periodic direction wraps there; its other faces are hard. */
static status set_region(const scene *s, int group, packing *p, failure *why)
{
    const particle_group *g = &s->group[group];
    const domain *box = &s->domain;
    if (!g->region_given && !box->given)
        return bed_refuse(s, group, why, "the random generator needs a region (or the scene a domain)");
    p->dimensions = s->dimensions == 2 ? 2 : 3;
    p->space = sphere_space_of(box);
    for (int d = 0; d < p->dimensions; d++) {
        p->low[d] = g->region_given ? g->region_low_m[d] : box->low_m[d];
        p->high[d] = g->region_given ? g->region_high_m[d] : box->high_m[d];
        if (!(p->low[d] < p->high[d] && isfinite(p->high[d] - p->low[d])))
            return bed_refuse(s, group, why, "region goes from %g to %g m along %c; low must be below high", p->low[d], p->high[d],
                              "xyz"[d]);
        double slack = 1.0e-9 * p->space.length[d];
        if (p->space.periodic[d] && p->low[d] <= box->low_m[d] + slack && p->high[d] >= box->high_m[d] - slack) {
            p->open[d] = true;
            p->low[d] = box->low_m[d];
            p->high[d] = box->high_m[d];
        }
    }
    return STATUS_OK;
}

/* True when a sphere of an earlier group reaches into the region, itself or an image. */
static bool is_obstacle(const packing *p, const double position[3], double radius)
{
    double reach = radius * (1.0 + 10.0 * PACKING_MARGIN);
    for (int d = 0; d < p->dimensions; d++) {
        double length = p->space.periodic[d] ? p->space.length[d] : 0.0;
        bool inside = false;
        for (int image = -1; image <= 1; image++) {
            double x = position[d] + image * length;
            inside |= x + reach >= p->low[d] && x - reach <= p->high[d];
        }
        if (!inside)
            return false;
    }
    return true;
}

/* The new spheres first, in their order, then the obstacles. */
static bool fill_packing(const bed *b, int64_t first, packing *p)
{
    int64_t moving = b->count - first, count = moving;
    for (int64_t i = 0; i < first; i++)
        count += is_obstacle(p, b->position[i], b->radius[i]);
    p->count = count;
    p->position = calloc((size_t)count, sizeof *p->position);
    p->radius = malloc((size_t)count * sizeof *p->radius);
    p->fixed = calloc((size_t)count, sizeof *p->fixed);
    if (!p->position || !p->radius || !p->fixed)
        return false;
    memcpy(p->radius, b->radius + first, (size_t)moving * sizeof *p->radius);
    for (int64_t i = 0, k = moving; i < first; i++)
        if (is_obstacle(p, b->position[i], b->radius[i])) {
            memcpy(p->position[k], b->position[i], sizeof p->position[k]);
            p->radius[k] = b->radius[i];
            p->fixed[k++] = true;
        }
    return true;
}

static status check_sizes(const scene *s, int group, const packing *p, int64_t moving, failure *why)
{
    for (int64_t i = 0; i < moving; i++)
        for (int d = 0; d < p->dimensions; d++)
            if (2.0 * p->radius[i] > p->high[d] - p->low[d])
                return bed_refuse(s, group, why, "particle %" PRId64 " of radius %.6g m does not fit into the region, %.6g m wide along %c",
                                  i, p->radius[i], p->high[d] - p->low[d], "xyz"[d]);
    return STATUS_OK;
}

static double power(const packing *p, double length)
{
    return p->dimensions == 2 ? length * length : length * length * length;
}

/* Whether the first `count` of the `moving` spheres find room beside the obstacles: what the scene would do with that count. */
static bool has_room_for(const packing *p, int64_t moving, int64_t count, uint64_t seed, int group)
{
    packing part = *p;
    int64_t obstacles = p->count - moving;
    bool overlap = true;
    double reached = 1.0;
    part.count = count + obstacles;
    part.position = calloc((size_t)part.count, sizeof *part.position);
    part.radius = malloc((size_t)part.count * sizeof *part.radius);
    part.fixed = calloc((size_t)part.count, sizeof *part.fixed);
    bool fits = part.position && part.radius && part.fixed;
    if (fits) {
        memcpy(part.radius, p->radius, (size_t)count * sizeof *part.radius);
        memcpy(part.radius + count, p->radius + moving, (size_t)obstacles * sizeof *part.radius);
        memcpy(part.position + count, p->position + moving, (size_t)obstacles * sizeof *part.position);
        memcpy(part.fixed + count, p->fixed + moving, (size_t)obstacles * sizeof *part.fixed);
        fits = packing_insert(&part, seed, (uint32_t)group, &overlap) && (!overlap || packing_relax(&part, 0.0, &reached)) &&
               reached == 1.0;
    }
    free(part.position);
    free(part.radius);
    free(part.fixed);
    return fits;
}

/* `shrink` is the factor on all lengths at which the spheres could be packed (0: unknown). A region is larger by it with a little to
 * spare; the count is tried out, because in a narrow region it does not follow from the volume. */
static status refuse_fraction(const scene *s, int group, const packing *p, int64_t moving, double asked, double shrink, failure *why)
{
    bool flat = p->dimensions == 2;
    double sure = flat ? sure_fraction_2d : sure_fraction_3d;
    double fits = 0.99 * (shrink > 0.0 ? fmin(asked * power(p, shrink), sure) : sure);
    int64_t count = (int64_t)((double)moving * fits / asked);
    while (count > 0 && !has_room_for(p, moving, count, s->seed, group))
        count -= 1 + count / 25;
    char advice[96] = "";
    if (count > 0)
        snprintf(advice, sizeof advice, "at most %" PRId64 " particles (a fraction of %.3f) or ", count,
                 grains_size(p, count) / region_size(p));
    return bed_refuse(s, group, why,
                      "%" PRId64
                      " particles are %s fraction of %.3f of their region (%.6g %s), which cannot be reached without overlap; ask "
                      "for %sa region of at least %.6g %s",
                      moving, flat ? "an area" : "a volume", asked, region_size(p), flat ? "m2" : "m3", advice,
                      region_size(p) * asked / fits, flat ? "m2" : "m3");
}

static status pack(const scene *s, int group, packing *p, int64_t moving, failure *why)
{
    bool flat = p->dimensions == 2, overlap = false;
    TRY(check_sizes(s, group, p, moving, why));
    double asked = grains_size(p, moving) / region_size(p), reached = 1.0;
    if (asked > (flat ? hopeless_fraction_2d : hopeless_fraction_3d))
        return refuse_fraction(s, group, p, moving, asked, 0.0, why);
    double sure = flat ? sqrt(sure_fraction_2d / asked) : cbrt(sure_fraction_3d / asked);
    if (!packing_insert(p, s->seed, (uint32_t)group, &overlap) || (overlap && !packing_relax(p, sure, &reached)))
        return fail(why, STATUS_ERROR, "out of memory while packing %" PRId64 " particles", moving);
    return reached == 1.0 ? STATUS_OK : refuse_fraction(s, group, p, moving, asked, reached, why);
}

status bed_random(const scene *s, int group, bed *b, failure *why)
{
    int64_t first;
    packing p = {0};
    TRY(set_region(s, group, &p, why));
    TRY(bed_extend(s, group, s->group[group].count, b, &first, why));
    TRY(bed_draw_radii(s, group, b, first, why));
    int64_t moving = b->count - first;
    status result = fill_packing(b, first, &p) ? pack(s, group, &p, moving, why)
                                               : fail(why, STATUS_ERROR, "out of memory while packing %" PRId64 " particles", moving);
    if (result == STATUS_OK)
        memcpy(b->position + first, p.position, (size_t)moving * sizeof *p.position);
    free(p.position);
    free(p.radius);
    free(p.fixed);
    return result;
}
