#include "hdf5_common.h"
#include "results.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

typedef struct reader {
    const char *path;
    hid_t file;
    int64_t count, frames, frame; /* -1: not known yet */
} reader;

static bool exists(hid_t file, const char *path)
{
    char part[512];
    for (const char *end = path; *end;) { /* H5Lexists needs every group on the way */
        end += strcspn(end + 1, "/") + 1;
        snprintf(part, sizeof part, "%.*s", (int)(end - path), path);
        if (H5Lexists(file, part, H5P_DEFAULT) <= 0)
            return false;
    }
    return H5Oexists_by_name(file, path, H5P_DEFAULT) > 0;
}

static status odd(const reader *r, const char *path, failure *why)
{
    return fail(why, STATUS_BAD_INPUT, "%s: %s is not what a results file holds there (numbers, one row a particle)", r->path, path);
}

/* Reads one row of the dataset's first dimension when `row` >= 0, else all of it. Values in double. */
static status read_numbers(const reader *r, const char *path, int64_t row, int components, double **out, failure *why)
{
    hid_t dataset = H5Dopen2(r->file, path, H5P_DEFAULT), type = H5Dget_type(dataset), space = H5Dget_space(dataset);
    hsize_t extent[H5S_MAX_RANK] = {0}, start[3] = {0}, block[3] = {0};
    int rank = H5Sget_simple_extent_dims(space, extent, NULL), lead = row >= 0 ? 1 : 0;
    H5T_class_t class = H5Tget_class(type);
    bool fits = dataset >= 0 && (class == H5T_FLOAT || class == H5T_INTEGER) && rank == lead + (components > 1 ? 2 : 1) &&
                (int64_t)extent[lead] == r->count && (components == 1 || (int64_t)extent[lead + 1] == components) &&
                (row < 0 || (int64_t)extent[0] > row);
    status result = STATUS_OK;
    double *value = NULL;
    if (fits) {
        hsize_t total = (hsize_t)r->count * (hsize_t)components;
        memcpy(block, extent, (size_t)rank * sizeof *block);
        if (row >= 0) {
            start[0] = (hsize_t)row;
            block[0] = 1;
        }
        hid_t memory = H5Screate_simple(1, &total, NULL);
        value = malloc((size_t)total * sizeof *value + 1);
        fits = value && H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, block, NULL) >= 0 &&
               (total == 0 || H5Dread(dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, value) >= 0);
        H5Sclose(memory);
    }
    if (!fits) {
        result = odd(r, path, why);
        free(value);
        value = NULL;
    }
    *out = value;
    H5Sclose(space);
    H5Tclose(type);
    if (dataset >= 0)
        H5Dclose(dataset);
    return result;
}

/* A field, be it a series or constant; NULL when the file has none. */
static status read_field(const reader *r, const char *name, int components, double **out, failure *why)
{
    char constant[64], series[64];
    snprintf(constant, sizeof constant, "/particles/all/%s", name);
    snprintf(series, sizeof series, "/particles/all/%s/value", name);
    *out = NULL;
    if (!exists(r->file, constant))
        return STATUS_OK;
    H5O_info_t about;
    if (H5Oget_info_by_name(r->file, constant, &about, H5P_DEFAULT) < 0)
        return odd(r, constant, why);
    if (about.type == H5O_TYPE_DATASET)
        return read_numbers(r, constant, -1, components, out, why);
    return exists(r->file, series) ? read_numbers(r, series, r->frame, components, out, why) : STATUS_OK;
}

/* Numbers of frames and particles, from the positions; the time of the chosen frame. */
static status read_shape(reader *r, int64_t frame, double *time, failure *why)
{
    const char *const value = "/particles/all/position/value", *const clock = "/particles/all/position/time";
    if (!exists(r->file, value) || !exists(r->file, clock))
        return fail(why, STATUS_BAD_INPUT, "%s: holds no /particles/all/position: not a results file, or written without positions",
                    r->path);
    hid_t dataset = H5Dopen2(r->file, value, H5P_DEFAULT), space = H5Dget_space(dataset);
    hsize_t extent[H5S_MAX_RANK] = {0};
    int rank = H5Sget_simple_extent_dims(space, extent, NULL);
    H5Sclose(space);
    if (dataset >= 0)
        H5Dclose(dataset);
    if (rank != 3 || extent[2] != 3)
        return odd(r, value, why);
    r->frames = (int64_t)extent[0];
    r->count = (int64_t)extent[1];
    if (r->frames == 0)
        return fail(why, STATUS_BAD_INPUT, "%s: holds no frames yet", r->path);
    if (frame < -1 || frame >= r->frames)
        return fail(why, STATUS_BAD_INPUT, "%s: has no frame %" PRId64 ": frames go from 0 to %" PRId64 ", and -1 is the last",
                    r->path, frame, r->frames - 1);
    r->frame = frame < 0 ? r->frames - 1 : frame;
    int64_t particles = r->count;
    double *times;
    r->count = r->frames; /* the times are one number a frame */
    status result = read_numbers(r, clock, -1, 1, &times, why);
    r->count = particles;
    if (result == STATUS_OK)
        *time = times[r->frame];
    free(times);
    return result;
}

status results_read_particles(const char *path, int64_t frame, results_particles *out, failure *why)
{
    *out = (results_particles){0};
    reader r = {.path = path};
    TRY(hdf5_open_read(path, "a results file", &r.file, why));
    status result;
    TRY_GOTO(result, done, read_shape(&r, frame, &out->time, why));
    out->count = r.count;
    TRY_GOTO(result, done, read_field(&r, "position", 3, &out->position, why));
    TRY_GOTO(result, done, read_field(&r, "velocity", 3, &out->velocity, why));
    TRY_GOTO(result, done, read_field(&r, "spin", 3, &out->spin, why));
    TRY_GOTO(result, done, read_field(&r, "radius", 1, &out->radius, why));
    out->radius_varies = out->radius && exists(r.file, "/particles/all/radius/value");
    TRY_GOTO(result, done, read_field(&r, "temperature", 1, &out->temperature, why));
done:
    H5Fclose(r.file);
    if (result != STATUS_OK)
        results_particles_free(out);
    return result;
}

void results_particles_free(results_particles *p)
{
    free(p->position);
    free(p->velocity);
    free(p->spin);
    free(p->radius);
    free(p->temperature);
    *p = (results_particles){0};
}
