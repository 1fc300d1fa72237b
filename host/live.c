#include "live.h"

#include "laws/fields.h"
#include "laws/laws.h"
#include "property.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool wants_output(const scene *scene, const char *name)
{
    for (int f = 0; f < scene->output.field_count; f++)
        if (strcmp(scene->output.fields[f], name) == 0)
            return true;
    for (int o = 0; o < scene->output.observable_count; o++)
        if (strcmp(scene->output.observables[o], name) == 0)
            return true;
    return false;
}

static bool group_moves(const scene *scene, int group)
{
    if (scene->group[group].fixed || scene->group[group].motion.count > 0)
        return true;
    for (int s = 0; s < scene->stage_count; s++)
        for (int c = 0; c < scene->stage[s].group_change_count; c++) {
            const group_change *change = &scene->stage[s].group_change[c];
            if (change->group == group && !change->free)
                return true;
        }
    return false;
}

static bool any_group_moves(const scene *scene)
{
    for (int g = 0; g < scene->group_count; g++)
        if (group_moves(scene, g))
            return true;
    return false;
}

static bool any_spin(const bed *bed)
{
    for (int64_t i = 0; i < bed->count; i++)
        if (bed->spin[i][0] != 0.0 || bed->spin[i][1] != 0.0 || bed->spin[i][2] != 0.0)
            return true;
    return false;
}

static bool any_finite_wall(const scene *scene)
{
    for (int w = 0; w < scene->wall_count; w++)
        if (scene->wall[w].shape != WALL_PLANE)
            return true;
    return false;
}

/* Static and dynamic friction differ somewhere, in some stage. */
static bool two_frictions(const scene *scene)
{
    for (int s = -1; s < scene->stage_count; s++)
        for (int a = 0; a < scene->material_count; a++)
            for (int p = 0; p < scene->material_count + scene->wall_count; p++) {
                int b = p < scene->material_count ? p : -1, w = p < scene->material_count ? -1 : p - scene->material_count;
                double rest = scene_interaction(scene, s, a, b, w, &property_friction_static);
                double slide = scene_interaction(scene, s, a, b, w, &property_friction_dynamic);
                if (rest != slide && !(isnan(rest) && isnan(slide)))
                    return true;
            }
    return false;
}

static bool law_turns(const law *l)
{
    return l && l->turns;
}

void live_laws_of(const scene *scene, const bed *bed, live_laws *out)
{
    memset(out, 0, sizeof *out);
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++) {
        const effect *e = slot_is_listed(slot) ? scene_effect(scene, -1, slot) : NULL;
        if (!e)
            continue;
        out->law[slot] = e->law;
        out->option[slot] = e->option;
    }
    bool turning = law_turns(out->law[SLOT_BOND]) || scene_effect(scene, -1, SLOT_TANGENTIAL) || scene_effect(scene, -1, SLOT_ROLLING) || wants_output(scene, "spin") ||
                   wants_output(scene, "orientation") || wants_output(scene, "rotational_energy") || any_spin(bed);
    if (scene->material_count > 1)
        out->law[SLOT_COMPOSITION] = &law_composition_several;
    if (scene->domain.given && (scene->domain.periodic[0] || scene->domain.periodic[1] || scene->domain.periodic[2]))
        out->law[SLOT_PERIODIC] = &law_periodic_box;
    if (any_group_moves(scene))
        out->law[SLOT_MOTION] = &law_motion_groups;
    if (turning)
        out->law[SLOT_ROTATION] = &law_rotation_spin;
    if (out->law[SLOT_TANGENTIAL])
        out->law[SLOT_SLIP] = two_frictions(scene) ? &law_slip_two : &law_slip_single;
    if (scene->wall_count > 0)
        out->law[SLOT_WALLS] = any_finite_wall(scene) ? &law_walls_finite : &law_walls_planes;
    if (wants_output(scene, "orientation"))
        out->law[SLOT_ORIENTATION] = &law_orientation_quaternion;
    const law *verlet = turning ? &law_velocity_verlet_spin : &law_velocity_verlet;
    out->law[SLOT_INTEGRATOR] = scene->integrator == INTEGRATOR_VELOCITY_VERLET ? verlet : &law_semi_implicit_euler;
}

void live_laws_in_stage(const scene *scene, const live_laws *all, int stage, live_laws *out)
{
    *out = *all;
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
        if (slot_is_listed(slot) && !scene_effect(scene, stage, slot))
            out->law[slot] = NULL;
    if (!out->law[SLOT_TANGENTIAL])
        out->law[SLOT_SLIP] = NULL;
}

/* The file that fills a slot when no law does. */
static const char *none_file(slot_id slot)
{
    static const char *const files[SLOT_COUNT] = {
        [SLOT_COMPOSITION] = "none/composition.cl", [SLOT_PERIODIC] = "none/periodic.cl",       [SLOT_MOTION] = "none/motion.cl",
        [SLOT_ROTATION] = "none/rotation.cl",       [SLOT_NORMAL] = "none/normal.cl",           [SLOT_BONDING] = "none/bonding.cl",
        [SLOT_BOND] = "none/bond.cl",               [SLOT_COHESION] = "none/cohesion.cl",       [SLOT_SLIP] = "none/slip.cl",
        [SLOT_TANGENTIAL] = "none/tangential.cl",   [SLOT_ROLLING] = "none/rolling.cl",         [SLOT_WALLS] = "none/walls.cl",
        [SLOT_BODY] = "none/body.cl",               [SLOT_ORIENTATION] = "none/orientation.cl", [SLOT_INTEGRATOR] = NULL,
    };
    return files[slot];
}

bool live_keeps_half_steps(const live_laws *live)
{
    return live_uses(live, &field_half_velocity);
}

int live_files(const live_laws *live, const char **files, int max)
{
    static const char *const stages[] = {"stage/contact.cl", "stage/pair.cl", "stage/particle.cl", "stage/observe.cl"};
    int count = 0;
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++) {
        const law *l = live->law[slot];
        if (count < max)
            files[count++] = l ? l->kernel_file : none_file(slot);
        for (int f = 0; l && f < LAW_FILES_MAX && l->more_files[f] && count < max; f++)
            files[count++] = l->more_files[f];
    }
    for (size_t s = 0; s < sizeof stages / sizeof *stages && count < max; s++)
        files[count++] = stages[s];
    if (live_keeps_half_steps(live) && count < max)
        files[count++] = "stage/synchronise.cl";
    return count;
}

int live_table_files(const live_laws *live, const char **files)
{
    const law *periodic = live->law[SLOT_PERIODIC];
    int count = 0;
    files[count++] = periodic ? periodic->kernel_file : none_file(SLOT_PERIODIC);
    files[count++] = "stage/scan.cl";
    files[count++] = "stage/table.cl";
    if (live->law[SLOT_WALLS])
        files[count++] = "stage/table_walls.cl";
    return count;
}

int live_constant_count(const live_laws *live)
{
    int count = 0;
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
        for (int p = 0; live->law[slot] && p < LAW_PARAMETERS_MAX && live->law[slot]->parameters[p]; p++)
            count++;
    return count > 0 ? count : 1;
}

void live_constants(const live_laws *live, const scene *scene, char *text, size_t size)
{
    int place = 0;
    size_t used = 0;
    text[0] = '\0';
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++) {
        const law *l = live->law[slot];
        if (!l)
            continue;
        for (int p = 0; p < LAW_PARAMETERS_MAX && l->parameters[p]; p++) {
            used = strlen(text);
            snprintf(text + used, size - used, "#define %s %d\n", l->parameters[p], place++);
        }
        if (l->constants)
            l->constants(live->option[slot], text, size);
        if (l->scene_constants)
            l->scene_constants(scene, text, size);
    }
    used = strlen(text);
    snprintf(text + used, size - used, "#define CONTACT_CONSTANTS %d\n", live_constant_count(live));
    if (live->law[SLOT_COMPOSITION]) {
        used = strlen(text);
        snprintf(text + used, size - used, "#define PARTIES %d\n", scene->material_count + scene->wall_count);
    }
}

int live_class_count(const live_laws *live, const scene *scene)
{
    (void)live;
    return scene->material_count * (scene->material_count + scene->wall_count);
}

void live_class_constants(const live_laws *live, const scene *scene, int stage, double *out)
{
    int width = live_constant_count(live), parties = scene->material_count + scene->wall_count;
    memset(out, 0, sizeof *out * (size_t)width * (size_t)live_class_count(live, scene));
    for (int a = 0; a < scene->material_count; a++)
        for (int p = 0; p < parties; p++) {
            bool wall = p >= scene->material_count;
            contact_class class = {scene, stage, a, wall ? -1 : p, wall ? p - scene->material_count : -1};
            double *row = out + (size_t)(a * parties + p) * (size_t)width;
            for (slot_id slot = 0; slot < SLOT_COUNT; slot++) {
                const law *l = live->law[slot];
                if (!l || !l->derive)
                    continue;
                l->derive(&class, live->option[slot], row);
                for (int n = 0; n < LAW_PARAMETERS_MAX && l->parameters[n]; n++)
                    row++;
            }
        }
}

bool live_uses(const live_laws *live, const field *field)
{
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
        for (int f = 0; live->law[slot] && f < LAW_ARGUMENTS_MAX; f++)
            if (live->law[slot]->pair_fields[f] == field || live->law[slot]->particle_fields[f] == field)
                return true;
    return false;
}
