/* From a file or a text to a checked scene. */
#include "scene_check.h"
#include "scene_table.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* A scene lists at most a few particles by hand; tables of particles come as csv. */
#define SCENE_BYTES_MAX ((size_t)256 << 20)

static void set_default_words(char ***words, int *count, const char *const *word, int number)
{
    if (*words)
        return; /* given, be it empty */
    *words = scene_allocate((size_t)number, sizeof **words);
    for (int k = 0; k < number; k++)
        (*words)[k] = scene_copy(word[k]);
    *count = number;
}

/* Defaults that hang on other parts of the scene, so no row of the table can hold them. */
static void fill_defaults(scene *s)
{
    static const char *const fields[] = {"position", "velocity", "spin"};
    static const char *const observables[] = {"kinetic_energy"};
    bool spins = scene_effect(s, -1, SLOT_TANGENTIAL) || scene_effect(s, -1, SLOT_ROLLING);
    set_default_words(&s->output.fields, &s->output.field_count, fields, spins ? 3 : 2);
    set_default_words(&s->output.observables, &s->output.observable_count, observables, 1);
    for (int k = 0; k < s->stage_count; k++) {
        char name[32];
        snprintf(name, sizeof name, "stage%d", k + 1);
        if (!s->stage[k].name)
            s->stage[k].name = scene_copy(name);
    }
}

static status read_document(document *d, const char *path, scene *s, failure *why)
{
    reader r = {d, s, why};
    TRY(parameter_section(&r, &scene_section, document_root(d), s));
    fill_defaults(s);
    TRY(scene_check(&r));
    s->path = scene_copy(path);
    s->text = document_text(d);
    return s->text ? STATUS_OK : fail(why, STATUS_ERROR, "%s: out of memory", path);
}

static status read_bytes(const char *text, size_t length, const char *path, int set_count, char *const *sets, scene **out, failure *why)
{
    document d;
    scene *s = scene_allocate(1, sizeof *s);
    status result = document_load(&d, text, length, path, set_count, sets, why);
    if (result == STATUS_OK)
        result = read_document(&d, path, s, why);
    document_free(&d);
    if (result != STATUS_OK) {
        scene_free(s);
        s = NULL;
    }
    *out = s;
    return result;
}

status scene_read_text(const char *text, const char *path, int set_count, char *const *sets, scene **out, failure *why)
{
    return read_bytes(text, strlen(text), path, set_count, sets, out, why);
}

static status read_stream(FILE *file, const char *path, char **text, size_t *length, failure *why)
{
    size_t capacity = 1 << 16;
    *text = scene_allocate(capacity, 1);
    *length = 0;
    for (;;) {
        size_t got = fread(*text + *length, 1, capacity - *length, file);
        *length += got;
        if (ferror(file))
            return fail(why, STATUS_BAD_INPUT, "%s: cannot be read: %s", path, strerror(errno));
        if (*length > SCENE_BYTES_MAX)
            return fail(why, STATUS_BAD_INPUT, "%s: larger than %zu MiB; give large tables of particles as csv", path,
                        SCENE_BYTES_MAX >> 20);
        if (got == 0)
            return STATUS_OK;
        if (*length == capacity) {
            char *larger = realloc(*text, 2 * capacity);
            if (!larger)
                return fail(why, STATUS_ERROR, "%s: out of memory", path);
            *text = larger;
            capacity *= 2;
        }
    }
}

status scene_read(const char *path, int set_count, char *const *sets, scene **out, failure *why)
{
    struct stat about;
    *out = NULL;
    if (stat(path, &about) == 0 && S_ISDIR(about.st_mode))
        return fail(why, STATUS_BAD_INPUT, "%s: is a folder; name the scene file in it", path);
    FILE *file = fopen(path, "rb");
    if (!file && errno == ENOENT)
        return fail(why, STATUS_BAD_INPUT, "%s: there is no such file", path);
    if (!file)
        return fail(why, STATUS_BAD_INPUT, "%s: cannot be opened: %s", path, strerror(errno));
    char *text = NULL;
    size_t length = 0;
    status result = read_stream(file, path, &text, &length, why);
    fclose(file);
    if (result == STATUS_OK)
        result = read_bytes(text, length, path, set_count, sets, out, why);
    free(text);
    return result;
}
