/* The largest stable step of every stage of a scene, by bisection, against the step that `step_s: auto` takes. */
#ifndef CLAST_HOST_STUDY_STABILITY_H
#define CLAST_HOST_STUDY_STABILITY_H
#include "run.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct stability_options {
    run_options run;       /* `out`: folder for stability.json and stability.csv; NULL: none is written */
    const char *stage;     /* name of the only stage to study; NULL: all */
    int64_t steps;         /* of auto's size a run, at most */
    double tolerance;      /* of the factor */
    bool json;             /* JSON on standard output instead of text */
} stability_options;

status study_stability(const stability_options *options, failure *why);

#endif
