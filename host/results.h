/* The results file: HDF5 in H5MD 1.1 form, with an XDMF file of the same stem beside it. Layout: interface, "Results". */
#ifndef CLAST_HOST_RESULTS_H
#define CLAST_HOST_RESULTS_H
#include "status.h"

#include <stdint.h>

/* A per-particle series, or a constant when `constant`. Rows in permanent-id order. */
typedef struct results_field {
    const char *name, *unit;
    int components;  /* 1: dataset of rank frames x N; else frames x N x components */
    bool constant;   /* written once, under /particles/all/<name> */
    bool integer;    /* stored as int32 (id, material, group) */
} results_field;

/* A scalar or vector over time: /observables/<name>, or /observables/walls/<wall>/<name> when the name is "walls/floor/force". */
typedef struct results_observable {
    const char *name, *unit;
    int components;
} results_observable;

typedef struct results_spec {
    int64_t count;               /* particles */
    int field_count;
    const results_field *field;
    int observable_count;
    const results_observable *observable;
    bool contacts;
    bool box_given;
    double box_low[3], box_high[3];
    bool periodic[3];
    const char *scene_text, *plan_text, *version_text, *device_text;
} results_spec;

/* One row per live contact: i < j permanent ids, or j = -1 and wall = index of the named wall; area pi a^2 with a the contact radius. */
typedef struct results_contacts {
    int64_t count;
    const int32_t *i, *j, *wall;
    const double *overlap, *area;
    const double (*force)[3]; /* on i */
    const double *heat;       /* NULL: zeros */
    const int32_t *bonded;    /* NULL: zeros */
} results_contacts;

typedef struct results results;

/* Creates every dataset first. An unwritable path, a missing folder, a full disk: STATUS_BAD_INPUT with the path and the reason. */
status results_create(const char *path, const results_spec *spec, results **out, failure *why);
/* Opens an existing file to go on after `step`: later frames and observable rows are cut first. */
status results_continue(const char *path, const results_spec *spec, int64_t step, results **out, failure *why);
/* `value[k]` is field k's data: double, row-major [count][components] (integer fields: int32). Constant fields only on the first frame.
 * Flushed before return. A full disk fails with STATUS_ERROR; the frames before it stay readable. */
status results_frame(results *r, int64_t step, double time, const void *const *value, const results_contacts *contacts, failure *why);
/* `value` holds all observables one after the other (components each). */
status results_observe(results *r, int64_t step, double time, const double *value, failure *why);
/* Rewrites the XDMF file by rename. Called by results_frame too. */
status results_close(results *r, failure *why);
/* Text under /clast/<name>, replaced if present (run summary). */
status results_text(results *r, const char *name, const char *text, failure *why);

/* Reads one frame of a results file for the `result` generator: frame -1 is the last. Caller frees the arrays. Absent datasets give NULL. */
typedef struct results_particles {
    int64_t count;
    double *position, *velocity, *spin, *radius, *temperature; /* [count][3] or [count] */
    bool radius_varies; /* radii are a series: those at the temperatures of the frame */
    double time;
} results_particles;
status results_read_particles(const char *path, int64_t frame, results_particles *out, failure *why);
void results_particles_free(results_particles *p);

/* The last sample of every observable in a results file, one entry a component ("momentum.x", "walls/floor/force.z"). */
typedef struct results_ends {
    int count;
    char **name;
    double *value;
} results_ends;
status results_read_ends(const char *path, results_ends *out, failure *why);
/* Index of an entry, or -1. */
int results_find_end(const results_ends *ends, const char *name);
void results_free_ends(results_ends *ends);

#endif
