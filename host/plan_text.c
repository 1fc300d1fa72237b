/* The plan for a person at the terminal. */
#include "frozen.h"
#include "plan_data.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *plural(int64_t count)
{
    return count == 1 ? "" : "s";
}

static const char *stage_label(const plan *p, int s, char *text, size_t size)
{
    const char *name = p->stage[s].stage->name;
    if (name)
        snprintf(text, size, "%s", name);
    else
        snprintf(text, size, "stage %d", s + 1);
    return text;
}

static void print_seconds(char *text, size_t size, double seconds)
{
    if (isfinite(seconds))
        snprintf(text, size, "%.4g s", seconds);
    else
        snprintf(text, size, "none");
}

static void print_particles(const plan *p)
{
    printf("\nParticles: %lld\n", (long long)p->particles);
    for (int g = 0; g < p->group_count; g++) {
        const plan_group *group = &p->group[g];
        printf("  %-16s %lld of %s", group->group->name ? group->group->name : "", (long long)group->count,
               p->scene->material[group->group->material].name);
        if (group->count > 0 && group->radius_min < group->radius_max)
            printf(", radius %.4g to %.4g m", group->radius_min, group->radius_max);
        else if (group->count > 0)
            printf(", radius %.4g m", group->radius_max);
        printf("%s\n", group->group->fixed ? ", fixed" : group->group->motion.count > 0 ? ", moved as prescribed" : "");
    }
    if (p->overlap_max > 0.0)
        printf("  largest overlap at the start: %.3g of the smaller radius, between grains %lld and %lld\n", p->overlap_max,
               (long long)p->overlap_i, (long long)p->overlap_j);
}

static void print_servo(const servo_choice *servo)
{
    if (!servo->given)
        return;
    const servo_spec *s = &servo->spec;
    printf(", keeps %.6g %s along [%.3g, %.3g, %.3g] at %.3g m/s at most", isnan(s->force_n) ? s->pressure_pa : s->force_n,
           isnan(s->force_n) ? "Pa" : "N", s->direction[0], s->direction[1], s->direction[2], s->speed_max_m_s);
}

static void print_walls(const plan *p)
{
    static const char *const shape[] = {"plane", "box", "rectangle", "disc", "cylinder", "cone"};
    const scene *scene = p->scene;
    if (scene->wall_count > 0)
        printf("\nWalls\n");
    for (int g = 0; g < scene->wall_group_count; g++) {
        printf("  group %-10s%s", scene->wall_group[g].name, scene->wall_group[g].motion.count > 0 ? " moves as prescribed" : "");
        print_servo(&scene->wall_group[g].servo);
        printf("\n");
    }
    for (int w = 0; w < scene->wall_count; w++) {
        const wall *wall = &scene->wall[w];
        bool round = wall->shape == WALL_CYLINDER || wall->shape == WALL_CONE;
        printf("  %-16s %s%s", wall->name, shape[wall->shape], !round ? "" : wall->outside ? ", from outside" : ", from inside");
        if (wall->group >= 0)
            printf(", of the group %s", scene->wall_group[wall->group].name);
        if (wall->motion.count > 0)
            printf(", moves as prescribed");
        print_servo(&wall->servo);
        printf("\n");
    }
}

static bool slot_is_live(const plan *p, slot_id slot)
{
    for (int s = 0; s < p->stage_count; s++)
        if (p->stage[s].live.law[slot])
            return true;
    return false;
}

#define BIOT_LARGE 0.1

static void print_unused(const plan *p)
{
    if (p->unused[0])
        printf("\nGiven, but nothing in this scene uses it\n");
    for (int k = 0; p->unused[k]; k++)
        printf("  %s\n", p->unused[k]);
}

static void print_biot(const plan *p)
{
    double most = 0.0;
    if (!p->biot_contact)
        return;
    printf("\nBiot numbers (grains count as isothermal; small is good)\n");
    for (int m = 0; m < p->scene->material_count; m++) {
        printf("  %-16s", p->scene->material[m].name);
        if (p->biot_contact[m] > 0.0)
            printf("contacts %.3g", p->biot_contact[m]);
        else
            printf("contacts none yet");
        if (p->biot_surface[m] > 0.0)
            printf(", surface %.3g", p->biot_surface[m]);
        printf("\n");
        most = fmax(most, fmax(p->biot_contact[m], p->biot_surface[m]));
    }
    if (most > BIOT_LARGE)
        printf("  WARNING: above %g a grain is not isothermal, and temperatures here are those of its mean at best\n", BIOT_LARGE);
}

/* One row a slot, one column a stage; the last column is not padded. */
static void print_laws(const plan *p)
{
    char label[64];
    printf("\n%-18s", "Live laws");
    for (int s = 0; s < p->stage_count; s++)
        printf("%-*s", s + 1 < p->stage_count ? 20 : 0, stage_label(p, s, label, sizeof label));
    printf("\n");
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++) {
        if (!slot_is_live(p, slot))
            continue;
        printf("  %-16s", slot_name(slot));
        for (int s = 0; s < p->stage_count; s++) {
            const law *l = p->stage[s].live.law[slot];
            printf("%-*s", s + 1 < p->stage_count ? 20 : 0, l ? l->name : "-");
        }
        printf("\n");
    }
}

static void print_bonds(const plan *p)
{
    if (p->bond_count > 0)
        printf("\nBonds, between grains of mean size\n");
    for (int k = 0; k < p->bond_count; k++) {
        const bond_figures *f = &p->bond[k];
        printf("  %s and %s%s: equilibrium overlap %.5g m, critical overlap %.5g m, pull-off force %.5g N\n", f->a, f->wall ? "the wall " : "", f->b,
               f->equilibrium, f->critical, f->pull_off);
        printf("    critical velocity %.7g m/s (BM Eq. 21)", f->velocity);
        if (f->sticks_from > f->velocity)
            printf(", %.5g m/s with the damping of the contact", f->sticks_from);
        if (isinf(f->breaks_from))
            printf("; no impact below a thousand times that breaks a fresh bond\n");
        else if (f->breaks_from <= f->sticks_from)
            printf("; without damping every fresh bond breaks again\n");
        else
            printf("; from %.5g m/s a fresh bond breaks again\n", f->breaks_from);
    }
}

static void print_end(const plan_stage *s)
{
    const scene_stage *stage = s->stage;
    bool rest = !isnan(stage->until_rest) || !isnan(stage->until_rest_j);
    const char * or = "";
    printf("    ends ");
    if (!isnan(stage->until_time_s)) {
        printf("after %.6g s", stage->until_time_s);
        or = " or ";
    }
    if (stage->until_steps >= 0) {
        printf("%safter %lld steps", or, (long long)stage->until_steps);
        or = " or ";
    }
    if (rest)
        printf("%sat rest", or);
    if (!isnan(stage->until_steady_k_s))
        printf("%swhen no temperature changes faster than %.4g K/s", !isnan(stage->until_time_s) || stage->until_steps >= 0 || rest ? " or " : "", stage->until_steady_k_s);
    if (!isnan(s->steps))
        printf(": %.4g steps%s", s->steps, rest ? " at most" : "");
    printf("\n");
    if (stage->repeat_from && isnan(stage->repeat_change))
        printf("    then again from `%s`: %lld rounds\n", stage->repeat_from, (long long)stage->repeat_rounds);
    else if (stage->repeat_from)
        printf("    then again from `%s`, until temperatures change by less than %.3g of their range from round to round; %lld rounds at most\n",
               stage->repeat_from, stage->repeat_change, (long long)stage->repeat_rounds);
}

/* Nothing moves: the method chooses its steps. */
static void print_frozen(const plan *p, int s)
{
    char label[64], limit[32];
    const plan_stage *stage = &p->stage[s];
    print_seconds(limit, sizeof limit, stage->limit.limit_s);
    printf("  %-16s motion is frozen; heat by the %s method, tolerance %.3g of the range of temperatures a step\n", stage_label(p, s, label, sizeof label),
           frozen_method_name(stage->stage->heat_method), stage->stage->heat_tolerance);
    printf("    limit of Euler's method %s\n", limit);
    print_end(stage);
}

static void print_steps(const plan *p)
{
    char label[64], limit[32], recommended[32], step[32];
    printf("\nTime steps, for the particles as they are at the start\n");
    for (int s = 0; s < p->stage_count; s++) {
        const plan_stage *stage = &p->stage[s];
        if (stage->stage->frozen) {
            print_frozen(p, s);
            continue;
        }
        print_seconds(limit, sizeof limit, stage->limit.limit_s);
        print_seconds(recommended, sizeof recommended, stage->limit.recommended_s);
        print_seconds(step, sizeof step, stage->step_s);
        printf("  %-16s limit %s, recommended %s", stage_label(p, s, label, sizeof label), limit, recommended);
        if (stage->limit.binds[0] && isfinite(stage->limit.limit_s))
            printf(", bound by: %s", stage->limit.binds);
        printf("\n    takes %s%s\n", step, isnan(stage->stage->step_s) ? " (auto)" : "");
        print_end(stage);
        if (stage->step_s > stage->limit.limit_s)
            printf("    ABOVE THE LIMIT: %s\n",
                   stage->stage->allow_unstable_step ? "allowed by `allow_unstable_step`" : "a run refuses it");
        else if (stage->step_s > stage->limit.recommended_s * (1.0 + 1e-9))
            printf("    above the recommended step: contacts are resolved more coarsely\n");
    }
}

static void print_row(const plan *p, const char *name, const char *note, uint64_t bytes)
{
    char total[32];
    device_bytes(bytes, total, sizeof total);
    printf("  %-22s%-11s%13.1f%12s\n", name, note, plan_bytes_per_particle(p, bytes), total);
}

static void print_memory(const plan *p)
{
    static const char *const per[] = {
        [PER_PARTICLE] = "per grain", [PER_RECORD] = "per contact", [PER_RECORD_BLOCK] = "per block", [PER_SCENE] = "per scene"};
    char usable[32];
    device_bytes(p->device->usable_bytes, usable, sizeof usable);
    printf("\n%-35s%13s%12s\n", "Memory", "bytes a grain", "total");
    for (int f = 0; f < p->field_count; f++)
        print_row(p, p->field[f].name, per[p->field[f].per], p->field[f].bytes);
    print_row(p, "contact table", "", p->table_bytes);
    print_row(p, "other", "", p->other_bytes);
    print_row(p, "all", "", p->bytes);
    if (p->packed_bytes > p->bytes)
        print_row(p, "all, packed densely", "", p->packed_bytes);
    printf("  of %s that %s\n", usable, p->device->cpu ? "the host has available for this device" : "the device has");
    printf("  skin of the contact table: %.4g m\n", p->skin_m);
}

static void print_arguments(const plan *p, const plan_arguments *arguments)
{
    printf("  %s: launch, control", arguments->kernel);
    int column = 0;
    for (int k = 0; k < arguments->count; k++) {
        column += (int)strlen(arguments->name[k]) + 2;
        printf(",%s%s", column > 90 ? "\n    " : " ", arguments->name[k]);
        column = column > 90 ? 0 : column;
    }
    printf("\n    %d arguments, %llu of %llu bytes\n", arguments->count + 2, (unsigned long long)arguments->bytes,
           (unsigned long long)p->device->argument_bytes);
}

static void print_probe(const plan *p)
{
    const plan_probe *probe = &p->probe;
    printf("\nSpeed\n  %.3g million particle-steps a second over %lld step%s\n", 1e-6 * probe->particle_steps_per_s,
           (long long)probe->steps, plural(probe->steps));
    if (isnan(probe->expected_wall_s))
        printf("  how long the run takes depends on when it comes to rest\n");
    else
        printf("  the whole run: about %.3g s%s, output not counted\n", probe->expected_wall_s,
               probe->expected_wall_s > 3600.0 ? " (more than an hour)" : "");
}

void plan_write_text(const plan *p)
{
    char device[1024];
    device_describe(p->device, device, sizeof device);
    printf("%s\n  scene: %s, %d dimensions, %s precision\n  device: %s\n", p->scene->title ? p->scene->title : "Untitled",
           p->scene->path, p->scene->dimensions, precision_name(p->scene), device);
    print_particles(p);
    print_walls(p);
    print_laws(p);
    print_bonds(p);
    print_unused(p);
    print_biot(p);
    print_steps(p);
    print_memory(p);
    printf("\nKernel arguments\n");
    print_arguments(p, &p->pair);
    print_arguments(p, &p->particle);
    if (p->probe.done)
        print_probe(p);
}
