/* Which of the given properties matter, found by trying: a property is used when another value of it would change a constant of a
 * contact, or which laws are live, in some stage. That needs no list of what each law reads beside the laws themselves, and it also finds
 * values that closer entries hide from every contact. */
#include "parameter.h"
#include "plan_data.h"
#include "property.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct trial {
    scene *scene;
    const bed *bed;
    size_t grain_place;        /* of the constants of grains, behind those of contacts */
    size_t stage_bytes, bytes; /* of one stage's constants, and of all */
    double *before, *after;
    live_laws *live_before, *live_after;
    char **unused;
    int count;
} trial;

static void evaluate(const trial *t, double *constants, live_laws *live)
{
    live_laws all;
    live_laws_of(t->scene, t->bed, &all);
    for (int s = 0; s < t->scene->stage_count; s++) {
        live_laws_in_stage(t->scene, &all, s, &live[s]);
        double *own = constants + (size_t)s * t->stage_bytes / sizeof(double);
        live_class_constants(&live[s], t->scene, s, own);
        if (live[s].law[SLOT_TEMPERATURE])
            live_grain_constants(&live[s], t->scene, s, own + t->grain_place);
    }
}

/* Room for one stage: the laws of the union have the most constants. A changed value may call for other derived laws, hence the reserve. */
static size_t room(const scene *scene, const bed *bed, size_t *grain_place)
{
    live_laws all;
    live_laws_of(scene, bed, &all);
    *grain_place = (size_t)(live_constant_count(&all) + LAW_PARAMETERS_MAX) * (size_t)live_class_count(&all, scene);
    return sizeof(double) * (*grain_place + (size_t)(live_grain_constant_count(&all) + LAW_PARAMETERS_MAX) * (size_t)scene->material_count);
}

static bool matters(trial *t, double *value)
{
    double kept = *value;
    *value = kept == 0.0 ? 0.5 : 0.75 * kept; /* within the range of every property */
    memset(t->after, 0, t->bytes);
    memset(t->live_after, 0, (size_t)t->scene->stage_count * sizeof *t->live_after);
    evaluate(t, t->after, t->live_after);
    *value = kept;
    return memcmp(t->after, t->before, t->bytes) != 0 ||
           memcmp(t->live_after, t->live_before, (size_t)t->scene->stage_count * sizeof *t->live_after) != 0;
}

static void try_values(trial *t, double *value, const property *const *properties, const char *place)
{
    for (int k = 0; value && properties[k]; k++) {
        /* Density makes the masses, which are no constants of a contact. */
        if (isnan(value[k]) || properties[k] == &property_density || matters(t, &value[k]))
            continue;
        char text[512];
        snprintf(text, sizeof text, "%s.%s", place, properties[k]->key);
        char **longer = realloc(t->unused, ((size_t)t->count + 2) * sizeof *longer);
        if (!longer)
            return;
        t->unused = longer;
        t->unused[t->count++] = scene_copy(text);
        t->unused[t->count] = NULL;
    }
}

static void try_interactions(trial *t, interaction *entry, int count, const char *prefix)
{
    char place[400];
    for (int k = 0; k < count; k++) {
        if (entry[k].is_default)
            snprintf(place, sizeof place, "%sinteractions[default]", prefix);
        else
            snprintf(place, sizeof place, "%sinteractions[%.100s,%.100s]", prefix, entry[k].between[0], entry[k].between[1]);
        try_values(t, entry[k].value, interaction_properties(), place);
    }
}

static void try_stage(trial *t, int index)
{
    scene_stage *stage = &t->scene->stage[index];
    char prefix[128], place[400];
    if (stage->name)
        snprintf(prefix, sizeof prefix, "stages[%.80s].change.", stage->name);
    else
        snprintf(prefix, sizeof prefix, "stages[%d].change.", index);
    try_interactions(t, stage->interaction, stage->interaction_count, prefix);
    for (int k = 0; k < stage->wall_change_count; k++) {
        snprintf(place, sizeof place, "%swalls[%.100s]", prefix, t->scene->wall[stage->wall_change[k].wall].name);
        try_values(t, stage->wall_change[k].value, interaction_properties(), place);
    }
}

char **plan_unused(scene *scene, const bed *bed)
{
    size_t stages = (size_t)scene->stage_count;
    trial t = {.scene = scene, .bed = bed};
    t.stage_bytes = room(scene, bed, &t.grain_place);
    t.bytes = stages * t.stage_bytes;
    t.before = calloc(1, t.bytes);
    t.after = calloc(1, t.bytes);
    t.live_before = calloc(stages, sizeof *t.live_before);
    t.live_after = calloc(stages, sizeof *t.live_after);
    t.unused = calloc(1, sizeof *t.unused);
    if (t.before && t.after && t.live_before && t.live_after && t.unused) {
        char place[256];
        evaluate(&t, t.before, t.live_before);
        for (int m = 0; m < scene->material_count; m++) {
            snprintf(place, sizeof place, "materials[%.200s]", scene->material[m].name);
            try_values(&t, scene->material[m].value, material_properties(), place);
        }
        try_interactions(&t, scene->interaction, scene->interaction_count, "");
        for (int s = 0; s < scene->stage_count; s++)
            try_stage(&t, s);
    }
    free(t.before);
    free(t.after);
    free(t.live_before);
    free(t.live_after);
    return t.unused;
}
