/* Running a scene from beginning to end, or on from a checkpoint. */
#ifndef CLAST_HOST_RUN_H
#define CLAST_HOST_RUN_H
#include "status.h"

#include <stdint.h>

/* What a run did, for who runs many of them. */
typedef struct run_report {
    int64_t grains, steps;
    double stepping_s; /* wall time of the steps alone, without start, looks and output */
    double start_s;    /* wall time before the first step */
    double time_s;     /* simulated */
} run_report;

typedef struct run_options {
    const char *scene_path;      /* run */
    const char *checkpoint_path; /* resume */
    const char *out;             /* results file; resume: NULL goes on in the file of the run */
    const char *device;          /* as device_choose */
    const char *precision;       /* NULL: the scene's */
    const char *kernels;         /* directory of kernels instead of the embedded ones; or NULL */
    int set_count;
    char *const *sets;
    bool quiet;                  /* no progress on standard error */
    run_report *report;          /* filled as the run goes; or NULL */
} run_options;

/* Exit status of the command. Progress and the closing summary go to standard error. SIGINT and SIGTERM end a run after the current batch
 * with a checkpoint and STATUS_INTERRUPTED; the handler is installed by run_catch_signals. */
status run_scene(const run_options *options, failure *why);
status run_resume(const run_options *options, failure *why);
void run_catch_signals(void);

#endif
