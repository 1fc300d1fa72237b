/* Bytes that a kernel moves, counted from its arguments: benchmarks hold them against the time that it takes. */
#ifndef CLAST_HOST_TRAFFIC_H
#define CLAST_HOST_TRAFFIC_H
#include "simulation.h"

/* Bytes of one launch over `items` work-items. Every array counts once, however often a kernel comes back to it: as long as it is (pair stage
 * and particle stage: the share of it that the launch is of the whole stage), and twice where it is read and written. So this is the least
 * that must move, and what a cache that holds nothing adds to it is not in it; but where pairs read packets, the fields of grains that stand in them
 * count beside, of which only walls' records read some. */
status traffic_of_launch(simulation *sim, cl_kernel kernel, const char *name, size_t items, double *bytes, failure *why);

/* Bytes of a whole step, and how many arguments its two kernels have. */
typedef struct step_traffic {
    double pair_bytes, particle_bytes;
    int pair_arguments, particle_arguments;
} step_traffic;
status traffic_of_step(simulation *sim, step_traffic *out, failure *why);

/* What the fields take: of a grain, and of a record of the contact table. */
typedef struct field_sizes {
    double grain, record;
} field_sizes;
field_sizes traffic_field_sizes(const simulation *sim);

/* Bytes a second, read and written together, that the device reaches in copying, where so many bytes move in all: median of some copies. */
status traffic_copy_speed(device *device, double bytes, double *bytes_per_s, failure *why);

#endif
