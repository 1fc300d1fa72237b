/* Servos and groups of walls in a scene. */
#include "scene_table.h"

#include <math.h>
#include <string.h>

status finish_servo(reader *r, int node, void *target)
{
    const servo_spec *servo = target;
    if (node == 0)
        return STATUS_OK;
    if (isnan(servo->pressure_pa) == isnan(servo->force_n))
        return document_fail(r->document, node, r->why, "a servo keeps either a pressure or a force; give one of `pressure_pa` and `force_n`");
    if (!isnan(servo->force_n) && !isnan(servo->area_m2))
        return document_fail(r->document, document_find(r->document, node, "area_m2"), r->why,
                             "`area_m2` has no meaning where a force is kept; it belongs to `pressure_pa`");
    if (r->scene->dimensions == 2 && servo->direction[2] != 0.0)
        return document_fail(r->document, document_find(r->document, node, "direction"), r->why,
                             "with `dimensions: 2` a direction has no z component");
    return STATUS_OK;
}

status read_changed_servo(reader *r, const parameter *row, int node, void *target)
{
    servo_choice *servo = (servo_choice *)((char *)target + row->offset);
    const char *word = document_scalar(r->document, node);
    char what[128];
    servo->given = true;
    servo->off = word && strcmp(word, "off") == 0;
    if (servo->off)
        return STATUS_OK;
    if (!document_is_mapping(r->document, node))
        return document_fail(r->document, node, r->why,
                             "`servo` must be a servo, like {direction: [0, 0, -1], force_n: 1, speed_max_m_s: 0.1}, or `off`; it is %s",
                             document_describe(r->document, node, what, sizeof what));
    return parameter_section(r, &servo_section, node, &servo->spec);
}

/* A wall without a group gets -1. */
status check_wall_group(reader *r, int node, wall *w)
{
    if (document_find(r->document, node, "group") == 0) {
        w->group = -1;
        return STATUS_OK;
    }
    if (w->motion.count == 0 && !w->servo.given)
        return STATUS_OK;
    return document_fail(r->document, document_find(r->document, node, w->servo.given ? "servo" : "motion"), r->why,
                         "a wall of a group moves with it; write `motion` and `servo` to the entry of `%s` under `wall_groups`",
                         r->scene->wall_group[w->group].name);
}

static status check_group(reader *r, int k)
{
    const scene *s = r->scene;
    bool used = false;
    for (int j = 0; j < k; j++)
        if (strcmp(s->wall_group[j].name, s->wall_group[k].name) == 0)
            return document_fail(r->document, document_at(r->document, "wall_groups[%d].name", k), r->why,
                                 "the name `%s` is taken by a wall group at line %d; names must differ", s->wall_group[k].name,
                                 s->wall_group[j].at.line);
    for (int w = 0; w < s->wall_count; w++)
        used = used || s->wall[w].group == k;
    if (used)
        return STATUS_OK;
    return document_fail(r->document, document_at(r->document, "wall_groups[%d]", k), r->why,
                         "no wall belongs to the wall group `%s`; write `group: %s` to its walls", s->wall_group[k].name, s->wall_group[k].name);
}

static status check_stage(reader *r, int t)
{
    const scene *s = r->scene;
    const scene_stage *stage = &s->stage[t];
    for (int k = 0; k < stage->wall_change_count; k++) {
        const wall_change *change = &stage->wall_change[k];
        const wall *w = &s->wall[change->wall];
        if (w->group >= 0 && (change->motion_given || change->servo.given))
            return document_fail(r->document, document_at(r->document, "stages[%d].change.walls[%d]", t, k), r->why,
                                 "the wall `%s` moves with its group `%s`; change that under `wall_groups`", w->name, s->wall_group[w->group].name);
    }
    for (int k = 0; k < stage->wall_group_change_count; k++)
        for (int j = 0; j < k; j++)
            if (stage->wall_group_change[j].group == stage->wall_group_change[k].group)
                return document_fail(r->document, document_at(r->document, "stages[%d].change.wall_groups[%d]", t, k), r->why,
                                     "the wall group `%s` is changed twice in this stage; put both into one entry",
                                     s->wall_group[stage->wall_group_change[k].group].name);
    return STATUS_OK;
}

status check_wall_groups(reader *r)
{
    for (int k = 0; k < r->scene->wall_group_count; k++)
        TRY(check_group(r, k));
    for (int t = 0; t < r->scene->stage_count; t++)
        TRY(check_stage(r, t));
    return STATUS_OK;
}
