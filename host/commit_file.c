#include "commit_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

/* Bytes that change the last commit, waiting for the flush. */
typedef struct piece {
    off_t at;
    size_t size;
    unsigned char *bytes;
    int order; /* as written */
} piece;

struct commit_file {
    char *path;
    int descriptor;
    int error;    /* errno of the first write that failed; all later ones are dropped */
    bool to_disk; /* the next flush ends with fsync */
    bool discard; /* closing: what libhdf5 still writes is not wanted */
    hid_t driver, file;
    off_t committed; /* size of the file at the last flush: bytes below belong to it */
    int count, capacity;
    piece *waiting;
    bool overlapping; /* some of them may overlap */
    bool cutting;     /* rows are taken away */
};

typedef struct driver_file {
    H5FD_t base; /* first: libhdf5 sees only this */
    commit_file *owner;
    haddr_t end_allocated, end_written;
} driver_file;

static bool put(commit_file *file, off_t at, const unsigned char *bytes, size_t size)
{
    while (size > 0) {
        ssize_t done = pwrite(file->descriptor, bytes, size, at);
        if (done < 0 && errno == EINTR)
            continue;
        if (done <= 0) {
            file->error = done < 0 ? errno : ENOSPC;
            return false;
        }
        at += done;
        bytes += done;
        size -= (size_t)done;
    }
    return true;
}

/* True when the bytes replace a waiting piece. More pieces than this wait only when much is cut; what they replace is found at the flush. */
static bool replaced(commit_file *file, off_t at, const unsigned char *bytes, size_t size)
{
    if (file->count > 4096)
        file->overlapping = true;
    for (int k = 0; k < file->count && !file->overlapping; k++) {
        piece *p = &file->waiting[k];
        if (p->at == at && p->size == size) {
            memcpy(p->bytes, bytes, size);
            return true;
        }
        if (p->at < at + (off_t)size && at < p->at + (off_t)p->size)
            file->overlapping = true;
    }
    return false;
}

static bool keep(commit_file *file, off_t at, const unsigned char *bytes, size_t size)
{
    if (replaced(file, at, bytes, size))
        return true;
    if (file->count == file->capacity) {
        int capacity = file->capacity ? 2 * file->capacity : 64;
        piece *grown = realloc(file->waiting, (size_t)capacity * sizeof *grown);
        if (!grown) {
            file->error = ENOMEM;
            return false;
        }
        file->waiting = grown;
        file->capacity = capacity;
    }
    unsigned char *copy = malloc(size);
    if (!copy) {
        file->error = ENOMEM;
        return false;
    }
    memcpy(copy, bytes, size);
    file->waiting[file->count] = (piece){at, size, copy, file->count};
    file->count++;
    return true;
}

static void forget(commit_file *file)
{
    for (int k = 0; k < file->count; k++)
        free(file->waiting[k].bytes);
    file->count = 0;
    file->overlapping = false;
}

/* ---- pieces that overlap ---- */

static int by_address(const void *a, const void *b)
{
    const piece *p = *(const piece *const *)a, *q = *(const piece *const *)b;
    return p->at != q->at ? (p->at < q->at ? -1 : 1) : p->order - q->order;
}

/* The stretch of `count`, sorted by address and apart from each other, that holds the address. */
static piece *stretch_at(piece *stretch, int count, off_t at)
{
    int low = 0, high = count - 1;
    while (low < high) {
        int middle = (low + high + 1) / 2;
        if (stretch[middle].at <= at)
            low = middle;
        else
            high = middle - 1;
    }
    return &stretch[low];
}

/* Makes one piece of all that overlap, with the bytes that were written last, so that the pieces may go out in any order. */
static bool merge(commit_file *file)
{
    int count = 0;
    size_t n = (size_t)file->count;
    piece **sorted = malloc(n * sizeof *sorted), *stretch = calloc(n, sizeof *stretch);
    bool done = sorted && stretch;
    for (int k = 0; done && k < file->count; k++)
        sorted[k] = &file->waiting[k];
    if (done)
        qsort(sorted, n, sizeof *sorted, by_address);
    for (int k = 0; done && k < file->count; k++) {
        const piece *p = sorted[k];
        piece *last = count > 0 ? &stretch[count - 1] : NULL;
        off_t end = p->at + (off_t)p->size;
        if (last && p->at < last->at + (off_t)last->size)
            last->size = end > last->at + (off_t)last->size ? (size_t)(end - last->at) : last->size;
        else
            stretch[count++] = (piece){p->at, p->size, NULL, p->order};
    }
    for (int k = 0; done && k < count; k++)
        done = (stretch[k].bytes = malloc(stretch[k].size)) != NULL;
    for (int k = 0; done && k < file->count; k++) { /* as they came */
        const piece *p = &file->waiting[k];
        piece *into = stretch_at(stretch, count, p->at);
        memcpy(into->bytes + (p->at - into->at), p->bytes, p->size);
    }
    free(sorted);
    if (!done) {
        for (int k = 0; stretch && k < count; k++)
            free(stretch[k].bytes);
        free(stretch);
        file->error = ENOMEM;
        return false;
    }
    forget(file);
    free(file->waiting);
    file->waiting = stretch;
    file->count = count;
    file->capacity = (int)n;
    return true;
}

/* ---- their order ---- */

/* A kill between two of the writes of a commit must not hurt the frames before. So chunk indices come first, parents before children (a
 * split child still holds what its new sibling, already in the file, took over), and then the object headers, whose extents show the
 * new rows. Within these the order of addresses stays: what is created last is committed last. A cut goes the other way round: the extents
 * hide the rows before anything of them goes. */
static int rank(const piece *p)
{
    if (p->size >= 6 && memcmp(p->bytes, "TREE", 4) == 0)
        return 256 - p->bytes[5]; /* the level; leaves are 0 */
    if (p->size >= 4 && (memcmp(p->bytes, "OHDR", 4) == 0 || memcmp(p->bytes, "OCHK", 4) == 0))
        return 257;
    return 0;
}

static int compare(const void *a, const void *b)
{
    const piece *p = a, *q = b;
    int difference = rank(p) - rank(q);
    return difference ? difference : p->order - q->order;
}

static int compare_for_cut(const void *a, const void *b)
{
    return compare(b, a);
}

static bool put_in_order(commit_file *file)
{
    if (file->overlapping && !merge(file))
        return false;
    if (file->count > 1)
        qsort(file->waiting, (size_t)file->count, sizeof *file->waiting, file->cutting ? compare_for_cut : compare);
    return true;
}

static H5FD_t *driver_open(const char *name, unsigned flags, hid_t access, haddr_t largest)
{
    (void)name, (void)flags, (void)largest;
    commit_file *const *owner = H5Pget_driver_info(access);
    driver_file *file = owner ? calloc(1, sizeof *file) : NULL;
    if (!file)
        return NULL;
    file->owner = *owner;
    file->end_written = (haddr_t)file->owner->committed;
    return &file->base;
}

static herr_t driver_close(H5FD_t *base)
{
    free(base);
    return 0;
}

static herr_t driver_query(const H5FD_t *base, unsigned long *flags)
{
    (void)base;
    /* No data sieve: it reads a block to write a row. No accumulator: each write is to be one structure, see rank(). No aggregation: it
     * would place structures without driver_alloc(). */
    *flags = 0;
    return 0;
}

/* A kill stops a write between two pages, never inside one. So a structure that will be rewritten in place must not cross a page. */
static haddr_t driver_alloc(H5FD_t *base, H5FD_mem_t type, hid_t transfer, hsize_t size)
{
    (void)transfer;
    driver_file *file = (driver_file *)base;
    const haddr_t page = 4096;
    haddr_t at = file->end_allocated;
    if (type != H5FD_MEM_DRAW && size <= page && at / page != (at + size - 1) / page)
        at = (at / page + 1) * page;
    file->end_allocated = at + size;
    return at;
}

static haddr_t driver_get_eoa(const H5FD_t *base, H5FD_mem_t type)
{
    (void)type;
    return ((const driver_file *)base)->end_allocated;
}

static herr_t driver_set_eoa(H5FD_t *base, H5FD_mem_t type, haddr_t address)
{
    (void)type;
    ((driver_file *)base)->end_allocated = address;
    return 0;
}

static haddr_t driver_get_eof(const H5FD_t *base, H5FD_mem_t type)
{
    (void)type;
    return ((const driver_file *)base)->end_written;
}

static herr_t driver_read(H5FD_t *base, H5FD_mem_t type, hid_t transfer, haddr_t address, size_t size, void *buffer)
{
    (void)type, (void)transfer;
    const commit_file *file = ((driver_file *)base)->owner;
    unsigned char *bytes = buffer;
    size_t have = 0;
    while (have < size) {
        ssize_t done = pread(file->descriptor, bytes + have, size - have, (off_t)(address + have));
        if (done < 0 && errno == EINTR)
            continue;
        if (done < 0)
            return -1;
        if (done == 0)
            break;
        have += (size_t)done;
    }
    memset(bytes + have, 0, size - have); /* beyond the end: allocated, not yet written */
    off_t low = (off_t)address, high = low + (off_t)size;
    for (int k = 0; k < file->count; k++) {
        const piece *p = &file->waiting[k];
        off_t from = p->at > low ? p->at : low, to = p->at + (off_t)p->size < high ? p->at + (off_t)p->size : high;
        if (from < to)
            memcpy(bytes + (from - low), p->bytes + (from - p->at), (size_t)(to - from));
    }
    return 0;
}

static herr_t driver_write(H5FD_t *base, H5FD_mem_t type, hid_t transfer, haddr_t address, size_t size, const void *buffer)
{
    (void)transfer;
    driver_file *handle = (driver_file *)base;
    commit_file *file = handle->owner;
    if (address + size > handle->end_written)
        handle->end_written = address + size;
    if (file->discard || file->error)
        return 0; /* the first failure has been told; libhdf5 would never stop trying to write the rest */
    off_t at = (off_t)address;
    size_t old = at < file->committed ? (size_t)(file->committed - at) : 0;
    if (type == H5FD_MEM_DRAW && !file->cutting)
        old = 0;
    if (old > size)
        old = size;
    if (old > 0 && !keep(file, at, buffer, old))
        return -1;
    return put(file, at + (off_t)old, (const unsigned char *)buffer + old, size - old) ? 0 : -1;
}

static herr_t driver_truncate(H5FD_t *base, hid_t transfer, hbool_t closing)
{
    (void)transfer, (void)closing;
    driver_file *handle = (driver_file *)base;
    commit_file *file = handle->owner;
    /* Growing makes the file as long as its superblock will say. Shrinking waits: the last commit may own the tail. */
    if (!file->discard && !file->error && handle->end_allocated > handle->end_written) {
        if (ftruncate(file->descriptor, (off_t)handle->end_allocated) != 0) {
            file->error = errno;
            return -1;
        }
    }
    handle->end_written = handle->end_allocated;
    return 0;
}

static herr_t driver_flush(H5FD_t *base, hid_t transfer, hbool_t closing)
{
    (void)transfer, (void)closing;
    driver_file *handle = (driver_file *)base;
    commit_file *file = handle->owner;
    if (file->discard || file->error)
        return 0;
    if (!put_in_order(file))
        return -1;
    if (file->to_disk && fsync(file->descriptor) != 0)
        file->error = errno;
    /* From the first of these on the file may say that the new tail belongs to it: should one of them fail, the tail must stay. */
    off_t before = file->committed;
    if (!file->error && (off_t)handle->end_allocated > file->committed)
        file->committed = (off_t)handle->end_allocated;
    for (int k = 0; k < file->count && !file->error; k++)
        put(file, file->waiting[k].at, file->waiting[k].bytes, file->waiting[k].size);
    if (!file->error && (off_t)handle->end_allocated < before)
        if (ftruncate(file->descriptor, (off_t)handle->end_allocated) != 0)
            file->error = errno;
    if (!file->error && file->to_disk && fsync(file->descriptor) != 0)
        file->error = errno;
    if (file->error)
        return -1;
    forget(file);
    file->cutting = false;
    file->committed = (off_t)handle->end_allocated;
    return 0;
}

static hid_t access_list(commit_file *file)
{
    static const H5FD_class_t class = {
#ifdef H5FD_CLASS_VERSION
        .version = H5FD_CLASS_VERSION,
        .value = (H5FD_class_value_t)530, /* below 512 is reserved for the library */
#endif
        .name = "clast_commit",
        .maxaddr = (haddr_t)INT64_MAX,
        .fc_degree = H5F_CLOSE_STRONG, /* a handle left open must not keep the file open */
        .fapl_size = sizeof(commit_file *),
        .open = driver_open,
        .close = driver_close,
        .query = driver_query,
        .alloc = driver_alloc,
        .get_eoa = driver_get_eoa,
        .set_eoa = driver_set_eoa,
        .get_eof = driver_get_eof,
        .read = driver_read,
        .write = driver_write,
        .flush = driver_flush,
        .truncate = driver_truncate,
        .fl_map = H5FD_FLMAP_DICHOTOMY,
    };
    file->driver = H5FDregister(&class);
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    /* The 1.8 format: checksums on metadata, read by every library since 2008, and no "open for writing" mark that would make a killed
     * file refuse to open. */
    if (file->driver < 0 || H5Pset_driver(access, file->driver, &file) < 0 ||
        H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18) < 0) {
        H5Pclose(access);
        return -1;
    }
    return access;
}

/* The superblock is written last, so a file that was killed while it was created begins with a hole. */
static bool never_finished(int descriptor)
{
    static const char hole[48]; /* its size */
    char start[sizeof hole];
    return pread(descriptor, start, sizeof start, 0) == (ssize_t)sizeof start && memcmp(start, hole, sizeof hole) == 0;
}

/* Opens the descriptor; refuses what is not ours to overwrite and what another process is writing. */
static status take(commit_file *file, bool create, failure *why)
{
    const char *verb = create ? "created" : "opened for writing";
    file->descriptor = open(file->path, O_RDWR | O_CLOEXEC | (create ? O_CREAT : 0), 0666);
    if (file->descriptor < 0) {
        if (errno != ENOENT || !create)
            return fail(why, STATUS_BAD_INPUT, "%s: cannot be %s: %s", file->path, verb, strerror(errno));
        const char *slash = strrchr(file->path, '/');
        char folder[4096];
        snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - file->path) + 1 : 1, slash ? file->path : ".");
        if (access(folder, F_OK) == 0)
            return fail(why, STATUS_BAD_INPUT, "%s: cannot be created: the folder takes no files", file->path);
        return fail(why, STATUS_BAD_INPUT, "%s: cannot be created: there is no folder %.*s", file->path,
                    slash ? (int)(slash - file->path) : 1, slash ? file->path : ".");
    }
    struct stat about;
    if (fstat(file->descriptor, &about) != 0 || !S_ISREG(about.st_mode))
        return fail(why, STATUS_BAD_INPUT, "%s: cannot be %s: it is not a regular file", file->path, verb);
    /* An open-file lock: seen by another writer only, while HDF5 readers, which use flock, may watch a running simulation. */
    struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    if (fcntl(file->descriptor, F_OFD_SETLK, &lock) != 0 && (errno == EAGAIN || errno == EACCES))
        return fail(why, STATUS_BAD_INPUT, "%s: another run is writing this file", file->path);
    if (about.st_size > 0 && !hdf5_signature(file->descriptor) && !(create && never_finished(file->descriptor)))
        return fail(why, STATUS_BAD_INPUT,
                    create ? "%s: exists and is not an HDF5 file: not overwritten; give another name" : "%s: not an HDF5 file", file->path);
    if (create && ftruncate(file->descriptor, 0) != 0)
        return fail(why, STATUS_BAD_INPUT, "%s: cannot be emptied: %s", file->path, strerror(errno));
    file->committed = create ? 0 : about.st_size;
    return STATUS_OK;
}

/* The driver ignores the flags and uses the descriptor: the name only serves libhdf5's own bookkeeping. */
static hid_t open_hdf5(const char *path, bool create, size_t user_block, hid_t access)
{
    if (!create)
        return H5Fopen(path, H5F_ACC_RDWR, access);
    hid_t creation = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_userblock(creation, user_block);
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, creation, access);
    H5Pclose(creation);
    return file;
}

static status begin(const char *path, bool create, size_t user_block, commit_file **out, failure *why)
{
    hdf5_quiet();
    *out = NULL;
    commit_file *file = calloc(1, sizeof *file);
    if (!file)
        return fail(why, STATUS_ERROR, "%s: out of memory", path);
    *file = (commit_file){.path = strdup(path), .descriptor = -1, .driver = -1, .file = -1};
    status result = take(file, create, why);
    if (result == STATUS_OK) {
        hid_t access = access_list(file);
        file->file = open_hdf5(path, create, user_block, access);
        if (file->file < 0) {
            char reason[256];
            hdf5_reason(reason, sizeof reason);
            result = fail(why, STATUS_BAD_INPUT, "%s: cannot be %s: %s", path, create ? "created" : "opened for writing",
                          file->error ? strerror(file->error) : reason);
        }
        if (access >= 0)
            H5Pclose(access);
    }
    if (result != STATUS_OK) {
        commit_file_close(file);
        return result;
    }
    *out = file;
    return STATUS_OK;
}

status commit_file_create(const char *path, size_t user_block, commit_file **out, failure *why)
{
    return begin(path, true, user_block, out, why);
}

status commit_file_open(const char *path, commit_file **out, failure *why)
{
    return begin(path, false, 0, out, why);
}

hid_t commit_file_id(const commit_file *file)
{
    return file->file;
}

void commit_file_begin_cut(commit_file *file)
{
    file->cutting = true;
}

status commit_file_flush(commit_file *file, bool to_disk, failure *why)
{
    file->to_disk = to_disk;
    if (H5Fflush(file->file, H5F_SCOPE_GLOBAL) < 0 || file->error)
        return commit_file_failed(file, "written", why);
    return STATUS_OK;
}

status commit_file_failed(commit_file *file, const char *doing, failure *why)
{
    char reason[256];
    hdf5_reason(reason, sizeof reason);
    if (!file->error)
        file->error = EIO; /* libhdf5 is in doubt, so nothing more may reach the file */
    else
        snprintf(reason, sizeof reason, "%s", strerror(file->error));
    return fail(why, STATUS_ERROR, "%s: cannot be %s: %s", file->path, doing, reason);
}

void commit_file_close(commit_file *file)
{
    if (!file)
        return;
    file->discard = true;
    if (file->file >= 0)
        H5Fclose(file->file);
    if (file->driver >= 0)
        H5FDunregister(file->driver);
    if (file->descriptor >= 0) {
        struct stat about; /* what an interrupted write left behind the last commit is given back */
        if (file->file >= 0 && fstat(file->descriptor, &about) == 0 && about.st_size > file->committed &&
            ftruncate(file->descriptor, file->committed) != 0)
            file->error = errno;
        close(file->descriptor);
    }
    forget(file);
    free(file->waiting);
    free(file->path);
    free(file);
}
