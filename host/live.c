#include "live.h"

#include "laws/fields.h"
#include "laws/laws.h"
#include "ledger.h"
#include "property.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool wants_ledger(const scene *scene)
{
    for (int t = 0; t < LEDGER_TERMS; t++)
        if (scene_outputs(scene, ledger_terms[t]))
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

/* The least of the three that knows every shape of the scene. */
static const law *wall_law(const scene *scene)
{
    const law *least = scene->wall_count > 0 ? &law_walls_planes : NULL;
    for (int w = 0; w < scene->wall_count; w++) {
        wall_shape shape = scene->wall[w].shape;
        if (shape == WALL_CYLINDER || shape == WALL_CONE)
            return &law_walls_round;
        if (shape != WALL_PLANE)
            least = &law_walls_finite;
    }
    return least;
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

static const law *temperature_law(const scene *scene, const live_laws *live)
{
    bool tabled = scene_has_material_table(scene, &property_specific_heat);
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
        if (live->law[slot] && live->law[slot]->reads_temperature)
            return tabled ? &law_temperature_pairs_tabled : &law_temperature_pairs;
    return tabled ? &law_temperature_grains_tabled : &law_temperature_grains;
}

/* Properties that depend on temperature, where a live law reads them. */
static void derive_tables(const scene *scene, live_laws *out)
{
    bool friction = scene_has_interaction_table(scene, &property_friction_static) || scene_has_interaction_table(scene, &property_friction_dynamic);
    if (out->law[SLOT_TANGENTIAL] && friction)
        out->law[SLOT_FRICTION] = &law_friction_tabled;
    if (out->law[SLOT_CONDUCTION] && scene_has_material_table(scene, &property_conductivity))
        out->law[SLOT_CONDUCTIVITY] = &law_conductivity_tabled;
    bool grains = out->law[SLOT_CONDUCTIVITY] || out->law[SLOT_MODULUS] == &law_modulus_table || scene_has_material_table(scene, &property_specific_heat);
    if (out->law[SLOT_FRICTION])
        out->law[SLOT_TABLES] = grains ? &law_tables_of_both : &law_tables_of_pairs;
    else if (grains)
        out->law[SLOT_TABLES] = &law_tables_of_grains;
}

static bool any_wall_heat(const scene *scene, wall_heat_kind kind)
{
    for (int stage = -1; stage < scene->stage_count; stage++)
        for (int w = 0; w < scene->wall_count; w++)
            if (wall_heat_kind_of(scene_wall_heat(scene, stage, w)) == kind)
                return true;
    return false;
}

/* Slots that a scene with heat fills of itself. */
static void derive_heat(const scene *scene, live_laws *out)
{
    const environment *e = &scene->environment;
    bool profile = (e->temperature_k.given && e->temperature_k.kind == QUANTITY_AXIS) ||
                   (e->gas_velocity_m_s.given && e->gas_velocity_m_s.kind == QUANTITY_AXIS);
    derive_tables(scene, out);
    for (int t = 0; t < scene->stage_count; t++)
        if (scene->stage[t].heat_every > 1)
            out->law[SLOT_HEAT_STEPS] = &law_heat_steps_every;
    out->law[SLOT_TEMPERATURE] = temperature_law(scene, out);
    if (out->law[SLOT_SOURCE])
        out->law[SLOT_SOURCE] = law_of_beams(scene);
    if (scene->material_count > 1)
        out->law[SLOT_SUBSTANCE] = &law_substance_several;
    if (out->law[SLOT_CONDUCTION] && any_wall_heat(scene, WALL_HEAT_TEMPERATURE))
        out->law[SLOT_WALL_HEAT] = &law_wall_temperature;
    if (out->law[SLOT_CONDUCTION] && any_wall_heat(scene, WALL_HEAT_FLUX))
        out->law[SLOT_WALL_HEAT] = &law_wall_flux;
    if (out->law[SLOT_CONVECTION] || out->law[SLOT_RADIATION])
        out->law[SLOT_ENVIRONMENT] = profile ? &law_environment_profile : &law_environment_uniform;
    for (int g = 0; g < scene->group_count; g++)
        if (scene->group[g].thermal != THERMAL_FREE)
            out->law[SLOT_THERMAL_GROUPS] = &law_thermal_groups;
    if (scene_tallies_heat(scene))
        out->law[SLOT_HEAT_TALLY] = &law_heat_tally;
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
    bool turning = law_turns(out->law[SLOT_BOND]) || scene_effect(scene, -1, SLOT_TANGENTIAL) || scene_effect(scene, -1, SLOT_ROLLING) ||
                   scene_outputs(scene, "spin") || scene_outputs(scene, "orientation") || scene_outputs(scene, "rotational_energy") || any_spin(bed);
    if (scene->precision == PRECISION_MIXED)
        out->law[SLOT_PRECISION] = &law_precision_mixed;
    if (scene->material_count > 1)
        out->law[SLOT_COMPOSITION] = &law_composition_several;
    if (scene->dimensions == 2)
        out->law[SLOT_DIMENSIONS] = &law_dimensions_two;
    if (scene->domain.given && (scene->domain.periodic[0] || scene->domain.periodic[1] || scene->domain.periodic[2]))
        out->law[SLOT_PERIODIC] = &law_periodic_box;
    if (any_group_moves(scene))
        out->law[SLOT_MOTION] = &law_motion_groups;
    if (turning)
        out->law[SLOT_ROTATION] = &law_rotation_spin;
    if (out->law[SLOT_TANGENTIAL])
        out->law[SLOT_SLIP] = two_frictions(scene) ? &law_slip_two : &law_slip_single;
    out->law[SLOT_WALLS] = wall_law(scene);
    if (wants_ledger(scene))
        out->law[SLOT_LEDGER] = &law_ledger_energies;
    if (out->law[SLOT_LEDGER] || out->law[SLOT_DISSIPATION_HEAT])
        out->law[SLOT_DISSIPATION] = scene->integrator == INTEGRATOR_VELOCITY_VERLET ? &law_dissipation_synchronous : &law_dissipation_tracked;
    if (out->law[SLOT_LEDGER] && out->law[SLOT_MODULUS])
        out->law[SLOT_SOFTENING] = &law_softening_tracked;
    if (out->law[SLOT_LEDGER] && out->law[SLOT_RADIUS])
        out->law[SLOT_EXPANSION] = &law_expansion_tracked;
    out->servo = scene_has_servo(scene);
    if (scene_outputs(scene, "orientation"))
        out->law[SLOT_ORIENTATION] = &law_orientation_quaternion;
    const law *verlet = turning ? &law_velocity_verlet_spin : &law_velocity_verlet;
    out->law[SLOT_INTEGRATOR] = scene->integrator == INTEGRATOR_VELOCITY_VERLET ? verlet : &law_semi_implicit_euler;
    out->law[SLOT_BONDING] = bonding_of(out->law[SLOT_BOND], out->option[SLOT_BOND]);
    out->option[SLOT_BONDING] = out->option[SLOT_BOND];
    if (scene_has_temperature(scene))
        derive_heat(scene, out);
}

/* Laws by which two bodies act on each other that do not touch, and sums over steps. */
static bool acts_apart(const live_laws *live)
{
    return live->law[SLOT_BOND] || live->law[SLOT_COHESION] || live->law[SLOT_DISSIPATION];
}

/* What records give stands side by side in mixed precision, where nothing else is read of it while steps are taken: no flow of heat, no force on a wall; and
 * in three dimensions, since in two there are but four numbers of it (docs/performance.md). */
static const law *rotation_by_blocks(const live_laws *live)
{
    if (!live->law[SLOT_PRECISION] || live->law[SLOT_DIMENSIONS] || live->law[SLOT_CONDUCTION] || live->servo)
        return live->law[SLOT_ROTATION];
    return live->law[SLOT_ROLLING] || live->law[SLOT_BOND] ? &law_rotation_wrenches_moment : &law_rotation_wrenches;
}

void live_for_blocks(live_laws *all)
{
    if (all->blocks && all->law[SLOT_ROTATION])
        all->law[SLOT_ROTATION] = rotation_by_blocks(all);
    all->law[SLOT_PACKED] = all->blocks && all->law[SLOT_PRECISION] ? &law_packed_grains : NULL;
    all->law[SLOT_TOUCHED] = all->blocks && !acts_apart(all) ? &law_touched_marks : NULL;
}

void live_laws_in_stage(const scene *scene, const live_laws *all, int stage, live_laws *out)
{
    *out = *all;
    out->frozen = stage >= 0 && scene->stage[stage].frozen;
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
        if (slot_is_listed(slot) && !scene_effect(scene, stage, slot))
            out->law[slot] = NULL;
    if (stage >= 0 && scene->stage[stage].heat_every <= 1)
        out->law[SLOT_HEAT_STEPS] = NULL;
    if (!out->law[SLOT_TANGENTIAL])
        out->law[SLOT_SLIP] = out->law[SLOT_FRICTION] = NULL;
    if (!out->law[SLOT_CONDUCTION])
        out->law[SLOT_CONDUCTIVITY] = NULL;
    if (!out->law[SLOT_BOND])
        out->law[SLOT_BONDING] = NULL;
    if (!out->law[SLOT_MODULUS])
        out->law[SLOT_SOFTENING] = NULL;
    if (!out->law[SLOT_RADIUS])
        out->law[SLOT_EXPANSION] = NULL;
    if (out->law[SLOT_TEMPERATURE])
        out->law[SLOT_TEMPERATURE] = temperature_law(scene, out);
    if (!out->law[SLOT_CONDUCTION])
        out->law[SLOT_WALL_HEAT] = NULL;
    if (!out->law[SLOT_CONVECTION] && !out->law[SLOT_RADIATION])
        out->law[SLOT_ENVIRONMENT] = NULL;
}

/* The file that fills a slot when no law does. */
static const char *none_file(slot_id slot)
{
    static const char *const files[SLOT_COUNT] = {
        [SLOT_PRECISION] = "precision/double.cl",   [SLOT_COMPOSITION] = "none/composition.cl", [SLOT_DIMENSIONS] = "none/dimensions.cl", [SLOT_PERIODIC] = "none/periodic.cl",       [SLOT_MOTION] = "none/motion.cl",
        [SLOT_ROTATION] = "none/rotation.cl",       [SLOT_NORMAL] = "none/normal.cl",           [SLOT_BONDING] = "none/bonding.cl",
        [SLOT_BOND] = "none/bond.cl",               [SLOT_COHESION] = "none/cohesion.cl",       [SLOT_SLIP] = "none/slip.cl",
        [SLOT_TANGENTIAL] = "none/tangential.cl",   [SLOT_ROLLING] = "none/rolling.cl",         [SLOT_WALLS] = "none/walls.cl",
        [SLOT_TEMPERATURE] = "none/temperature.cl", [SLOT_SUBSTANCE] = "none/substance.cl",     [SLOT_CONDUCTION] = "none/conduction.cl",
        [SLOT_WALL_HEAT] = "none/wall_heat.cl",     [SLOT_ENVIRONMENT] = "none/environment.cl", [SLOT_CONVECTION] = "none/convection.cl",
        [SLOT_RADIATION] = "none/radiation.cl",     [SLOT_SOURCE] = "none/source.cl",           [SLOT_HEAT_GENERATION] = "none/heat_generation.cl",
        [SLOT_THERMAL_GROUPS] = "none/thermal_groups.cl", [SLOT_HEAT_TALLY] = "none/heat_tally.cl",
        [SLOT_MODULUS] = "none/modulus.cl",         [SLOT_SOFTENING] = "none/softening.cl",
        [SLOT_HEAT_STEPS] = "none/heat_steps.cl",
        [SLOT_TABLES] = "none/tables.cl",           [SLOT_CONDUCTIVITY] = "none/conductivity.cl", [SLOT_FRICTION] = "none/friction.cl",
        [SLOT_RADIUS] = "none/radius.cl",           [SLOT_EXPANSION] = "none/expansion.cl",
        [SLOT_DISSIPATION] = "none/dissipation.cl", [SLOT_LEDGER] = "none/ledger.cl",           [SLOT_DISSIPATION_HEAT] = "none/dissipation_heat.cl",
        [SLOT_BODY] = "none/body.cl",               [SLOT_ORIENTATION] = "none/orientation.cl", [SLOT_INTEGRATOR] = NULL,
        [SLOT_PACKED] = "none/packed.cl",           [SLOT_TOUCHED] = "none/touched.cl",
    };
    return files[slot];
}

bool live_keeps_half_steps(const live_laws *live)
{
    return live_uses(live, &field_half_velocity);
}

bool live_changes_stiffness(const live_laws *live)
{
    return !live->frozen && live->law[SLOT_NORMAL] && (live->law[SLOT_MODULUS] || live->law[SLOT_RADIUS]);
}

static const char *rows_file(const live_laws *live)
{
    return live->law[SLOT_PACKED] ? "stage/rows_packed.cl" : "stage/rows_gathered.cl";
}

static const char *wrenches_file(const live_laws *live)
{
    const law *rotation = live->law[SLOT_ROTATION];
    return rotation && rotation != &law_rotation_spin ? "stage/wrenches_together.cl" : "stage/wrenches_apart.cl";
}

int live_files(const live_laws *live, const char **files, int max)
{
    static const char *const stages[] = {"stage/contact.cl", "stage/pair.cl", "stage/particle.cl", NULL, "stage/observe.cl"};
    int count = 0;
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++) {
        const law *l = live->law[slot];
        if (count < max)
            files[count++] = l ? l->kernel_file : none_file(slot);
        for (int f = 0; l && f < LAW_FILES_MAX && l->more_files[f] && count < max; f++)
            files[count++] = l->more_files[f];
    }
    for (size_t s = 0; s < sizeof stages / sizeof *stages; s++) {
        for (int f = 0; !stages[s] && live->blocks && f < 4 && count < max; f++)
            files[count++] = f == 0 ? "stage/team.cl" : f == 1 ? "stage/rows.cl" : f == 2 ? rows_file(live) : wrenches_file(live);
        if (count < max)
            files[count++] = stages[s] ? stages[s] : live->blocks ? "stage/by_blocks.cl" : "stage/by_items.cl";
    }
    if (live_keeps_half_steps(live) && count < max)
        files[count++] = "stage/synchronise.cl";
    if (live->servo && count < max)
        files[count++] = "stage/servo.cl";
    if (live->law[SLOT_TEMPERATURE] && count < max)
        files[count++] = "stage/heat.cl";
    if (live->law[SLOT_WALL_HEAT] == &law_wall_flux && count < max)
        files[count++] = "stage/heat_areas.cl";
    if (live_changes_stiffness(live) && count < max)
        files[count++] = "stage/stiffness.cl";
    if (live->frozen && count < max)
        files[count++] = "stage/frozen.cl";
    if (live->law[SLOT_SOURCE] && count < max)
        files[count++] = "stage/beam.cl";
    return count;
}

int live_table_files(const live_laws *live, const char **files)
{
    static const slot_id slots[] = {SLOT_PRECISION, SLOT_DIMENSIONS, SLOT_PERIODIC};
    int count = 0;
    for (size_t s = 0; s < sizeof slots / sizeof *slots; s++)
        files[count++] = live->law[slots[s]] ? live->law[slots[s]]->kernel_file : none_file(slots[s]);
    files[count++] = "stage/scan.cl";
    files[count++] = "stage/table.cl";
    files[count++] = live->law[SLOT_WALLS] ? "stage/table_walls.cl" : "none/table_walls.cl";
    files[count++] = live->law[SLOT_BOND] ? "stage/table_bonds.cl" : "none/table_bonds.cl";
    if (live->blocks) {
        files[count++] = "stage/team.cl";
        files[count++] = "stage/table_phases.cl";
    }
    return count;
}

void live_table_constants(const live_laws *live, char *text, size_t size)
{
    const law *precision = live->law[SLOT_PRECISION];
    text[0] = '\0';
    if (precision)
        precision->constants(live->option[SLOT_PRECISION], text, size);
}

int live_constant_count(const live_laws *live)
{
    int count = 0;
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
        for (int p = 0; live->law[slot] && p < LAW_PARAMETERS_MAX && live->law[slot]->parameters[p]; p++)
            count++;
    return count > 0 ? count : 1;
}

int live_grain_constant_count(const live_laws *live)
{
    int count = 0;
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
        for (int p = 0; live->law[slot] && p < LAW_PARAMETERS_MAX && live->law[slot]->grain_parameters[p]; p++)
            count++;
    return count > 0 ? count : 1;
}

void live_grain_constants(const live_laws *live, const scene *scene, int stage, double *out)
{
    int width = live_grain_constant_count(live);
    memset(out, 0, sizeof *out * (size_t)(width * scene->material_count));
    for (int m = 0; m < scene->material_count; m++) {
        double *row = out + m * width;
        for (slot_id slot = 0; slot < SLOT_COUNT; slot++) {
            const law *l = live->law[slot];
            if (!l || !l->derive_grain)
                continue;
            l->derive_grain(scene, stage, m, live->option[slot], row);
            for (int n = 0; n < LAW_PARAMETERS_MAX && l->grain_parameters[n]; n++)
                row++;
        }
    }
}

/* Places of the constants of grains. */
static void grain_places(const live_laws *live, const scene *scene, char *text, size_t size)
{
    int place = 0;
    if (!live->law[SLOT_TEMPERATURE])
        return;
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
        for (int p = 0; live->law[slot] && p < LAW_PARAMETERS_MAX && live->law[slot]->grain_parameters[p]; p++) {
            size_t used = strlen(text);
            snprintf(text + used, size - used, "#define %s %d\n", live->law[slot]->grain_parameters[p], place++);
        }
    size_t used = strlen(text);
    snprintf(text + used, size - used, "#define GRAIN_CONSTANTS %d\n", live_grain_constant_count(live));
    used = strlen(text);
    if (live->law[SLOT_THERMAL_GROUPS])
        snprintf(text + used, size - used, "#define THERMAL_GROUPS %d\n", scene->group_count);
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
    snprintf(text + used, size - used, "#define LOOP_ITEMS %d\n", live->loop_items > 0 ? live->loop_items : 1);
    used = strlen(text);
    if (live->blocks)
        snprintf(text + used, size - used, "#define LANES %d\n#define PAIRS_ACT_APART %d\n", live->lanes > 0 ? live->lanes : 4,
                 acts_apart(live));
    used = strlen(text);
    snprintf(text + used, size - used, "#define CONTACT_CONSTANTS %d\n", live_constant_count(live));
    if (live->law[SLOT_COMPOSITION]) {
        used = strlen(text);
        snprintf(text + used, size - used, "#define PARTIES %d\n", scene->material_count + scene->wall_count);
    }
    grain_places(live, scene, text, size);
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
