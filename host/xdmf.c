#include "xdmf.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

char *xdmf_path(const char *results_path)
{
    static const char *const endings[] = {".h5", ".hdf5", ".h5md", ".hdf"};
    size_t length = strlen(results_path), stem = length;
    for (size_t k = 0; k < sizeof endings / sizeof endings[0]; k++) {
        size_t n = strlen(endings[k]);
        if (length > n && strcmp(results_path + length - n, endings[k]) == 0 && results_path[length - n - 1] != '/')
            stem = length - n;
    }
    char *path = malloc(stem + sizeof ".xdmf");
    if (path) {
        memcpy(path, results_path, stem);
        strcpy(path + stem, ".xdmf");
    }
    return path;
}

static void put_escaped(FILE *out, const char *text)
{
    for (; *text; text++)
        switch (*text) {
        case '&': fputs("&amp;", out); break;
        case '<': fputs("&lt;", out); break;
        case '>': fputs("&gt;", out); break;
        case '"': fputs("&quot;", out); break;
        default: fputc(*text, out);
        }
}

typedef struct writer {
    FILE *out;
    const char *data_name; /* of the HDF5 file, beside this one */
    int64_t count, frames;
} writer;

/* One frame of one field: a constant as it stands, a series as a hyperslab (start, stride and count, then the whole dataset). This is
 * XDMF 2; ParaView's Xdmf3 readers lose hyperslabs, and what they take instead the XDMF reader and VisIt do not. */
static void put_data(const writer *w, const results_field *field, int64_t frame)
{
    char shape[64], type[64];
    if (field->components > 1)
        snprintf(shape, sizeof shape, "%" PRId64 " %d", w->count, field->components);
    else
        snprintf(shape, sizeof shape, "%" PRId64, w->count);
    snprintf(type, sizeof type, "NumberType=\"%s\" Precision=\"%d\"", field->integer ? "Int" : "Float", field->integer ? 4 : 8);
    if (field->constant) {
        fprintf(w->out, "        <DataItem Dimensions=\"%s\" %s Format=\"HDF\">", shape, type);
        put_escaped(w->out, w->data_name);
        fprintf(w->out, ":/particles/all/%s</DataItem>\n", field->name);
        return;
    }
    bool vector = field->components > 1;
    fprintf(w->out, "        <DataItem ItemType=\"HyperSlab\" Dimensions=\"%s\">\n", shape);
    fprintf(w->out, "          <DataItem Dimensions=\"3 %d\" NumberType=\"Int\" Format=\"XML\">%" PRId64 " 0%s  1 1%s  1 %s</DataItem>\n",
            vector ? 3 : 2, frame, vector ? " 0" : "", vector ? " 1" : "", shape);
    fprintf(w->out, "          <DataItem Dimensions=\"%" PRId64 " %s\" %s Format=\"HDF\">", w->frames, shape, type);
    put_escaped(w->out, w->data_name);
    fprintf(w->out, ":/particles/all/%s/value</DataItem>\n        </DataItem>\n", field->name);
}

static const char *attribute_type(int components)
{
    switch (components) {
    case 1: return "Scalar";
    case 3: return "Vector";
    case 6: return "Tensor6";
    case 9: return "Tensor";
    default: return "Matrix";
    }
}

static void put_frame(const writer *w, int field_count, const results_field *field, const results_field *position, int64_t frame,
                      double time)
{
    fprintf(w->out, "    <Grid Name=\"particles\" GridType=\"Uniform\">\n      <Time Value=\"%.17g\"/>\n", time);
    fprintf(w->out, "      <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"%" PRId64 "\" NodesPerElement=\"1\"/>\n", w->count);
    fprintf(w->out, "      <Geometry GeometryType=\"%s\">\n", position->components == 2 ? "XY" : "XYZ");
    put_data(w, position, frame);
    fprintf(w->out, "      </Geometry>\n");
    for (int k = 0; k < field_count; k++) {
        if (&field[k] == position)
            continue;
        fprintf(w->out, "      <Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"Node\">\n", field[k].name,
                attribute_type(field[k].components));
        put_data(w, &field[k], frame);
        fprintf(w->out, "      </Attribute>\n");
    }
    fprintf(w->out, "    </Grid>\n");
}

status xdmf_write(const char *path, const char *results_path, int64_t count, int field_count, const results_field *field, int64_t frames,
                  const double *time, failure *why)
{
    const results_field *position = NULL;
    for (int k = 0; k < field_count; k++)
        if (strcmp(field[k].name, "position") == 0 && (field[k].components == 2 || field[k].components == 3))
            position = &field[k];
    if (!position || count == 0)
        return STATUS_OK; /* nothing to show */
    char temporary[4096];
    if ((size_t)snprintf(temporary, sizeof temporary, "%s.tmp", path) >= sizeof temporary)
        return fail(why, STATUS_ERROR, "%s: the path is too long", path);
    FILE *out = fopen(temporary, "we");
    if (!out)
        return fail(why, STATUS_ERROR, "%s: cannot be written: %s", temporary, strerror(errno));
    const char *slash = strrchr(results_path, '/');
    writer w = {out, slash ? slash + 1 : results_path, count, frames};
    fputs("<?xml version=\"1.0\"?>\n<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n<Xdmf Version=\"2.0\">\n<Domain>\n"
          "  <Grid Name=\"bed\" GridType=\"Collection\" CollectionType=\"Temporal\">\n", out);
    errno = 0;
    for (int64_t k = 0; k < frames && !ferror(out); k++)
        put_frame(&w, field_count, field, position, k, time[k]);
    fputs("  </Grid>\n</Domain>\n</Xdmf>\n", out);
    bool failed = ferror(out) || fflush(out) != 0;
    int reason = errno;
    failed = fclose(out) != 0 || failed;
    if (!failed && rename(temporary, path) == 0)
        return STATUS_OK;
    reason = failed ? reason : errno;
    unlink(temporary);
    return fail(why, STATUS_ERROR, "%s: cannot be written: %s", path, reason ? strerror(reason) : "write failed");
}
