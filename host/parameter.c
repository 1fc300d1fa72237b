#include "parameter.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define KNOWN_MAX 96

void *scene_allocate(size_t count, size_t size)
{
    void *memory = calloc(count ? count : 1, size);
    if (!memory) {
        fprintf(stderr, "clast: out of memory while reading a scene\n");
        abort();
    }
    return memory;
}

char *scene_copy(const char *text)
{
    char *copy = scene_allocate(strlen(text) + 1, 1);
    memcpy(copy, text, strlen(text) + 1);
    return copy;
}

parameter parameter_of_property(const property *p)
{
    return (parameter){.key = p->key,
                       .type = PARAMETER_NUMBER,
                       .unit = parameter_unit(p->key),
                       .low = p->low,
                       .high = p->high,
                       .open_low = p->open_low,
                       .doc = p->doc};
}

static bool row_is_active(const parameter *row, const char *selected)
{
    return !row->only || !selected || words_find(row->only, selected) >= 0;
}

static const parameter *find_row(const section *s, const char *key, const char *selected)
{
    for (const parameter *row = s->row; row->key; row++)
        if (strcmp(row->key, key) == 0 && row_is_active(row, selected))
            return row;
    return NULL;
}

static const property *find_property(const section *s, const char *key)
{
    if (s->properties)
        for (const property *const *p = s->properties(); *p; p++)
            if (strcmp((*p)->key, key) == 0)
                return *p;
    return NULL;
}

static int known_keys(const section *s, const char *selected, const char **known)
{
    int count = 0;
    for (const parameter *row = s->row; row->key && count < KNOWN_MAX; row++)
        if (row_is_active(row, selected) && row->type != PARAMETER_LATER)
            known[count++] = row->key;
    if (s->properties)
        for (const property *const *p = s->properties(); *p && count < KNOWN_MAX; p++)
            known[count++] = (*p)->key;
    return count;
}

static status unknown_key(reader *r, const section *s, int key_node, const char *selected)
{
    const char *key = document_scalar(r->document, key_node), *known[KNOWN_MAX];
    for (const parameter *row = s->row; row->key; row++)
        if (strcmp(row->key, key) == 0) {
            char where[256];
            words_list(row->only, where, sizeof where);
            return document_fail(r->document, key_node, r->why, "`%s` has no meaning in %s %s with `%s: %s`; it belongs to %s", key,
                                 article(s->name), s->name, s->selector, selected, where);
        }
    int count = known_keys(s, selected, known);
    const char *nearest = word_nearest(key, known, count);
    if (nearest)
        return document_fail(r->document, key_node, r->why, "unknown key `%.60s` in %s %s; did you mean `%s`?", key, article(s->name),
                             s->name, nearest);
    char all[2048];
    size_t used = 0;
    all[0] = '\0';
    for (int k = 0; k < count && used + 80 < sizeof all; k++)
        used += (size_t)snprintf(all + used, sizeof all - used, "%s`%s`", k ? ", " : "", known[k]);
    return document_fail(r->document, key_node, r->why, "unknown key `%.60s` in %s %s; its keys are %s", key, article(s->name), s->name,
                         all);
}

static status check_keys(reader *r, const section *s, int node, const char *selected)
{
    document *d = r->document;
    const yaml_node_t *n = document_node(d, node);
    for (const yaml_node_pair_t *p = n->data.mapping.pairs.start; p < n->data.mapping.pairs.top; p++) {
        const char *key = document_scalar(d, p->key);
        if (!find_row(s, key, selected) && !find_property(s, key))
            return unknown_key(r, s, p->key, selected);
        for (const yaml_node_pair_t *q = n->data.mapping.pairs.start; q < p; q++)
            if (strcmp(document_scalar(d, q->key), key) == 0)
                return document_fail(d, p->key, r->why, "the key `%s` stands twice in this %s, first at line %d; keep one", key, s->name,
                                     document_place(d, q->key).line);
    }
    return STATUS_OK;
}

static status read_properties(reader *r, const section *s, int node, void *target)
{
    int count = 0;
    while (s->properties()[count])
        count++;
    double *value = scene_allocate((size_t)count, sizeof *value);
    memcpy((char *)target + s->values, &value, sizeof value);
    for (int k = 0; k < count; k++) {
        const parameter row = parameter_of_property(s->properties()[k]);
        int found = document_find(r->document, node, row.key);
        value[k] = NAN;
        if (found && property_is_tabled(s->properties()[k]) && document_is_mapping(r->document, found))
            TRY(read_property_table(r, &row, s->properties()[k], found, &value[k]));
        else if (found)
            TRY(parameter_number(r, &row, found, &value[k]));
    }
    return STATUS_OK;
}

static void store_vector_default(const char *fallback, double *out)
{
    const char *p = fallback + 1;
    for (int k = 0; k < 3; k++) {
        char *end;
        out[k] = strtod(p, &end);
        p = end + strspn(end, ", ");
    }
}

/* Stores a row's default; the table is trusted. */
static status store_default(reader *r, const parameter *row, void *target)
{
    void *store = (char *)target + row->offset;
    const char *fallback = row->fallback && row->word && strcmp(row->fallback, row->word) == 0 ? NULL : row->fallback;
    double number = fallback && row->type == PARAMETER_NUMBER ? strtod(fallback, NULL) : NAN;
    int64_t integer = fallback ? strtoll(fallback, NULL, 10) : row->type == PARAMETER_INTEGER ? (int64_t)row->absent : 0;
    switch (row->type) {
    case PARAMETER_NUMBER:
        memcpy(store, &number, sizeof number);
        break;
    case PARAMETER_INTEGER:
        memcpy(store, &integer, sizeof integer);
        break;
    case PARAMETER_FLAG:
        *(bool *)store = fallback && strcmp(fallback, "true") == 0;
        break;
    case PARAMETER_CHOICE:
        parameter_store_choice(row, fallback ? words_find(row->choices, fallback) : 0, store);
        break;
    case PARAMETER_TEXT:
    case PARAMETER_NAME:
        *(char **)store = fallback ? scene_copy(fallback) : NULL;
        break;
    case PARAMETER_VECTOR:
        if (fallback)
            store_vector_default(fallback, store);
        break;
    case PARAMETER_SECTION:
        return parameter_section(r, row->section, 0, store);
    case PARAMETER_OTHER:
        if (isnan(row->absent))
            memcpy(store, &row->absent, sizeof row->absent);
        break;
    default:
        break;
    }
    return STATUS_OK;
}

static status selected_word(reader *r, const section *s, int node, const char **selected)
{
    *selected = NULL;
    if (!s->selector || !node)
        return STATUS_OK;
    const parameter *row = find_row(s, s->selector, NULL);
    int found = document_find(r->document, node, s->selector);
    if (!found && row->required)
        return document_fail(r->document, node, r->why, "%s %s needs the key `%s`: %s", article(s->name), s->name, row->key, row->doc);
    *selected = found ? document_scalar(r->document, found) : row->fallback;
    if (*selected && words_find(row->choices, *selected) < 0)
        *selected = NULL;
    if (found && !*selected) {
        int unused;
        parameter plain = *row;
        plain.offset = 0;
        plain.as_number = false;
        return parameter_value(r, &plain, found, &unused); /* says what is wrong with it */
    }
    return STATUS_OK;
}

status parameter_section(reader *r, const section *s, int node, void *target)
{
    const char *selected = NULL;
    char what[128];
    if (node && !document_is_mapping(r->document, node))
        return document_fail(r->document, node, r->why, "%s %s must be a mapping (`key: value`), not %s", article(s->name), s->name,
                             document_describe(r->document, node, what, sizeof what));
    TRY(selected_word(r, s, node, &selected));
    if (node)
        TRY(check_keys(r, s, node, selected));
    if (s->placed && node)
        *(place *)((char *)target + s->at) = document_place(r->document, node);
    for (const parameter *row = s->row; row->key; row++) {
        if (s->selector && node && row->only && !row_is_active(row, selected))
            continue;
        int found = node ? document_find(r->document, node, row->key) : 0;
        if (found) {
            if (row->given)
                *(bool *)((char *)target + row->given) = true;
            TRY(parameter_value(r, row, found, target));
        } else if (row->required && node) {
            return document_fail(r->document, node, r->why, "%s %s needs the key `%s`: %s", article(s->name), s->name, row->key, row->doc);
        } else if (!row->keep) {
            TRY(store_default(r, row, target));
        }
    }
    if (s->properties && node)
        TRY(read_properties(r, s, node, target));
    return s->finish && node ? s->finish(r, node, target) : STATUS_OK;
}
