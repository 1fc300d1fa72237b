/* What a scene says when it is asked: interaction values by pair and stage, laws by slot. */
#include "scene.h"

#include "property.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define HIDERS_MAX 4

bool precision_find(const char *word, precision *out)
{
    static const char *const words[] = {[PRECISION_AUTO] = "auto", [PRECISION_DOUBLE] = "double", [PRECISION_MIXED] = "mixed"};
    for (int k = 0; k < 3; k++)
        if (strcmp(words[k], word) == 0) {
            *out = (precision)k;
            return true;
        }
    return false;
}

const char *precision_name(const scene *scene)
{
    return scene->precision == PRECISION_MIXED ? "mixed" : "double";
}

static int property_index(const property *const *all, const property *wanted)
{
    for (int k = 0; all[k]; k++)
        if (all[k] == wanted)
            return k;
    return -1;
}

/* Ways of saying one thing, or a value that follows another unless it is given closer: where an entry gives `closer`, entries
 * further away that give `hidden` do not count. */
static const struct {
    const property *hidden, *closer;
} hides[] = {
    {&property_restitution, &property_normal_damping},
    {&property_normal_damping, &property_restitution},
    {&property_friction_dynamic, &property_friction_static},
};

/* Four ways of saying how strongly a bond pulls: each hides the others. */
static const property *const adhesions[HIDERS_MAX] = {&property_bond_stiffness, &property_bond_equilibrium_overlap,
                                                      &property_bond_normalised_stiffness, &property_bond_equilibrium_strain};

/* Indices of the properties that hide p where they stand closer; -1 ends them. */
static void find_hiders(const property *p, int *closer)
{
    int count = 0;
    for (size_t k = 0; k < sizeof hides / sizeof *hides; k++)
        if (hides[k].hidden == p)
            closer[count++] = property_index(interaction_properties(), hides[k].closer);
    for (int k = 0; k < HIDERS_MAX; k++)
        for (int j = 0; j < HIDERS_MAX && adhesions[k] == p; j++)
            if (j != k)
                closer[count++] = property_index(interaction_properties(), adhesions[j]);
    closer[count] = -1;
}

/* One look at the entries that may speak for a contact, from the closest on. */
typedef struct search {
    int wanted, closer[HIDERS_MAX + 1]; /* indices of properties; what hides it ends with -1 */
    const char *a, *b;
    int wall;
    bool ended;
    double value;
    const double *at; /* where it stands */
} search;

static void look_at(search *find, const double *value)
{
    if (find->ended || !value)
        return;
    if (!isnan(value[find->wanted])) {
        find->value = value[find->wanted];
        find->at = &value[find->wanted];
        find->ended = true;
    }
    for (int k = 0; find->closer[k] >= 0; k++)
        find->ended = find->ended || !isnan(value[find->closer[k]]);
}

static bool is_pair(const interaction *entry, const char *a, const char *b)
{
    if (entry->is_default)
        return false;
    return (!strcmp(entry->between[0], a) && !strcmp(entry->between[1], b)) ||
           (!strcmp(entry->between[0], b) && !strcmp(entry->between[1], a));
}

static void look_through(search *find, const interaction *entry, int count, bool defaults)
{
    for (int k = count - 1; k >= 0; k--)
        if (defaults ? entry[k].is_default : is_pair(&entry[k], find->a, find->b))
            look_at(find, entry[k].value);
}

/* Entries of the pair itself, the latest stage's first, then the defaults. Changes stay in force in the stages after theirs. */
static void look_everywhere(search *find, const scene *s, int stage)
{
    for (int t = stage; t >= 0; t--) {
        const scene_stage *change = &s->stage[t];
        look_through(find, change->interaction, change->interaction_count, false);
        for (int k = change->wall_change_count - 1; k >= 0 && find->wall >= 0; k--)
            if (change->wall_change[k].wall == find->wall)
                look_at(find, change->wall_change[k].value);
    }
    look_through(find, s->interaction, s->interaction_count, false);
    for (int t = stage; t >= 0; t--)
        look_through(find, s->stage[t].interaction, s->stage[t].interaction_count, true);
    look_through(find, s->interaction, s->interaction_count, true);
}

static const double *written_place(const scene *s, int stage, int material_a, int material_b, int w, const property *wanted)
{
    const int index = property_index(interaction_properties(), wanted);
    if (index < 0)
        return NULL;
    search find = {.wanted = index, .wall = w, .value = NAN};
    find_hiders(wanted, find.closer);
    find.a = s->material[material_a].name;
    find.b = w >= 0 ? s->wall[w].name : s->material[material_b].name;
    look_everywhere(&find, s, stage < s->stage_count ? stage : s->stage_count - 1);
    return find.at;
}

static double written_value(const scene *s, int stage, int material_a, int material_b, int w, const property *wanted)
{
    const double *place = written_place(s, stage, material_a, material_b, w, wanted);
    return place ? *place : NAN;
}

double scene_interaction(const scene *s, int stage, int material_a, int material_b, int w, const property *wanted)
{
    double value = NAN;
    double fallback = wanted->fallback;
    for (const property *p = wanted; p && isnan(value); p = p->fallback_property)
        value = written_value(s, stage, material_a, material_b, w, p);
    return isnan(value) ? fallback : value;
}

bool scene_interaction_given(const scene *s, int stage, int material_a, int material_b, int w, const property *wanted)
{
    return !isnan(written_value(s, stage, material_a, material_b, w, wanted));
}

static const property_table *table_of(const scene *s, const double *place)
{
    for (int k = 0; place && k < s->table_count; k++)
        if (s->property_table[k].of == place)
            return &s->property_table[k];
    return NULL;
}

const property_table *scene_interaction_table(const scene *s, int stage, int material_a, int material_b, int w, const property *wanted)
{
    const double *place = NULL;
    for (const property *p = wanted; p && !place && s->table_count > 0; p = p->fallback_property)
        place = written_place(s, stage, material_a, material_b, w, p);
    return table_of(s, place);
}

const property_table *scene_material_table(const scene *s, int m, const property *wanted)
{
    int index = property_index(material_properties(), wanted);
    return index >= 0 ? table_of(s, &s->material[m].value[index]) : NULL;
}

bool scene_has_material_table(const scene *s, const property *wanted)
{
    for (int m = 0; m < s->material_count; m++)
        if (scene_material_table(s, m, wanted))
            return true;
    return false;
}

bool scene_has_interaction_table(const scene *s, const property *wanted)
{
    for (int stage = -1; s->table_count > 0 && stage < s->stage_count; stage++)
        for (int a = 0; a < s->material_count; a++)
            for (int p = 0; p < s->material_count + s->wall_count; p++) {
                int b = p < s->material_count ? p : -1, w = p < s->material_count ? -1 : p - s->material_count;
                if (scene_interaction_table(s, stage, a, b, w, wanted))
                    return true;
            }
    return false;
}

double property_table_at(const property_table *t, double temperature)
{
    int k = 0;
    while (k + 1 < t->count && temperature >= t->temperature_k[k + 1])
        k++;
    if (k + 1 == t->count || temperature <= t->temperature_k[k])
        return t->value[k];
    double share = (temperature - t->temperature_k[k]) / (t->temperature_k[k + 1] - t->temperature_k[k]);
    return t->value[k] + share * (t->value[k + 1] - t->value[k]);
}

double scene_table_constant(const scene *s, const property_table *table)
{
    return -1.0 - (double)(table - s->property_table);
}

double scene_material(const scene *s, int m, const property *wanted)
{
    for (const property *p = wanted; p; p = p->fallback_property) {
        int index = property_index(material_properties(), p);
        if (index >= 0 && !isnan(s->material[m].value[index]))
            return s->material[m].value[index];
    }
    return wanted->fallback;
}

double scene_gas(const scene *s, const property *wanted)
{
    int index = property_index(gas_properties(), wanted);
    return s->environment.gas && index >= 0 ? s->environment.gas[index] : NAN;
}

const effect *scene_effect(const scene *s, int stage, slot_id slot)
{
    if (stage >= 0 && s->stage[stage].slot_off[slot])
        return NULL;
    for (int k = 0; k < s->effect_count; k++)
        if (s->effect[k].law && s->effect[k].law->slot == slot)
            return &s->effect[k];
    return NULL;
}

void scene_gravity(const scene *s, int stage, double gravity_m_s2[3])
{
    memcpy(gravity_m_s2, s->gravity_m_s2, 3 * sizeof(double));
    for (int t = 0; t <= stage; t++)
        if (s->stage[t].gravity_given)
            memcpy(gravity_m_s2, s->stage[t].gravity_m_s2, 3 * sizeof(double));
}

static void free_motion(motion_list *list)
{
    for (int k = 0; k < list->count; k++) {
        free(list->term[k].time_s);
        free(list->term[k].table_velocity_m_s);
    }
    free(list->term);
}

const motion_list *scene_wall_motion(const scene *s, int wall)
{
    int group = s->wall[wall].group;
    return group >= 0 ? &s->wall_group[group].motion : &s->wall[wall].motion;
}

bool scene_wall_moves(const scene *s, int wall)
{
    int group = s->wall[wall].group;
    bool moves = scene_wall_motion(s, wall)->count > 0 || (group >= 0 ? s->wall_group[group].servo.given : s->wall[wall].servo.given);
    for (int t = 0; t < s->stage_count; t++) {
        const scene_stage *stage = &s->stage[t];
        for (int k = 0; k < stage->wall_change_count; k++)
            moves = moves || (stage->wall_change[k].wall == wall && (stage->wall_change[k].motion.count > 0 || stage->wall_change[k].servo.given));
        for (int k = 0; k < stage->wall_group_change_count; k++)
            moves = moves || (group >= 0 && stage->wall_group_change[k].group == group &&
                              (stage->wall_group_change[k].motion.count > 0 || stage->wall_group_change[k].servo.given));
    }
    return moves;
}

bool scene_has_servo(const scene *s)
{
    bool any = false;
    for (int w = 0; w < s->wall_count; w++)
        any = any || s->wall[w].servo.given;
    for (int g = 0; g < s->wall_group_count; g++)
        any = any || s->wall_group[g].servo.given;
    for (int t = 0; t < s->stage_count; t++) {
        for (int k = 0; k < s->stage[t].wall_change_count; k++)
            any = any || s->stage[t].wall_change[k].servo.given;
        for (int k = 0; k < s->stage[t].wall_group_change_count; k++)
            any = any || s->stage[t].wall_group_change[k].servo.given;
    }
    return any;
}

static void free_interactions(interaction *entry, int count)
{
    for (int k = 0; k < count; k++) {
        free(entry[k].between[0]);
        free(entry[k].between[1]);
        free(entry[k].value);
    }
    free(entry);
}

static void free_words(char **word, int count)
{
    for (int k = 0; k < count; k++)
        free(word[k]);
    free(word);
}

static void free_group(particle_group *group)
{
    free(group->name);
    free(group->radius_m.size_m);
    free(group->radius_m.mass_fraction);
    free(group->item);
    free(group->path);
    quantity_free(&group->temperature);
    free_motion(&group->motion);
}

static void free_stage(scene_stage *stage)
{
    free(stage->name);
    free(stage->repeat_from);
    for (int k = 0; k < stage->wall_change_count; k++) {
        free_motion(&stage->wall_change[k].motion);
        quantity_free(&stage->wall_change[k].heat.temperature_k);
        free(stage->wall_change[k].value);
    }
    free(stage->wall_change);
    for (int k = 0; k < stage->wall_group_change_count; k++)
        free_motion(&stage->wall_group_change[k].motion);
    free(stage->wall_group_change);
    for (int k = 0; k < stage->group_change_count; k++)
        free_motion(&stage->group_change[k].motion);
    free(stage->group_change);
    free_interactions(stage->interaction, stage->interaction_count);
}

void scene_free(scene *s)
{
    if (!s)
        return;
    for (int k = 0; k < s->effect_count; k++) {
        free(s->effect[k].name);
        quantity_free(&s->effect[k].beam.position);
        quantity_free(&s->effect[k].beam.power);
    }
    for (int k = 0; k < s->material_count; k++) {
        free(s->material[k].name);
        free(s->material[k].value);
    }
    for (int k = 0; k < s->group_count; k++)
        free_group(&s->group[k]);
    for (int k = 0; k < s->wall_group_count; k++) {
        free(s->wall_group[k].name);
        free_motion(&s->wall_group[k].motion);
    }
    free(s->wall_group);
    for (int k = 0; k < s->wall_count; k++) {
        free(s->wall[k].name);
        free_motion(&s->wall[k].motion);
        quantity_free(&s->wall[k].heat.temperature_k);
    }
    for (int k = 0; k < s->stage_count; k++)
        free_stage(&s->stage[k]);
    for (int k = 0; k < s->table_count; k++) {
        free(s->property_table[k].temperature_k);
        free(s->property_table[k].value);
    }
    free(s->property_table);
    free_interactions(s->interaction, s->interaction_count);
    quantity_free(&s->environment.temperature_k);
    quantity_free(&s->environment.gas_velocity_m_s);
    free(s->environment.gas);
    free(s->effect);
    free(s->material);
    free(s->group);
    free(s->wall);
    free(s->stage);
    free_words(s->output.fields, s->output.field_count);
    free_words(s->output.observables, s->output.observable_count);
    free_words(s->study.answers, s->study.answer_count);
    free_words(s->study.set, s->study.set_count);
    for (int k = 0; k < s->study.closed_form_count; k++) {
        free(s->study.closed_form[k].answer);
        free(s->study.closed_form[k].time_s);
        free(s->study.closed_form[k].value);
    }
    free(s->study.closed_form);
    free(s->title);
    free(s->path);
    free(s->text);
    free(s);
}
