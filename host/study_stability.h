/* The largest stable step of every stage of a scene, by bisection, against the step that `step_s: auto` takes. */
#ifndef CLAST_HOST_STUDY_STABILITY_H
#define CLAST_HOST_STUDY_STABILITY_H
#include "status.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct stability_options {
    const char *scene_path;
    int set_count;
    char *const *sets;
    const char *device, *kernels;
    const char *precision; /* NULL: the scene's */
    const char *stage;     /* name of the only stage to study; NULL: all */
    const char *out;       /* folder for stability.json and stability.csv; NULL: none is written */
    int64_t steps;         /* of auto's size a run, at most */
    double tolerance;      /* of the factor */
    bool json;             /* JSON on standard output instead of text */
} stability_options;

status study_stability(const stability_options *options, failure *why);

#endif
