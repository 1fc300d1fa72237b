#include "work_precision.h"

#include <math.h>
#include <stdlib.h>

/* Orders outside say that the runs do not converge yet, or that rounding is all that is left. */
#define ORDER_LOW  0.5
#define ORDER_HIGH 6.5

double wp_distance(const double *a, const double *b, int count)
{
    double sum = 0.0;
    for (int k = 0; k < count; k++) {
        double d = a[k] - (b ? b[k] : 0.0);
        sum += d * d;
    }
    return sqrt(sum);
}

wp_extrapolation wp_richardson(const double *coarse, const double *middle, const double *fine, int count, double *value)
{
    double first = wp_distance(coarse, middle, count), second = wp_distance(middle, fine, count);
    wp_extrapolation out = {.order = log2(first / second), .uncertainty = second};
    out.extrapolated = out.order > ORDER_LOW && out.order < ORDER_HIGH; /* false for a NAN */
    double share = out.extrapolated ? 1.0 / (exp2(out.order) - 1.0) : 0.0;
    for (int k = 0; k < count; k++)
        value[k] = fine[k] + share * (fine[k] - middle[k]);
    if (out.extrapolated)
        out.uncertainty = share * second;
    return out;
}

double wp_order(const double *step, const double *error, int count, double largest, double floor)
{
    double least = INFINITY, n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (int k = 0; k < count; k++)
        if (error[k] > 0.0)
            least = fmin(least, error[k]);
    for (int k = 0; k < count; k++) {
        if (!(error[k] < largest && error[k] > 1.5 * least && error[k] > floor && step[k] > 0.0))
            continue;
        double u = log(step[k]), v = log(error[k]);
        n += 1.0;
        x += u;
        y += v;
        xx += u * u;
        xy += u * v;
    }
    double spread = n * xx - x * x;
    return n < 3.0 || spread <= 0.0 ? NAN : (n * xy - x * y) / spread;
}

void wp_pareto(const double *time, const double *error, int count, bool *front)
{
    for (int k = 0; k < count; k++) {
        front[k] = !isnan(time[k]) && !isnan(error[k]);
        for (int j = 0; j < count && front[k]; j++) {
            bool no_worse = time[j] <= time[k] && error[j] <= error[k];
            bool better = time[j] < time[k] || error[j] < error[k];
            front[k] = !(no_worse && (better || j < k)); /* of equals the first */
        }
    }
}

int wp_cheapest(const double *time, const double *error, int count, double tolerance)
{
    int best = -1;
    for (int k = 0; k < count; k++)
        if (error[k] <= tolerance && !isnan(time[k]) && (best < 0 || time[k] < time[best]))
            best = k;
    return best;
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double wp_median(double *value, int count)
{
    if (count == 0)
        return NAN;
    qsort(value, (size_t)count, sizeof *value, compare);
    return count % 2 ? value[count / 2] : 0.5 * (value[count / 2 - 1] + value[count / 2]);
}

void wp_mean(const double *value, int count, double *mean, double *standard_error)
{
    double sum = 0.0, squares = 0.0;
    for (int k = 0; k < count; k++)
        sum += value[k];
    *mean = count > 0 ? sum / count : NAN;
    for (int k = 0; k < count; k++)
        squares += (value[k] - *mean) * (value[k] - *mean);
    *standard_error = count > 1 ? sqrt(squares / (count - 1) / count) : NAN;
}
