/* What a run writes to its results file: frames and observables, as the scene's `output:` asks. */
#ifndef CLAST_HOST_OUTPUT_H
#define CLAST_HOST_OUTPUT_H
#include "results.h"
#include "simulation.h"

typedef struct output output;

/* Creates the file, or goes on in it after `step` when `continued`. */
status output_open(simulation *sim, const char *path, const char *plan_text, bool continued, output **out, failure *why);
status output_frame(output *o, failure *why);
status output_observe(output *o, failure *why);
status output_text(output *o, const char *name, const char *text, failure *why);
status output_close(output *o, failure *why);

#endif
