/* A step in chunks: every record and every grain once, no grain before its records, no force overwritten before it has been gathered; and the
 * same bits as in one piece. */
#include "simulation_case.h"
#include "frozen.h"
#include "ledger.h"

#define COMMON                                                                                            \
    "gravity_m_s2: [1, 0.5, -9]\n"                                                                        \
    "effects: [{slot: normal, law: hertz}, {slot: tangential, law: mindlin}]\n"                           \
    "materials: [{name: glass, density_kg_m3: 2500, youngs_modulus_pa: 5.0e6, poissons_ratio: 0.3}]\n"    \
    "interactions: [{between: default, restitution: 0.5, friction_static: 0.4}]\n"                        \
    "stages: [{name: go, until: {steps: 1}, step_s: 1.0e-5}]\n"
#define GRAINS "particles: [{name: one, material: glass, generator: list, items: [{position_m: [0.005, 0.005, 0.005], radius_m: 1.0e-3}]}]\n"
#define FLOOR "walls: [{name: floor, shape: plane, point_m: [0, 0, -0.0009], normal: [0, 0, 1]}]\n"
#define PERIODIC "domain: {low_m: [0, 0, 0], high_m: [0.016, 0.016, 0.044], periodic: [x, y, z]}\n"

/* Grains of about 1 mm on a grid whose spacing makes most of them touch; some four times as large where `boulders`. */
static bed packed(bool boulders)
{
    const int n[3] = {8, 8, 22};
    bed b = case_bed(n[0] * n[1] * n[2]);
    uint64_t seed = 3;
    for (int64_t i = 0; i < b.count; i++) {
        int64_t at[3] = {i % n[0], i / n[0] % n[1], i / n[0] / n[1]};
        for (int c = 0; c < 3; c++) {
            b.position[i][c] = (0.5 + (double)at[c]) * 0.002 + case_random(&seed, -1e-4, 1e-4);
            b.velocity[i][c] = case_random(&seed, -0.1, 0.1);
            b.spin[i][c] = case_random(&seed, -50.0, 50.0);
        }
        b.radius[i] = case_random(&seed, 0.95e-3, 1.05e-3);
    }
    for (int64_t i = 0; boulders && i < 4; i++) {
        b.radius[i] = 4e-3;
        b.position[i][0] = b.position[i][1] = 0.008;
        b.position[i][2] = 0.06 + 0.0081 * (double)i;
    }
    return b;
}

static void open_bed_in(sim_case *c, const char *rest, bool boulders, const char *chunk, const char *form)
{
    char yaml[4096];
    snprintf(yaml, sizeof yaml, "%scontact_table: {chunk_records: %s, step_form: %s}\n", rest, chunk, form);
    case_open_bed(c, yaml, packed(boulders));
    simulation_set_step(c->sim, 1e-5);
}

/* With a skin so wide that lots of records in which none touches are looked for. */
#define LOOSE_CHUNKS "256, skin_m: 4.0e-4"

static void open_bed(sim_case *c, const char *rest, bool boulders, const char *chunk)
{
    open_bed_in(c, rest, boulders, chunk, "two_kernels");
}

/* ---- the order of the pieces ---- */

typedef struct table_copy {
    int32_t *owner, *other, *slots, *placed;
    uint32_t *slot_offset;
} table_copy;

static table_copy copy_table(simulation *sim)
{
    contact_table *t = &sim->table;
    int64_t blocks = sim->stride / CLAST_BLOCK;
    table_copy r = {.owner = case_read(sim, t->owner[t->now], 0, t->record_count, 4),
                    .other = case_read(sim, t->other[t->now], 0, t->record_count, 4),
                    .slot_offset = case_read(sim, t->slot_offset[t->now], 0, blocks + 1, 4)};
    r.slots = case_read(sim, t->slots[t->now], 0, r.slot_offset[blocks], 4);
    r.placed = sim->plan.force_records > 0 ? case_read(sim, t->placed, 0, r.slot_offset[blocks], 4) : NULL;
    return r;
}

static void free_copy(table_copy *r)
{
    free(r->owner);
    free(r->other);
    free(r->slots);
    free(r->placed);
    free(r->slot_offset);
}

/* The pair stage puts record k where the piece says. */
static void put_records(const simulation *sim, const clast_piece *piece, const table_copy *r, const bool *moved, int *at)
{
    for (int k = piece->first * CLAST_BLOCK; k < (piece->first + piece->count) * CLAST_BLOCK; k++) {
        assert_true(k >= 0 && k < sim->table.record_count && k - piece->force_shift >= 0 && k - piece->force_shift < sim->table.record_count);
        bool pads = k >= sim->table.pair_count && k < sim->table.wall_base;
        pads = pads || k >= sim->table.wall_base + sim->table.wall_record_count;
        if (!pads && (moved[r->owner[k] / CLAST_BLOCK] || (k < sim->table.wall_base && moved[r->other[k] / CLAST_BLOCK])))
            fail_msg("record %d is late: one of its grains has moved", k);
        at[k - piece->force_shift] = k;
    }
}

/* The particle stage finds every record of its blocks, where its slots lead. */
static void take_blocks(const simulation *sim, const clast_piece *piece, const table_copy *r, bool *moved, const int *at)
{
    for (int b = piece->first; b < piece->first + piece->count; b++) {
        assert_true(b >= 0 && (int64_t)b * CLAST_BLOCK < sim->count && !moved[b]);
        moved[b] = true;
        for (uint32_t s = r->slot_offset[b]; s < r->slot_offset[b + 1]; s++) {
            int entry = r->slots[s], lead = r->placed ? r->placed[s] : entry;
            assert_true((entry > 0) == (lead > 0) && (entry < 0) == (lead < 0));
            if (entry != 0 && at[abs(lead) - 1] != abs(entry) - 1)
                fail_msg("block %d finds record %d where %d should stand", b, at[abs(lead) - 1], abs(entry) - 1);
        }
    }
}

/* Piece number `n` of a step where the streams go one after the other, the last one first. */
static int with_streams_reversed(const step_plan *plan, int n)
{
    const clast_phases *phases = &plan->phases;
    int streams = 0;
    for (int p = 0; p < phases->count; p++)
        streams = phases->phase[p].streams ? phases->phase[p].end : streams;
    if (streams == 0 || n < phases->stream[0] || n >= phases->stream[streams])
        return n;
    int at = n - phases->stream[0];
    for (int s = streams - 1; s >= 0; s--) {
        int pieces = phases->stream[s + 1] - phases->stream[s];
        if (at < pieces)
            return phases->stream[s] + at;
        at -= pieces;
    }
    return -1;
}

static void assert_in_order(simulation *sim, bool reversed)
{
    table_copy r = copy_table(sim);
    int64_t blocks = (sim->count + CLAST_BLOCK - 1) / CLAST_BLOCK, records = 0, done = 0;
    bool *moved = calloc((size_t)blocks + 1, sizeof *moved);
    int *at = malloc(sizeof *at * (size_t)sim->table.record_count);
    assert_non_null(moved);
    assert_non_null(at);
    memset(at, -1, sizeof *at * (size_t)sim->table.record_count);
    for (int p = 0; p < sim->plan.count; p++) {
        const clast_piece *piece = &sim->plan.piece[reversed ? with_streams_reversed(&sim->plan, p) : p];
        if (piece->pairs)
            put_records(sim, piece, &r, moved, at);
        else
            take_blocks(sim, piece, &r, moved, at);
        *(piece->pairs ? &records : &done) += piece->count;
    }
    assert_int_equal(records * CLAST_BLOCK, sim->table.record_count);
    assert_int_equal(done, blocks);
    free(moved);
    free(at);
    free_copy(&r);
}

static void test_order(void **state)
{
    (void)state;
    static const char *const chunks[] = {"64", "256", "1024"};
    for (int c = 0; c < 3; c++)
        for (int wraps = 0; wraps < 2; wraps++)
            for (int boulders = 0; boulders < 2 - wraps; boulders++) {
                sim_case one;
                open_bed(&one, wraps ? COMMON GRAINS PERIODIC : COMMON GRAINS FLOOR, boulders, chunks[c]);
                assert_int_equal(one.sim->plan.chunk_records, atoi(chunks[c]));
                assert_true(one.sim->plan.count > 4);
                assert_in_order(one.sim, false);
                case_close(&one);
            }
}

/* A tall bed needs a few layers of its records at a time. */
static void test_forces_share_places(void **state)
{
    (void)state;
    for (int loose = 0; loose < 2; loose++) {
        sim_case c;
        open_bed(&c, COMMON GRAINS FLOOR, false, loose ? LOOSE_CHUNKS : "256");
        assert_true(c.sim->plan.force_records > 0);
        assert_true(2 * c.sim->plan.force_records <= c.sim->table.wall_base);
        assert_int_equal(launch_values(c.sim).loose, loose);
        case_close(&c);
    }
}

/* Streams do not wait for one another, so they may go in any order. */
static void test_streams(void **state)
{
    (void)state;
    static const char *const chunks[] = {"64", "256", "auto"};
    int units = (int)case_device()->info.compute_units;
    if (units < 2)
        skip(); /* one core has no streams */
    for (int c = 0; c < 3; c++)
        for (int wraps = 0; wraps < 2; wraps++)
            for (int reversed = 0; reversed < 2; reversed++) {
                sim_case one;
                open_bed_in(&one, wraps ? COMMON GRAINS PERIODIC : COMMON GRAINS FLOOR, false, chunks[c], "phases");
                const clast_phases *phases = &one.sim->plan.phases;
                const clast_phase *streams = &phases->phase[phases->phase[0].streams ? 0 : 1];
                assert_true(streams->streams && streams->end > 1 && streams->end <= units && streams->units == streams->end);
                assert_true(c > 0 || wraps || one.sim->plan.force_records > 0);
                assert_in_order(one.sim, reversed);
                case_close(&one);
            }
}

/* Two launches where nothing is gained by more. */
static void test_small_beds_go_whole(void **state)
{
    (void)state;
    sim_case c;
    open_bed(&c, COMMON GRAINS FLOOR, false, "auto");
    assert_int_equal(c.sim->plan.count, 2);
    assert_int_equal(c.sim->plan.chunk_records, 0);
    assert_in_order(c.sim, false);
    case_close(&c);
}

/* ---- the same bits ---- */

#define STEPS 150

static double *run(const char *rest, bool boulders, const char *chunk)
{
    static const char *const names[] = {"position", "velocity", "spin"};
    sim_case c;
    open_bed(&c, rest, boulders, chunk);
    MUST(simulation_advance(c.sim, STEPS, why));
    double *all = malloc(sizeof *all * (size_t)(9 * c.sim->id_count));
    assert_non_null(all);
    for (int f = 0; f < 3; f++) {
        double *rows;
        MUST(observe_field(c.sim, names[f], &rows, why));
        memcpy(all + 3 * f * c.sim->id_count, rows, sizeof *all * (size_t)(3 * c.sim->id_count));
        free(rows);
    }
    contact_sums sums;
    MUST(observe_contact_sums(c.sim, &sums, why));
    if (sums.contacts < c.sim->count / 8)
        fail_msg("only %lld contacts", (long long)sums.contacts);
    case_close(&c);
    return all;
}

static void test_bits(void **state)
{
    (void)state;
    static const struct {
        const char *rest, *chunk;
        bool boulders;
    } cases[] = {
        {COMMON GRAINS FLOOR, "64", false}, {COMMON GRAINS FLOOR, "512", false}, {COMMON GRAINS FLOOR, "256", true}, {COMMON GRAINS PERIODIC, "256", false},
        {COMMON GRAINS FLOOR, LOOSE_CHUNKS, false}};
    size_t count = (size_t)(9 * 8 * 8 * 22);
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        double *whole = run(cases[n].rest, cases[n].boulders, "1000000000"), *chunked = run(cases[n].rest, cases[n].boulders, cases[n].chunk);
        for (size_t k = 0; k < count; k++)
            if (memcmp(&whole[k], &chunked[k], sizeof *whole) != 0)
                fail_msg("case %zu: value %zu is %.17g in chunks, %.17g in one piece", n, k, chunked[k], whole[k]);
        free(whole);
        free(chunked);
    }
}

/* ---- the same bits with history, heat and a wall that answers, and across a stage without motion ---- */

#define EVERYTHING                                                                                                                                   \
    "gravity_m_s2: [1, 0.5, -9]\n"                                                                                                                    \
    "effects: [{slot: normal, law: hertz}, {slot: tangential, law: mindlin}, {slot: rolling, law: elastic_plastic}, {slot: conduction, law: overlap_area}," \
    " {slot: dissipation_heat, law: fraction}%s]\n"                                                                                                   \
    "materials: [{name: glass, density_kg_m3: 2500, youngs_modulus_pa: 5.0e6, poissons_ratio: 0.3, conductivity_w_mk: 60, specific_heat_j_kgk: 50}]\n"  \
    "interactions: [{between: default, restitution: 0.5, friction_static: 0.4, rolling_friction: 0.05%s}]\n" GRAINS                                   \
    "walls: [{name: floor, shape: plane, point_m: [0, 0, -0.0009], normal: [0, 0, 1], temperature_k: 500},\n"                                         \
    "  {name: lid, shape: plane, point_m: [0, 0, 0.0449], normal: [0, 0, -1], servo: {direction: [0, 0, -1], force_n: 0.05, speed_max_m_s: 0.5}}]\n"   \
    "output: {observables: [heat_walls%s]}\n"                                                                                                         \
    "stages: [{name: go, until: {steps: 1}, step_s: 1.0e-5}, {name: heat, until: {time_s: 0.01}, motion: frozen, heat: {method: stabilised}},"          \
    " {name: on, until: {steps: 1}, step_s: 1.0e-5}]\ncontact_table: {chunk_records: %s, step_form: two_kernels}\n"

/* Steps, a frozen stage, steps again: state in the order of ids, then the servo, the ledger and the bonds. */
static double *run_everything(bool bonds, const char *chunk, int64_t *count)
{
    static const struct {
        const char *name;
        int components;
    } fields[] = {{"position", 3}, {"velocity", 3}, {"spin", 3}, {"temperature", 1}};
    sim_case c;
    char yaml[8192];
    snprintf(yaml, sizeof yaml, EVERYTHING, bonds ? ", {slot: bond, law: parallel, criterion: always}" : "",
             bonds ? ", bond_youngs_modulus_pa: 1.0e7, bond_damping_ratio: 0.2, bond_gap_ratio: 0.02, bond_tensile_strength_pa: 1.0e4" : "",
             bonds ? "" : ", dissipated_normal, dissipated_tangential, dissipated_rolling, work_walls", chunk);
    bed b = packed(false);
    for (int64_t i = 0; i < b.count; i++)
        b.temperature[i] = 300.0 + (double)(i % 7) * 20.0;
    case_open_bed(&c, yaml, b);
    for (int stage = 0; stage < 3; stage++) {
        if (stage > 0)
            MUST(simulation_begin_stage(c.sim, stage, why));
        if (stage == 1) {
            MUST(frozen_advance(c.sim, c.sim->time + 0.01, INT64_MAX, why));
            continue;
        }
        simulation_set_step(c.sim, 1e-5);
        MUST(simulation_advance(c.sim, STEPS, why));
    }
    assert_int_equal(c.sim->plan.chunk_records, strcmp(chunk, "64") == 0 ? 64 : 0);
    int64_t n = c.sim->id_count, at = 0;
    double *all = calloc((size_t)(10 * n + 32), sizeof *all);
    assert_non_null(all);
    for (int f = 0; f < 4; f++) {
        double *rows;
        MUST(observe_field(c.sim, fields[f].name, &rows, why));
        memcpy(all + at, rows, sizeof *all * (size_t)(fields[f].components * n));
        at += fields[f].components * n;
        free(rows);
    }
    contact_sums sums;
    bond_sums bonded;
    MUST(observe_contact_sums(c.sim, &sums, why));
    MUST(bonds_count(c.sim, &bonded, why));
    assert_true(sums.contacts > 50);
    assert_true(!bonds || bonded.alive > 100);
    assert_true(c.sim->drives.drive[0].state.shift > 0.0);
    all[at++] = sums.elastic;
    all[at++] = (double)bonded.alive;
    all[at++] = (double)bonded.broken;
    all[at++] = c.sim->drives.drive[0].state.shift;
    all[at++] = c.sim->drives.drive[0].state.force;
    if (!bonds) {
        double e[LEDGER_TERMS];
        MUST(ledger_read(c.sim, e, why));
        assert_true(e[0] > 0.0);
        memcpy(all + at, e, sizeof e);
        at += LEDGER_TERMS;
    }
    *count = at;
    case_close(&c);
    return all;
}

static void test_bits_with_everything(void **state)
{
    (void)state;
    for (int bonds = 0; bonds < 2; bonds++) {
        int64_t count, other;
        double *whole = run_everything(bonds, "1000000000", &count), *chunked = run_everything(bonds, "64", &other);
        assert_int_equal(count, other);
        for (int64_t k = 0; k < count; k++)
            if (memcmp(&whole[k], &chunked[k], sizeof *whole) != 0)
                fail_msg("%s bonds: value %lld is %.17g in chunks, %.17g in one piece", bonds ? "with" : "without", (long long)k, chunked[k], whole[k]);
        free(whole);
        free(chunked);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_order),
        cmocka_unit_test(test_forces_share_places), cmocka_unit_test(test_streams),
        cmocka_unit_test(test_small_beds_go_whole),
        cmocka_unit_test(test_bits),
        cmocka_unit_test(test_bits_with_everything),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
