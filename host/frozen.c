/* Heat while nothing moves (docs/theory.md, "Heat while nothing moves"). The kernels are kernels/stage/frozen.cl. */
#include "frozen.h"

#include "frozen_parts.h"
#include "laws/laws.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CHUNK 256
#define FINDINGS 4
/* Stages of a step at most: rows of tables are kept for each. */
#define STAGES_MAX 255
#define ROWS (STAGES_MAX + 1)
/* Share of the step that the number of stages allows for by the bound of the spectrum. */
#define STABLE_SHARE 0.95
#define EULER_SHARE 0.9

const char *frozen_method_name(heat_method method)
{
    static const char *const names[] = {"stabilised", "implicit", "steady", "explicit"};
    return names[method];
}

const scene_stage *frozen_stage(const simulation *sim)
{
    return &sim->scene->stage[sim->stage];
}

/* ---- the network ---- */

void frozen_forget(simulation *sim)
{
    sim->frozen.linked = false;
}

void frozen_restart(simulation *sim)
{
    frozen_heat *f = &sim->frozen;
    f->linked = false;
    f->low = f->high = f->next = f->limit = f->hottest = NAN;
    f->rate = INFINITY;
}

static void release_arrays(simulation *sim)
{
    frozen_heat *f = &sim->frozen;
    cl_mem *const grains[] = {&f->given, &f->start, &f->begin, &f->zero, &f->error, &f->rates, &f->rises[0], &f->rises[1], &f->rises[2]};
    store_release(sim, &f->link, f->link_bytes);
    store_release(sim, &f->conductance, f->link_bytes);
    for (size_t k = 0; k < sizeof grains / sizeof *grains; k++)
        store_release(sim, grains[k], f->grain_bytes);
    store_release(sim, &f->kept, 6 * f->grain_bytes);
    f->link_bytes = f->grain_bytes = 0;
}

void frozen_free(simulation *sim)
{
    frozen_solve_free(sim);
    release_arrays(sim);
}

static status fit_arrays(simulation *sim, failure *why)
{
    frozen_heat *f = &sim->frozen;
    uint64_t links = 8 * (uint64_t)sim->table.slots_held[sim->table.now], grains = 8 * (uint64_t)sim->stride;
    if (f->link && f->link_bytes >= links && (f->begin || !frozen_follows(sim)))
        return STATUS_OK;
    release_arrays(sim);
    frozen_solve_free(sim);
    f->link_bytes = links > 0 ? links : 8;
    f->grain_bytes = grains;
    TRY(store_buffer(sim, &f->link, f->link_bytes, "links of the contact network", why));
    TRY(store_buffer(sim, &f->conductance, f->link_bytes, "conductances", why));
    cl_mem *const arrays[] = {&f->given, &f->start, &f->zero, &f->error, &f->rates, &f->rises[0], &f->rises[1], &f->rises[2]};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++)
        TRY(store_buffer(sim, arrays[k], grains, "steps of heat", why));
    if (frozen_follows(sim))
        TRY(store_buffer(sim, &f->begin, grains, "rates at the start of a step", why));
    if (sim->all.law[SLOT_HEAT_TALLY])
        TRY(store_buffer(sim, &f->kept, 6 * grains, "heat by path of a step", why));
    return store_fill(sim, f->zero, grains, why);
}

status frozen_run_grains(simulation *sim, const char *name, int bound, failure *why)
{
    TRY(launch_bind(sim, name, bound, why));
    return launch_run(sim, launch_kernel(sim, name), name, sim->count, sim->block, why);
}

/* Heat of walls that give a prescribed flow, from the records' flows as they stand. */
static status find_given(simulation *sim, failure *why)
{
    clast_launch launch = launch_values(sim);
    contact_table *t = &sim->table;
    cl_kernel given = launch_kernel(sim, "heat_frozen_given");
    TRY(store_fill(sim, sim->frozen.given, sim->frozen.grain_bytes, why));
    if (!sim->live.law[SLOT_WALL_HEAT])
        return STATUS_OK;
    TRY(observe_flows(sim, why));
    TRY(launch_set(given, "heat_frozen_given", why, "Lmmm", &launch, t->other[t->now], sim->heat.walls, sim->frozen.given));
    return frozen_run_grains(sim, "heat_frozen_given", 4, why);
}

static status find_links(simulation *sim, failure *why)
{
    clast_launch launch = launch_values(sim);
    contact_table *t = &sim->table;
    frozen_heat *f = &sim->frozen;
    cl_kernel records = launch_kernel(sim, "heat_conductances"), links = launch_kernel(sim, "heat_frozen_links");
    TRY(launch_pass(records, "heat_conductances", &launch, why));
    TRY(launch_bind(sim, "heat_conductances", 1, why));
    TRY(launch_run(sim, records, "heat_conductances", t->record_count, sim->block, why));
    TRY(launch_set(links, "heat_frozen_links", why, "Lmmmm", &launch, t->owner[t->now], t->other[t->now], f->link, f->conductance));
    return frozen_run_grains(sim, "heat_frozen_links", 5, why);
}

/* One evaluation of the pairs gives all that the contacts do while nothing moves. */
status frozen_link(simulation *sim, failure *why)
{
    if (sim->frozen.linked)
        return STATUS_OK;
    if (sim->walls_move || sim->groups_move)
        return fail(why, STATUS_BAD_INPUT,
                    "%s: stage %s: motion is frozen, but a wall or a group of particles has a prescribed motion; stop it by `change` (motion: [] of a wall, "
                    "motion: fixed of particles)",
                    sim->scene->path, frozen_stage(sim)->name);
    TRY(simulation_pose_now(sim, why));
    TRY(fit_arrays(sim, why));
    TRY(find_given(sim, why));
    TRY(find_links(sim, why));
    if (sim->heat.vary && sim->heat.rows < ROWS) { /* fewer would not do for the batches of a stage that moves */
        TRY(heat_fit_rows(sim, ROWS, why));
        TRY(launch_bind_stages(sim, why)); /* the stages read these arrays as well */
    }
    sim->frozen.linked = true;
    return STATUS_OK;
}

/* ---- bounds ---- */

static void widen(const quantity *q, double *low, double *high)
{
    int count = q->kind == QUANTITY_NUMBER ? 1 : q->count;
    for (int k = 0; q->given && k < count; k++) {
        double value = q->kind == QUANTITY_NUMBER ? q->number[0] : q->value[k];
        *low = fmin(*low, value);
        *high = fmax(*high, value);
    }
}

bool frozen_is_heated(const simulation *sim)
{
    const scene *s = sim->scene;
    bool heated = sim->live.law[SLOT_SOURCE] || sim->live.law[SLOT_HEAT_GENERATION];
    for (int g = 0; g < s->group_count; g++)
        heated = heated || s->group[g].thermal == THERMAL_FLUX;
    for (int w = 0; sim->live.law[SLOT_WALL_HEAT] && w < s->wall_count; w++)
        heated = heated || wall_heat_kind_of(scene_wall_heat(s, sim->stage, w)) == WALL_HEAT_FLUX;
    return heated;
}

/* The interval spanned by the temperatures at the start of the stage and by those prescribed around the bed. */
static status find_interval(simulation *sim, failure *why)
{
    frozen_heat *f = &sim->frozen;
    const scene *s = sim->scene;
    heat_sums sums;
    if (!isnan(f->low))
        return STATUS_OK;
    TRY(heat_observe(sim, &sums, why));
    f->low = sums.lowest;
    f->high = sums.highest;
    if (sim->live.law[SLOT_ENVIRONMENT])
        widen(&s->environment.temperature_k, &f->low, &f->high);
    for (int w = 0; sim->live.law[SLOT_WALL_HEAT] && w < s->wall_count; w++)
        widen(&scene_wall_heat(s, sim->stage, w)->temperature_k, &f->low, &f->high);
    for (int g = 0; g < s->group_count; g++)
        if (s->group[g].thermal == THERMAL_PRESCRIBED)
            widen(&s->group[g].temperature, &f->low, &f->high);
    return STATUS_OK;
}

status frozen_range(simulation *sim, double *out, failure *why)
{
    TRY(find_interval(sim, why));
    *out = sim->frozen.high - sim->frozen.low;
    return STATUS_OK;
}

status frozen_find_limit(simulation *sim, failure *why)
{
    frozen_heat *f = &sim->frozen;
    clast_launch launch = launch_values(sim);
    int64_t chunks = (sim->count + CHUNK - 1) / CHUNK;
    cl_kernel kernel = launch_kernel(sim, "heat_frozen_spectrum");
    TRY(observe_partial(sim, chunks, why));
    TRY(launch_set(kernel, "heat_frozen_spectrum", why, sim->mixed ? "Lmmf" : "Lmmd", &launch, f->conductance, sim->partial, f->hottest));
    TRY(launch_bind(sim, "heat_frozen_spectrum", 4, why));
    TRY(launch_run(sim, kernel, "heat_frozen_spectrum", chunks, 1, why));
    double *partial = malloc(sizeof *partial * (size_t)(chunks + 1)), most = 0.0;
    if (!partial)
        return fail(why, STATUS_ERROR, "out of memory");
    status result = store_get(sim, sim->partial, FIELD_EXACT, 0, chunks, partial, why);
    for (int64_t n = 0; n < chunks && result == STATUS_OK; n++)
        most = fmax(most, partial[n]);
    free(partial);
    f->limit = most > 0.0 ? 1.0 / most : INFINITY;
    return result;
}

/* Where beds are heated they may become hotter than anything so far; and a wind that changes changes what it takes. */
static status keep_limit(simulation *sim, failure *why)
{
    frozen_heat *f = &sim->frozen;
    bool vary = sim->heat.vary && sim->live.law[SLOT_CONVECTION];
    if (!isnan(f->limit) && f->high <= f->hottest && !vary)
        return STATUS_OK;
    if (isnan(f->hottest) || f->high > f->hottest)
        f->hottest = frozen_is_heated(sim) ? 1.1 * f->high : f->high;
    return frozen_find_limit(sim, why);
}

status frozen_limit(simulation *sim, double *out, failure *why)
{
    TRY(frozen_link(sim, why));
    TRY(find_interval(sim, why));
    if (isnan(sim->frozen.hottest))
        sim->frozen.hottest = frozen_is_heated(sim) ? 1.1 * sim->frozen.high : sim->frozen.high;
    TRY(frozen_find_limit(sim, why));
    *out = sim->frozen.limit;
    return STATUS_OK;
}

/* ---- steps ---- */

/* Coefficients of the stages of RKL2 (Meyer, Balsara & Aslam 2014, Eqs. 16-18) or, with one stage, of Euler's method; and the weight that the
 * flows of each stage have in the step as a whole. Stage k leads from row k to row k + 1 of the tables. */
typedef struct scheme {
    int stages;
    double place[ROWS]; /* in the step */
    double mu[ROWS], nu[ROWS], slope[ROWS], start_slope[ROWS], weight[ROWS];
} scheme;

static double rkl_b(int j)
{
    return j < 2 ? 1.0 / 3.0 : (double)(j * j + j - 2) / (double)(2 * j * (j + 1));
}

static void weigh(scheme *c)
{
    double two[3][ROWS] = {{0}};
    for (int k = 0; k < c->stages; k++) {
        double *now = two[(k + 1) % 3], *last = two[k % 3], *before = two[(k + 2) % 3];
        for (int n = 0; n <= k; n++)
            now[n] = c->mu[k] * (n < k ? last[n] : 0.0) + c->nu[k] * (n < k - 1 ? before[n] : 0.0);
        now[k] += c->slope[k];
        now[0] += c->start_slope[k];
    }
    memcpy(c->weight, two[c->stages % 3], sizeof c->weight);
}

static void rkl2(scheme *c, int stages)
{
    double w = 4.0 / (double)(stages * stages + stages - 2);
    memset(c, 0, sizeof *c);
    c->stages = stages;
    c->slope[0] = rkl_b(1) * w;
    c->place[1] = c->slope[0];
    for (int j = 2; j <= stages; j++) {
        int k = j - 1;
        c->mu[k] = (double)(2 * j - 1) / j * rkl_b(j) / rkl_b(j - 1);
        c->nu[k] = -(double)(j - 1) / j * rkl_b(j) / rkl_b(j - 2);
        c->slope[k] = c->mu[k] * w;
        c->start_slope[k] = -(1.0 - rkl_b(j - 1)) * c->slope[k];
        c->place[j] = 0.25 * w * (double)(j * j + j - 2);
    }
    weigh(c);
}

static void euler(scheme *c)
{
    memset(c, 0, sizeof *c);
    c->stages = 1;
    c->slope[0] = c->weight[0] = c->place[1] = 1.0;
}

/* The odd number of stages under which a step is stable: odd ones damp better. */
static int stages_for(double step, double limit)
{
    double needed = isfinite(limit) ? 0.5 * (sqrt(9.0 + 16.0 * step / (STABLE_SHARE * limit)) - 1.0) : 3.0;
    int stages = needed < 3.0 ? 3 : (int)ceil(needed);
    return stages % 2 ? stages : stages + 1;
}

static double longest_step(double limit)
{
    return 0.25 * STABLE_SHARE * limit * (STAGES_MAX * STAGES_MAX + STAGES_MAX - 2);
}

/* What is prescribed at the times of the stages, a row each. */
status frozen_write_rows(simulation *sim, const double *place, int rows, double step, failure *why)
{
    double dt = sim->dt;
    if (!sim->heat.vary)
        return STATUS_OK;
    sim->dt = 0.0; /* groups: at these times, not a step later */
    for (int row = 0; row < rows; row++)
        heat_fill_row(sim, row, sim->time + place[row] * step);
    sim->dt = dt;
    return heat_write_rows(sim, rows, why);
}

status frozen_set_network(simulation *sim, cl_kernel kernel, const char *name, const clast_launch *launch, cl_mem rises, failure *why)
{
    frozen_heat *f = &sim->frozen;
    return launch_set(kernel, name, why, "Lmmmmm", launch, f->link, f->conductance, f->given, sim->heat.walls, rises);
}

/* All stages of one step; the rises at its end stand in rises[stages % 3]. */
static status run_stages(simulation *sim, const scheme *c, double step, failure *why)
{
    frozen_heat *f = &sim->frozen;
    clast_launch launch = launch_values(sim);
    cl_kernel kernel = launch_kernel(sim, "heat_frozen_stage");
    TRY(launch_bind(sim, "heat_frozen_stage", 17, why));
    for (int k = 0; k < c->stages; k++) {
        cl_mem last = k > 0 ? f->rises[k % 3] : f->zero, before = k > 1 ? f->rises[(k - 1) % 3] : f->zero;
        launch.heat_row = sim->heat.vary ? k : 0;
        TRY(frozen_set_network(sim, kernel, "heat_frozen_stage", &launch, last, why));
        TRY(launch_set_from(kernel, "heat_frozen_stage", 6, why, sim->mixed ? "mmmmfffffii" : "mmmmdddddii", before, f->rises[(k + 1) % 3], f->start,
                            f->kept, c->mu[k], c->nu[k], c->slope[k] * step, c->start_slope[k] * step, c->weight[k] * step,
                            (cl_int)(sim->heat.vary ? k + 1 : 0), (cl_int)(k == 0)));
        TRY(launch_run(sim, kernel, "heat_frozen_stage", sim->count, sim->block, why));
    }
    return STATUS_OK;
}

status frozen_fold(simulation *sim, cl_mem rises, cl_mem error, cl_mem rates, frozen_findings *out, failure *why)
{
    clast_launch launch = launch_values(sim);
    cl_kernel fold = launch_kernel(sim, "heat_frozen_findings");
    int64_t chunks = (sim->count + CHUNK - 1) / CHUNK;
    TRY(observe_partial(sim, FINDINGS * chunks, why));
    TRY(launch_set(fold, "heat_frozen_findings", why, "Lmmmm", &launch, rises, error, rates, sim->partial));
    TRY(launch_bind(sim, "heat_frozen_findings", 5, why));
    TRY(launch_run(sim, fold, "heat_frozen_findings", chunks, 1, why));
    double *partial = malloc(sizeof *partial * (size_t)(FINDINGS * chunks + 1));
    if (!partial)
        return fail(why, STATUS_ERROR, "out of memory");
    status result = store_get(sim, sim->partial, FIELD_EXACT, 0, FINDINGS * chunks, partial, why);
    *out = (frozen_findings){0.0, 0.0, -INFINITY, INFINITY};
    for (int64_t n = 0; n < chunks && result == STATUS_OK; n++) {
        out->error = fmax(out->error, partial[FINDINGS * n]);
        out->rate = fmax(out->rate, partial[FINDINGS * n + 1]);
        out->hottest = fmax(out->hottest, partial[FINDINGS * n + 2]);
        out->coldest = fmin(out->coldest, -partial[FINDINGS * n + 3]);
    }
    free(partial);
    return result;
}

static status look_at_step(simulation *sim, const scheme *c, double step, frozen_findings *out, failure *why)
{
    frozen_heat *f = &sim->frozen;
    clast_launch launch = launch_values(sim);
    cl_mem rises = f->rises[c->stages % 3];
    cl_kernel error = launch_kernel(sim, "heat_frozen_error");
    launch.heat_row = sim->heat.vary ? c->stages : 0;
    TRY(frozen_set_network(sim, error, "heat_frozen_error", &launch, rises, why));
    TRY(launch_set_from(error, "heat_frozen_error", 6, why, sim->mixed ? "mmmf" : "mmmd", frozen_rates_at_start(sim), f->error, f->rates, step));
    TRY(frozen_run_grains(sim, "heat_frozen_error", 10, why));
    return frozen_fold(sim, rises, f->error, f->rates, out, why);
}

status frozen_accept(simulation *sim, cl_mem rises, int row, bool all, failure *why)
{
    clast_launch launch = launch_values(sim);
    cl_kernel kernel = launch_kernel(sim, "heat_frozen_accept");
    if (frozen_follows(sim)) /* growth counts from the radii at the start */
        TRY(frozen_probe(sim, sim->frozen.zero, 1.0, why));
    launch.heat_row = sim->heat.vary ? row : 0;
    TRY(launch_set(kernel, "heat_frozen_accept", why, "Lmmi", &launch, rises, sim->frozen.kept, (cl_int)all));
    return frozen_run_grains(sim, "heat_frozen_accept", 4, why);
}

void frozen_count_step(simulation *sim, double step, double until, const frozen_findings *found)
{
    frozen_heat *f = &sim->frozen;
    sim->time = until;
    sim->step++;
    sim->stage_steps++;
    simulation_set_step(sim, step);
    f->rate = found->rate;
    if (frozen_is_heated(sim)) {
        f->high = fmax(f->high, found->hottest);
        f->low = fmin(f->low, found->coldest);
    }
}

static status accept(simulation *sim, const scheme *c, double step, double until, const frozen_findings *found, failure *why)
{
    TRY(frozen_accept(sim, sim->frozen.rises[c->stages % 3], c->stages, false, why));
    for (int k = 0; k < c->stages; k++)
        beams_deliver(sim, sim->time + c->place[k] * step, c->weight[k] * step);
    frozen_count_step(sim, step, until, found);
    return STATUS_OK;
}

/* Error that a step may make, K. */
double frozen_allowed_error(const simulation *sim)
{
    const frozen_heat *f = &sim->frozen;
    double range = f->high - f->low, least = frozen_is_heated(sim) ? 1e-2 * f->high : 1e-9 * f->high;
    return frozen_stage(sim)->heat_tolerance * fmax(range, least);
}

/* Rounding alone may carry a temperature past the ends of the interval. */
bool frozen_is_inside(const simulation *sim, const frozen_findings *found)
{
    const frozen_heat *f = &sim->frozen;
    double slack = (sim->mixed ? 1e-6 : 1e-12) * f->high;
    return frozen_is_heated(sim) || (found->hottest <= f->high + slack && found->coldest >= f->low - slack);
}

status frozen_give_up(const simulation *sim, double step, const frozen_findings *found, failure *why)
{
    return fail(why, STATUS_GUARD,
                "%s: stage %s: heat does not advance at t = %.9g s: a step of %.3g s still makes an error of %.3g K with temperatures from %.9g to %.9g K, "
                "allowed are %.3g K and %.9g to %.9g K; raise `tolerance`",
                sim->scene->path, frozen_stage(sim)->name, sim->time, step, found->error, found->coldest, found->hottest, frozen_allowed_error(sim),
                sim->frozen.low, sim->frozen.high);
}

/* The step ahead, so that it ends on `until` or leaves room for another like it. */
double frozen_fit_step(double step, double left)
{
    if (step >= left)
        return left;
    return step > 0.5 * left ? 0.5 * left : step;
}

static status run_rkl2(simulation *sim, scheme *c, double step, failure *why)
{
    rkl2(c, stages_for(step, sim->frozen.limit));
    TRY(frozen_write_rows(sim, c->place, c->stages + 1, step, why));
    return run_stages(sim, c, step, why);
}

/* Where conductances follow the temperatures, the step is taken with those of its start to find those of its middle, then with these. Its error
 * is looked at with the conductances of either end. *possible: not more stages than there may be, and no grain outgrows the table. */
static status try_step(simulation *sim, scheme *c, double step, frozen_findings *found, bool *possible, failure *why)
{
    *possible = true;
    TRY(run_rkl2(sim, c, step, why));
    if (frozen_follows(sim)) {
        TRY(frozen_keep_start(sim, why));
        TRY(frozen_look_up(sim, sim->frozen.rises[c->stages % 3], 0.5, why));
        *possible = step <= longest_step(sim->frozen.limit);
        if (!*possible)
            return STATUS_OK;
        TRY(run_rkl2(sim, c, step, why));
        TRY(frozen_look_up(sim, sim->frozen.rises[c->stages % 3], 1.0, why));
        TRY(frozen_fits_table(sim, possible, why));
    }
    return look_at_step(sim, c, step, found, why);
}

/* One step of RKL2 that meets the tolerance and the interval. The error of a step goes as its cube. */
static status stabilised_step(simulation *sim, double until, failure *why)
{
    frozen_heat *f = &sim->frozen;
    scheme c;
    frozen_findings found = {0};
    double left = until - sim->time, allowed = frozen_allowed_error(sim);
    if (isnan(f->next))
        f->next = isfinite(f->limit) ? f->limit : left;
    for (;;) {
        double step = frozen_fit_step(fmin(f->next, longest_step(f->limit)), left);
        bool possible;
        TRY(try_step(sim, &c, step, &found, &possible, why));
        bool inside = possible && frozen_is_inside(sim, &found);
        double growth = found.error > 0.0 ? 0.8 * cbrt(allowed / found.error) : 5.0;
        if (found.error <= allowed && inside) {
            double next = step * fmin(growth, 5.0);
            f->next = step < f->next ? fmax(next, f->next) : next;
            return accept(sim, &c, step, step == left ? until : sim->time + step, &found, why);
        }
        f->rejected++;
        TRY(frozen_take_back(sim, why));
        f->next = step * (inside ? fmax(fmin(growth, 0.8), 0.1) : 0.5);
        if (f->next < FROZEN_DWINDLED * fmin(f->limit, left))
            return frozen_give_up(sim, step, &found, why);
    }
}

/* Under Euler's method conductances are those of the start of a step; so no temperature may change by more than this share of the range. */
#define FOLLOWING_SHARE 0.01

static status follow_by_euler(simulation *sim, double *until, failure *why)
{
    frozen_heat *f = &sim->frozen;
    if (!frozen_follows(sim) || frozen_stage(sim)->heat_method != HEAT_EXPLICIT)
        return STATUS_OK;
    TRY(frozen_take_back(sim, why));
    double range = fmax(f->high - f->low, 1e-3 * f->high), most = FOLLOWING_SHARE * range / f->rate;
    double first = isfinite(f->rate) && f->rate > 0.0 ? most : FOLLOWING_SHARE * f->limit;
    if (isfinite(first) && sim->time + first < *until)
        *until = sim->time + first;
    return STATUS_OK;
}

static status explicit_step(simulation *sim, double until, failure *why)
{
    scheme c;
    frozen_findings found;
    double left = until - sim->time, step = frozen_fit_step(EULER_SHARE * sim->frozen.limit, left);
    euler(&c);
    TRY(frozen_write_rows(sim, c.place, c.stages + 1, step, why));
    TRY(run_stages(sim, &c, step, why));
    TRY(look_at_step(sim, &c, step, &found, why));
    return accept(sim, &c, step, step == left ? until : sim->time + step, &found, why);
}

static status take_step(simulation *sim, double until, failure *why)
{
    switch (frozen_stage(sim)->heat_method) {
    case HEAT_STEADY:
        return frozen_steady_step(sim, until, why);
    case HEAT_IMPLICIT:
        return frozen_implicit_step(sim, until, why);
    case HEAT_EXPLICIT:
        return explicit_step(sim, until, why);
    default:
        return stabilised_step(sim, until, why);
    }
}

status frozen_advance(simulation *sim, double until, int64_t most, failure *why)
{
    TRY(frozen_link(sim, why));
    TRY(find_interval(sim, why));
    for (int64_t n = 0; n < most && sim->time < until && sim->count > 0; n++) {
        TRY(keep_limit(sim, why));
        bool endless = !isfinite(until) && !isfinite(sim->frozen.limit);
        double end = endless ? sim->time + 1.0 : until;
        TRY(follow_by_euler(sim, &end, why));
        TRY(take_step(sim, end, why));
        TRY(frozen_follow_growth(sim, why));
    }
    return STATUS_OK;
}
