#include "document.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A scene needs eight levels; nobody should be led into a hundred thousand. */
#define NESTING_MAX 32

static void begin_message(char *out, size_t size, const char *path, bool with_place, yaml_mark_t mark)
{
    if (with_place)
        snprintf(out, size, "%s:%zu:%zu", path, mark.line + 1, mark.column + 1);
    else
        snprintf(out, size, "%s", path);
}

static yaml_mark_t mark_of_byte(const char *text, size_t offset)
{
    yaml_mark_t mark = {.index = offset};
    for (size_t k = 0; k < offset; k++) {
        mark.column = text[k] == '\n' ? 0 : mark.column + 1;
        mark.line += text[k] == '\n';
    }
    return mark;
}

static status parse_failure(const yaml_parser_t *parser, const char *text, const char *path, bool with_place, failure *why)
{
    char at[1024];
    const char *problem = parser->problem ? parser->problem : "the parser gave up";
    if (parser->error == YAML_MEMORY_ERROR)
        return fail(why, STATUS_ERROR, "%s: out of memory while reading the YAML text", path);
    if (parser->error == YAML_READER_ERROR) {
        begin_message(at, sizeof at, path, with_place, mark_of_byte(text, parser->problem_offset));
        return fail(why, STATUS_BAD_INPUT, "%s: not a text file in UTF-8: %s", at, problem);
    }
    begin_message(at, sizeof at, path, with_place, parser->problem_mark);
    if (strstr(problem, "cannot start any token"))
        return fail(why, STATUS_BAD_INPUT, "%s: not valid YAML: %s (a tab? indent with spaces; or a text that needs quotes)", at, problem);
    if (!parser->context)
        return fail(why, STATUS_BAD_INPUT, "%s: not valid YAML: %s", at, problem);
    if (!with_place)
        return fail(why, STATUS_BAD_INPUT, "%s: not valid YAML: %s %s", at, problem, parser->context);
    return fail(why, STATUS_BAD_INPUT, "%s: not valid YAML: %s %s that began at %zu:%zu", at, problem, parser->context,
                parser->context_mark.line + 1, parser->context_mark.column + 1);
}

/* One pass over the events, before the tree is built: depth, for a parser whose time grows with the square of it; anchors, for a tree
 * that no alias can make larger than the file, or endless; and what a scene has no use for. */
typedef struct inspection {
    const char *path;
    bool with_place;
    int documents, depth;
    bool mapping[NESTING_MAX], key_next[NESTING_MAX];
    failure *why;
} inspection;

static status inspect_failure(const inspection *in, const yaml_event_t *event, const char *message)
{
    char at[1024];
    begin_message(at, sizeof at, in->path, in->with_place, event->start_mark);
    return fail(in->why, STATUS_BAD_INPUT, "%s: %s", at, message);
}

/* Counts a node as a key or a value of the mapping around it; says whether it is a key. */
static bool take_place(inspection *in)
{
    if (in->depth == 0 || !in->mapping[in->depth - 1])
        return false;
    bool key = in->key_next[in->depth - 1];
    in->key_next[in->depth - 1] = !key;
    return key;
}

static status inspect_node(const inspection *in, const yaml_event_t *event, const yaml_char_t *anchor, const yaml_char_t *tag)
{
    if (anchor)
        return inspect_failure(in, event, "anchors and aliases (`&name`, `*name`) are not allowed in a scene; write the value out");
    if (tag)
        return inspect_failure(in, event, "tags (`!...`) have no meaning in a scene; remove the tag");
    return STATUS_OK;
}

static status inspect_scalar(inspection *in, const yaml_event_t *event)
{
    take_place(in);
    if (strlen((const char *)event->data.scalar.value) != event->data.scalar.length)
        return inspect_failure(in, event, "a text must not hold a zero byte");
    return inspect_node(in, event, event->data.scalar.anchor, event->data.scalar.tag);
}

static status inspect_start(inspection *in, const yaml_event_t *event)
{
    bool mapping = event->type == YAML_MAPPING_START_EVENT;
    if (mapping)
        TRY(inspect_node(in, event, event->data.mapping_start.anchor, event->data.mapping_start.tag));
    else
        TRY(inspect_node(in, event, event->data.sequence_start.anchor, event->data.sequence_start.tag));
    if (take_place(in))
        return inspect_failure(in, event, "a key must be one word");
    if (in->depth == NESTING_MAX)
        return inspect_failure(in, event, "nested too deeply; no key of a scene needs more than a few levels");
    in->mapping[in->depth] = mapping;
    in->key_next[in->depth++] = mapping;
    return STATUS_OK;
}

static status inspect_event(inspection *in, const yaml_event_t *event)
{
    switch (event->type) {
    case YAML_DOCUMENT_START_EVENT:
        return in->documents++ ? inspect_failure(in, event, "a second YAML document begins here; a scene is one document") : STATUS_OK;
    case YAML_ALIAS_EVENT:
        return inspect_node(in, event, event->data.alias.anchor, NULL);
    case YAML_SCALAR_EVENT:
        return inspect_scalar(in, event);
    case YAML_SEQUENCE_START_EVENT:
    case YAML_MAPPING_START_EVENT:
        return inspect_start(in, event);
    case YAML_SEQUENCE_END_EVENT:
    case YAML_MAPPING_END_EVENT:
        in->depth--;
        return STATUS_OK;
    default:
        return STATUS_OK;
    }
}

static status inspect(const char *text, size_t length, const char *path, bool with_place, failure *why)
{
    yaml_parser_t parser;
    yaml_event_t event;
    inspection in = {.path = path, .with_place = with_place, .why = why};
    if (!yaml_parser_initialize(&parser))
        return fail(why, STATUS_ERROR, "%s: out of memory", path);
    yaml_parser_set_input_string(&parser, (const unsigned char *)text, length);
    status result = STATUS_OK;
    for (bool last = false; !last && result == STATUS_OK;) {
        if (!yaml_parser_parse(&parser, &event)) {
            result = parse_failure(&parser, text, path, with_place, why);
            break;
        }
        last = event.type == YAML_STREAM_END_EVENT;
        result = inspect_event(&in, &event);
        yaml_event_delete(&event);
    }
    yaml_parser_delete(&parser);
    char begin[1024];
    begin_message(begin, sizeof begin, path, with_place, (yaml_mark_t){0});
    if (result == STATUS_OK && in.documents == 0)
        result = fail(why, STATUS_BAD_INPUT, "%s: holds no YAML; a scene begins with keys such as `materials:`", begin);
    return result;
}

status document_parse(yaml_document_t *out, const char *text, size_t length, const char *path, bool with_place, failure *why)
{
    TRY(inspect(text, length, path, with_place, why));
    yaml_parser_t parser;
    if (!yaml_parser_initialize(&parser))
        return fail(why, STATUS_ERROR, "%s: out of memory", path);
    yaml_parser_set_input_string(&parser, (const unsigned char *)text, length);
    status result = yaml_parser_load(&parser, out) ? STATUS_OK : parse_failure(&parser, text, path, with_place, why);
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
