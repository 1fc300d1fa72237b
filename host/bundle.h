/* Named arrays in one HDF5 file: what a checkpoint is made of. Written to a temporary name, flushed to disk and renamed, so that the
 * file under the final name is always whole. */
#ifndef CLAST_HOST_BUNDLE_H
#define CLAST_HOST_BUNDLE_H
#include "status.h"

#include <stdint.h>

typedef enum bundle_type { BUNDLE_F64, BUNDLE_I64, BUNDLE_I32, BUNDLE_TEXT } bundle_type;

typedef struct bundle_entry {
    char name[64];
    bundle_type type;
    int64_t rows, columns; /* text: rows is the length */
    void *data;            /* owned by the bundle */
} bundle_entry;

typedef struct bundle {
    int count, capacity;
    bundle_entry *entry;
} bundle;

void bundle_init(bundle *b);
void bundle_free(bundle *b);
/* Adds an array (copied when `data` is not NULL, else zeroed) and returns its storage. Aborts on out of memory. */
void *bundle_add(bundle *b, const char *name, bundle_type type, int64_t rows, int64_t columns, const void *data);
void bundle_add_text(bundle *b, const char *name, const char *text);
void bundle_add_f64(bundle *b, const char *name, double value);
void bundle_add_i64(bundle *b, const char *name, int64_t value);
/* NULL when absent. */
const bundle_entry *bundle_find(const bundle *b, const char *name);
/* Fail with STATUS_BAD_INPUT naming file and entry when absent or of another type or size (rows or columns -1: any). */
status bundle_get(const bundle *b, const char *path, const char *name, bundle_type type, int64_t rows, int64_t columns, const bundle_entry **out,
                  failure *why);
status bundle_write(const bundle *b, const char *path, failure *why);
/* A missing, truncated or foreign file is one clear message and STATUS_BAD_INPUT. */
status bundle_read(const char *path, bundle *out, failure *why);

#endif
