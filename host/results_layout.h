/* Inside of an open results file: which dataset holds what. Only results.c and results_layout.c see it. */
#ifndef CLAST_HOST_RESULTS_LAYOUT_H
#define CLAST_HOST_RESULTS_LAYOUT_H
#include "commit_file.h"
#include "results.h"
#include "series.h"

/* The step and time of every row, shared by hard links by all elements that are written together, as H5MD allows. */
typedef struct clock_series {
    series step, time;
} clock_series;

typedef struct contact_series {
    series offset, i, j, wall, overlap, area, force, heat, bonded;
} contact_series;

struct results {
    char *path, *xdmf_path;
    commit_file *file;
    int64_t count;
    int field_count, observable_count, observable_width; /* width: numbers in one sample of all observables */
    results_field *field;
    results_observable *observable;
    series *field_series, *observable_series; /* of a constant field: dataset and type only */
    clock_series frames, samples;
    bool contacts;
    contact_series contact;

    /* Samples since the last write: there may be millions, and each would cost a call for every observable. */
    int64_t pending;
    int64_t *pending_step;
    double *pending_time, *pending_value, *gathered;

    double *frame_time; /* for the XDMF file */
    int64_t frame_capacity;
    double last_flush_s, last_xdmf_s, xdmf_cost_s; /* wall clock */
    int64_t xdmf_frames;
    status broken; /* after a failed write: every later call repeats it */
    failure why;
};

enum { RESULTS_PENDING_MAX = 1024 };

/* All work on r->file and the copies of the spec. A false return leaves the reason on libhdf5's error stack. */
bool results_layout_create(results *r, const results_spec *spec);
/* STATUS_BAD_INPUT when the file was written by a run with other outputs or particles. */
status results_layout_open(results *r, failure *why);
/* Cuts frames and samples later than `step`, and what a torn end left in only some of the datasets. */
bool results_layout_cut(results *r, int64_t step);
/* One more frame of contacts; NULL: none in this frame. */
bool results_layout_add_contacts(results *r, const results_contacts *contacts);

#endif
