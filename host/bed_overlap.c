#include "bed.h"
#include "sphere_grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct deepest {
    double overlap; /* fraction of the smaller radius */
    int64_t i, j;
} deepest;

static void compare(const bed *b, const sphere_space *space, int64_t i, int64_t j, deepest *worst)
{
    double branch[3], ri = b->radius[i], rj = b->radius[j];
    sphere_branch(space, b->position[i], b->position[j], branch);
    double distance2 = branch[0] * branch[0] + branch[1] * branch[1] + branch[2] * branch[2];
    if (distance2 >= (ri + rj) * (ri + rj))
        return;
    double overlap = (ri + rj - sqrt(distance2)) / fmin(ri, rj);
    if (overlap > worst->overlap)
        *worst = (deepest){.overlap = overlap, .i = i < j ? i : j, .j = i < j ? j : i};
}

/* A sphere wider than the period overlaps its own image. */
static void compare_own_image(const bed *b, const sphere_space *space, int64_t i, deepest *worst)
{
    for (int d = 0; d < 3; d++) {
        double overlap = (2.0 * b->radius[i] - space->length[d]) / b->radius[i];
        if (space->periodic[d] && overlap > worst->overlap)
            *worst = (deepest){.overlap = overlap, .i = i, .j = i};
    }
}

/* Without memory for the grid, every pair: slow, but right. */
static void compare_all(const bed *b, const sphere_space *space, deepest *worst)
{
    for (int64_t i = 0; i < b->count; i++)
        for (int64_t j = 0; j < i; j++)
            compare(b, space, i, j, worst);
}

/* In spatial order: the grid's spheres are numbered along the curve. The finer level looks into the coarser ones. */
static bool compare_near(const bed *b, const sphere_space *space, const int32_t *order, double top, deepest *worst)
{
    sphere_grid grid;
    sphere_list near = {0};
    if (!sphere_grid_init(&grid, space, b->count, top))
        return false;
    bool fits = true;
    for (int64_t k = 0; k < b->count; k++)
        sphere_grid_insert(&grid, (int32_t)k, b->position[order[k]], b->radius[order[k]]);
    for (int64_t k = 0; k < b->count && fits; k++) {
        int64_t i = order[k];
        near.count = 0;
        fits = sphere_grid_near(&grid, b->position[i], b->radius[i], sphere_grid_level(&grid, b->radius[i]), &near);
        for (int64_t n = 0; n < near.count; n++)
            if (near.index[n] != k)
                compare(b, space, i, order[near.index[n]], worst);
    }
    free(near.index);
    sphere_grid_free(&grid);
    return fits;
}

double bed_largest_overlap(const bed *b, const domain *box, int64_t *i, int64_t *j)
{
    sphere_space space = sphere_space_of(box);
    deepest worst = {.i = -1, .j = -1};
    double top = 0.0;
    for (int64_t k = 0; k < b->count; k++) {
        top = fmax(top, b->radius[k]);
        compare_own_image(b, &space, k, &worst);
    }
    int32_t *order = malloc((size_t)b->count * sizeof *order + 1);
    if (!order || !sphere_order(b->count, (const double(*)[3])b->position, b->radius, order) ||
        !compare_near(b, &space, order, top, &worst))
        compare_all(b, &space, &worst);
    free(order);
    if (i)
        *i = worst.i;
    if (j)
        *j = worst.j;
    return worst.overlap;
}
