/* One value of a scene: from the YAML node to the field that its row of the parameter table names. */
#include "parameter.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Longest suffix first. */
static const struct {
    const char *suffix, *unit;
} units[] = {
    {"_kg_m3", "kg/m^3"}, {"_j_kgk", "J/(kg K)"},
    {"_rad_s", "rad/s"},  {"_w_m2k", "W/(m^2 K)"},
    {"_j_mol", "J/mol"},  {"_w_m3", "W/m^3"},
    {"_w_mk", "W/(m K)"}, {"_pa_s", "Pa s"},
    {"_m3_s", "m^3/s"},   {"_j_m2", "J/m^2"},
    {"_m_s2", "m/s^2"},   {"_m_s", "m/s"},
    {"_n_m", "N/m"},      {"_rad", "rad"},
    {"_1_k", "1/K"},      {"_1_m", "1/m"},
    {"_k_s", "K/s"},      {"_m3", "m^3"},
    {"_m2", "m^2"},       {"_pa", "Pa"},
    {"_hz", "Hz"},        {"_m", "m"},
    {"_s", "s"},          {"_k", "K"},
    {"_j", "J"},
};

const char *parameter_unit(const char *key)
{
    size_t length = strlen(key);
    for (size_t k = 0; k < sizeof units / sizeof *units; k++) {
        size_t suffix = strlen(units[k].suffix);
        if (length > suffix && strcmp(key + length - suffix, units[k].suffix) == 0)
            return units[k].unit;
    }
    return NULL;
}

bool vector_normalise(double v[3])
{
    double length = hypot(hypot(v[0], v[1]), v[2]);
    if (!(length > 0.0) || !isfinite(length))
        return false;
    for (int k = 0; k < 3; k++)
        v[k] /= length;
    return true;
}

static bool has_range(const parameter *row)
{
    return row->low != 0.0 || row->high != 0.0 || row->open_low;
}

void parameter_range(const parameter *row, char *text, size_t size)
{
    char low[48] = "", high[48] = "";
    if (has_range(row) && row->low > -INFINITY)
        snprintf(low, sizeof low, "%s %.10g", row->open_low ? "above" : "at least", row->low);
    if (has_range(row) && row->high < INFINITY)
        snprintf(high, sizeof high, "at most %.10g", row->high);
    snprintf(text, size, "%s%s%s", low, low[0] && high[0] ? ", " : "", high);
}

void parameter_allowed(const parameter *row, char *text, size_t size)
{
    char range[128];
    parameter_range(row, range, sizeof range);
    const char *kind = row->type == PARAMETER_INTEGER || row->type == PARAMETER_COUNTS ? "a whole number" : "a number";
    snprintf(text, size, "%s%s%s%s%s%s%s%s", kind, row->unit ? " in " : "", row->unit ? row->unit : "", range[0] ? ", " : "", range,
             row->word ? ", or `" : "", row->word ? row->word : "", row->word ? "`" : "");
}

static status wrong_number(reader *r, const parameter *row, int node, const char *advice)
{
    char allowed[256], what[128];
    parameter_allowed(row, allowed, sizeof allowed);
    return document_fail(r->document, node, r->why, "`%s` must be %s; it is %s%s", row->key, allowed,
                         document_describe(r->document, node, what, sizeof what), advice);
}

status parameter_number(reader *r, const parameter *row, int node, double *out)
{
    const char *text = document_scalar(r->document, node);
    if (!text)
        return wrong_number(r, row, node, "");
    if (document_node(r->document, node)->data.scalar.style != YAML_PLAIN_SCALAR_STYLE)
        return wrong_number(r, row, node, "; remove the quotes");
    char *end;
    double value = strtod(text, &end);
    if (text[0] == '\0' || end == text)
        return wrong_number(r, row, node, "");
    /* strtod also takes hexadecimal, inf and nan. */
    if (*end == '\0' && !isfinite(value) && strpbrk(text, "nN"))
        return wrong_number(r, row, node, ", which is no finite number");
    if (*end != '\0' || strspn(text, "0123456789+-.eE") != strlen(text))
        return wrong_number(r, row, node, "; write the number alone, in SI, without a unit");
    if (!isfinite(value))
        return wrong_number(r, row, node, ", which is too large for a number");
    if (has_range(row) && (value < row->low || value > row->high || (row->open_low && value <= row->low)))
        return wrong_number(r, row, node, "");
    *out = value;
    return STATUS_OK;
}

static status read_integer(reader *r, const parameter *row, int node, int64_t *out)
{
    double value = 0.0;
    TRY(parameter_number(r, row, node, &value));
    if (value != floor(value))
        return wrong_number(r, row, node, ", which has a fraction");
    if (fabs(value) > 9007199254740992.0)
        return wrong_number(r, row, node, ", which is beyond 2^53");
    *out = (int64_t)value;
    return STATUS_OK;
}

status parameter_list_length(reader *r, const parameter *row, int node, int *out)
{
    char what[128];
    if (!document_is_list(r->document, node))
        return document_fail(r->document, node, r->why, "`%s` must be a list (`[a, b]`, or one `- ` a line); it is %s", row->key,
                             document_describe(r->document, node, what, sizeof what));
    *out = document_length(r->document, node);
    return STATUS_OK;
}

static status check_three(reader *r, const parameter *row, int node)
{
    char what[128];
    if (document_is_list(r->document, node) && document_length(r->document, node) == 3)
        return STATUS_OK;
    return document_fail(r->document, node, r->why, "`%s` must be three numbers [x, y, z]%s%s; it is %s", row->key, row->unit ? " in " : "",
                         row->unit ? row->unit : "", document_describe(r->document, node, what, sizeof what));
}

status parameter_vector(reader *r, const parameter *row, int node, double out[3])
{
    TRY(check_three(r, row, node));
    for (int k = 0; k < 3; k++)
        TRY(parameter_number(r, row, document_item(r->document, node, k), &out[k]));
    return STATUS_OK;
}

status parameter_numbers(reader *r, const parameter *row, int node, double **out, int *count)
{
    int length = 0;
    TRY(parameter_list_length(r, row, node, &length));
    if (length == 0)
        return document_fail(r->document, node, r->why, "`%s` must hold at least one number", row->key);
    *out = scene_allocate((size_t)length, sizeof **out);
    *count = length;
    for (int k = 0; k < length; k++)
        TRY(parameter_number(r, row, document_item(r->document, node, k), &(*out)[k]));
    return STATUS_OK;
}

status parameter_word(reader *r, const char *key, int node, const char **out)
{
    char what[128];
    *out = document_scalar(r->document, node);
    if (*out && **out)
        return STATUS_OK;
    return document_fail(r->document, node, r->why, "`%s` must be a word; it is %s", key,
                         document_describe(r->document, node, what, sizeof what));
}

static status wrong_choice(reader *r, const parameter *row, int node, const char *word)
{
    char list[512];
    words_list(row->choices, list, sizeof list);
    if (words_find(row->later, word) >= 0)
        return document_fail(r->document, node, r->why, "`%s: %s` is not in this version yet; it has %s", row->key, word, list);
    const char *known[32];
    char copy[512];
    int count = 0;
    snprintf(copy, sizeof copy, "%s", row->choices);
    for (char *save = NULL, *w = strtok_r(copy, "|", &save); w && count < 32; w = strtok_r(NULL, "|", &save))
        known[count++] = w;
    const char *nearest = word_nearest(word, known, count);
    return document_fail(r->document, node, r->why, "`%s` must be one of %s; it is `%.60s`%s%s%s", row->key, list, word,
                         nearest ? " (did you mean `" : "", nearest ? nearest : "", nearest ? "`?)" : "");
}

static status read_choice(reader *r, const parameter *row, int node, int *out)
{
    const char *word = NULL;
    TRY(parameter_word(r, row->key, node, &word));
    *out = words_find(row->choices, word);
    return *out < 0 ? wrong_choice(r, row, node, word) : STATUS_OK;
}

static status read_flag(reader *r, const parameter *row, int node, bool *out)
{
    char what[128];
    const char *word = document_scalar(r->document, node);
    *out = word && strcmp(word, "true") == 0;
    if (*out || (word && strcmp(word, "false") == 0))
        return STATUS_OK;
    return document_fail(r->document, node, r->why, "`%s` must be `true` or `false`; it is %s", row->key,
                         document_describe(r->document, node, what, sizeof what));
}

static status read_flags(reader *r, const parameter *row, int node, bool *out)
{
    int length = 0, index = 0;
    TRY(parameter_list_length(r, row, node, &length));
    for (int k = 0; k < length; k++) {
        int item = document_item(r->document, node, k);
        TRY(read_choice(r, row, item, &index));
        if (out[index])
            return document_fail(r->document, item, r->why, "`%s` lists `%s` twice; keep one", row->key,
                                 document_scalar(r->document, item));
        out[index] = true;
    }
    return STATUS_OK;
}

static bool is_name_letter(unsigned char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c >= 0x80;
}

/* Names stand in paths of settings and of the results file, so they are words. */
static status read_name(reader *r, const parameter *row, int node, char **out)
{
    const char *word = NULL;
    TRY(parameter_word(r, row->key, node, &word));
    bool good = is_name_letter((unsigned char)word[0]) && strlen(word) <= 40;
    for (const char *c = word; *c && good; c++)
        good = is_name_letter((unsigned char)*c) || (*c >= '0' && *c <= '9') || *c == '-' || *c == '.';
    if (!good)
        return document_fail(r->document, node, r->why,
                             "`%s` must begin with a letter and hold at most 40 letters, digits, `_`, `-` and `.`; it is `%.60s`", row->key,
                             word);
    *out = scene_copy(word);
    return STATUS_OK;
}

static status read_text(reader *r, const parameter *row, int node, char **out)
{
    char what[128];
    const char *text = document_scalar(r->document, node);
    if (!text)
        return document_fail(r->document, node, r->why, "`%s` must be a text; it is %s", row->key,
                             document_describe(r->document, node, what, sizeof what));
    *out = scene_copy(text);
    return STATUS_OK;
}

static status read_words(reader *r, const parameter *row, int node, void *target)
{
    int length = 0;
    TRY(parameter_list_length(r, row, node, &length));
    char **words = scene_allocate((size_t)length, sizeof *words);
    memcpy((char *)target + row->offset, &words, sizeof words);
    for (int k = 0; k < length; k++) {
        const char *word = NULL;
        TRY(parameter_word(r, row->key, document_item(r->document, node, k), &word));
        words[k] = scene_copy(word);
        *(int *)((char *)target + row->count) = k + 1;
    }
    return STATUS_OK;
}

static status read_list(reader *r, const parameter *row, int node, void *target)
{
    int length = 0;
    TRY(parameter_list_length(r, row, node, &length));
    char *array = scene_allocate((size_t)length, row->size);
    memcpy((char *)target + row->offset, &array, sizeof array);
    *(int *)((char *)target + row->count) = length;
    for (int k = 0; k < length; k++)
        TRY(parameter_section(r, row->section, document_item(r->document, node, k), array + (size_t)k * row->size));
    return STATUS_OK;
}

static status read_direction(reader *r, const parameter *row, int node, double out[3])
{
    TRY(parameter_vector(r, row, node, out));
    if (!vector_normalise(out))
        return document_fail(r->document, node, r->why, "`%s` is a zero vector, which has no direction", row->key);
    return STATUS_OK;
}

static status read_counts(reader *r, const parameter *row, int node, int64_t out[3])
{
    TRY(check_three(r, row, node));
    for (int k = 0; k < 3; k++)
        TRY(read_integer(r, row, document_item(r->document, node, k), &out[k]));
    return STATUS_OK;
}

/* True for a word such as `auto` that stands for no number. */
static bool is_word_for_none(reader *r, const parameter *row, int node)
{
    const char *text = document_scalar(r->document, node);
    return row->word && text && strcmp(text, row->word) == 0;
}

static status read_number_or_word(reader *r, const parameter *row, int node, double *out)
{
    *out = NAN;
    return is_word_for_none(r, row, node) ? STATUS_OK : parameter_number(r, row, node, out);
}

static status read_integer_or_word(reader *r, const parameter *row, int node, int64_t *out)
{
    *out = (int64_t)row->absent;
    return is_word_for_none(r, row, node) ? STATUS_OK : read_integer(r, row, node, out);
}

void parameter_store_choice(const parameter *row, int index, void *store)
{
    const int value = row->first + index;
    const double number = index;
    const bool flag = index == 1;
    if (row->as_number)
        memcpy(store, &number, sizeof number);
    else if (row->as_flag)
        memcpy(store, &flag, sizeof flag);
    else
        memcpy(store, &value, sizeof value);
}

static status read_stored_choice(reader *r, const parameter *row, int node, void *store)
{
    int index = 0;
    TRY(read_choice(r, row, node, &index));
    parameter_store_choice(row, index, store);
    return STATUS_OK;
}

status parameter_value(reader *r, const parameter *row, int node, void *target)
{
    void *store = (char *)target + row->offset;
    switch (row->type) {
    case PARAMETER_NUMBER:
        return read_number_or_word(r, row, node, store);
    case PARAMETER_INTEGER:
        return read_integer_or_word(r, row, node, store);
    case PARAMETER_FLAG:
        return read_flag(r, row, node, store);
    case PARAMETER_CHOICE:
        return read_stored_choice(r, row, node, store);
    case PARAMETER_TEXT:
        return read_text(r, row, node, store);
    case PARAMETER_NAME:
        return read_name(r, row, node, store);
    case PARAMETER_VECTOR:
        return parameter_vector(r, row, node, store);
    case PARAMETER_DIRECTION:
        return read_direction(r, row, node, store);
    case PARAMETER_COUNTS:
        return read_counts(r, row, node, store);
    case PARAMETER_NUMBERS:
        return parameter_numbers(r, row, node, store, (int *)((char *)target + row->count));
    case PARAMETER_WORDS:
        return read_words(r, row, node, target);
    case PARAMETER_FLAGS:
        return read_flags(r, row, node, store);
    case PARAMETER_SECTION:
        return parameter_section(r, row->section, node, store);
    case PARAMETER_LIST:
        return read_list(r, row, node, target);
    case PARAMETER_OTHER:
        return row->read(r, row, node, target);
    case PARAMETER_LATER:
        break;
    }
    return document_fail(r->document, node, r->why, "`%s` (%s) is not in this version yet; remove the key", row->key, row->doc);
}
