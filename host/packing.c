#include "packing.h"

#include "random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Tries for a place per sphere; then the one with the least overlap is taken. More tries cost more than the pushing that they save. */
#define INSERT_TRIES 8
/* Spheres are pushed apart until they have this much more than their radii: the last small overlaps vanish slowly (the closer to jamming,
 * the slower), those beyond a few percent fast. */
static const double inflation = 1.01;
/* A sphere may move by this fraction of its radius before the list of neighbours is made anew. Whether it has is looked at every few passes
 * only: a list that is somewhat out of date delays the end, and before the end a fresh one decides. */
static const double skin = 0.35;
#define LIST_CHECK_PASSES 4
/* Pushing further than needed gets there in fewer passes, like the over-relaxation of a linear system. */
static const double over_relaxation = 1.7;

static void face_range(const packing *p, int d, double radius, double *low, double *high)
{
    double keep = radius * (1.0 + PACKING_MARGIN);
    *low = p->low[d] + keep;
    *high = p->high[d] - keep;
    if (*low > *high)
        *low = *high = 0.5 * (p->low[d] + p->high[d]);
}

static void random_place(const packing *p, random_stream *stream, double radius, double centre[3])
{
    centre[2] = 0.0;
    for (int d = 0; d < p->dimensions; d++) {
        double low = p->low[d], high = p->high[d];
        if (!p->open[d])
            face_range(p, d, radius, &low, &high);
        centre[d] = low + (high - low) * random_uniform(stream);
    }
}

/* Largest overlap at a place as a share of the wanted distance; stops early when it reaches `enough`. */
static double overlap_at(const packing *p, const double centre[3], double radius, const sphere_list *near, double enough)
{
    double worst = 0.0;
    for (int64_t k = 0; k < near->count && worst < enough; k++) {
        int32_t j = near->index[k];
        double wanted = (radius + p->radius[j]) * (1.0 + PACKING_MARGIN), branch[3];
        sphere_branch(&p->space, centre, p->position[j], branch);
        double distance2 = branch[0] * branch[0] + branch[1] * branch[1] + branch[2] * branch[2];
        if (distance2 < wanted * wanted)
            worst = fmax(worst, 1.0 - sqrt(distance2) / wanted);
    }
    return worst;
}

typedef struct sized {
    double radius;
    int32_t index;
} sized;

static int compare_sizes(const void *a, const void *b)
{
    const sized *p = a, *q = b;
    if (p->radius != q->radius)
        return p->radius > q->radius ? -1 : 1;
    return p->index < q->index ? -1 : p->index > q->index;
}

static bool insert_all(packing *p, const sized *order, int64_t moving, sphere_grid *grid, uint64_t seed, uint32_t group, bool *overlap)
{
    sphere_list near = {0};
    bool fits = true;
    for (int64_t k = 0; k < moving && fits; k++) {
        int32_t i = order[k].index;
        double radius = p->radius[i], least = INFINITY, centre[3];
        random_stream stream = random_start(seed, group, RANDOM_POSITION, (uint32_t)i);
        for (int t = 0; t < INSERT_TRIES && least > 0.0 && fits; t++) {
            random_place(p, &stream, radius, centre);
            near.count = 0;
            fits = sphere_grid_near(grid, centre, radius * (1.0 + PACKING_MARGIN), SPHERE_GRID_LEVELS - 1, &near);
            double worst = overlap_at(p, centre, radius, &near, least);
            if (worst < least) {
                least = worst;
                memcpy(p->position[i], centre, sizeof centre);
            }
        }
        *overlap |= least > 0.0;
        sphere_grid_insert(grid, i, p->position[i], radius);
    }
    free(near.index);
    return fits;
}

bool packing_insert(packing *p, uint64_t seed, uint32_t group, bool *overlap)
{
    *overlap = false;
    sized *order = malloc((size_t)p->count * sizeof *order + 1);
    if (!order)
        return false;
    int64_t moving = 0;
    double top = 0.0;
    for (int64_t i = 0; i < p->count; i++) {
        top = fmax(top, p->radius[i]);
        if (!p->fixed[i])
            order[moving++] = (sized){.radius = p->radius[i], .index = (int32_t)i};
    }
    qsort(order, (size_t)moving, sizeof *order, compare_sizes);
    sphere_grid grid;
    bool fits = sphere_grid_init(&grid, &p->space, p->count, top);
    if (fits) {
        for (int64_t i = 0; i < p->count; i++)
            if (p->fixed[i])
                sphere_grid_insert(&grid, (int32_t)i, p->position[i], p->radius[i]);
        fits = insert_all(p, order, moving, &grid, seed, group, overlap);
        sphere_grid_free(&grid);
    }
    free(order);
    return fits;
}

typedef struct pair {
    int32_t i, j;
} pair;

/* The pushing, on copies in spatial order. */
typedef struct relaxation {
    packing p;
    int32_t *order;
    double *mobility;   /* 1/r^3, 0 for obstacles: a push moves the small sphere */
    double (*built)[3]; /* positions at the last list */
    double scale;       /* of all radii, below 1 while looking for what would fit */
    pair *pairs;
    int64_t pair_count, pair_capacity;
    sphere_grid grid;
    sphere_list near;
} relaxation;

static void relaxation_free(relaxation *r)
{
    free(r->p.position);
    free(r->p.radius);
    free(r->p.fixed);
    free(r->order);
    free(r->mobility);
    free(r->built);
    free(r->pairs);
    free(r->near.index);
    sphere_grid_free(&r->grid);
}

static bool relaxation_init(const packing *p, relaxation *r)
{
    size_t n = (size_t)p->count;
    *r = (relaxation){.p = *p, .scale = 1.0};
    r->p.position = malloc(n * sizeof *r->p.position + 1);
    r->p.radius = malloc(n * sizeof *r->p.radius + 1);
    r->p.fixed = malloc(n * sizeof *r->p.fixed + 1);
    r->order = malloc(n * sizeof *r->order + 1);
    r->mobility = malloc(n * sizeof *r->mobility + 1);
    r->built = malloc(n * sizeof *r->built + 1);
    if (!r->p.position || !r->p.radius || !r->p.fixed || !r->order || !r->mobility || !r->built)
        return false;
    if (!sphere_order(p->count, (const double(*)[3])p->position, p->radius, r->order))
        return false;
    double top = 0.0;
    for (int64_t k = 0; k < p->count; k++)
        top = fmax(top, p->radius[k]);
    for (int64_t k = 0; k < p->count; k++) {
        int32_t i = r->order[k];
        double small = top / p->radius[i];
        memcpy(r->p.position[k], p->position[i], sizeof r->p.position[k]);
        r->p.radius[k] = p->radius[i];
        r->p.fixed[k] = p->fixed[i];
        r->mobility[k] = p->fixed[i] ? 0.0 : small * small * small;
    }
    return sphere_grid_init(&r->grid, &p->space, p->count, top * (inflation + skin));
}

static bool add_pair(relaxation *r, int32_t i, int32_t j)
{
    if (r->pair_count == r->pair_capacity) {
        int64_t capacity = r->pair_capacity + r->pair_capacity / 2 + 8 * r->p.count + 64;
        pair *grown = realloc(r->pairs, (size_t)capacity * sizeof *grown);
        if (!grown)
            return false;
        r->pairs = grown;
        r->pair_capacity = capacity;
    }
    r->pairs[r->pair_count++] = (pair){.i = i, .j = j};
    return true;
}

static double distance_squared(const packing *p, int32_t i, int32_t j, double branch[3])
{
    sphere_branch(&p->space, p->position[i], p->position[j], branch);
    return branch[0] * branch[0] + branch[1] * branch[1] + branch[2] * branch[2];
}

/* All pairs that can come closer than their inflated radii before one of them has moved by its skin. The finer level looks into
 * the coarser ones, and within a level the later sphere looks at the earlier, so that each pair is found once. */
static bool list_pairs(relaxation *r)
{
    packing *p = &r->p;
    double grow = inflation + skin;
    r->pair_count = 0;
    sphere_grid_clear(&r->grid);
    for (int64_t i = 0; i < p->count; i++) {
        for (int d = 0; d < p->dimensions; d++)
            p->position[i][d] = sphere_wrap(&p->space, d, p->position[i][d]);
        sphere_grid_insert(&r->grid, (int32_t)i, p->position[i], grow * p->radius[i]);
    }
    memcpy(r->built, p->position, (size_t)p->count * sizeof *r->built);
    for (int64_t i = 0; i < p->count; i++) {
        int level = sphere_grid_level(&r->grid, grow * p->radius[i]);
        r->near.count = 0;
        if (!sphere_grid_near(&r->grid, p->position[i], grow * p->radius[i], level, &r->near))
            return false;
        for (int64_t k = 0; k < r->near.count; k++) {
            int32_t j = r->near.index[k];
            bool once = j < i || sphere_grid_level(&r->grid, grow * p->radius[j]) < level;
            double branch[3], reach = grow * (p->radius[i] + p->radius[j]);
            if (j == i || !once || (p->fixed[i] && p->fixed[j]) || distance_squared(p, (int32_t)i, j, branch) >= reach * reach)
                continue;
            if (!add_pair(r, (int32_t)i, j))
                return false;
        }
    }
    return true;
}

/* The faces see the scaled radius: shrinking everything is then the same as a larger box. */
static void shift(packing *p, double scale, int32_t i, const double branch[3], double share)
{
    if (p->fixed[i]) /* may reach through a face */
        return;
    for (int d = 0; d < p->dimensions; d++) {
        double x = p->position[i][d] + share * branch[d];
        if (!p->open[d]) {
            double low, high;
            face_range(p, d, scale * p->radius[i], &low, &high);
            x = x < low ? low : x > high ? high : x;
        }
        p->position[i][d] = x;
    }
}

/* One pass over the pairs (every other one backwards, so that no direction is favoured): each is pushed apart to its inflated radii
 * at once. Returns the sum of the squared overlaps, as shares of the distance, of the radii themselves. */
static double push_apart(relaxation *r, bool backwards)
{
    packing *p = &r->p;
    double sum = 0.0;
    for (int64_t n = 0; n < r->pair_count; n++) {
        pair c = r->pairs[backwards ? r->pair_count - 1 - n : n];
        double branch[3], radii = r->scale * (p->radius[c.i] + p->radius[c.j]);
        double wanted = inflation * radii, distance2 = distance_squared(p, c.i, c.j, branch);
        if (distance2 >= wanted * wanted)
            continue;
        double distance = sqrt(distance2), bare = 1.0 - distance / radii;
        if (bare > -PACKING_MARGIN)
            sum += (bare + PACKING_MARGIN) * (bare + PACKING_MARGIN);
        if (distance < 1.0e-9 * radii) { /* no direction to speak of: any will do */
            branch[0] = distance = 1.0e-9 * radii;
            branch[1] = branch[2] = 0.0;
        }
        double push = over_relaxation * (wanted - distance) / (distance * (r->mobility[c.i] + r->mobility[c.j]));
        shift(p, r->scale, c.i, branch, push * r->mobility[c.i]);
        shift(p, r->scale, c.j, branch, -push * r->mobility[c.j]);
    }
    return sum;
}

static bool list_is_stale(const relaxation *r)
{
    for (int64_t i = 0; i < r->p.count; i++) {
        double moved2 = 0.0, limit = skin * r->p.radius[i];
        for (int d = 0; d < 3; d++) {
            double x = r->p.position[i][d] - r->built[i][d];
            moved2 += x * x;
        }
        if (moved2 > limit * limit)
            return true;
    }
    return false;
}

static bool is_clear(const relaxation *r)
{
    for (int64_t n = 0; n < r->pair_count; n++) {
        pair c = r->pairs[n];
        double branch[3], wanted = r->scale * (1.0 + PACKING_MARGIN) * (r->p.radius[c.i] + r->p.radius[c.j]);
        if (distance_squared(&r->p, c.i, c.j, branch) < wanted * wanted)
            return false;
    }
    return true;
}

/* Pushes until the scaled spheres are clear of each other, or until that no longer gets nearer. */
static bool relax(relaxation *r, int passes, bool *clear)
{
    double before = INFINITY;
    *clear = false;
    for (int pass = 0; pass < passes; pass++) {
        if (pass % LIST_CHECK_PASSES == 0 && list_is_stale(r) && !list_pairs(r))
            return false;
        double overlap = push_apart(r, pass & 1);
        if (overlap == 0.0 && list_is_stale(r) && !list_pairs(r))
            return false;
        if (overlap == 0.0 && is_clear(r)) {
            *clear = true;
            return true;
        }
        if (pass % 100 == 99) {
            if (overlap > 0.7 * before)
                return true;
            before = overlap;
        }
    }
    return true;
}

bool packing_relax(packing *p, double sure, double *reached)
{
    relaxation r;
    bool clear = false, fits = relaxation_init(p, &r) && list_pairs(&r);
    if (fits)
        fits = relax(&r, 3000, &clear);
    /* What does not fit is shrunk until it does, to be able to say what would. */
    for (bool first = true; fits && !clear && sure > 0.0 && r.scale > 0.02; first = false) {
        r.scale = first && sure < 1.0 ? sure : 0.98 * r.scale;
        fits = relax(&r, 300, &clear);
    }
    if (fits)
        for (int64_t k = 0; k < p->count; k++)
            memcpy(p->position[r.order[k]], r.p.position[k], sizeof r.p.position[k]);
    *reached = clear ? r.scale : 0.0;
    relaxation_free(&r);
    return fits;
}
