/* The plan for programs. What does not exist (no limit, a length that only running tells) is null. */
#include "frozen.h"
#include "plan_data.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>

static json_t *number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *bytes_of(uint64_t bytes)
{
    return json_integer((json_int_t)bytes);
}

static json_t *text_or_null(const char *text)
{
    return text ? json_string(text) : json_null();
}

static json_t *groups(const plan *p)
{
    json_t *list = json_array();
    for (int g = 0; g < p->group_count; g++) {
        const plan_group *group = &p->group[g];
        json_t *entry = json_object();
        json_object_set_new(entry, "name", text_or_null(group->group->name));
        json_object_set_new(entry, "material", json_string(p->scene->material[group->group->material].name));
        json_object_set_new(entry, "count", json_integer(group->count));
        json_object_set_new(entry, "radius_min_m", number(group->radius_min));
        json_object_set_new(entry, "radius_max_m", number(group->radius_max));
        json_array_append_new(list, entry);
    }
    return list;
}

/* Null without a servo. */
static json_t *servo(const servo_choice *choice)
{
    const servo_spec *s = &choice->spec;
    if (!choice->given)
        return json_null();
    return json_pack("{s:[f, f, f], s:o, s:o, s:o, s:o}", "direction", s->direction[0], s->direction[1], s->direction[2], "force_n", number(s->force_n),
                     "pressure_pa", number(s->pressure_pa), "area_m2", number(s->area_m2), "speed_max_m_s", number(s->speed_max_m_s));
}

static json_t *walls(const plan *p)
{
    static const char *const shape[] = {"plane", "box", "rectangle", "disc", "cylinder", "cone"};
    json_t *list = json_array();
    for (int w = 0; w < p->scene->wall_count; w++) {
        const wall *wall = &p->scene->wall[w];
        bool round = wall->shape == WALL_CYLINDER || wall->shape == WALL_CONE;
        json_array_append_new(list, json_pack("{s:s, s:s, s:o, s:o, s:b, s:o}", "name", wall->name, "shape", shape[wall->shape], "side",
                                              text_or_null(!round ? NULL : wall->outside ? "outside" : "inside"), "group",
                                              text_or_null(wall->group >= 0 ? p->scene->wall_group[wall->group].name : NULL), "moves",
                                              wall->motion.count > 0, "servo", servo(&wall->servo)));
    }
    return list;
}

static json_t *wall_groups(const plan *p)
{
    json_t *list = json_array();
    for (int g = 0; g < p->scene->wall_group_count; g++) {
        const wall_group *group = &p->scene->wall_group[g];
        json_array_append_new(list, json_pack("{s:s, s:b, s:o}", "name", group->name, "moves", group->motion.count > 0, "servo", servo(&group->servo)));
    }
    return list;
}

static json_t *stages(const plan *p)
{
    json_t *list = json_array();
    for (int s = 0; s < p->stage_count; s++) {
        const plan_stage *stage = &p->stage[s];
        json_t *entry = json_object(), *laws_live = json_object();
        for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
            if (stage->live.law[slot])
                json_object_set_new(laws_live, slot_name(slot), json_string(stage->live.law[slot]->name));
        json_object_set_new(entry, "name", text_or_null(stage->stage->name));
        json_object_set_new(entry, "laws", laws_live);
        json_object_set_new(entry, "motion", json_string(stage->stage->frozen ? "frozen" : "free"));
        if (stage->stage->frozen)
            json_object_set_new(entry, "heat_method", json_string(frozen_method_name(stage->stage->heat_method)));
        json_object_set_new(entry, "limit_s", number(stage->limit.limit_s));
        json_object_set_new(entry, "recommended_s", number(stage->limit.recommended_s));
        json_object_set_new(entry, "bound_by", json_string(stage->limit.binds));
        json_object_set_new(entry, "contact_s", number(stage->limit.contact_s));
        json_object_set_new(entry, "step_s", number(stage->step_s));
        json_object_set_new(entry, "step_is_automatic", json_boolean(isnan(stage->stage->step_s)));
        json_object_set_new(entry, "steps", number(stage->steps));
        json_array_append_new(list, entry);
    }
    return list;
}

static json_t *memory(const plan *p)
{
    static const char *const per[] = {[PER_PARTICLE] = "particle", [PER_RECORD] = "contact", [PER_RECORD_BLOCK] = "block of contacts", [PER_SCENE] = "scene"};
    json_t *fields = json_array(), *out = json_object();
    for (int f = 0; f < p->field_count; f++) {
        json_t *entry = json_object();
        json_object_set_new(entry, "name", json_string(p->field[f].name));
        json_object_set_new(entry, "per", json_string(per[p->field[f].per]));
        json_object_set_new(entry, "bytes", bytes_of(p->field[f].bytes));
        json_object_set_new(entry, "bytes_per_particle", number(plan_bytes_per_particle(p, p->field[f].bytes)));
        json_array_append_new(fields, entry);
    }
    json_object_set_new(out, "fields", fields);
    json_object_set_new(out, "contact_table_bytes", bytes_of(p->table_bytes));
    json_object_set_new(out, "other_bytes", bytes_of(p->other_bytes));
    json_object_set_new(out, "bytes", bytes_of(p->bytes));
    json_object_set_new(out, "bytes_per_particle", number(plan_bytes_per_particle(p, p->bytes)));
    json_object_set_new(out, "packed_bytes", bytes_of(p->packed_bytes));
    json_object_set_new(out, "usable_bytes", bytes_of(p->device->usable_bytes));
    return out;
}

static json_t *arguments(const plan *p, const plan_arguments *of)
{
    json_t *names = json_pack("[s, s]", "launch", "control"), *out = json_object();
    for (int k = 0; k < of->count; k++)
        json_array_append_new(names, json_string(of->name[k]));
    json_object_set_new(out, "names", names);
    json_object_set_new(out, "bytes", bytes_of(of->bytes));
    json_object_set_new(out, "bytes_max", bytes_of(p->device->argument_bytes));
    return out;
}

static json_t *bonds(const plan *p)
{
    json_t *all = json_array();
    for (int k = 0; k < p->bond_count; k++) {
        const bond_figures *f = &p->bond[k];
        json_t *one = json_object();
        json_object_set_new(one, "between", json_pack("[s, s]", f->a, f->b));
        json_object_set_new(one, "equilibrium_overlap_m", number(f->equilibrium));
        json_object_set_new(one, "critical_overlap_m", number(f->critical));
        json_object_set_new(one, "pull_off_force_n", number(f->pull_off));
        json_object_set_new(one, "critical_velocity_m_s", number(f->velocity));
        json_object_set_new(one, "sticks_from_m_s", number(f->sticks_from));
        json_object_set_new(one, "breaks_from_m_s", number(f->breaks_from));
        json_array_append_new(all, one);
    }
    return all;
}

static json_t *probe(const plan_probe *of)
{
    if (!of->done)
        return json_null();
    json_t *out = json_object();
    json_object_set_new(out, "steps", json_integer(of->steps));
    json_object_set_new(out, "wall_s", number(of->wall_s));
    json_object_set_new(out, "particle_steps_per_s", number(of->particle_steps_per_s));
    json_object_set_new(out, "expected_wall_s", number(of->expected_wall_s));
    return out;
}

/* By material, or null without heat. */
static json_t *biot(const plan *p)
{
    json_t *list = p->biot_contact ? json_array() : json_null();
    for (int m = 0; p->biot_contact && m < p->scene->material_count; m++)
        json_array_append_new(list, json_pack("{s:s, s:f, s:f}", "material", p->scene->material[m].name, "contacts", p->biot_contact[m], "surface",
                                              p->biot_surface[m]));
    return list;
}

status plan_write_json(const plan *p, failure *why)
{
    char device[1024];
    device_describe(p->device, device, sizeof device);
    json_t *unused = json_array(), *root = json_object();
    for (int k = 0; p->unused[k]; k++)
        json_array_append_new(unused, json_string(p->unused[k]));
    json_object_set_new(root, "title", text_or_null(p->scene->title));
    json_object_set_new(root, "scene", json_string(p->scene->path));
    json_object_set_new(root, "dimensions", json_integer(p->scene->dimensions));
    json_object_set_new(root, "precision", json_string(precision_name(p->scene)));
    json_object_set_new(root, "device", json_string(device));
    json_object_set_new(root, "particles", json_integer(p->particles));
    json_object_set_new(root, "groups", groups(p));
    json_object_set_new(root, "walls", walls(p));
    json_object_set_new(root, "wall_groups", wall_groups(p));
    json_object_set_new(root, "overlap_max", number(p->overlap_max));
    json_object_set_new(root, "unused", unused);
    json_object_set_new(root, "biot", biot(p));
    json_object_set_new(root, "stages", stages(p));
    json_object_set_new(root, "bonds", bonds(p));
    json_object_set_new(root, "memory", memory(p));
    json_object_set_new(root, "skin_m", number(p->skin_m));
    json_object_set_new(root, "pair_stage_arguments", arguments(p, &p->pair));
    json_object_set_new(root, "particle_stage_arguments", arguments(p, &p->particle));
    json_object_set_new(root, "probe", probe(&p->probe));
    int failed = json_dumpf(root, stdout, JSON_INDENT(2));
    json_decref(root);
    printf("\n");
    return failed ? fail(why, STATUS_ERROR, "the plan cannot be written as JSON") : STATUS_OK;
}
