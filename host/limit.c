/* The largest stable step, from the contacts that there are and from those to be expected (docs/theory.md, "The step"). */
#include "property.h"
#include "schedule.h"
#include "simulation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHUNK 256

/* Safety of the recommended step against the limit, and the share of a contact that it may take (TM sec. 4). Heat advances by Euler's method,
 * whose error is of the order of the step: stable alone is not enough (docs/accuracy.md, "Cooling by radiation and convection"). */
#define SAFETY 0.7
#define SHARE_OF_HEAT 0.1
#define SHARE_OF_CONTACT 0.1
/* The step that a look takes as recommended holds until the next: stiffness may not grow past its limit in between. */
#define SHARE_OF_STIFFNESS (-2.0 * log(SAFETY) / LIMIT_CHECK_STEPS)
/* Contacts through which a grain is expected to be heated at once. */
#define CONTACTS_EXPECTED 12.0

static status live_limit(simulation *sim, double *normal, double *turning, failure *why)
{
    clast_launch launch = launch_values(sim);
    launch.bonding = !sim->bonding_done; /* where contacts bond in one step of the run: it is to come */
    cl_kernel records = launch_kernel(sim, "limit_records"), grains = launch_kernel(sim, "limit_particles");
    contact_table *t = &sim->table;
    stored_field *torque = sim->live.law[SLOT_ROTATION] ? store_find(sim, "torque") : NULL;
    int64_t chunks = (sim->count + CHUNK - 1) / CHUNK;
    *normal = *turning = INFINITY;
    TRY(simulation_pose_now(sim, why));
    TRY(launch_pass(records, "limit_records", &launch, why));
    TRY(launch_run(sim, records, "limit_records", t->record_count, sim->block, why));
    TRY(observe_partial(sim, 2 * chunks + 5, why));
    TRY(launch_set(grains, "limit_particles", why, torque ? "Lmmmmmmm" : "Lmmmmmm", &launch, t->slot_offset[t->now], t->slots[t->now],
                   store_find(sim, "force")->mem, store_find(sim, "radius")->mem, store_find(sim, "mass")->mem, sim->partial,
                   torque ? torque->mem : NULL));
    TRY(launch_run(sim, grains, "limit_particles", chunks, 1, why));
    double *partial = malloc(sizeof *partial * (size_t)(2 * chunks + 1));
    if (!partial)
        return fail(why, STATUS_ERROR, "out of memory");
    status result = store_get(sim, sim->partial, FIELD_EXACT, 0, 2 * chunks, partial, why);
    for (int64_t c = 0; c < chunks && result == STATUS_OK; c++) {
        *normal = fmin(*normal, partial[2 * c]);
        *turning = fmin(*turning, partial[2 * c + 1]);
    }
    free(partial);
    return result;
}

/* Speed of the fastest wall or prescribed group now. */
static double prescribed_speed(const simulation *sim)
{
    double most = 0.0, span = 0.0;
    for (int c = 0; c < 3; c++)
        span += pow(sim->bed_high[c] - sim->bed_low[c] + 2.0 * sim->radius_max, 2);
    for (int b = 0; b < sim->scene->wall_count + sim->mover_count; b++) {
        const moving_body *body = b < sim->scene->wall_count ? &sim->wall_body[b] : &sim->group_body[b - sim->scene->wall_count];
        body_pose pose = moving_body_pose(body, sim->time);
        double v = sqrt(pow(pose.velocity[0], 2) + pow(pose.velocity[1], 2) + pow(pose.velocity[2], 2));
        double w = sqrt(pow(pose.spin[0], 2) + pow(pose.spin[1], 2) + pow(pose.spin[2], 2));
        most = fmax(most, v + w * sqrt(span));
    }
    most += servo_speed_max(sim);
    return most;
}

/* What the bed above presses on a grain: its layers times the weight of a mean grain. */
static double expected_weight(const simulation *sim)
{
    double g = sqrt(pow(sim->gravity[0], 2) + pow(sim->gravity[1], 2) + pow(sim->gravity[2], 2)), height = 0.0;
    for (int c = 0; c < 3 && g > 0.0; c++)
        height += fabs(sim->gravity[c]) / g * (sim->bed_high[c] - sim->bed_low[c]);
    return g * sim->mean_mass * fmax(1.0, height / (2.0 * sim->mean_radius));
}

typedef struct expected_contact {
    double overlap, normal, turning, duration, heat;
} expected_contact;

/* The smallest grain on a mean one, or on a wall: the smallest are the stiffest for their mass. */
static status expect_class(simulation *sim, int a, int party, double speed, double weight, expected_contact *out, failure *why)
{
    const scene *scene = sim->scene;
    int parties = scene->material_count + scene->wall_count;
    bool wall = party >= scene->material_count;
    double ri = sim->radius_min, rj = sim->mean_radius, result[5];
    double mi = 4.0 / 3.0 * M_PI * ri * ri * ri * scene_material(scene, a, &property_density);
    double mj = wall ? 0.0 : 4.0 / 3.0 * M_PI * rj * rj * rj * scene_material(scene, party, &property_density);
    cl_kernel kernel = launch_kernel(sim, "limit_expected");
    TRY(launch_set(kernel, "limit_expected", why, sim->mixed ? "mmiffffff" : "mmidddddd", sim->constants, sim->partial, (cl_int)(a * parties + party), ri, rj, mi, mj, speed, weight));
    TRY(launch_run(sim, kernel, "limit_expected", 1, 1, why));
    TRY(store_get(sim, sim->partial, FIELD_EXACT, 0, 5, result, why));
    double capacity = sim->live.law[SLOT_TEMPERATURE] ? mi * scene_material(scene, a, &property_specific_heat) : 0.0;
    *out = (expected_contact){result[0], result[1], result[2], result[3], result[4] > 0.0 ? capacity / (CONTACTS_EXPECTED * result[4]) : INFINITY};
    return STATUS_OK;
}

static void note(step_limit *out, double limit, const char *what)
{
    if (limit >= 1e29)
        limit = INFINITY;
    if (limit < out->limit_s) {
        out->limit_s = limit;
        snprintf(out->binds, sizeof out->binds, "%s", what);
    }
}

/* Fastest approach of two grains (twice the fastest: they may meet head on) and of a grain and a wall; at least what gravity gives over a
 * radius, or one radius a second. */
static status approach_speed(simulation *sim, double *grains, double *walls, failure *why)
{
    particle_sums sums;
    TRY(observe_stored_sums(sim, &sums, why));
    double g = sqrt(pow(sim->gravity[0], 2) + pow(sim->gravity[1], 2) + pow(sim->gravity[2], 2));
    double fastest = sums.speed_max, drift = 0.0;
    if (sim->scene->wall_count == 0 && sim->mover_count == 0 && sums.mass > 0.0) {
        for (int c = 0; c < 3; c++)
            drift += pow(sums.momentum[c] / sums.mass, 2);
        fastest = sqrt(fmax(0.0, 2.0 * sums.kinetic / sums.mass - drift)) * sqrt((double)sim->count);
        fastest = fmin(fastest, sums.speed_max + sqrt(drift));
    }
    double least = g > 0.0 ? sqrt(2.0 * g * sim->radius_min) : sim->radius_min;
    *grains = fmax(2.0 * fastest, least);
    *walls = fmax(fastest + prescribed_speed(sim), least);
    return STATUS_OK;
}

static status note_heat(simulation *sim, step_limit *out, failure *why)
{
    TRY(heat_limit_find(sim, &out->heat, why));
    double every = sim->live.law[SLOT_HEAT_STEPS] ? (double)sim->scene->stage[sim->stage].heat_every : 1.0;
    note(out, out->heat.conduction / every, "conduction of heat");
    note(out, out->heat.convection / every, "convection");
    note(out, out->heat.radiation / every, "radiation");
    note(out, out->heat.all / every, "conduction, convection and radiation together");
    return STATUS_OK;
}

/* Largest rates of change of the logarithm of a grain's modulus, 1/s, and of a radius, m/s. */
static status stiffness_rates(simulation *sim, double *modulus, double *radial, failure *why)
{
    int64_t chunks = (sim->count + CHUNK - 1) / CHUNK;
    cl_kernel kernel = launch_kernel(sim, "stiffness_rate");
    *modulus = *radial = 0.0;
    TRY(observe_flows(sim, why));
    clast_launch launch = launch_values(sim);
    TRY(observe_partial(sim, 2 * chunks, why));
    TRY(launch_set(kernel, "stiffness_rate", why, "Lm", &launch, sim->partial));
    TRY(launch_bind(sim, "stiffness_rate", 2, why));
    TRY(launch_run(sim, kernel, "stiffness_rate", chunks, 1, why));
    double *partial = malloc(sizeof *partial * (size_t)(2 * chunks + 1));
    if (!partial)
        return fail(why, STATUS_ERROR, "out of memory");
    status result = store_get(sim, sim->partial, FIELD_EXACT, 0, 2 * chunks, partial, why);
    for (int64_t c = 0; c < chunks && result == STATUS_OK; c++) {
        *modulus = fmax(*modulus, partial[2 * c]);
        *radial = fmax(*radial, partial[2 * c + 1]);
    }
    free(partial);
    return result;
}

/* A contact of stiffness k goes as E sqrt(d): d ln k/dt is that of the modulus and half of that of the overlap, which two growing radii raise. The
 * overlap is that at which the other limits stand: of the contacts to be expected, or of the deepest there is. */
static status note_stiffness(simulation *sim, step_limit *out, double overlap, failure *why)
{
    double modulus, radial;
    contact_sums contacts;
    if (!live_changes_stiffness(&sim->live))
        return STATUS_OK;
    TRY(stiffness_rates(sim, &modulus, &radial, why));
    if (radial > 0.0) {
        TRY(observe_contact_sums(sim, &contacts, why));
        overlap = fmax(overlap, contacts.overlap_max * sim->radius_min);
    }
    double rate = modulus + (radial > 0.0 ? radial / overlap : 0.0);
    out->heat.stiffness = rate > 0.0 ? 1.0 / rate : INFINITY;
    note(out, out->heat.stiffness, "change of stiffness by heat");
    out->recommended_s = fmin(out->recommended_s, SHARE_OF_STIFFNESS * out->heat.stiffness);
    return STATUS_OK;
}

/* A drag of rate c is a damper on top of all others: where w^2 dt^2 + b dt <= 4 bounded the step, w^2 dt^2 + (b + 2 c) dt <= 4 does, and
 * 1/(1/dt + c/2) is within that. An integrator that extrapolates what a damper is given counts it twice. */
static void note_drag(const simulation *sim, step_limit *out)
{
    const law *law = sim->live.law[SLOT_BODY];
    const effect *effect = scene_effect(sim->scene, sim->stage, SLOT_BODY);
    if (!law || !law->drag_rate || !effect)
        return;
    double rate = law->drag_rate(effect->option) * (live_keeps_half_steps(&sim->live) ? 2.0 : 1.0);
    double moving = fmin(out->live_s, out->expected_s);
    if (rate > 0.0)
        note(out, 1.0 / (1.0 / moving + 0.5 * rate), "background drag");
}

/* All grains are held where they are and no wall moves: no contact can push anything, and none comes. Heat alone bounds the step. */
static bool nothing_can_move(const simulation *sim)
{
    bool held = sim->mover_count > 0 && !sim->walls_move && !sim->groups_move;
    for (int g = 0; held && g < sim->mover_count; g++)
        held = sim->group_held[g];
    return held;
}

status limit_find(simulation *sim, step_limit *out, failure *why)
{
    *out = (step_limit){.limit_s = INFINITY, .recommended_s = INFINITY, .live_s = INFINITY, .expected_s = INFINITY};
    snprintf(out->binds, sizeof out->binds, "nothing");
    bool moves = !nothing_can_move(sim);
    TRY(note_heat(sim, out, why));
    if (moves)
        note_drag(sim, out);
    double for_heat = SHARE_OF_HEAT * out->limit_s;
    out->recommended_s = for_heat;
    if (!sim->live.law[SLOT_NORMAL] || sim->count == 0 || !moves)
        return STATUS_OK;
    double normal, turning, speed, wall_speed, weight = expected_weight(sim);
    TRY(live_limit(sim, &normal, &turning, why));
    out->live_s = fmin(normal, turning) < 1e29 ? fmin(normal, turning) : INFINITY;
    note(out, normal, "normal, contacts as they are");
    note(out, turning, "all modes together, contacts as they are");
    TRY(approach_speed(sim, &speed, &wall_speed, why));
    double shortest = INFINITY, shallowest = INFINITY;
    for (int a = 0; a < sim->scene->material_count; a++)
        for (int p = 0; p < sim->scene->material_count + sim->scene->wall_count; p++) {
            expected_contact e;
            if (p < sim->scene->material_count && sim->count < 2)
                continue;
            TRY(expect_class(sim, a, p, p < sim->scene->material_count ? speed : wall_speed, weight, &e, why));
            out->expected_s = fmin(out->expected_s, fmin(e.normal, e.turning));
            shallowest = fmin(shallowest, e.overlap);
            note(out, e.normal, "normal, contact to be expected");
            note(out, e.turning, "tangential and rolling, contact to be expected");
            note(out, e.heat, "conduction of heat, contacts to be expected");
            if (e.duration > 0.0)
                shortest = fmin(shortest, e.duration);
        }
    out->contact_s = isfinite(shortest) ? shortest : 0.0;
    note_drag(sim, out);
    out->recommended_s = fmin(SAFETY * out->limit_s, for_heat);
    if (SHARE_OF_CONTACT * shortest < out->recommended_s)
        out->recommended_s = SHARE_OF_CONTACT * shortest;
    return note_stiffness(sim, out, shallowest, why);
}
