/* A copy on the host of a contact table, and what must hold of it: every pair and wall in reach, in the order that the stages rely on. */
#ifndef CLAST_TESTS_TABLE_CASE_H
#define CLAST_TESTS_TABLE_CASE_H
#include "simulation_case.h"

#include "laws/fields.h"

#define DEEP 1e-12 /* share of the reach within which host and device may round differently */

/* ---- scenes ---- */

#define MATERIAL                                                                                                       \
    "materials: [{name: m, density_kg_m3: 2500, youngs_modulus_pa: 5.0e6, poissons_ratio: 0.3}]\n"                     \
    "interactions: [{between: default, restitution: 0.5, friction_static: 0.5}]\n"                                     \
    "particles: [{name: bed, material: m, generator: list, items: [{position_m: [0.5, 0.5, 0.5], radius_m: 0.01}]}]\n" \
    "stages: [{name: go, until: {steps: 1}, step_s: 1.0e-5}]\n"
#define NORMAL               "effects: [{slot: normal, law: hertz}]\n"
#define FRICTION             "effects: [{slot: normal, law: hertz}, {slot: tangential, law: mindlin}]\n"
#define SKIN(text)           "contact_table: {skin_m: " text "}\n"
#define PERIODIC(directions) "domain: {low_m: [0, 0, 0], high_m: [1, 1, 1], periodic: [" directions "]}\n"

#define WALLS                                                                                               \
    "walls:\n"                                                                                              \
    "  - {name: floor, shape: plane, point_m: [0, 0, 0.2], normal: [0.1, 0, 1]}\n"                          \
    "  - {name: box, shape: box, low_m: [0, 0, 0], high_m: [1, 1, 1], open: [z_high]}\n"                    \
    "  - {name: shelf, shape: rectangle, corners_m: [[0.3, 0.3, 0.4], [0.8, 0.3, 0.5], [0.3, 0.6, 0.4]]}\n" \
    "  - {name: coin, shape: disc, center_m: [0.5, 0.5, 0.7], normal: [1, 2, 3], radius_m: 0.2}\n"

static inline bed random_bed(int64_t count, double radius_low, double radius_high, uint64_t seed)
{
    bed b = case_bed(count);
    for (int64_t i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++)
            b.position[i][c] = case_random(&seed, 0.0, 1.0);
        b.radius[i] = radius_low * pow(radius_high / radius_low, case_random(&seed, 0.0, 1.0));
    }
    return b;
}

/* ---- a host copy of the table ---- */

typedef struct table_copy {
    int64_t count, records, pairs, wall_base, end, blocks;
    double *position, *radius;
    int32_t *id, *owner, *other, *slots;
    uint32_t *slot_offset;
} table_copy;

static inline table_copy copy_table(simulation *sim)
{
    contact_table *t = &sim->table;
    table_copy h = {.count = sim->count,
                    .records = t->record_count,
                    .pairs = t->pair_count,
                    .wall_base = t->wall_base,
                    .end = t->wall_base + t->wall_record_count,
                    .blocks = sim->stride / CLAST_BLOCK};
    h.position = case_field(sim, "position");
    h.radius = case_field(sim, "radius");
    h.id = case_read(sim, store_find(sim, "id")->mem, 0, sim->stride, sizeof *h.id);
    h.owner = case_read(sim, t->owner[t->now], 0, h.records, sizeof *h.owner);
    h.other = case_read(sim, t->other[t->now], 0, h.records, sizeof *h.other);
    h.slot_offset = case_read(sim, t->slot_offset[t->now], 0, h.blocks + 1, sizeof *h.slot_offset);
    h.slots = case_read(sim, t->slots[t->now], 0, h.slot_offset[h.blocks], sizeof *h.slots);
    return h;
}

static inline void free_copy(table_copy *h)
{
    free(h->position);
    free(h->radius);
    free(h->id);
    free(h->owner);
    free(h->other);
    free(h->slots);
    free(h->slot_offset);
}

/* ---- what must be in it ---- */

static inline double distance2(const simulation *sim, const double *a, const double *b)
{
    const domain *d = &sim->scene->domain;
    double sum = 0.0;
    for (int c = 0; c < 3; c++) {
        double x = b[c] - a[c], length = d->given && d->periodic[c] ? d->high_m[c] - d->low_m[c] : 0.0;
        x = x > 0.5 * length && length > 0.0 ? x - length : x;
        x = x < -0.5 * length && length > 0.0 ? x + length : x;
        sum += x * x;
    }
    return sum;
}

/* 1: within reach, 0: not, -1: on the edge, where rounding decides. */
static inline int expected_pair(const simulation *sim, const table_copy *h, int64_t i, int64_t j)
{
    double reach = h->radius[i] + h->radius[j] + sim->table.skin, d2 = distance2(sim, &h->position[3 * i], &h->position[3 * j]);
    if (fabs(d2 - reach * reach) <= DEEP * reach * reach)
        return -1;
    return d2 < reach * reach;
}

static inline bool owns(const table_copy *h, int64_t i, int64_t j)
{
    return h->radius[i] < h->radius[j] || (h->radius[i] == h->radius[j] && h->id[i] < h->id[j]);
}

/* Height over a face and its two in-plane distances. */
static inline void face_coordinates(const clast_face *f, const double *x, double *height, double *u, double *v)
{
    *height = *u = *v = 0.0;
    for (int c = 0; c < 3; c++) {
        *height += (x[c] - f->origin[c]) * f->normal[c];
        *u += (x[c] - f->origin[c]) * f->e1[c];
        *v += (x[c] - f->origin[c]) * f->e2[c];
    }
}

/* Distance from a face; behind a plane it is negative. */
static inline double face_distance(const clast_face *f, const double *x)
{
    double height, u, v, past_u, past_v = 0.0;
    face_coordinates(f, x, &height, &u, &v);
    if (f->shape == CLAST_FACE_PLANE)
        return height;
    if (f->shape == CLAST_FACE_DISC) {
        past_u = fmax(0.0, sqrt(u * u + v * v) - f->extent[0]);
    } else {
        past_u = fmax(0.0, fabs(u) - f->extent[0]);
        past_v = fmax(0.0, fabs(v) - f->extent[1]);
    }
    return sqrt(height * height + past_u * past_u + past_v * past_v);
}

/* A record must stand where the face is within reach, and may stand in a box around that (its edges are not rounded). */
static inline int expected_wall(const simulation *sim, const table_copy *h, int64_t i, const clast_face *f)
{
    double reach = h->radius[i] + sim->table.skin, height, u, v, slack = 1e-12 * (reach + fabs(f->extent[0]) + fabs(f->extent[1]));
    if (face_distance(f, &h->position[3 * i]) < reach - slack)
        return 1;
    face_coordinates(f, &h->position[3 * i], &height, &u, &v);
    if (f->shape == CLAST_FACE_PLANE)
        return height > reach + slack ? 0 : -1;
    bool outside = fabs(height) > reach + slack;
    if (f->shape == CLAST_FACE_DISC)
        outside = outside || sqrt(u * u + v * v) > f->extent[0] + reach + slack;
    else
        outside = outside || fabs(u) > f->extent[0] + reach + slack || fabs(v) > f->extent[1] + reach + slack;
    return outside ? 0 : -1;
}

/* found[i][j] over grains and faces, from the records. */
static inline signed char *mark_records(const table_copy *h, int faces)
{
    int64_t width = h->count + faces;
    signed char *found = calloc((size_t)(h->count * width + 1), 1);
    assert_non_null(found);
    for (int64_t k = 0; k < h->end; k++) {
        int64_t i = h->owner[k], j = h->other[k];
        if (k >= h->pairs && k < h->wall_base)
            continue;
        bool wall = k >= h->wall_base;
        assert_true(i >= 0 && i < h->count && j >= 0 && j < (wall ? faces : h->count));
        signed char *here = &found[i * width + (wall ? h->count + j : j)];
        assert_int_equal(*here, 0);
        *here = 1;
        if (!wall) {
            assert_true(owns(h, i, j));
            found[j * width + i] = 1;
        }
    }
    return found;
}

static inline void check_set(simulation *sim, const table_copy *h)
{
    int64_t width = h->count + sim->face_count;
    signed char *found = mark_records(h, sim->face_count);
    for (int64_t i = 0; i < h->count; i++) {
        for (int64_t j = 0; j < i; j++) {
            int expected = expected_pair(sim, h, i, j);
            if (expected >= 0 && expected != found[i * width + j])
                fail_msg("grains %d and %d: %s", h->id[i], h->id[j], expected ? "missing" : "listed out of reach");
        }
        for (int f = 0; f < sim->face_count; f++) {
            int expected = expected_wall(sim, h, i, &sim->face_rows[f]);
            if (expected >= 0 && expected != found[i * width + h->count + f])
                fail_msg("grain %d and face %d: %s", h->id[i], f, expected ? "missing" : "listed out of reach");
        }
    }
    free(found);
}

/* ---- how it must stand there ---- */

/* Whether a record may stand behind that of `finder` and its partner `last`, as found by one of its grains; that one into *finder. */
static inline bool stands_behind(const table_copy *h, int64_t k, int64_t *finder, int64_t *last)
{
    int32_t low = h->owner[k] < h->other[k] ? h->owner[k] : h->other[k], high = h->owner[k] + h->other[k] - low;
    bool found = low > *finder || (low == *finder && h->id[high] > *last), wraps = !found && (high > *finder || (high == *finder && h->id[low] > *last));
    *finder = found ? low : high;
    *last = h->id[found ? high : low];
    return found || wraps;
}

/* Pairs in the order of the grains that find them, and each one's by the partner's id; those of walls by grain and face; work-groups filled up with rows
 * that name grain 0 twice. */
static inline void check_records(const table_copy *h)
{
    assert_int_equal(h->wall_base % CLAST_BLOCK, 0);
    assert_int_equal(h->records % CLAST_BLOCK, 0);
    assert_true(h->wall_base - h->pairs < CLAST_BLOCK && h->records - h->end < CLAST_BLOCK);
    for (int64_t k = 0, finder = -1, last = -1; k < h->pairs; k++)
        assert_true(stands_behind(h, k, &finder, &last));
    for (int64_t k = h->wall_base + 1; k < h->end; k++)
        assert_true(h->owner[k] > h->owner[k - 1] || (h->owner[k] == h->owner[k - 1] && h->other[k] > h->other[k - 1]));
    for (int64_t k = h->pairs; k < h->records; k++)
        if (k < h->wall_base || k >= h->end)
            assert_true(h->owner[k] == 0 && h->other[k] == 0);
}

static inline int64_t slot_key(const table_copy *h, int32_t entry)
{
    int64_t k = abs(entry) - 1;
    if (k >= h->wall_base)
        return INT32_MAX + (int64_t)h->other[k];
    return h->id[entry > 0 ? h->other[k] : h->owner[k]];
}

static inline void check_slots(const table_copy *h)
{
    int64_t entries = 0;
    for (int64_t i = 0; i < h->blocks * CLAST_BLOCK; i++) {
        int64_t last = -1;
        bool ended = false;
        for (uint32_t s = h->slot_offset[i / CLAST_BLOCK] + (uint32_t)(i % CLAST_BLOCK); s < h->slot_offset[i / CLAST_BLOCK + 1];
             s += CLAST_BLOCK) {
            int32_t entry = h->slots[s];
            ended = ended || entry == 0;
            assert_true(ended == (entry == 0));
            if (ended)
                continue;
            int64_t k = abs(entry) - 1;
            assert_true(i < h->count && k < h->end && (k < h->pairs || k >= h->wall_base));
            assert_int_equal(entry > 0 ? h->owner[k] : h->other[k], i);
            assert_true(entry > 0 || k < h->pairs);
            assert_true(slot_key(h, entry) > last);
            last = slot_key(h, entry);
            entries++;
        }
    }
    assert_int_equal(entries, 2 * h->pairs + h->end - h->wall_base);
}

/* A block is as wide as its fullest grain. */
static inline void check_widths(const table_copy *h)
{
    for (int64_t b = 0; b < h->blocks; b++) {
        uint32_t width = h->slot_offset[b + 1] - h->slot_offset[b];
        assert_int_equal(width % CLAST_BLOCK, 0);
        bool any = width == 0;
        for (int lane = 0; lane < CLAST_BLOCK && !any; lane++)
            any = h->slots[h->slot_offset[b + 1] - CLAST_BLOCK + (uint32_t)lane] != 0;
        assert_true(any);
    }
}

static inline int64_t cell_of(const clast_grid *g, const double *x, double radius)
{
    int level = 0;
    int64_t at[3];
    while (level + 1 < g->level_count && radius <= g->radius_max / pow(2.0, level + 1))
        level++;
    const clast_level *l = &g->level[level];
    for (int c = 0; c < 3; c++) {
        double cell = floor((x[c] - g->origin[c]) * l->inverse_size[c]);
        cell -= l->cells[c] * floor(cell / l->cells[c]);
        at[c] = (int64_t)cell;
    }
    return l->first_cell + (at[2] * l->cells[1] + at[1]) * l->cells[0] + at[0];
}

/* Grains stand by cell, within a cell by id. */
static inline void check_order(const simulation *sim, const table_copy *h)
{
    int64_t before = -1;
    char *seen = calloc((size_t)sim->id_count + 1, 1);
    assert_non_null(seen);
    for (int64_t i = 0; i < h->count; i++) {
        int64_t cell = cell_of(&sim->table.grid_host, &h->position[3 * i], h->radius[i]);
        assert_true(cell >= before);
        assert_true(i == 0 || cell > before || h->id[i] > h->id[i - 1]);
        before = cell;
        assert_true(h->id[i] >= 0 && h->id[i] < sim->id_count && !seen[h->id[i]]);
        seen[h->id[i]] = 1;
    }
    free(seen);
}

static inline void check_table(simulation *sim)
{
    table_copy h = copy_table(sim);
    check_set(sim, &h);
    check_records(&h);
    check_slots(&h);
    check_widths(&h);
    check_order(sim, &h);
    free_copy(&h);
}

/* Builds the bed's table; `least` pairs must be in it, so that a case is not empty by mistake. */
static inline void check_bed(const char *yaml, bed b, int least)
{
    sim_case c;
    case_open_bed(&c, yaml, b);
    check_table(c.sim);
    if (c.sim->table.pair_count < least)
        fail_msg("only %d pairs", c.sim->table.pair_count);
    case_close(&c);
}
/* ---- grains that move ---- */

/* Puts every grain where `place` says and builds the table anew. */
static inline void move_grains(simulation *sim, void (*place)(int32_t id, double *x))
{
    double *x = case_field(sim, "position");
    int32_t *id = case_read(sim, store_find(sim, "id")->mem, 0, sim->stride, sizeof *id);
    for (int64_t i = 0; i < sim->count; i++)
        place(id[i], &x[3 * i]);
    MUST(store_write(sim, store_find(sim, "position")->mem, 0, 24 * (uint64_t)sim->stride, x, why));
    free(x);
    free(id);
    MUST(table_build(sim, false, why));
}

#endif
