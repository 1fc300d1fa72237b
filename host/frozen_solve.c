/* Methods that solve for temperatures (docs/theory.md, "Heat while nothing moves"): steps of SDIRK2, and the steady state. Newton's method
 * outside, conjugate gradients on the device inside. */
#include "frozen_parts.h"
#include "laws/laws.h"
#include "property.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ITERATIONS_MAX 20000
/* Iterations between looks of the host. */
#define LOOK_EVERY 8
#define NEWTON_MAX 60
#define PICARD_MAX 60
/* Radiation's slope is a chord in so many iterations, until temperatures are near. */
#define CHORDS 4
/* Alexander 1977: both stages with this on the diagonal; stable for any step, and damping. */
#define GAMMA (1.0 - M_SQRT1_2)

static double reduction(const simulation *sim)
{
    return sim->mixed ? 1e-6 : 1e-12;
}

void frozen_solve_free(simulation *sim)
{
    frozen_heat *f = &sim->frozen;
    cl_mem *const arrays[] = {&f->fixed, &f->residual, &f->slope, &f->diagonal, &f->x, &f->p, &f->q};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++)
        store_release(sim, arrays[k], f->grain_bytes);
    store_release(sim, &f->scalar, 64);
}

static status fit_arrays(simulation *sim, failure *why)
{
    frozen_heat *f = &sim->frozen;
    if (f->scalar)
        return STATUS_OK;
    cl_mem *const arrays[] = {&f->fixed, &f->residual, &f->slope, &f->diagonal, &f->x, &f->p, &f->q};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++)
        TRY(store_buffer(sim, arrays[k], f->grain_bytes, "a linear system of temperatures", why));
    TRY(store_buffer(sim, &f->scalar, 64, "scalars of a linear system", why));
    return store_fill(sim, f->fixed, f->grain_bytes, why);
}

/* ---- conjugate gradients ---- */

static status run_blocks(simulation *sim, const char *name, failure *why)
{
    return launch_run(sim, launch_kernel(sim, name), name, sim->count, sim->block, why);
}

static status fold(simulation *sim, int what, failure *why)
{
    cl_kernel kernel = launch_kernel(sim, "heat_frozen_cg_fold");
    cl_int groups = (cl_int)((sim->count + sim->block - 1) / sim->block);
    TRY(launch_set(kernel, "heat_frozen_cg_fold", why, "mimi", sim->partial, groups, sim->frozen.scalar, (cl_int)what));
    return launch_run(sim, kernel, "heat_frozen_cg_fold", sim->block, sim->block, why);
}

static status bind_iteration(simulation *sim, failure *why)
{
    frozen_heat *f = &sim->frozen;
    contact_table *t = &sim->table;
    TRY(launch_set(launch_kernel(sim, "heat_frozen_cg_apply"), "heat_frozen_cg_apply", why, "mmmmmmmm", t->slot_offset[t->now], f->link, f->conductance,
                   f->slope, f->diagonal, f->p, f->q, sim->partial));
    TRY(launch_set(launch_kernel(sim, "heat_frozen_cg_update"), "heat_frozen_cg_update", why, "mmmmmmm", f->scalar, f->p, f->q, f->diagonal, f->x,
                   f->residual, sim->partial));
    return launch_set(launch_kernel(sim, "heat_frozen_cg_turn"), "heat_frozen_cg_turn", why, "mmmm", f->scalar, f->residual, f->diagonal, f->p);
}

static status iterate(simulation *sim, failure *why)
{
    TRY(run_blocks(sim, "heat_frozen_cg_apply", why));
    TRY(fold(sim, 1, why));
    TRY(run_blocks(sim, "heat_frozen_cg_update", why));
    TRY(fold(sim, 2, why));
    return run_blocks(sim, "heat_frozen_cg_turn", why);
}

/* x of the system with the residual as its right-hand side, until the residual has fallen by `to`. */
static status solve(simulation *sim, double to, failure *why)
{
    frozen_heat *f = &sim->frozen;
    cl_kernel begin = launch_kernel(sim, "heat_frozen_cg_begin");
    TRY(observe_partial(sim, (sim->count + sim->block - 1) / sim->block, why));
    TRY(launch_set(begin, "heat_frozen_cg_begin", why, "mmmmm", f->residual, f->diagonal, f->x, f->p, sim->partial));
    TRY(run_blocks(sim, "heat_frozen_cg_begin", why));
    TRY(fold(sim, 0, why));
    TRY(bind_iteration(sim, why));
    for (int n = 0; n < ITERATIONS_MAX; n += LOOK_EVERY) {
        double scalar[4];
        for (int k = 0; k < LOOK_EVERY; k++)
            TRY(iterate(sim, why));
        TRY(store_get(sim, f->scalar, FIELD_REAL, 0, 4, scalar, why));
        if (!(scalar[0] > to * to * scalar[3])) /* r z now and at first */
            return STATUS_OK;
    }
    return fail(why, STATUS_ERROR, "%s: stage %s: conjugate gradients do not converge in %d iterations", sim->scene->path, frozen_stage(sim)->name,
                ITERATIONS_MAX);
}

/* ---- Newton ---- */

static status find_residual(simulation *sim, cl_mem rises, cl_mem known, double sigma, int row, bool chord, failure *why)
{
    frozen_heat *f = &sim->frozen;
    clast_launch launch = launch_values(sim);
    cl_kernel kernel = launch_kernel(sim, "heat_frozen_residual");
    launch.heat_row = sim->heat.vary ? row : 0;
    TRY(frozen_set_network(sim, kernel, "heat_frozen_residual", &launch, rises, why));
    TRY(launch_set_from(kernel, "heat_frozen_residual", 6, why, sim->mixed ? "mmmmmfi" : "mmmmmdi", known, f->fixed, f->residual, f->slope, f->diagonal,
                        sigma, (cl_int)chord));
    return frozen_run_grains(sim, "heat_frozen_residual", 13, why);
}

/* Temperatures stay in the interval of all around them; where something heats them, positive; those to be `levelled` have no level yet. */
static status correct(simulation *sim, cl_mem rises, bool levelled, failure *why)
{
    frozen_heat *f = &sim->frozen;
    clast_launch launch = launch_values(sim);
    cl_kernel kernel = launch_kernel(sim, "heat_frozen_correct");
    bool heated = frozen_is_heated(sim);
    TRY(launch_set(kernel, "heat_frozen_correct", why, sim->mixed ? "Lmmff" : "Lmmdd", &launch, f->x, rises,
                   levelled ? -1e6 * f->high : heated ? 0.1 * f->low : f->low, heated ? 1e6 * f->high : f->high));
    return frozen_run_grains(sim, "heat_frozen_correct", 5, why);
}

/* Rises at which what flows in is what sigma stores of them beyond the known ones. *converged: the last correction was small enough. */
static status newton(simulation *sim, cl_mem rises, cl_mem known, double sigma, int row, bool levelled, bool *converged, failure *why)
{
    frozen_heat *f = &sim->frozen;
    bool linear = !sim->live.law[SLOT_RADIATION] && (sigma == 0.0 || !scene_has_material_table(sim->scene, &property_specific_heat));
    double least = (sim->mixed ? 2e-7 : 1e-12) * f->high;
    *converged = false;
    for (int n = 0; n < NEWTON_MAX && !*converged; n++) {
        frozen_findings found;
        TRY(find_residual(sim, rises, known, sigma, row, sigma == 0.0 && n < CHORDS, why));
        TRY(solve(sim, reduction(sim), why));
        TRY(correct(sim, rises, levelled, why));
        TRY(frozen_fold(sim, rises, f->x, f->zero, &found, why));
        if (!(found.error < 1e29))
            return STATUS_OK;
        *converged = found.error <= least || (linear && n > 0);
    }
    return STATUS_OK;
}

static status hold(simulation *sim, cl_mem rises, int row, failure *why)
{
    clast_launch launch = launch_values(sim);
    cl_kernel kernel = launch_kernel(sim, "heat_frozen_hold");
    launch.heat_row = sim->heat.vary ? row : 0;
    TRY(launch_set(kernel, "heat_frozen_hold", why, "Lm", &launch, rises));
    return frozen_run_grains(sim, "heat_frozen_hold", 2, why);
}

/* ---- clusters without a sink ---- */

typedef struct clusters {
    int64_t *root, links;
    int32_t *link, *fixed;
    uint32_t *slot_offset;
    double *conductance, *sink, *capacity, *source, *temperature;
    double *sums;    /* of each root: sink, capacity, its product with temperature, source, sizes of the sources */
    double *end;     /* temperature that each root's cluster comes to without a sink */
    int32_t *material;
    bool levelled;   /* some cluster has no sink, and what heats it in one place cools it in another */
} clusters;

#define CLUSTER_SUMS 5

static void clusters_free(clusters *c)
{
    void *const all[] = {c->root, c->link, c->fixed, c->slot_offset, c->conductance, c->sink, c->capacity, c->source, c->temperature, c->sums, c->end, c->material};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        free(all[k]);
}

static int64_t root_of(clusters *c, int64_t i)
{
    while (c->root[i] != i)
        i = c->root[i] = c->root[c->root[i]];
    return i;
}

static status read_clusters(simulation *sim, clusters *c, failure *why)
{
    frozen_heat *f = &sim->frozen;
    contact_table *t = &sim->table;
    clast_launch launch = launch_values(sim);
    cl_kernel kernel = launch_kernel(sim, "heat_frozen_sinks");
    size_t n = (size_t)sim->stride, blocks = n / sim->block;
    TRY(frozen_set_network(sim, kernel, "heat_frozen_sinks", &launch, f->zero, why));
    TRY(launch_set_from(kernel, "heat_frozen_sinks", 6, why, "mmm", f->residual, f->slope, f->diagonal));
    TRY(frozen_run_grains(sim, "heat_frozen_sinks", 9, why));
    c->slot_offset = malloc(sizeof *c->slot_offset * (blocks + 1));
    if (!c->slot_offset)
        return fail(why, STATUS_ERROR, "out of memory");
    TRY(store_read(sim, t->slot_offset[t->now], 0, sizeof *c->slot_offset * (blocks + 1), c->slot_offset, why));
    c->links = c->slot_offset[blocks];
    c->root = malloc(sizeof *c->root * n);
    c->fixed = calloc(n, sizeof *c->fixed);
    c->link = malloc(sizeof *c->link * (size_t)(c->links + 1));
    c->conductance = malloc(sizeof *c->conductance * (size_t)(c->links + 1));
    double **const grains[] = {&c->sink, &c->capacity, &c->source, &c->temperature};
    for (int k = 0; k < 4; k++)
        *grains[k] = malloc(sizeof(double) * n);
    c->sums = calloc(CLUSTER_SUMS * n, sizeof *c->sums);
    c->end = malloc(sizeof *c->end * n);
    c->material = calloc(n, sizeof *c->material);
    if (!c->end || !c->material || !c->root || !c->fixed || !c->link || !c->conductance || !c->sink || !c->capacity || !c->source || !c->temperature || !c->sums)
        return fail(why, STATUS_ERROR, "out of memory");
    TRY(store_read(sim, f->link, 0, sizeof *c->link * (size_t)c->links, c->link, why));
    TRY(store_get(sim, f->conductance, FIELD_REAL, 0, c->links, c->conductance, why));
    TRY(store_get(sim, f->residual, FIELD_REAL, 0, sim->count, c->sink, why));
    TRY(store_get(sim, f->slope, FIELD_REAL, 0, sim->count, c->capacity, why));
    TRY(store_get(sim, f->diagonal, FIELD_REAL, 0, sim->count, c->source, why));
    if (store_find(sim, "material"))
        TRY(store_read(sim, store_find(sim, "material")->mem, 0, sizeof *c->material * (uint64_t)sim->count, c->material, why));
    return store_get_grains(sim, store_find(sim, "temperature"), sim->count, c->temperature, why);
}

static void join_clusters(const simulation *sim, clusters *c)
{
    for (int64_t i = 0; i < sim->count; i++)
        c->root[i] = i;
    for (int64_t i = 0; i < sim->count; i++)
        for (uint32_t s = c->slot_offset[i / sim->block] + (uint32_t)(i % sim->block); s < c->slot_offset[i / sim->block + 1]; s += sim->block)
            if (c->link[s] >= 0 && c->conductance[s] > 0.0) {
                int64_t a = root_of(c, i), b = root_of(c, c->link[s]);
                c->root[a > b ? a : b] = a > b ? b : a;
            }
    for (int64_t i = 0; i < sim->count; i++) {
        double *sum = c->sums + CLUSTER_SUMS * root_of(c, i);
        sum[0] += c->sink[i];
        sum[1] += c->capacity[i];
        sum[2] += c->capacity[i] * c->temperature[i];
        sum[3] += c->source[i];
        sum[4] += fabs(c->source[i]);
    }
}

/* What the cluster of every root would hold more than now at the temperature of `end`, J. */
static void find_excess(const simulation *sim, clusters *c, double *excess)
{
    memset(excess, 0, sizeof *excess * (size_t)sim->count);
    for (int64_t i = 0; i < sim->count; i++) {
        int64_t root = root_of(c, i);
        double from = c->temperature[i], mass = c->capacity[i] / specific_heat_at(sim->scene, c->material[i], from);
        excess[root] += mass * specific_heat_between(sim->scene, c->material[i], from, c->end[root]);
    }
}

#define HALVINGS 64

/* The mean by heat capacity; where specific heats depend on temperature, the one temperature at which a cluster holds what its grains hold now,
 * between the coldest and the hottest of them. */
static status find_ends(const simulation *sim, clusters *c, failure *why)
{
    size_t n = (size_t)sim->count + 1;
    double *excess = malloc(3 * n * sizeof *excess), *low = excess + n, *high = low + n;
    if (!excess)
        return fail(why, STATUS_ERROR, "out of memory");
    for (int64_t i = 0; i < sim->count; i++) {
        c->end[i] = c->sums[CLUSTER_SUMS * i + 1] > 0.0 ? c->sums[CLUSTER_SUMS * i + 2] / c->sums[CLUSTER_SUMS * i + 1] : 0.0;
        low[i] = INFINITY;
        high[i] = 0.0;
    }
    for (int64_t i = 0; i < sim->count; i++) {
        int64_t root = root_of(c, i);
        low[root] = fmin(low[root], c->temperature[i]);
        high[root] = fmax(high[root], c->temperature[i]);
    }
    bool tabled = scene_has_material_table(sim->scene, &property_specific_heat);
    for (int k = 0; tabled && k < HALVINGS; k++) {
        for (int64_t i = 0; i < sim->count; i++)
            c->end[i] = 0.5 * (low[i] + high[i]);
        find_excess(sim, c, excess);
        for (int64_t i = 0; i < sim->count; i++)
            *(excess[i] > 0.0 ? &high[i] : &low[i]) = c->end[i];
    }
    free(excess);
    return STATUS_OK;
}

/* What a cluster without a sink gains, W; 0 where its sources balance but for rounding. */
static double cluster_gain(const simulation *sim, const double *sum)
{
    double rounding = (sim->mixed ? 1e-5 : 1e-10) * sum[4];
    return sum[0] > 0.0 || fabs(sum[3]) <= rounding ? 0.0 : sum[3];
}

/* Rises to the end of clusters that have no sink, which are then fixed; one that is heated has no steady state. Where sources balance, flows settle
 * and the level is that of the heat there is: one grain is fixed meanwhile. */
static status sort_out(simulation *sim, clusters *c, cl_mem rises, failure *why)
{
    double *rise = calloc((size_t)sim->stride, sizeof *rise);
    status result = rise ? STATUS_OK : fail(why, STATUS_ERROR, "out of memory");
    for (int64_t i = 0; i < sim->count && result == STATUS_OK; i++) {
        int64_t root = root_of(c, i);
        const double *sum = c->sums + CLUSTER_SUMS * root;
        bool balanced = sum[4] > 0.0;
        if (sum[0] > 0.0)
            continue;
        c->levelled = c->levelled || balanced;
        c->fixed[i] = !balanced || i == root;
        rise[i] = balanced ? 0.0 : c->end[root] - c->temperature[i];
        if (cluster_gain(sim, sum) != 0.0)
            result = fail(why, STATUS_BAD_INPUT,
                          "%s: stage %s: there is no steady state: a cluster of particles gains %.4g W and touches no wall with a temperature, nor does "
                          "anything else take heat from it; give it a sink, or heat it for a time by `method: stabilised`",
                          sim->scene->path, frozen_stage(sim)->name, sum[3]);
    }
    if (result == STATUS_OK)
        result = store_put(sim, rises, FIELD_REAL, 0, sim->count, rise, why);
    if (result == STATUS_OK)
        result = store_write(sim, sim->frozen.fixed, 0, sizeof *c->fixed * (uint64_t)sim->count, c->fixed, why);
    free(rise);
    return result;
}

static status settle_clusters(simulation *sim, clusters *c, cl_mem rises, failure *why)
{
    TRY(read_clusters(sim, c, why));
    join_clusters(sim, c);
    TRY(find_ends(sim, c, why));
    return sort_out(sim, c, rises, why);
}

/* What each root's cluster would hold more than before, J, with the rises and a shift of its own. */
static void find_gain(const simulation *sim, clusters *c, const double *rise, const double *shift, double *gain)
{
    memset(gain, 0, sizeof *gain * (size_t)sim->count);
    for (int64_t i = 0; i < sim->count; i++) {
        int64_t root = root_of(c, i);
        double from = c->temperature[i], mass = c->capacity[i] / specific_heat_at(sim->scene, c->material[i], from);
        gain[root] += mass * specific_heat_between(sim->scene, c->material[i], from, from + rise[i] + shift[root]);
    }
}

/* The shift with which a cluster holds what it held: at the largest of its rises turned around it holds less, at the smallest more, and its heat
 * content grows with every temperature. */
static void find_shifts(const simulation *sim, clusters *c, const double *rise, double *shift)
{
    double *gain = shift + sim->count, *low = gain + sim->count, *high = low + sim->count;
    for (int64_t i = 0; i < sim->count; i++)
        low[i] = high[i] = -rise[i];
    for (int64_t i = 0; i < sim->count; i++) {
        int64_t root = root_of(c, i);
        low[root] = fmin(low[root], -rise[i]);
        high[root] = fmax(high[root], -rise[i]);
    }
    for (int k = 0; k < HALVINGS; k++) {
        for (int64_t i = 0; i < sim->count; i++)
            shift[i] = 0.5 * (low[i] + high[i]);
        find_gain(sim, c, rise, shift, gain);
        for (int64_t i = 0; i < sim->count; i++)
            *(gain[i] > 0.0 ? &high[i] : &low[i]) = shift[i];
    }
}

static status level(simulation *sim, clusters *c, double *rise, double *shift, failure *why)
{
    find_shifts(sim, c, rise, shift);
    for (int64_t i = 0; i < sim->count; i++) {
        int64_t root = root_of(c, i);
        const double *sum = c->sums + CLUSTER_SUMS * root;
        if (sum[0] > 0.0 || !(sum[4] > 0.0))
            continue;
        rise[i] += shift[root];
        if (!(c->temperature[i] + rise[i] > 0.0))
            return fail(why, STATUS_BAD_INPUT,
                        "%s: stage %s: there is no steady state: the heat that flows through a cluster of particles without a sink would take one of them "
                        "to %.4g K; let less heat flow, or give the cluster a wall with a temperature",
                        sim->scene->path, frozen_stage(sim)->name, c->temperature[i] + rise[i]);
    }
    return STATUS_OK;
}

static status level_clusters(simulation *sim, clusters *c, cl_mem rises, failure *why)
{
    if (!c->levelled)
        return STATUS_OK;
    double *work = malloc(5 * ((size_t)sim->count + 1) * sizeof *work), *rise = work + 4 * sim->count;
    status result = work ? store_get(sim, rises, FIELD_REAL, 0, sim->count, rise, why) : fail(why, STATUS_ERROR, "out of memory");
    if (result == STATUS_OK)
        result = level(sim, c, rise, work, why);
    if (result == STATUS_OK)
        result = store_put(sim, rises, FIELD_REAL, 0, sim->count, rise, why);
    free(work);
    return result;
}

status frozen_refuse_endless(simulation *sim, failure *why)
{
    const scene_stage *stage = frozen_stage(sim);
    clusters c = {0};
    bool ends = !isnan(stage->until_time_s) || stage->until_steps >= 0, changes = sim->heat.vary || frozen_follows(sim);
    if (isnan(stage->until_steady_k_s) || ends || changes || stage->heat_method == HEAT_STEADY)
        return STATUS_OK;
    TRY(fit_arrays(sim, why));
    status result = read_clusters(sim, &c, why);
    if (result == STATUS_OK)
        join_clusters(sim, &c);
    for (int64_t i = 0; i < sim->count && result == STATUS_OK; i++) {
        const double *sum = c.sums + CLUSTER_SUMS * i;
        double rate = sum[1] > 0.0 ? fabs(cluster_gain(sim, sum)) / sum[1] : 0.0;
        if (rate >= stage->until_steady_k_s)
            result = fail(why, STATUS_BAD_INPUT,
                          "%s:%d:%d: stage %s: `until: {steady_k_s: %g}` is never met: a cluster of particles gains %.4g W and touches no wall with a temperature, "
                          "nor does anything else take heat from it, so that it changes by %.4g K/s for good; give it a sink, or end the stage by `time_s`",
                          sim->scene->path, stage->at.line, stage->at.column, stage->name, stage->until_steady_k_s, sum[3], rate);
    }
    clusters_free(&c);
    frozen_solve_free(sim);
    return result;
}

/* ---- the steady state ---- */

/* Rises to the steady state with the conductances as they stand. */
static status find_steady(simulation *sim, cl_mem rises, bool *converged, failure *why)
{
    clusters c = {0};
    TRY(store_fill(sim, rises, sim->frozen.grain_bytes, why));
    status result = settle_clusters(sim, &c, rises, why);
    if (result == STATUS_OK)
        result = hold(sim, rises, 0, why);
    if (result == STATUS_OK)
        result = newton(sim, rises, sim->frozen.zero, 0.0, 0, c.levelled, converged, why);
    if (result == STATUS_OK)
        result = level_clusters(sim, &c, rises, why);
    clusters_free(&c);
    return result;
}

/* The steady state for what is prescribed at the end; without `time_s` at this moment, and no time passes. In mixed precision temperatures are
 * rebased and solved for again: floats hold the last corrections, not the whole rise. */
status frozen_steady_step(simulation *sim, double until, failure *why)
{
    frozen_heat *f = &sim->frozen;
    bool timeless = isnan(frozen_stage(sim)->until_time_s), converged = false;
    double end = timeless ? sim->time : until;
    const double place[1] = {1.0};
    bool follows = frozen_follows(sim), settled = !follows;
    int passes = follows ? PICARD_MAX : sim->mixed ? 3 : 1;
    TRY(frozen_write_rows(sim, place, 1, end - sim->time, why));
    for (int pass = 0; pass < passes; pass++) {
        frozen_findings moved;
        TRY(fit_arrays(sim, why));
        cl_mem rises = f->rises[0];
        TRY(find_steady(sim, rises, &converged, why));
        if (sim->live.law[SLOT_HEAT_TALLY])
            TRY(store_fill(sim, f->kept, 6 * f->grain_bytes, why));
        TRY(frozen_fold(sim, rises, rises, f->zero, &moved, why));
        TRY(frozen_accept(sim, rises, 0, true, why));
        if (follows) { /* Picard: conductances of the temperatures found, until those stand */
            settled = pass > 0 && moved.error <= (sim->mixed ? 1e-6 : 1e-11) * f->high;
            if (settled)
                break;
            f->linked = false;
            TRY(frozen_follow_growth(sim, why));
            TRY(frozen_link(sim, why));
        }
    }
    if (!(converged && settled) && !sim->mixed)
        return fail(why, STATUS_ERROR, "%s: stage %s: no steady state was found in %d iterations", sim->scene->path, frozen_stage(sim)->name,
                    converged ? PICARD_MAX : NEWTON_MAX);
    const frozen_findings none = {0.0, 0.0, f->high, f->low};
    frozen_count_step(sim, end > sim->time ? end - sim->time : sim->dt, end, &none);
    return STATUS_OK;
}

/* ---- implicit steps ---- */

/* Evaluates the flows at the rises: for the tally with their weight, and, first, the rates at the start. */
static status weigh_flows(simulation *sim, cl_mem rises, int row, double weight, bool first, failure *why)
{
    frozen_heat *f = &sim->frozen;
    clast_launch launch = launch_values(sim);
    cl_kernel kernel = launch_kernel(sim, "heat_frozen_stage");
    launch.heat_row = sim->heat.vary ? row : 0;
    TRY(frozen_set_network(sim, kernel, "heat_frozen_stage", &launch, rises, why));
    TRY(launch_set_from(kernel, "heat_frozen_stage", 6, why, sim->mixed ? "mmmmfffffii" : "mmmmdddddii", f->zero, f->q, f->start, f->kept, 0.0, 0.0, 0.0,
                        0.0, weight, (cl_int)(sim->heat.vary ? row : 0), (cl_int)first));
    return frozen_run_grains(sim, "heat_frozen_stage", 17, why);
}

/* The error against the trapezoidal rule, and what a step damps taken out of it: (1 - gamma dt J) e = defect. */
static status find_error(simulation *sim, cl_mem rises, double step, frozen_findings *out, failure *why)
{
    frozen_heat *f = &sim->frozen;
    clast_launch launch = launch_values(sim);
    cl_kernel error = launch_kernel(sim, "heat_frozen_error"), capacity = launch_kernel(sim, "heat_frozen_store");
    launch.heat_row = sim->heat.vary ? 2 : 0;
    TRY(frozen_set_network(sim, error, "heat_frozen_error", &launch, rises, why));
    TRY(launch_set_from(error, "heat_frozen_error", 6, why, sim->mixed ? "mmmf" : "mmmd", frozen_rates_at_start(sim), f->error, f->rates, step));
    TRY(frozen_run_grains(sim, "heat_frozen_error", 10, why));
    TRY(find_residual(sim, rises, f->zero, 1.0 / (GAMMA * step), 2, false, why));
    TRY(launch_set(capacity, "heat_frozen_store", why, sim->mixed ? "Lmmmf" : "Lmmmd", &launch, f->error, f->diagonal, f->residual, 1.0 / (GAMMA * step)));
    TRY(frozen_run_grains(sim, "heat_frozen_store", 5, why));
    TRY(solve(sim, 1e-3, why));
    return frozen_fold(sim, rises, f->x, f->rates, out, why);
}

/* The two stages with the conductances as they stand; the rises at the end stand in rises[2]. */
static status run_stages(simulation *sim, double step, bool *converged, failure *why)
{
    frozen_heat *f = &sim->frozen;
    double sigma = 1.0 / (GAMMA * step);
    cl_kernel known = launch_kernel(sim, "heat_frozen_scale");
    clast_launch launch = launch_values(sim);
    cl_mem first = f->rises[1], second = f->rises[2];
    TRY(weigh_flows(sim, f->zero, 0, 0.0, true, why));
    TRY(store_fill(sim, first, f->grain_bytes, why));
    TRY(hold(sim, first, 1, why));
    TRY(newton(sim, first, f->zero, sigma, 1, false, converged, why));
    if (!*converged)
        return STATUS_OK;
    TRY(weigh_flows(sim, first, 1, (1.0 - GAMMA) * step, false, why));
    TRY(launch_set(known, "heat_frozen_scale", why, sim->mixed ? "Lmmf" : "Lmmd", &launch, first, f->rises[0], (1.0 - GAMMA) / GAMMA));
    TRY(frozen_run_grains(sim, "heat_frozen_scale", 4, why));
    TRY(store_copy(sim, first, second, 0, 0, f->grain_bytes, why));
    TRY(hold(sim, second, 2, why));
    TRY(newton(sim, second, f->rises[0], sigma, 2, false, converged, why));
    return *converged ? weigh_flows(sim, second, 2, GAMMA * step, false, why) : STATUS_OK;
}

/* As the stabilised method does (frozen.c): where conductances follow the temperatures, a step with those of its start finds those of its middle. */
static status try_step(simulation *sim, double step, frozen_findings *found, failure *why)
{
    bool converged, fits = true;
    *found = (frozen_findings){1e30, 0.0, 0.0, 0.0};
    TRY(run_stages(sim, step, &converged, why));
    if (converged && frozen_follows(sim)) {
        TRY(frozen_keep_start(sim, why));
        TRY(frozen_look_up(sim, sim->frozen.rises[2], 0.5, why));
        TRY(run_stages(sim, step, &converged, why));
        if (converged)
            TRY(frozen_look_up(sim, sim->frozen.rises[2], 1.0, why));
        TRY(frozen_fits_table(sim, &fits, why));
    }
    if (!fits) {
        found->error = 8.0 * frozen_allowed_error(sim); /* two fifths of the step */
        return STATUS_OK;
    }
    return converged ? find_error(sim, sim->frozen.rises[2], step, found, why) : STATUS_OK;
}

status frozen_implicit_step(simulation *sim, double until, failure *why)
{
    frozen_heat *f = &sim->frozen;
    const double place[3] = {0.0, GAMMA, 1.0};
    double left = until - sim->time, allowed = frozen_allowed_error(sim);
    TRY(fit_arrays(sim, why));
    TRY(store_fill(sim, f->fixed, f->grain_bytes, why));
    if (isnan(f->next))
        f->next = isfinite(f->limit) ? f->limit : left;
    for (;;) {
        double step = frozen_fit_step(f->next, left);
        frozen_findings found;
        TRY(frozen_write_rows(sim, place, 3, step, why));
        TRY(try_step(sim, step, &found, why));
        double growth = found.error > 0.0 ? 0.8 * cbrt(allowed / found.error) : 5.0;
        if (found.error <= allowed && frozen_is_inside(sim, &found)) {
            double next = step * fmin(growth, 5.0);
            f->next = step < f->next ? fmax(next, f->next) : next;
            TRY(frozen_accept(sim, f->rises[2], 2, false, why));
            beams_deliver(sim, sim->time + GAMMA * step, (1.0 - GAMMA) * step);
            beams_deliver(sim, sim->time + step, GAMMA * step);
            frozen_count_step(sim, step, step == left ? until : sim->time + step, &found);
            return STATUS_OK;
        }
        f->rejected++;
        TRY(frozen_take_back(sim, why));
        f->next = step * (found.error > allowed ? fmax(fmin(growth, 0.8), 0.1) : 0.5);
        if (f->next < FROZEN_DWINDLED * fmin(f->limit, left))
            return frozen_give_up(sim, step, &found, why);
    }
}
