/* The settled bed of the benchmarks: how large ones are laid out, mirror images, and the cache. */
#include "settled_bed.h"

#include "simulation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* cmocka has a macro called fail, so it comes after the headers that declare the function. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static void test_layouts(void **state)
{
    (void)state;
    const int64_t sizes[] = {100, 10000, 20000, 20001, 50000, 99991, 100000, 1000000, 10000000, 100000000};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        bed_layout l = settled_bed_layout(sizes[k], NULL);
        int64_t images = (int64_t)l.columns * l.rows;
        assert_int_equal(l.part * images - l.surplus, sizes[k]);
        assert_true(l.surplus >= 0 && l.surplus < images);
        assert_true(sizes[k] <= 20000 ? images == 1 : l.part >= 8000 && l.part <= 20000);
        assert_true(l.columns >= l.rows && l.columns <= 2 * l.rows);
        assert_true(fabs(l.part_x * l.columns / l.side - 1.0) < 1e-12 && fabs(l.part_y * l.rows / l.side - 1.0) < 1e-12);
        /* As wide as a bed of volume fraction 0.6 is high. */
        double volume = (double)sizes[k] * 4.0 / 3.0 * M_PI * 1.01e-9;
        assert_true(fabs(volume / (0.6 * pow(l.side, 3)) - 1.0) < 1e-12);
        /* One grain in a hundred a thousand times the volume of the others. */
        bed_layout two = settled_bed_layout(sizes[k], &(bed_sizes){.ratio = 10.0, .large_share = 0.01});
        assert_int_equal(two.part, l.part);
        assert_true(fabs(pow(two.side / l.side, 3) / (0.99 + 0.01 * 1000.0) - 1.0) < 1e-12);
    }
}

static bed part_of_two(double (*position)[3], double (*velocity)[3], double (*spin)[3], double *radius)
{
    return (bed){.count = 2, .position = position, .velocity = velocity, .spin = spin, .radius = radius};
}

/* A grain and its image touch where the mirror stands, and their surfaces do not slide on each other. */
static void check_image(const bed *b, int64_t i, int64_t j, int axis, double mirror)
{
    double slip[3];
    assert_true(fabs(0.5 * (b->position[i][axis] + b->position[j][axis]) - mirror) < 1e-15);
    assert_true(b->velocity[i][axis] == -b->velocity[j][axis]);
    for (int c = 0; c < 3; c++) {
        int d = (c + 1) % 3, e = (c + 2) % 3;
        double sum_d = b->spin[i][d] + b->spin[j][d], sum_e = b->spin[i][e] + b->spin[j][e];
        slip[c] = b->velocity[i][c] - b->velocity[j][c] + (sum_d * (e == axis) - sum_e * (d == axis)) * b->radius[i];
        assert_true(c == axis || fabs(slip[c]) < 1e-15);
        assert_true(c == axis || b->position[i][c] == b->position[j][c]);
    }
}

static void test_images(void **state)
{
    (void)state;
    double position[2][3] = {{0.01, 0.02, 0.03}, {0.04, 0.05, 0.06}}, velocity[2][3] = {{1, 2, 3}, {4, 5, 6}},
           spin[2][3] = {{7, 8, 9}, {10, 11, 12}}, radius[2] = {1e-3, 2e-3};
    bed part = part_of_two(position, velocity, spin, radius), out;
    bed_layout l = {.columns = 3, .rows = 2, .part = 2, .surplus = 0, .side = 0.3, .part_x = 0.1, .part_y = 0.15};
    failure why;
    assert_int_equal(settled_bed_assemble(&l, &part, 12, &out, &why), STATUS_OK);
    for (int64_t i = 0; i < 2; i++) {
        check_image(&out, i, 2 + i, 0, 0.1);
        check_image(&out, 2 + i, 4 + i, 0, 0.2);
        check_image(&out, i, 6 + i, 1, 0.15);
        check_image(&out, 4 + i, 10 + i, 1, 0.15);
    }
    bed_free(&out);
    l.surplus = 4;
    assert_int_equal(settled_bed_assemble(&l, &part, 8, &out, &why), STATUS_OK);
    int64_t high = 0;
    for (int64_t i = 0; i < out.count; i++)
        high += out.position[i][2] == 0.06;
    assert_int_equal(high, 2);
    assert_true(out.low[0] == 0.01 && fabs(out.high[1] - 0.28) < 1e-15);
    bed_free(&out);
}

static void check_rest(const settled_bed *b, device *device)
{
    double r = 1.1e-3, overlap = 0.05 * r;
    for (int64_t i = 0; i < b->bed.count; i++) {
        const double *x = b->bed.position[i];
        double ri = b->bed.radius[i];
        assert_true(ri >= 0.9e-3 && ri <= r);
        assert_true(x[0] > ri - overlap && x[0] < b->side_m - ri + overlap && x[1] > ri - overlap && x[1] < b->side_m - ri + overlap);
        assert_true(x[2] > ri - overlap && x[2] < 2.0 * b->side_m);
    }
    simulation *sim;
    failure why;
    contact_sums contacts;
    particle_sums sums;
    assert_int_equal(simulation_create(b->scene, &b->bed, device, NULL, &sim, &why), STATUS_OK);
    assert_int_equal(simulation_begin_stage(sim, 0, &why), STATUS_OK);
    assert_int_equal(observe_contact_sums(sim, &contacts, &why), STATUS_OK);
    assert_int_equal(observe_particle_sums(sim, &sums, &why), STATUS_OK);
    assert_true(2.0 * (double)contacts.pairs > 3.0 * (double)b->bed.count);
    assert_true(contacts.overlap_max < 0.05);
    assert_true(sums.kinetic < 1e-6 * 9.81 * sums.weight_radius);
    simulation_free(sim);
}

static void check_same(const bed *a, const bed *b)
{
    size_t bytes = sizeof *a->position * (size_t)a->count;
    assert_int_equal(a->count, b->count);
    assert_memory_equal(a->position, b->position, bytes);
    assert_memory_equal(a->velocity, b->velocity, bytes);
    assert_memory_equal(a->spin, b->spin, bytes);
    assert_memory_equal(a->radius, b->radius, sizeof *a->radius * (size_t)a->count);
}

/* Made, taken from the cache, and made again where the cached file is damaged: the same bed, bit for bit. */
static void test_cache(void **state)
{
    (void)state;
    device device;
    failure why;
    if (device_open(NULL, true, &device, &why) != STATUS_OK)
        skip();
    char folder[] = "/tmp/clast_test_XXXXXX", path[256];
    assert_non_null(mkdtemp(folder));
    setenv("XDG_CACHE_HOME", folder, 1);
    settled_bed first, again;
    assert_int_equal(settled_bed_make(300, 0, NULL, &device, NULL, &first, &why), STATUS_OK);
    check_rest(&first, &device);
    snprintf(path, sizeof path, "%s/clast/settled-bed-1-300-1x1.h5", folder);
    for (int damaged = 0; damaged < 2; damaged++) {
        assert_int_equal(damaged ? truncate(path, 1000) : access(path, R_OK), 0);
        assert_int_equal(settled_bed_make(300, BED_ROLLING, NULL, &device, NULL, &again, &why), STATUS_OK);
        check_same(&first.bed, &again.bed);
        settled_bed_free(&again);
    }
    settled_bed_free(&first);
    const bed_sizes two = {.ratio = 2.0, .large_share = 0.05};
    assert_int_equal(settled_bed_make(120, 0, &two, &device, NULL, &again, &why), STATUS_OK);
    int64_t large = 0;
    for (int64_t i = 0; i < again.bed.count; i++)
        large += again.bed.radius[i] > 1.5e-3;
    assert_int_equal(large, 6);
    settled_bed_free(&again);
    snprintf(path, sizeof path, "%s/clast/settled-bed-1-120-1x1-2-0.05.h5", folder);
    assert_int_equal(access(path, R_OK), 0);
    assert_int_equal(settled_bed_make(SETTLED_BED_LEAST - 1, 0, NULL, &device, NULL, &again, &why), STATUS_BAD_INPUT);
    device_close(&device);
    char command[300];
    snprintf(command, sizeof command, "rm -r %s", folder);
    assert_int_equal(system(command), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_layouts), cmocka_unit_test(test_images), cmocka_unit_test(test_cache)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
