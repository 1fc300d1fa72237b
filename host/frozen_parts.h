/* What the methods for stages in which nothing moves share (frozen.c, frozen_solve.c). */
#ifndef CLAST_HOST_FROZEN_PARTS_H
#define CLAST_HOST_FROZEN_PARTS_H
#include "frozen.h"

/* What a step has come to. */
typedef struct frozen_findings {
    double error, rate, hottest, coldest;
} frozen_findings;

const scene_stage *frozen_stage(const simulation *sim);
/* Looks the contact network up, where it is not known. */
status frozen_link(simulation *sim, failure *why);
/* Conductances, or surfaces, depend on the temperatures: by tables of conductivity, or by the grains' growth. */
bool frozen_follows(const simulation *sim);
/* Where they do: looks the network up as it is at a share of the rises (temperatures stay; radii and conductivities are left so), and the limit. */
status frozen_look_up(simulation *sim, cl_mem rises, double share, failure *why);
/* The network of the temperatures as they are, after a step that is not taken. */
status frozen_take_back(simulation *sim, failure *why);
/* Between steps: grains that have grown may touch others than the table knows. */
status frozen_follow_growth(simulation *sim, failure *why);
/* With the radii as they stand, two grains may not meet that the table does not know. */
status frozen_fits_table(simulation *sim, bool *fits, failure *why);
/* Keeps the rates that the first stage of a step has found, while the step is taken again with other conductances; and where they stand. */
status frozen_keep_start(simulation *sim, failure *why);
cl_mem frozen_rates_at_start(const simulation *sim);
/* Radii and conductivities of the temperatures at a share of the rises; the temperatures stay. */
status frozen_probe(simulation *sim, cl_mem rises, double share, failure *why);
status frozen_find_limit(simulation *sim, failure *why);
/* Something other than differences of temperature brings heat. */
bool frozen_is_heated(const simulation *sim);
/* Error that a step may make, K. */
double frozen_allowed_error(const simulation *sim);
/* Inside the interval of temperatures, but for rounding; always where the bed is heated. */
bool frozen_is_inside(const simulation *sim, const frozen_findings *found);
/* The step ahead, so that it ends at what is left or leaves room for another like it. */
double frozen_fit_step(double step, double left);
/* The share of a stage, or of Euler's limit, below which a step has dwindled to nothing. Where the edge of a moving beam takes in a grain at once, the
 * error is what that grain is heated by in the step, and falls no faster than it. */
#define FROZEN_DWINDLED 1e-10
status frozen_give_up(const simulation *sim, double step, const frozen_findings *found, failure *why);
/* The first six arguments of kernels that look at flows. */
status frozen_set_network(simulation *sim, cl_kernel kernel, const char *name, const clast_launch *launch, cl_mem rises, failure *why);
/* Binds the fields of grains behind `bound` arguments, and runs over all grains. */
status frozen_run_grains(simulation *sim, const char *name, int bound, failure *why);
/* The rows that a step's stages stand in, at so many places of it. */
status frozen_write_rows(simulation *sim, const double *place, int rows, double step, failure *why);
/* Largest |error| and |rate|, and the ends of the temperatures that the rises lead to. */
status frozen_fold(simulation *sim, cl_mem rises, cl_mem error, cl_mem rates, frozen_findings *out, failure *why);
/* Takes the rises; `row` of the tables holds at their end. `all`: what they brought is no flow, and counts as given by a source. */
status frozen_accept(simulation *sim, cl_mem rises, int row, bool all, failure *why);
/* Time has gone on by one step. */
void frozen_count_step(simulation *sim, double step, double until, const frozen_findings *found);

/* frozen_solve.c */
status frozen_steady_step(simulation *sim, double until, failure *why);
status frozen_implicit_step(simulation *sim, double until, failure *why);
void frozen_solve_free(simulation *sim);

#endif
