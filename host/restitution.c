#include "restitution.h"

#include <math.h>

/* y'' = -[4/3 y^1.5 + 2 xi sqrt(2) y^0.25 y']_+, y(0) = 0, y'(0) = 1: TM Eq. 2 and 6 with E* = m* = r* = 1. The contact ends where the
 * bracket reaches zero on the way out. In tau with t = tau^4 the powers of y are smooth at the start, so that RK4 keeps its order. */
double hertz_restitution(double xi)
{
    const double damping = 2.0 * xi * sqrt(2.0), h = 1e-4;
    double y = 0.0, v = 1.0, tau = 0.0, before = v;
    for (;;) {
        double ky[4], kv[4];
        const double shift[4] = {0.0, 0.5, 0.5, 1.0};
        for (int s = 0; s < 4; s++) {
            double ys = y + (s ? shift[s] * h * ky[s - 1] : 0.0), vs = v + (s ? shift[s] * h * kv[s - 1] : 0.0);
            double t = tau + shift[s] * h, rate = 4.0 * t * t * t;
            double root = sqrt(ys > 0.0 ? ys : 0.0);
            ky[s] = rate * vs;
            kv[s] = -rate * (4.0 / 3.0 * root * root * root + damping * sqrt(root) * vs);
        }
        double force = 4.0 / 3.0 * pow(y > 0.0 ? y : 0.0, 1.5) + damping * pow(y > 0.0 ? y : 0.0, 0.25) * v;
        if (tau > 0.1 && force <= 0.0)
            return -0.5 * (v + before); /* the force vanishes there, so the velocity is stationary: the mean loses nothing */
        before = v;
        y += h / 6.0 * (ky[0] + 2.0 * ky[1] + 2.0 * ky[2] + ky[3]);
        v += h / 6.0 * (kv[0] + 2.0 * kv[1] + 2.0 * kv[2] + kv[3]);
        tau += h;
    }
}

double linear_restitution(double xi)
{
    if (xi < 1.0) {
        double root = sqrt(1.0 - xi * xi);
        return exp(-xi / root * atan2(2.0 * xi * root, 2.0 * xi * xi - 1.0));
    }
    if (xi == 1.0)
        return exp(-2.0);
    double root = sqrt(xi * xi - 1.0);
    return exp(-xi / root * log((xi + root) / (xi - root)));
}

static double invert(double (*restitution)(double), double wanted)
{
    if (wanted >= 1.0)
        return 0.0;
    double low = 0.0, high = 1.0;
    while (restitution(high) > wanted && high < 64.0)
        high *= 2.0;
    for (int k = 0; k < 60 && high - low > 1e-13 * high; k++) {
        double middle = 0.5 * (low + high);
        if (restitution(middle) > wanted)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

/* A search integrates fifty collisions; a scene asks for the same few values once for each pair of bodies and each look at its constants, so
 * the last ones are kept. */
#define KEPT 16

double hertz_damping_ratio(double restitution)
{
    static _Thread_local struct {
        double restitution, ratio;
    } kept[KEPT];
    static _Thread_local int count;
    for (int k = 0; k < KEPT && k < count; k++)
        if (kept[k].restitution == restitution)
            return kept[k].ratio;
    double ratio = invert(hertz_restitution, restitution);
    int place = count++ % KEPT;
    kept[place].restitution = restitution;
    kept[place].ratio = ratio;
    count = count == 2 * KEPT ? KEPT : count;
    return ratio;
}

double linear_damping_ratio(double restitution)
{
    return invert(linear_restitution, restitution);
}
