/* What contacts carry from table to table: histories over rebuilds and growth, and what is left when grains leave. */
#include "table_case.h"

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
        cmocka_unit_test(test_histories),
        cmocka_unit_test(test_growth),
        cmocka_unit_test(test_owner_sign),
        cmocka_unit_test(test_leavers),
        cmocka_unit_test(test_all_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
