/* A results file whose every value tells where it belongs, and its reading with libhdf5 alone. */
#ifndef CLAST_TESTS_RESULTS_CASE_H
#define CLAST_TESTS_RESULTS_CASE_H
#include "results.h"

#include <hdf5.h>
#include <inttypes.h>
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

enum { COUNT = 7, WIDTH = 5 };

static const results_field fields[] = {
    {"position", "m", 3, false, false},  {"velocity", "m/s", 3, false, false}, {"temperature", "K", 1, false, false},
    {"contacts", "", 1, false, true},    {"id", "", 1, true, true},            {"radius", "m", 1, true, false},
};
enum { FIELDS = sizeof fields / sizeof fields[0] };
static const results_observable observables[] = {
    {"kinetic_energy", "J", 1},
    {"momentum", "kg m/s", 3},
    {"walls/floor/force_z", "N", 1},
};

static inline results_spec example(void)
{
    return (results_spec){.count = COUNT,
                          .field_count = FIELDS,
                          .field = fields,
                          .observable_count = 3,
                          .observable = observables,
                          .contacts = true,
                          .box_given = true,
                          .box_low = {-1, -2, -3},
                          .box_high = {1, 2, 4},
                          .periodic = {true, false, false},
                          .scene_text = "title: \xc3\xbc & <x>\n",
                          .plan_text = "",
                          .version_text = "clast test",
                          .device_text = "none"};
}

/* Values that tell field, frame, particle and component. */
static inline double expected(int field, int64_t frame, int64_t row, int component)
{
    return 1000.0 * field + 10.0 * (double)frame + (double)row + 0.1 * component;
}

static inline int64_t contact_count(int64_t frame)
{
    return frame % 4;
}

static inline status put_frame(results *r, int64_t frame, failure *why)
{
    double real[3][COUNT * 3];
    int32_t whole[2][COUNT];
    double radius[COUNT];
    for (int row = 0; row < COUNT; row++) {
        for (int c = 0; c < 3; c++) {
            real[0][3 * row + c] = expected(0, frame, row, c);
            real[1][3 * row + c] = expected(1, frame, row, c);
        }
        real[2][row] = expected(2, frame, row, 0);
        whole[0][row] = (int32_t)expected(3, frame, row, 0);
        whole[1][row] = row;
        radius[row] = 0.001 * (row + 1);
    }
    const void *value[FIELDS] = {real[0], real[1], real[2], whole[0], frame ? NULL : whole[1], frame ? NULL : radius};
    int32_t i[3] = {0, 1, 2}, j[3] = {1, 2, -1}, wall[3] = {-1, -1, 0};
    double overlap[3], area[3] = {1, 2, 3}, force[3][3] = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
    for (int k = 0; k < 3; k++)
        overlap[k] = (double)frame + 0.1 * k;
    results_contacts contacts = {contact_count(frame), i, j, wall, overlap, area, (const double(*)[3])force, NULL, NULL};
    return results_frame(r, 100 * frame, 0.5 * (double)frame, value, &contacts, why);
}

static inline status put_sample(results *r, int64_t sample, failure *why)
{
    double value[WIDTH];
    for (int k = 0; k < WIDTH; k++)
        value[k] = (double)sample + 0.1 * k;
    return results_observe(r, 10 * sample, 0.05 * (double)sample, value, why);
}

/* Ten samples a frame. */
static inline status put_both(results *r, int64_t frame, failure *why)
{
    TRY(put_frame(r, frame, why));
    for (int64_t k = 0; k < 10; k++)
        TRY(put_sample(r, 10 * frame + k, why));
    return STATUS_OK;
}

static inline void write_example(const char *path, int64_t frames)
{
    failure why;
    results *r;
    results_spec spec = example();
    assert_int_equal(results_create(path, &spec, &r, &why), STATUS_OK);
    for (int64_t k = 0; k < frames; k++)
        assert_int_equal(put_both(r, k, &why), STATUS_OK);
    assert_int_equal(results_close(r, &why), STATUS_OK);
}

/* ---- reading back with libhdf5 alone ---- */

static inline int64_t extent(hid_t file, const char *path, int dimension)
{
    hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT);
    assert_true(dataset >= 0);
    hid_t space = H5Dget_space(dataset);
    hsize_t dims[8] = {0};
    int rank = H5Sget_simple_extent_dims(space, dims, NULL);
    H5Sclose(space);
    H5Dclose(dataset);
    return dimension < rank ? (int64_t)dims[dimension] : -1;
}

static inline double *all(hid_t file, const char *path)
{
    hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT);
    assert_true(dataset >= 0);
    hid_t space = H5Dget_space(dataset);
    hssize_t count = H5Sget_simple_extent_npoints(space);
    double *value = malloc((size_t)(count + 1) * sizeof *value);
    if (count > 0)
        assert_true(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0);
    H5Sclose(space);
    H5Dclose(dataset);
    return value;
}

static inline void text_of(hid_t object, const char *attribute, char *text, size_t size)
{
    hid_t a = H5Aopen(object, attribute, H5P_DEFAULT);
    assert_true(a >= 0);
    hid_t type = H5Aget_type(a);
    size_t length = H5Tget_size(type);
    assert_true(length < size);
    memset(text, 0, size);
    assert_true(H5Aread(a, type, text) >= 0);
    H5Tclose(type);
    H5Aclose(a);
}

static inline void assert_unit(hid_t file, const char *path, const char *unit)
{
    char text[64];
    hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT);
    text_of(dataset, "unit", text, sizeof text);
    assert_string_equal(text, unit);
    H5Dclose(dataset);
}

static inline bool same_object(hid_t file, const char *a, const char *b)
{
    H5O_info_t one, two;
    assert_true(H5Oget_info_by_name(file, a, &one, H5P_DEFAULT) >= 0);
    assert_true(H5Oget_info_by_name(file, b, &two, H5P_DEFAULT) >= 0);
    return one.addr == two.addr;
}

/* Every frame and sample that has a step has its rows, and they hold what was written; `torn` allows a row that has no step yet. Returns
 * the frames found. */
static inline int64_t check_rows(const char *path, bool torn)
{
    const int64_t extra = torn ? 1 : 0;
    hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    assert_true(file >= 0);
    int64_t frames = extent(file, "/particles/all/position/step", 0), contacts = 0;
    for (int k = 0; k < 4; k++) {
        char name[128];
        snprintf(name, sizeof name, "/particles/all/%s/value", fields[k].name);
        assert_in_range(extent(file, name, 0), frames, frames + extra);
        double *value = all(file, name);
        for (int64_t f = 0; f < frames; f++)
            for (int64_t row = 0; row < COUNT; row++)
                for (int c = 0; c < fields[k].components; c++)
                    assert_true(value[(f * COUNT + row) * fields[k].components + c] == expected(k, f, row, c));
        free(value);
    }
    double *step = all(file, "/particles/all/position/step"), *offset = all(file, "/contacts/offset");
    double *overlap = all(file, "/contacts/overlap");
    assert_in_range(extent(file, "/contacts/offset", 0), frames, frames + extra);
    for (int64_t f = 0; f < frames; f++) {
        assert_true(step[f] == 100.0 * (double)f);
        assert_true(offset[f] == (double)contacts);
        for (int64_t k = 0; k < contact_count(f); k++)
            assert_true(overlap[contacts + k] == (double)f + 0.1 * (double)k);
        contacts += contact_count(f);
    }
    assert_in_range(extent(file, "/contacts/overlap", 0), contacts, contacts + 3 * extra);
    free(step);
    free(offset);
    free(overlap);
    int64_t samples = extent(file, "/observables/momentum/step", 0);
    double *momentum = all(file, "/observables/momentum/value"), *force = all(file, "/observables/walls/floor/force_z/value");
    assert_in_range(extent(file, "/observables/momentum/value", 0), samples, samples + 10 * extra);
    for (int64_t s = 0; s < samples; s++) {
        for (int c = 0; c < 3; c++)
            assert_true(momentum[3 * s + c] == (double)s + 0.1 * (1 + c));
        assert_true(force[s] == (double)s + 0.1 * 4);
    }
    free(momentum);
    free(force);
    H5Fclose(file);
    return frames;
}

static inline int64_t check_whole(const char *path)
{
    return check_rows(path, false);
}

static char folder[64];

static const char *in_folder(const char *name)
{
    static char path[4][256];
    static int next;
    next = (next + 1) % 4;
    snprintf(path[next], sizeof path[next], "%s/%s", folder, name);
    return path[next];
}

static inline int set_up(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/clast_results_XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static inline int tear_down(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command) == 0 ? 0 : -1;
}

#endif
