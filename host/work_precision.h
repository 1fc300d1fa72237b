/* Arithmetic of work-precision studies: extrapolation, orders of convergence, what is worth its time. Knows nothing of scenes. */
#ifndef CLAST_HOST_WORK_PRECISION_H
#define CLAST_HOST_WORK_PRECISION_H
#include <stdbool.h>

/* Root of the sum of squares of a - b; b NULL: of a. */
double wp_distance(const double *a, const double *b, int count);

typedef struct wp_extrapolation {
    double order;       /* observed from the three; NAN where there is none */
    bool extrapolated;  /* else `value` is the finest, because no order can be seen */
    double uncertainty; /* of `value`, as wp_distance: what the last halving still changed */
} wp_extrapolation;

/* Richardson's extrapolation from a step, its half and its quarter. */
wp_extrapolation wp_richardson(const double *coarse, const double *middle, const double *fine, int count, double *value);

/* Slope of log error over log step, by least squares over the points of a curve that show it: errors below `largest`, above one and a half times the
 * curve's least one, and above the floor. NAN with fewer than three such points. */
double wp_order(const double *step, const double *error, int count, double largest, double floor);

/* Marks points that no other one beats in both time and error; points with a NAN are never marked. */
void wp_pareto(const double *time, const double *error, int count, bool *front);

/* Index of the quickest point with an error of at most `tolerance`, or -1. */
int wp_cheapest(const double *time, const double *error, int count, double tolerance);

/* Sorts; NAN for none. */
double wp_median(double *value, int count);

/* Mean of differences over runs and its standard error. */
void wp_mean(const double *value, int count, double *mean, double *standard_error);

#endif
