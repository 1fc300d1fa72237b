#include "bed_group.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* A longer line is no table of particles; the bound keeps a binary file from filling the memory. */
#define LINE_MAX_BYTES 65536

typedef enum column { X, Y, Z, RADIUS, VX, VY, VZ, WX, WY, WZ, TEMPERATURE, SCALAR, COLUMN_COUNT } column;

static const char *const column_names[COLUMN_COUNT] = {"x_m",    "y_m",      "z_m",      "radius_m", "vx_m_s",       "vy_m_s",
                                                       "vz_m_s", "wx_rad_s", "wy_rad_s", "wz_rad_s", "temperature_k", "scalar"};

typedef struct table {
    const char *path;
    FILE *file;
    char *line; /* LINE_MAX_BYTES */
    int64_t line_number;
    int column_count;
    column columns[COLUMN_COUNT]; /* of the file, in its order */
    bool present[COLUMN_COUNT];
    double (*row)[COLUMN_COUNT];
    int64_t count, capacity;
} table;

static status read_failed(const table *t, failure *why)
{
    return fail(why, STATUS_BAD_INPUT, "%s:%" PRId64 ": reading stopped: %s", t->path, t->line_number, strerror(errno));
}

/* One line without its end, `text` NULL at the end of the file. */
static status next_line(table *t, char **text, failure *why)
{
    size_t length = 0;
    int c;
    t->line_number++;
    while ((c = getc_unlocked(t->file)) != EOF && c != '\n') {
        if (c < ' ' && c != '\t' && c != '\r')
            return fail(why, STATUS_BAD_INPUT, "%s:%" PRId64 ": byte %zu is 0x%02x; this is not a text file", t->path, t->line_number,
                        length + 1, (unsigned)c);
        if (length == LINE_MAX_BYTES - 1)
            return fail(why, STATUS_BAD_INPUT, "%s:%" PRId64 ": the line is longer than %d bytes; this is not a table of particles",
                        t->path, t->line_number, LINE_MAX_BYTES - 1);
        t->line[length++] = (char)c;
    }
    if (c == EOF && ferror(t->file))
        return read_failed(t, why);
    t->line[length] = '\0';
    *text = c == EOF && length == 0 ? NULL : t->line;
    if (*text && t->line_number == 1 && strncmp(*text, "\xef\xbb\xbf", 3) == 0) /* byte order mark */
        *text += 3;
    return STATUS_OK;
}

static bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

static char *trim(char *text)
{
    while (is_space(*text))
        text++;
    char *end = text + strlen(text);
    while (end > text && is_space(end[-1]))
        *--end = '\0';
    return text;
}

/* The next line that says something, its comment cut off; NULL at the end of the file. */
static status next_content(table *t, char **text, failure *why)
{
    do {
        TRY(next_line(t, text, why));
        if (*text) {
            (*text)[strcspn(*text, "#")] = '\0';
            *text = trim(*text);
        }
    } while (*text && **text == '\0');
    return STATUS_OK;
}

/* Cuts the cell off the front of *rest; *rest is NULL after the last one. */
static char *next_cell(char **rest)
{
    char *cell = *rest, *comma = strchr(cell, ',');
    *rest = comma ? comma + 1 : NULL;
    if (comma)
        *comma = '\0';
    return trim(cell);
}

/* Counted from 1, in bytes, as editors and the messages on scenes count. */
static int place_in_line(const table *t, const char *cell)
{
    return (int)(cell - t->line) + 1;
}

static status read_header(table *t, bool radius_given, failure *why)
{
    char *text;
    TRY(next_content(t, &text, why));
    if (!text)
        return fail(why, STATUS_BAD_INPUT, "%s: the file is empty; it needs a line of column names (x_m,y_m,z_m,radius_m) and rows",
                    t->path);
    while (text) {
        const char *name = next_cell(&text);
        int k = 0, at = place_in_line(t, name);
        while (k < COLUMN_COUNT && strcmp(name, column_names[k]) != 0)
            k++;
        if (k == COLUMN_COUNT)
            return fail(why, STATUS_BAD_INPUT,
                        "%s:%" PRId64
                        ":%d: column `%.60s` is unknown; known are x_m, y_m, z_m, radius_m, vx_m_s, vy_m_s, vz_m_s, wx_rad_s, wy_rad_s, "
                        "wz_rad_s, temperature_k and scalar, separated by commas",
                        t->path, t->line_number, at, name);
        if (t->present[k])
            return fail(why, STATUS_BAD_INPUT, "%s:%" PRId64 ":%d: column `%s` appears twice", t->path, t->line_number, at, name);
        t->present[k] = true;
        t->columns[t->column_count++] = (column)k;
    }
    for (int k = X; k <= RADIUS; k++)
        if (!t->present[k] && !(k == RADIUS && radius_given))
            return fail(why, STATUS_BAD_INPUT, "%s:%" PRId64 ": column `%s` is missing%s", t->path, t->line_number, column_names[k],
                        k == RADIUS ? ", and the group gives no radius_m" : "");
    return STATUS_OK;
}

static status read_cell(const table *t, column k, const char *cell, double *value, failure *why)
{
    char *end;
    int at = place_in_line(t, cell);
    *value = strtod(cell, &end);
    if (end == cell || *end != '\0')
        return fail(why, STATUS_BAD_INPUT, "%s:%" PRId64 ":%d: %s is `%.60s`, which is not a number", t->path, t->line_number, at,
                    column_names[k], cell);
    if (!isfinite(*value))
        return fail(why, STATUS_BAD_INPUT, "%s:%" PRId64 ":%d: %s is `%.60s`; it must be finite", t->path, t->line_number, at,
                    column_names[k], cell);
    if (k == RADIUS && !(*value > 0.0))
        return fail(why, STATUS_BAD_INPUT, "%s:%" PRId64 ":%d: radius_m is `%.60s`; it must be above 0", t->path, t->line_number, at, cell);
    if (k == TEMPERATURE && !(*value > 0.0))
        return fail(why, STATUS_BAD_INPUT, "%s:%" PRId64 ":%d: temperature_k is `%.60s`; it must be above 0", t->path, t->line_number, at, cell);
    return STATUS_OK;
}

static status read_row(table *t, char *text, failure *why)
{
    if (t->count == t->capacity) {
        int64_t capacity = 2 * t->capacity + 1024;
        void *grown = realloc(t->row, (size_t)capacity * sizeof *t->row);
        if (!grown)
            return fail(why, STATUS_ERROR, "%s: out of memory for %" PRId64 " rows", t->path, capacity);
        t->row = grown;
        t->capacity = capacity;
    }
    int cells = 1;
    for (const char *c = text; *c; c++)
        cells += *c == ',';
    if (cells != t->column_count)
        return fail(why, STATUS_BAD_INPUT, "%s:%" PRId64 ": the row has %d columns, the header %d", t->path, t->line_number, cells,
                    t->column_count);
    for (int k = 0; k < t->column_count; k++)
        TRY(read_cell(t, t->columns[k], next_cell(&text), &t->row[t->count][t->columns[k]], why));
    t->count++;
    return STATUS_OK;
}

static status read_table(table *t, bool radius_given, failure *why)
{
    char *text;
    TRY(read_header(t, radius_given, why));
    for (;;) {
        TRY(next_content(t, &text, why));
        if (!text)
            break;
        if (t->count == INT32_MAX)
            return fail(why, STATUS_BAD_INPUT, "%s:%" PRId64 ": more than %d rows", t->path, t->line_number, INT32_MAX);
        TRY(read_row(t, text, why));
    }
    if (t->count == 0)
        return fail(why, STATUS_BAD_INPUT, "%s: the table has no rows", t->path);
    return STATUS_OK;
}

static status take_table(const scene *s, int group, const table *t, bed *b, failure *why)
{
    int64_t first;
    TRY(bed_extend(s, group, t->count, b, &first, why));
    if (!t->present[RADIUS])
        TRY(bed_draw_radii(s, group, b, first, why));
    for (int64_t n = 0; n < t->count; n++) {
        const double *row = t->row[n];
        int64_t i = first + n;
        for (int d = 0; d < 3; d++) {
            b->position[i][d] = row[X + d];
            if (t->present[VX + d])
                b->velocity[i][d] = row[VX + d];
            if (t->present[WX + d])
                b->spin[i][d] = row[WX + d];
        }
        if (t->present[RADIUS])
            b->radius[i] = row[RADIUS];
        if (t->present[TEMPERATURE])
            b->temperature[i] = row[TEMPERATURE];
        if (t->present[SCALAR])
            b->scalar[i] = row[SCALAR];
    }
    return STATUS_OK;
}

static status open_table(const scene *s, int group, table *t, failure *why)
{
    t->path = s->group[group].path;
    if (!t->path)
        return bed_refuse(s, group, why, "the csv generator needs a path");
    struct stat about;
    if (stat(t->path, &about) != 0)
        return bed_refuse(s, group, why, "cannot read %s: %s", t->path, strerror(errno));
    if (S_ISDIR(about.st_mode))
        return bed_refuse(s, group, why, "cannot read %s: it is a directory", t->path);
    t->file = fopen(t->path, "r");
    if (!t->file)
        return bed_refuse(s, group, why, "cannot read %s: %s", t->path, strerror(errno));
    t->line = malloc(LINE_MAX_BYTES);
    if (!t->line)
        return fail(why, STATUS_ERROR, "out of memory reading %s", t->path);
    return STATUS_OK;
}

status bed_csv(const scene *s, int group, bed *b, failure *why)
{
    table t = {0};
    status result = open_table(s, group, &t, why);
    if (result == STATUS_OK)
        result = read_table(&t, bed_radius_given(&s->group[group]), why);
    if (result == STATUS_OK)
        result = take_table(s, group, &t, b, why);
    if (t.file)
        fclose(t.file);
    free(t.line);
    free(t.row);
    return result;
}
