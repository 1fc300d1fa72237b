#include "radius.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define DRAWS 200000
#define PI    3.14159265358979323846

/* Sample mean and variance held against closed forms: within 5 standard errors, the fourth moment estimated from the sample. */
static void assert_moments(const radius_spec *spec, double mean, double variance, double low, double high)
{
    radius_sampler sampler;
    failure why = {0};
    double *r = malloc(DRAWS * sizeof *r), sum = 0.0, second = 0.0, fourth = 0.0;
    assert_int_equal(radius_sampler_init(spec, &sampler, &why), STATUS_OK);
    for (uint32_t i = 0; i < DRAWS; i++) {
        r[i] = radius_draw(&sampler, 1, 0, i);
        assert_true(r[i] >= low && r[i] <= high);
        sum += r[i];
    }
    for (int i = 0; i < DRAWS; i++) {
        double x = (r[i] - mean) * (r[i] - mean);
        second += x / DRAWS;
        fourth += x * x / DRAWS;
    }
    double error = 5.0 / sqrt(DRAWS);
    if (!(fabs(sum / DRAWS - mean) <= error * sqrt(variance) + 1.0e-10 * mean))
        fail_msg("mean %.9g, expected %.9g", sum / DRAWS, mean);
    if (!(fabs(second - variance) <= error * sqrt(fourth) + 1.0e-10 * variance))
        fail_msg("variance %.9g, expected %.9g", second, variance);
    radius_sampler_free(&sampler);
    free(r);
}

static void number(void **state)
{
    (void)state;
    assert_moments(&(radius_spec){.distribution = RADIUS_NUMBER, .value = 1.0e-3}, 1.0e-3, 0.0, 1.0e-3, 1.0e-3);
}

static void uniform(void **state)
{
    (void)state;
    double a = 1.0e-3, b = 3.0e-3;
    assert_moments(&(radius_spec){.distribution = RADIUS_UNIFORM, .low = a, .high = b}, 0.5 * (a + b), (b - a) * (b - a) / 12.0, a, b);
}

/* Variance of a standard normal cut off at +-k: 1 - 2 k phi(k)/(2 Phi(k) - 1). */
static double truncated_variance(double k)
{
    return 1.0 - 2.0 * k * exp(-0.5 * k * k) / sqrt(2.0 * PI) / erf(k / sqrt(2.0));
}

static void normal(void **state)
{
    (void)state;
    const double cuts[] = {0.01, 0.5, 0.99, 1.01, 2.0, 3.0};
    double mean = 1.0e-3, std = 1.0e-4;
    for (size_t n = 0; n < sizeof cuts / sizeof *cuts; n++) {
        double k = cuts[n];
        assert_moments(&(radius_spec){.distribution = RADIUS_NORMAL, .mean = mean, .std = std, .truncate_sigmas = k}, mean,
                       std * std * truncated_variance(k), mean - k * std * (1.0 + 1.0e-12), mean + k * std * (1.0 + 1.0e-12));
    }
    assert_moments(&(radius_spec){.distribution = RADIUS_NORMAL, .mean = mean, .std = std}, mean, std * std, 0.0, INFINITY);
    assert_moments(&(radius_spec){.distribution = RADIUS_NORMAL, .mean = mean, .std = 0.0}, mean, 0.0, mean, mean);
}

/* Not truncated: mean and std are those of the radius itself. Truncated at k: the moments of e^(mu + s z), |z| < k, are
 * e^(n mu + n^2 s^2/2) (Phi(k - n s) - Phi(-k - n s))/(2 Phi(k) - 1). */
static void lognormal(void **state)
{
    (void)state;
    double mean = 1.0e-3, std = 4.0e-4, k = 1.5;
    radius_spec spec = {.distribution = RADIUS_LOGNORMAL, .mean = mean, .std = std};
    assert_moments(&spec, mean, std * std, 0.0, INFINITY);
    double s2 = log(1.0 + std * std / mean / mean), s = sqrt(s2), mu = log(mean) - 0.5 * s2, moment[3];
    for (int n = 1; n <= 2; n++)
        moment[n] = exp(n * mu + 0.5 * n * n * s2) * 0.5 * (erf((k - n * s) / sqrt(2.0)) - erf((-k - n * s) / sqrt(2.0))) /
                    erf(k / sqrt(2.0));
    spec.truncate_sigmas = k;
    assert_moments(&spec, moment[1], moment[2] - moment[1] * moment[1], exp(mu - k * s) * (1.0 - 1.0e-12),
                   exp(mu + k * s) * (1.0 + 1.0e-12));
}

/* The mass passing a sieve is the sum of the fractions below it, and half of a class's mass lies below the middle of its sizes. The number of
 * grains in a class gives the error of its mass. */
static void sieve(void **state)
{
    (void)state;
    double size[] = {0.5e-3, 1.0e-3, 1.0e-3, 2.0e-3, 3.0e-3}, fraction[] = {0.2, 0.1, 0.4, 0.3};
    radius_spec spec = {.distribution = RADIUS_SIEVE, .count = 4, .size_m = size, .mass_fraction = fraction};
    radius_sampler sampler;
    failure why = {0};
    assert_int_equal(radius_sampler_init(&spec, &sampler, &why), STATUS_OK);
    double mass[4] = {0}, lower[4] = {0}, square[4] = {0}, all = 0.0;
    for (uint32_t i = 0; i < DRAWS; i++) {
        double r = radius_draw(&sampler, 1, 0, i), m = r * r * r;
        int k = r == size[1] ? 1 : r < size[1] ? 0 : r < size[3] ? 2 : 3;
        assert_true(r >= size[0] && r <= size[4]);
        mass[k] += m;
        square[k] += m * m;
        lower[k] += r < 0.5 * (size[k] + size[k + 1]) ? m : 0.0;
        all += m;
    }
    for (int k = 0; k < 4; k++) {
        double error = 5.0 * sqrt(square[k]) / all;
        if (!(fabs(mass[k] / all - fraction[k]) <= error))
            fail_msg("class %d holds %g of the mass, expected %g +- %g", k, mass[k] / all, fraction[k], error);
        if (k != 1)
            assert_true(fabs(lower[k] / all - 0.5 * fraction[k]) <= error);
    }
    radius_sampler_free(&sampler);
}

static void refused(const radius_spec *spec, const char *piece)
{
    radius_sampler sampler;
    failure why = {0};
    assert_int_equal(radius_sampler_init(spec, &sampler, &why), STATUS_BAD_INPUT);
    if (!strstr(why.text, piece))
        fail_msg("no `%s` in `%s`", piece, why.text);
}

static void bad_numbers(void **state)
{
    (void)state;
    double falling[] = {2.0e-3, 1.0e-3}, zero[] = {0.0, 1.0e-3}, good[] = {1.0e-3, 2.0e-3}, one[] = {1.0}, minus[] = {-1.0}, none[] = {0.0};
    refused(&(radius_spec){.distribution = RADIUS_NUMBER, .value = 0.0}, "radius_m is 0; it must be above 0");
    refused(&(radius_spec){.distribution = RADIUS_NUMBER, .value = NAN}, "nan");
    refused(&(radius_spec){.distribution = RADIUS_UNIFORM, .low = 2.0e-3, .high = 1.0e-3}, "low 0.002 to high 0.001");
    refused(&(radius_spec){.distribution = RADIUS_NORMAL, .mean = -1.0, .std = 0.1}, "mean -1");
    refused(&(radius_spec){.distribution = RADIUS_LOGNORMAL, .mean = 1.0, .std = -0.1}, "std -0.1");
    refused(&(radius_spec){.distribution = RADIUS_SIEVE}, "at least one class");
    refused(&(radius_spec){.distribution = RADIUS_SIEVE, .count = 1, .size_m = falling, .mass_fraction = one}, "from 0.002 to 0.001 m");
    refused(&(radius_spec){.distribution = RADIUS_SIEVE, .count = 1, .size_m = zero, .mass_fraction = one}, "from 0 to 0.001 m");
    refused(&(radius_spec){.distribution = RADIUS_SIEVE, .count = 1, .size_m = good, .mass_fraction = minus},
            "fraction 0 of the sieve curve is -1");
    refused(&(radius_spec){.distribution = RADIUS_SIEVE, .count = 1, .size_m = good, .mass_fraction = none}, "all 0");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(number),    cmocka_unit_test(uniform), cmocka_unit_test(normal),
                                       cmocka_unit_test(lognormal), cmocka_unit_test(sieve),   cmocka_unit_test(bad_numbers)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
