/* Extrapolation, orders and fronts on numbers that are known. */
#include "work_precision.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h> /* after all that it uses */

#define POINTS 10

static void assert_near(double value, double expected, double allowed)
{
    if (!(fabs(value - expected) <= allowed))
        fail_msg("%.17g instead of %.17g", value, expected);
}

/* a(h) = a + b h^p: three runs give a and p whatever b is. */
static void richardson_finds_limit_and_order(void **state)
{
    (void)state;
    for (double p = 1.0; p < 3.2; p += 0.5) {
        double run[3][3], value[3];
        for (int level = 0; level < 3; level++)
            for (int k = 0; k < 3; k++)
                run[level][k] = 2.0 + k + (0.1 * k - 0.3) * pow(0.01 * pow(0.5, level), p);
        wp_extrapolation found = wp_richardson(run[0], run[1], run[2], 3, value);
        assert_true(found.extrapolated);
        assert_near(found.order, p, 1e-4);
        for (int k = 0; k < 3; k++)
            assert_near(value[k], 2.0 + k, 1e-11);
        /* what it is uncertain by covers what the finest run is off */
        assert_near(found.uncertainty, wp_distance(run[2], value, 3), 1e-6 * found.uncertainty /* the rest is rounding */);
    }
}

/* Runs that do not converge are not extrapolated. */
static void richardson_keeps_the_finest_without_an_order(void **state)
{
    (void)state;
    const double a[] = {1.0}, b[] = {1.1}, c[] = {0.95}, same[] = {1.0};
    double value;
    wp_extrapolation found = wp_richardson(a, b, c, 1, &value);
    assert_false(found.extrapolated);
    assert_near(value, 0.95, 0.0);
    assert_near(found.uncertainty, 0.15, 1e-15);
    found = wp_richardson(a, same, same, 1, &value);
    assert_near(value, 1.0, 0.0);
    assert_near(found.uncertainty, 0.0, 0.0);
}

static void order_is_the_slope(void **state)
{
    (void)state;
    double step[POINTS], error[POINTS];
    for (int k = 0; k < POINTS; k++) {
        step[k] = 1e-3 * pow(0.5, k);
        error[k] = 7.0 * pow(step[k] / 1e-3, 1.5) / 100.0;
    }
    assert_near(wp_order(step, error, POINTS, 0.1, 0.0), 1.5, 1e-12);
    /* a curve that ends on a plateau: the plateau says nothing about the order */
    for (int k = 0; k < POINTS; k++)
        error[k] = fmax(error[k], 2e-4);
    assert_near(wp_order(step, error, POINTS, 0.1, 0.0), 1.5, 1e-12);
    /* what is below the floor, or too coarse, counts as little */
    error[0] = 3.0;
    error[9] = 1e-9;
    assert_near(wp_order(step, error, POINTS, 0.1, 3e-4), 1.5, 1e-12);
    assert_true(isnan(wp_order(step, error, 2, 0.1, 0.0)));
}

static void front_is_what_nothing_beats(void **state)
{
    (void)state;
    /*                    beaten by   front  beaten   front  not a point  equal to the front's first */
    const double time[] = {2.0, 1.0, 3.0, 4.0, 0.1, 1.0};
    const double error[] = {0.5, 0.4, 0.2, 0.1, NAN, 0.4};
    const bool expected[] = {false, true, true, true, false, false};
    bool front[6];
    wp_pareto(time, error, 6, front);
    for (int k = 0; k < 6; k++)
        assert_int_equal(front[k], expected[k]);
    assert_int_equal(wp_cheapest(time, error, 6, 0.3), 2);
    assert_int_equal(wp_cheapest(time, error, 6, 0.1), 3);
    assert_int_equal(wp_cheapest(time, error, 6, 1.0), 1);
    assert_int_equal(wp_cheapest(time, error, 6, 0.01), -1);
}

static void median_and_mean(void **state)
{
    (void)state;
    double odd[] = {5.0, 1.0, 3.0}, even[] = {4.0, 1.0, 2.0, 100.0}, mean, standard_error;
    assert_near(wp_median(odd, 3), 3.0, 0.0);
    assert_near(wp_median(even, 4), 3.0, 0.0);
    assert_true(isnan(wp_median(odd, 0)));
    const double value[] = {1.0, 2.0, 3.0, 4.0};
    wp_mean(value, 4, &mean, &standard_error);
    assert_near(mean, 2.5, 1e-15);
    assert_near(standard_error, sqrt(5.0 / 3.0 / 4.0), 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(richardson_finds_limit_and_order),
        cmocka_unit_test(richardson_keeps_the_finest_without_an_order),
        cmocka_unit_test(order_is_the_slope),
        cmocka_unit_test(front_is_what_nothing_beats),
        cmocka_unit_test(median_and_mean),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
