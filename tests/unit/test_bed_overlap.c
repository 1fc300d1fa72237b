/* The largest overlap against every pair. */
#include "unit/bed_case.h"

#include "random.h"

#include <time.h>

static bed bed_of(int64_t count)
{
    bed b = {.count = count};
    b.position = calloc((size_t)count, sizeof *b.position);
    b.radius = calloc((size_t)count, sizeof *b.radius);
    return b;
}

/* Points in a box of the given size, radii from `small` to `large` with as many in each octave. */
static bed scattered(int64_t count, const double size[3], double small, double large, uint64_t seed)
{
    bed b = bed_of(count);
    random_stream stream = random_start(seed, 0, RANDOM_POSITION, 0);
    for (int64_t i = 0; i < count; i++) {
        for (int d = 0; d < 3; d++)
            b.position[i][d] = size[d] * random_uniform(&stream);
        b.radius[i] = small * exp(log(large / small) * random_uniform(&stream));
    }
    return b;
}

static void agrees_with_every_pair(void **state)
{
    (void)state;
    struct {
        double size[3], small, large;
        bool periodic[3];
    } cases[] = {{{1, 1, 1}, 0.01, 0.01, {false, false, false}},     {{1, 1, 1}, 1.0e-4, 0.01, {true, true, true}},
                 {{1, 1, 1}, 1.0e-3, 0.1, {true, false, false}},     {{1, 1, 0}, 1.0e-3, 5.0e-3, {true, false, false}},
                 {{1, 0, 0}, 1.0e-5, 1.0e-3, {false, false, false}}, {{0.1, 1, 1}, 0.01, 0.02, {true, true, false}},
                 {{1.0e6, 1, 1}, 1.0e-3, 0.2, {false, true, false}}, {{0.05, 0.05, 10}, 0.01, 0.02, {true, true, false}}};
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++)
        for (uint64_t seed = 0; seed < 20; seed++) {
            /* Few spheres make the deepest pair a lonely one, which a missed cell would lose. */
            bed b = scattered(seed < 10 ? 20 : 400, cases[n].size, cases[n].small, cases[n].large, seed);
            domain box = {.given = true};
            for (int d = 0; d < 3; d++) {
                box.high_m[d] = cases[n].size[d];
                box.periodic[d] = cases[n].periodic[d];
            }
            int64_t i = -2, j = -2;
            double overlap = bed_largest_overlap(&b, &box, &i, &j), expected = brute_force_overlap(&b, &box);
            assert_true(fabs(overlap - expected) <= 1.0e-12 * (1.0 + expected));
            if (expected == 0.0)
                assert_true(i == -1 && j == -1);
            else
                assert_true(i >= 0 && j > i && j < b.count);
            bed_free(&b);
        }
}

static void two_spheres(void **state)
{
    (void)state;
    bed b = bed_of(2);
    domain box = {.given = true, .low_m = {-1, -1, -1}, .high_m = {1, 1, 1}};
    int64_t i, j;
    b.radius[0] = 0.1;
    b.radius[1] = 0.2;
    b.position[1][0] = 0.25;
    assert_true(fabs(bed_largest_overlap(&b, &box, &i, &j) - 0.05 / 0.1) < 1.0e-12);
    assert_true(i == 0 && j == 1);
    b.position[0][0] = -0.95;
    b.position[1][0] = 0.95;
    assert_true(bed_largest_overlap(&b, &box, &i, &j) == 0.0);
    box.periodic[0] = true;
    assert_true(fabs(bed_largest_overlap(&b, &box, &i, &j) - 0.2 / 0.1) < 1.0e-12);
    b.position[1][0] = 0.0;
    b.radius[1] = 1.05; /* wider than the period: its own image */
    b.radius[0] = 0.01;
    b.position[0][1] = 5.0;
    assert_true(fabs(bed_largest_overlap(&b, &box, &i, &j) - 0.1 / 1.05) < 1.0e-12);
    assert_true(i == 1 && j == 1);
    bed_free(&b);
    b = bed_of(1);
    b.radius[0] = 1.0;
    box.given = false;
    assert_true(bed_largest_overlap(&b, &box, &i, &j) == 0.0);
    bed_free(&b);
}

/* Sizes of 1 to 50 in equal volumes, a million of them, and one grain far out: seconds, not hours. */
static void a_million(void **state)
{
    (void)state;
    const int64_t count = 1000000;
    bed b = scattered(count, (double[]){1, 1, 1}, 1.0e-3, 1.0e-3, 1);
    random_stream stream = random_start(2, 0, RANDOM_POSITION, 0);
    for (int64_t i = 0; i < count; i++) { /* numbers fall like r^-3 */
        double u = random_uniform(&stream);
        b.radius[i] = 2.0e-3 / sqrt(1.0 - u * (1.0 - 1.0 / 2500.0)) * 0.5;
    }
    b.position[0][0] = 1.0e9;
    struct timespec start, end;
    int64_t i, j;
    clock_gettime(CLOCK_MONOTONIC, &start);
    double overlap = bed_largest_overlap(&b, &(domain){0}, &i, &j);
    clock_gettime(CLOCK_MONOTONIC, &end);
    print_message("1,000,000 spheres: %.2f s\n", (double)(end.tv_sec - start.tv_sec) + 1.0e-9 * (double)(end.tv_nsec - start.tv_nsec));
    assert_true(overlap > 0.0 && i >= 0 && j > i);
    bed_free(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(agrees_with_every_pair), cmocka_unit_test(two_spheres),
                                       cmocka_unit_test(a_million)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
