/* The last sample of every observable of a results file. */
#include "hdf5_common.h"
#include "results.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int results_find_end(const results_ends *ends, const char *name)
{
    for (int k = 0; k < ends->count; k++)
        if (strcmp(ends->name[k], name) == 0)
            return k;
    return -1;
}

void results_free_ends(results_ends *ends)
{
    for (int k = 0; k < ends->count; k++)
        free(ends->name[k]);
    free(ends->name);
    free(ends->value);
    *ends = (results_ends){0};
}

static bool add_end(results_ends *ends, const char *name, const char *suffix, double value)
{
    char **names = realloc(ends->name, sizeof *names * (size_t)(ends->count + 1));
    ends->name = names ? names : ends->name;
    double *values = realloc(ends->value, sizeof *values * (size_t)(ends->count + 1));
    ends->value = values ? values : ends->value;
    if (!names || !values || asprintf(&names[ends->count], "%s%s", name, suffix) < 0)
        return false;
    values[ends->count++] = value;
    return true;
}

static const char *suffix_of(hsize_t components, hsize_t c)
{
    static const char *const three[] = {".x", ".y", ".z"}, *const nine[] = {".xx", ".xy", ".xz", ".yx", ".yy", ".yz", ".zx", ".zy", ".zz"};
    return components == 3 ? three[c] : components == 9 ? nine[c] : "";
}

/* `name` is the path below /observables of a group with a dataset `value`. */
static bool read_end(hid_t dataset, const char *name, results_ends *ends)
{
    hid_t space = H5Dget_space(dataset);
    hsize_t extent[H5S_MAX_RANK] = {0}, components;
    int rank = H5Sget_simple_extent_dims(space, extent, NULL);
    bool read = (rank == 1 || rank == 2) && extent[0] > 0;
    components = rank == 2 ? extent[1] : 1;
    if (read && components <= 9) {
        hsize_t start[2] = {extent[0] - 1, 0}, block[2] = {1, components};
        double value[9];
        hid_t memory = H5Screate_simple(1, &components, NULL);
        read = H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, block, NULL) >= 0 &&
               H5Dread(dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, value) >= 0;
        H5Sclose(memory);
        for (hsize_t c = 0; c < components && read; c++)
            read = add_end(ends, name, suffix_of(components, c), value[c]);
    }
    H5Sclose(space);
    return read;
}

static herr_t visit(hid_t group, const char *name, const H5L_info_t *info, void *data)
{
    size_t length = strlen(name);
    (void)info;
    if (length < 7 || strcmp(name + length - 6, "/value") != 0)
        return 0;
    char *path = strndup(name, length - 6);
    hid_t dataset = H5Dopen2(group, name, H5P_DEFAULT);
    if (path && dataset >= 0)
        (void)read_end(dataset, path, data); /* a series without a sample has no end */
    if (dataset >= 0)
        H5Dclose(dataset);
    free(path);
    return 0;
}

status results_read_ends(const char *path, results_ends *out, failure *why)
{
    *out = (results_ends){0};
    hid_t file;
    TRY(hdf5_open_read(path, "a results file", &file, why));
    if (H5Lexists(file, "observables", H5P_DEFAULT) > 0) {
        hid_t group = H5Gopen2(file, "observables", H5P_DEFAULT);
        H5Lvisit(group, H5_INDEX_NAME, H5_ITER_INC, visit, out);
        H5Gclose(group);
    }
    H5Fclose(file);
    return STATUS_OK;
}
