#include "output.h"

#include "scene_table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The last of them, the radius, is a series where it changes. */
#define CONSTANT_FIELDS 5

struct output {
    simulation *sim;
    results *file;
    int field_count;
    results_field *field;
    int observable_count, value_count;
    results_observable *observable;
    char (*wall_name)[160];
    double *value;
    bool wants_sums, wants_contacts, wants_stress, wants_heat, wants_clusters;
    double *mass, *radius;
    int32_t *id, *material, *group;
};

static const output_name *find_name(const output_name *names, const char *name)
{
    for (const output_name *n = names; n->name; n++)
        if (strcmp(n->name, name) == 0)
            return n;
    return NULL;
}

/* ---- constants of the grains ---- */

static status read_constants(output *o, failure *why)
{
    simulation *sim = o->sim;
    size_t n = (size_t)sim->id_count + 1;
    o->id = malloc(n * sizeof *o->id);
    o->material = calloc(n, sizeof *o->material);
    o->group = malloc(n * sizeof *o->group);
    if (!o->id || !o->material || !o->group)
        return fail(why, STATUS_ERROR, "out of memory");
    TRY(observe_field(sim, "mass", &o->mass, why));
    TRY(observe_field(sim, "radius", &o->radius, why));
    for (int64_t i = 0; i < sim->id_count; i++) {
        o->id[i] = (int32_t)i;
        o->group[i] = sim->group_of_id[i];
        o->material[i] = sim->scene->group[sim->group_of_id[i]].material;
    }
    return STATUS_OK;
}

/* ---- what the scene asks for ---- */

static bool is_cluster(const char *name)
{
    return strcmp(name, "cluster") == 0;
}

static status list_fields(output *o, failure *why)
{
    const output_spec *spec = &o->sim->scene->output;
    const results_field constant[CONSTANT_FIELDS] = {{"id", "", 1, true, true},
                                                     {"group", "", 1, true, true},
                                                     {"material", "", 1, true, true},
                                                     {"mass", "kg", 1, true, false},
                                                     {"radius", "m", 1, true, false}};
    o->field = calloc((size_t)spec->field_count + CONSTANT_FIELDS, sizeof *o->field);
    if (!o->field)
        return fail(why, STATUS_ERROR, "out of memory");
    memcpy(o->field, constant, sizeof constant);
    o->field[CONSTANT_FIELDS - 1].constant = !o->sim->all.law[SLOT_RADIUS];
    o->field_count = CONSTANT_FIELDS;
    for (int f = 0; f < spec->field_count; f++) {
        const output_name *name = find_name(output_fields, spec->fields[f]);
        o->field[o->field_count++] = (results_field){name->name, name->unit, name->components, false, is_cluster(name->name)};
    }
    return STATUS_OK;
}

static bool is_of_heat(const char *name)
{
    return strncmp(name, "temperature_", 12) == 0 || strcmp(name, "thermal_energy") == 0 || strncmp(name, "heat_", 5) == 0 || strcmp(name, "source_absorbed") == 0;
}

static bool wall_heat_is_written(const simulation *sim)
{
    return sim->all.law[SLOT_CONDUCTION] != NULL;
}

/* Of walls that move: where their point of reference is, its velocity, and how they are turned. */
static void list_poses(output *o)
{
    static const results_observable part[] = {{"position", "m", 3}, {"velocity", "m/s", 3}, {"orientation", "1", 4}};
    const scene *scene = o->sim->scene;
    for (int w = 0; w < scene->wall_count; w++)
        for (int p = 0; scene_wall_moves(scene, w) && p < 3; p++) {
            char *name = o->wall_name[3 * scene->wall_count + 3 * w + p];
            snprintf(name, sizeof o->wall_name[0], "walls/%s/%s", scene->wall[w].name, part[p].name);
            o->observable[o->observable_count++] = (results_observable){name, part[p].unit, part[p].components};
            o->value_count += part[p].components;
        }
}

static status list_observables(output *o, failure *why)
{
    static const char *const of_contacts[] = {"elastic_energy", "overlap_max", "coordination_number", "contacts"};
    const scene *scene = o->sim->scene;
    o->observable = calloc((size_t)(scene->output.observable_count + 6 * scene->wall_count + scene->wall_group_count + 1), sizeof *o->observable);
    o->wall_name = calloc((size_t)(6 * scene->wall_count + scene->wall_group_count + 1), sizeof *o->wall_name);
    if (!o->observable || !o->wall_name)
        return fail(why, STATUS_ERROR, "out of memory");
    for (int k = 0; k < scene->output.observable_count; k++) {
        const output_name *name = find_name(output_observables, scene->output.observables[k]);
        o->observable[o->observable_count++] = (results_observable){name->name, name->unit, name->components};
        o->value_count += name->components;
        o->wants_stress = o->wants_stress || strcmp(name->name, "stress") == 0;
        o->wants_clusters = o->wants_clusters || strncmp(name->name, "cluster", 7) == 0;
        o->wants_heat = o->wants_heat || is_of_heat(name->name);
        for (size_t c = 0; c < sizeof of_contacts / sizeof *of_contacts; c++)
            o->wants_contacts = o->wants_contacts || strcmp(name->name, of_contacts[c]) == 0;
    }
    for (int w = 0; w < scene->wall_count; w++)
        for (int q = 0; q < 2; q++) {
            char *name = o->wall_name[2 * w + q];
            snprintf(name, sizeof o->wall_name[0], "walls/%s/%s", scene->wall[w].name, q ? "torque" : "force");
            o->observable[o->observable_count++] = (results_observable){name, q ? "N m" : "N", 3};
            o->value_count += 3;
        }
    for (int w = 0; wall_heat_is_written(o->sim) && w < scene->wall_count; w++) {
        char *name = o->wall_name[2 * scene->wall_count + w];
        snprintf(name, sizeof o->wall_name[0], "walls/%s/heat", scene->wall[w].name);
        o->observable[o->observable_count++] = (results_observable){name, "W", 1};
        o->value_count++;
    }
    list_poses(o);
    for (int g = 0; g < scene->wall_group_count; g++) {
        char *name = o->wall_name[6 * scene->wall_count + g];
        snprintf(name, sizeof o->wall_name[0], "wall_groups/%s/force", scene->wall_group[g].name);
        o->observable[o->observable_count++] = (results_observable){name, "N", 3};
        o->value_count += 3;
    }
    o->value = calloc((size_t)o->value_count + 1, sizeof *o->value);
    return o->value ? STATUS_OK : fail(why, STATUS_ERROR, "out of memory");
}

status output_open(simulation *sim, const char *path, const char *plan_text, bool continued, output **out, failure *why)
{
    output *o = calloc(1, sizeof *o);
    *out = o;
    if (!o)
        return fail(why, STATUS_ERROR, "out of memory");
    const scene *scene = sim->scene;
    o->sim = sim;
    TRY(read_constants(o, why));
    TRY(list_fields(o, why));
    TRY(list_observables(o, why));
    char device[1024];
    device_describe(&sim->device->info, device, sizeof device);
    results_spec spec = {.count = sim->id_count,
                         .field_count = o->field_count,
                         .field = o->field,
                         .observable_count = o->observable_count,
                         .observable = o->observable,
                         .contacts = scene->output.contacts,
                         .box_given = scene->domain.given,
                         .scene_text = scene->text,
                         .plan_text = plan_text,
                         .version_text = "clast " CLAST_VERSION,
                         .device_text = device};
    for (int c = 0; c < 3; c++) {
        spec.box_low[c] = scene->domain.low_m[c];
        spec.box_high[c] = scene->domain.high_m[c];
        spec.periodic[c] = scene->domain.given && scene->domain.periodic[c];
    }
    return continued ? results_continue(path, &spec, sim->step, &o->file, why) : results_create(path, &spec, &o->file, why);
}

/* ---- frames ---- */

/* Total force or torque on every grain: its contacts, and its weight. */
static status total_of_contacts(output *o, bool torque, double **out, failure *why)
{
    simulation *sim = o->sim;
    TRY(observe_totals(sim, torque, out, why));
    for (int64_t i = 0; !torque && i < sim->id_count; i++)
        for (int c = 0; c < 3; c++)
            (*out)[3 * i + c] += o->mass[i] * sim->gravity[c];
    return STATUS_OK;
}

static status field_values(output *o, const char *name, void **out, failure *why)
{
    bool force = strcmp(name, "force") == 0, torque = strcmp(name, "torque") == 0;
    int32_t *ids = NULL;
    double *reals = NULL;
    status result = is_cluster(name) ? clusters_find(o->sim, &ids, why)
                                     : force || torque ? total_of_contacts(o, torque, &reals, why) : observe_field(o->sim, name, &reals, why);
    *out = ids ? (void *)ids : reals;
    return result;
}

static status frame_values(output *o, const void **value, void **owned, failure *why)
{
    const void *const constant[CONSTANT_FIELDS] = {o->id, o->group, o->material, o->mass, o->radius};
    memcpy(value, constant, sizeof constant);
    for (int f = 0; f < o->field_count; f++) {
        if (o->field[f].constant || f < CONSTANT_FIELDS - 1)
            continue;
        const char *name = o->field[f].name;
        TRY(field_values(o, name, &owned[f], why));
        value[f] = owned[f];
    }
    return STATUS_OK;
}

/* Contacts as columns. */
static status frame_contacts(output *o, results_contacts *c, void **columns, failure *why)
{
    live_contact *live = NULL;
    int64_t count;
    TRY(observe_contacts(o->sim, false, &live, &count, why));
    columns[0] = live;
    size_t n = (size_t)count + 1;
    int32_t *ids = columns[1] = malloc(4 * n * sizeof *ids);
    double *reals = columns[2] = malloc(6 * n * sizeof *reals);
    if (!ids || !reals)
        return fail(why, STATUS_ERROR, "out of memory");
    for (int64_t k = 0; k < count; k++) {
        ids[k] = live[k].i;
        ids[(int64_t)n + k] = live[k].j;
        ids[2 * (int64_t)n + k] = live[k].wall;
        ids[3 * (int64_t)n + k] = live[k].bonded;
        reals[k] = live[k].overlap;
        reals[(int64_t)n + k] = live[k].area;
        memcpy(reals + 2 * n + 3 * k, live[k].force, sizeof live[k].force);
        reals[5 * (int64_t)n + k] = live[k].heat;
    }
    *c = (results_contacts){.count = count,
                            .i = ids,
                            .j = ids + n,
                            .wall = ids + 2 * n,
                            .bonded = ids + 3 * n,
                            .overlap = reals,
                            .area = reals + n,
                            .force = (const double(*)[3])(reals + 2 * n),
                            .heat = reals + 5 * n};
    return STATUS_OK;
}

status output_frame(output *o, failure *why)
{
    const void **value = calloc((size_t)o->field_count, sizeof *value);
    void **owned = calloc((size_t)o->field_count, sizeof *owned);
    void *columns[3] = {NULL, NULL, NULL};
    results_contacts contacts;
    bool with_contacts = o->sim->scene->output.contacts;
    status result = value && owned ? frame_values(o, value, owned, why) : fail(why, STATUS_ERROR, "out of memory");
    if (result == STATUS_OK && with_contacts)
        result = frame_contacts(o, &contacts, columns, why);
    if (result == STATUS_OK)
        result = results_frame(o->file, o->sim->step, o->sim->time, value, with_contacts ? &contacts : NULL, why);
    for (int f = 0; owned && f < o->field_count; f++)
        free(owned[f]);
    for (int c = 0; c < 3; c++)
        free(columns[c]);
    free(owned);
    free(value);
    return result;
}

/* ---- observables ---- */

typedef struct measured {
    particle_sums grains;
    contact_sums contacts;
    bond_sums bonds;
    cluster_sums clusters;
    double stress[9];
    heat_sums heat;
    double ledger[LEDGER_TERMS];
    double source_delivered;
} measured;

static double bed_volume(const simulation *sim)
{
    const domain *d = &sim->scene->domain;
    double volume = 1.0;
    for (int c = 0; c < (sim->scene->dimensions == 2 ? 2 : 3); c++)
        volume *= d->given ? d->high_m[c] - d->low_m[c] : sim->bed_high[c] - sim->bed_low[c] + 2.0 * sim->mean_radius;
    return sim->scene->dimensions == 2 ? volume * 2.0 * sim->mean_radius : volume;
}

static int put_observable(const output *o, const char *name, const measured *m, double *to)
{
    const simulation *sim = o->sim;
    const struct {
        const char *name;
        double value;
    } scalars[] = {{"time_step", sim->dt},
                   {"kinetic_energy", m->grains.kinetic},
                   {"rotational_energy", m->grains.rotational},
                   {"elastic_energy", m->contacts.elastic},
                   {"gravitational_energy", m->grains.gravitational},
                   {"overlap_max", m->contacts.overlap_max},
                   {"coordination_number", sim->count ? (double)(m->contacts.contacts + m->contacts.pairs) / (double)sim->count : 0.0},
                   {"contacts", (double)m->contacts.contacts},
                   {"rebuilds", (double)sim->rebuilds},
                   {"bonds_alive", (double)m->bonds.alive},
                   {"bonds_made", (double)m->bonds.made},
                   {"bonds_broken", (double)m->bonds.broken},
                   {"clusters", (double)m->clusters.count},
                   {"cluster_grains", (double)m->clusters.grains},
                   {"cluster_largest", (double)m->clusters.largest},
                   {"left_count", (double)sim->left_count},
                   {"left_mass", sim->left_mass},
                   {"thermal_energy", m->heat.content},
                   {"temperature_min", m->heat.lowest},
                   {"temperature_mean", m->heat.mean},
                   {"temperature_max", m->heat.highest},
                   {"heat_sources", m->heat.tally[CLAST_TALLY_SOURCES]},
                   {"heat_convection", m->heat.tally[CLAST_TALLY_CONVECTION]},
                   {"heat_radiation", m->heat.tally[CLAST_TALLY_RADIATION]},
                   {"heat_walls", m->heat.tally[CLAST_TALLY_WALLS]},
                   {"heat_dissipation", m->heat.tally[CLAST_TALLY_DISSIPATION]},
                   {"source_absorbed", m->heat.tally[CLAST_TALLY_ABSORBED]},
                   {"source_delivered", m->source_delivered}};
    for (size_t s = 0; s < sizeof scalars / sizeof *scalars; s++)
        if (strcmp(scalars[s].name, name) == 0) {
            *to = scalars[s].value;
            return 1;
        }
    for (int t = 0; t < LEDGER_TERMS; t++)
        if (strcmp(ledger_terms[t], name) == 0) {
            *to = m->ledger[t];
            return 1;
        }
    if (strcmp(name, "stress") == 0) {
        for (int c = 0; c < 9; c++)
            to[c] = m->stress[c] / bed_volume(sim);
        return 9;
    }
    if (strcmp(name, "cluster_sizes") == 0) {
        memcpy(to, m->clusters.sizes, sizeof m->clusters.sizes);
        return CLUSTER_CLASSES;
    }
    memcpy(to, strcmp(name, "momentum") == 0 ? m->grains.momentum : m->grains.angular, 3 * sizeof *to);
    return 3;
}

/* Force and torque on every wall: the opposite of what it does to its grains, in the order of their ids; behind them the heat that it gives. */
static status put_walls(output *o, double *to, failure *why)
{
    live_contact *live = NULL;
    int64_t count;
    if (o->sim->scene->wall_count == 0)
        return STATUS_OK;
    double *heat = wall_heat_is_written(o->sim) ? to + 6 * o->sim->scene->wall_count : NULL;
    memset(to, 0, sizeof *to * (heat ? 7 : 6) * (size_t)o->sim->scene->wall_count);
    status result = observe_contacts(o->sim, true, &live, &count, why);
    for (int64_t k = 0; k < count && result == STATUS_OK; k++) {
        if (heat)
            heat[live[k].wall] += live[k].heat;
        for (int c = 0; c < 3; c++) {
            to[6 * live[k].wall + c] -= live[k].force[c];
            to[6 * live[k].wall + 3 + c] += live[k].torque_wall[c];
        }
    }
    free(live);
    return result;
}

/* Returns the end of what it has put. */
static double *put_poses(const output *o, double *to)
{
    const scene *scene = o->sim->scene;
    for (int w = 0; w < scene->wall_count; w++) {
        if (!scene_wall_moves(scene, w))
            continue;
        body_pose pose = simulation_wall_pose(o->sim, w);
        double arm[3];
        pose_point(&pose, wall_reference(&scene->wall[w]), to);
        for (int c = 0; c < 3; c++)
            arm[c] = to[c] - pose.pivot[c];
        for (int c = 0; c < 3; c++)
            to[3 + c] = pose.velocity[c] + pose.spin[(c + 1) % 3] * arm[(c + 2) % 3] - pose.spin[(c + 2) % 3] * arm[(c + 1) % 3];
        pose_quaternion(&pose, to + 6);
        to += 10;
    }
    return to;
}

/* Force on every group of walls: the sum over its walls, in their order. */
static void put_groups(const output *o, const double *walls, double *to)
{
    const scene *scene = o->sim->scene;
    memset(to, 0, sizeof *to * 3 * (size_t)scene->wall_group_count);
    for (int w = 0; w < scene->wall_count; w++)
        for (int c = 0; c < 3 && scene->wall[w].group >= 0; c++)
            to[3 * scene->wall[w].group + c] += walls[6 * w + c];
}

status output_observe(output *o, failure *why)
{
    measured m;
    memset(&m, 0, sizeof m);
    if (o->observable_count == 0)
        return STATUS_OK;
    TRY(observe_particle_sums(o->sim, &m.grains, why));
    if (o->wants_contacts)
        TRY(observe_contact_sums(o->sim, &m.contacts, why));
    TRY(bonds_count(o->sim, &m.bonds, why));
    if (o->wants_clusters)
        TRY(clusters_measure(o->sim, &m.clusters, why));
    if (o->wants_stress)
        TRY(observe_virial(o->sim, m.stress, why));
    if (o->wants_heat)
        TRY(heat_observe(o->sim, &m.heat, why));
    if (o->sim->all.law[SLOT_LEDGER])
        TRY(ledger_read(o->sim, m.ledger, why));
    m.source_delivered = o->sim->beams.delivered;
    double *to = o->value;
    for (int k = 0; k < o->sim->scene->output.observable_count; k++)
        to += put_observable(o, o->observable[k].name, &m, to);
    TRY(put_walls(o, to, why));
    double *end = put_poses(o, to + (wall_heat_is_written(o->sim) ? 7 : 6) * o->sim->scene->wall_count);
    put_groups(o, to, end);
    return results_observe(o->file, o->sim->step, o->sim->time, o->value, why);
}

status output_text(output *o, const char *name, const char *text, failure *why)
{
    return results_text(o->file, name, text, why);
}

status output_close(output *o, failure *why)
{
    if (!o)
        return STATUS_OK;
    status result = o->file ? results_close(o->file, why) : STATUS_OK;
    free(o->field);
    free(o->observable);
    free(o->wall_name);
    free(o->value);
    free(o->mass);
    free(o->radius);
    free(o->id);
    free(o->material);
    free(o->group);
    free(o);
    return result;
}
