#include "precision.h"
#include "simulation.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Layers of grains whose mass the wall has: enough that its contacts do not bind the step, see docs/theory.md. */
#define SERVO_LAYERS 5.0
/* Forces are summed in this many parts of the force to keep. */
#define SERVO_PARTS 1099511627776.0 /* 2^40 */
#define SERVO_NUMBERS ((int64_t)(offsetof(clast_servo, reversals) / sizeof(double)))
/* Violent turns between guards, so many looks in a row, are an oscillation. */
#define SERVO_TURNS 2
#define SERVO_LOOKS 100

static const servo_choice *first_choice(const scene *scene, const drive *d)
{
    return d->group >= 0 ? &scene->wall_group[d->group].servo : &scene->wall[d->wall].servo;
}

static const char *drive_name(const scene *scene, const drive *d)
{
    return d->group >= 0 ? scene->wall_group[d->group].name : scene->wall[d->wall].name;
}

static place drive_place(const scene *scene, const drive *d)
{
    return d->group >= 0 ? scene->wall_group[d->group].at : scene->wall[d->wall].at;
}

/* What a stage says about a wall or a group; NULL: nothing. */
static const servo_choice *changed_choice(const scene_stage *stage, int wall, int group)
{
    for (int k = 0; group < 0 && k < stage->wall_change_count; k++)
        if (stage->wall_change[k].wall == wall && stage->wall_change[k].servo.given)
            return &stage->wall_change[k].servo;
    for (int k = 0; group >= 0 && k < stage->wall_group_change_count; k++)
        if (stage->wall_group_change[k].group == group && stage->wall_group_change[k].servo.given)
            return &stage->wall_group_change[k].servo;
    return NULL;
}

static bool ever_driven(const scene *scene, int wall, int group)
{
    drive d = {.wall = wall, .group = group};
    bool any = first_choice(scene, &d)->given;
    for (int s = 0; s < scene->stage_count; s++)
        any = any || changed_choice(&scene->stage[s], wall, group);
    return any;
}

status servo_create(simulation *sim, failure *why)
{
    const scene *scene = sim->scene;
    drives *all = &sim->drives;
    if (!scene_has_servo(scene))
        return STATUS_OK;
    all->drive = calloc((size_t)(scene->wall_count + scene->wall_group_count), sizeof *all->drive);
    all->of_wall = malloc(sizeof *all->of_wall * (size_t)scene->wall_count);
    if (!all->drive || !all->of_wall)
        return fail(why, STATUS_ERROR, "out of memory");
    for (int w = 0; w < scene->wall_count; w++) {
        all->of_wall[w] = -1;
        if (scene->wall[w].group < 0 && ever_driven(scene, w, -1)) {
            all->of_wall[w] = all->count;
            all->drive[all->count++] = (drive){.wall = w, .group = -1};
        }
    }
    for (int g = 0; g < scene->wall_group_count; g++) {
        if (!ever_driven(scene, -1, g))
            continue;
        for (int w = 0; w < scene->wall_count; w++)
            if (scene->wall[w].group == g)
                all->of_wall[w] = all->count;
        all->drive[all->count++] = (drive){.wall = -1, .group = g};
    }
    for (int d = 0; d < all->count; d++) {
        const servo_choice *choice = first_choice(scene, &all->drive[d]);
        all->drive[d].spec = choice->given ? &choice->spec : NULL;
    }
    return store_buffer(sim, &all->mem, sizeof(clast_servo) * (uint64_t)all->count, "servos", why);
}

void servo_free(simulation *sim)
{
    store_release(sim, &sim->drives.mem, 0);
    free(sim->drives.drive);
    free(sim->drives.of_wall);
}

/* In a frozen stage walls stand where they are. */
bool servo_live(const simulation *sim)
{
    for (int d = 0; d < sim->drives.count && !sim->live.frozen; d++)
        if (sim->drives.drive[d].spec)
            return true;
    return false;
}

/* ---- areas ---- */

static double along(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Index of the axis that a unit vector lies along, or -1. */
static int axis_of(const double *n)
{
    for (int c = 0; c < 3; c++)
        if (fabs(n[c]) > 1.0 - 1e-9)
            return c;
    return -1;
}

static double product_without(const double *low, const double *high, int axis)
{
    double area = 1.0;
    for (int c = 0; c < 3; c++)
        area *= c == axis ? 1.0 : high[c] - low[c];
    return area;
}

/* A plane has no area: that of the one box or the one cylinder that stands around the bed, else the domain's. NAN where none is certain. */
static double cross_section(const scene *scene, const double *direction)
{
    int axis = axis_of(direction), found = 0;
    double area = NAN;
    for (int w = 0; w < scene->wall_count; w++) {
        const wall *wall = &scene->wall[w];
        if (wall->shape == WALL_BOX && axis >= 0) {
            area = product_without(wall->low_m, wall->high_m, axis);
            found++;
        } else if (wall->shape == WALL_CYLINDER && !wall->outside && fabs(along(wall->axis, direction)) > 1.0 - 1e-9) {
            area = M_PI * wall->radii_m[0] * wall->radii_m[0];
            found++;
        }
    }
    if (found == 0 && axis >= 0 && scene->domain.given)
        return product_without(scene->domain.low_m, scene->domain.high_m, axis);
    return found == 1 ? area : NAN;
}

/* A box whose faces towards both sides are closed feels its bed on both: no area is the right one. */
static double box_area(const wall *wall, const double *direction)
{
    double area = 0.0;
    for (int c = 0; c < 3; c++) {
        bool low = !wall->open[2 * c], high = !wall->open[2 * c + 1];
        if (fabs(direction[c]) > 1e-9 && low && high)
            return NAN;
        area += low || high ? fabs(direction[c]) * product_without(wall->low_m, wall->high_m, c) : 0.0;
    }
    return area > 0.0 ? area : NAN;
}

static double wall_area(const scene *scene, const wall *wall, const double *direction)
{
    body_pose still = {.rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    clast_face face[6];
    switch (wall->shape) {
    case WALL_PLANE:
        return cross_section(scene, direction);
    case WALL_BOX:
        return box_area(wall, direction);
    case WALL_RECTANGLE:
        wall_faces(wall, &still, 0, 0, face);
        return 4.0 * face[0].extent[0] * face[0].extent[1] * fabs(along(face[0].normal, direction));
    case WALL_DISC:
        return M_PI * wall->radius_m * wall->radius_m * fabs(along(wall->normal, direction));
    default:
        return NAN;
    }
}

static status find_area(const simulation *sim, const drive *d, double *out, failure *why)
{
    const scene *scene = sim->scene;
    place at = drive_place(scene, d);
    *out = d->spec->area_m2;
    if (!isnan(*out))
        return STATUS_OK;
    *out = 0.0;
    for (int w = 0; w < scene->wall_count; w++)
        if (sim->drives.of_wall[w] == d - sim->drives.drive)
            *out += scene->dimensions == 2 ? NAN : wall_area(scene, &scene->wall[w], d->spec->direction);
    if (*out > 0.0)
        return STATUS_OK;
    return fail(why, STATUS_BAD_INPUT,
                "%s:%d:%d: the servo of `%s` keeps a pressure, and the area that faces the bed cannot be told from the scene (%s); give "
                "`area_m2` beside `pressure_pa`, or a force by `force_n`",
                scene->path, at.line, at.column, drive_name(scene, d),
                scene->dimensions == 2 ? "in two dimensions walls have no depth" : "of a plane it is that of the one box or cylinder around the bed, or of the domain");
}

/* ---- stages ---- */

/* From the first of its walls to the far end of the bed as it was generated. */
static double way_through_bed(const simulation *sim, const drive *d)
{
    const double *n = d->spec->direction;
    double far = 0.0, first = INFINITY;
    for (int c = 0; c < 3; c++)
        far += fmax(n[c] * sim->bed_low[c], n[c] * sim->bed_high[c]) + fabs(n[c]) * sim->radius_max;
    for (int w = 0; w < sim->scene->wall_count; w++)
        if (sim->drives.of_wall[w] == d - sim->drives.drive)
            first = fmin(first, along(wall_reference(&sim->scene->wall[w]), n));
    return far - first;
}

/* Mass of some layers of grains across the direction, of all at most. */
static double wall_mass(const simulation *sim, const double *n)
{
    double height = 2.0 * sim->mean_radius, all = sim->mean_mass * (double)sim->id_count;
    for (int c = 0; c < 3; c++)
        height += fabs(n[c]) * (sim->bed_high[c] - sim->bed_low[c]);
    return all * fmin(1.0, SERVO_LAYERS * 2.0 * sim->mean_radius / height);
}

static void fold(drive *d, const double *direction)
{
    for (int c = 0; c < 3; c++)
        d->base[c] += d->state.shift * direction[c];
    d->state.shift = d->state.built = 0.0;
}

void servo_change(simulation *sim, const scene_stage *stage, bool replay)
{
    for (int k = 0; k < sim->drives.count; k++) {
        drive *d = &sim->drives.drive[k];
        const servo_choice *choice = changed_choice(stage, d->wall, d->group);
        if (!choice)
            continue;
        const servo_spec *next = choice->off ? NULL : &choice->spec;
        bool goes_on = next && d->spec && memcmp(next->direction, d->spec->direction, sizeof next->direction) == 0;
        if (!goes_on && !replay) {
            if (d->spec)
                fold(d, d->spec->direction);
            d->state.velocity = d->state.force = 0.0;
        }
        d->spec = next;
    }
}

status servo_enter(simulation *sim, failure *why)
{
    for (int k = 0; k < sim->drives.count; k++) {
        drive *d = &sim->drives.drive[k];
        clast_servo *s = &d->state;
        const scene *scene = sim->scene;
        place at = drive_place(scene, d);
        s->live = d->spec != NULL;
        if (!d->spec)
            continue;
        d->area = NAN;
        if (!isnan(d->spec->pressure_pa))
            TRY(find_area(sim, d, &d->area, why));
        memcpy(s->direction, d->spec->direction, sizeof s->direction);
        s->target = isnan(d->spec->force_n) ? d->spec->pressure_pa * d->area : d->spec->force_n;
        s->speed_max = d->spec->speed_max_m_s;
        s->mass = wall_mass(sim, s->direction);
        s->damping = s->target / s->speed_max;
        s->unit = exp2(round(log2(s->target / SERVO_PARTS)));
        s->inverse_unit = 1.0 / s->unit;
        d->bound = isnan(d->spec->travel_max_m) ? way_through_bed(sim, d) : d->spec->travel_max_m;
        if (!(d->bound > 0.0))
            return fail(why, STATUS_BAD_INPUT,
                        "%s:%d:%d: the servo of `%s` presses along [%g, %g, %g], and no particle lies on that side of the wall; turn `direction` "
                        "round, or give `travel_max_m`",
                        scene->path, at.line, at.column, drive_name(scene, d), s->direction[0], s->direction[1], s->direction[2]);
    }
    return STATUS_OK;
}

int servo_of_wall(const simulation *sim, int wall)
{
    int d = sim->drives.count ? sim->drives.of_wall[wall] : -1;
    return d >= 0 && sim->drives.drive[d].spec && !sim->live.frozen ? d : -1;
}

void servo_shift(const simulation *sim, int wall, bool all, body_pose *pose)
{
    int k = sim->drives.count ? sim->drives.of_wall[wall] : -1;
    if (k < 0)
        return;
    const drive *d = &sim->drives.drive[k];
    bool moved = (all || sim->live.frozen) && d->spec, driven = moved && !sim->live.frozen;
    for (int c = 0; c < 3; c++) {
        double way = d->base[c] + (moved ? d->state.shift * d->state.direction[c] : 0.0);
        pose->shift[c] += way;
        pose->pivot[c] += way;
        pose->velocity[c] += driven ? d->state.velocity * d->state.direction[c] : 0.0;
    }
}

/* ---- steps ---- */

double servo_share(const simulation *sim)
{
    bool prescribed = false;
    for (int w = 0; w < sim->scene->wall_count; w++)
        prescribed = prescribed || moving_body_moves(&sim->wall_body[w]);
    return servo_live(sim) && prescribed ? 0.25 : 0.5;
}

double servo_speed_max(const simulation *sim)
{
    double most = 0.0;
    for (int k = 0; k < sim->drives.count; k++)
        if (sim->drives.drive[k].spec)
            most = fmax(most, sim->drives.drive[k].spec->speed_max_m_s);
    return most;
}

status servo_begin(simulation *sim, failure *why)
{
    if (!servo_live(sim))
        return STATUS_OK;
    cl_kernel kernel = launch_kernel(sim, "servo_place");
    double travel = servo_share(sim) * sim->table.skin;
    for (int k = 0; k < sim->drives.count; k++) {
        clast_servo *s = &sim->drives.drive[k].state;
        s->travel_max = travel;
        clast_servo sent = *s;
        if (sim->mixed)
            precision_split(&sent, SERVO_NUMBERS);
        TRY(store_write(sim, sim->drives.mem, sizeof sent * (uint64_t)k, sizeof sent, &sent, why));
    }
    TRY(launch_set(kernel, "servo_place", why, "mmi", sim->drives.mem, sim->faces, (cl_int)sim->face_count));
    return launch_run(sim, kernel, "servo_place", 1, 1, why);
}

status servo_step(simulation *sim, const clast_launch *launch, int rows, failure *why)
{
    const contact_table *t = &sim->table;
    if (!servo_live(sim))
        return STATUS_OK;
    cl_kernel kernel = launch_kernel(sim, "servo_stage");
    TRY(launch_set(kernel, "servo_stage", why, "Lmmmmmiiii", launch, sim->control, sim->drives.mem, sim->faces, t->other[t->now],
                   store_find(sim, "force")->mem, (cl_int)sim->drives.count, (cl_int)t->wall_base, (cl_int)(t->wall_base + t->wall_record_count),
                   (cl_int)rows));
    return launch_run(sim, kernel, "servo_stage", sim->block, sim->block, why);
}

status servo_end(simulation *sim, failure *why)
{
    if (!servo_live(sim))
        return STATUS_OK;
    for (int k = 0; k < sim->drives.count; k++) {
        clast_servo *s = &sim->drives.drive[k].state;
        TRY(store_read(sim, sim->drives.mem, sizeof *s * (uint64_t)k, sizeof *s, s, why));
        if (sim->mixed)
            precision_join(s, SERVO_NUMBERS);
    }
    return STATUS_OK;
}

void servo_note_table(simulation *sim)
{
    for (int k = 0; k < sim->drives.count; k++)
        sim->drives.drive[k].state.built = sim->drives.drive[k].state.shift;
}

/* ---- guards ---- */

static void stop(const simulation *sim, const drive *d, guard_finding *out, const char *what, const char *remedy)
{
    out->stop = true;
    snprintf(out->text, sizeof out->text, "%s: stopped by a guard at t = %.9g s (step %lld): the servo of the wall%s `%s` %s (it keeps %g N, the bed pushes back with %g N); %s",
             sim->scene->path, sim->time, (long long)sim->step, d->group >= 0 ? " group" : "", drive_name(sim->scene, d), what, d->state.target, d->state.force, remedy);
}

void servo_guard(simulation *sim, guard_finding *out)
{
    char what[256];
    for (int k = 0; k < sim->drives.count && !out->stop; k++) {
        drive *d = &sim->drives.drive[k];
        if (!d->spec)
            continue;
        int32_t turns = d->state.reversals - d->reversals_seen;
        d->reversals_seen = d->state.reversals;
        d->looks = turns >= SERVO_TURNS ? d->looks + 1 : 0;
        if (fabs(d->state.shift) > d->bound) {
            bool lost = d->state.shift > 0.0 && fabs(d->state.force) < 0.01 * d->state.target;
            snprintf(what, sizeof what, "has moved %.4g m along its direction, past its bound of %.4g m%s", d->state.shift, d->bound,
                     lost ? ", and has not found the bed" : "");
            stop(sim, d, out, what,
                 lost ? "see that `direction` points to the bed and that the wall spans it" : "raise travel_max_m if that is meant, or lower the force or speed_max_m_s");
        } else if (d->looks >= SERVO_LOOKS) {
            snprintf(what, sizeof what, "swings to and fro at more than half of its largest speed of %.3g m/s", d->state.speed_max);
            stop(sim, d, out, what, "lower speed_max_m_s, which damps it more");
        }
    }
}

/* ---- checkpoints ---- */

enum { SAVED = 7 };

void servo_save(const simulation *sim, bundle *out)
{
    if (sim->drives.count == 0)
        return;
    double *row = bundle_add(out, "bodies/servos", BUNDLE_F64, sim->drives.count, SAVED, NULL);
    for (int k = 0; k < sim->drives.count; k++, row += SAVED) {
        const drive *d = &sim->drives.drive[k];
        memcpy(row, d->base, sizeof d->base);
        row[3] = d->state.shift;
        row[4] = d->state.velocity;
        row[5] = d->state.force;
        row[6] = d->state.fastest;
    }
}

status servo_load(simulation *sim, const bundle *in, const char *path, int stage, failure *why)
{
    const bundle_entry *entry;
    if (sim->drives.count == 0)
        return STATUS_OK;
    TRY(bundle_get(in, path, "bodies/servos", BUNDLE_F64, sim->drives.count, SAVED, &entry, why));
    for (int s = 0; s <= stage; s++)
        servo_change(sim, &sim->scene->stage[s], true);
    const double *row = entry->data;
    for (int k = 0; k < sim->drives.count; k++, row += SAVED) {
        drive *d = &sim->drives.drive[k];
        memcpy(d->base, row, sizeof d->base);
        d->state.shift = row[3];
        d->state.velocity = row[4];
        d->state.force = row[5];
        d->state.fastest = row[6];
    }
    return STATUS_OK;
}
