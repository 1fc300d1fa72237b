/* Walls and prescribed motions as the steps of a batch see them, and how far walls have gone since the last table. */
#include "simulation.h"

#include "precision.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rows for the steps of a batch: walls where they are at the start of each step, prescribed motions over it. What stands still has one. */
static status fit_rows(simulation *sim, failure *why)
{
    int rows = sim->walls_move || sim->groups_move || sim->heat.vary ? (int)sim->batch_limit : 1;
    if (rows <= sim->batch_rows)
        return STATUS_OK;
    uint64_t faces = sizeof(clast_face) * (uint64_t)(sim->face_count * rows),
             movers = sizeof(clast_mover) * (uint64_t)(sim->mover_count * rows);
    free(sim->face_rows);
    free(sim->mover_rows);
    sim->face_rows = malloc(faces + 1);
    sim->mover_rows = malloc(movers + 1);
    if (!sim->face_rows || !sim->mover_rows)
        return fail(why, STATUS_ERROR, "out of memory");
    store_release(sim, &sim->faces, sim->face_bytes);
    store_release(sim, &sim->movers, sim->mover_bytes);
    sim->face_bytes = faces;
    sim->mover_bytes = movers;
    if (sim->face_count > 0)
        TRY(store_buffer(sim, &sim->faces, faces, "walls", why));
    if (sim->mover_count > 0)
        TRY(store_buffer(sim, &sim->movers, movers, "prescribed motions", why));
    sim->batch_rows = rows;
    return heat_fit_rows(sim, rows, why);
}

/* In mixed precision by way of a copy: the host goes on reading its own rows. */
static status send_rows(simulation *sim, int rows, failure *why)
{
    uint64_t faces = sizeof(clast_face) * (uint64_t)(sim->face_count * rows),
             movers = sizeof(clast_mover) * (uint64_t)(sim->mover_count * rows);
    if (!sim->mixed) {
        TRY(store_write(sim, sim->faces, 0, faces, sim->face_rows, why));
        return store_write(sim, sim->movers, 0, movers, sim->mover_rows, why);
    }
    clast_face *face = malloc(faces + 1);
    clast_mover *mover = malloc(movers + 1);
    status result = face && mover ? STATUS_OK : fail(why, STATUS_ERROR, "out of memory");
    if (result == STATUS_OK) {
        memcpy(face, sim->face_rows, faces);
        memcpy(mover, sim->mover_rows, movers);
        precision_split_faces(face, sim->face_count * rows, sim->origin);
        precision_split_movers(mover, sim->mover_count * rows, sim->origin);
        result = store_write(sim, sim->faces, 0, faces, face, why);
    }
    if (result == STATUS_OK)
        result = store_write(sim, sim->movers, 0, movers, mover, why);
    free(face);
    free(mover);
    return result;
}

status body_rows_write(simulation *sim, int rows, failure *why)
{
    for (int row = 0; row < rows; row++) {
        double time = simulation_time_after(sim, row);
        clast_face *face = sim->face_rows + row * sim->face_count;
        for (int w = 0; w < sim->scene->wall_count; w++) {
            body_pose pose = moving_body_pose(&sim->wall_body[w], time);
            servo_shift(sim, w, false, &pose);
            wall_faces(&sim->scene->wall[w], &pose, sim->scene->material_count + w, w, face);
            for (int f = 0; f < wall_face_count(&sim->scene->wall[w]); f++)
                face++->drive = servo_of_wall(sim, w);
        }
        for (int g = 0; g < sim->mover_count; g++)
            sim->mover_rows[row * sim->mover_count + g] = moving_body_step(&sim->group_body[g], time, sim->dt);
        heat_fill_row(sim, row, time);
    }
    TRY(send_rows(sim, rows, why));
    TRY(servo_begin(sim, why));
    return heat_write_rows(sim, rows, why);
}

status simulation_pose_now(simulation *sim, failure *why)
{
    TRY(fit_rows(sim, why));
    return body_rows_write(sim, 1, why);
}

body_pose simulation_wall_pose(const simulation *sim, int wall)
{
    body_pose pose = moving_body_pose(&sim->wall_body[wall], sim->time);
    servo_shift(sim, wall, true, &pose);
    return pose;
}

/* A cylinder, a cone or a disc is where its axis is: to turn about that moves nothing. False: not such a wall. */
static bool round_travel(const wall *wall, const body_pose *before, const body_pose *now, double *out)
{
    bool disc = wall->shape == WALL_DISC;
    if (!disc && wall->shape != WALL_CYLINDER && wall->shape != WALL_CONE)
        return false;
    double a[3], b[3], e[3], f[3], moved = 0.0, tilted = 0.0;
    pose_point(before, disc ? wall->center_m : wall->axis_point_m, a);
    pose_point(now, disc ? wall->center_m : wall->axis_point_m, b);
    pose_vector(before, disc ? wall->normal : wall->axis, e);
    pose_vector(now, disc ? wall->normal : wall->axis, f);
    for (int c = 0; c < 3; c++) {
        moved += (b[c] - a[c]) * (b[c] - a[c]);
        tilted += (f[c] - e[c]) * (f[c] - e[c]);
    }
    *out = sqrt(moved) + sqrt(tilted) * (disc ? wall->radius_m : wall->length_m + fmax(wall->radii_m[0], wall->radii_m[1]));
    return true;
}

/* How far a wall may have moved, against the common drift, since the table was built: an upper bound over what the bed can touch. */
double body_rows_wall_travel(const simulation *sim, double time)
{
    double most = 0.0, span = 0.0;
    for (int c = 0; c < 3; c++)
        span += pow(sim->bed_high[c] - sim->bed_low[c] + 4.0 * sim->radius_max, 2);
    for (int w = 0; w < sim->scene->wall_count; w++) {
        const moving_body *body = &sim->wall_body[w];
        body_pose before = moving_body_pose(body, sim->built_time), now = moving_body_pose(body, time);
        double centre[3], a[3], b[3], apart = 0.0, speed = 0.0, turn = 0.0, reach = 0.0;
        if (round_travel(&sim->scene->wall[w], &before, &now, &turn)) {
            most = fmax(most, turn); /* with walls the common drift is none */
            continue;
        }
        for (int c = 0; c < 3; c++)
            centre[c] = 0.5 * (sim->bed_low[c] + sim->bed_high[c]);
        pose_point(&before, centre, a);
        pose_point(&now, centre, b);
        for (int c = 0; c < 3; c++) {
            apart += pow(b[c] - a[c] - sim->drift_velocity[c] * (time - sim->built_time), 2);
            speed += pow(now.spin[c], 2);
            reach += pow(centre[c] - now.pivot[c], 2);
        }
        turn = sqrt(speed) * (time - sim->built_time) * (sqrt(span) + sqrt(reach));
        most = fmax(most, (speed > 0.0 ? 0.0 : sqrt(apart)) + turn);
    }
    return most;
}

/* Displacements count against the bed's mean velocity where no wall or prescribed grain holds it; against rest else. */
status simulation_choose_drift(simulation *sim, failure *why)
{
    memset(sim->drift_velocity, 0, sizeof sim->drift_velocity);
    if (sim->scene->wall_count > 0 || sim->mover_count > 0 || sim->count == 0)
        return STATUS_OK;
    particle_sums sums;
    TRY(observe_stored_sums(sim, &sums, why));
    for (int c = 0; c < 3; c++)
        sim->drift_velocity[c] = sums.mass > 0.0 ? sums.momentum[c] / sums.mass : 0.0;
    return STATUS_OK;
}
