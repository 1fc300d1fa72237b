#include "hdf5_common.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

void hdf5_quiet(void)
{
    H5open();
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

static herr_t first_reason(unsigned depth, const H5E_error2_t *error, void *text)
{
    (void)depth;
    const char **found = text;
    if (error->desc && *error->desc)
        *found = error->desc;
    return 1; /* the first entry walking up is the innermost */
}

void hdf5_reason(char *text, size_t size)
{
    const char *found = "HDF5 gives no reason";
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, first_reason, &found);
    snprintf(text, size, "%s", found);
}

bool hdf5_signature(int descriptor)
{
    static const char signature[8] = {'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
    char start[sizeof signature] = {0};
    return pread(descriptor, start, sizeof start, 0) == (ssize_t)sizeof start && memcmp(start, signature, sizeof start) == 0;
}

status hdf5_open_read(const char *path, const char *kind, hid_t *file, failure *why)
{
    hdf5_quiet();
    *file = -1;
    int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    if (descriptor < 0)
        return fail(why, STATUS_BAD_INPUT, "%s: cannot be opened: %s", path, strerror(errno));
    struct stat about;
    bool regular = fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode), ours = regular && hdf5_signature(descriptor);
    close(descriptor);
    if (!regular)
        return fail(why, STATUS_BAD_INPUT, "%s: not a regular file", path);
    if (!ours)
        return fail(why, STATUS_BAD_INPUT, "%s: not %s (not an HDF5 file)", path, kind);
    *file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (*file < 0) {
        char reason[256];
        hdf5_reason(reason, sizeof reason);
        return fail(why, STATUS_BAD_INPUT, "%s: not %s that can be read: damaged or cut short (%s)", path, kind, reason);
    }
    return STATUS_OK;
}

static hid_t text_type(const char *text)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    size_t length = strlen(text);
    if (H5Tset_size(type, length ? length : 1) < 0 || H5Tset_cset(type, H5T_CSET_UTF8) < 0 || H5Tset_strpad(type, H5T_STR_NULLPAD) < 0) {
        H5Tclose(type);
        return -1;
    }
    return type;
}

bool hdf5_text_attribute(hid_t object, const char *name, const char *text)
{
    hid_t type = text_type(text), space = H5Screate(H5S_SCALAR);
    hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    bool done = attribute >= 0 && H5Awrite(attribute, type, text) >= 0;
    if (attribute >= 0)
        H5Aclose(attribute);
    H5Sclose(space);
    if (type >= 0)
        H5Tclose(type);
    return done;
}

bool hdf5_text_dataset(hid_t parent, const char *name, const char *text)
{
    if (H5Lexists(parent, name, H5P_DEFAULT) > 0 && H5Ldelete(parent, name, H5P_DEFAULT) < 0)
        return false;
    hid_t type = text_type(text), space = H5Screate(H5S_SCALAR), creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(creation, false);
    hid_t dataset = H5Dcreate2(parent, name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    bool done = dataset >= 0 && H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) >= 0;
    if (dataset >= 0)
        H5Dclose(dataset);
    H5Pclose(creation);
    H5Sclose(space);
    if (type >= 0)
        H5Tclose(type);
    return done;
}
