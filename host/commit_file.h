/* An HDF5 file that is always whole: a file driver of our own below libhdf5.
 *
 * libhdf5 rewrites its own structures (headers, chunk indices, the superblock) in place. Stopped in between by a kill or a full disk,
 * such a file may not open again. Here new bytes go to the end of the file at once, while everything that would change bytes of the last
 * commit waits in memory until the flush. A write that fails leaves the last commit untouched, and from then on the driver drops all
 * writes, so that libhdf5 can be closed in peace, which it otherwise cannot (it keeps trying, at exit too).
 * Chunk data is exempt: it lands in rows that the last commit does not know of, except while rows are cut. */
#ifndef CLAST_HOST_COMMIT_FILE_H
#define CLAST_HOST_COMMIT_FILE_H
#include "hdf5_common.h"

typedef struct commit_file commit_file;

/* Replaces a file of that name, but only an HDF5 file or an empty one. The first `user_block` bytes (0, or a power of two from 512 on) are
 * left to the caller. Fails with STATUS_BAD_INPUT. */
status commit_file_create(const char *path, size_t user_block, commit_file **out, failure *why);
/* Opens for reading and writing. */
status commit_file_open(const char *path, commit_file **out, failure *why);
hid_t commit_file_id(const commit_file *file);
/* What comes until the next flush takes rows away: the last commit knows of these rows, so chunk data waits as well, and the flush goes the
 * other way round, extents first. */
void commit_file_begin_cut(commit_file *file);
/* Everything written so far becomes the file. With `to_disk` it also survives a power cut. */
status commit_file_flush(commit_file *file, bool to_disk, failure *why);
/* A STATUS_ERROR with the path and why the last call to libhdf5 failed; the file stays at its last commit. */
status commit_file_failed(commit_file *file, const char *doing, failure *why);
/* Closes without committing what is not yet flushed. Handles still open into the file are closed too. NULL is allowed. */
void commit_file_close(commit_file *file);

#endif
