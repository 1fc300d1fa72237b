#include "random.h"

#include <Random123/philox.h>
#include <math.h>

static const double two_pi = 6.283185307179586;

random_stream random_start(uint64_t seed, uint32_t group, random_purpose purpose, uint32_t index)
{
    return (random_stream){.seed = seed, .group = group, .purpose = (uint32_t)purpose, .index = index};
}

/* The middle of one of 2^52 equal parts: from 2^-53 to 1 - 2^-53, so that neither 0 nor 1 comes out. */
static double unit_interval(uint32_t high, uint32_t low)
{
    uint64_t bits = ((uint64_t)high << 32 | low) >> 12;
    return ((double)bits + 0.5) * 0x1p-52;
}

double random_uniform(random_stream *stream)
{
    if (stream->uniforms_left == 0) {
        philox4x32_ctr_t counter = {{stream->index, stream->draw++, stream->group, stream->purpose}};
        philox4x32_key_t key = {{(uint32_t)stream->seed, (uint32_t)(stream->seed >> 32)}};
        philox4x32_ctr_t word = philox4x32(counter, key);
        stream->uniform[1] = unit_interval(word.v[0], word.v[1]);
        stream->uniform[0] = unit_interval(word.v[2], word.v[3]);
        stream->uniforms_left = 2;
    }
    return stream->uniform[--stream->uniforms_left];
}

double random_normal(random_stream *stream)
{
    if (stream->normal_left) {
        stream->normal_left = false;
        return stream->normal;
    }
    double distance = sqrt(-2.0 * portable_log(random_uniform(stream)));
    double cosine, sine;
    portable_turn(random_uniform(stream), &cosine, &sine);
    stream->normal = distance * sine;
    stream->normal_left = true;
    return distance * cosine;
}

/* x = m 2^e with m in [sqrt(1/2), sqrt(2)); ln m = 2 artanh t, t = (m - 1)/(m + 1), |t| < 0.172: 12 terms reach 1e-19. */
double portable_log(double x)
{
    int exponent;
    double m = frexp(x, &exponent);
    if (m < 0.70710678118654752) {
        m *= 2.0;
        exponent--;
    }
    double t = (m - 1.0) / (m + 1.0), t2 = t * t, sum = 0.0;
    for (int k = 12; k >= 0; k--)
        sum = sum * t2 + 1.0 / (2 * k + 1);
    return exponent * 0.69314718055994531 + 2.0 * t * sum;
}

/* x = k ln 2 + r with |r| < 0.347; ln 2 in two parts so that k times the first is exact; Taylor's series of exp r. */
double portable_exp(double x)
{
    if (x > 710.0)
        return INFINITY;
    if (x < -746.0)
        return 0.0;
    const double ln2_high = 0x1.62e42fefa38p-1, ln2_low = 0x1.ef35793c7673p-45;
    double k = floor(x / 0.69314718055994531 + 0.5);
    double r = x - k * ln2_high - k * ln2_low, sum = 1.0;
    for (int n = 16; n >= 1; n--)
        sum = 1.0 + sum * r / n;
    return ldexp(sum, (int)k);
}

void portable_turn(double x, double *cosine, double *sine)
{
    double quarter = floor(4.0 * x + 0.5);
    double angle = two_pi * (x - 0.25 * quarter), angle2 = angle * angle; /* |angle| <= pi/4 */
    double c = 1.0, s = 1.0;
    for (int n = 18; n >= 2; n -= 2) {
        c = 1.0 - c * angle2 / ((n - 1) * n);
        s = 1.0 - s * angle2 / (n * (n + 1));
    }
    s *= angle;
    int64_t turn = (int64_t)quarter & 3;
    *cosine = turn == 0 ? c : turn == 1 ? -s : turn == 2 ? -c : s;
    *sine = turn == 0 ? s : turn == 1 ? c : turn == 2 ? -s : -c;
}
