#include "bundle.h"

#include "commit_file.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* The first bytes of the file, before HDF5's own. A damaged file must never reach libhdf5, which can crash on one, and a wrong bit in the
 * values would pass unseen: so everything behind the seal is hashed. */
typedef struct seal {
    char name[16];
    int32_t format, unused;
    int64_t size; /* of the whole file */
    uint64_t hash;
} seal;

enum { BUNDLE_FORMAT = 1, SEAL_BLOCK = 512 };
static const char seal_name[16] = "clast checkpoint";

void bundle_init(bundle *b)
{
    *b = (bundle){0};
}

void bundle_free(bundle *b)
{
    for (int k = 0; k < b->count; k++)
        free(b->entry[k].data);
    free(b->entry);
    *b = (bundle){0};
}

static size_t item_size(bundle_type type)
{
    static const size_t size[] = {[BUNDLE_F64] = 8, [BUNDLE_I64] = 8, [BUNDLE_I32] = 4, [BUNDLE_TEXT] = 1};
    return size[type];
}

static const char *type_name(bundle_type type)
{
    static const char *const name[] = {[BUNDLE_F64] = "real numbers", [BUNDLE_I64] = "64-bit integers", [BUNDLE_I32] = "32-bit integers",
                                       [BUNDLE_TEXT] = "text"};
    return name[type];
}

/* Bytes of an entry, or SIZE_MAX where they cannot be counted. Text gets a closing zero, nothing is allocated with size 0. */
static size_t entry_bytes(bundle_type type, int64_t rows, int64_t columns)
{
    size_t bytes;
    if (rows < 0 || columns < 0 || __builtin_mul_overflow((size_t)rows, (size_t)columns, &bytes) ||
        __builtin_mul_overflow(bytes, item_size(type), &bytes) || bytes >= (size_t)PTRDIFF_MAX)
        return SIZE_MAX;
    return bytes;
}

/* NULL when there is no memory for it. */
static bundle_entry *grow(bundle *b, const char *name, bundle_type type, int64_t rows, int64_t columns)
{
    size_t bytes = entry_bytes(type, rows, columns);
    if (bytes == SIZE_MAX || strlen(name) >= sizeof b->entry->name)
        return NULL;
    if (b->count == b->capacity) {
        int capacity = b->capacity ? 2 * b->capacity : 32;
        bundle_entry *grown = realloc(b->entry, (size_t)capacity * sizeof *grown);
        if (!grown)
            return NULL;
        b->entry = grown;
        b->capacity = capacity;
    }
    void *data = calloc(bytes + 1, 1);
    if (!data)
        return NULL;
    bundle_entry *entry = &b->entry[b->count++];
    *entry = (bundle_entry){.type = type, .rows = rows, .columns = columns, .data = data};
    strcpy(entry->name, name);
    return entry;
}

void *bundle_add(bundle *b, const char *name, bundle_type type, int64_t rows, int64_t columns, const void *data)
{
    bundle_entry *entry = grow(b, name, type, rows, columns);
    if (!entry) {
        fprintf(stderr, "clast: no memory for %s (%" PRId64 " x %" PRId64 " %s)\n", name, rows, columns, type_name(type));
        abort();
    }
    size_t bytes = entry_bytes(type, rows, columns);
    if (data && bytes > 0)
        memcpy(entry->data, data, bytes);
    return entry->data;
}

void bundle_add_text(bundle *b, const char *name, const char *text)
{
    bundle_add(b, name, BUNDLE_TEXT, (int64_t)strlen(text), 1, text);
}

void bundle_add_f64(bundle *b, const char *name, double value)
{
    bundle_add(b, name, BUNDLE_F64, 1, 1, &value);
}

void bundle_add_i64(bundle *b, const char *name, int64_t value)
{
    bundle_add(b, name, BUNDLE_I64, 1, 1, &value);
}

const bundle_entry *bundle_find(const bundle *b, const char *name)
{
    for (int k = 0; k < b->count; k++)
        if (strcmp(b->entry[k].name, name) == 0)
            return &b->entry[k];
    return NULL;
}

status bundle_get(const bundle *b, const char *path, const char *name, bundle_type type, int64_t rows, int64_t columns,
                  const bundle_entry **out, failure *why)
{
    const bundle_entry *entry = bundle_find(b, name);
    *out = NULL;
    if (!entry)
        return fail(why, STATUS_BAD_INPUT, "%s: has no entry '%s'", path, name);
    if (entry->type != type)
        return fail(why, STATUS_BAD_INPUT, "%s: entry '%s' holds %s where %s belong", path, name, type_name(entry->type), type_name(type));
    if ((rows >= 0 && entry->rows != rows) || (columns >= 0 && entry->columns != columns))
        return fail(why, STATUS_BAD_INPUT, "%s: entry '%s' has %" PRId64 " x %" PRId64 " values where %" PRId64 " x %" PRId64 " belong",
                    path, name, entry->rows, entry->columns, rows >= 0 ? rows : entry->rows, columns >= 0 ? columns : entry->columns);
    *out = entry;
    return STATUS_OK;
}

static hid_t stored_type(bundle_type type)
{
    switch (type) {
    case BUNDLE_F64: return H5T_IEEE_F64LE;
    case BUNDLE_I64: return H5T_STD_I64LE;
    case BUNDLE_I32: return H5T_STD_I32LE;
    default: return H5T_STD_U8LE; /* text as bytes: exact, of any length and content */
    }
}

static hid_t memory_type(bundle_type type)
{
    switch (type) {
    case BUNDLE_F64: return H5T_NATIVE_DOUBLE;
    case BUNDLE_I64: return H5T_NATIVE_INT64;
    case BUNDLE_I32: return H5T_NATIVE_INT32;
    default: return H5T_NATIVE_UINT8;
    }
}

static bool write_int_attribute(hid_t object, const char *name, int value)
{
    hid_t space = H5Screate(H5S_SCALAR), attribute = H5Acreate2(object, name, H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT);
    bool done = attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_INT, &value) >= 0;
    if (attribute >= 0)
        H5Aclose(attribute);
    H5Sclose(space);
    return done;
}

static bool read_int_attribute(hid_t object, const char *name, int *value)
{
    if (H5Aexists(object, name) <= 0)
        return false;
    hid_t attribute = H5Aopen(object, name, H5P_DEFAULT), space = H5Aget_space(attribute), type = H5Aget_type(attribute);
    bool done = attribute >= 0 && H5Sget_simple_extent_npoints(space) == 1 && H5Tget_class(type) == H5T_INTEGER &&
                H5Aread(attribute, H5T_NATIVE_INT, value) >= 0;
    H5Tclose(type);
    H5Sclose(space);
    if (attribute >= 0)
        H5Aclose(attribute);
    return done;
}

static bool write_entry(hid_t file, const bundle_entry *entry)
{
    hsize_t extent[2] = {(hsize_t)entry->rows, (hsize_t)entry->columns};
    bool empty = entry->rows == 0 || entry->columns == 0;
    hid_t space = H5Screate_simple(entry->type == BUNDLE_TEXT ? 1 : 2, extent, NULL), creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(creation, false);
    H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
    hid_t links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1); /* a slash in a name makes a group */
    hid_t dataset = H5Dcreate2(file, entry->name, stored_type(entry->type), space, links, creation, H5P_DEFAULT);
    bool done = dataset >= 0 && write_int_attribute(dataset, "type", (int)entry->type) &&
                (empty || H5Dwrite(dataset, memory_type(entry->type), H5S_ALL, H5S_ALL, H5P_DEFAULT, entry->data) >= 0);
    if (dataset >= 0)
        H5Dclose(dataset);
    H5Pclose(links);
    H5Pclose(creation);
    H5Sclose(space);
    return done;
}

/* Hashes the bytes from SEAL_BLOCK up to `size`. False when they cannot be read. */
static bool hash_file(int descriptor, int64_t size, uint64_t *hash)
{
    enum { WORDS = 1 << 15 };
    uint64_t *words = malloc(WORDS * sizeof *words), h = (uint64_t)size;
    bool done = words != NULL;
    for (int64_t at = SEAL_BLOCK; at < size && done;) {
        size_t want = size - at < (int64_t)(WORDS * sizeof *words) ? (size_t)(size - at) : WORDS * sizeof *words, have = 0;
        while (have < want && done) {
            ssize_t got = pread(descriptor, (char *)words + have, want - have, at + (int64_t)have);
            done = got > 0 || (got < 0 && errno == EINTR);
            have += got > 0 ? (size_t)got : 0;
        }
        memset((char *)words + have, 0, (8 - have % 8) % 8);
        for (size_t k = 0; k < (have + 7) / 8; k++) {
            h = (h ^ words[k]) * UINT64_C(0x9e3779b97f4a7c15); /* odd, bits well mixed: 2^64 over the golden ratio */
            h ^= h >> 32;
        }
        at += (int64_t)want;
    }
    free(words);
    *hash = h;
    return done;
}

/* The file is whole only once its seal is on the disk. */
static status write_seal(const char *path, failure *why)
{
    int descriptor = open(path, O_RDWR | O_CLOEXEC);
    if (descriptor < 0)
        return fail(why, STATUS_ERROR, "%s: cannot be sealed: %s", path, strerror(errno));
    struct stat about;
    seal mark = {.format = BUNDLE_FORMAT};
    memcpy(mark.name, seal_name, sizeof mark.name);
    bool done = fstat(descriptor, &about) == 0 && hash_file(descriptor, about.st_size, &mark.hash);
    mark.size = about.st_size;
    done = done && pwrite(descriptor, &mark, sizeof mark, 0) == (ssize_t)sizeof mark && fsync(descriptor) == 0;
    status result = done ? STATUS_OK : fail(why, STATUS_ERROR, "%s: cannot be sealed: %s", path, strerror(errno));
    close(descriptor);
    return result;
}

static status check_seal(int descriptor, const char *path, failure *why)
{
    struct stat about;
    seal mark;
    uint64_t hash;
    if (fstat(descriptor, &about) != 0 || !S_ISREG(about.st_mode))
        return fail(why, STATUS_BAD_INPUT, "%s: not a regular file", path);
    if (pread(descriptor, &mark, sizeof mark, 0) != (ssize_t)sizeof mark || memcmp(mark.name, seal_name, sizeof mark.name) != 0)
        return fail(why, STATUS_BAD_INPUT, "%s: not a Clast checkpoint%s", path,
                    hdf5_signature(descriptor) ? " (an HDF5 file of another kind, perhaps the results)" : "");
    if (mark.format != BUNDLE_FORMAT)
        return fail(why, STATUS_BAD_INPUT, "%s: a checkpoint of format %d; this version of Clast reads format %d", path, mark.format,
                    BUNDLE_FORMAT);
    if (mark.size != about.st_size)
        return fail(why, STATUS_BAD_INPUT, "%s: damaged: it has %" PRId64 " bytes of %" PRId64, path, (int64_t)about.st_size, mark.size);
    if (!hash_file(descriptor, mark.size, &hash) || hash != mark.hash)
        return fail(why, STATUS_BAD_INPUT, "%s: damaged: its bytes are not those that were written", path);
    return STATUS_OK;
}

/* A rename lasts through a power cut only once its folder is on disk. Not every file system can do it, so nobody is told. */
static void sync_folder(const char *path)
{
    char folder[4096];
    const char *slash = strrchr(path, '/');
    if ((size_t)snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - path + 1) : 1, slash ? path : ".") >= sizeof folder)
        return;
    int descriptor = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0)
        return;
    (void)!fsync(descriptor);
    close(descriptor);
}

status bundle_write(const bundle *b, const char *path, failure *why)
{
    char temporary[4096];
    if ((size_t)snprintf(temporary, sizeof temporary, "%s.tmp", path) >= sizeof temporary)
        return fail(why, STATUS_BAD_INPUT, "%s: the path is too long", path);
    commit_file *file;
    unlink(temporary); /* what an interrupted write left */
    if (commit_file_create(temporary, SEAL_BLOCK, &file, why) != STATUS_OK)
        return STATUS_ERROR; /* in the middle of a run nothing that the user gave is at fault */
    bool done = true;
    for (int k = 0; k < b->count && done; k++)
        done = write_entry(commit_file_id(file), &b->entry[k]);
    status result = done ? commit_file_flush(file, true, why) : commit_file_failed(file, "written", why);
    commit_file_close(file);
    if (result == STATUS_OK)
        result = write_seal(temporary, why);
    if (result == STATUS_OK && rename(temporary, path) != 0)
        result = fail(why, STATUS_ERROR, "%s: cannot be put in place: %s", path, strerror(errno));
    if (result != STATUS_OK)
        unlink(temporary);
    else
        sync_folder(path);
    return result;
}

/* What the walk over the file's entries carries along. */
typedef struct reading {
    bundle *into;
    const char *path;
    status result;
    failure *why;
} reading;

static bool matches(hid_t dataset, bundle_type type)
{
    hid_t stored = H5Dget_type(dataset);
    bool same = H5Tequal(stored, stored_type(type)) > 0;
    H5Tclose(stored);
    return same;
}

static status read_entry(hid_t dataset, const char *name, reading *r)
{
    hsize_t extent[H5S_MAX_RANK] = {0};
    int type;
    if (!read_int_attribute(dataset, "type", &type) || type < BUNDLE_F64 || type > BUNDLE_TEXT || !matches(dataset, (bundle_type)type))
        return fail(r->why, STATUS_BAD_INPUT, "%s: entry '%s' is damaged: its type cannot be told", r->path, name);
    hid_t space = H5Dget_space(dataset);
    int rank = H5Sget_simple_extent_dims(space, extent, NULL);
    H5Sclose(space);
    int wanted = type == BUNDLE_TEXT ? 1 : 2;
    if (rank != wanted || strlen(name) >= sizeof r->into->entry->name)
        return fail(r->why, STATUS_BAD_INPUT, "%s: entry '%s' is damaged: it has %d dimensions in place of %d", r->path, name, rank,
                    wanted);
    int64_t rows = (int64_t)extent[0], columns = rank > 1 ? (int64_t)extent[1] : 1;
    /* A damaged size must not ask for all the memory there is: the values must be in the file. */
    size_t bytes = entry_bytes((bundle_type)type, rows, columns);
    if (bytes == SIZE_MAX || H5Dget_storage_size(dataset) != bytes)
        return fail(r->why, STATUS_BAD_INPUT, "%s: entry '%s' is damaged: its values are not all there", r->path, name);
    bundle_entry *entry = grow(r->into, name, (bundle_type)type, rows, columns);
    if (!entry)
        return fail(r->why, STATUS_ERROR, "%s: no memory for entry '%s' (%zu bytes)", r->path, name, bytes);
    if (bytes > 0 && H5Dread(dataset, memory_type((bundle_type)type), H5S_ALL, H5S_ALL, H5P_DEFAULT, entry->data) < 0)
        return fail(r->why, STATUS_BAD_INPUT, "%s: entry '%s' is damaged: its values cannot be read", r->path, name);
    return STATUS_OK;
}

static herr_t visit(hid_t file, const char *name, const H5L_info_t *about, void *context)
{
    reading *r = context;
    hid_t object = about->type == H5L_TYPE_HARD ? H5Oopen(file, name, H5P_DEFAULT) : -1;
    if (object >= 0 && H5Iget_type(object) == H5I_DATASET)
        r->result = read_entry(object, name, r);
    else if (object < 0 || H5Iget_type(object) != H5I_GROUP)
        r->result = fail(r->why, STATUS_BAD_INPUT, "%s: entry '%s' is damaged: it is not an array", r->path, name);
    if (object >= 0)
        H5Oclose(object);
    return r->result == STATUS_OK ? 0 : 1;
}

status bundle_read(const char *path, bundle *out, failure *why)
{
    bundle_init(out);
    hdf5_quiet();
    int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    if (descriptor < 0)
        return fail(why, STATUS_BAD_INPUT, "%s: cannot be opened: %s", path, strerror(errno));
    status result = check_seal(descriptor, path, why);
    close(descriptor);
    TRY(result);
    hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0) {
        char reason[256];
        hdf5_reason(reason, sizeof reason);
        return fail(why, STATUS_BAD_INPUT, "%s: cannot be read: %s", path, reason);
    }
    reading r = {out, path, STATUS_OK, why};
    if (H5Lvisit(file, H5_INDEX_NAME, H5_ITER_INC, visit, &r) < 0 && r.result == STATUS_OK)
        r.result = fail(why, STATUS_BAD_INPUT, "%s: damaged: its entries cannot be listed", path);
    H5Fclose(file);
    if (r.result != STATUS_OK)
        bundle_free(out);
    return r.result;
}
