#include "document.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A scene needs eight levels; a walker that recurses must not be led into a hundred thousand. */
#define NESTING_MAX 32

static void begin_message(char *out, size_t size, const char *path, bool with_place, yaml_mark_t mark)
{
    if (with_place)
        snprintf(out, size, "%s:%zu:%zu", path, mark.line + 1, mark.column + 1);
    else
        snprintf(out, size, "%s", path);
}

static status parse_failure(const yaml_parser_t *parser, const char *path, bool with_place, failure *why)
{
    char at[1024];
    const char *problem = parser->problem ? parser->problem : "the parser gave up";
    if (parser->error == YAML_MEMORY_ERROR)
        return fail(why, STATUS_ERROR, "%s: out of memory while reading the YAML text", path);
    if (parser->error == YAML_READER_ERROR)
        return fail(why, STATUS_BAD_INPUT, "%s: not a text file in UTF-8: %s at byte %zu", path, problem, parser->problem_offset);
    begin_message(at, sizeof at, path, with_place, parser->problem_mark);
    if (!parser->context)
        return fail(why, STATUS_BAD_INPUT, "%s: not valid YAML: %s", at, problem);
    if (!with_place)
        return fail(why, STATUS_BAD_INPUT, "%s: not valid YAML: %s %s", at, problem, parser->context);
    return fail(why, STATUS_BAD_INPUT, "%s: not valid YAML: %s %s that began at %zu:%zu", at, problem, parser->context,
                parser->context_mark.line + 1, parser->context_mark.column + 1);
}

typedef struct inspection {
    yaml_document_t *yaml;
    char *seen; /* by node id */
    const char *path;
    bool with_place;
    failure *why;
} inspection;

static status inspect_failure(const inspection *in, const yaml_node_t *node, const char *message)
{
    char at[1024];
    begin_message(at, sizeof at, in->path, in->with_place, node->start_mark);
    return fail(in->why, STATUS_BAD_INPUT, "%s: %s", at, message);
}

static status inspect_scalar(const inspection *in, const yaml_node_t *node)
{
    if (strcmp((const char *)node->tag, YAML_STR_TAG) != 0)
        return inspect_failure(in, node, "tags (`!...`) have no meaning in a scene; remove the tag");
    if (strlen((const char *)node->data.scalar.value) != node->data.scalar.length)
        return inspect_failure(in, node, "a text must not hold a zero byte");
    return STATUS_OK;
}

/* Every node is reached once, so that no alias can make the tree larger than the file, or endless. */
static status inspect(const inspection *in, int id, int depth)
{
    const yaml_node_t *node = yaml_document_get_node(in->yaml, id);
    if (in->seen[id])
        return inspect_failure(in, node, "anchors and aliases (`&name`, `*name`) are not allowed in a scene; write the value out");
    in->seen[id] = 1;
    if (depth > NESTING_MAX)
        return inspect_failure(in, node, "nested too deeply; no key of a scene needs more than a few levels");
    if (node->type == YAML_SCALAR_NODE)
        return inspect_scalar(in, node);
    if (strcmp((const char *)node->tag, node->type == YAML_SEQUENCE_NODE ? YAML_SEQ_TAG : YAML_MAP_TAG) != 0)
        return inspect_failure(in, node, "tags (`!...`) have no meaning in a scene; remove the tag");
    if (node->type == YAML_SEQUENCE_NODE) {
        for (const yaml_node_item_t *i = node->data.sequence.items.start; i < node->data.sequence.items.top; i++)
            TRY(inspect(in, *i, depth + 1));
        return STATUS_OK;
    }
    for (const yaml_node_pair_t *p = node->data.mapping.pairs.start; p < node->data.mapping.pairs.top; p++) {
        const yaml_node_t *key = yaml_document_get_node(in->yaml, p->key);
        if (key->type != YAML_SCALAR_NODE)
            return inspect_failure(in, key, "a key must be one word");
        TRY(inspect(in, p->key, depth + 1));
        TRY(inspect(in, p->value, depth + 1));
    }
    return STATUS_OK;
}

static status inspect_all(yaml_document_t *yaml, const char *path, bool with_place, failure *why)
{
    if (!yaml_document_get_root_node(yaml))
        return fail(why, STATUS_BAD_INPUT, "%s: holds no YAML; a scene begins with keys such as `materials:`", path);
    char *seen = calloc((size_t)(yaml->nodes.top - yaml->nodes.start) + 1, 1);
    if (!seen)
        return fail(why, STATUS_ERROR, "%s: out of memory", path);
    const inspection in = {yaml, seen, path, with_place, why};
    status result = inspect(&in, 1, 0);
    free(seen);
    return result;
}

static status refuse_second_document(yaml_parser_t *parser, const char *path, bool with_place, failure *why)
{
    yaml_document_t next;
    if (!yaml_parser_load(parser, &next))
        return parse_failure(parser, path, with_place, why);
    const yaml_node_t *root = yaml_document_get_root_node(&next);
    status result = STATUS_OK;
    if (root) {
        char at[1024];
        begin_message(at, sizeof at, path, with_place, root->start_mark);
        result = fail(why, STATUS_BAD_INPUT, "%s: a second YAML document begins here; a scene is one document", at);
    }
    yaml_document_delete(&next);
    return result;
}

status document_parse(yaml_document_t *out, const char *text, size_t length, const char *path, bool with_place, failure *why)
{
    yaml_parser_t parser;
    if (!yaml_parser_initialize(&parser))
        return fail(why, STATUS_ERROR, "%s: out of memory", path);
    yaml_parser_set_input_string(&parser, (const unsigned char *)text, length);
    status result = STATUS_OK;
    bool loaded = yaml_parser_load(&parser, out);
    if (!loaded)
        result = parse_failure(&parser, path, with_place, why);
    if (result == STATUS_OK)
        result = inspect_all(out, path, with_place, why);
    if (result == STATUS_OK)
        result = refuse_second_document(&parser, path, with_place, why);
    if (loaded && result != STATUS_OK)
        yaml_document_delete(out);
    yaml_parser_delete(&parser);
    return result;
}

status document_load(document *d, const char *text, size_t length, const char *path, int set_count, char *const *sets, failure *why)
{
    *d = (document){.path = path, .set = sets};
    TRY(document_parse(&d->yaml, text, length, path, true, why));
    d->loaded = true;
    d->set_first = calloc((size_t)set_count + 1, sizeof *d->set_first);
    if (!d->set_first)
        return fail(why, STATUS_ERROR, "%s: out of memory", path);
    for (int k = 0; k < set_count; k++) {
        d->set_first[k] = (int)(d->yaml.nodes.top - d->yaml.nodes.start) + 1;
        d->set_count = k + 1;
        TRY(document_set(d, sets[k], why));
    }
    return STATUS_OK;
}

void document_free(document *d)
{
    if (d->loaded)
        yaml_document_delete(&d->yaml);
    d->loaded = false;
    free(d->set_first);
    d->set_first = NULL;
}

typedef struct text_buffer {
    char *text;
    size_t length, capacity;
} text_buffer;

static int append_text(void *data, unsigned char *bytes, size_t size)
{
    text_buffer *buffer = data;
    if (buffer->length + size + 1 > buffer->capacity) {
        size_t capacity = 2 * (buffer->length + size + 1);
        char *larger = realloc(buffer->text, capacity);
        if (!larger)
            return 0;
        buffer->text = larger;
        buffer->capacity = capacity;
    }
    memcpy(buffer->text + buffer->length, bytes, size);
    buffer->length += size;
    buffer->text[buffer->length] = '\0';
    return 1;
}

char *document_text(document *d)
{
    text_buffer buffer = {0};
    yaml_emitter_t emitter;
    if (!yaml_emitter_initialize(&emitter))
        return NULL;
    yaml_emitter_set_output(&emitter, append_text, &buffer);
    yaml_emitter_set_unicode(&emitter, 1);
    yaml_emitter_set_width(&emitter, 140);
    bool good = yaml_emitter_open(&emitter);
    if (good) {
        d->loaded = false; /* the emitter frees the document, whether it succeeds or not */
        good = yaml_emitter_dump(&emitter, &d->yaml) && yaml_emitter_close(&emitter) && yaml_emitter_flush(&emitter);
    }
    yaml_emitter_delete(&emitter);
    if (!good) {
        free(buffer.text);
        return NULL;
    }
    return buffer.text;
}

int document_root(document *d)
{
    return yaml_document_get_root_node(&d->yaml) ? 1 : 0;
}

const yaml_node_t *document_node(document *d, int node)
{
    return yaml_document_get_node(&d->yaml, node);
}

bool document_is_scalar(document *d, int node)
{
    return document_node(d, node)->type == YAML_SCALAR_NODE;
}

bool document_is_list(document *d, int node)
{
    return document_node(d, node)->type == YAML_SEQUENCE_NODE;
}

bool document_is_mapping(document *d, int node)
{
    return document_node(d, node)->type == YAML_MAPPING_NODE;
}

const char *document_scalar(document *d, int node)
{
    return document_is_scalar(d, node) ? (const char *)document_node(d, node)->data.scalar.value : NULL;
}

int document_length(document *d, int list)
{
    const yaml_node_t *node = document_node(d, list);
    return node->type == YAML_SEQUENCE_NODE ? (int)(node->data.sequence.items.top - node->data.sequence.items.start) : 0;
}

int document_item(document *d, int list, int index)
{
    return document_node(d, list)->data.sequence.items.start[index];
}

int document_find(document *d, int mapping, const char *key)
{
    const yaml_node_t *node = document_node(d, mapping);
    if (!node || node->type != YAML_MAPPING_NODE)
        return 0;
    for (const yaml_node_pair_t *p = node->data.mapping.pairs.start; p < node->data.mapping.pairs.top; p++) {
        const char *name = document_scalar(d, p->key);
        if (name && strcmp(name, key) == 0)
            return p->value;
    }
    return 0;
}

int document_at(document *d, const char *format, ...)
{
    char path[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(path, sizeof path, format, arguments);
    va_end(arguments);
    int node = document_root(d);
    for (char *rest = path; *rest;) {
        size_t length = strcspn(rest, ".[]");
        char end = rest[length];
        rest[length] = '\0';
        if (length > 0) {
            bool index = strspn(rest, "0123456789") == length;
            int next = 0;
            if (!index)
                next = document_find(d, node, rest);
            else if (document_is_list(d, node) && atoi(rest) < document_length(d, node))
                next = document_item(d, node, atoi(rest));
            if (!next)
                return node;
            node = next;
        }
        rest += length + (end != '\0');
    }
    return node;
}

static int set_of_node(const document *d, int node)
{
    for (int k = d->set_count - 1; k >= 0; k--)
        if (node >= d->set_first[k])
            return k;
    return -1;
}

place document_place(document *d, int node)
{
    const yaml_node_t *n = document_node(d, node);
    if (!n || set_of_node(d, node) >= 0)
        return (place){0, 0};
    return (place){(int)n->start_mark.line + 1, (int)n->start_mark.column + 1};
}

status document_fail(document *d, int node, failure *why, const char *format, ...)
{
    char message[3072];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    int set = set_of_node(d, node);
    if (set >= 0)
        return fail(why, STATUS_BAD_INPUT, "--set %.500s: %s", d->set[set], message);
    place at = document_place(d, node);
    return fail(why, STATUS_BAD_INPUT, "%s:%d:%d: %s", d->path, at.line, at.column, message);
}

const char *document_describe(document *d, int node, char *text, size_t size)
{
    const yaml_node_t *n = document_node(d, node);
    if (n->type == YAML_SEQUENCE_NODE)
        snprintf(text, size, "a list of %d", document_length(d, node));
    else if (n->type == YAML_MAPPING_NODE)
        snprintf(text, size, "a mapping (`key: value`)");
    else if (n->data.scalar.length == 0 && n->data.scalar.style == YAML_PLAIN_SCALAR_STYLE)
        snprintf(text, size, "empty");
    else if (n->data.scalar.style == YAML_PLAIN_SCALAR_STYLE)
        snprintf(text, size, "`%.60s`", (const char *)n->data.scalar.value);
    else
        snprintf(text, size, "the text \"%.60s\"", (const char *)n->data.scalar.value);
    return text;
}
