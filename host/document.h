/* The YAML document behind a scene: a tree whose every node knows where it was written, changed by `--set` before anybody reads it. */
#ifndef CLAST_HOST_DOCUMENT_H
#define CLAST_HOST_DOCUMENT_H
#include "scene.h"
#include "status.h"

#include <yaml.h>

/* Nodes are named by libyaml's ids, counted from 1; 0 is none. */
typedef struct document {
    const char *path; /* as the user gave it; messages begin with it */
    yaml_document_t yaml;
    bool loaded;
    char *const *set; /* the `--set` strings as given */
    int set_count;    /* those applied so far */
    int *set_first;   /* first node that each of them brought */
} document;

/* Reads the text and applies the settings in order. Rejects what a scene has no use for: anchors and aliases, tags, keys
 * that are not words, more than one document, deep nesting. */
status document_load(document *d, const char *text, size_t length, const char *path, int set_count, char *const *sets, failure *why);
void document_free(document *d);
/* The document as YAML text, or NULL when out of memory; uses the document up. */
char *document_text(document *d);

int document_root(document *d);
const yaml_node_t *document_node(document *d, int node);
bool document_is_scalar(document *d, int node);
bool document_is_list(document *d, int node);
bool document_is_mapping(document *d, int node);
/* The scalar's text, or NULL. */
const char *document_scalar(document *d, int node);
int document_length(document *d, int list);
int document_item(document *d, int list, int index);
/* The value of a key, or 0. */
int document_find(document *d, int mapping, const char *key);
/* The deepest node that exists along a path in the form of `--set`, for messages. */
int document_at(document *d, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Line and column; zeros for a node that came from `--set`. */
place document_place(document *d, int node);
/* "scene.yaml:12:5: message", or "--set path=value: message". Returns STATUS_BAD_INPUT. */
status document_fail(document *d, int node, failure *why, const char *format, ...) __attribute__((format(printf, 4, 5)));
/* What a node is, in words for a message: "the text `x`", "a list of 3". */
const char *document_describe(document *d, int node, char *text, size_t size);

/* Applies one `path=value` (host/document_set.c). */
status document_set(document *d, const char *setting, failure *why);
/* Parses one YAML document, a scene or the value of a setting; messages begin with `path`, and with line and column when with_place. */
status document_parse(yaml_document_t *out, const char *text, size_t length, const char *path, bool with_place, failure *why);

#endif
