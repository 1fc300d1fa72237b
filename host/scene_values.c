/* Values of a scene that no plain type covers, and checks over several keys of one mapping. */
#include "property.h"
#include "scene_check.h"
#include "scene_table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Index of a name in an array of structs whose names lie at `offset`. */
static int find_named(const void *array, int count, size_t size, size_t offset, const char *name)
{
    for (int k = 0; k < count; k++) {
        const char *other = *(char *const *)((const char *)array + (size_t)k * size + offset);
        if (other && strcmp(other, name) == 0)
            return k;
    }
    return -1;
}

/* Adds "`a`, `b`" to a text. */
static void append_names(char *text, size_t size, const void *array, int count, size_t stride, size_t offset)
{
    size_t used = strlen(text);
    for (int k = 0; k < count && used + 80 < size; k++) {
        const char *name = *(char *const *)((const char *)array + (size_t)k * stride + offset);
        used += (size_t)snprintf(text + used, size - used, "%s`%s`", used ? ", " : "", name);
    }
}

static status unknown_name(reader *r, int node, const char *kind, const char *word, const char *known)
{
    return document_fail(r->document, node, r->why, "there is no %s called `%.60s`; known here: %s", kind, word, known[0] ? known : "none");
}

static status read_reference(reader *r, const parameter *row, int node, const char *kind, const void *array, int count, size_t size,
                             size_t offset, int *out)
{
    const char *word = NULL;
    TRY(parameter_word(r, row->key, node, &word));
    *out = find_named(array, count, size, offset, word);
    if (*out >= 0)
        return STATUS_OK;
    char known[1024] = "";
    append_names(known, sizeof known, array, count, size, offset);
    return unknown_name(r, node, kind, word, known);
}

status read_wall_group(reader *r, const parameter *row, int node, void *target)
{
    return read_reference(r, row, node, "wall group", r->scene->wall_group, r->scene->wall_group_count, sizeof(wall_group),
                          offsetof(wall_group, name), (int *)((char *)target + row->offset));
}

status read_material(reader *r, const parameter *row, int node, void *target)
{
    return read_reference(r, row, node, "material", r->scene->material, r->scene->material_count, sizeof(material),
                          offsetof(material, name), (int *)((char *)target + row->offset));
}

status read_wall(reader *r, const parameter *row, int node, void *target)
{
    return read_reference(r, row, node, "wall", r->scene->wall, r->scene->wall_count, sizeof(wall), offsetof(wall, name),
                          (int *)((char *)target + row->offset));
}

status read_group(reader *r, const parameter *row, int node, void *target)
{
    return read_reference(r, row, node, "particle group", r->scene->group, r->scene->group_count, sizeof(particle_group),
                          offsetof(particle_group, name), (int *)((char *)target + row->offset));
}

static status unknown_body(reader *r, int node, const char *word)
{
    char known[1024] = "";
    append_names(known, sizeof known, r->scene->material, r->scene->material_count, sizeof(material), offsetof(material, name));
    append_names(known, sizeof known, r->scene->wall, r->scene->wall_count, sizeof(wall), offsetof(wall, name));
    return unknown_name(r, node, "material or wall", word, known);
}

status read_between(reader *r, const parameter *row, int node, void *target)
{
    interaction *entry = target;
    const scene *s = r->scene;
    char what[128];
    const char *word = document_scalar(r->document, node);
    entry->is_default = word && strcmp(word, "default") == 0;
    if (entry->is_default)
        return STATUS_OK;
    if (document_length(r->document, node) != 2)
        return document_fail(r->document, node, r->why, "`%s` must be `default` or two names [a, b]; it is %s", row->key,
                             document_describe(r->document, node, what, sizeof what));
    int walls = 0;
    for (int k = 0; k < 2; k++) {
        int item = document_item(r->document, node, k);
        TRY(parameter_word(r, row->key, item, &word));
        bool is_wall = find_named(s->wall, s->wall_count, sizeof(wall), offsetof(wall, name), word) >= 0;
        bool is_material = find_named(s->material, s->material_count, sizeof(material), offsetof(material, name), word) >= 0;
        walls += is_wall && !is_material; /* a name that both have is refused as such, later */
        if (!is_wall && !is_material)
            return unknown_body(r, item, word);
        entry->between[k] = scene_copy(word);
    }
    if (walls == 2)
        return document_fail(r->document, node, r->why, "`%s` names two walls, which do not interact; name a material and a wall",
                             row->key);
    return STATUS_OK;
}

status finish_interaction(reader *r, int node, void *target)
{
    (void)target;
    int damping = document_find(r->document, node, property_normal_damping.key);
    if (damping && document_find(r->document, node, property_restitution.key))
        return document_fail(r->document, damping, r->why,
                             "an interaction gives both `restitution` and `normal_damping_ratio`, which say the same thing; keep one");
    const property *const adhesion[] = {&property_bond_stiffness, &property_bond_equilibrium_overlap, &property_bond_normalised_stiffness,
                                        &property_bond_equilibrium_strain};
    const char *first = NULL;
    for (size_t k = 0; k < sizeof adhesion / sizeof *adhesion; k++) {
        int found = document_find(r->document, node, adhesion[k]->key);
        if (found && first)
            return document_fail(r->document, found, r->why, "an interaction gives both `%s` and `%s`, which say the same thing; keep one", first,
                                 adhesion[k]->key);
        first = found ? adhesion[k]->key : first;
    }
    return STATUS_OK;
}

static void list_slots(char *text, size_t size)
{
    size_t used = 0;
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
        if (slot_is_listed(slot))
            used += (size_t)snprintf(text + used, size - used, "%s`%s`", used ? ", " : "", slot_name(slot));
}

static void list_laws(slot_id slot, char *text, size_t size)
{
    size_t used = 0;
    for (const law *const *l = laws; *l; l++)
        if ((*l)->slot == slot)
            used += (size_t)snprintf(text + used, size - used, "%s`%s`", used ? ", " : "", (*l)->name);
}

static status read_slot(reader *r, int node, slot_id *slot)
{
    const char *word = NULL;
    char list[512];
    TRY(parameter_word(r, "slot", node, &word));
    *slot = slot_find(word);
    if (*slot != SLOT_COUNT && slot_is_listed(*slot))
        return STATUS_OK;
    list_slots(list, sizeof list);
    return document_fail(r->document, node, r->why, "there is no slot called `%.60s`; this version has %s", word, list);
}

static status read_law(reader *r, slot_id slot, int node, const law **out)
{
    const char *word = NULL;
    char list[512];
    TRY(parameter_word(r, "law", node, &word));
    *out = law_find(slot, word);
    if (*out)
        return STATUS_OK;
    list_laws(slot, list, sizeof list);
    return document_fail(r->document, node, r->why, "the slot `%s` has no law called `%.60s`; this version has %s", slot_name(slot), word,
                         list);
}

static status required_key(reader *r, int node, const char *key, const char *doc, int *found)
{
    char what[128];
    if (!document_is_mapping(r->document, node))
        return document_fail(r->document, node, r->why, "an effect must be a mapping like {slot: normal, law: hertz}; it is %s",
                             document_describe(r->document, node, what, sizeof what));
    *found = document_find(r->document, node, key);
    return *found ? STATUS_OK : document_fail(r->document, node, r->why, "an effect needs the key `%s`: %s", key, doc);
}

static status ignore_value(reader *r, const parameter *row, int node, void *target)
{
    (void)r, (void)row, (void)node, (void)target;
    return STATUS_OK;
}

/* The rows of one effect: slot and law, which are known by now, the name, and the law's own options. */
static status read_effect(reader *r, int node, effect *out)
{
    int slot_node = 0, law_node = 0;
    slot_id slot = SLOT_COUNT;
    TRY(required_key(r, node, "slot", "which part of the physics it fills", &slot_node));
    TRY(read_slot(r, slot_node, &slot));
    TRY(required_key(r, node, "law", "which law fills the slot", &law_node));
    TRY(read_law(r, slot, law_node, &out->law));
    parameter rows[LAW_OPTIONS_MAX + 6] = {
        {.key = "slot", .type = PARAMETER_OTHER, .read = ignore_value, .keep = true},
        {.key = "law", .type = PARAMETER_OTHER, .read = ignore_value, .keep = true},
        {.key = "name", .type = PARAMETER_NAME, .offset = offsetof(effect, name)},
    };
    char fallback[LAW_OPTIONS_MAX][32];
    int k = 0;
    for (; k < LAW_OPTIONS_MAX && out->law->options[k].key; k++) {
        const law_option *option = &out->law->options[k];
        snprintf(fallback[k], sizeof fallback[k], "%.17g", option->fallback);
        rows[3 + k] = (parameter){.key = option->key,
                                  .type = option->choices ? PARAMETER_CHOICE : PARAMETER_NUMBER,
                                  .low = option->low,
                                  .high = option->high,
                                  .choices = option->choices,
                                  .as_number = true,
                                  .required = !option->choices && isnan(option->fallback),
                                  .doc = option->doc,
                                  .fallback = option->choices ? NULL : fallback[k],
                                  .unit = parameter_unit(option->key),
                                  .offset = offsetof(effect, option) + (size_t)k * sizeof(double)};
    }
    for (int n = 0; slot == SLOT_SOURCE && beam_rows[n].key; n++)
        rows[3 + k++] = beam_rows[n];
    char name[128];
    snprintf(name, sizeof name, "%s effect with the law `%s`", slot_name(slot), out->law->name);
    const section one = {.name = name, .row = rows, .placed = true, .at = offsetof(effect, at)};
    return parameter_section(r, &one, node, out);
}

status read_effects(reader *r, const parameter *row, int node, void *target)
{
    scene *s = target;
    int length = 0;
    TRY(parameter_list_length(r, row, node, &length));
    s->effect = scene_allocate((size_t)length, sizeof *s->effect);
    s->effect_count = length;
    for (int k = 0; k < length; k++) {
        int item = document_item(r->document, node, k);
        TRY(read_effect(r, item, &s->effect[k]));
        for (int j = 0; j < k; j++)
            if (s->effect[j].law->slot == s->effect[k].law->slot && s->effect[k].law->slot != SLOT_SOURCE)
                return document_fail(r->document, item, r->why, "the slot `%s` is filled twice, by `%s` and by `%s`; keep one",
                                     slot_name(s->effect[k].law->slot), s->effect[j].law->name, s->effect[k].law->name);
    }
    return STATUS_OK;
}

status read_effects_off(reader *r, const parameter *row, int node, void *target)
{
    scene_stage *stage = target;
    int length = 0;
    TRY(parameter_list_length(r, row, node, &length));
    for (int k = 0; k < length; k++) {
        int item = document_item(r->document, node, k);
        slot_id slot = SLOT_COUNT;
        TRY(read_slot(r, item, &slot));
        if (!scene_effect(r->scene, -1, slot))
            return document_fail(r->document, item, r->why, "`%s` names the slot `%s`, which no entry of `effects` fills", row->key,
                                 slot_name(slot));
        stage->slot_off[slot] = true;
    }
    return STATUS_OK;
}

status read_radius(reader *r, const parameter *row, int node, void *target)
{
    radius_spec *radius = (radius_spec *)((char *)target + row->offset);
    if (document_is_mapping(r->document, node))
        return parameter_section(r, &radius_section, node, radius);
    radius->distribution = RADIUS_NUMBER;
    return parameter_number(r, row, node, &radius->value);
}

status read_sieve_sizes(reader *r, const parameter *row, int node, void *target)
{
    radius_spec *radius = target;
    int count = 0;
    TRY(parameter_numbers(r, row, node, &radius->size_m, &count));
    if (count != radius->count + 1)
        return document_fail(r->document, node, r->why, "`%s` has %d entries and `mass_fraction` %d; it takes one size more than fractions",
                             row->key, count, radius->count);
    for (int k = 1; k < count; k++)
        if (radius->size_m[k] <= radius->size_m[k - 1])
            return document_fail(r->document, document_item(r->document, node, k), r->why,
                                 "`%s` must rise from entry to entry; %g follows %g", row->key, radius->size_m[k], radius->size_m[k - 1]);
    return STATUS_OK;
}

status finish_radius(reader *r, int node, void *target)
{
    radius_spec *radius = target;
    if (radius->distribution == RADIUS_UNIFORM && radius->low > radius->high)
        return document_fail(r->document, document_find(r->document, node, "low"), r->why, "`low` (%g m) is above `high` (%g m)",
                             radius->low, radius->high);
    double least = radius->mean - radius->truncate_sigmas * radius->std;
    if (radius->distribution == RADIUS_NORMAL && least <= 0.0)
        return document_fail(r->document, node, r->why,
                             "radii down to mean - truncate_sigmas std = %g m would be drawn; lower `std` or `truncate_sigmas`", least);
    double sum = 0.0;
    for (int k = 0; k < radius->count; k++)
        sum += radius->mass_fraction[k];
    if (radius->distribution != RADIUS_SIEVE)
        return STATUS_OK;
    if (fabs(sum - 1.0) > 1e-6)
        return document_fail(r->document, document_find(r->document, node, "mass_fraction"), r->why,
                             "the entries of `mass_fraction` must add up to 1; they add up to %.9g", sum);
    for (int k = 0; k < radius->count; k++)
        radius->mass_fraction[k] /= sum;
    return STATUS_OK;
}

status read_items(reader *r, const parameter *row, int node, void *target)
{
    particle_group *group = target;
    int length = 0;
    TRY(parameter_list_length(r, row, node, &length));
    group->item = scene_allocate((size_t)length, sizeof *group->item);
    group->item_count = length;
    group->count = length;
    for (int k = 0; k < length; k++) {
        particle_item *item = &group->item[k];
        memcpy(item->velocity_m_s, group->velocity_m_s, sizeof item->velocity_m_s);
        memcpy(item->spin_rad_s, group->spin_rad_s, sizeof item->spin_rad_s);
        item->temperature_k = group->temperature_k;
        item->scalar = group->scalar;
        TRY(parameter_section(r, &item_section, document_item(r->document, node, k), item));
    }
    return STATUS_OK;
}

/* A number, or the table of a prescribed temperature, from whose start grains start. */
status read_group_temperature(reader *r, const parameter *row, int node, void *target)
{
    particle_group *group = target;
    parameter whole = *row;
    whole.offset = offsetof(particle_group, temperature);
    TRY(read_number_in_time(r, &whole, node, target));
    group->temperature_k = quantity_at(&group->temperature, 0.0);
    return STATUS_OK;
}

/* A relative path starts at the scene's folder. */
status read_file(reader *r, const parameter *row, int node, void *target)
{
    particle_group *group = target;
    const char *word = NULL;
    TRY(parameter_word(r, row->key, node, &word));
    const char *slash = strrchr(r->document->path, '/');
    size_t folder = word[0] != '/' && slash ? (size_t)(slash - r->document->path) + 1 : 0;
    group->path = scene_allocate(folder + strlen(word) + 1, 1);
    memcpy(group->path, r->document->path, folder);
    memcpy(group->path + folder, word, strlen(word) + 1);
    return STATUS_OK;
}

status read_corners(reader *r, const parameter *row, int node, void *target)
{
    wall *out = target;
    char what[128];
    if (document_length(r->document, node) != 3)
        return document_fail(r->document, node, r->why, "`%s` must be three points: a corner and its two neighbours; it is %s", row->key,
                             document_describe(r->document, node, what, sizeof what));
    for (int k = 0; k < 3; k++)
        TRY(parameter_vector(r, row, document_item(r->document, node, k), out->corners_m[k]));
    return STATUS_OK;
}

status read_cone_radii(reader *r, const parameter *row, int node, void *target)
{
    wall *out = target;
    double *radius = NULL;
    char what[128];
    int count = 0;
    if (!document_is_list(r->document, node) || document_length(r->document, node) != 2)
        return document_fail(r->document, node, r->why, "`%s` of a cone must be two numbers, [radius at the first end, at the other]; it is %s",
                             row->key, document_describe(r->document, node, what, sizeof what));
    status result = parameter_numbers(r, row, node, &radius, &count);
    if (result == STATUS_OK)
        memcpy(out->radii_m, radius, sizeof out->radii_m);
    free(radius);
    TRY(result);
    if (out->radii_m[0] == out->radii_m[1])
        return document_fail(r->document, node, r->why, "both radii of the cone are %g m; write `shape: cylinder` with one radius, above 0",
                             out->radii_m[0]);
    return STATUS_OK;
}

static status check_rectangle(reader *r, int node, const wall *w)
{
    int corners = document_find(r->document, node, "corners_m");
    double side[2][3], product = 0.0;
    for (int k = 0; k < 2; k++) {
        for (int c = 0; c < 3; c++)
            side[k][c] = w->corners_m[k + 1][c] - w->corners_m[0][c];
        if (!vector_normalise(side[k]))
            return document_fail(r->document, corners, r->why, "corners 1 and %d of the rectangle are the same point", k + 2);
    }
    for (int c = 0; c < 3; c++)
        product += side[0][c] * side[1][c];
    if (fabs(product) > 1e-6)
        return document_fail(r->document, corners, r->why,
                             "the sides of a rectangle must be perpendicular; at the first corner they meet at %.6g degrees",
                             acos(fmax(-1.0, fmin(1.0, product))) * 180.0 / acos(-1.0));
    bool planar = fabs(side[0][2]) == 1.0 || fabs(side[1][2]) == 1.0;
    if (r->scene->dimensions == 2 && !planar)
        return document_fail(r->document, corners, r->why,
                             "with `dimensions: 2` one side of a rectangle must lie along z, so that its normal lies in the plane");
    double low = w->corners_m[0][2], high = low;
    for (int k = 1; k < 3; k++) {
        low = fmin(low, w->corners_m[k][2]);
        high = fmax(high, w->corners_m[k][2]);
    }
    if (r->scene->dimensions == 2 && (low > 0.0 || high < 0.0))
        return document_fail(r->document, corners, r->why,
                             "with `dimensions: 2` a rectangle must reach the plane z = 0, in which the grains are; it runs from z = %g to %g", low, high);
    return STATUS_OK;
}

static status check_corners(reader *r, int node, const double low[3], const double high[3], const char *key, int axes, bool may_touch)
{
    for (int k = 0; k < axes; k++)
        if (low[k] > high[k] || (low[k] == high[k] && !may_touch))
            return document_fail(r->document, document_find(r->document, node, key), r->why,
                                 "`low_m` must be below `high_m` in %c; they are %.10g and %.10g", "xyz"[k], low[k], high[k]);
    return STATUS_OK;
}

static status check_planar_round(reader *r, int node, const wall *w)
{
    if (w->shape == WALL_CONE)
        return document_fail(r->document, document_find(r->document, node, "shape"), r->why,
                             "with `dimensions: 2` a cone's normals leave the x-y plane; use a cylinder along z, or rectangles");
    if (fabs(w->axis[2]) != 1.0)
        return document_fail(r->document, document_find(r->document, node, "axis"), r->why,
                             "with `dimensions: 2` the axis of a cylinder must lie along z: [0, 0, 1]");
    double end = w->axis_point_m[2] + w->axis[2] * w->length_m;
    if (fmin(w->axis_point_m[2], end) >= 0.0 || fmax(w->axis_point_m[2], end) <= 0.0)
        return document_fail(r->document, document_find(r->document, node, "axis_point_m"), r->why,
                             "with `dimensions: 2` a cylinder must pass through z = 0; it runs from z = %g to %g", w->axis_point_m[2], end);
    return STATUS_OK;
}

status finish_wall(reader *r, int node, void *target)
{
    wall *w = target;
    bool planar = r->scene->dimensions == 2;
    TRY(check_wall_heat(r, node, &w->heat));
    TRY(check_wall_group(r, node, w));
    if (w->shape == WALL_RECTANGLE)
        return check_rectangle(r, node, w);
    if (w->shape == WALL_CYLINDER)
        w->radii_m[1] = w->radii_m[0];
    if (w->shape == WALL_CYLINDER || w->shape == WALL_CONE)
        return planar ? check_planar_round(r, node, w) : STATUS_OK;
    if (w->shape == WALL_BOX) {
        TRY(check_corners(r, node, w->low_m, w->high_m, "low_m", planar ? 2 : 3, false));
        if (planar) { /* its faces reach far to both sides of the plane of the motion, whatever z the scene gives */
            w->open[4] = w->open[5] = true;
            w->high_m[2] = w->high_m[0] - w->low_m[0];
            w->low_m[2] = -w->high_m[2];
        }
        return STATUS_OK;
    }
    if (planar && w->normal[2] != 0.0)
        return document_fail(r->document, document_find(r->document, node, "normal"), r->why,
                             "with `dimensions: 2` a wall's normal must lie in the x-y plane; its z component is %g", w->normal[2]);
    return STATUS_OK;
}

status finish_domain(reader *r, int node, void *target)
{
    const domain *d = target;
    bool planar = r->scene->dimensions == 2;
    if (planar && d->periodic[2])
        return document_fail(r->document, document_find(r->document, node, "periodic"), r->why,
                             "with `dimensions: 2` the domain cannot repeat along z");
    return check_corners(r, node, d->low_m, d->high_m, "low_m", planar ? 2 : 3, false);
}

status finish_region(reader *r, int node, void *target)
{
    const particle_group *group = target;
    const double *low = group->region_low_m, *high = group->region_high_m;
    if (r->scene->dimensions == 2 && (low[2] != 0.0 || high[2] != 0.0))
        return document_fail(r->document, node, r->why, "with `dimensions: 2` a region lies at z = 0; its z runs from %g to %g", low[2],
                             high[2]);
    return check_corners(r, node, low, high, "low_m", r->scene->dimensions, false);
}

status finish_until(reader *r, int node, void *target)
{
    const scene_stage *stage = target;
    if (isnan(stage->until_time_s) && stage->until_steps < 0 && isnan(stage->until_rest) && isnan(stage->until_rest_j) &&
        isnan(stage->until_steady_k_s))
        return document_fail(r->document, node, r->why, "`until` needs at least one of `time_s`, `steps`, `rest`, `rest_j` and `steady_k_s`");
    return STATUS_OK;
}
