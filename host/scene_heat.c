/* Heat in a scene: whether there is a temperature, what a wall's is in a stage, and checks over several keys. */
#include "scene_check.h"

#include "laws/laws.h"
#include "property.h"
#include "scene_table.h"

#include <math.h>
#include <string.h>

static const slot_id thermal_slots[] = {SLOT_CONDUCTION, SLOT_CONVECTION, SLOT_RADIATION, SLOT_SOURCE, SLOT_HEAT_GENERATION, SLOT_DISSIPATION_HEAT};

bool scene_has_heat(const scene *s)
{
    for (size_t k = 0; k < sizeof thermal_slots / sizeof *thermal_slots; k++)
        if (scene_effect(s, -1, thermal_slots[k]))
            return true;
    return false;
}

static bool lists(char *const *word, int count, const char *name)
{
    for (int k = 0; k < count; k++)
        if (strcmp(word[k], name) == 0)
            return true;
    return false;
}

bool scene_outputs(const scene *s, const char *name)
{
    return lists(s->output.fields, s->output.field_count, name) || lists(s->output.observables, s->output.observable_count, name);
}

static bool scene_has_friction_table(const scene *s)
{
    return scene_effect(s, -1, SLOT_TANGENTIAL) &&
           (scene_has_interaction_table(s, &property_friction_static) || scene_has_interaction_table(s, &property_friction_dynamic));
}

bool scene_has_temperature(const scene *s)
{
    static const char *const names[] = {"temperature", "thermal_energy", "temperature_min", "temperature_mean", "temperature_max"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (scene_outputs(s, names[k]))
            return true;
    const effect *bond = scene_effect(s, -1, SLOT_BOND);
    if (scene_effect(s, -1, SLOT_MODULUS) || scene_effect(s, -1, SLOT_RADIUS) || scene_has_friction_table(s))
        return true;
    return scene_has_heat(s) || scene_tallies_heat(s) || (bond && bonding_reads_temperature(bond->law, bond->option));
}

bool scene_tallies_heat(const scene *s)
{
    static const char *const names[] = {"heat_sources", "heat_convection", "heat_radiation", "heat_walls", "source_absorbed", "heat_dissipation"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (scene_outputs(s, names[k]))
            return true;
    return scene_effect(s, -1, SLOT_SOURCE) != NULL; /* a run reports how much its beams bring */
}

static bool says_something(const wall_heat *heat)
{
    return heat->adiabatic || heat->temperature_k.given || !isnan(heat->flux_w);
}

const wall_heat *scene_wall_heat(const scene *s, int stage, int w)
{
    for (int t = stage; t >= 0; t--)
        for (int k = s->stage[t].wall_change_count - 1; k >= 0; k--) {
            const wall_change *change = &s->stage[t].wall_change[k];
            if (change->wall == w && says_something(&change->heat))
                return &change->heat;
        }
    return &s->wall[w].heat;
}

wall_heat_kind wall_heat_kind_of(const wall_heat *heat)
{
    if (heat->temperature_k.given)
        return WALL_HEAT_TEMPERATURE;
    return !isnan(heat->flux_w) && heat->flux_w != 0.0 ? WALL_HEAT_FLUX : WALL_HEAT_ADIABATIC;
}

status check_wall_heat(reader *r, int node, const wall_heat *heat)
{
    int ways = heat->adiabatic + heat->temperature_k.given + !isnan(heat->flux_w);
    if (ways > 1)
        return document_fail(r->document, node, r->why,
                             "a wall is adiabatic (`heat: adiabatic`), or has a `temperature_k`, or gives a `heat_flux_w`; keep one");
    return STATUS_OK;
}

static status check_environment(reader *r)
{
    const scene *s = r->scene;
    static const slot_id slots[] = {SLOT_CONVECTION, SLOT_RADIATION};
    for (size_t k = 0; k < 2; k++) {
        const effect *live = scene_effect(s, -1, slots[k]);
        if (!live)
            continue;
        int node = document_at(r->document, "effects[%d]", (int)(live - s->effect));
        if (!s->environment.temperature_k.given)
            return document_fail(r->document, node, r->why, "the %s law `%s` needs the temperature of the environment; add `environment: {temperature_k: ...}`",
                                 slot_name(slots[k]), live->law->name);
        for (int n = 0; n < LAW_PROPERTIES_MAX && live->law->gas_needs[n]; n++)
            if (isnan(scene_gas(s, live->law->gas_needs[n])))
                return document_fail(r->document, node, r->why, "the %s law `%s` needs `environment.gas.%s`", slot_name(slots[k]), live->law->name,
                                     live->law->gas_needs[n]->key);
    }
    return STATUS_OK;
}

/* Going back undoes what later stages have changed, by itself: only not the motions, which go on from where they are. */
static bool changes_motion(const scene_stage *stage)
{
    bool motion = stage->group_change_count > 0 || stage->wall_group_change_count > 0;
    for (int c = 0; c < stage->wall_change_count; c++)
        motion = motion || stage->wall_change[c].motion_given || stage->wall_change[c].servo.given;
    return motion;
}

static status check_repeat(reader *r, int t)
{
    scene *s = r->scene;
    scene_stage *stage = &s->stage[t];
    int node = document_at(r->document, "stages[%d].repeat", t), from = -1;
    if (!stage->repeat_from)
        return STATUS_OK;
    for (int k = 0; k < t && from < 0; k++)
        if (strcmp(s->stage[k].name, stage->repeat_from) == 0)
            from = k;
    if (from < 0)
        return document_fail(r->document, document_at(r->document, "stages[%d].repeat.from", t), r->why,
                             "`from` must name a stage before this one; no such stage is called `%s`", stage->repeat_from);
    if (!scene_has_heat(s))
        return document_fail(r->document, node, r->why,
                             "rounds of stages end when temperatures stand, and no law of heat is listed under `effects`; add one, or leave `repeat` out");
    for (int k = from; k < t; k++)
        if (s->stage[k].repeat_from)
            return document_fail(r->document, node, r->why, "the stage `%s` between `%s` and this one repeats stages itself; rounds do not nest",
                                 s->stage[k].name, stage->repeat_from);
    for (int k = from + 1; k <= t; k++)
        if (changes_motion(&s->stage[k]))
            return document_fail(r->document, document_at(r->document, "stages[%d].change", k), r->why,
                                 "stages that are repeated may change motions and servos in the first of them alone, `%s`", stage->repeat_from);
    if (isnan(stage->repeat_change) && stage->repeat_rounds < 0)
        stage->repeat_change = 1e-3;
    if (stage->repeat_rounds < 0)
        stage->repeat_rounds = 100;
    stage->repeat_index = from;
    return STATUS_OK;
}

/* What a stage with frozen motion needs, and what only such a stage may ask for. */
status check_frozen_stage(reader *r, int t)
{
    const scene *s = r->scene;
    const scene_stage *stage = &s->stage[t];
    int node = document_at(r->document, "stages[%d]", t);
    if (!isnan(stage->until_steady_k_s) && !scene_has_heat(s))
        return document_fail(r->document, document_at(r->document, "stages[%d].until.steady_k_s", t), r->why,
                             "`steady_k_s` looks at temperatures, and no law of heat is listed under `effects`; add one, or use `time_s`");
    TRY(check_repeat(r, t));
    if (!stage->frozen)
        return STATUS_OK;
    if (stage->heat_every > 1)
        return document_fail(r->document, document_at(r->document, "stages[%d].heat.every_steps", t), r->why,
                             "`every_steps` is for stages in which grains move; where motion is frozen heat has steps of its own");
    if (!scene_has_heat(s))
        return document_fail(r->document, node, r->why,
                             "`motion: frozen` leaves only heat to advance, and no law of heat is listed under `effects`; add one, like "
                             "{slot: conduction, law: overlap_area}");
    if (!isnan(stage->until_rest) || !isnan(stage->until_rest_j))
        return document_fail(r->document, node, r->why, "nothing moves in a stage with `motion: frozen`; end it by `time_s`, `steps` or `steady_k_s`");
    if (!isnan(stage->step_s))
        return document_fail(r->document, document_at(r->document, "stages[%d].step_s", t), r->why,
                             "the steps of a stage with `motion: frozen` follow from `heat: {tolerance: ...}`; leave `step_s` out");
    return STATUS_OK;
}

static status check_thermal_groups(reader *r)
{
    const scene *s = r->scene;
    for (int g = 0; g < s->group_count; g++) {
        const particle_group *group = &s->group[g];
        int node = document_at(r->document, "particles[%d]", g);
        if (group->thermal == THERMAL_PRESCRIBED && !group->temperature.given)
            return document_fail(r->document, node, r->why, "`thermal: prescribed` needs `temperature_k`, a number or a table in time");
        if (group->thermal != THERMAL_PRESCRIBED && quantity_varies_in_time(&group->temperature))
            return document_fail(r->document, document_at(r->document, "particles[%d].temperature_k", g), r->why,
                                 "a table in time prescribes the temperature; add `thermal: prescribed`, or give a number to start from");
        if (group->thermal == THERMAL_FLUX && isnan(group->heat_flux_w))
            return document_fail(r->document, node, r->why, "`thermal: flux` needs `heat_flux_w`, the heat into each particle");
        if (group->thermal != THERMAL_FLUX && !isnan(group->heat_flux_w))
            return document_fail(r->document, document_at(r->document, "particles[%d].heat_flux_w", g), r->why,
                                 "`heat_flux_w` needs `thermal: flux`");
    }
    return STATUS_OK;
}

static double option_of(const effect *live, const char *key)
{
    for (int k = 0; k < LAW_OPTIONS_MAX && live->law->options[k].key; k++)
        if (strcmp(live->law->options[k].key, key) == 0)
            return live->option[k];
    return 0.0;
}

/* The correction of a soft modulus compares Hertz contacts of two moduli. */
static status check_conduction(reader *r)
{
    const scene *s = r->scene;
    const effect *live = scene_effect(s, -1, SLOT_CONDUCTION), *normal = scene_effect(s, -1, SLOT_NORMAL);
    if (!live)
        return STATUS_OK;
    int node = document_at(r->document, "effects[%d]", (int)(live - s->effect));
    if (live->law == &law_pipe_network && s->dimensions != 2)
        return document_fail(r->document, node, r->why, "the conduction law `pipe_network` is for discs; it needs `dimensions: 2`");
    if (option_of(live, "soft_modulus") == 0.0)
        return STATUS_OK;
    if (!normal || normal->law != &law_hertz)
        return document_fail(r->document, node, r->why, "`soft_modulus` corrects Hertz contacts; it needs {slot: normal, law: hertz}");
    for (int m = 0; m < s->material_count; m++)
        if (isnan(scene_material(s, m, &property_real_modulus)))
            return document_fail(r->document, document_at(r->document, "materials[%d]", m), r->why, "`soft_modulus` needs `%s`, which the material `%s` lacks",
                                 property_real_modulus.key, s->material[m].name);
    return STATUS_OK;
}

status scene_check_heat(reader *r)
{
    const scene *s = r->scene;
    TRY(check_thermal_groups(r));
    TRY(check_environment(r));
    TRY(check_conduction(r));
    TRY(scene_check_sources(r));
    for (int m = 0; m < s->material_count && scene_has_temperature(s); m++)
        if (isnan(scene_material(s, m, &property_specific_heat)))
            return document_fail(r->document, document_at(r->document, "materials[%d]", m), r->why,
                                 "the material `%s` lacks `%s`, which every scene with temperatures needs", s->material[m].name,
                                 property_specific_heat.key);
    const effect *modulus = scene_effect(s, -1, SLOT_MODULUS);
    for (int m = 0; m < s->material_count && !(modulus && modulus->law == &law_modulus_table); m++)
        if (scene_material_table(s, m, &property_youngs_modulus))
            return document_fail(r->document, document_at(r->document, "materials[%d].%s", m, property_youngs_modulus.key), r->why,
                                 "a table of `%s` needs the law that reads it; add {slot: modulus, law: table}, or give a number", property_youngs_modulus.key);
    if (scene_outputs(s, "modulus_factor") && !scene_effect(s, -1, SLOT_MODULUS))
        return document_fail(r->document, document_at(r->document, "output.fields"), r->why,
                             "the field `modulus_factor` needs a law of the modulus, like {slot: modulus, law: exponential_softening}");
    return STATUS_OK;
}
