#include "clock.h"
#include "results_layout.h"
#include "xdmf.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/statvfs.h>
#include <unistd.h>

static void release(results *r)
{
    if (!r)
        return;
    commit_file_close(r->file);
    for (int k = 0; k < r->field_count; k++) {
        free((char *)r->field[k].name);
        free((char *)r->field[k].unit);
    }
    for (int k = 0; k < r->observable_count; k++) {
        free((char *)r->observable[k].name);
        free((char *)r->observable[k].unit);
    }
    free(r->field);
    free(r->observable);
    free(r->field_series);
    free(r->observable_series);
    free(r->pending_step);
    free(r->pending_time);
    free(r->pending_value);
    free(r->gathered);
    free(r->frame_time);
    free(r->path);
    free(r->xdmf_path);
    free(r);
}

static bool copy_names(results *r, const results_spec *spec)
{
    bool done = true;
    for (int k = 0; k < spec->field_count; k++) {
        r->field[k] = spec->field[k];
        r->field[k].name = strdup(spec->field[k].name);
        r->field[k].unit = strdup(spec->field[k].unit ? spec->field[k].unit : "");
        done = done && r->field[k].name && r->field[k].unit;
    }
    for (int k = 0; k < spec->observable_count; k++) {
        r->observable[k] = spec->observable[k];
        r->observable[k].name = strdup(spec->observable[k].name);
        r->observable[k].unit = strdup(spec->observable[k].unit ? spec->observable[k].unit : "");
        r->observable_width += spec->observable[k].components;
        done = done && r->observable[k].name && r->observable[k].unit;
    }
    return done;
}

static results *prepare(const char *path, const results_spec *spec)
{
    results *r = calloc(1, sizeof *r);
    if (!r)
        return NULL;
    r->count = spec->count;
    r->contacts = spec->contacts;
    r->path = strdup(path);
    r->xdmf_path = xdmf_path(path);
    r->field = calloc((size_t)spec->field_count + 1, sizeof *r->field);
    r->observable = calloc((size_t)spec->observable_count + 1, sizeof *r->observable);
    r->field_series = calloc((size_t)spec->field_count + 1, sizeof *r->field_series);
    r->observable_series = calloc((size_t)spec->observable_count + 1, sizeof *r->observable_series);
    bool done = r->path && r->xdmf_path && r->field && r->observable && r->field_series && r->observable_series;
    if (done) {
        r->field_count = spec->field_count;
        r->observable_count = spec->observable_count;
        done = copy_names(r, spec);
    }
    size_t values = (size_t)RESULTS_PENDING_MAX * (size_t)(r->observable_width + 1);
    r->pending_step = malloc(RESULTS_PENDING_MAX * sizeof *r->pending_step);
    r->pending_time = malloc(RESULTS_PENDING_MAX * sizeof *r->pending_time);
    r->pending_value = malloc(values * sizeof *r->pending_value);
    r->gathered = malloc(values * sizeof *r->gathered);
    r->last_flush_s = clock_seconds();
    if (done && r->pending_step && r->pending_time && r->pending_value && r->gathered)
        return r;
    release(r);
    return NULL;
}

/* A disk that cannot even hold the first frame is better known before the run than after it. */
static status enough_space(const results *r, failure *why)
{
    struct statvfs disk;
    double need = 1 << 20;
    for (int k = 0; k < r->field_count; k++)
        need += (double)r->count * r->field[k].components * (r->field[k].integer ? 4 : 8);
    if (statvfs(r->path, &disk) != 0)
        return STATUS_OK; /* not every file system says; the write itself will */
    double have = (double)disk.f_bavail * (double)disk.f_frsize;
    if (have >= need)
        return STATUS_OK;
    return fail(why, STATUS_BAD_INPUT, "%s: the disk is full: %.1f MB free, and the first frame needs %.1f MB; "
                "free some space or write elsewhere", r->path, 1e-6 * have, 1e-6 * need);
}

static status write_xdmf(results *r, failure *why)
{
    double start = clock_seconds();
    TRY(xdmf_write(r->xdmf_path, r->path, r->count, r->field_count, r->field, r->frames.step.rows, r->frame_time, why));
    r->xdmf_frames = r->frames.step.rows;
    r->last_xdmf_s = clock_seconds();
    r->xdmf_cost_s = r->last_xdmf_s - start;
    return STATUS_OK;
}

status results_create(const char *path, const results_spec *spec, results **out, failure *why)
{
    *out = NULL;
    results *r = prepare(path, spec);
    if (!r)
        return fail(why, STATUS_ERROR, "%s: out of memory", path);
    status result;
    TRY_GOTO(result, failed, commit_file_create(path, 0, &r->file, why));
    result = enough_space(r, why);
    if (result == STATUS_OK && !results_layout_create(r, spec))
        result = commit_file_failed(r->file, "created", why);
    if (result == STATUS_OK)
        result = commit_file_flush(r->file, false, why);
    if (result == STATUS_OK)
        result = write_xdmf(r, why);
    if (result != STATUS_OK) {
        unlink(path);
        result = STATUS_BAD_INPUT;
        goto failed;
    }
    *out = r;
    return STATUS_OK;
failed:
    release(r);
    return result;
}

static status read_frame_times(results *r, failure *why)
{
    int64_t frames = r->frames.time.rows;
    r->frame_capacity = frames + 64;
    r->frame_time = malloc((size_t)r->frame_capacity * sizeof *r->frame_time);
    if (!r->frame_time)
        return fail(why, STATUS_ERROR, "%s: out of memory", r->path);
    return series_read(&r->frames.time, 0, frames, r->frame_time) ? STATUS_OK : commit_file_failed(r->file, "read", why);
}

status results_continue(const char *path, const results_spec *spec, int64_t step, results **out, failure *why)
{
    *out = NULL;
    results *r = prepare(path, spec);
    if (!r)
        return fail(why, STATUS_ERROR, "%s: out of memory", path);
    status result;
    TRY_GOTO(result, failed, commit_file_open(path, &r->file, why));
    TRY_GOTO(result, failed, results_layout_open(r, why));
    commit_file_begin_cut(r->file);
    if (!results_layout_cut(r, step))
        TRY_GOTO(result, failed, commit_file_failed(r->file, "cut", why));
    TRY_GOTO(result, failed, commit_file_flush(r->file, false, why));
    TRY_GOTO(result, failed, read_frame_times(r, why));
    TRY_GOTO(result, failed, write_xdmf(r, why));
    *out = r;
    return STATUS_OK;
failed:
    release(r);
    return result;
}

/* Remembers the failure: the file stays at its last flush, and every later call says the same. */
static status broken(results *r, status result, failure *why)
{
    r->broken = result;
    r->why = *why;
    return result;
}

static status write_samples(results *r, failure *why)
{
    bool done = series_append(&r->samples.step, r->pending, r->pending_step) &&
                series_append(&r->samples.time, r->pending, r->pending_time);
    int at = 0;
    for (int k = 0; k < r->observable_count && done; k++) {
        size_t components = (size_t)r->observable[k].components;
        for (int64_t row = 0; row < r->pending; row++)
            memcpy(r->gathered + (size_t)row * components, r->pending_value + row * r->observable_width + at, components * sizeof(double));
        done = series_append(&r->observable_series[k], r->pending, r->gathered);
        at += r->observable[k].components;
    }
    if (!done)
        return commit_file_failed(r->file, "written", why);
    r->pending = 0;
    return STATUS_OK;
}

static status flush(results *r, failure *why)
{
    TRY(write_samples(r, why));
    TRY(commit_file_flush(r->file, false, why));
    r->last_flush_s = clock_seconds();
    return STATUS_OK;
}

static bool write_constant(const results *r, int k, const void *value)
{
    const series *s = &r->field_series[k];
    return r->count == 0 || !value || H5Dwrite(s->dataset, s->type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0;
}

static status write_frame(results *r, int64_t step, double time, const void *const *value, const results_contacts *contacts, failure *why)
{
    if (r->frames.step.rows + 1 > r->frame_capacity) {
        int64_t capacity = 2 * r->frame_capacity + 64;
        double *grown = realloc(r->frame_time, (size_t)capacity * sizeof *grown);
        if (!grown)
            return fail(why, STATUS_ERROR, "%s: out of memory", r->path);
        r->frame_time = grown;
        r->frame_capacity = capacity;
    }
    bool done = true, first = r->frames.step.rows == 0;
    for (int k = 0; k < r->field_count && done; k++) {
        if (r->field[k].constant)
            done = !first || write_constant(r, k, value[k]);
        else
            done = series_append(&r->field_series[k], 1, value[k]);
    }
    done = done && (!r->contacts || results_layout_add_contacts(r, contacts));
    r->frame_time[r->frames.step.rows] = time;
    done = done && series_append(&r->frames.time, 1, &time) && series_append(&r->frames.step, 1, &step);
    return done ? flush(r, why) : commit_file_failed(r->file, "written", why);
}

/* Writing all frames at every frame is quadratic: soon it may take no more than a twentieth of the time. */
static bool xdmf_due(const results *r)
{
    double since = clock_seconds() - r->last_xdmf_s;
    if (r->frames.step.rows <= 100)
        return true;
    return since > 20.0 * r->xdmf_cost_s && (r->frames.step.rows <= 2000 || since > 5.0);
}

status results_frame(results *r, int64_t step, double time, const void *const *value, const results_contacts *contacts, failure *why)
{
    if (r->broken != STATUS_OK) {
        *why = r->why;
        return r->broken;
    }
    status result = write_frame(r, step, time, value, contacts, why);
    if (result == STATUS_OK && xdmf_due(r))
        result = write_xdmf(r, why);
    return result == STATUS_OK ? STATUS_OK : broken(r, result, why);
}

status results_observe(results *r, int64_t step, double time, const double *value, failure *why)
{
    if (r->broken != STATUS_OK) {
        *why = r->why;
        return r->broken;
    }
    r->pending_step[r->pending] = step;
    r->pending_time[r->pending] = time;
    if (r->observable_width > 0)
        memcpy(r->pending_value + r->pending * r->observable_width, value, (size_t)r->observable_width * sizeof *value);
    r->pending++;
    status result = STATUS_OK;
    if (clock_seconds() - r->last_flush_s > 1.0)
        result = flush(r, why);
    else if (r->pending == RESULTS_PENDING_MAX)
        result = write_samples(r, why);
    return result == STATUS_OK ? STATUS_OK : broken(r, result, why);
}

status results_text(results *r, const char *name, const char *text, failure *why)
{
    if (r->broken != STATUS_OK) {
        *why = r->why;
        return r->broken;
    }
    hid_t clast = H5Gopen2(commit_file_id(r->file), "/clast", H5P_DEFAULT);
    status result = clast >= 0 && hdf5_text_dataset(clast, name, text) ? STATUS_OK : commit_file_failed(r->file, "written", why);
    H5Gclose(clast);
    if (result == STATUS_OK)
        result = flush(r, why);
    return result == STATUS_OK ? STATUS_OK : broken(r, result, why);
}

status results_close(results *r, failure *why)
{
    if (!r)
        return STATUS_OK;
    status result = r->broken;
    if (result == STATUS_OK)
        result = flush(r, why);
    else
        *why = r->why;
    if (result == STATUS_OK && r->xdmf_frames != r->frames.step.rows)
        result = write_xdmf(r, why);
    release(r);
    return result;
}
