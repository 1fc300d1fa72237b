#include "run.h"

#include "bed.h"
#include "frozen.h"
#include "scene.h"
#include "simulation.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STEPS 600
#define LOOK  100
#define FROZEN_STEPS 50 /* some methods take long ways to the end: the beginning will do */

typedef struct fuzz_case {
    device *on;
    scene *scene;
    bed bed;
    simulation *sim;
    double energy, momentum[3], impulse, low, high; /* of the start */
    bool keeps_energy, keeps_momentum, keeps_range;
} fuzz_case;

static void broken(outcome *o, const char *what, const char *format, ...) __attribute__((format(printf, 3, 4)));
static void broken(outcome *o, const char *what, const char *format, ...)
{
    va_list values;
    if (o->verdict == BROKEN)
        return;
    va_start(values, format);
    o->verdict = BROKEN;
    snprintf(o->what, sizeof o->what, "%s", what);
    vsnprintf(o->text, sizeof o->text, format, values);
    va_end(values);
}

static bool free_motion(const scene *s)
{
    for (int g = 0; g < s->group_count; g++)
        if (s->group[g].fixed || s->group[g].motion.count > 0)
            return false;
    for (int w = 0; w < s->wall_count; w++)
        if (scene_wall_moves(s, w))
            return false;
    return !scene_has_servo(s);
}

static void what_holds(fuzz_case *c)
{
    const law *const *live = c->sim->all.law;
    bool passive = free_motion(c->scene) && !c->scene->domain.delete_leaving;
    bool falls_around = false; /* what leaves below comes in above with more of it */
    for (int d = 0; d < 3; d++)
        falls_around = falls_around || (c->scene->domain.periodic[d] && c->scene->gravity_m_s2[d] != 0.0);
    c->keeps_energy = passive && !falls_around && !live[SLOT_BOND] && !live[SLOT_COHESION] && !live[SLOT_MODULUS] && !live[SLOT_RADIUS];
    c->keeps_momentum = passive && c->scene->wall_count == 0 && !live[SLOT_BODY];
    c->keeps_range = live[SLOT_TEMPERATURE] && !live[SLOT_SOURCE] && !live[SLOT_HEAT_GENERATION] && !live[SLOT_DISSIPATION_HEAT] &&
                     live[SLOT_WALL_HEAT] == NULL && !live[SLOT_THERMAL_GROUPS] && !live[SLOT_RADIUS];
}

static status energy_of(fuzz_case *c, double *out, particle_sums *sums, failure *why)
{
    contact_sums contacts = {0};
    TRY(observe_particle_sums(c->sim, sums, why));
    if (c->sim->live.law[SLOT_NORMAL])
        TRY(observe_contact_sums(c->sim, &contacts, why));
    *out = sums->kinetic + sums->rotational + sums->gravitational + contacts.elastic;
    return STATUS_OK;
}

static status begin(fuzz_case *c, failure *why)
{
    particle_sums sums;
    heat_sums heat;
    what_holds(c);
    TRY(energy_of(c, &c->energy, &sums, why));
    memcpy(c->momentum, sums.momentum, sizeof c->momentum);
    c->impulse = sqrt(2.0 * sums.mass * sums.kinetic) + 1e-30;
    if (c->sim->all.law[SLOT_TEMPERATURE]) {
        TRY(heat_observe(c->sim, &heat, why));
        double around = quantity_at(&c->scene->environment.temperature_k, 0.0);
        c->low = fmin(heat.lowest, isnan(around) ? INFINITY : around);
        c->high = fmax(heat.highest, isnan(around) ? -INFINITY : around);
    }
    return STATUS_OK;
}

static status look(fuzz_case *c, outcome *o, failure *why)
{
    double energy, g = sqrt(pow(c->sim->gravity[0], 2) + pow(c->sim->gravity[1], 2) + pow(c->sim->gravity[2], 2));
    particle_sums sums;
    guard_finding found;
    found.stop = false;
    if (!c->sim->live.frozen)
        TRY(guard_check(c->sim, &found, why));
    if (found.stop) {
        o->verdict = STOPPED;
        snprintf(o->text, sizeof o->text, "%.1000s", found.text);
        if (strstr(found.text, "not a number"))
            broken(o, "numbers", "%.1000s", found.text);
        return STATUS_OK;
    }
    TRY(energy_of(c, &energy, &sums, why));
    double eps = c->sim->mixed ? 1e-5 : 1e-9;
    if (!isfinite(energy))
        broken(o, "numbers", "the energy is not a number at step %lld", (long long)c->sim->step);
    /* collisions may be sampled as coarsely as ten steps each: what a contact stores then is out by some per cent of what moves */
    double moving = sums.kinetic + sums.rotational + g * sums.weight_radius;
    if (c->keeps_energy && c->sim->stage == 0 && energy > c->energy + 0.3 * fmax(moving, fabs(c->energy)) + eps)
        broken(o, "energy", "energy has risen from %.6g to %.6g J at step %lld (%.3g of it in motion)", c->energy, energy,
               (long long)c->sim->step, moving);
    for (int k = 0; k < 3 && c->keeps_momentum && c->sim->stage == 0; k++) {
        double expected = c->momentum[k] + sums.mass * c->sim->gravity[k] * c->sim->time;
        double scale = c->impulse + sums.mass * g * c->sim->time + sqrt(2.0 * sums.mass * sums.kinetic);
        if (fabs(sums.momentum[k] - expected) > (c->sim->mixed ? 1e-4 : 1e-10) * scale)
            broken(o, "momentum", "momentum %d is %.9g, not %.9g, at step %lld", k, sums.momentum[k], expected, (long long)c->sim->step);
    }
    if (!c->sim->all.law[SLOT_TEMPERATURE] || c->sim->count == 0)
        return STATUS_OK;
    heat_sums heat;
    TRY(heat_observe(c->sim, &heat, why));
    if (!isfinite(heat.mean) || !(heat.lowest > 0.0))
        broken(o, "temperatures", "temperatures run from %.6g to %.6g K at step %lld", heat.lowest, heat.highest, (long long)c->sim->step);
    double slack = eps * c->high + (c->sim->stage ? 1e-4 * (c->high - c->low) : 0.0); /* frozen stages are exact to their tolerance */
    if (c->keeps_range && (heat.lowest < c->low - slack || heat.highest > c->high + slack))
        broken(o, "temperatures", "temperatures run from %.9g to %.9g K at step %lld, and began between %.9g and %.9g", heat.lowest,
               heat.highest, (long long)c->sim->step, c->low, c->high);
    return STATUS_OK;
}

static status advance(simulation *sim, int64_t steps, failure *why)
{
    step_limit limit;
    for (int64_t done = 0; done < steps; done += LOOK) {
        TRY(limit_find(sim, &limit, why));
        simulation_set_step(sim, isfinite(limit.recommended_s) ? limit.recommended_s : 1e-5);
        TRY(simulation_advance(sim, LOOK < steps - done ? LOOK : steps - done, why));
    }
    return STATUS_OK;
}

static bool same_bits(simulation *a, simulation *b, const char *field, failure *why, status *result)
{
    double *x = NULL, *y = NULL;
    bool same = true;
    if (!store_find(a, field))
        return true;
    *result = observe_field(a, field, &x, why);
    if (*result == STATUS_OK)
        *result = observe_field(b, field, &y, why);
    if (*result == STATUS_OK)
        same = memcmp(x, y, sizeof *x * (size_t)a->id_count * (size_t)store_find(a, field)->field->components) == 0;
    free(x);
    free(y);
    return same;
}

/* A run that goes on from a saved state is the run that went on. */
static status resumes(fuzz_case *c, outcome *o, failure *why)
{
    static const char *const fields[] = {"position", "velocity", "spin", "temperature", "radius"};
    simulation *again = NULL;
    bundle state;
    bundle_init(&state);
    status result = state_save(c->sim, &state, why);
    if (result == STATUS_OK)
        result = simulation_create(c->scene, &c->bed, c->on, NULL, &again, why);
    if (result == STATUS_OK)
        result = state_load(again, &state, "saved state", why);
    if (result == STATUS_OK)
        result = simulation_advance(c->sim, LOOK, why);
    if (result == STATUS_OK)
        result = simulation_advance(again, LOOK, why);
    for (int f = 0; f < 5 && result == STATUS_OK; f++)
        if (!same_bits(c->sim, again, fields[f], why, &result) && result == STATUS_OK)
            broken(o, "resume", "the %s of a run that goes on from a saved state differs", fields[f]);
    simulation_free(again);
    bundle_free(&state);
    return result;
}

static status run_frozen(fuzz_case *c, const scene_stage *stage, failure *why)
{
    double end = c->sim->time + stage->until_time_s;
    for (int k = 0; k < FROZEN_STEPS && c->sim->time < end; k++)
        TRY(frozen_advance(c->sim, end, 1, why));
    return STATUS_OK;
}

static status run_stages(fuzz_case *c, outcome *o, failure *why)
{
    for (int s = 0; s < c->scene->stage_count && o->verdict == KEPT; s++) {
        const scene_stage *stage = &c->scene->stage[s];
        TRY(simulation_begin_stage(c->sim, s, why));
        if (s == 0)
            TRY(begin(c, why));
        if (stage->frozen) {
            TRY(run_frozen(c, stage, why));
            TRY(look(c, o, why));
            continue;
        }
        TRY(guard_walls(c->sim, why));
        int64_t steps = stage->until_steps > 0 ? stage->until_steps : STEPS;
        for (int64_t done = 0; done < steps && o->verdict == KEPT; done += 2 * LOOK) {
            TRY(advance(c->sim, 2 * LOOK, why));
            TRY(look(c, o, why));
        }
        if (o->verdict == KEPT)
            TRY(resumes(c, o, why));
    }
    return STATUS_OK;
}

outcome run_text(device *on, const char *text, const char *name)
{
    fuzz_case c = {.on = on};
    outcome o = {.verdict = KEPT};
    failure why = {""};
    bool generated = false;
    status result = scene_read_text(text, name, 0, NULL, &c.scene, &why);
    if (result == STATUS_OK) {
        result = bed_generate(c.scene, &c.bed, &why);
        generated = result == STATUS_OK;
    }
    if (result == STATUS_OK)
        result = simulation_create(c.scene, &c.bed, on, NULL, &c.sim, &why);
    if (result == STATUS_OK) {
        memcpy(o.law, c.sim->all.law, sizeof o.law);
        result = run_stages(&c, &o, &why);
    }
    if (result != STATUS_OK && o.verdict != BROKEN) {
        o.verdict = result == STATUS_BAD_INPUT ? REFUSED : STOPPED;
        snprintf(o.text, sizeof o.text, "%.1000s", why.text);
        if (!why.text[0] || (result != STATUS_BAD_INPUT && result != STATUS_GUARD))
            broken(&o, "message", "ends with status %d and says: %.900s", result, why.text);
        if (result != STATUS_OK && strstr(why.text, "nan"))
            broken(&o, "message", "speaks of what is not a number: %.900s", why.text);
    }
    simulation_free(c.sim);
    if (generated)
        bed_free(&c.bed);
    scene_free(c.scene);
    return o;
}
