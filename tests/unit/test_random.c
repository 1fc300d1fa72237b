#include "random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

/* Random123's known answer of philox4x32-10 for counter 0 and key 0. */
static void known_answer(void **state)
{
    (void)state;
    random_stream stream = random_start(0, 0, (random_purpose)0, 0);
    assert_true(random_uniform(&stream) == ((double)(0x6627e8d5e169c58du >> 12) + 0.5) * 0x1p-52);
    assert_true(random_uniform(&stream) == ((double)(0xbc57ac4c9b00dbd8u >> 12) + 0.5) * 0x1p-52);
}

static void streams_differ_by_every_part_of_the_key(void **state)
{
    (void)state;
    random_stream stream[] = {random_start(7, 1, RANDOM_RADIUS, 5),
                              random_start(8, 1, RANDOM_RADIUS, 5),
                              random_start(7 + (UINT64_C(1) << 32), 1, RANDOM_RADIUS, 5),
                              random_start(7, 2, RANDOM_RADIUS, 5),
                              random_start(7, 1, RANDOM_POSITION, 5),
                              random_start(7, 1, RANDOM_RADIUS, 6)};
    double value[6];
    for (int i = 0; i < 6; i++) {
        value[i] = random_uniform(&stream[i]);
        for (int j = 0; j < i; j++)
            assert_true(value[i] != value[j]);
    }
    random_stream again = random_start(7, 1, RANDOM_RADIUS, 5);
    assert_true(random_uniform(&again) == value[0]);
}

/* Mean within 5 standard errors of its value, the standard deviation of one draw being `std`. */
static void assert_mean(double sum, int64_t n, double expected, double std)
{
    double mean = sum / (double)n;
    if (!(fabs(mean - expected) <= 5.0 * std / sqrt((double)n)))
        fail_msg("mean %.9g, expected %.9g +- %.2g", mean, expected, 5.0 * std / sqrt((double)n));
}

static void moments(void **state)
{
    (void)state;
    const int64_t n = 400000;
    random_stream stream = random_start(3, 0, RANDOM_POSITION, 0);
    double u1 = 0.0, u2 = 0.0, z1 = 0.0, z2 = 0.0, z4 = 0.0, product = 0.0, last = 0.0;
    for (int64_t i = 0; i < n; i++) {
        double u = random_uniform(&stream), z = random_normal(&stream);
        assert_true(u > 0.0 && u < 1.0);
        u1 += u;
        u2 += u * u;
        z1 += z;
        z2 += z * z;
        z4 += z * z * z * z;
        product += z * last;
        last = z;
    }
    assert_mean(u1, n, 0.5, sqrt(1.0 / 12.0));
    assert_mean(u2, n, 1.0 / 3.0, sqrt(1.0 / 5.0 - 1.0 / 9.0));
    assert_mean(z1, n, 0.0, 1.0);
    assert_mean(z2, n, 1.0, sqrt(3.0 - 1.0));
    assert_mean(z4, n, 3.0, sqrt(105.0 - 9.0));
    assert_mean(product, n, 0.0, 1.0);
}

static void portable_functions_agree_with_libm(void **state)
{
    (void)state;
    const double few = 4.0 * 2.220446049250313e-16;
    random_stream stream = random_start(11, 0, RANDOM_POSITION, 0);
    for (int i = 0; i < 100000; i++) {
        double x = exp(60.0 * (random_uniform(&stream) - 0.5)), y = 600.0 * (random_uniform(&stream) - 0.5);
        double t = 4.0 * (random_uniform(&stream) - 0.5), c, s;
        assert_true(fabs(portable_log(x) - log(x)) <= few * (1.0 + fabs(log(x))));
        assert_true(fabs(portable_exp(y) - exp(y)) <= few * exp(y));
        portable_turn(t, &c, &s);
        assert_true(fabs(c - cos(6.283185307179586 * t)) <= 4.0 * few);
        assert_true(fabs(s - sin(6.283185307179586 * t)) <= 4.0 * few);
    }
    assert_true(portable_log(1.0) == 0.0 && portable_exp(0.0) == 1.0);
    assert_true(portable_exp(1000.0) == INFINITY && portable_exp(-1000.0) == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(known_answer), cmocka_unit_test(streams_differ_by_every_part_of_the_key),
                                       cmocka_unit_test(moments), cmocka_unit_test(portable_functions_agree_with_libm)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
