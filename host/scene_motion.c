/* Prescribed motion: terms, and the words `free` and `fixed`. */
#include "scene_table.h"

#include <stdio.h>
#include <string.h>

static status read_terms(reader *r, const parameter *row, int node, motion_list *list)
{
    const parameter terms = {.key = row->key,
                             .type = PARAMETER_LIST,
                             .section = &motion_section,
                             .size = sizeof(motion),
                             .offset = offsetof(motion_list, term),
                             .count = offsetof(motion_list, count)};
    return parameter_value(r, &terms, node, list);
}

status read_motion(reader *r, const parameter *row, int node, void *target)
{
    return read_terms(r, row, node, (motion_list *)((char *)target + row->offset));
}

static status read_word_or_terms(reader *r, const parameter *row, int node, bool *fixed, bool *is_free, motion_list *list)
{
    char what[128];
    const char *word = document_scalar(r->document, node);
    *fixed = word && strcmp(word, "fixed") == 0;
    *is_free = word && strcmp(word, "free") == 0;
    if (*fixed || *is_free)
        return STATUS_OK;
    if (!document_is_list(r->document, node))
        return document_fail(r->document, node, r->why, "`%s` must be `free`, `fixed` or a list of motion terms; it is %s", row->key,
                             document_describe(r->document, node, what, sizeof what));
    if (document_length(r->document, node) == 0)
        return document_fail(r->document, node, r->why, "`%s` is an empty list; write `free` or `fixed`", row->key);
    return read_terms(r, row, node, list);
}

status read_group_motion(reader *r, const parameter *row, int node, void *target)
{
    particle_group *group = target;
    bool is_free = false;
    return read_word_or_terms(r, row, node, &group->fixed, &is_free, &group->motion);
}

status read_changed_motion(reader *r, const parameter *row, int node, void *target)
{
    group_change *change = target;
    return read_word_or_terms(r, row, node, &change->fixed, &change->free, &change->motion);
}

status read_table_velocity(reader *r, const parameter *row, int node, void *target)
{
    motion *term = target;
    int length = 0;
    TRY(parameter_list_length(r, row, node, &length));
    if (length != term->count)
        return document_fail(r->document, node, r->why, "`%s` has %d entries and `time_s` has %d; give one velocity for each time",
                             row->key, length, term->count);
    term->table_velocity_m_s = scene_allocate((size_t)length, sizeof *term->table_velocity_m_s);
    for (int k = 0; k < length; k++)
        TRY(parameter_vector(r, row, document_item(r->document, node, k), term->table_velocity_m_s[k]));
    return STATUS_OK;
}

/* In two dimensions nothing moves out of the plane. */
static status check_planar_motion(reader *r, int node, const motion *term)
{
    document *d = r->document;
    if (term->type == MOTION_CONSTANT && term->velocity_m_s[2] != 0.0)
        return document_fail(d, document_find(d, node, "velocity_m_s"), r->why,
                             "with `dimensions: 2` velocities have no z component; it is %g", term->velocity_m_s[2]);
    if (term->type == MOTION_SINUSOID && term->direction[2] != 0.0)
        return document_fail(d, document_find(d, node, "direction"), r->why, "with `dimensions: 2` a direction has no z component");
    if (term->type == MOTION_ROTATION && (term->axis[0] != 0.0 || term->axis[1] != 0.0))
        return document_fail(d, document_find(d, node, "axis"), r->why, "with `dimensions: 2` an axis must lie along z: [0, 0, 1]");
    for (int k = 0; term->type == MOTION_TABLE && k < term->count; k++)
        if (term->table_velocity_m_s[k][2] != 0.0)
            return document_fail(d, document_item(d, document_find(d, node, "velocity_m_s"), k), r->why,
                                 "with `dimensions: 2` velocities have no z component; it is %g", term->table_velocity_m_s[k][2]);
    return STATUS_OK;
}

status finish_motion(reader *r, int node, void *target)
{
    const motion *term = target;
    for (int k = 1; k < term->count; k++)
        if (term->time_s[k] <= term->time_s[k - 1])
            return document_fail(r->document, document_item(r->document, document_find(r->document, node, "time_s"), k), r->why,
                                 "`time_s` must rise from entry to entry; %.10g follows %.10g", term->time_s[k], term->time_s[k - 1]);
    return r->scene->dimensions == 2 ? check_planar_motion(r, node, term) : STATUS_OK;
}
