#include "results_layout.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifndef CLAST_VERSION
#define CLAST_VERSION "unknown"
#endif

static hid_t group(hid_t parent, const char *path)
{
    hid_t links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    hid_t made = H5Lexists(parent, path, H5P_DEFAULT) > 0 ? H5Gopen2(parent, path, H5P_DEFAULT) :
                                                            H5Gcreate2(parent, path, links, H5P_DEFAULT, H5P_DEFAULT);
    H5Pclose(links);
    return made;
}

/* H5Lexists needs every group on the way. */
static hid_t group_at(hid_t file, const char *path)
{
    char part[512];
    hid_t made = -1;
    for (const char *end = path; *end;) {
        end += strcspn(end + 1, "/") + 1;
        snprintf(part, sizeof part, "%.*s", (int)(end - path), path);
        if (made >= 0)
            H5Gclose(made);
        made = group(file, part);
    }
    return made;
}

static bool int_attribute(hid_t object, const char *name, int count, const int *value)
{
    hsize_t extent = (hsize_t)count;
    hid_t space = count > 1 ? H5Screate_simple(1, &extent, NULL) : H5Screate(H5S_SCALAR);
    hid_t attribute = H5Acreate2(object, name, H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT);
    bool done = attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_INT, value) >= 0;
    if (attribute >= 0)
        H5Aclose(attribute);
    H5Sclose(space);
    return done;
}

static bool header(hid_t file)
{
    const int version[2] = {1, 1};
    const char *author = getenv("LOGNAME");
    hid_t top = group_at(file, "/h5md"), by = group_at(file, "/h5md/author"), with = group_at(file, "/h5md/creator");
    bool done = int_attribute(top, "version", 2, version) && hdf5_text_attribute(by, "name", author && *author ? author : "unknown") &&
                hdf5_text_attribute(with, "name", "clast") && hdf5_text_attribute(with, "version", CLAST_VERSION);
    H5Gclose(top);
    H5Gclose(by);
    H5Gclose(with);
    return done;
}

static bool vector_dataset(hid_t parent, const char *name, int count, const double *value)
{
    hsize_t extent = (hsize_t)count;
    hid_t space = H5Screate_simple(1, &extent, NULL), creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(creation, false);
    hid_t dataset = H5Dcreate2(parent, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    bool done = dataset >= 0 && H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0 &&
                hdf5_text_attribute(dataset, "unit", "m");
    if (dataset >= 0)
        H5Dclose(dataset);
    H5Pclose(creation);
    H5Sclose(space);
    return done;
}

/* H5MD wants the box even where there is none: then no direction repeats and the edges are left out. Positions always have three
 * components, so a two-dimensional scene, too, has a box of dimension 3. H5MD puts a box's corner at the origin; ours is in `offset`. */
static bool box(hid_t file, const results_spec *spec)
{
    hid_t made = group_at(file, "/particles/all/box");
    const int dimension = 3;
    char boundary[3][8] = {{0}}; /* filled up with zeros; the longer word leaves no room for one */
    for (int k = 0; k < 3; k++) {
        const char *word = spec->box_given && spec->periodic[k] ? "periodic" : "none";
        memcpy(boundary[k], word, strlen(word));
    }
    hsize_t extent = 3;
    hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate_simple(1, &extent, NULL);
    H5Tset_size(type, sizeof boundary[0]);
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    hid_t attribute = H5Acreate2(made, "boundary", type, space, H5P_DEFAULT, H5P_DEFAULT);
    bool done = int_attribute(made, "dimension", 1, &dimension) && attribute >= 0 && H5Awrite(attribute, type, boundary) >= 0;
    if (spec->box_given) {
        double edges[3];
        for (int k = 0; k < 3; k++)
            edges[k] = spec->box_high[k] - spec->box_low[k];
        done = done && vector_dataset(made, "edges", 3, edges) && vector_dataset(made, "offset", 3, spec->box_low);
    }
    H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(type);
    H5Gclose(made);
    return done;
}

static bool clock_create(clock_series *clock, hid_t file)
{
    return series_create(&clock->time, file, NULL, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 1, NULL, 1024, "s") &&
           series_create(&clock->step, file, NULL, H5T_STD_I64LE, H5T_NATIVE_INT64, 1, NULL, 1024, NULL);
}

static bool clock_link(const clock_series *clock, hid_t file, const char *element)
{
    char step[520], time[520];
    snprintf(step, sizeof step, "%s/step", element);
    snprintf(time, sizeof time, "%s/time", element);
    return H5Olink(clock->step.dataset, file, step, H5P_DEFAULT, H5P_DEFAULT) >= 0 &&
           H5Olink(clock->time.dataset, file, time, H5P_DEFAULT, H5P_DEFAULT) >= 0;
}

/* The clocks are created last and so committed last (commit_file.c): a step that is in the file has its row in every dataset. */
static bool clocks_create(results *r, hid_t file)
{
    bool done = clock_create(&r->frames, file) && clock_create(&r->samples, file);
    char element[512]; /* names come from the scene's keys and walls, far shorter */
    for (int k = 0; k < r->field_count && done; k++) {
        snprintf(element, sizeof element, "/particles/all/%s", r->field[k].name);
        done = r->field[k].constant || clock_link(&r->frames, file, element);
    }
    for (int k = 0; k < r->observable_count && done; k++) {
        snprintf(element, sizeof element, "/observables/%s", r->observable[k].name);
        done = clock_link(&r->samples, file, element);
    }
    return done && (!r->contacts || clock_link(&r->frames, file, "/contacts"));
}

static void field_shape(const results *r, int k, int *rank, hsize_t row[2])
{
    const results_field *field = &r->field[k];
    row[0] = (hsize_t)r->count;
    row[1] = (hsize_t)field->components;
    *rank = field->components > 1 ? 3 : 2;
}

static bool constant_create(results *r, int k, hid_t parent)
{
    const results_field *field = &r->field[k];
    int rank;
    hsize_t row[2];
    field_shape(r, k, &rank, row);
    hid_t space = H5Screate_simple(rank - 1, row, NULL), creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(creation, false);
    hid_t type = field->integer ? H5T_STD_I32LE : H5T_IEEE_F64LE;
    hid_t dataset = H5Dcreate2(parent, field->name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    r->field_series[k] = (series){.dataset = dataset, .type = field->integer ? H5T_NATIVE_INT32 : H5T_NATIVE_DOUBLE};
    H5Pclose(creation);
    H5Sclose(space);
    return dataset >= 0 && (!field->unit || !*field->unit || hdf5_text_attribute(dataset, "unit", field->unit));
}

static bool fields_create(results *r, hid_t file)
{
    hid_t all = group_at(file, "/particles/all");
    bool done = all >= 0;
    for (int k = 0; k < r->field_count && done; k++) {
        const results_field *field = &r->field[k];
        if (field->constant) {
            done = constant_create(r, k, all);
            continue;
        }
        int rank;
        hsize_t row[2];
        field_shape(r, k, &rank, row);
        hid_t element = group(all, field->name);
        done = series_create(&r->field_series[k], element, "value", field->integer ? H5T_STD_I32LE : H5T_IEEE_F64LE,
                             field->integer ? H5T_NATIVE_INT32 : H5T_NATIVE_DOUBLE, rank, row, 0, field->unit);
        H5Gclose(element);
    }
    H5Gclose(all);
    return done;
}

static bool observables_create(results *r, hid_t file)
{
    bool done = true;
    for (int k = 0; k < r->observable_count && done; k++) {
        const results_observable *observable = &r->observable[k];
        char path[512];
        snprintf(path, sizeof path, "/observables/%s", observable->name);
        hid_t element = group_at(file, path);
        hsize_t components = (hsize_t)observable->components;
        done = series_create(&r->observable_series[k], element, "value", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, components > 1 ? 2 : 1,
                             &components, RESULTS_PENDING_MAX, observable->unit);
        H5Gclose(element);
    }
    return done;
}

/* One list for creating and opening. */
typedef struct contact_column {
    const char *name, *unit;
    size_t at;
    bool integer;
    int components;
} contact_column;

#define COLUMN(member, unit, integer, components) {#member, unit, offsetof(contact_series, member), integer, components}
static const contact_column contact_columns[] = {
    COLUMN(i, "", true, 1),       COLUMN(j, "", true, 1),       COLUMN(wall, "", true, 1),
    COLUMN(overlap, "m", false, 1), COLUMN(area, "m^2", false, 1), COLUMN(force, "N", false, 3),
    COLUMN(heat, "W", false, 1),  COLUMN(bonded, "", true, 1),
};
enum { CONTACT_COLUMNS = sizeof contact_columns / sizeof contact_columns[0] };

static series *column_series(results *r, const contact_column *column)
{
    return (series *)((char *)&r->contact + column->at);
}

static bool contacts_create(results *r, hid_t file)
{
    hid_t parent = group_at(file, "/contacts");
    int64_t chunk = 3 * r->count < 256 ? 256 : 3 * r->count > 131072 ? 131072 : 3 * r->count; /* some three contacts a particle */
    const hsize_t three = 3;
    bool done = series_create(&r->contact.offset, parent, "offset", H5T_STD_I64LE, H5T_NATIVE_INT64, 1, NULL, 1024, NULL);
    for (int k = 0; k < CONTACT_COLUMNS && done; k++) {
        const contact_column *c = &contact_columns[k];
        done = series_create(column_series(r, c), parent, c->name, c->integer ? H5T_STD_I32LE : H5T_IEEE_F64LE,
                             c->integer ? H5T_NATIVE_INT32 : H5T_NATIVE_DOUBLE, c->components > 1 ? 2 : 1, &three, chunk, c->unit);
    }
    H5Gclose(parent);
    return done;
}

static bool texts_create(hid_t file, const results_spec *spec)
{
    const char *const name[4] = {"scene", "plan", "version", "device"};
    const char *const text[4] = {spec->scene_text, spec->plan_text, spec->version_text, spec->device_text};
    hid_t clast = group_at(file, "/clast");
    bool done = clast >= 0;
    for (int k = 0; k < 4 && done; k++)
        if (text[k])
            done = hdf5_text_dataset(clast, name[k], text[k]);
    H5Gclose(clast);
    return done;
}

bool results_layout_create(results *r, const results_spec *spec)
{
    hid_t file = commit_file_id(r->file);
    bool done = header(file) && box(file, spec);
    hid_t observables = group_at(file, "/observables");
    H5Gclose(observables);
    return done && fields_create(r, file) && observables_create(r, file) && (!r->contacts || contacts_create(r, file)) &&
           texts_create(file, spec) && clocks_create(r, file);
}

/* From the first element that carries it; a new one where no element does. */
static bool clock_open(clock_series *clock, hid_t file, const char *element)
{
    if (!element)
        return clock_create(clock, file);
    hid_t parent = H5Gopen2(file, element, H5P_DEFAULT);
    bool done = parent >= 0 && series_open(&clock->step, parent, "step", H5T_NATIVE_INT64, 1, NULL) &&
                series_open(&clock->time, parent, "time", H5T_NATIVE_DOUBLE, 1, NULL);
    H5Gclose(parent);
    return done;
}

static bool constant_open(series *s, hid_t file, const char *path, hid_t type)
{
    s->type = type;
    s->dataset = H5Dopen2(file, path, H5P_DEFAULT);
    return s->dataset >= 0;
}

static status misfit(const results *r, const char *path, failure *why)
{
    return fail(why, STATUS_BAD_INPUT, "%s: has no %s of the shape that this run writes: it belongs to another scene or other outputs; "
                "give a new file with --out", r->path, path);
}

static status fields_open(results *r, hid_t file, failure *why)
{
    const char *element = r->contacts ? "/contacts" : NULL;
    char path[512], first[512];
    for (int k = 0; k < r->field_count; k++) {
        const results_field *field = &r->field[k];
        const hid_t type = field->integer ? H5T_NATIVE_INT32 : H5T_NATIVE_DOUBLE;
        int rank;
        hsize_t row[2];
        field_shape(r, k, &rank, row);
        snprintf(path, sizeof path, "/particles/all/%s%s", field->name, field->constant ? "" : "/value");
        bool done = field->constant ? constant_open(&r->field_series[k], file, path, type) :
                                      series_open(&r->field_series[k], file, path, type, rank, row);
        if (!done)
            return misfit(r, path, why);
        if (!field->constant && !element) {
            snprintf(first, sizeof first, "/particles/all/%s", field->name);
            element = first;
        }
    }
    return clock_open(&r->frames, file, element) ? STATUS_OK : misfit(r, element, why);
}

static status observables_open(results *r, hid_t file, failure *why)
{
    char path[512];
    for (int k = 0; k < r->observable_count; k++) {
        hsize_t components = (hsize_t)r->observable[k].components;
        snprintf(path, sizeof path, "/observables/%s/value", r->observable[k].name);
        if (!series_open(&r->observable_series[k], file, path, H5T_NATIVE_DOUBLE, components > 1 ? 2 : 1, &components))
            return misfit(r, path, why);
    }
    if (r->observable_count > 0)
        snprintf(path, sizeof path, "/observables/%s", r->observable[0].name);
    return clock_open(&r->samples, file, r->observable_count ? path : NULL) ? STATUS_OK : misfit(r, path, why);
}

static status contacts_open(results *r, hid_t file, failure *why)
{
    const hsize_t three = 3;
    char path[64];
    if (!series_open(&r->contact.offset, file, "/contacts/offset", H5T_NATIVE_INT64, 1, NULL))
        return misfit(r, "/contacts/offset", why);
    for (int k = 0; k < CONTACT_COLUMNS; k++) {
        const contact_column *c = &contact_columns[k];
        snprintf(path, sizeof path, "/contacts/%s", c->name);
        const hid_t type = c->integer ? H5T_NATIVE_INT32 : H5T_NATIVE_DOUBLE;
        if (!series_open(column_series(r, c), file, path, type, c->components > 1 ? 2 : 1, &three))
            return misfit(r, path, why);
    }
    return STATUS_OK;
}

status results_layout_open(results *r, failure *why)
{
    hid_t file = commit_file_id(r->file);
    TRY(fields_open(r, file, why));
    TRY(observables_open(r, file, why));
    return r->contacts ? contacts_open(r, file, why) : STATUS_OK;
}

/* Rows that a clock and all series beside it have. */
static int64_t common_rows(const clock_series *clock, int count, const series *list, const results_field *field)
{
    int64_t rows = clock->step.rows < clock->time.rows ? clock->step.rows : clock->time.rows;
    for (int k = 0; k < count; k++)
        if ((!field || !field[k].constant) && list[k].rows < rows)
            rows = list[k].rows;
    return rows;
}

/* Steps rise, so the first rows are those to keep. False on failure. */
static bool rows_until(const clock_series *clock, int64_t rows, int64_t step, int64_t *keep)
{
    int64_t low = 0, high = rows; /* rows below `low` are kept, from `high` on they are not */
    while (low < high) {
        int64_t middle = low + (high - low) / 2, found;
        if (!series_read(&clock->step, middle, 1, &found))
            return false;
        if (found <= step)
            low = middle + 1;
        else
            high = middle;
    }
    *keep = low;
    return true;
}

static bool cut_clock(clock_series *clock, int64_t rows)
{
    return series_cut(&clock->step, rows) && series_cut(&clock->time, rows);
}

static bool cut_contacts(results *r, int64_t frames)
{
    int64_t rows = r->contact.i.rows;
    if (frames < r->contact.offset.rows && !series_read(&r->contact.offset, frames, 1, &rows))
        return false;
    bool done = series_cut(&r->contact.offset, frames);
    for (int k = 0; k < CONTACT_COLUMNS && done; k++)
        done = series_cut(column_series(r, &contact_columns[k]), rows);
    return done;
}

bool results_layout_cut(results *r, int64_t step)
{
    int64_t frames = common_rows(&r->frames, r->field_count, r->field_series, r->field);
    int64_t samples = common_rows(&r->samples, r->observable_count, r->observable_series, NULL);
    if (r->contacts && r->contact.offset.rows < frames)
        frames = r->contact.offset.rows;
    if (!rows_until(&r->frames, frames, step, &frames) || !rows_until(&r->samples, samples, step, &samples))
        return false;
    bool done = (!r->contacts || cut_contacts(r, frames)) && cut_clock(&r->frames, frames) && cut_clock(&r->samples, samples);
    for (int k = 0; k < r->field_count && done; k++)
        done = r->field[k].constant || series_cut(&r->field_series[k], frames);
    for (int k = 0; k < r->observable_count && done; k++)
        done = series_cut(&r->observable_series[k], samples);
    return done;
}

bool results_layout_add_contacts(results *r, const results_contacts *c)
{
    int64_t count = c ? c->count : 0, first = r->contact.i.rows;
    void *zeros = NULL;
    if (count > 0 && (!c->heat || !c->bonded)) {
        zeros = calloc((size_t)count, sizeof(double));
        if (!zeros)
            return false;
    }
    bool done = series_append(&r->contact.offset, 1, &first);
    if (count > 0)
        done = done && series_append(&r->contact.i, count, c->i) && series_append(&r->contact.j, count, c->j) &&
               series_append(&r->contact.wall, count, c->wall) && series_append(&r->contact.overlap, count, c->overlap) &&
               series_append(&r->contact.area, count, c->area) && series_append(&r->contact.force, count, c->force) &&
               series_append(&r->contact.heat, count, c->heat ? (const void *)c->heat : zeros) &&
               series_append(&r->contact.bonded, count, c->bonded ? (const void *)c->bonded : zeros);
    free(zeros);
    return done;
}
