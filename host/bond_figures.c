#include "bond_figures.h"

#include "laws/laws.h"
#include "property.h"
#include "restitution.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Largest equilibrium overlap, of the smaller radius: contact laws are laws of small overlaps. */
#define OVERLAP_MAX 0.2
#define BISECTIONS 40
#define STEPS 1500 /* a radian of the fastest oscillation has about a hundred */

/* Two bodies in line: m* d'' = -N(d, d'). */
typedef struct bonded_pair {
    double k2, a2, k, a; /* repulsion and adhesion */
    double contact_damping, bond_damping, mass;
    bool clamps;
} bonded_pair;

static double critical_overlap(const bonded_pair *p)
{
    return pow(p->a * p->k / (p->a2 * p->k2), 1.0 / (p->a2 - p->a));
}

static double equilibrium_overlap(const bonded_pair *p)
{
    return pow(p->k / p->k2, 1.0 / (p->a2 - p->a));
}

static double normal_force(const bonded_pair *p, bool bonded, double d, double rate)
{
    double spring = p->k2 * pow(d, p->a2), tangent = p->a2 * p->k2 * pow(d, p->a2 - 1.0);
    if (!bonded)
        return fmax(0.0, spring + 2.0 * p->contact_damping * sqrt(p->mass * tangent) * rate);
    double net = spring - p->k * pow(d, p->a);
    tangent = fmax(0.0, tangent - p->a * p->k * pow(d, p->a - 1.0));
    double force = net + 2.0 * p->bond_damping * sqrt(p->mass * tangent) * rate;
    if (!p->clamps)
        return force;
    return net > 0.0 ? fmax(0.0, force) : fmin(0.0, force);
}

typedef enum impact_end { BOUNCES, STICKS, BREAKS } impact_end;

static void advance(const bonded_pair *p, bool bonded, double dt, double *d, double *rate)
{
    double a1 = -normal_force(p, bonded, *d, *rate) / p->mass;
    double d2 = fmax(0.0, *d + 0.5 * dt * *rate), v2 = *rate + 0.5 * dt * a1, a2 = -normal_force(p, bonded, d2, v2) / p->mass;
    double d3 = fmax(0.0, *d + 0.5 * dt * v2), v3 = *rate + 0.5 * dt * a2, a3 = -normal_force(p, bonded, d3, v3) / p->mass;
    double d4 = fmax(0.0, *d + dt * v3), v4 = *rate + dt * a3, a4 = -normal_force(p, bonded, d4, v4) / p->mass;
    *d += dt / 6.0 * (*rate + 2.0 * v2 + 2.0 * v3 + v4);
    *rate += dt / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
}

/* A bond that survives its first swing outwards survives the smaller ones that follow. */
static impact_end impact(const bonded_pair *p, double speed)
{
    double critical = critical_overlap(p), d = 0.0, rate = speed;
    double energy = 0.5 * p->mass * speed * speed;
    double deepest = fmax(pow((p->a2 + 1.0) * energy / p->k2, 1.0 / (p->a2 + 1.0)), 2.0 * equilibrium_overlap(p));
    double dt = 10.0 / STEPS / sqrt(p->a2 * p->k2 * pow(deepest, fmax(p->a2 - 1.0, 0.0)) / p->mass);
    bool bonded = false;
    for (int n = 0; n < 200 * STEPS; n++) {
        double before = rate;
        advance(p, bonded, dt, &d, &rate);
        if (bonded && d <= critical)
            return BREAKS;
        if (bonded && before < 0.0 && rate >= 0.0)
            return STICKS;
        bonded = bonded || d > critical;
        if (!bonded && rate < 0.0)
            return BOUNCES;
    }
    return STICKS;
}

/* The speed between `low` and `high` at which an impact ceases to end as `as`. */
static double border(const bonded_pair *p, double low, double high, impact_end as)
{
    for (int n = 0; n < BISECTIONS; n++) {
        double middle = sqrt(low * high);
        if (impact(p, middle) == as)
            low = middle;
        else
            high = middle;
    }
    return high;
}

static void find_velocities(const bonded_pair *p, bond_figures *f)
{
    double energy = p->k2 * pow(f->critical, p->a2 + 1.0) / (p->a2 + 1.0);
    f->velocity = f->sticks_from = sqrt(2.0 * energy / p->mass);
    if (p->contact_damping > 0.0)
        f->sticks_from = border(p, f->velocity, 1e3 * f->velocity, BOUNCES);
    double low = f->sticks_from * (1.0 + 1e-6), high = 1e3 * f->sticks_from;
    f->breaks_from = impact(p, low) == BREAKS ? f->sticks_from : impact(p, high) == STICKS ? INFINITY : border(p, low, high, STICKS);
}

static double contact_damping(const contact_class *class)
{
    const effect *normal = scene_effect(class->scene, -1, SLOT_NORMAL);
    if (!strcmp(normal->law->name, "hertz"))
        return normal_damping_ratio(class, hertz_damping_ratio);
    if (!strcmp(normal->law->name, "linear"))
        return normal_damping_ratio(class, linear_damping_ratio);
    double xi = interaction_value(class, &property_normal_damping);
    return isnan(xi) ? 0.0 : xi;
}

static double sphere(double density, double radius)
{
    return 4.0 / 3.0 * M_PI * density * radius * radius * radius;
}

/* False where the pair does not bond. */
static bool make_pair(const contact_class *class, double ri, double rj, bonded_pair *out)
{
    repulsion push = repulsion_of(class);
    adhesion pull = adhesion_of(class);
    bool wall = class->material_b < 0;
    double r = wall ? ri : ri * rj / (ri + rj), mi = sphere(material_value(class, class->material_a, &property_density), ri);
    double mj = wall ? INFINITY : sphere(material_value(class, class->material_b, &property_density), rj);
    *out = (bonded_pair){push.coefficient * pow(r, push.radius_power), push.exponent, pull.coefficient * pow(r, pull.radius_power), pull.exponent,
                         contact_damping(class), pull.damping_ratio, wall ? mi : mi * mj / (mi + mj), true};
    return pull.coefficient > 0.0;
}

typedef struct size_range {
    double least, most, sum;
    int64_t count;
} size_range;

static size_range *sizes_of(const scene *scene, const bed *bed)
{
    size_range *size = calloc((size_t)scene->material_count + 1, sizeof *size);
    for (int64_t i = 0; size && i < bed->count; i++) {
        size_range *s = &size[bed->material[i]];
        s->least = s->count == 0 ? bed->radius[i] : fmin(s->least, bed->radius[i]);
        s->most = fmax(s->most, bed->radius[i]);
        s->sum += bed->radius[i];
        s->count++;
    }
    return size;
}

static bool is_adhesion(const scene *scene, int stage)
{
    const effect *bond = scene_effect(scene, stage, SLOT_BOND);
    return bond && bond->law == &law_adhesion;
}

bond_figures *bond_figures_of(const scene *scene, const bed *bed, int stage, int *count)
{
    int parties = scene->material_count + scene->wall_count;
    bond_figures *all = calloc((size_t)(scene->material_count * parties) + 1, sizeof *all);
    size_range *size = sizes_of(scene, bed);
    *count = 0;
    for (int a = 0; all && size && is_adhesion(scene, stage) && a < scene->material_count; a++)
        for (int p = a; p < parties; p++) {
            bool wall = p >= scene->material_count;
            bond_figures *f = &all[*count];
            bonded_pair pair;
            if (size[a].count == 0 || (!wall && size[p].count == 0) || (p == a && size[a].count < 2))
                continue;
            f->radius_i = size[a].sum / (double)size[a].count;
            f->radius_j = wall ? 0.0 : size[p].sum / (double)size[p].count;
            if (!make_pair(&(contact_class){scene, stage, a, wall ? -1 : p, wall ? p - scene->material_count : -1}, f->radius_i, f->radius_j, &pair))
                continue;
            f->a = scene->material[a].name;
            f->b = wall ? scene->wall[p - scene->material_count].name : scene->material[p].name;
            f->wall = wall;
            f->equilibrium = equilibrium_overlap(&pair);
            f->critical = critical_overlap(&pair);
            f->pull_off = pair.k * pow(f->critical, pair.a) - pair.k2 * pow(f->critical, pair.a2);
            const effect *bond = scene_effect(scene, stage, SLOT_BOND);
            pair.clamps = bond->option[BOND_OWN] == 0.0;
            find_velocities(&pair, f);
            (*count)++;
        }
    free(size);
    return all;
}

static status check_pair(const contact_class *class, double ri, double rj, failure *why)
{
    const scene *s = class->scene;
    const effect *bond = scene_effect(s, -1, SLOT_BOND);
    bool wall = class->material_b < 0;
    const char *a = s->material[class->material_a].name, *b = wall ? s->wall[class->wall].name : s->material[class->material_b].name;
    bonded_pair pair;
    if (!make_pair(class, ri, rj, &pair))
        return STATUS_OK; /* no bond, no questions */
    if (!(pair.a < pair.a2))
        return fail(why, STATUS_BAD_INPUT,
                    "%s:%d:%d: effects[bond]: between `%s` and `%s` the exponent of adhesion must be below that of repulsion, and it is not: "
                    "bond_exponent %g >= %g of the normal law; such a pair has no stable equilibrium (BM Eq. 9); lower `bond_exponent`",
                    s->path, bond->at.line, bond->at.column, a, b, pair.a, pair.a2);
    double equilibrium = equilibrium_overlap(&pair), critical = critical_overlap(&pair), least = wall ? ri : fmin(ri, rj);
    if (!(equilibrium > critical))
        return fail(why, STATUS_BAD_INPUT,
                    "%s:%d:%d: effects[bond]: between `%s` and `%s` the equilibrium overlap must be above the critical one (BM Eq. 10), and it is not: "
                    "%g m <= %g m; change the adhesion",
                    s->path, bond->at.line, bond->at.column, a, b, equilibrium, critical);
    if (!(equilibrium <= OVERLAP_MAX * least))
        return fail(why, STATUS_BAD_INPUT,
                    "%s:%d:%d: effects[bond]: between `%s` and `%s` the equilibrium overlap of %g m is %.3g of the radius %g m, above %g: contact "
                    "laws hold for small overlaps; take a weaker adhesion or a stiffer contact",
                    s->path, bond->at.line, bond->at.column, a, b, equilibrium, equilibrium / least, least, OVERLAP_MAX);
    return STATUS_OK;
}

static status check_threshold(const contact_class *class, failure *why)
{
    const scene *s = class->scene;
    const effect *bond = scene_effect(s, -1, SLOT_BOND);
    bool wall = class->material_b < 0;
    if (bond->option[BOND_CRITERION] < BOND_SCALAR_ABOVE || !pair_bonds(class) || !isnan(interaction_value(class, &property_bond_threshold)))
        return STATUS_OK;
    return fail(why, STATUS_BAD_INPUT,
                "%s:%d:%d: effects[bond]: `%s` and `%s` can bond, and the criterion needs to know above which value: add `bond_threshold` to their "
                "entry under `interactions` or to `default`",
                s->path, bond->at.line, bond->at.column, s->material[class->material_a].name,
                wall ? s->wall[class->wall].name : s->material[class->material_b].name);
}

/* The extremes of sizes: overlaps at rest are powers of r*. */
static status check_class(const contact_class *class, const size_range *size, failure *why)
{
    const size_range *a = &size[class->material_a], *b = class->material_b < 0 ? a : &size[class->material_b];
    const double pairs[4][2] = {{a->least, b->least}, {a->least, b->most}, {a->most, b->least}, {a->most, b->most}};
    TRY(check_threshold(class, why));
    for (int n = 0; n < 4 && is_adhesion(class->scene, class->stage) && a->count > 0 && b->count > 0; n++)
        TRY(check_pair(class, pairs[n][0], pairs[n][1], why));
    return STATUS_OK;
}

/* Cohesion by JKR's contact radius is made for Hertz's spring. */
static status check_cohesion(const scene *s, failure *why)
{
    const effect *cohesion = scene_effect(s, -1, SLOT_COHESION), *normal = scene_effect(s, -1, SLOT_NORMAL);
    if (!cohesion)
        return STATUS_OK;
    if (cohesion->law == &law_jkr && scene_effect(s, -1, SLOT_MODULUS))
        return fail(why, STATUS_BAD_INPUT, "%s:%d:%d: effects[cohesion]: `jkr` has constant moduli, and the scene softens them; take `sjkr` or `dmt`",
                    s->path, cohesion->at.line, cohesion->at.column);
    if (cohesion->law != &law_dmt && normal && normal->law != &law_hertz)
        return fail(why, STATUS_BAD_INPUT, "%s:%d:%d: effects[cohesion]: `%s` needs the normal law `hertz`; the scene has `%s`", s->path,
                    cohesion->at.line, cohesion->at.column, cohesion->law->name, normal->law->name);
    return STATUS_OK;
}

status bond_check(const scene *scene, const bed *bed, failure *why)
{
    TRY(check_cohesion(scene, why));
    size_range *size = sizes_of(scene, bed);
    status result = size ? STATUS_OK : fail(why, STATUS_ERROR, "out of memory");
    for (int s = 0; s < scene->stage_count; s++)
        for (int a = 0; a < scene->material_count && scene_effect(scene, s, SLOT_BOND); a++)
            for (int p = a; p < scene->material_count + scene->wall_count && result == STATUS_OK; p++) {
                bool wall = p >= scene->material_count;
                result = check_class(&(contact_class){scene, s, a, wall ? -1 : p, wall ? p - scene->material_count : -1}, size, why);
            }
    free(size);
    return result;
}
