/* Sources in a scene: the path of a beam. */
#include "scene_check.h"

#include "laws/laws.h"
#include "scene_table.h"

#include <clast/shared.h>
#include <stdlib.h>
#include <string.h>


static status check_length(reader *r, const parameter *row, int node, int times)
{
    int length = 0;
    TRY(parameter_list_length(r, row, node, &length));
    if (length != times)
        return document_fail(r->document, node, r->why, "`%s` has %d entries and `time_s` has %d; give one for each time", row->key, length, times);
    return STATUS_OK;
}

static quantity in_time(const quantity *times, int components)
{
    quantity q = {.given = true, .kind = QUANTITY_TIME, .components = components, .count = times->count};
    q.at = scene_allocate((size_t)q.count, sizeof *q.at);
    memcpy(q.at, times->at, sizeof *q.at * (size_t)q.count);
    q.value = scene_allocate((size_t)(q.count * components), sizeof *q.value);
    return q;
}

/* Times may repeat, where the power jumps; they may not fall. */
static status read_times(reader *r, const parameter *row, int node, void *target)
{
    quantity *power = &((beam *)target)->power;
    TRY(parameter_numbers(r, row, node, &power->at, &power->count));
    for (int k = 1; k < power->count; k++)
        if (power->at[k] < power->at[k - 1])
            return document_fail(r->document, document_item(r->document, node, k), r->why,
                                 "`%s` must not fall from entry to entry; %.10g follows %.10g (write a time twice where the power jumps)", row->key,
                                 power->at[k], power->at[k - 1]);
    return STATUS_OK;
}

static status read_positions(reader *r, const parameter *row, int node, void *target)
{
    beam *b = target;
    TRY(check_length(r, row, node, b->power.count));
    b->position = in_time(&b->power, 3);
    for (int k = 0; k < b->position.count; k++)
        TRY(parameter_vector(r, row, document_item(r->document, node, k), b->position.value + 3 * k));
    return STATUS_OK;
}

static status read_powers(reader *r, const parameter *row, int node, void *target)
{
    beam *b = target;
    TRY(check_length(r, row, node, b->power.count));
    double *times = b->power.at;
    b->power = in_time(&b->power, 1);
    free(times);
    for (int k = 0; k < b->power.count; k++)
        TRY(parameter_number(r, row, document_item(r->document, node, k), b->power.value + k));
    return STATUS_OK;
}

/* clang-format off */
static const parameter path_rows[] = {
    {.key = "time_s", .type = PARAMETER_OTHER, .read = read_times, .unit = "s", .required = true, .form = "list of numbers",
     .doc = "times that do not fall; one alone is a beam that stands still. A time written twice lets the power jump"},
    {.key = "position_m", .type = PARAMETER_OTHER, .read = read_positions, .unit = "m", .required = true, .form = "list of [x, y, z]",
     .doc = "a point of the beam's axis at each time, linear between them and constant outside"},
    {.key = "power_w", .type = PARAMETER_OTHER, .read = read_powers, .unit = "W", .required = true, .low = 0, .high = 1e15,
     .form = "list of numbers", .doc = "power of the beam at each time, linear between them and constant outside"},
    {0},
};
const section path_section = {.name = "path of a source", .doc = "Where the beam of a source is, and how strong, over time.", .row = path_rows};

const parameter beam_rows[] = {
    {.key = "direction", .type = PARAMETER_DIRECTION, .required = true, .offset = offsetof(effect, beam.direction),
     .doc = "where the beam points"},
    {.key = "path", .type = PARAMETER_SECTION, .section = &path_section, .required = true, .offset = offsetof(effect, beam),
     .doc = "where it is, and how strong, over time"},
    {0},
};
/* clang-format on */

status scene_check_sources(reader *r)
{
    const scene *s = r->scene;
    for (int e = 0; e < s->effect_count; e++) {
        if (s->effect[e].law->slot != SLOT_SOURCE)
            continue;
        int node = document_at(r->document, "effects[%d]", e);
        if (!s->effect[e].name)
            return document_fail(r->document, node, r->why, "a source needs a `name`, by which `--set` and messages call it");
        for (int k = 0; k < e; k++)
            if (s->effect[k].law->slot == SLOT_SOURCE && strcmp(s->effect[k].name, s->effect[e].name) == 0)
                return document_fail(r->document, node, r->why, "two sources are called `%.60s`; give each a name of its own", s->effect[e].name);
    }
    if (scene_beam_count(s) > SOURCES_MAX)
        return document_fail(r->document, document_at(r->document, "effects"), r->why, "a scene has at most %d sources; this one has %d", SOURCES_MAX,
                             scene_beam_count(s));
    if (scene_beam_sides(s) > CLAST_BEAM_SIDES_MAX)
        return document_fail(r->document, document_at(r->document, "effects"), r->why,
                             "the sources point in %d directions; depths are kept for at most %d", scene_beam_sides(s), CLAST_BEAM_SIDES_MAX);
    return STATUS_OK;
}
