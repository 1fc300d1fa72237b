/* Values that may be numbers or tables: in time, or along an axis. */
#include "property.h"
#include "scene_table.h"

#include <clast/shared.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The keys of a table, before it is known which kind it is. */
typedef struct table_keys {
    double *time_s, *at_m;
    int time_count, at_count;
    int axis;
    bool axis_given;
} table_keys;

static status keep_value(reader *r, const parameter *row, int node, void *target)
{
    (void)r, (void)row, (void)node, (void)target;
    return STATUS_OK;
}

static const parameter quantity_rows[] = {
    {.key = "time_s", .type = PARAMETER_NUMBERS, .unit = "s", .offset = offsetof(table_keys, time_s),
     .count = offsetof(table_keys, time_count), .doc = "times, rising, for a value that varies in time"},
    {.key = "axis", .type = PARAMETER_CHOICE, .choices = "x|y|z", .offset = offsetof(table_keys, axis),
     .given = offsetof(table_keys, axis_given), .shown = "none", .doc = "the axis, for a value that varies in space"},
    {.key = "at_m", .type = PARAMETER_NUMBERS, .unit = "m", .offset = offsetof(table_keys, at_m),
     .count = offsetof(table_keys, at_count), .doc = "places along the axis, rising"},
    {.key = "value", .type = PARAMETER_OTHER, .read = keep_value, .required = true, .form = "list of values",
     .doc = "the values there, linear between them and constant outside"},
    {0},
};
const section quantity_section = {.name = "table", .doc = "A value that varies: a table in time, or along an axis where the key allows it.",
                                  .row = quantity_rows};

static status read_table_values(reader *r, const parameter *row, int node, int components, quantity *out)
{
    parameter value = *row;
    int list = document_find(r->document, node, "value"), length = 0;
    value.key = "value";
    TRY(parameter_list_length(r, &value, list, &length));
    if (length != out->count)
        return document_fail(r->document, list, r->why, "`value` has %d entries and the table %d places; give one value for each", length,
                             out->count);
    out->value = scene_allocate((size_t)(length * components), sizeof *out->value);
    for (int k = 0; k < length; k++) {
        int item = document_item(r->document, list, k);
        TRY(components == 3 ? parameter_vector(r, &value, item, out->value + 3 * k) : parameter_number(r, &value, item, out->value + k));
    }
    return STATUS_OK;
}

static status check_table(reader *r, int node, const quantity *q, const char *key)
{
    for (int k = 1; k < q->count; k++)
        if (q->at[k] <= q->at[k - 1])
            return document_fail(r->document, document_item(r->document, document_find(r->document, node, key), k), r->why,
                                 "`%s` must rise from entry to entry; %.10g follows %.10g", key, q->at[k], q->at[k - 1]);
    if (q->kind == QUANTITY_AXIS && q->count > QUANTITY_PLACES_MAX)
        return document_fail(r->document, document_find(r->document, node, key), r->why, "a table along an axis holds at most %d places; it has %d",
                             QUANTITY_PLACES_MAX, q->count);
    return STATUS_OK;
}

static status take_table(reader *r, const parameter *row, int node, int components, bool in_time, bool in_space, table_keys *read, quantity *out)
{
    TRY(parameter_section(r, &quantity_section, node, read));
    const table_keys keys = *read;
    bool space = keys.axis_given || keys.at_m;
    if (keys.time_s && space)
        return document_fail(r->document, node, r->why, "`%s` is a table in time (`time_s`) or along an axis (`axis` and `at_m`), not both",
                             row->key);
    if (!keys.time_s && !(keys.axis_given && keys.at_m))
        return document_fail(r->document, node, r->why, "`%s` as a table needs %s", row->key,
                             in_time && in_space ? "`time_s`, or `axis` and `at_m`" :
                             in_time             ? "`time_s`" :
                                                   "`axis` and `at_m`");
    if (space ? !in_space : !in_time)
        return document_fail(r->document, node, r->why, "`%s` cannot vary %s; it takes a number%s", row->key, space ? "along an axis" : "in time",
                             in_time    ? ", or a table in time" :
                             in_space   ? ", or a table along an axis" :
                                          "");
    out->kind = space ? QUANTITY_AXIS : QUANTITY_TIME;
    out->axis = keys.axis;
    out->at = space ? keys.at_m : keys.time_s;
    out->count = space ? keys.at_count : keys.time_count;
    TRY(check_table(r, node, out, space ? "at_m" : "time_s"));
    return read_table_values(r, row, node, components, out);
}

static status read_table(reader *r, const parameter *row, int node, int components, bool in_time, bool in_space, quantity *out)
{
    table_keys keys = {0};
    status result = take_table(r, row, node, components, in_time, in_space, &keys, out);
    if (!out->at) {
        free(keys.time_s);
        free(keys.at_m);
    }
    return result;
}

static status read_quantity(reader *r, const parameter *row, int node, int components, bool in_time, bool in_space, void *target)
{
    quantity *out = (quantity *)((char *)target + row->offset);
    out->given = true;
    out->components = components;
    if (document_is_mapping(r->document, node))
        return read_table(r, row, node, components, in_time, in_space, out);
    out->kind = QUANTITY_NUMBER;
    return components == 3 ? parameter_vector(r, row, node, out->number) : parameter_number(r, row, node, out->number);
}

status read_number_in_time(reader *r, const parameter *row, int node, void *target)
{
    return read_quantity(r, row, node, 1, true, false, target);
}

status read_number_anywhere(reader *r, const parameter *row, int node, void *target)
{
    return read_quantity(r, row, node, 1, true, true, target);
}

status read_vector_anywhere(reader *r, const parameter *row, int node, void *target)
{
    return read_quantity(r, row, node, 3, true, true, target);
}

/* ---- properties against temperature ---- */

static const parameter property_table_rows[] = {
    {.key = "temperature_k", .type = PARAMETER_NUMBERS, .unit = "K", .offset = offsetof(property_table, temperature_k),
     .count = offsetof(property_table, count), .required = true, .doc = "temperatures, rising"},
    {.key = "value", .type = PARAMETER_NUMBERS, .offset = offsetof(property_table, value), .count = offsetof(property_table, value_count),
     .required = true, .doc = "the property there, linear between them and constant outside"},
    {0},
};
const section property_table_section = {.name = "table", .doc = "A property of a material or an interaction that depends on temperature, where the key allows a table.",
                                        .row = property_table_rows};

static status check_property_table(reader *r, const parameter *row, int node, const property_table *t)
{
    int places = document_find(r->document, node, "temperature_k"), values = document_find(r->document, node, "value");
    if (t->count != t->value_count || t->count == 0)
        return document_fail(r->document, values, r->why, "`value` has %d entries and `temperature_k` %d; give one value for each temperature", t->value_count, t->count);
    if (t->count > CLAST_TABLE_PLACES)
        return document_fail(r->document, places, r->why, "a table against temperature holds at most %d places; it has %d", CLAST_TABLE_PLACES, t->count);
    for (int k = 0; k < t->count; k++) {
        char allowed[128];
        parameter_range(row, allowed, sizeof allowed);
        if (k > 0 && !(t->temperature_k[k] > t->temperature_k[k - 1]))
            return document_fail(r->document, document_item(r->document, places, k), r->why, "`temperature_k` must rise from entry to entry; %.10g follows %.10g",
                                 t->temperature_k[k], t->temperature_k[k - 1]);
        if (t->value[k] < row->low || t->value[k] > row->high || (row->open_low && t->value[k] == row->low))
            return document_fail(r->document, document_item(r->document, values, k), r->why, "`%s` must be %s everywhere in the table; it is %.10g", row->key, allowed, t->value[k]);
    }
    return STATUS_OK;
}

status read_property_table(reader *r, const parameter *row, const property *property, int node, double *value)
{
    scene *s = r->scene;
    s->property_table = realloc(s->property_table, sizeof *s->property_table * (size_t)(s->table_count + 1));
    property_table *t = &s->property_table[s->table_count];
    if (!s->property_table)
        return fail(r->why, STATUS_ERROR, "out of memory");
    *t = (property_table){.of = value};
    s->table_count++;
    TRY(parameter_section(r, &property_table_section, node, t));
    TRY(check_property_table(r, row, node, t));
    *value = t->value[0];
    for (int k = 1; k < t->count; k++)
        *value = property == &property_specific_heat ? fmin(*value, t->value[k]) : fmax(*value, t->value[k]);
    return STATUS_OK;
}

double quantity_component(const quantity *q, double x, int component)
{
    if (!q->given)
        return NAN;
    if (q->kind == QUANTITY_NUMBER)
        return q->number[component];
    int k = 0, n = q->components;
    while (k + 1 < q->count && x >= q->at[k + 1])
        k++;
    double from = q->value[k * n + component];
    if (k + 1 == q->count || x <= q->at[k])
        return from;
    return from + (x - q->at[k]) / (q->at[k + 1] - q->at[k]) * (q->value[(k + 1) * n + component] - from);
}

double quantity_at(const quantity *q, double x)
{
    return quantity_component(q, x, 0);
}

bool quantity_varies_in_time(const quantity *q)
{
    return q->given && q->kind == QUANTITY_TIME;
}

double quantity_largest(const quantity *q)
{
    if (!q->given || q->kind == QUANTITY_NUMBER)
        return quantity_at(q, 0.0);
    double most = q->value[0];
    for (int k = 1; k < q->count; k++)
        most = fmax(most, q->value[k * q->components]);
    return most;
}

void quantity_free(quantity *q)
{
    free(q->at);
    free(q->value);
    *q = (quantity){0};
}
