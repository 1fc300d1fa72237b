/* Speed and memory of a settled bed: the output of `clast bench bed`. */
#ifndef CLAST_HOST_BENCH_H
#define CLAST_HOST_BENCH_H
#include "status.h"

#include <stdint.h>

typedef struct bench_options {
    int64_t particles;
    int64_t steps;           /* that are timed; 0: as many as suit the number of particles */
    unsigned effects;        /* BED_* (host/settled_bed.h), on top of contact and friction */
    bool mixed;              /* in mixed precision */
    const char *export_path; /* the bed as CSV, or NULL */
    const char *json_path;   /* the figures as JSON, or NULL */
    const char *device;      /* as device_choose */
    const char *kernels;     /* directory of kernels instead of the embedded ones, or NULL */
} bench_options;

bench_options bench_options_default(void);
/* Makes or takes from the cache a settled bed, times it, and writes the figures to standard output. */
status bench_bed(const bench_options *options, failure *why);

#endif
