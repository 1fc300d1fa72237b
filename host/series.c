#include "series.h"

#include "hdf5_common.h"

static int64_t at_least(int64_t value, int64_t low)
{
    return value < low ? low : value;
}

/* Some 64 KiB a chunk for small rows, at most 1024 rows; rows past 4 MiB are cut into equal parts. */
static void choose_chunk(const series *s, int64_t chunk_rows, hsize_t chunk[3])
{
    const int64_t small = 64 << 10, large = 4 << 20;
    int64_t item = (int64_t)H5Tget_size(s->type) * (s->rank > 2 ? (int64_t)s->row[1] : 1);
    int64_t wide = s->rank > 1 ? (int64_t)s->row[0] : 1, bytes = at_least(item * wide, 1);
    int64_t parts = (bytes + large - 1) / large;
    if (chunk_rows == 0)
        chunk_rows = small / bytes > 1024 ? 1024 : at_least(small / bytes, 1);
    chunk[0] = (hsize_t)chunk_rows;
    chunk[1] = (hsize_t)at_least((wide + parts - 1) / parts, 1);
    chunk[2] = s->rank > 2 ? s->row[1] : 1;
}

/* Rows go straight to the file: with libhdf5's chunk cache every flush would write whole chunks again. */
static hid_t uncached(void)
{
    hid_t access = H5Pcreate(H5P_DATASET_ACCESS);
    H5Pset_chunk_cache(access, 0, 0, H5D_CHUNK_CACHE_W0_DEFAULT);
    return access;
}

bool series_create(series *s, hid_t parent, const char *name, hid_t file_type, hid_t memory_type, int rank, const hsize_t *row,
                   int64_t chunk_rows, const char *unit)
{
    *s = (series){.type = memory_type, .rank = rank};
    hsize_t now[3] = {0, 1, 1}, most[3] = {H5S_UNLIMITED, 1, 1}, chunk[3];
    for (int k = 1; k < rank; k++) {
        s->row[k - 1] = row[k - 1];
        now[k] = row[k - 1];
        most[k] = row[k - 1] ? row[k - 1] : H5S_UNLIMITED; /* a chunk must fit in the largest extent */
    }
    choose_chunk(s, chunk_rows, chunk);
    hid_t space = H5Screate_simple(rank, now, most), creation = H5Pcreate(H5P_DATASET_CREATE), access = uncached();
    H5Pset_chunk(creation, rank, chunk);
    H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER); /* every row is written before the extent that shows it is committed */
    H5Pset_obj_track_times(creation, false);
    s->dataset = name ? H5Dcreate2(parent, name, file_type, space, H5P_DEFAULT, creation, access) :
                        H5Dcreate_anon(parent, file_type, space, creation, access);
    H5Pclose(access);
    H5Pclose(creation);
    H5Sclose(space);
    return s->dataset >= 0 && (!unit || !*unit || hdf5_text_attribute(s->dataset, "unit", unit));
}

bool series_open(series *s, hid_t parent, const char *name, hid_t memory_type, int rank, const hsize_t *row)
{
    *s = (series){.type = memory_type, .rank = rank};
    hid_t access = uncached();
    s->dataset = H5Dopen2(parent, name, access);
    H5Pclose(access);
    if (s->dataset < 0)
        return false;
    hid_t space = H5Dget_space(s->dataset), type = H5Dget_type(s->dataset);
    hsize_t now[H5S_MAX_RANK] = {0};
    bool same = H5Sget_simple_extent_ndims(space) == rank && H5Sget_simple_extent_dims(space, now, NULL) == rank &&
                H5Tget_class(type) == H5Tget_class(memory_type);
    for (int k = 1; k < rank && same; k++) {
        s->row[k - 1] = row[k - 1];
        same = now[k] == row[k - 1];
    }
    s->rows = (int64_t)now[0];
    H5Tclose(type);
    H5Sclose(space);
    return same;
}

static bool transfer(const series *s, int64_t first, int64_t count, const void *write, void *read)
{
    hsize_t start[3] = {(hsize_t)first, 0, 0}, block[3] = {(hsize_t)count, s->row[0], s->row[1]};
    hid_t space = H5Dget_space(s->dataset), memory = H5Screate_simple(s->rank, block, NULL);
    bool done = space >= 0 && memory >= 0 && H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, block, NULL) >= 0;
    if (done && write)
        done = H5Dwrite(s->dataset, s->type, memory, space, H5P_DEFAULT, write) >= 0;
    else if (done)
        done = H5Dread(s->dataset, s->type, memory, space, H5P_DEFAULT, read) >= 0;
    H5Sclose(memory);
    H5Sclose(space);
    return done;
}

static bool empty_row(const series *s)
{
    return (s->rank > 1 && s->row[0] == 0) || (s->rank > 2 && s->row[1] == 0);
}

bool series_append(series *s, int64_t count, const void *data)
{
    if (count == 0)
        return true;
    hsize_t extent[3] = {(hsize_t)(s->rows + count), s->row[0], s->row[1]};
    if (H5Dset_extent(s->dataset, extent) < 0 || (!empty_row(s) && !transfer(s, s->rows, count, data, NULL)))
        return false;
    s->rows += count;
    return true;
}

bool series_cut(series *s, int64_t rows)
{
    if (rows >= s->rows)
        return true;
    hsize_t extent[3] = {(hsize_t)rows, s->row[0], s->row[1]};
    s->rows = rows;
    return H5Dset_extent(s->dataset, extent) >= 0;
}

bool series_read(const series *s, int64_t first, int64_t count, void *data)
{
    return count == 0 || empty_row(s) || transfer(s, first, count, NULL, data);
}
