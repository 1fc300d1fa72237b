#include "sphere_grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Cells far out share the last index: slower there, never wrong. */
static const double cell_limit = 1.0e15;

sphere_space sphere_space_of(const domain *box)
{
    sphere_space space = {0};
    for (int d = 0; d < 3 && box && box->given; d++) {
        space.origin[d] = box->low_m[d];
        space.length[d] = box->high_m[d] - box->low_m[d];
        space.periodic[d] = box->periodic[d] && space.length[d] > 0.0;
    }
    return space;
}

bool sphere_grid_init(sphere_grid *grid, const sphere_space *space, int64_t count, double radius_top)
{
    *grid = (sphere_grid){.space = *space, .radius_top = radius_top};
    uint64_t buckets = 1024;
    while (buckets < 2 * (uint64_t)count)
        buckets *= 2;
    grid->mask = buckets - 1;
    grid->head = malloc(buckets * sizeof *grid->head);
    grid->link = malloc((size_t)count * sizeof *grid->link + 1);
    if (!grid->head || !grid->link) {
        sphere_grid_free(grid);
        return false;
    }
    double diameter = 2.0 * radius_top;
    for (int k = 0; k < SPHERE_GRID_LEVELS; k++) {
        struct sphere_level *level = &grid->level[k];
        for (int d = 0; d < 3; d++) {
            level->cell[d] = diameter;
            if (space->periodic[d]) {
                level->cells[d] = (int64_t)fmin(fmax(floor(space->length[d] / diameter), 1.0), cell_limit);
                level->cell[d] = space->length[d] / (double)level->cells[d];
            }
        }
        diameter *= 0.5;
    }
    sphere_grid_clear(grid);
    return true;
}

void sphere_grid_clear(sphere_grid *grid)
{
    memset(grid->head, 0xff, (grid->mask + 1) * sizeof *grid->head); /* -1 */
    for (int k = 0; k < SPHERE_GRID_LEVELS; k++) {
        struct sphere_level *level = &grid->level[k];
        level->members = 0;
        level->radius_max = 0.0;
        for (int d = 0; d < 3; d++) {
            level->first[d] = INT64_MAX;
            level->last[d] = INT64_MIN;
        }
    }
}

void sphere_grid_free(sphere_grid *grid)
{
    free(grid->head);
    free(grid->link);
    grid->head = NULL;
    grid->link = NULL;
}

int sphere_grid_level(const sphere_grid *grid, double radius)
{
    int level = 0;
    for (double limit = 0.5 * grid->radius_top; level < SPHERE_GRID_LEVELS - 1 && radius <= limit; limit *= 0.5)
        level++;
    return level;
}

double sphere_wrap(const sphere_space *space, int direction, double x)
{
    if (!space->periodic[direction])
        return x;
    double low = space->origin[direction], length = space->length[direction], high = low + length;
    if (x >= low && x < high)
        return x;
    x -= length * floor((x - low) / length);
    return x >= low && x < high ? x : low;
}

static int64_t cell_of(const sphere_grid *grid, const struct sphere_level *level, int d, double x)
{
    double c = floor((x - grid->space.origin[d]) / level->cell[d]);
    return (int64_t)fmin(fmax(c, -cell_limit), cell_limit);
}

/* Cells in a row along x get successive keys and so successive buckets: a lookup of three touches one cache line. */
static uint64_t row_key(int level, int64_t y, int64_t z)
{
    uint64_t h = (uint64_t)y * 0x9e3779b97f4a7c15u ^ (uint64_t)z * 0xc2b2ae3d27d4eb4fu ^ (uint64_t)(level + 1) * 0x165667b19e3779f9u;
    h ^= h >> 32;
    h *= 0xd6e8feb86659fd93u;
    h ^= h >> 32;
    return h * 0xd6e8feb86659fd93u;
}

void sphere_grid_insert(sphere_grid *grid, int32_t index, const double position[3], double radius)
{
    int k = sphere_grid_level(grid, radius);
    struct sphere_level *level = &grid->level[k];
    int64_t cell[3];
    for (int d = 0; d < 3; d++) {
        cell[d] = cell_of(grid, level, d, sphere_wrap(&grid->space, d, position[d]));
        if (grid->space.periodic[d] && cell[d] >= level->cells[d])
            cell[d] = level->cells[d] - 1;
        if (cell[d] < level->first[d])
            level->first[d] = cell[d];
        if (cell[d] > level->last[d])
            level->last[d] = cell[d];
    }
    level->members++;
    level->radius_max = fmax(level->radius_max, radius);
    uint64_t key = row_key(k, cell[1], cell[2]) + (uint64_t)cell[0];
    int32_t *head = &grid->head[key & grid->mask];
    grid->link[index] = (sphere_link){.key = key, .next = *head};
    *head = index;
}

/* Cells first .. first + count - 1 along d (to be wrapped where periodic) that a reach around x covers. */
static int64_t cell_range(const sphere_grid *grid, const struct sphere_level *level, int d, double x, double reach, int64_t *first)
{
    int64_t from = cell_of(grid, level, d, x - reach), to = cell_of(grid, level, d, x + reach);
    if (grid->space.periodic[d]) {
        if (to - from + 1 >= level->cells[d]) {
            from = 0;
            to = level->cells[d] - 1;
        }
    } else {
        from = from < level->first[d] ? level->first[d] : from;
        to = to > level->last[d] ? level->last[d] : to;
    }
    *first = from;
    return to - from + 1;
}

static int64_t cell_wrap(const sphere_grid *grid, const struct sphere_level *level, int d, int64_t cell)
{
    if (!grid->space.periodic[d])
        return cell;
    while (cell < 0)
        cell += level->cells[d];
    while (cell >= level->cells[d])
        cell -= level->cells[d];
    return cell;
}

static bool append_cell(const sphere_grid *grid, uint64_t key, sphere_list *found)
{
    for (int32_t i = grid->head[key & grid->mask]; i >= 0; i = grid->link[i].next) {
        if (grid->link[i].key != key)
            continue;
        if (found->count == found->capacity) {
            int64_t capacity = 2 * found->capacity + 256;
            int32_t *grown = realloc(found->index, (size_t)capacity * sizeof *grown);
            if (!grown)
                return false;
            found->index = grown;
            found->capacity = capacity;
        }
        found->index[found->count++] = i;
    }
    return true;
}

bool sphere_grid_near(const sphere_grid *grid, const double position[3], double radius, int level_last, sphere_list *found)
{
    for (int k = 0; k <= level_last; k++) {
        const struct sphere_level *level = &grid->level[k];
        if (level->members == 0)
            continue;
        /* The factor covers the rounding of cell indices across a periodic face. */
        double reach = (radius + level->radius_max) * (1.0 + 1.0e-9);
        int64_t first[3], count[3];
        for (int d = 0; d < 3; d++)
            count[d] = cell_range(grid, level, d, sphere_wrap(&grid->space, d, position[d]), reach, &first[d]);
        for (int64_t z = 0; z < count[2]; z++)
            for (int64_t y = 0; y < count[1]; y++) {
                uint64_t row = row_key(k, cell_wrap(grid, level, 1, first[1] + y), cell_wrap(grid, level, 2, first[2] + z));
                for (int64_t x = 0; x < count[0]; x++)
                    if (!append_cell(grid, row + (uint64_t)cell_wrap(grid, level, 0, first[0] + x), found))
                        return false;
            }
    }
    return true;
}

typedef struct curve_point {
    uint64_t code;
    int32_t index;
} curve_point;

static int compare_places(const void *a, const void *b)
{
    const curve_point *p = a, *q = b;
    if (p->code != q->code)
        return p->code < q->code ? -1 : 1;
    return p->index < q->index ? -1 : p->index > q->index;
}

static uint64_t spread_bits(uint64_t x)
{
    x &= 0x1fffff;
    x = (x | x << 32) & 0x1f00000000ffffu;
    x = (x | x << 16) & 0x1f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    return (x | x << 2) & 0x1249249249249249u;
}

/* Counted in mean radii and modulo 2^21, so that a grain far away does not squeeze all others into one place of the curve. */
bool sphere_order(int64_t count, const double (*position)[3], const double *radius, int32_t *order)
{
    curve_point *point = malloc((size_t)count * sizeof *point + 1);
    if (!point)
        return false;
    double mean = 0.0;
    for (int64_t i = 0; i < count; i++)
        mean += radius[i] / (double)count;
    for (int64_t i = 0; i < count; i++) {
        uint64_t code = 0;
        for (int d = 0; d < 3; d++) {
            double x = floor((position[i][d] - position[0][d]) / mean);
            code |= spread_bits((uint64_t)(int64_t)fmin(fmax(x, -cell_limit), cell_limit)) << d;
        }
        point[i] = (curve_point){.code = code, .index = (int32_t)i};
    }
    qsort(point, (size_t)count, sizeof *point, compare_places);
    for (int64_t i = 0; i < count; i++)
        order[i] = point[i].index;
    free(point);
    return true;
}
