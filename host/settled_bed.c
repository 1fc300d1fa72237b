/* A grain that leans on a frictionless wall is in the very state of one that leans on its own mirror image: half the effective modulus,
 * half the effective radius and twice the overlap give the same Hertz force. So a part that has settled between frictionless sides, as high
 * as the whole bed, fits its mirror images without a gap and stays at rest among them. */
#include "settled_bed.h"

#include "bundle.h"
#include "cache.h"
#include "clock.h"
#include "simulation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CACHE_VERSION  1 /* counts on when beds of the same name would differ */

#define RADIUS_M       1.0e-3
#define RADIUS_SPREAD  0.1
#define MODULUS_PA     5.0e6
#define SETTLED        0.6 /* volume fraction, as the box is laid out */
#define POURED         0.5
#define POURED_MIXED   0.45 /* of grains of two sizes */
#define PART_LEAST     8000
#define PART_MOST      20000
#define PART_WANTED    15000.0
#define GRAVITY        9.81
#define REST           1.0e-7 /* kinetic energy as a fraction of the sum of m g r; without its history a bed moves more than that */
#define SETTLE_MAX_S   3.0
#define SETTLE_CHECK   500  /* steps between looks at the energy */
#define SETTLE_DAMPING 20.0 /* 1/s */
#define MIXED_DAMPING  40.0 /* small grains fall on between large ones */
#define MIXED_REST     1.0e-3 /* of which a few still roll through pores */
#define REST_DAMPING   600.0 /* 1/s, of a bed with bonds that is taken up without the history of its friction: critical for the slowest waves in it */
#define BONDING_STRAIN 0.055 /* of 100,000 grains */

static const bed_sizes all_alike = {.ratio = 1.0, .large_share = 0.0};

static int64_t large_of(const bed_sizes *sizes, int64_t particles)
{
    return llround(sizes->large_share * (double)particles);
}

/* Sum of volumes of so many grains on average: <r^3> of the uniform distribution. */
static double solid_volume(double particles, const bed_sizes *sizes)
{
    double mean_cube = 1.0 + sizes->large_share * (pow(sizes->ratio, 3) - 1.0);
    return particles * mean_cube * 4.0 / 3.0 * M_PI * pow(RADIUS_M, 3) * (1.0 + RADIUS_SPREAD * RADIUS_SPREAD);
}

static double layout_cost(int64_t particles, int columns, int rows, int64_t part)
{
    double cost = log((double)columns / rows) + 0.5 * fabs(log((double)part / PART_WANTED));
    return cost + (part * columns * rows == particles ? 0.0 : 0.2);
}

bed_layout settled_bed_layout(int64_t particles, const bed_sizes *sizes)
{
    bed_layout best = {.columns = 1, .rows = 1, .part = particles};
    double least = INFINITY;
    int most = particles > PART_MOST ? (int)sqrt(2.0 * (double)particles / PART_LEAST) + 1 : 0;
    for (int columns = 1; columns <= most; columns++)
        for (int rows = (columns + 1) / 2; rows <= columns; rows++) {
            int64_t images = (int64_t)columns * rows, part = (particles + images - 1) / images;
            if (part < PART_LEAST || part > PART_MOST || layout_cost(particles, columns, rows, part) >= least)
                continue;
            least = layout_cost(particles, columns, rows, part);
            best = (bed_layout){.columns = columns, .rows = rows, .part = part};
        }
    best.sizes = sizes ? *sizes : all_alike;
    best.surplus = best.part * best.columns * best.rows - particles;
    best.side = cbrt(solid_volume((double)particles, &best.sizes) / SETTLED);
    best.part_x = best.side / best.columns;
    best.part_y = best.side / best.rows;
    best.height = solid_volume((double)best.part, &best.sizes) / ((large_of(&best.sizes, particles) > 0 ? POURED_MIXED : POURED) * best.part_x * best.part_y);
    return best;
}

/* ---- the scene ---- */

const char bed_effect_words[] = "rolling|conduction|convection|radiation|bonds";

static void print_walls(FILE *out, double x, double y, bool hot)
{
    fprintf(out, "walls:\n  - {name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]%s}\n", hot ? ", temperature_k: 400" : "");
    fprintf(out, "  - {name: west, shape: plane, point_m: [0, 0, 0], normal: [1, 0, 0]}\n"
                 "  - {name: south, shape: plane, point_m: [0, 0, 0], normal: [0, 1, 0]}\n");
    fprintf(out, "  - {name: east, shape: plane, point_m: [%.17g, 0, 0], normal: [-1, 0, 0]}\n", x);
    fprintf(out, "  - {name: north, shape: plane, point_m: [0, %.17g, 0], normal: [0, -1, 0]}\n", y);
}

/* Adhesion with which half of the contacts of the bed are deeper than the critical overlap once it rests under it: overlaps go as the load to the
 * power 2/3, and the load as the height. `particles`: of the whole bed. */
static double bonding_strain(int64_t particles)
{
    return BONDING_STRAIN * pow(1e-5 * (double)particles, 2.0 / 9.0);
}

/* A bed settles under bonds that form whenever they can; where it then rests, those contacts are bonded that are deeper than the critical overlap,
 * and the same ones bond when it is taken up again. */
static void print_grains(FILE *out, const char *name, int64_t count, double size, const double region[3])
{
    if (count > 0)
        fprintf(out, "  - {name: %s, material: glass, generator: random, count: %lld, temperature_k: 300,\n     radius_m: {distribution: uniform, low: %.17g, high: %.17g},\n"
                     "     region: {low_m: [0, 0, 0], high_m: [%.17g, %.17g, %.17g]}}\n",
                name, (long long)count, size * RADIUS_M * (1.0 - RADIUS_SPREAD), size * RADIUS_M * (1.0 + RADIUS_SPREAD), region[0], region[1], region[2]);
}

static void print_scene(FILE *out, int64_t whole, int64_t particles, const bed_sizes *sizes, const double region[3], unsigned effects, bool settling,
                        bool slippery)
{
    static const char *const sides[] = {"west", "south", "east", "north"};
    fprintf(out, "title: Settled bed\ngravity_m_s2: [0, 0, -%g]\neffects:\n", GRAVITY);
    fprintf(out, "  - {slot: normal, law: hertz}\n  - {slot: tangential, law: mindlin}\n");
    if (effects & BED_ROLLING)
        fprintf(out, "  - {slot: rolling, law: elastic_plastic}\n");
    if (effects & BED_CONDUCTION)
        fprintf(out, "  - {slot: conduction, law: overlap_area}\n");
    if (effects & BED_CONVECTION)
        fprintf(out, "  - {slot: convection, law: newton, coefficient_w_m2k: 50}\n");
    if (effects & BED_RADIATION)
        fprintf(out, "  - {slot: radiation, law: stefan_boltzmann}\n");
    if (effects & BED_BONDS)
        fprintf(out, "  - {slot: bond, law: adhesion, criterion: %s}\n", settling ? "always" : "at_time");
    bool damped = (effects & BED_BONDS) && !settling;
    if (settling || damped)
        fprintf(out, "  - {slot: body, law: viscous_damping, coefficient: %g}\n", !settling ? REST_DAMPING : sizes->ratio > 1.0 ? MIXED_DAMPING : SETTLE_DAMPING);
    if (effects & (BED_CONVECTION | BED_RADIATION))
        fprintf(out, "environment: {temperature_k: 350}\n");
    fprintf(out, "materials: [{name: glass, density_kg_m3: 2500, youngs_modulus_pa: %.17g, poissons_ratio: 0.3, conductivity_w_mk: 1,\n"
                 "             specific_heat_j_kgk: 800, emissivity: 0.9}]\ninteractions:\n", MODULUS_PA * sizes->ratio);
    fprintf(out, "  - {between: default, restitution: 0.5, friction_static: 0.5, rolling_friction: 0.01, bond_equilibrium_strain: %.6g,\n     bond_damping_ratio: 0.3}\n", bonding_strain(whole));
    for (int s = 0; s < 4 && slippery; s++) /* half the overlap and twice r* of a contact with the mirror image */
        fprintf(out, "  - {between: [glass, %s], friction_static: 0, bond_equilibrium_strain: %.6g}\n", sides[s], 0.25 * bonding_strain(whole));
    int64_t large = large_of(sizes, particles);
    fprintf(out, "particles:\n");
    print_grains(out, "large", large, sizes->ratio, region);
    print_grains(out, "bed", particles - large, 1.0, region);
    print_walls(out, region[0], region[1], effects & BED_CONDUCTION);
    fprintf(out, "stages: [{name: rest, until: {steps: 1}}%s]\n", damped ? ", {name: at_rest, until: {steps: 1}, effects_off: [body]}" : "");
}

static status make_scene(int64_t whole, int64_t particles, const bed_sizes *sizes, const double region[3], unsigned effects, bool settling, bool slippery,
                         scene **out, failure *why)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream)
        return fail(why, STATUS_ERROR, "out of memory");
    print_scene(stream, whole, particles, sizes, region, effects, settling, slippery);
    fclose(stream);
    status result = scene_read_text(text, "settled bed", 0, NULL, out, why);
    free(text);
    return result;
}

/* ---- settling ---- */

static status take_field(simulation *sim, const char *name, double (*out)[3], failure *why)
{
    double *value = NULL;
    TRY(observe_field(sim, name, &value, why));
    memcpy(out, value, sizeof *out * (size_t)sim->id_count);
    free(value);
    return STATUS_OK;
}

/* The step follows the limit, which a falling and then loaded bed lowers. */
static status settle(simulation *sim, double rest, failure *why)
{
    particle_sums sums;
    double start = clock_seconds();
    TRY(simulation_begin_stage(sim, 0, why));
    do {
        step_limit limit;
        TRY(limit_find(sim, &limit, why));
        simulation_set_step(sim, fmin(2.0e-5, 0.7 * limit.limit_s));
        TRY(simulation_advance(sim, SETTLE_CHECK, why));
        TRY(observe_particle_sums(sim, &sums, why));
        if (!isfinite(sums.kinetic) || sim->count < sim->id_count)
            return fail(why, STATUS_ERROR, "the bed did not settle: its kinetic energy is %g J after %g s", sums.kinetic, sim->time);
    } while (sums.kinetic > rest * GRAVITY * sums.weight_radius && sim->time < SETTLE_MAX_S);
    fprintf(stderr, "%lld grains came to rest after %.2f s, in %.1f s\n", (long long)sim->id_count, sim->time, clock_seconds() - start);
    return STATUS_OK;
}

typedef struct bed_request {
    int64_t particles; /* of the whole bed */
    unsigned effects;  /* under which it rests: none, or BED_BONDS */
    device *device;
    const char *kernels;
} bed_request;

static void find_bounds(bed *b)
{
    for (int c = 0; c < 3; c++) {
        b->low[c] = INFINITY;
        b->high[c] = -INFINITY;
    }
    for (int64_t i = 0; i < b->count; i++)
        for (int c = 0; c < 3; c++) {
            b->low[c] = fmin(b->low[c], b->position[i][c]);
            b->high[c] = fmax(b->high[c], b->position[i][c]);
        }
}

/* Lets the grains come to rest under the effects. */
static status come_to_rest(const scene *under, double rest, device *device, const char *kernels, bed *grains, failure *why)
{
    simulation *sim = NULL;
    find_bounds(grains);
    status result = simulation_create(under, grains, device, kernels, &sim, why);
    if (result == STATUS_OK)
        result = settle(sim, rest, why);
    if (result == STATUS_OK)
        result = take_field(sim, "position", grains->position, why);
    if (result == STATUS_OK)
        result = take_field(sim, "velocity", grains->velocity, why);
    if (result == STATUS_OK)
        result = take_field(sim, "spin", grains->spin, why);
    simulation_free(sim);
    return result;
}

/* `grains` has those of the bed without bonds where it is to be made with bonds. */
static status pour(const bed_request *of, const bed_layout *l, bed *grains, failure *why)
{
    scene *poured = NULL;
    bool bonds = of->effects & BED_BONDS;
    const double region[3] = {l->part_x, l->part_y, l->height};
    TRY(make_scene(of->particles, l->part, &l->sizes, region, of->effects & BED_BONDS, true, l->columns * l->rows > 1, &poured, why));
    if (!of->device->info.fp64)
        poured->precision = PRECISION_MIXED;
    status result = bonds ? STATUS_OK : bed_generate(poured, grains, why);
    if (result == STATUS_OK)
        result = come_to_rest(poured, l->sizes.ratio > 1.0 ? MIXED_REST : REST, of->device, of->kernels, grains, why);
    scene_free(poured);
    return result;
}

/* ---- the cache ---- */

static bool cache_file(const bed_request *of, const bed_layout *l, char *path, size_t size)
{
    char directory[3072];
    if (!cache_directory(directory, sizeof directory))
        return false;
    char sizes[64] = "";
    if (large_of(&l->sizes, of->particles) > 0)
        snprintf(sizes, sizeof sizes, "-%g-%g", l->sizes.ratio, l->sizes.large_share);
    snprintf(path, size, "%s/settled-bed-%d-%lld-%dx%d%s%s.h5", directory, CACHE_VERSION, (long long)of->particles, l->columns, l->rows, sizes,
             of->effects ? "-bonds" : "");
    return true;
}

static status allocate_bed(int64_t count, bed *out, failure *why)
{
    size_t n = (size_t)count;
    *out = (bed){.count = count};
    out->position = calloc(n, sizeof *out->position);
    out->velocity = calloc(n, sizeof *out->velocity);
    out->spin = calloc(n, sizeof *out->spin);
    out->radius = calloc(n, sizeof *out->radius);
    out->temperature = calloc(n, sizeof *out->temperature);
    out->material = calloc(n, sizeof *out->material);
    out->group = calloc(n, sizeof *out->group);
    if (out->position && out->velocity && out->spin && out->radius && out->temperature && out->material && out->group)
        return STATUS_OK;
    bed_free(out);
    *out = (bed){0};
    return fail(why, STATUS_ERROR, "out of memory for %lld particles", (long long)count);
}

static status take_entry(const bundle *in, const char *path, const char *name, int64_t rows, int64_t columns, void *out, failure *why)
{
    const bundle_entry *entry;
    TRY(bundle_get(in, path, name, BUNDLE_F64, rows, columns, &entry, why));
    memcpy(out, entry->data, sizeof(double) * (size_t)(rows * columns));
    return STATUS_OK;
}

/* False where there is no such file, or it is damaged: then it is made anew. */
static bool cache_load(const char *path, int64_t count, bed *out)
{
    bundle in;
    failure why;
    if (bundle_read(path, &in, &why) != STATUS_OK)
        return false;
    status result = allocate_bed(count, out, &why);
    if (result == STATUS_OK)
        result = take_entry(&in, path, "position", count, 3, out->position, &why);
    if (result == STATUS_OK)
        result = take_entry(&in, path, "velocity", count, 3, out->velocity, &why);
    if (result == STATUS_OK)
        result = take_entry(&in, path, "spin", count, 3, out->spin, &why);
    if (result == STATUS_OK)
        result = take_entry(&in, path, "radius", count, 1, out->radius, &why);
    bundle_free(&in);
    if (result != STATUS_OK)
        bed_free(out);
    return result == STATUS_OK;
}

/* A cache that cannot be written is no error: the next run settles the bed again. */
static void cache_store(const char *path, const bed *of)
{
    bundle out;
    failure why;
    bundle_init(&out);
    bundle_add(&out, "position", BUNDLE_F64, of->count, 3, of->position);
    bundle_add(&out, "velocity", BUNDLE_F64, of->count, 3, of->velocity);
    bundle_add(&out, "spin", BUNDLE_F64, of->count, 3, of->spin);
    bundle_add(&out, "radius", BUNDLE_F64, of->count, 1, of->radius);
    if (bundle_write(&out, path, &why) != STATUS_OK)
        fprintf(stderr, "the bed is not kept for the next time: %s\n", why.text);
    bundle_free(&out);
}

static status get_part(const bed_request *of, const bed_layout *l, bed *out, failure *why)
{
    char path[4096];
    bool cached = cache_file(of, l, path, sizeof path);
    *out = (bed){0};
    if (cached && cache_load(path, l->part, out))
        return STATUS_OK;
    if (of->effects) {
        bed_request plain = *of;
        plain.effects = 0;
        TRY(get_part(&plain, l, out, why));
    }
    fprintf(stderr, "settling %lld grains%s, once for all later runs ...\n", (long long)l->part, of->effects ? " under bonds" : "");
    status result = pour(of, l, out, why);
    if (result == STATUS_OK && cached)
        cache_store(path, out);
    if (result != STATUS_OK)
        bed_free(out);
    return result;
}

/* ---- mirror images ---- */

static int64_t highest(const bed *b)
{
    int64_t top = 0;
    for (int64_t i = 1; i < b->count; i++)
        if (b->position[i][2] > b->position[top][2])
            top = i;
    return top;
}

/* Grain i of the part, seen in the given image. Spins are axial: a mirror across x keeps their x component and turns the others. */
static void place_image(const bed_layout *l, const bed *part, int64_t i, int column, int row, bed *out, int64_t to)
{
    const double *x = part->position[i], *v = part->velocity[i], *w = part->spin[i];
    double mx = column % 2 ? -1.0 : 1.0, my = row % 2 ? -1.0 : 1.0;
    out->position[to][0] = l->part_x * (column + column % 2) + mx * x[0];
    out->position[to][1] = l->part_y * (row + row % 2) + my * x[1];
    out->position[to][2] = x[2];
    out->velocity[to][0] = mx * v[0];
    out->velocity[to][1] = my * v[1];
    out->velocity[to][2] = v[2];
    out->spin[to][0] = my * w[0];
    out->spin[to][1] = mx * w[1];
    out->spin[to][2] = mx * my * w[2];
    out->radius[to] = part->radius[i];
    out->temperature[to] = 300.0;
}

status settled_bed_assemble(const bed_layout *l, const bed *part, int64_t particles, bed *out, failure *why)
{
    TRY(allocate_bed(particles, out, why));
    int64_t top = highest(part), to = 0;
    for (int row = 0; row < l->rows; row++)
        for (int column = 0; column < l->columns; column++)
            for (int64_t i = 0; i < part->count; i++)
                if (i != top || row * l->columns + column >= l->surplus)
                    place_image(l, part, i, column, row, out, to++);
    find_bounds(out);
    return STATUS_OK;
}

status settled_bed_make(int64_t particles, unsigned effects, const bed_sizes *sizes, device *device, const char *kernels, settled_bed *out,
                        failure *why)
{
    *out = (settled_bed){0};
    if (particles < SETTLED_BED_LEAST || particles > INT32_MAX)
        return fail(why, STATUS_BAD_INPUT, "the bed can have %d to %d particles, not %lld", SETTLED_BED_LEAST, INT32_MAX,
                    (long long)particles);
    bed_layout l = settled_bed_layout(particles, sizes);
    const double region[3] = {l.side, l.side, l.height};
    bed part;
    TRY(get_part(&(bed_request){particles, effects & BED_BONDS, device, kernels}, &l, &part, why));
    status result = settled_bed_assemble(&l, &part, particles, &out->bed, why);
    bed_free(&part);
    if (result == STATUS_OK)
        result = make_scene(particles, particles, &l.sizes, region, effects, false, false, &out->scene, why);
    out->side_m = l.side;
    if (result != STATUS_OK)
        settled_bed_free(out);
    return result;
}

void settled_bed_free(settled_bed *b)
{
    scene_free(b->scene);
    bed_free(&b->bed);
    *b = (settled_bed){0};
}
