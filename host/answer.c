#include "answer.h"

#include "hdf5_common.h"
#include "scene_table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const output_name *find_name(const output_name *known, const char *name)
{
    while (known->name && strcmp(known->name, name) != 0)
        known++;
    return known->name ? known : NULL;
}

static status unknown_name(const output_name *known, const char *kind, const char *name, failure *why)
{
    const char *names[64];
    int count = 0;
    for (; known->name && count < 64; known++)
        names[count++] = known->name;
    const char *nearest = word_nearest(name, names, count);
    if (nearest)
        return fail(why, STATUS_BAD_INPUT, "there is no %s called `%.60s`; did you mean `%s`?", kind, name, nearest);
    return fail(why, STATUS_BAD_INPUT, "there is no %s called `%.60s`; the scene reference lists them under `output`", kind, name);
}

/* Takes a trailing ".x" or ".xy" off a name: which of so many components, or -1 where none is named. */
static status take_component(char *name, int components, int *out, failure *why)
{
    static const char *const three[] = {"x", "y", "z"}, *const nine[] = {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};
    char *dot = strrchr(name, '.');
    *out = -1;
    if (!dot)
        return STATUS_OK;
    for (int c = 0; c < components && components > 1; c++)
        if (strcmp(dot + 1, components == 9 ? nine[c] : c < 3 ? three[c] : "") == 0)
            *out = c;
    if (*out < 0)
        return fail(why, STATUS_BAD_INPUT, "`%.20s` is no component of `%.*s`, which has %d", dot + 1, (int)(dot - name), name, components);
    *dot = '\0';
    return STATUS_OK;
}

/* "name]" at the start of text: the name, and what follows the bracket; NULL where there is no bracket. */
static const char *take_index(const char *text, char *name, size_t size)
{
    size_t length = strcspn(text, "]");
    if (text[length] != ']' || length == 0 || length >= size)
        return NULL;
    memcpy(name, text, length);
    name[length] = '\0';
    return text + length + 1;
}

static status find_source(const output_name *known, const char *kind, const char *name, answer *out, failure *why)
{
    char whole[128], plain[128];
    if (strlen(name) >= sizeof whole)
        return fail(why, STATUS_BAD_INPUT, "there is no %s called `%.60s...`", kind, name);
    strcpy(whole, name);
    snprintf(plain, sizeof plain, "%.*s", (int)strcspn(name, "."), name);
    const output_name *found = find_name(known, plain);
    if (!found)
        return unknown_name(known, kind, plain, why);
    if (found->needs)
        return fail(why, STATUS_BAD_INPUT, "the %s `%s` needs %s, which this version does not have", kind, plain, found->needs);
    out->components = found->components;
    TRY(take_component(whole, found->components, &out->component, why));
    strcpy(out->source, plain);
    return STATUS_OK;
}

static status find_grains(const scene *s, const char *text, answer *out, failure *why)
{
    char name[128], *end;
    const char *rest = take_index(text + strlen("particles["), name, sizeof name);
    if (!rest)
        return fail(why, STATUS_BAD_INPUT, "`%.60s`: write particles[GROUP].FIELD or particles[GROUP].items[N].FIELD", text);
    for (int g = 0; g < s->group_count; g++)
        if (strcmp(s->group[g].name, name) == 0)
            out->group = g;
    if (out->group < 0)
        return fail(why, STATUS_BAD_INPUT, "there is no particle group called `%s`", name);
    if (strncmp(rest, ".items[", 7) == 0) {
        rest = take_index(rest + 7, name, sizeof name);
        out->item = rest ? strtoll(name, &end, 10) : -1;
        if (!rest || *end != '\0' || out->item < 0)
            return fail(why, STATUS_BAD_INPUT, "`%.60s`: the grain's place in its group is a whole number, counted from 0", text);
        if (s->group[out->group].generator == GENERATOR_LIST && out->item >= s->group[out->group].item_count)
            return fail(why, STATUS_BAD_INPUT, "`%.60s`: the group has %d grains, counted from 0", text, s->group[out->group].item_count);
    }
    if (*rest != '.')
        return fail(why, STATUS_BAD_INPUT, "`%.60s`: which field? Write particles[GROUP].FIELD or particles[GROUP].items[N].FIELD", text);
    return find_source(output_fields, "field", rest + 1, out, why);
}

static status find_wall(const scene *s, const char *text, answer *out, failure *why)
{
    static const output_name of_walls[] = {
        {.name = "force", .components = 3}, {.name = "torque", .components = 3}, {.name = "heat", .components = 1}, {0}};
    char name[64], source[sizeof out->source + 80];
    const char *rest = take_index(text + strlen("walls["), name, sizeof name);
    bool found = false;
    for (int w = 0; rest && w < s->wall_count; w++)
        found |= strcmp(s->wall[w].name, name) == 0;
    if (!rest || !found || *rest != '.')
        return fail(why, STATUS_BAD_INPUT, "`%.60s`: write walls[WALL].force, .torque or .heat with the name of a wall", text);
    TRY(find_source(of_walls, "number of a wall", rest + 1, out, why));
    snprintf(source, sizeof source, "walls/%s/%s", name, out->source);
    if (strlen(source) >= sizeof out->source)
        return fail(why, STATUS_BAD_INPUT, "`%.60s`: the wall's name is too long", text);
    strcpy(out->source, source);
    return STATUS_OK;
}

status answer_find(const scene *scene, const char *text, answer *out, failure *why)
{
    *out = (answer){.text = text, .group = -1, .item = -1, .component = -1};
    if (strncmp(text, "particles[", 10) == 0)
        return find_grains(scene, text, out, why);
    if (strncmp(text, "walls[", 6) == 0)
        return find_wall(scene, text, out, why);
    return find_source(output_observables, "observable", text, out, why);
}

int answer_width(const answer *a, const int64_t *first)
{
    int64_t grains = a->group < 0 || a->item >= 0 ? 1 : first[a->group + 1] - first[a->group];
    return (int)grains * (a->component >= 0 ? 1 : a->components);
}

/* Picks the answer's numbers out of rows of `rows` x components. */
static void pick(const answer *a, const int64_t *first, const double *all, int64_t rows, answer_series *out)
{
    int64_t low = a->group < 0 ? 0 : a->item >= 0 ? first[a->group] + a->item : first[a->group];
    int each = a->component >= 0 ? 1 : a->components;
    for (int s = 0; s < out->samples; s++)
        for (int k = 0; k < out->width; k++) {
            int component = a->component >= 0 ? a->component : k % each;
            out->value[(size_t)s * (size_t)out->width + (size_t)k] =
                all[((size_t)s * (size_t)rows + (size_t)(low + k / each)) * (size_t)a->components + (size_t)component];
        }
}

static status read_pair(hid_t file, const char *path, const char *at, const answer *a, const int64_t *first, answer_series *out,
                        failure *why)
{
    char name[256];
    snprintf(name, sizeof name, "%s/value", at);
    hid_t value = H5Dopen2(file, name, H5P_DEFAULT);
    snprintf(name, sizeof name, "%s/time", at);
    hid_t time = H5Dopen2(file, name, H5P_DEFAULT);
    hsize_t extent[H5S_MAX_RANK] = {0}, times = 0;
    status result = STATUS_OK;
    double *all = NULL;
    if (value < 0 || time < 0) {
        result = fail(why, STATUS_ERROR, "%s: holds no %s", path, at);
    } else {
        hid_t space = H5Dget_space(value), time_space = H5Dget_space(time);
        int rank = H5Sget_simple_extent_dims(space, extent, NULL);
        H5Sget_simple_extent_dims(time_space, &times, NULL);
        int64_t rows = a->group < 0 ? 1 : (int64_t)extent[1], count = 1;
        for (int k = 0; k < rank; k++)
            count *= (int64_t)extent[k];
        *out = (answer_series){.samples = (int)extent[0], .width = answer_width(a, first)};
        out->time = calloc((size_t)out->samples + 1, sizeof *out->time);
        out->value = calloc((size_t)out->samples * (size_t)out->width + 1, sizeof *out->value);
        all = calloc((size_t)count + 1, sizeof *all);
        bool fits = times == extent[0] && count == (int64_t)out->samples * rows * a->components;
        if (!out->time || !out->value || !all)
            result = fail(why, STATUS_ERROR, "out of memory");
        else if (!fits || H5Dread(value, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, all) < 0 ||
                 H5Dread(time, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, out->time) < 0)
            result = fail(why, STATUS_ERROR, "%s: %s cannot be read", path, at);
        else
            pick(a, first, all, rows, out);
        H5Sclose(space);
        H5Sclose(time_space);
    }
    if (value >= 0)
        H5Dclose(value);
    if (time >= 0)
        H5Dclose(time);
    free(all);
    return result;
}

status answer_read(const char *path, const answer *a, const int64_t *first, answer_series *out, failure *why)
{
    char at[200];
    hid_t file;
    *out = (answer_series){0};
    TRY(hdf5_open_read(path, "a results file", &file, why));
    snprintf(at, sizeof at, a->group < 0 ? "observables/%s" : "particles/all/%s", a->source);
    status result = read_pair(file, path, at, a, first, out, why);
    H5Fclose(file);
    if (result != STATUS_OK)
        answer_free(out);
    return result;
}

void answer_merge(answer_series *series, double within_s)
{
    int kept = 0;
    for (int k = 0; k < series->samples; k++) {
        if (k + 1 < series->samples && series->time[k + 1] - series->time[k] < within_s)
            continue;
        series->time[kept] = series->time[k];
        memmove(&series->value[kept * series->width], &series->value[k * series->width], sizeof *series->value * (size_t)series->width);
        kept++;
    }
    series->samples = kept;
}

void answer_free(answer_series *series)
{
    free(series->time);
    free(series->value);
    *series = (answer_series){0};
}

static status check_closed_form(const scene *scene, const closed_form *form, failure *why)
{
    const study_spec *study = &scene->study;
    answer found;
    failure wrong;
    bool known = answer_find(scene, form->answer, &found, &wrong) == STATUS_OK; /* else `wrong` says why */
    if (known && ((found.group >= 0 && found.item < 0) || (found.components > 1 && found.component < 0)))
        snprintf(wrong.text, sizeof wrong.text, "`%.100s` is more than one number; name one grain and one component", form->answer);
    else if (known && (form->time_count != form->value_count || form->time_count == 0))
        snprintf(wrong.text, sizeof wrong.text, "`time_s` has %d entries and `value` %d; give as many of both, and one at least",
                 form->time_count, form->value_count);
    else if (known) {
        for (int k = 0; k < study->answer_count; k++)
            if (strcmp(study->answers[k], form->answer) == 0)
                return STATUS_OK;
        snprintf(wrong.text, sizeof wrong.text, "`%.100s` is not among the `answers`; list it there, in the same words", form->answer);
    }
    return fail(why, STATUS_BAD_INPUT, "%s:%d:%d: closed form: %.1000s", scene->path, form->at.line, form->at.column, wrong.text);
}

status answer_check_study(const scene *scene, failure *why)
{
    const study_spec *study = &scene->study;
    answer found;
    failure wrong;
    for (int k = 0; k < study->answer_count; k++)
        if (answer_find(scene, study->answers[k], &found, &wrong) != STATUS_OK)
            return fail(why, STATUS_BAD_INPUT, "%s: study.answers[%d]: %.1000s", scene->path, k, wrong.text);
    for (int k = 0; k < study->closed_form_count; k++)
        TRY(check_closed_form(scene, &study->closed_form[k], why));
    return STATUS_OK;
}

status answer_check_scene(const scene *s, failure *why)
{
    scene *studied = NULL;
    if (s->study.set_count == 0)
        return answer_check_study(s, why);
    TRY(scene_read(s->path, s->study.set_count, s->study.set, &studied, why));
    status result = answer_check_study(studied, why);
    scene_free(studied);
    return result;
}
