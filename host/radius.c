#include "radius.h"

#include "random.h"

#include <math.h>
#include <stdlib.h>

/* Within a class the mass is spread evenly over the radius, so that the passing curve is the straight line between the sieves that the
 * scene's author drew. By number the density then falls like r^-3 between a and b, whose mean of r^3 is 2 a^2 b^2/(a + b); a class of
 * mass fraction f holds a number of grains in proportion to f over that mean. */
static double class_mean_cube(double a, double b)
{
    return 2.0 * a * a * b * b / (a + b);
}

static double class_radius(double a, double b, double u)
{
    double q = a / b;
    return fmin(b, a / sqrt(1.0 - u * (1.0 - q * q)));
}

static status sieve_init(const radius_spec *spec, radius_sampler *out, failure *why)
{
    if (spec->count < 1)
        return fail(why, STATUS_BAD_INPUT, "radius_m: a sieve curve needs at least one class (two sizes and a mass fraction)");
    for (int k = 0; k < spec->count; k++) {
        double a = spec->size_m[k], b = spec->size_m[k + 1], fraction = spec->mass_fraction[k];
        if (!(a > 0.0 && b >= a && isfinite(b)))
            return fail(why, STATUS_BAD_INPUT, "radius_m: sieve sizes must be above 0 and rise; class %d goes from %g to %g m", k, a, b);
        if (!(fraction >= 0.0 && isfinite(fraction)))
            return fail(why, STATUS_BAD_INPUT, "radius_m: mass fraction %d of the sieve curve is %g; it must be 0 or more", k, fraction);
    }
    out->cumulative = malloc((size_t)spec->count * sizeof *out->cumulative);
    if (!out->cumulative)
        return fail(why, STATUS_ERROR, "out of memory for a sieve curve of %d classes", spec->count);
    /* Sizes relative to the first keep the cubes in range. */
    double unit = spec->size_m[0], sum = 0.0;
    for (int k = 0; k < spec->count; k++) {
        sum += spec->mass_fraction[k] / class_mean_cube(spec->size_m[k] / unit, spec->size_m[k + 1] / unit);
        out->cumulative[k] = sum;
    }
    if (!(sum > 0.0)) {
        radius_sampler_free(out);
        return fail(why, STATUS_BAD_INPUT, "radius_m: the mass fractions of the sieve curve are all 0");
    }
    for (int k = 0; k < spec->count; k++)
        out->cumulative[k] /= sum;
    return STATUS_OK;
}

static status normal_init(const radius_spec *spec, radius_sampler *out, failure *why)
{
    if (!(spec->mean > 0.0 && isfinite(spec->mean) && spec->std >= 0.0 && isfinite(spec->std)))
        return fail(why, STATUS_BAD_INPUT, "radius_m: mean %g and std %g m; the mean must be above 0 and the std 0 or more", spec->mean,
                    spec->std);
    double ratio = spec->std / spec->mean;
    double variance = portable_log(1.0 + ratio * ratio);
    out->log_std = sqrt(variance);
    out->log_mean = portable_log(spec->mean) - 0.5 * variance;
    return STATUS_OK;
}

status radius_sampler_init(const radius_spec *spec, radius_sampler *out, failure *why)
{
    *out = (radius_sampler){.spec = spec};
    switch (spec->distribution) {
    case RADIUS_NUMBER:
        if (!(spec->value > 0.0 && isfinite(spec->value)))
            return fail(why, STATUS_BAD_INPUT, "radius_m is %g; it must be above 0", spec->value);
        return STATUS_OK;
    case RADIUS_UNIFORM:
        if (!(spec->low > 0.0 && spec->high >= spec->low && isfinite(spec->high)))
            return fail(why, STATUS_BAD_INPUT, "radius_m: uniform from low %g to high %g m; low must be above 0 and not above high",
                        spec->low, spec->high);
        return STATUS_OK;
    case RADIUS_NORMAL:
    case RADIUS_LOGNORMAL:
        return normal_init(spec, out, why);
    case RADIUS_SIEVE:
        return sieve_init(spec, out, why);
    }
    return fail(why, STATUS_ERROR, "radius_m: unknown distribution %d", (int)spec->distribution);
}

void radius_sampler_free(radius_sampler *sampler)
{
    free(sampler->cumulative);
    sampler->cumulative = NULL;
}

/* Normal truncated at +-limit (0: not truncated). Below one sigma a uniform proposal is accepted more often than a normal one. */
static double truncated_normal(random_stream *stream, double limit)
{
    if (!(limit > 0.0))
        return random_normal(stream);
    if (limit < 1.0)
        for (;;) {
            double z = limit * (2.0 * random_uniform(stream) - 1.0);
            if (random_uniform(stream) < portable_exp(-0.5 * z * z))
                return z;
        }
    for (;;) {
        double z = random_normal(stream);
        if (fabs(z) <= limit)
            return z;
    }
}

double radius_draw(const radius_sampler *sampler, uint64_t seed, uint32_t group, uint32_t index)
{
    const radius_spec *spec = sampler->spec;
    if (spec->distribution == RADIUS_NUMBER)
        return spec->value;
    random_stream stream = random_start(seed, group, RANDOM_RADIUS, index);
    if (spec->distribution == RADIUS_UNIFORM)
        return spec->low + (spec->high - spec->low) * random_uniform(&stream);
    if (spec->distribution == RADIUS_NORMAL)
        for (;;) { /* ends: at least half of all draws are above 0 */
            double radius = spec->mean + spec->std * truncated_normal(&stream, spec->truncate_sigmas);
            if (radius > 0.0)
                return radius;
        }
    if (spec->distribution == RADIUS_LOGNORMAL)
        return portable_exp(sampler->log_mean + sampler->log_std * truncated_normal(&stream, spec->truncate_sigmas));
    double u = random_uniform(&stream);
    int k = 0;
    while (k < spec->count - 1 && u > sampler->cumulative[k])
        k++;
    return class_radius(spec->size_m[k], spec->size_m[k + 1], random_uniform(&stream));
}
