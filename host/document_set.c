/* `--set path=value`: finds or makes the place in the document that the path names, and puts the value there, as YAML. Whether the key
 * exists is not asked here: the parameter table checks the finished document, and its messages name the setting. */
#include "document.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STEP_MAX 128

/* Where the walk stands. The holder is the list or mapping in which `node` hangs, so that it can be replaced. */
typedef struct walk {
    document *d;
    const char *setting;
    int node;
    char done[512]; /* the path so far */
    failure *why;
} walk;

static status set_fail(const walk *w, const char *format, ...) __attribute__((format(printf, 2, 3)));

static status set_fail(const walk *w, const char *format, ...)
{
    char message[2048];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return fail(w->why, STATUS_BAD_INPUT, "--set %.500s: %s", w->setting, message);
}

static int out_of_memory(const walk *w)
{
    return fail(w->why, STATUS_ERROR, "--set %.500s: out of memory", w->setting);
}

/* Names of a list's entries, for a message. */
static void list_names(document *d, int list, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i < document_length(d, list) && used + 80 < size; i++) {
        int item = document_item(d, list, i);
        int name = document_find(d, item, "name");
        if (!name)
            name = document_find(d, item, "slot");
        const char *word = name ? document_scalar(d, name) : NULL;
        if (word)
            used += (size_t)snprintf(text + used, size - used, "%s%.60s", used ? ", " : "", word);
    }
}

static bool has_value(document *d, int mapping, const char *key, const char *word)
{
    int node = document_find(d, mapping, key);
    const char *text = node ? document_scalar(d, node) : NULL;
    return text && strcmp(text, word) == 0;
}

/* `default`, or `a,b` in either order. */
static bool is_between(document *d, int mapping, const char *word)
{
    int between = document_find(d, mapping, "between");
    if (!between)
        return false;
    if (document_is_scalar(d, between))
        return strcmp(document_scalar(d, between), word) == 0;
    if (document_length(d, between) != 2)
        return false;
    const char *a = document_scalar(d, document_item(d, between, 0)), *b = document_scalar(d, document_item(d, between, 1));
    if (!a || !b)
        return false;
    char pair[2 * STEP_MAX];
    snprintf(pair, sizeof pair, "%s,%s", a, b);
    if (strcmp(pair, word) == 0)
        return true;
    snprintf(pair, sizeof pair, "%s,%s", b, a);
    return strcmp(pair, word) == 0;
}

/* A stage without a name is called stage1, stage2, ... after its place in the list. */
static bool is_unnamed_stage(document *d, int list, int index, const char *word)
{
    char name[32];
    snprintf(name, sizeof name, "stage%d", index + 1);
    return list == document_at(d, "stages") && !document_find(d, document_item(d, list, index), "name") && strcmp(name, word) == 0;
}

static status find_by_name(const walk *w, const char *word, int *index)
{
    document *d = w->d;
    int found = -1, matches = 0;
    for (int pass = 0; pass < 2 && matches == 0; pass++)
        for (int i = 0; i < document_length(d, w->node); i++) {
            int item = document_item(d, w->node, i);
            bool match = pass == 0 ? has_value(d, item, "name", word)
                                   : has_value(d, item, "slot", word) || is_between(d, item, word) || is_unnamed_stage(d, w->node, i, word);
            if (match) {
                found = i;
                matches++;
            }
        }
    if (matches > 1)
        return set_fail(w, "`%s` holds %d entries called `%s`; use an index, counted from 0", w->done, matches, word);
    if (matches == 0) {
        char names[1024];
        list_names(d, w->node, names, sizeof names);
        return set_fail(w, "`%s` has no entry called `%s`; it has %d entries%s%s", w->done, word, document_length(d, w->node),
                        names[0] ? ": " : "", names);
    }
    *index = found;
    return STATUS_OK;
}

static status select_item(const walk *w, const char *word, int *index)
{
    char what[128];
    int length = document_length(w->d, w->node);
    if (!document_is_list(w->d, w->node))
        return set_fail(w, "`%s` is %s, not a list, so `[%s]` finds nothing in it", w->done,
                        document_describe(w->d, w->node, what, sizeof what), word);
    if (word[0] == '\0' || strspn(word, "0123456789") != strlen(word))
        return find_by_name(w, word, index);
    long value = strlen(word) < 10 ? strtol(word, NULL, 10) : length;
    if (value >= length)
        return set_fail(w, "`%s` has %d entries, counted from 0; there is no entry %s", w->done, length, word);
    *index = (int)value;
    return STATUS_OK;
}

static int copy_node(document *d, yaml_document_t *from, int id)
{
    const yaml_node_t *node = yaml_document_get_node(from, id);
    if (node->type == YAML_SCALAR_NODE)
        return yaml_document_add_scalar(&d->yaml, NULL, node->data.scalar.value, (int)node->data.scalar.length, node->data.scalar.style);
    if (node->type == YAML_SEQUENCE_NODE) {
        int list = yaml_document_add_sequence(&d->yaml, NULL, YAML_FLOW_SEQUENCE_STYLE);
        for (const yaml_node_item_t *i = node->data.sequence.items.start; list && i < node->data.sequence.items.top; i++) {
            int item = copy_node(d, from, *i);
            if (!item || !yaml_document_append_sequence_item(&d->yaml, list, item))
                return 0;
        }
        return list;
    }
    int mapping = yaml_document_add_mapping(&d->yaml, NULL, YAML_FLOW_MAPPING_STYLE);
    for (const yaml_node_pair_t *p = node->data.mapping.pairs.start; mapping && p < node->data.mapping.pairs.top; p++) {
        int key = copy_node(d, from, p->key), value = copy_node(d, from, p->value);
        if (!key || !value || !yaml_document_append_mapping_pair(&d->yaml, mapping, key, value))
            return 0;
    }
    return mapping;
}

static status add_pair(const walk *w, const char *key, int value)
{
    yaml_document_t *yaml = &w->d->yaml;
    int name = yaml_document_add_scalar(yaml, NULL, (const yaml_char_t *)key, (int)strlen(key), YAML_ANY_SCALAR_STYLE);
    if (!name || !value || !yaml_document_append_mapping_pair(yaml, w->node, name, value))
        return out_of_memory(w);
    return STATUS_OK;
}

static status set_key(walk *w, const char *key, int value)
{
    yaml_node_t *node = yaml_document_get_node(&w->d->yaml, w->node);
    for (yaml_node_pair_t *p = node->data.mapping.pairs.start; p < node->data.mapping.pairs.top; p++) {
        const char *name = document_scalar(w->d, p->key);
        if (name && strcmp(name, key) == 0) {
            p->value = value;
            return STATUS_OK;
        }
    }
    return add_pair(w, key, value);
}

/* One step of a path: `key` or `[selector]`. Takes it off `rest`. */
static status next_step(const walk *w, const char **rest, char *step, bool *selector)
{
    const char *p = *rest;
    *selector = *p == '[';
    if (*p == '[' || *p == '.')
        p++;
    size_t length = *selector ? strcspn(p, "]") : strcspn(p, ".[");
    if (length >= STEP_MAX)
        return set_fail(w, "a step of the path is longer than %d characters", STEP_MAX - 1);
    memcpy(step, p, length);
    step[length] = '\0';
    p += length;
    if (*selector && *p != ']')
        return set_fail(w, "the path lacks a `]`");
    if (length == 0)
        return set_fail(w, "the path has an empty step; it reads like `walls[floor].point_m=[0,0,1]`");
    p += *selector;
    if (*selector && *p && *p != '.' && *p != '[')
        return set_fail(w, "the path needs a `.` or `[` after `]`");
    *rest = p;
    return STATUS_OK;
}

/* after: the character that follows the step in the path. */
static status take_step(walk *w, const char *step, bool selector, char after, int value)
{
    document *d = w->d;
    bool last = after == '\0';
    char what[128];
    if (selector) {
        int index = 0;
        TRY(select_item(w, step, &index));
        if (last)
            yaml_document_get_node(&d->yaml, w->node)->data.sequence.items.start[index] = value;
        else
            w->node = document_item(d, w->node, index);
    } else {
        if (!document_is_mapping(d, w->node))
            return set_fail(w, "`%s` is %s, so it has no key `%s`%s", w->done, document_describe(d, w->node, what, sizeof what), step,
                            document_is_list(d, w->node) ? "; choose an entry by `[name]` or `[index]`" : "");
        if (last)
            return set_key(w, step, value);
        int next = document_find(d, w->node, step);
        if (!next && after == '[')
            return set_fail(w, "the scene has no list `%s%s%s` to choose an entry from", w->done, w->done[0] ? "." : "", step);
        if (!next) {
            next = yaml_document_add_mapping(&d->yaml, NULL, YAML_FLOW_MAPPING_STYLE);
            TRY(add_pair(w, step, next));
        }
        w->node = next;
    }
    size_t used = strlen(w->done);
    snprintf(w->done + used, sizeof w->done - used, selector ? "[%s]" : "%s%s", selector ? step : (used ? "." : ""), step);
    return STATUS_OK;
}

static status walk_path(walk *w, const char *path, int value)
{
    char step[STEP_MAX];
    bool selector = false;
    const char *rest = path;
    if (*rest == '.' || *rest == '[')
        return set_fail(w, "the path must begin with a key of the scene, like `walls[floor].point_m`");
    do {
        TRY(next_step(w, &rest, step, &selector));
        TRY(take_step(w, step, selector, *rest, value));
    } while (*rest);
    return STATUS_OK;
}

status document_set(document *d, const char *setting, failure *why)
{
    walk w = {.d = d, .setting = setting, .node = document_root(d), .why = why};
    const char *equals = strchr(setting, '=');
    if (!equals || equals == setting)
        return set_fail(&w, "must read `path=value`, like `walls[floor].point_m=[0,0,1]`");
    if (equals[1 + strspn(equals + 1, " \t\n")] == '\0')
        return set_fail(&w, "the value is missing after `=`");
    char what[600];
    snprintf(what, sizeof what, "--set %.500s", setting);
    yaml_document_t parsed;
    TRY(document_parse(&parsed, equals + 1, strlen(equals + 1), what, false, why));
    int value = copy_node(d, &parsed, 1);
    yaml_document_delete(&parsed);
    if (!value)
        return out_of_memory(&w);
    char *path = strndup(setting, (size_t)(equals - setting));
    if (!path)
        return out_of_memory(&w);
    status result = walk_path(&w, path, value);
    free(path);
    return result;
}
