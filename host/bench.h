/* Speed and memory of a settled bed: the output of `clast bench bed`. */
#ifndef CLAST_HOST_BENCH_H
#define CLAST_HOST_BENCH_H
#include "scene.h"
#include "settled_bed.h"
#include "status.h"

#include <stddef.h>
#include <stdint.h>

typedef struct bench_options {
    int64_t particles;
    int64_t steps;           /* that are timed; 0: as many as suit the number of particles */
    unsigned effects;        /* BED_* (host/settled_bed.h), on top of contact and friction */
    bed_sizes sizes;         /* of the grains of `bed` and `kernels` */
    bool mixed;              /* in mixed precision */
    step_form form;          /* of the steps of `bed` */
    const char *export_path; /* the bed as CSV, or NULL */
    const char *json_path;   /* the figures as JSON, or NULL */
    const char *csv_path;    /* the same as CSV, or NULL; not of a bed */
    double seconds;          /* that `effects` may take about */
    const char *only;        /* of the cases of `effects` those whose name has one of these words, by commas; NULL: all */
    bool forget;             /* `tune`: drops what was kept, and measures nothing */
    const char *scenes;      /* folder that `effects` writes the scenes of its cases to, and measures nothing; or NULL */
    const char *device;      /* as device_choose */
    const char *kernels;     /* directory of kernels instead of the embedded ones, or NULL */
} bench_options;

bench_options bench_options_default(void);
/* Makes or takes from the cache a settled bed, times it, and writes the figures to standard output. */
status bench_bed(const bench_options *options, failure *why);
/* bench_effects.c: what every law adds to a step of the bed, alone and on top of those before it. */
status bench_effects(const bench_options *options, failure *why);
/* bench_kernels.c: time and bytes of every kernel. */
status bench_kernels(const bench_options *options, failure *why);
/* bench_tune.c: finds what is fastest on the device, and keeps it. */
status bench_tune(const bench_options *options, failure *why);

/* Step of the bed, s. */
#define BENCH_STEP_S 1.0e-5
double bench_step(const bench_options *options); /* of the bed that is asked for */
/* Before minutes of work, not after. */
status bench_check_writable(const char *path, failure *why);
/* "rolling, conduction" */
void bench_name_effects(unsigned effects, char *text, size_t size);

#endif
