/* The contact table as the device builds it, against every pair on the host; and histories over rebuilds and growth. */
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

static bed random_bed(int64_t count, double radius_low, double radius_high, uint64_t seed)
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

static table_copy copy_table(simulation *sim)
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

static void free_copy(table_copy *h)
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

static double distance2(const simulation *sim, const double *a, const double *b)
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
static int expected_pair(const simulation *sim, const table_copy *h, int64_t i, int64_t j)
{
    double reach = h->radius[i] + h->radius[j] + sim->table.skin, d2 = distance2(sim, &h->position[3 * i], &h->position[3 * j]);
    if (fabs(d2 - reach * reach) <= DEEP * reach * reach)
        return -1;
    return d2 < reach * reach;
}

static bool owns(const table_copy *h, int64_t i, int64_t j)
{
    return h->radius[i] < h->radius[j] || (h->radius[i] == h->radius[j] && h->id[i] < h->id[j]);
}

/* Height over a face and its two in-plane distances. */
static void face_coordinates(const clast_face *f, const double *x, double *height, double *u, double *v)
{
    *height = *u = *v = 0.0;
    for (int c = 0; c < 3; c++) {
        *height += (x[c] - f->origin[c]) * f->normal[c];
        *u += (x[c] - f->origin[c]) * f->e1[c];
        *v += (x[c] - f->origin[c]) * f->e2[c];
    }
}

/* Distance from a face; behind a plane it is negative. */
static double face_distance(const clast_face *f, const double *x)
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
static int expected_wall(const simulation *sim, const table_copy *h, int64_t i, const clast_face *f)
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
static signed char *mark_records(const table_copy *h, int faces)
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

static void check_set(simulation *sim, const table_copy *h)
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

/* Packed by owner, each owner's partners by id; work-groups filled up with rows that name grain 0 twice. */
static void check_records(const table_copy *h)
{
    assert_int_equal(h->wall_base % CLAST_BLOCK, 0);
    assert_int_equal(h->records % CLAST_BLOCK, 0);
    assert_true(h->wall_base - h->pairs < CLAST_BLOCK && h->records - h->end < CLAST_BLOCK);
    for (int64_t k = 1; k < h->end; k++) {
        if (k >= h->pairs && k <= h->wall_base)
            continue;
        assert_true(h->owner[k] >= h->owner[k - 1]);
        if (h->owner[k] != h->owner[k - 1])
            continue;
        assert_true(k < h->pairs ? h->id[h->other[k]] > h->id[h->other[k - 1]] : h->other[k] > h->other[k - 1]);
    }
    for (int64_t k = h->pairs; k < h->records; k++)
        if (k < h->wall_base || k >= h->end)
            assert_true(h->owner[k] == 0 && h->other[k] == 0);
}

static int64_t slot_key(const table_copy *h, int32_t entry)
{
    int64_t k = abs(entry) - 1;
    if (k >= h->wall_base)
        return INT32_MAX + (int64_t)h->other[k];
    return h->id[entry > 0 ? h->other[k] : h->owner[k]];
}

static void check_slots(const table_copy *h)
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
static void check_widths(const table_copy *h)
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

static int64_t cell_of(const clast_grid *g, const double *x, double radius)
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
static void check_order(const simulation *sim, const table_copy *h)
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

static void check_table(simulation *sim)
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
static void check_bed(const char *yaml, bed b, int least)
{
    sim_case c;
    case_open_bed(&c, yaml, b);
    check_table(c.sim);
    if (c.sim->table.pair_count < least)
        fail_msg("only %d pairs", c.sim->table.pair_count);
    case_close(&c);
}

/* ---- the set of pairs ---- */

static void test_random(void **state)
{
    (void)state;
    const char *yaml = MATERIAL NORMAL SKIN("0.004");
    check_bed(yaml, random_bed(1000, 0.03, 0.03, 1), 400);
    check_bed(yaml, random_bed(1000, 0.02, 0.04, 2), 400);
    check_bed(yaml, random_bed(1500, 0.002, 0.1, 3), 1000); /* size ratio 50 */
    check_bed(yaml, random_bed(400, 5e-5, 0.5, 4), 500);    /* more sizes than levels */
}

/* A boulder in sand: its block alone is wide. */
static void test_boulder(void **state)
{
    (void)state;
    bed b = random_bed(1500, 0.008, 0.008, 5);
    b.radius[700] = 0.4;
    for (int c = 0; c < 3; c++)
        b.position[700][c] = 0.5;
    sim_case c;
    case_open_bed(&c, MATERIAL NORMAL SKIN("0.002"), b);
    check_table(c.sim);
    table_copy h = copy_table(c.sim);
    int wide = 0;
    for (int64_t block = 0; block < h.blocks; block++)
        wide += (h.slot_offset[block + 1] - h.slot_offset[block]) / CLAST_BLOCK > 100;
    assert_int_equal(wide, 1);
    free_copy(&h);
    case_close(&c);
}

static void test_periodic(void **state)
{
    (void)state;
    static const char *const yaml[] = {
        MATERIAL NORMAL SKIN("0.004") PERIODIC("x"),    MATERIAL NORMAL SKIN("0.004") PERIODIC("y"),
        MATERIAL NORMAL SKIN("0.004") PERIODIC("z"),    MATERIAL NORMAL SKIN("0.004") PERIODIC("x, y"),
        MATERIAL NORMAL SKIN("0.004") PERIODIC("x, z"), MATERIAL NORMAL SKIN("0.004") PERIODIC("x, y, z"),
    };
    for (size_t s = 0; s < sizeof yaml / sizeof *yaml; s++) {
        check_bed(yaml[s], random_bed(600, 0.03, 0.03, 10 + s), 100);
        check_bed(yaml[s], random_bed(600, 0.004, 0.2, 20 + s), 500); /* few cells a direction: each neighbour once */
        check_bed(yaml[s], random_bed(300, 0.1, 0.2, 30 + s), 500);
    }
    /* the smallest box that is allowed: 2 (2 r_max + skin) */
    check_bed(MATERIAL NORMAL SKIN("0.1") PERIODIC("x, y, z"), random_bed(40, 0.05, 0.19999, 40), 100);
}

/* Grains on the faces, edges and corners of a periodic box, and exactly one length apart. */
static void test_periodic_edges(void **state)
{
    (void)state;
    bed b = case_bed(54);
    for (int64_t i = 0; i < 54; i++) {
        for (int c = 0, n = (int)(i % 27); c < 3; c++, n /= 3)
            b.position[i][c] = 0.5 * (n % 3) + (i < 27 ? 0.0 : 1e-9 * (double)(1 - n % 3));
        b.radius[i] = 0.06;
    }
    check_bed(MATERIAL NORMAL SKIN("0.01") PERIODIC("x, y, z"), b, 27);
}

static void test_clustered(void **state)
{
    (void)state;
    uint64_t seed = 50;
    bed b = random_bed(600, 0.002, 0.004, 51);
    for (int64_t i = 0; i < 600; i++)
        for (int c = 0; c < 3; c++)
            b.position[i][c] = (double)(i % 3) * 100.0 + case_random(&seed, 0.0, 0.03); /* three heaps, far apart */
    check_bed(MATERIAL NORMAL SKIN("0.001"), b, 600);
    b = random_bed(300, 0.5, 0.9, 52); /* all in one cell */
    check_bed(MATERIAL NORMAL SKIN("0.01"), b, 300 * 299 / 2 - 2000);
    b = case_bed(130); /* all in one place */
    for (int64_t i = 0; i < 130; i++)
        b.radius[i] = 0.01;
    check_bed(MATERIAL NORMAL SKIN("0.01"), b, 130 * 129 / 2);
}

static void test_nothing_near(void **state)
{
    (void)state;
    bed b = case_bed(200);
    for (int64_t i = 0; i < 200; i++) {
        b.position[i][0] = (double)i;
        b.radius[i] = 0.1;
    }
    check_bed(MATERIAL NORMAL SKIN("0.01"), b, 0);
    for (int64_t count = 1; count <= 2; count++) {
        b = case_bed(count);
        b.radius[0] = b.radius[count - 1] = 0.1;
        b.position[count - 1][1] = 0.205 * (double)(count - 1);
        check_bed(MATERIAL NORMAL SKIN("0.01"), b, (int)count - 1);
        b = case_bed(count);
        b.radius[0] = b.radius[count - 1] = 0.1;
        check_bed(MATERIAL NORMAL SKIN("0.01") PERIODIC("x, y, z"), b, (int)count - 1);
    }
}

/* One grain without walls takes steps, meets none, and flies on. */
static void test_one_grain_flies(void **state)
{
    (void)state;
    sim_case c;
    bed b = case_bed(1);
    b.radius[0] = 0.01;
    b.velocity[0][0] = 2.0;
    case_open_bed(&c, MATERIAL FRICTION SKIN("0.001") "gravity_m_s2: [0, 0, -10]\n", b);
    simulation_set_step(c.sim, 1e-4);
    MUST(simulation_advance(c.sim, 1000, why));
    double *x = case_field(c.sim, "position");
    assert_true(fabs(x[0] - 2.0 * 0.1) < 1e-12);
    assert_true(fabs(x[2] + 10.0 * 1e-8 * 0.5 * 1000.0 * 1001.0) < 1e-12);
    free(x);
    check_table(c.sim);
    case_close(&c);
}

/* ---- walls ---- */

#define WALLS                                                                                               \
    "walls:\n"                                                                                              \
    "  - {name: floor, shape: plane, point_m: [0, 0, 0.2], normal: [0.1, 0, 1]}\n"                          \
    "  - {name: box, shape: box, low_m: [0, 0, 0], high_m: [1, 1, 1], open: [z_high]}\n"                    \
    "  - {name: shelf, shape: rectangle, corners_m: [[0.3, 0.3, 0.4], [0.8, 0.3, 0.5], [0.3, 0.6, 0.4]]}\n" \
    "  - {name: coin, shape: disc, center_m: [0.5, 0.5, 0.7], normal: [1, 2, 3], radius_m: 0.2}\n"

static void test_walls(void **state)
{
    (void)state;
    sim_case c;
    const char *const yaml[] = {MATERIAL NORMAL SKIN("0.01") WALLS, MATERIAL NORMAL SKIN("0.01") WALLS PERIODIC("x, y")};
    for (int s = 0; s < 2; s++) {
        case_open_bed(&c, yaml[s], random_bed(900, 0.005, 0.08, 60));
        assert_int_equal(c.sim->face_count, 1 + 5 + 1 + 1);
        assert_true(c.sim->table.wall_record_count > 300);
        check_table(c.sim);
        case_close(&c);
    }
    /* walls without any pair, and one grain */
    bed b = case_bed(1);
    b.radius[0] = 0.05;
    b.position[0][2] = 0.2;
    case_open_bed(&c, yaml[0], b);
    assert_int_equal(c.sim->table.pair_count, 0);
    assert_true(c.sim->table.wall_record_count >= 3);
    check_table(c.sim);
    case_close(&c);
}

/* Every pair and every wall that touches has its record, whatever has moved since the table was built. */
static void check_nothing_missed(simulation *sim)
{
    table_copy h = copy_table(sim);
    int64_t width = h.count + sim->face_count;
    MUST(simulation_pose_now(sim, why));
    signed char *found = mark_records(&h, sim->face_count);
    for (int64_t i = 0; i < h.count; i++) {
        for (int64_t j = 0; j < i; j++) {
            double touch = h.radius[i] + h.radius[j];
            if (distance2(sim, &h.position[3 * i], &h.position[3 * j]) < touch * touch && !found[i * width + j])
                fail_msg("step %lld: grains %d and %d touch unseen", (long long)sim->step, h.id[i], h.id[j]);
        }
        for (int f = 0; f < sim->face_count; f++)
            if (face_distance(&sim->face_rows[f], &h.position[3 * i]) < h.radius[i] && !found[i * width + h.count + f])
                fail_msg("step %lld: grain %d and face %d touch unseen", (long long)sim->step, h.id[i], f);
    }
    free(found);
    free_copy(&h);
}

#define MOVING_WALLS                                                                                                                     \
    "walls:\n"                                                                                                                           \
    "  - {name: piston, shape: plane, point_m: [-0.05, 0, 0], normal: [1, 0, 0], motion: [{type: constant, velocity_m_s: [2, 0, 0]}]}\n" \
    "  - {name: paddle, shape: rectangle, corners_m: [[0.1, 0.5, 0.1], [0.9, 0.5, 0.1], [0.1, 0.5, 0.9]],"                               \
    " motion: [{type: rotation, point_m: [0.5, 0.5, 0.5], axis: [0, 0, 1], rate_rad_s: 9}]}\n"                                           \
    "  - {name: plate, shape: disc, center_m: [0.5, 0.5, 0.5], normal: [0, 0, 1], radius_m: 0.4,"                                        \
    " motion: [{type: sinusoid, direction: [0, 0, 1], amplitude_m: 0.3, frequency_hz: 3}]}\n"

static void test_moving_walls(void **state)
{
    (void)state;
    sim_case c;
    uint64_t seed = 70;
    bed b = random_bed(300, 0.01, 0.05, 71);
    for (int64_t i = 0; i < 300; i++)
        for (int k = 0; k < 3; k++)
            b.velocity[i][k] = case_random(&seed, -1.0, 1.0);
    case_open_bed(&c, MATERIAL NORMAL SKIN("0.01") MOVING_WALLS PERIODIC("y, z"), b);
    simulation_set_step(c.sim, 1e-4);
    for (int n = 0; n < 60; n++) {
        MUST(simulation_advance(c.sim, 17, why));
        check_nothing_missed(c.sim);
    }
    assert_true(c.sim->rebuilds > 20);
    MUST(simulation_pose_now(c.sim, why));
    MUST(table_build(c.sim, false, why));
    check_table(c.sim);
    case_close(&c);
}

/* Walls that sweep through grains that nothing moves: the walls alone ask for tables. */
static void test_sweeping_walls(void **state)
{
    (void)state;
    sim_case c;
    case_open_bed(&c, "effects: [{slot: body, law: viscous_damping, coefficient: 0}]\n" MATERIAL SKIN("0.01") MOVING_WALLS,
                  random_bed(300, 0.01, 0.05, 74));
    simulation_set_step(c.sim, 1e-4);
    for (int n = 0; n < 60; n++) {
        MUST(simulation_advance(c.sim, 17, why));
        check_nothing_missed(c.sim);
    }
    assert_true(c.sim->rebuilds > 20 && c.sim->rebuilds < 1000);
    case_close(&c);
}

/* A bed that flies as a whole needs no table on the way, and comes to no harm. */
static void test_drift(void **state)
{
    (void)state;
    sim_case c;
    uint64_t seed = 72;
    bed b = random_bed(300, 0.03, 0.03, 73);
    for (int64_t i = 0; i < 300; i++)
        b.velocity[i][1] = 50.0 + case_random(&seed, -0.01, 0.01);
    case_open_bed(&c,
                  "domain: {low_m: [-100, -100, -100], high_m: [100, 100, 100], periodic: [x, y, z]}\n"
                  "effects: [{slot: body, law: viscous_damping, coefficient: 0}]\n" MATERIAL SKIN("0.01"),
                  b);
    simulation_set_step(c.sim, 1e-4);
    MUST(simulation_advance(c.sim, 1000, why));
    check_nothing_missed(c.sim);
    assert_true(c.sim->rebuilds <= 2);
    case_close(&c);
}

/* ---- grains that moved, and growth ---- */

/* Puts every grain where `place` says and builds the table anew. */
static void move_grains(simulation *sim, void (*place)(int32_t id, double *x))
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

static void place_far(int32_t id, double *x)
{
    for (int c = 0; c < 3; c++)
        x[c] += id % 3 == c ? 1e6 * (id % 2 ? 1.0 : -1.0) : -37.0;
}

static void test_far_outside(void **state)
{
    (void)state;
    sim_case c;
    case_open_bed(&c, MATERIAL NORMAL SKIN("0.01") WALLS, random_bed(600, 0.02, 0.06, 80));
    move_grains(c.sim, place_far);
    check_table(c.sim);
    assert_true(c.sim->table.pair_count > 50);
    case_close(&c);
}

static void place_closer(int32_t id, double *x)
{
    (void)id;
    for (int c = 0; c < 3; c++)
        x[c] = 0.5 + 0.6 * (x[c] - 0.5);
}

static void place_apart(int32_t id, double *x)
{
    (void)id;
    for (int c = 0; c < 3; c++)
        x[c] = 0.5 + (x[c] - 0.5) / 0.36;
}

static void place_nudged(int32_t id, double *x)
{
    uint64_t seed = (uint64_t)id + 1;
    for (int c = 0; c < 3; c++)
        x[c] += case_random(&seed, -0.02, 0.02);
}

/* ---- histories ---- */

/* A number for component c of the contact of two parties, seen from the first: the other sees the opposite. */
static double made_up(int64_t a, int64_t b, int c)
{
    double sign = a < b ? 1.0 : -1.0;
    uint64_t seed = (uint64_t)(a < b ? a : b) * 1000003u + (uint64_t)(a < b ? b : a) * 7u + (uint64_t)c;
    return sign * case_random(&seed, 0.5, 1.5);
}

/* Faces count as parties behind all grains. */
static int64_t party_of(const simulation *sim, const table_copy *h, int64_t k)
{
    return k >= h->wall_base ? sim->id_count + h->other[k] : h->id[h->other[k]];
}

static void write_springs(simulation *sim)
{
    table_copy h = copy_table(sim);
    double *column = calloc((size_t)h.records + 1, sizeof *column);
    assert_non_null(column);
    for (int c = 0; c < 3; c++) {
        for (int64_t k = 0; k < h.records; k++)
            column[k] = (k >= h.pairs && k < h.wall_base) || k >= h.end ? 0.0 : made_up(h.id[h.owner[k]], party_of(sim, &h, k), c);
        MUST(store_write(sim, store_find(sim, "tangential_spring")->mem, 8 * (uint64_t)(c * sim->table.record_stride),
                         8 * (uint64_t)h.records, column, why));
    }
    free(column);
    free_copy(&h);
}

/* Contacts of `before` that are still listed keep theirs, new ones have none. Returns how many were kept. */
static int64_t check_springs(simulation *sim, const signed char *before)
{
    table_copy h = copy_table(sim);
    int64_t kept = 0, width = sim->id_count + sim->face_count;
    for (int c = 0; c < 3; c++) {
        double *column = case_read(sim, store_find(sim, "tangential_spring")->mem, c * sim->table.record_stride, h.records, sizeof *column);
        for (int64_t k = 0; k < h.records; k++) {
            if ((k >= h.pairs && k < h.wall_base) || k >= h.end) {
                assert_true(column[k] == 0.0);
                continue;
            }
            int64_t i = h.id[h.owner[k]], j = party_of(sim, &h, k);
            bool was = before[i * width + j];
            kept += was;
            if (column[k] != (was ? made_up(i, j, c) : 0.0))
                fail_msg("spring of %lld and %lld: %g, not %g", (long long)i, (long long)j, column[k], was ? made_up(i, j, c) : 0.0);
        }
        free(column);
    }
    free_copy(&h);
    return kept / 3;
}

/* listed[i][j] by permanent ids, faces behind. */
static signed char *listed_by_id(simulation *sim)
{
    table_copy h = copy_table(sim);
    int64_t width = sim->id_count + sim->face_count;
    signed char *listed = calloc((size_t)(sim->id_count * width + 1), 1);
    assert_non_null(listed);
    for (int64_t k = 0; k < h.end; k++) {
        if (k >= h.pairs && k < h.wall_base)
            continue;
        int64_t i = h.id[h.owner[k]], j = party_of(sim, &h, k);
        listed[i * width + j] = 1;
        if (k < h.pairs)
            listed[j * width + i] = 1;
    }
    free_copy(&h);
    return listed;
}

static void check_carried(simulation *sim, void (*place)(int32_t id, double *x), int64_t least)
{
    write_springs(sim);
    signed char *before = listed_by_id(sim);
    move_grains(sim, place);
    check_table(sim);
    int64_t kept = check_springs(sim, before);
    if (kept < least)
        fail_msg("only %lld contacts kept", (long long)kept);
    free(before);
}

static void test_histories(void **state)
{
    (void)state;
    const char *const yaml[] = {MATERIAL FRICTION SKIN("0.01") WALLS, MATERIAL FRICTION SKIN("0.01") WALLS PERIODIC("x, y")};
    for (int s = 0; s < 2; s++) {
        sim_case c;
        case_open_bed(&c, yaml[s], random_bed(700, 0.02, 0.06, 90));
        for (int n = 0; n < 4; n++)
            check_carried(c.sim, place_nudged, 500);
        case_close(&c);
    }
}

/* A bed that is squeezed, spread and squeezed again: records and slots outgrow their places, and nothing is lost. */
static void test_growth(void **state)
{
    (void)state;
    sim_case c;
    case_open_bed(&c, MATERIAL FRICTION SKIN("0.01") WALLS, random_bed(700, 0.02, 0.06, 91));
    for (int n = 0; n < 3; n++) {
        int64_t records = c.sim->table.record_capacity, slots = c.sim->table.slot_capacity;
        check_carried(c.sim, place_closer, 500);
        assert_true(c.sim->table.record_capacity > records && c.sim->table.slot_capacity > slots);
        check_carried(c.sim, place_nudged, 500);
    }
    for (int n = 0; n < 2; n++)
        check_carried(c.sim, place_apart, 100);
    check_carried(c.sim, place_closer, 100);
    uint64_t counted = c.sim->bytes;
    MUST(table_build(c.sim, false, why));
    assert_int_equal(c.sim->bytes, counted); /* what stays the same size is not counted again */
    case_close(&c);
}

/* Grains that trade sizes change the owners of their pairs: the history is the same, seen from the other side. */
static void test_owner_sign(void **state)
{
    (void)state;
    sim_case c;
    case_open_bed(&c, MATERIAL FRICTION SKIN("0.05"), random_bed(400, 0.05, 0.06, 92));
    write_springs(c.sim);
    signed char *before = listed_by_id(c.sim);
    table_copy old = copy_table(c.sim);
    double *radius = malloc(sizeof *radius * (size_t)c.sim->stride);
    assert_non_null(radius);
    for (int64_t i = 0; i < c.sim->stride; i++)
        radius[i] = i < c.sim->count ? 0.11 - old.radius[i] : 1.0;
    MUST(store_write(c.sim, store_find(c.sim, "radius")->mem, 0, 8 * (uint64_t)c.sim->stride, radius, why));
    free(radius);
    free_copy(&old);
    MUST(table_build(c.sim, false, why));
    check_table(c.sim);
    assert_true(check_springs(c.sim, before) > 1000);
    free(before);
    case_close(&c);
}

/* ---- grains that leave ---- */

static void place_outside(int32_t id, double *x)
{
    if (id % 3 == 0)
        x[2] = id % 2 ? 1.5 : -0.5;
}

/* Leavers are gone from the table; the rest keep their contacts. */
static void test_leavers(void **state)
{
    (void)state;
    sim_case c;
    case_open_bed(&c, MATERIAL FRICTION SKIN("0.01") "domain: {low_m: [0, 0, 0], high_m: [1, 1, 1], leaving: delete}\n",
                  random_bed(700, 0.02, 0.06, 93));
    double mass = 0.0;
    for (int64_t i = 0; i < 700; i += 3)
        mass += 4.0 / 3.0 * M_PI * 2500.0 * pow(c.bed.radius[i], 3.0);
    write_springs(c.sim);
    signed char *before = listed_by_id(c.sim);
    move_grains(c.sim, place_outside); /* outside, and still there */
    assert_int_equal(c.sim->count, 700);
    check_springs(c.sim, before);
    write_springs(c.sim);
    free(before);
    before = listed_by_id(c.sim);
    MUST(table_build(c.sim, true, why));
    assert_int_equal(c.sim->count, 700 - 234);
    assert_int_equal(c.sim->left_count, 234);
    assert_true(fabs(c.sim->left_mass - mass) < 1e-12 * mass);
    check_table(c.sim);
    assert_true(check_springs(c.sim, before) > 150);
    table_copy h = copy_table(c.sim);
    for (int64_t i = 0; i < h.count; i++)
        assert_true(h.id[i] % 3 != 0);
    MUST(observe_where(c.sim, why));
    int32_t *where = case_read(c.sim, c.sim->where, 0, 700, sizeof *where);
    for (int32_t n = 0; n < 700; n++)
        assert_true(n % 3 == 0 ? where[n] == -1 : h.id[where[n]] == n);
    free(where);
    free_copy(&h);
    free(before);
    case_close(&c);
}

static void place_all_outside(int32_t id, double *x)
{
    x[0] = 2.0 + (double)id;
}

static void test_all_leave(void **state)
{
    (void)state;
    sim_case c;
    case_open_bed(&c, MATERIAL FRICTION SKIN("0.01") "domain: {low_m: [0, 0, 0], high_m: [1, 1, 1], leaving: delete}\n",
                  random_bed(100, 0.02, 0.06, 94));
    move_grains(c.sim, place_all_outside);
    MUST(table_build(c.sim, true, why));
    assert_int_equal(c.sim->count, 0);
    simulation_set_step(c.sim, 1e-5);
    MUST(simulation_advance(c.sim, 100, why));
    MUST(table_build(c.sim, true, why));
    check_table(c.sim);
    step_limit limit;
    particle_sums sums;
    contact_sums contacts;
    guard_finding finding;
    MUST(limit_find(c.sim, &limit, why));
    MUST(observe_particle_sums(c.sim, &sums, why));
    MUST(observe_contact_sums(c.sim, &contacts, why));
    MUST(guard_check(c.sim, &finding, why));
    assert_true(sums.mass == 0.0 && contacts.contacts == 0 && !finding.stop);
    case_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random),          cmocka_unit_test(test_boulder),   cmocka_unit_test(test_periodic),
        cmocka_unit_test(test_periodic_edges),  cmocka_unit_test(test_clustered), cmocka_unit_test(test_nothing_near),
        cmocka_unit_test(test_one_grain_flies), cmocka_unit_test(test_walls),     cmocka_unit_test(test_moving_walls),
        cmocka_unit_test(test_sweeping_walls),  cmocka_unit_test(test_drift),     cmocka_unit_test(test_far_outside),
        cmocka_unit_test(test_histories),       cmocka_unit_test(test_growth),    cmocka_unit_test(test_owner_sign),
        cmocka_unit_test(test_leavers),         cmocka_unit_test(test_all_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
