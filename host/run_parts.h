/* Parts of a run that run.c, run_say.c and run_checkpoint.c share. */
#ifndef CLAST_HOST_RUN_PARTS_H
#define CLAST_HOST_RUN_PARTS_H
#include "bed.h"
#include "bundle.h"
#include "device.h"
#include "output.h"
#include "run.h"
#include "scene.h"
#include "schedule.h"
#include "simulation.h"
#include "steady.h"

typedef struct run {
    scene *scene;
    bed bed;
    device device;
    simulation *sim;
    output *output;
    schedule schedule;
    temperature_look steady; /* at the last look, in stages that move and end when temperatures stand */
    stage_rounds rounds;
    char *results_path, *checkpoint_path;
    bundle good;      /* the last state that passed the guards; empty at first */
    double good_cost, good_at; /* wall seconds that it took, and when */
    int64_t beyond_limit; /* looks in a row at which the step was past twice its limit */
    bool quiet, terminal;
    double started, shown, chunk_steps, stepping;
    int64_t first_step, first_rebuilds; /* where this run begins: one that is resumed, at its checkpoint */
} run;

/* run_say.c: what goes to standard error */
void run_tell(const run *r, const char *format, ...) __attribute__((format(printf, 2, 3)));
void run_show_progress(run *r);
void run_summarise(run *r);
/* What the beams of a scene delivered and what the grains took, and beams that met none. */
status run_report_sources(run *r, failure *why);

/* run_checkpoint.c */
/* <stem>.checkpoint.h5 beside the result; caller frees. */
char *run_checkpoint_path(const char *results);
status run_write_checkpoint(run *r, failure *why);
/* Remembers a state that passed the guards, as often as that costs little. */
status run_keep_good_state(run *r, failure *why);
/* Writes the last good state and returns STATUS_GUARD with the text. */
status run_stop_by_guard(run *r, const char *text, failure *why);
/* What a checkpoint says of the scene, and where the results of its run are: the caller frees *results. */
status run_load_scene(run *r, const bundle *in, const char *path, char **results, failure *why);
/* The state of the run, once its simulation exists. */
status run_load_state(run *r, const bundle *in, const char *path, failure *why);

#endif
