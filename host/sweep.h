/* One scene for every combination of swept values: a process each, several small ones at a time, and one table of what they end with. */
#ifndef CLAST_HOST_SWEEP_H
#define CLAST_HOST_SWEEP_H
#include "run.h"

typedef struct sweep_options {
    run_options run;     /* `out` is a folder */
    int count;
    char *const *sweeps; /* "path=a,b,c"; several: every combination, the last changing fastest */
    int jobs;            /* runs at a time; 0: as many as there are cores where beds are small, else one */
} sweep_options;

/* Writes NNN.h5 and NNN.log of every run and sweep.csv into the folder. STATUS_OK where all runs ended well, else the status of the first
 * that did not. */
status sweep_run(const sweep_options *options, failure *why);

#endif
