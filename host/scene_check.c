#include "scene_check.h"

#include "laws/laws.h"
#include "property.h"
#include "scene_table.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Everything is counted in int32 on the device. */
#define PARTICLES_MAX 2000000000.0

static status name_taken(reader *r, int node, const char *name, const char *kind, place other)
{
    return document_fail(r->document, node, r->why, "the name `%s` is taken by a %s at line %d; names must differ", name, kind, other.line);
}

/* A wall stands in `between` like a material, so they share their names. */
static status check_body_names(reader *r)
{
    const scene *s = r->scene;
    for (int k = 0; k < s->material_count; k++) {
        int node = document_at(r->document, "materials[%d].name", k);
        if (strcmp(s->material[k].name, "default") == 0)
            return document_fail(r->document, node, r->why, "a material cannot be called `default`; in `between` that means every pair");
        for (int j = 0; j < k; j++)
            if (strcmp(s->material[j].name, s->material[k].name) == 0)
                return name_taken(r, node, s->material[k].name, "material", s->material[j].at);
    }
    for (int k = 0; k < s->wall_count; k++) {
        int node = document_at(r->document, "walls[%d].name", k);
        if (strcmp(s->wall[k].name, "default") == 0)
            return document_fail(r->document, node, r->why, "a wall cannot be called `default`; in `between` that means every pair");
        for (int j = 0; j < s->material_count; j++)
            if (strcmp(s->material[j].name, s->wall[k].name) == 0)
                return name_taken(r, node, s->wall[k].name, "material", s->material[j].at);
        for (int j = 0; j < k; j++)
            if (strcmp(s->wall[j].name, s->wall[k].name) == 0)
                return name_taken(r, node, s->wall[k].name, "wall", s->wall[j].at);
    }
    return STATUS_OK;
}

static status check_other_names(reader *r)
{
    const scene *s = r->scene;
    for (int k = 0; k < s->group_count; k++)
        for (int j = 0; j < k; j++)
            if (strcmp(s->group[j].name, s->group[k].name) == 0)
                return name_taken(r, document_at(r->document, "particles[%d].name", k), s->group[k].name, "particle group", s->group[j].at);
    for (int k = 0; k < s->stage_count; k++)
        for (int j = 0; j < k; j++)
            if (strcmp(s->stage[j].name, s->stage[k].name) == 0)
                return name_taken(r, document_at(r->document, "stages[%d].name", k), s->stage[k].name, "stage", s->stage[j].at);
    return STATUS_OK;
}

static bool same_pair(const interaction *a, const interaction *b)
{
    if (a->is_default || b->is_default)
        return a->is_default && b->is_default;
    return (!strcmp(a->between[0], b->between[0]) && !strcmp(a->between[1], b->between[1])) ||
           (!strcmp(a->between[0], b->between[1]) && !strcmp(a->between[1], b->between[0]));
}

static status check_pairs_once(reader *r, const char *path, const interaction *entry, int count)
{
    for (int k = 0; k < count; k++)
        for (int j = 0; j < k; j++)
            if (same_pair(&entry[j], &entry[k]))
                return document_fail(r->document, document_at(r->document, "%s[%d].between", path, k), r->why,
                                     "this pair has an entry already, at line %d; put both into one", entry[j].at.line);
    return STATUS_OK;
}

static status check_interactions(reader *r)
{
    const scene *s = r->scene;
    TRY(check_pairs_once(r, "interactions", s->interaction, s->interaction_count));
    for (int k = 0; k < s->stage_count; k++) {
        char path[64];
        snprintf(path, sizeof path, "stages[%d].change.interactions", k);
        TRY(check_pairs_once(r, path, s->stage[k].interaction, s->stage[k].interaction_count));
    }
    return STATUS_OK;
}

static status check_changes_once(reader *r)
{
    const scene *s = r->scene;
    for (int t = 0; t < s->stage_count; t++) {
        const scene_stage *stage = &s->stage[t];
        for (int k = 0; k < stage->wall_change_count; k++) {
            int node = document_at(r->document, "stages[%d].change.walls[%d]", t, k);
            TRY(finish_interaction(r, node, NULL));
            TRY(check_wall_heat(r, node, &stage->wall_change[k].heat));
            for (int j = 0; j < k; j++)
                if (stage->wall_change[j].wall == stage->wall_change[k].wall)
                    return document_fail(r->document, node, r->why, "the wall `%s` is changed twice in this stage; put both into one entry",
                                         s->wall[stage->wall_change[k].wall].name);
        }
        for (int k = 0; k < stage->group_change_count; k++)
            for (int j = 0; j < k; j++)
                if (stage->group_change[j].group == stage->group_change[k].group)
                    return document_fail(r->document, document_at(r->document, "stages[%d].change.particles[%d]", t, k), r->why,
                                         "the particle group `%s` is changed twice in this stage",
                                         s->group[stage->group_change[k].group].name);
    }
    return STATUS_OK;
}

/* Friction and rolling are limited by the normal force. */
static status check_normal_present(reader *r)
{
    const scene *s = r->scene;
    static const slot_id dependent[] = {SLOT_BOND, SLOT_COHESION, SLOT_TANGENTIAL, SLOT_ROLLING};
    for (size_t k = 0; k < sizeof dependent / sizeof *dependent; k++) {
        const effect *live = scene_effect(s, -1, dependent[k]);
        if (live && !scene_effect(s, -1, SLOT_NORMAL))
            return document_fail(r->document, document_at(r->document, "effects[%d]", (int)(live - s->effect)), r->why,
                                 "the %s law `%s` needs a normal law; add one, like {slot: normal, law: hertz}", slot_name(dependent[k]),
                                 live->law->name);
        for (int t = 0; t < s->stage_count; t++)
            if (scene_effect(s, t, dependent[k]) && !scene_effect(s, t, SLOT_NORMAL))
                return document_fail(r->document, document_at(r->document, "stages[%d].effects_off", t), r->why,
                                     "this stage switches the normal law off and leaves `%s` on, which needs it; switch that off too",
                                     slot_name(dependent[k]));
    }
    return STATUS_OK;
}

static status check_material_needs(reader *r, const effect *live)
{
    const scene *s = r->scene;
    for (int n = 0; n < LAW_PROPERTIES_MAX && live->law->material_needs[n]; n++)
        for (int m = 0; m < s->material_count; m++)
            if (isnan(scene_material(s, m, live->law->material_needs[n])))
                return document_fail(r->document, document_at(r->document, "materials[%d]", m), r->why,
                                     "the %s law `%s` needs `%s`, which the material `%s` lacks", slot_name(live->law->slot),
                                     live->law->name, live->law->material_needs[n]->key, s->material[m].name);
    return STATUS_OK;
}

static status check_pair_needs(reader *r, const effect *live, int stage, int a, int b, int w)
{
    const scene *s = r->scene;
    for (int n = 0; n < LAW_PROPERTIES_MAX && live->law->interaction_needs[n]; n++) {
        const property *need = live->law->interaction_needs[n];
        if (isnan(scene_interaction(s, stage, a, b, w, need)))
            return document_fail(r->document, document_at(r->document, "effects[%d]", (int)(live - s->effect)), r->why,
                                 "the %s law `%s` needs `%s` between `%s` and %s`%s`; add it under `interactions`, to an entry "
                                 "{between: [%s, %s]} or to `default`",
                                 slot_name(live->law->slot), live->law->name, need->key, s->material[a].name, w >= 0 ? "the wall " : "",
                                 w >= 0 ? s->wall[w].name : s->material[b].name, s->material[a].name,
                                 w >= 0 ? s->wall[w].name : s->material[b].name);
    }
    return STATUS_OK;
}

/* For every contact that can come about, in every stage in which the law is live. */
static status check_needs(reader *r)
{
    const scene *s = r->scene;
    for (int m = 0; m < s->material_count; m++)
        if (isnan(scene_material(s, m, &property_density)))
            return document_fail(r->document, document_at(r->document, "materials[%d]", m), r->why,
                                 "the material `%s` lacks `%s`; every particle needs a mass", s->material[m].name, property_density.key);
    for (int k = 0; k < s->effect_count; k++) {
        const effect *live = &s->effect[k];
        TRY(check_material_needs(r, live));
        for (int t = 0; t < s->stage_count && live->law->interaction_needs[0]; t++) {
            if (s->stage[t].slot_off[live->law->slot])
                continue;
            for (int a = 0; a < s->material_count; a++) {
                for (int b = a; b < s->material_count; b++)
                    TRY(check_pair_needs(r, live, t, a, b, -1));
                for (int w = 0; w < s->wall_count; w++)
                    TRY(check_pair_needs(r, live, t, a, -1, w));
            }
        }
    }
    return STATUS_OK;
}

static status check_stages(reader *r)
{
    const scene *s = r->scene;
    if (s->stage_count == 0)
        return document_fail(r->document, document_at(r->document, "stages"), r->why,
                             "`stages` must hold at least one stage, like {until: {time_s: 1}}");
    for (int t = 0; t < s->stage_count; t++) {
        double g[3];
        scene_gravity(s, t, g);
        if (!isnan(s->stage[t].until_rest) && g[0] == 0.0 && g[1] == 0.0 && g[2] == 0.0)
            return document_fail(r->document, document_at(r->document, "stages[%d].until.rest", t), r->why,
                                 "`rest` compares with m g r, and this stage has no gravity; use `rest_j` with a limit in joules");
        TRY(check_frozen_stage(r, t));
    }
    return STATUS_OK;
}

static status check_particles(reader *r)
{
    const scene *s = r->scene;
    double sum = 0.0;
    for (int k = 0; k < s->group_count; k++) {
        const particle_group *group = &s->group[k];
        if (group->generator == GENERATOR_RANDOM && !group->region_given && !s->domain.given)
            return document_fail(r->document, document_at(r->document, "particles[%d]", k), r->why,
                                 "a group of random particles needs a `region`, or the scene a `domain`");
        sum += group->generator == GENERATOR_LATTICE ? (double)group->counts[0] * (double)group->counts[1] * (double)group->counts[2]
                                                     : (double)group->count;
        if (sum > PARTICLES_MAX)
            return document_fail(r->document, document_at(r->document, "particles[%d]", k), r->why,
                                 "with this group the scene has %.4g particles; at most %.4g are possible", sum, PARTICLES_MAX);
    }
    return STATUS_OK;
}

static const output_name *find_output(const output_name *known, const char *word)
{
    while (known->name && strcmp(known->name, word) != 0)
        known++;
    return known->name ? known : NULL;
}

static status check_output_word(reader *r, const output_name *known, const char *kind, int node, const char *word)
{
    const char *name[64];
    char all[1024] = "";
    size_t used = 0;
    int count = 0;
    const output_name *found = find_output(known, word);
    if (found && !found->needs)
        return STATUS_OK;
    if (found)
        return document_fail(r->document, node, r->why, "the %s `%s` needs %s, which this version does not have", kind, word, found->needs);
    for (const output_name *o = known; o->name && count < 64; o++)
        if (!o->needs) {
            name[count++] = o->name;
            used += (size_t)snprintf(all + used, sizeof all - used, "%s`%s`", used ? ", " : "", o->name);
        }
    const char *nearest = word_nearest(word, name, count);
    if (nearest)
        return document_fail(r->document, node, r->why, "there is no %s called `%.60s`; did you mean `%s`?", kind, word, nearest);
    return document_fail(r->document, node, r->why, "there is no %s called `%.60s`; this version has %s", kind, word, all);
}

/* The scalar is kept where a bond criterion looks at it. */
static status check_bond_output(reader *r, int node, const char *word)
{
    const effect *bond = scene_effect(r->scene, -1, SLOT_BOND);
    if ((strncmp(word, "bonds_", 6) == 0 || strncmp(word, "cluster", 7) == 0) && !bond)
        return document_fail(r->document, node, r->why, "the %s `%s` needs a bond law; add one, like {slot: bond, law: adhesion}",
                             strcmp(word, "cluster") == 0 ? "field" : "observable", word);
    if (strcmp(word, "scalar") != 0 || (bond && (int)bond->option[BOND_CRITERION] == BOND_SCALAR_ABOVE))
        return STATUS_OK;
    return document_fail(r->document, node, r->why,
                         "the field `scalar` needs a bond law with `criterion: scalar_above`; nothing else looks at it, so it is not kept");
}

static status check_output(reader *r)
{
    const scene *s = r->scene;
    const struct {
        const char *key, *kind;
        const output_name *known;
        char **word;
        int count;
    } list[] = {{"fields", "field", output_fields, s->output.fields, s->output.field_count},
                {"observables", "observable", output_observables, s->output.observables, s->output.observable_count}};
    for (int l = 0; l < 2; l++)
        for (int k = 0; k < list[l].count; k++) {
            int node = document_at(r->document, "output.%s[%d]", list[l].key, k);
            TRY(check_output_word(r, list[l].known, list[l].kind, node, list[l].word[k]));
            TRY(check_bond_output(r, node, list[l].word[k]));
            for (int j = 0; j < k; j++)
                if (strcmp(list[l].word[j], list[l].word[k]) == 0)
                    return document_fail(r->document, node, r->why, "the %s `%s` is listed twice", list[l].kind, list[l].word[k]);
        }
    return STATUS_OK;
}

/* What must be zero in two dimensions, and where it stands. */
static status check_zero(reader *r, double value, const char *what, const char *format, int index, int item)
{
    char path[128];
    if (value == 0.0)
        return STATUS_OK;
    snprintf(path, sizeof path, format, index, item);
    return document_fail(r->document, document_at(r->document, "%s", path), r->why, "with `dimensions: 2` %s must be 0; it is %g", what,
                         value);
}

static status check_planar_lattice(reader *r, int k)
{
    const particle_group *group = &r->scene->group[k];
    int flat = group->lattice == LATTICE_TRIANGULAR ? 1 : 2;
    if (group->generator != GENERATOR_LATTICE)
        return STATUS_OK;
    if (group->counts[flat] != 1)
        return document_fail(r->document, document_at(r->document, "particles[%d].counts", k), r->why,
                             "with `dimensions: 2` %s lattice has one layer: entry %d of `counts` must be 1; it is %" PRId64,
                             flat == 1 ? "a triangular" : "a", flat + 1, group->counts[flat]);
    return check_zero(r, group->origin_m[2], "z of `origin_m`", "particles[%d].origin_m", k, 0);
}

static status check_planar_items(reader *r, int k)
{
    const particle_group *group = &r->scene->group[k];
    for (int i = 0; i < group->item_count; i++) {
        const particle_item *item = &group->item[i];
        TRY(check_zero(r, item->position_m[2], "z of a position", "particles[%d].items[%d].position_m", k, i));
        TRY(check_zero(r, item->velocity_m_s[2], "z of a velocity", "particles[%d].items[%d].velocity_m_s", k, i));
        TRY(check_zero(r, item->spin_rad_s[0], "spin about x", "particles[%d].items[%d].spin_rad_s", k, i));
        TRY(check_zero(r, item->spin_rad_s[1], "spin about y", "particles[%d].items[%d].spin_rad_s", k, i));
    }
    return STATUS_OK;
}

static status check_planar(reader *r)
{
    const scene *s = r->scene;
    if (s->dimensions != 2)
        return STATUS_OK;
    TRY(check_zero(r, s->gravity_m_s2[2], "z of `gravity_m_s2` (y is up)", "gravity_m_s2", 0, 0));
    for (int t = 0; t < s->stage_count; t++)
        if (s->stage[t].gravity_given)
            TRY(check_zero(r, s->stage[t].gravity_m_s2[2], "z of `gravity_m_s2` (y is up)", "stages[%d].change.gravity_m_s2", t, 0));
    for (int k = 0; k < s->group_count; k++) {
        TRY(check_zero(r, s->group[k].velocity_m_s[2], "z of `velocity_m_s`", "particles[%d].velocity_m_s", k, 0));
        TRY(check_zero(r, s->group[k].spin_rad_s[0], "spin about x", "particles[%d].spin_rad_s", k, 0));
        TRY(check_zero(r, s->group[k].spin_rad_s[1], "spin about y", "particles[%d].spin_rad_s", k, 0));
        TRY(check_planar_lattice(r, k));
        TRY(check_planar_items(r, k));
    }
    return STATUS_OK;
}

status scene_check(reader *r)
{
    TRY(check_body_names(r));
    TRY(check_other_names(r));
    TRY(check_wall_groups(r));
    TRY(check_stages(r));
    TRY(check_particles(r));
    TRY(check_interactions(r));
    TRY(check_changes_once(r));
    TRY(check_normal_present(r));
    TRY(check_needs(r));
    TRY(check_output(r));
    TRY(scene_check_heat(r));
    return check_planar(r);
}
