/* What accuracy costs in time: a scene run over a grid of choices, its answers compared with a reference. */
#ifndef CLAST_HOST_STUDY_H
#define CLAST_HOST_STUDY_H
#include "answer.h"
#include "run.h"
#include "scene.h"

typedef struct study_options {
    run_options run;     /* `out` is a folder */
    double tolerance;    /* NAN: not asked for */
    const char *choices; /* "integrator,modulus"; NULL: all that the scene has */
    int levels;          /* of a ladder of steps; 0: as many as the budget allows */
    double budget_s;     /* wall seconds that the study may take, roughly */
    int jobs;            /* 0: by size */
    int repeats;         /* runs from which the cost of a step is taken */
} study_options;

/* Writes accuracy.csv, accuracy.h5, and accuracy.png and .svg where they can be drawn, into the folder; the summary to standard output. */
status study_accuracy(const study_options *options, failure *why);
/* Kinds of choices, NULL-terminated, and what each of them is. */
extern const char *const study_choice_names[], *const study_choice_docs[];

/* ---- inside ---- */

#define STUDY_LEVELS_MAX  14
#define STUDY_LEVELS_PAST 2 /* steps beyond the finest of the ladder, for the reference */
#define STUDY_STAGES_MAX  16
/* Share of the interval between samples within which two times are the same: mixed precision rounds the step to float. */
#define SAME_SAMPLE       1e-3
#define STUDY_REPEATS_MAX 100

/* What a curve of the diagram goes along. */
typedef enum ladder {
    LADDER_STEP,      /* the step is halved from point to point */
    LADDER_TOLERANCE, /* of frozen heat */
    LADDER_VALUES     /* some other number, at the recommended step */
} ladder;

/* What a simulation says of itself before it runs, from a process of its own. */
typedef struct study_probe {
    int set_count;
    char **set;
    double limit_s[STUDY_STAGES_MAX], recommended_s[STUDY_STAGES_MAX];
    double step_cost_s; /* wall time of a step, for planning only */
    int64_t grains;
    bool done;
} study_probe;

typedef struct study_curve {
    char label[160];
    ladder ladder;
    const char *along; /* what the numbers of LADDER_VALUES are: "modulus factor" */
    bool candidate;    /* may be the reference: the scene's own model in double precision */
    bool other_model;  /* converges to something else than the reference, if to anything */
    bool each_costs;   /* a step of one point costs another time than one of the next */
    char integrator[40], precision[16];
    int set_count;
    char **set;
    double order; /* observed, of the worst answer; NAN */
    double *answer_order;
    char expected[64];  /* what docs let expect */
    double step_cost_s; /* calibrated; NAN where each point has its own */
    int probe;          /* of a ladder of steps */
    int costs_like;     /* curve whose program this one runs, and whose calibrated cost it takes; -1: its own */
} study_curve;

typedef struct study_point {
    int curve, probe;
    int level;        /* of a ladder of steps; -1: the recommended step */
    double parameter; /* share of the recommended step, tolerance, or value */
    double step_s;    /* of the first moving stage; NAN */
    bool hidden;      /* only for the reference */
    int set_count;    /* beyond those of its curve */
    char **set;
    int first_run;
    bool failed;
    char failure[200];
    double steps, time_s, wall_s;
    double error, bar, uncertainty; /* the worst answer's; NAN */
    double *answer_error;
    bool front;
} study_point;

typedef struct study_run {
    int point, seed; /* seed: 0-based */
    int status;
    double wall_s;
    char result[4200], log[4200];
    answer_series *answer; /* by answer; NULL where the run failed */
} study_run;

typedef struct study {
    const study_options *options;
    scene *scene; /* with study.set and --set */
    int base_count;
    char **base;            /* these settings */
    bool closed_forms_hold; /* no --set has changed the scene */
    int64_t *first;         /* grain of every group */
    int64_t grains;
    int answer_count;
    answer *answer;
    double duration_s; /* NAN where only rest ends the run */
    double interval_s; /* between samples; NAN */
    int curve_count;
    study_curve *curve;
    int probe_count;
    study_probe *probe; /* shared with the processes that fill them */
    int point_count;
    study_point *point;
    int seeds; /* runs a point */
    int run_count;
    study_run *run;
    run_report *report; /* by run, shared with the processes */
    int levels;
    double **reference;      /* by answer: samples x width, or the mean's width */
    double *reference_floor; /* by answer: uncertainty */
    double *scale;           /* by answer: what errors are shares of */
    double *start;           /* where the scale is taken from */
    char reference_text[512];
    int done;
} study;

/* study_choices.c: curves, and what must be known before they can run: probes, not yet filled. */
status study_choose(study *s, failure *why);
/* study_ladders.c: points of the curves, once the probes are filled. */
status study_lay_ladders(study *s, failure *why);
/* What docs let expect of a scene's order in the step. */
void study_expected_order(const scene *scene, char *text, size_t size);
bool study_wants(const study *s, const char *choice);
/* Adds a formatted setting to a list. */
void study_add_set(char ***set, int *count, const char *format, ...) __attribute__((format(printf, 3, 4)));
study_point *study_add_point(study *s, int curve, int probe);
int study_add_curve(study *s, ladder along, const char *format, ...) __attribute__((format(printf, 3, 4)));
/* True where a stage's motion follows mechanical steps. */
bool study_moves(const scene_stage *stage);

/* study_runs.c */
status study_fill_probes(study *s, failure *why);
status study_run_all(study *s, failure *why);
status study_calibrate(study *s, failure *why);
char **study_sets(const study *s, const study_point *p, const study_probe *probe, int seed, int *count);

/* study_compare.c: reference, errors, orders, front. */
status study_compare(study *s, failure *why);
/* What a point may be relied on for: its error with twice its bar, and no less than the reference is uncertain by; NAN where it is none. */
double study_error(const study_point *p);

/* study_report.c */
status study_write(const study *s, failure *why);
void study_print(const study *s);

#endif
