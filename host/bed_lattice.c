#include "bed_group.h"

#include <inttypes.h>
#include <math.h>

/* Simple cubic: counts along x, y and z. */
static void simple_cubic(const particle_group *g, int64_t x, int64_t y, int64_t z, double centre[3])
{
    centre[0] = (double)x * g->spacing_m;
    centre[1] = (double)y * g->spacing_m;
    centre[2] = (double)z * g->spacing_m;
}

/* Hexagonal close packing: triangular layers, every other one (B) over the hollows of the first (A). */
static void hexagonal(const particle_group *g, int64_t x, int64_t y, int64_t z, double centre[3])
{
    centre[0] = g->spacing_m * ((double)x + 0.5 * (double)((y + z) % 2));
    centre[1] = g->spacing_m * sqrt(0.75) * ((double)y + (double)(z % 2) / 3.0);
    centre[2] = g->spacing_m * sqrt(2.0 / 3.0) * (double)z;
}

/* Rows along x that rise along z (along y in two dimensions), every other one shifted by half a spacing and one grain shorter, as in the
 * heated layer of TM 5.2; in three dimensions repeated along y. */
static void triangular(const particle_group *g, int dimensions, int64_t x, int64_t y, int64_t row, double centre[3])
{
    double rise = g->spacing_m * sqrt(0.75) * (double)row;
    centre[0] = g->spacing_m * ((double)x + 0.5 * (double)(row % 2));
    centre[1] = dimensions == 2 ? rise : (double)y * g->spacing_m;
    centre[2] = dimensions == 2 ? 0.0 : rise;
}

static status check_lattice(const scene *s, int group, failure *why)
{
    const particle_group *g = &s->group[group];
    double product = 1.0;
    for (int d = 0; d < 3; d++) {
        if (g->counts[d] < 1)
            return bed_refuse(s, group, why, "counts[%d] is %" PRId64 "; each of the three must be 1 or more", d, g->counts[d]);
        product *= (double)g->counts[d];
    }
    if (product > INT32_MAX)
        return bed_refuse(s, group, why, "counts [%" PRId64 ", %" PRId64 ", %" PRId64 "] make %.4g particles; a scene holds at most %d",
                          g->counts[0], g->counts[1], g->counts[2], product, INT32_MAX);
    if (!(g->spacing_m > 0.0 && isfinite(g->spacing_m)))
        return bed_refuse(s, group, why, "spacing_m is %g; it must be above 0", g->spacing_m);
    int flat = g->lattice == LATTICE_TRIANGULAR ? 1 : 2;
    if (s->dimensions == 2 && g->counts[flat] != 1)
        return bed_refuse(s, group, why, "counts[%d] is %" PRId64 "; in a scene of 2 dimensions it must be 1 for this lattice", flat,
                          g->counts[flat]);
    return STATUS_OK;
}

status bed_lattice(const scene *s, int group, bed *b, failure *why)
{
    TRY(check_lattice(s, group, why));
    const particle_group *g = &s->group[group];
    bool rows = g->lattice == LATTICE_TRIANGULAR;
    int64_t short_rows = rows ? g->counts[2] / 2 : 0; /* every other row lacks a grain */
    int64_t count = g->counts[0] * g->counts[1] * g->counts[2] - short_rows * g->counts[1];
    int64_t first;
    TRY(bed_extend(s, group, count, b, &first, why));
    TRY(bed_draw_radii(s, group, b, first, why));
    int64_t i = first;
    for (int64_t z = 0; z < g->counts[2]; z++)
        for (int64_t y = 0; y < g->counts[1]; y++)
            for (int64_t x = 0; x < g->counts[0] - (rows ? z % 2 : 0); x++, i++) {
                double centre[3];
                if (g->lattice == LATTICE_SIMPLE_CUBIC)
                    simple_cubic(g, x, y, z, centre);
                else if (g->lattice == LATTICE_HEXAGONAL)
                    hexagonal(g, x, y, z, centre);
                else
                    triangular(g, s->dimensions, x, y, z, centre);
                for (int d = 0; d < 3; d++)
                    b->position[i][d] = g->origin_m[d] + centre[d];
            }
    return STATUS_OK;
}
