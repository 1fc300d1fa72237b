/* Heat on the device: constants of materials, tables of what surrounds the bed, walls and groups, and what is read back. */
#include "laws/laws.h"
#include "precision.h"
#include "simulation.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#define CHUNK 256
#define LIMITS 4
#define SUMS (5 + CLAST_TALLIES)

/* ---- tables ---- */

static const scene *scene_of(const simulation *sim)
{
    return sim->scene;
}

static int faces_of(const simulation *sim)
{
    return sim->all.law[SLOT_WALL_HEAT] ? sim->face_count : 0;
}

static int groups_of(const simulation *sim)
{
    return sim->all.law[SLOT_THERMAL_GROUPS] ? sim->scene->group_count : 0;
}

bool heat_varies(const simulation *sim)
{
    const scene *s = scene_of(sim);
    bool varies = false;
    if (!sim->all.law[SLOT_TEMPERATURE])
        return false;
    if (beams_vary(sim))
        return true;
    if (sim->live.law[SLOT_ENVIRONMENT])
        varies = quantity_varies_in_time(&s->environment.temperature_k) || quantity_varies_in_time(&s->environment.gas_velocity_m_s);
    for (int w = 0; sim->live.law[SLOT_WALL_HEAT] && w < s->wall_count; w++)
        varies = varies || quantity_varies_in_time(&scene_wall_heat(s, sim->stage, w)->temperature_k);
    for (int g = 0; g < groups_of(sim); g++)
        varies = varies || (s->group[g].thermal == THERMAL_PRESCRIBED && quantity_varies_in_time(&s->group[g].temperature));
    return varies;
}

static void fill_profile(const quantity *q, clast_profile *out)
{
    memset(out, 0, sizeof *out);
    if (!q->given || q->kind != QUANTITY_AXIS)
        return;
    out->axis = q->axis;
    out->count = q->count;
    for (int k = 0; k < q->count; k++) {
        out->at[k] = q->at[k];
        for (int c = 0; c < q->components; c++)
            out->value[c][k] = q->value[k * q->components + c];
    }
}

/* Rows of properties against temperature, as kernels/effect/tables.cl reads them. */
static status upload_tables(simulation *sim, failure *why)
{
    const scene *s = scene_of(sim);
    int64_t places = CLAST_TABLE_PLACES, count = 3 * places * (s->table_count > 0 ? s->table_count : 1);
    double *rows = calloc((size_t)count, sizeof *rows);
    if (!rows)
        return fail(why, STATUS_ERROR, "out of memory");
    for (int t = 0; t < s->table_count; t++) {
        const property_table *table = &s->property_table[t];
        double *row = rows + 3 * places * t;
        for (int p = 0; p < places; p++) {
            bool inside = p < table->count, next = p + 1 < table->count;
            row[p] = inside ? table->temperature_k[p] : 1e30;
            row[places + p] = table->value[inside ? p : table->count - 1];
            row[2 * places + p] = next ? (table->value[p + 1] - table->value[p]) / (table->temperature_k[p + 1] - table->temperature_k[p]) : 0.0;
        }
    }
    status result = store_buffer(sim, &sim->heat.tables, store_item(sim, FIELD_REAL) * (uint64_t)count, "properties by temperature", why);
    if (result == STATUS_OK)
        result = store_put(sim, sim->heat.tables, FIELD_REAL, 0, count, rows, why);
    free(rows);
    return result;
}

status heat_create(simulation *sim, failure *why)
{
    heat_tables *h = &sim->heat;
    const scene *s = scene_of(sim);
    if (!sim->all.law[SLOT_TEMPERATURE])
        return STATUS_OK;
    TRY(beams_create(sim, why));
    if (sim->all.law[SLOT_TABLES])
        TRY(upload_tables(sim, why));
    uint64_t constants = store_item(sim, FIELD_REAL) * (uint64_t)(live_grain_constant_count(&sim->all) * s->material_count);
    TRY(store_buffer(sim, &h->constants, constants, "constants of materials", why));
    if (sim->all.law[SLOT_WALL_HEAT] == &law_wall_flux)
        TRY(store_buffer(sim, &h->areas, 8 * (uint64_t)s->wall_count, "areas of contact of walls", why));
    if (sim->all.law[SLOT_ENVIRONMENT] != &law_environment_profile)
        return STATUS_OK;
    clast_profile profile[2];
    fill_profile(&s->environment.temperature_k, &profile[0]);
    fill_profile(&s->environment.gas_velocity_m_s, &profile[1]);
    TRY(store_buffer(sim, &h->profile, sizeof profile, "the environment", why));
    if (sim->mixed)
        precision_split_profiles(profile, 2, sim->origin);
    return store_write(sim, h->profile, 0, sizeof profile, profile, why);
}

static void release_rows(simulation *sim)
{
    heat_tables *h = &sim->heat;
    uint64_t rows = (uint64_t)h->rows;
    store_release(sim, &h->environment, sizeof *h->environment_rows * rows);
    store_release(sim, &h->walls, sizeof *h->wall_rows * (uint64_t)faces_of(sim) * rows);
    store_release(sim, &h->groups, sizeof *h->group_rows * (uint64_t)groups_of(sim) * rows);
    free(h->environment_rows);
    free(h->wall_rows);
    free(h->group_rows);
    h->environment_rows = NULL;
    h->wall_rows = NULL;
    h->group_rows = NULL;
}

void heat_free(simulation *sim)
{
    release_rows(sim);
    beams_free(sim);
    store_release(sim, &sim->heat.constants, 0);
    store_release(sim, &sim->heat.tables, 0);
    store_release(sim, &sim->heat.profile, 0);
    store_release(sim, &sim->heat.areas, 0);
}

static status fit_array(simulation *sim, cl_mem *mem, void **host, uint64_t bytes, const char *what, failure *why)
{
    if (bytes == 0)
        return STATUS_OK;
    *host = calloc(1, bytes);
    if (!*host)
        return fail(why, STATUS_ERROR, "out of memory");
    return store_buffer(sim, mem, bytes, what, why);
}

status heat_fit_rows(simulation *sim, int rows, failure *why)
{
    heat_tables *h = &sim->heat;
    if (!sim->all.law[SLOT_TEMPERATURE])
        return STATUS_OK;
    release_rows(sim);
    h->rows = rows;
    TRY(beams_fit_rows(sim, rows, why));
    uint64_t environments = sim->all.law[SLOT_ENVIRONMENT] ? (uint64_t)rows : 0;
    TRY(fit_array(sim, &h->environment, (void **)&h->environment_rows, sizeof *h->environment_rows * environments, "the environment", why));
    TRY(fit_array(sim, &h->walls, (void **)&h->wall_rows, sizeof *h->wall_rows * (uint64_t)(faces_of(sim) * rows), "heat of walls", why));
    return fit_array(sim, &h->groups, (void **)&h->group_rows, sizeof *h->group_rows * (uint64_t)(groups_of(sim) * rows), "heat of groups", why);
}

static double in_time(const quantity *q, double time, int component)
{
    return q->given && q->kind != QUANTITY_AXIS ? quantity_component(q, time, component) : 0.0;
}

static clast_environment environment_row(const scene *s, double time)
{
    const environment *e = &s->environment;
    clast_environment row = {.temperature = in_time(&e->temperature_k, time, 0)};
    for (int c = 0; c < 3; c++)
        row.gas_velocity[c] = in_time(&e->gas_velocity_m_s, time, c);
    return row;
}

/* Units in which areas of contact are summed: a sum of millions of the largest fits in 63 bits. */
#define QUANTA 1099511627776.0

static clast_wall_heat wall_row(const simulation *sim, int wall, double time)
{
    static const clast_i32 kinds[] = {CLAST_WALL_ADIABATIC, CLAST_WALL_TEMPERATURE, CLAST_WALL_FLUX};
    const wall_heat *heat = scene_wall_heat(sim->scene, sim->stage, wall);
    wall_heat_kind kind = wall_heat_kind_of(heat);
    return (clast_wall_heat){.temperature = kind == WALL_HEAT_TEMPERATURE ? quantity_at(&heat->temperature_k, time) : 0.0,
                             .flux = kind == WALL_HEAT_FLUX ? heat->flux_w : 0.0,
                             .quantum = QUANTA / (sim->radius_max * sim->radius_max),
                             .kind = kinds[kind],
                             .wall = wall};
}

static clast_group_heat group_row(const particle_group *group, double end)
{
    bool prescribed = group->thermal == THERMAL_PRESCRIBED;
    return (clast_group_heat){.temperature = prescribed ? quantity_at(&group->temperature, end) : 0.0,
                              .heat = group->thermal == THERMAL_FLUX ? group->heat_flux_w : 0.0,
                              .prescribed = prescribed};
}

void heat_fill_row(simulation *sim, int row, double time)
{
    heat_tables *h = &sim->heat;
    const scene *s = scene_of(sim);
    beams_fill_row(sim, row, time);
    if (h->environment_rows)
        h->environment_rows[row] = environment_row(s, time);
    for (int w = 0, face = 0; h->wall_rows && w < s->wall_count; w++)
        for (int f = 0; f < wall_face_count(&s->wall[w]); f++, face++)
            h->wall_rows[row * sim->face_count + face] = wall_row(sim, w, time);
    for (int g = 0; h->group_rows && g < s->group_count; g++)
        h->group_rows[row * s->group_count + g] = group_row(&s->group[g], time + sim->dt);
}

/* In place: rows are filled anew for every batch. */
static void split_rows(simulation *sim, int rows)
{
    heat_tables *h = &sim->heat;
    for (int r = 0; h->environment_rows && r < rows; r++)
        precision_split(h->environment_rows + r, sizeof *h->environment_rows / sizeof(double));
    for (int r = 0; h->wall_rows && r < rows * faces_of(sim); r++)
        precision_split(h->wall_rows + r, offsetof(clast_wall_heat, kind) / sizeof(double));
    for (int r = 0; h->group_rows && r < rows * groups_of(sim); r++)
        precision_split(h->group_rows + r, offsetof(clast_group_heat, prescribed) / sizeof(double));
}

status heat_write_rows(simulation *sim, int rows, failure *why)
{
    heat_tables *h = &sim->heat;
    if (sim->mixed)
        split_rows(sim, rows);
    TRY(beams_write_rows(sim, rows, why));
    if (h->environment_rows)
        TRY(store_write(sim, h->environment, 0, sizeof *h->environment_rows * (uint64_t)rows, h->environment_rows, why));
    if (h->wall_rows)
        TRY(store_write(sim, h->walls, 0, sizeof *h->wall_rows * (uint64_t)(faces_of(sim) * rows), h->wall_rows, why));
    if (h->group_rows)
        TRY(store_write(sim, h->groups, 0, sizeof *h->group_rows * (uint64_t)(groups_of(sim) * rows), h->group_rows, why));
    return STATUS_OK;
}

status heat_sum_areas(simulation *sim, const clast_launch *launch, failure *why)
{
    const contact_table *t = &sim->table;
    cl_kernel kernel = launch_kernel(sim, "heat_areas");
    if (!kernel)
        return STATUS_OK;
    TRY(launch_set(kernel, "heat_areas", why, "Lmmii", launch, sim->control, sim->heat.areas, (cl_int)t->wall_base,
                   (cl_int)(t->wall_base + t->wall_record_count)));
    TRY(launch_bind(sim, "heat_areas", 5, why));
    return launch_run(sim, kernel, "heat_areas", (int64_t)sim->scene->wall_count * sim->block, sim->block, why);
}

/* ---- stages ---- */

status heat_upload_constants(simulation *sim, int stage, failure *why)
{
    if (!sim->live.law[SLOT_TEMPERATURE])
        return STATUS_OK;
    int64_t count = (int64_t)live_grain_constant_count(&sim->live) * sim->scene->material_count;
    double *constants = malloc(sizeof *constants * (size_t)count);
    if (!constants)
        return fail(why, STATUS_ERROR, "out of memory");
    live_grain_constants(&sim->live, sim->scene, stage, constants);
    status result = store_put(sim, sim->heat.constants, FIELD_REAL, 0, count, constants, why);
    free(constants);
    return result;
}

/* Temperatures as generated; grains of thermal groups know theirs. */
status heat_upload_bed(simulation *sim, const bed *bed, failure *why)
{
    if (!sim->all.law[SLOT_TEMPERATURE])
        return STATUS_OK;
    double *temperature = malloc((size_t)sim->stride * sizeof *temperature);
    int32_t *group = malloc((size_t)sim->stride * sizeof *group);
    status result = temperature && group ? STATUS_OK : fail(why, STATUS_ERROR, "out of memory");
    for (int64_t i = 0; result == STATUS_OK && i < sim->stride; i++) {
        bool real = i < bed->count;
        temperature[i] = real ? bed->temperature[i] : 1.0;
        group[i] = real && sim->scene->group[bed->group[i]].thermal != THERMAL_FREE ? bed->group[i] : -1;
    }
    if (result == STATUS_OK)
        result = store_put_grains(sim, store_find(sim, "temperature"), sim->stride, temperature, why);
    if (result == STATUS_OK && store_find(sim, "thermal_group"))
        result = store_write(sim, store_find(sim, "thermal_group")->mem, 0, 4 * (uint64_t)sim->stride, group, why);
    free(temperature);
    free(group);
    return result;
}

/* ---- what is read back ---- */

/* Velocities stand half a step behind, and so does the heat of what is dissipated: what comes with the half step is in the records after a look at
 * velocities. */
static status look_ahead(simulation *sim, bool *ahead, failure *why)
{
    cl_mem velocity, spin;
    *ahead = sim->live.law[SLOT_DISSIPATION_HEAT] && !sim->live.law[SLOT_HEAT_STEPS] && live_keeps_half_steps(&sim->live) && sim->lag > 0.0;
    return *ahead ? observe_velocities(sim, &velocity, &spin, why) : STATUS_OK;
}

status heat_temperatures(simulation *sim, cl_mem *out, failure *why)
{
    bool ahead;
    clast_launch launch = launch_values(sim);
    *out = store_find(sim, "temperature")->mem;
    TRY(look_ahead(sim, &ahead, why));
    if (!ahead)
        return STATUS_OK;
    TRY(observe_partial(sim, sim->stride, why));
    TRY(launch_set(launch_kernel(sim, "heat_ahead"), "heat_ahead", why, "Lm", &launch, sim->partial));
    TRY(launch_bind(sim, "heat_ahead", 2, why));
    *out = sim->partial;
    return launch_run(sim, launch_kernel(sim, "heat_ahead"), "heat_ahead", sim->stride, sim->block, why);
}

status heat_observe(simulation *sim, heat_sums *out, failure *why)
{
    bool ahead;
    int64_t chunks = (sim->id_count + CHUNK - 1) / CHUNK;
    clast_launch launch = launch_values(sim);
    cl_kernel kernel = launch_kernel(sim, "heat_sums");
    double sum[SUMS] = {[3] = -INFINITY};
    *out = (heat_sums){.lowest = NAN, .mean = NAN, .highest = NAN};
    TRY(observe_where(sim, why));
    TRY(look_ahead(sim, &ahead, why));
    TRY(simulation_pose_now(sim, why));
    TRY(observe_partial(sim, chunks * SUMS, why));
    TRY(launch_set(kernel, "heat_sums", why, "Lmmii", &launch, sim->where, sim->partial, (cl_int)sim->id_count, (cl_int)ahead));
    TRY(launch_bind(sim, "heat_sums", 5, why));
    TRY(launch_run(sim, kernel, "heat_sums", chunks, 1, why));
    double *partial = malloc(sizeof *partial * (size_t)(chunks * SUMS + 1));
    if (!partial)
        return fail(why, STATUS_ERROR, "out of memory");
    status result = store_get(sim, sim->partial, FIELD_EXACT, 0, chunks * SUMS, partial, why);
    for (int64_t c = 0; c < chunks && result == STATUS_OK; c++)
        for (int q = 0; q < SUMS; q++) {
            double value = partial[c * SUMS + q];
            sum[q] = q == 3 || q == 4 ? fmax(sum[q], value) : sum[q] + value;
        }
    free(partial);
    TRY(result);
    out->content = sum[0];
    memcpy(out->tally, sum + 5, sizeof out->tally);
    if (sum[2] > 0.0) {
        out->mean = sum[1] / sum[2];
        out->lowest = -sum[3];
        out->highest = sum[4];
    }
    return STATUS_OK;
}

/* No surface can become hotter than this. */
static double hottest_possible(const simulation *sim, double highest)
{
    const scene *s = scene_of(sim);
    highest = fmax(highest, quantity_largest(&s->environment.temperature_k)); /* fmax passes over a NAN */
    for (int w = 0; w < s->wall_count; w++)
        highest = fmax(highest, quantity_largest(&scene_wall_heat(s, sim->stage, w)->temperature_k));
    for (int g = 0; g < s->group_count; g++)
        if (s->group[g].thermal == THERMAL_PRESCRIBED)
            highest = fmax(highest, quantity_largest(&s->group[g].temperature));
    return highest;
}

static status enqueue_limit(simulation *sim, double hottest, int64_t chunks, failure *why)
{
    clast_launch launch = launch_values(sim);
    cl_kernel records = launch_kernel(sim, "heat_conductances"), grains = launch_kernel(sim, "heat_limit");
    TRY(simulation_pose_now(sim, why));
    TRY(launch_pass(records, "heat_conductances", &launch, why));
    TRY(launch_bind(sim, "heat_conductances", 1, why));
    TRY(launch_run(sim, records, "heat_conductances", sim->table.record_count, sim->block, why));
    TRY(observe_partial(sim, LIMITS * chunks, why));
    TRY(launch_set(grains, "heat_limit", why, sim->mixed ? "Lmf" : "Lmd", &launch, sim->partial, hottest));
    TRY(launch_bind(sim, "heat_limit", 3, why));
    return launch_run(sim, grains, "heat_limit", chunks, 1, why);
}

status heat_limit_find(simulation *sim, heat_limit *out, failure *why)
{
    heat_sums sums;
    int64_t chunks = (sim->count + CHUNK - 1) / CHUNK;
    *out = (heat_limit){INFINITY, INFINITY, INFINITY, INFINITY, INFINITY};
    if (!sim->live.law[SLOT_TEMPERATURE] || sim->count == 0)
        return STATUS_OK;
    TRY(heat_observe(sim, &sums, why));
    TRY(enqueue_limit(sim, hottest_possible(sim, sums.highest), chunks, why));
    double *partial = malloc(sizeof *partial * (size_t)(LIMITS * chunks + 1)), least[LIMITS] = {INFINITY, INFINITY, INFINITY, INFINITY};
    if (!partial)
        return fail(why, STATUS_ERROR, "out of memory");
    status result = store_get(sim, sim->partial, FIELD_EXACT, 0, LIMITS * chunks, partial, why);
    for (int64_t n = 0; n < LIMITS * chunks && result == STATUS_OK; n++)
        if (partial[n] < 1e29)
            least[n % LIMITS] = fmin(least[n % LIMITS], partial[n]);
    free(partial);
    *out = (heat_limit){least[0], least[1], least[2], least[3], INFINITY};
    return result;
}

status heat_enqueue_coefficients(simulation *sim, failure *why)
{
    heat_sums sums;
    clast_launch launch = launch_values(sim);
    cl_kernel records = launch_kernel(sim, "heat_conductances"), grains = launch_kernel(sim, "heat_surfaces");
    TRY(heat_observe(sim, &sums, why));
    TRY(launch_pass(records, "heat_conductances", &launch, why));
    TRY(launch_bind(sim, "heat_conductances", 1, why));
    TRY(launch_run(sim, records, "heat_conductances", sim->table.record_count, sim->block, why));
    TRY(observe_partial(sim, sim->stride, why));
    TRY(launch_set(grains, "heat_surfaces", why, sim->mixed ? "Lmf" : "Lmd", &launch, sim->partial, hottest_possible(sim, sums.highest)));
    TRY(launch_bind(sim, "heat_surfaces", 3, why));
    return launch_run(sim, grains, "heat_surfaces", sim->count, sim->block, why);
}
