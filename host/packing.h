/* Spheres brought into a box without overlap: first by chance, largest first, then, where chance leaves overlaps, by pushing apart. */
#ifndef CLAST_HOST_PACKING_H
#define CLAST_HOST_PACKING_H
#include "sphere_grid.h"

#include <stdbool.h>
#include <stdint.h>

/* Centres keep this fraction of their radii more distance than they must, so that the gap stays positive in any order of rounding. */
#define PACKING_MARGIN 1.0e-7

typedef struct packing {
    int dimensions; /* 2: z is 0 for all */
    sphere_space space;
    double low[3], high[3]; /* faces, hard for the whole sphere */
    bool open[3];           /* directions without faces: the box wraps there */
    int64_t count;
    double (*position)[3];
    double *radius;
    bool *fixed; /* obstacles: in place already */
} packing;

/* Gives every sphere that is not fixed a place, and says whether any two overlap. The place of sphere i is a function of seed, group, i
 * and of what is larger or fixed. False when memory runs out. */
bool packing_insert(packing *p, uint64_t seed, uint32_t group, bool *overlap);
/* Pushes overlapping spheres apart. `reached` is 1 when nothing overlaps any more; else a factor below 1 by which everything would have to
 * shrink for that, of which `sure` is the first to be tried (0: none is tried), or 0 when none was found. False when memory runs out. */
bool packing_relax(packing *p, double sure, double *reached);

#endif
