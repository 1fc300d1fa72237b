/* A dataset whose first dimension grows: one row for a frame, an observable's sample, or a contact. */
#ifndef CLAST_HOST_SERIES_H
#define CLAST_HOST_SERIES_H
#include <hdf5.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct series {
    hid_t dataset; /* 0: none */
    hid_t type;    /* in memory */
    int rank;      /* 1 to 3 */
    hsize_t row[2]; /* the other dimensions */
    int64_t rows;
} series;

/* Each returns false on failure and leaves the reason on the error stack. `chunk_rows` 0: as many as suit rows of that size. The dataset
 * is not linked yet when `name` is NULL. */
bool series_create(series *s, hid_t parent, const char *name, hid_t file_type, hid_t memory_type, int rank, const hsize_t *row,
                   int64_t chunk_rows, const char *unit);
/* Fails when the dataset is absent or of another kind or shape. */
bool series_open(series *s, hid_t parent, const char *name, hid_t memory_type, int rank, const hsize_t *row);
bool series_append(series *s, int64_t count, const void *data);
bool series_cut(series *s, int64_t rows);
/* Reads rows [first, first + count). */
bool series_read(const series *s, int64_t first, int64_t count, void *data);

#endif
