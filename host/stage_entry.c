/* What changes when a stage begins: laws, motions, constants, and the histories of what is switched off. */
#include "simulation.h"

#include "frozen.h"
#include "laws/fields.h"

#include <stdlib.h>
#include <string.h>

/* Grains that a group holds or moves, and the velocities that they have from now on. */
static void set_movers(const simulation *sim, int32_t *id, const double (*x)[3], double (*v)[3])
{
    for (int64_t i = 0; i < sim->stride; i++) {
        int group = i < sim->count ? sim->group_of_id[id[i]] : -1;
        id[i] = group >= 0 && sim->group_held[group] ? group : -1;
        if (id[i] < 0)
            continue;
        body_pose pose = moving_body_pose(&sim->group_body[group], sim->time);
        double arm[3];
        for (int c = 0; c < 3; c++)
            arm[c] = x[i][c] - pose.pivot[c];
        for (int c = 0; c < 3; c++)
            v[i][c] = pose.velocity[c] + pose.spin[(c + 1) % 3] * arm[(c + 2) % 3] - pose.spin[(c + 2) % 3] * arm[(c + 1) % 3];
    }
}

static status upload_movers(simulation *sim, failure *why)
{
    stored_field *mover = store_find(sim, "mover");
    if (!mover)
        return STATUS_OK;
    uint64_t n = (uint64_t)sim->stride;
    stored_field *position = store_find(sim, "position"), *velocity = store_find(sim, "velocity");
    int32_t *id = malloc(n * sizeof *id);
    double(*x)[3] = malloc(n * sizeof *x), (*v)[3] = malloc(n * sizeof *v);
    status result = id && x && v ? store_read(sim, store_find(sim, "id")->mem, 0, 4 * n, id, why)
                                 : fail(why, STATUS_ERROR, "out of memory");
    if (result == STATUS_OK)
        result = store_get_grains(sim, position, sim->stride, &x[0][0], why);
    if (result == STATUS_OK)
        result = store_get_grains(sim, velocity, sim->stride, &v[0][0], why);
    if (result == STATUS_OK) {
        set_movers(sim, id, (const double(*)[3])x, v);
        result = store_write(sim, mover->mem, 0, 4 * n, id, why);
    }
    if (result == STATUS_OK)
        result = store_put_grains(sim, velocity, sim->stride, &v[0][0], why);
    free(id);
    free(x);
    free(v);
    return result;
}

static void change_bodies(simulation *sim, const scene_stage *stage)
{
    for (int c = 0; c < stage->wall_change_count; c++)
        if (stage->wall_change[c].motion_given)
            moving_body_change(&sim->wall_body[stage->wall_change[c].wall], &stage->wall_change[c].motion, sim->time);
    for (int c = 0; c < stage->wall_group_change_count; c++)
        for (int w = 0; stage->wall_group_change[c].motion_given && w < sim->scene->wall_count; w++)
            if (sim->scene->wall[w].group == stage->wall_group_change[c].group)
                moving_body_change(&sim->wall_body[w], &stage->wall_group_change[c].motion, sim->time);
    servo_change(sim, stage, false);
    for (int c = 0; c < stage->group_change_count; c++) {
        const group_change *change = &stage->group_change[c];
        moving_body_change(&sim->group_body[change->group], &change->motion, sim->time);
        sim->group_held[change->group] = !change->free;
    }
}

static void note_movers(simulation *sim)
{
    sim->groups_move = false;
    sim->walls_move = servo_live(sim);
    for (int w = 0; w < sim->scene->wall_count; w++)
        sim->walls_move = sim->walls_move || moving_body_moves(&sim->wall_body[w]);
    for (int g = 0; g < sim->mover_count; g++)
        sim->groups_move = sim->groups_move || moving_body_moves(&sim->group_body[g]);
    sim->heat.vary = heat_varies(sim);
    sim->batch_rows = 0;
}

/* History of laws that the stage switches off is gone. */
static status forget_histories(simulation *sim, failure *why)
{
    for (int f = 0; f < sim->field_count; f++) {
        const field *field = sim->field[f].field;
        if (field->role == FIELD_HISTORY && !live_uses(&sim->live, field))
            TRY(store_fill(sim, sim->field[f].mem, sim->table.record_stride > 0 ? field_bytes(sim, field) : 0, why));
    }
    return STATUS_OK;
}

static status upload_constants(simulation *sim, int stage, failure *why)
{
    int64_t count = (int64_t)live_constant_count(&sim->live) * live_class_count(&sim->live, sim->scene);
    double *constants = malloc(sizeof *constants * (size_t)count);
    if (!constants)
        return fail(why, STATUS_ERROR, "out of memory");
    live_class_constants(&sim->live, sim->scene, stage, constants);
    status result = store_put(sim, sim->constants, FIELD_REAL, 0, count, constants, why);
    free(constants);
    return result;
}

status simulation_enter_stage(simulation *sim, int stage, failure *why)
{
    const live_laws before = sim->live;
    live_laws_in_stage(sim->scene, &sim->all, stage, &sim->live);
    bool same = sim->program && memcmp(before.law, sim->live.law, sizeof before.law) == 0 && before.frozen == sim->live.frozen;
    sim->stage = stage;
    scene_gravity(sim->scene, stage, sim->gravity);
    if (!sim->live.law[SLOT_BOND])
        TRY(bonds_before(sim, why)); /* they are forgotten */
    if (!same) {
        launch_close(sim);
        TRY(launch_open(sim, why));
        form_trials_forget(&sim->loop.trials);
    }
    TRY(forget_histories(sim, why));
    TRY(servo_enter(sim, why));
    note_movers(sim);
    TRY(upload_constants(sim, stage, why));
    TRY(heat_upload_constants(sim, stage, why));
    frozen_forget(sim);
    TRY(simulation_pose_now(sim, why));
    return table_build(sim, false, why);
}

/* Half-step velocities start anew where laws, gravity or motions change: from the velocities of this moment, under the laws that led to it. */
static status end_half_steps(simulation *sim, failure *why)
{
    if (sim->stage < 0 || !live_keeps_half_steps(&sim->live))
        return STATUS_OK;
    return observe_end_half_steps(sim, why);
}

static status begin_half_steps(simulation *sim, failure *why)
{
    sim->lag = 0.0;
    if (!live_keeps_half_steps(&sim->all))
        return STATUS_OK;
    stored_field *half_spin = store_find(sim, "half_spin");
    uint64_t bytes = field_bytes(sim, &field_velocity);
    TRY(store_copy(sim, store_find(sim, "velocity")->mem, store_find(sim, "half_velocity")->mem, 0, 0, bytes, why));
    return half_spin ? store_copy(sim, store_find(sim, "spin")->mem, half_spin->mem, 0, 0, bytes, why) : STATUS_OK;
}

status simulation_begin_stage(simulation *sim, int stage, failure *why)
{
    TRY(heat_steps_end(sim, why));
    sim->stage_steps = 0;
    frozen_restart(sim);
    TRY(end_half_steps(sim, why));
    change_bodies(sim, &sim->scene->stage[stage]);
    TRY(upload_movers(sim, why));
    TRY(begin_half_steps(sim, why));
    TRY(softening_refresh(sim, why));
    TRY(simulation_enter_stage(sim, stage, why));
    return beams_find_depths(sim, why);
}
