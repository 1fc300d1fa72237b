/* The bed that benchmarks run on: spheres of 1 mm +-10 % at rest in a square box with four side walls and a floor, about as high as wide,
 * with about five contacts each. */
#ifndef CLAST_HOST_SETTLED_BED_H
#define CLAST_HOST_SETTLED_BED_H
#include "bed.h"
#include "device.h"

#define SETTLED_BED_LEAST 100

/* What the scene has on top of contact and friction. */
#define BED_ROLLING    1u
#define BED_CONDUCTION 2u /* with a hot floor */
#define BED_CONVECTION 4u
#define BED_RADIATION  8u
#define BED_BONDS      16u /* adhesion, of about half of the contacts */
/* Their words in that order, "rolling|conduction|...". */
extern const char bed_effect_words[];

/* Two kinds of grains: `large_share` of them, by number, `ratio` times as large as the others, and all as much stiffer, so that they are not crushed. */
typedef struct bed_sizes {
    double ratio, large_share;
} bed_sizes;

typedef struct settled_bed {
    bed bed;
    double side_m; /* of the box */
    scene *scene;  /* under which it is at rest */
} settled_bed;

/* Takes the bed from the cache, or makes it: small ones are poured and come to rest, large ones are put together from mirror images of a
 * part with that height. Progress goes to standard error. */
status settled_bed_make(int64_t particles, unsigned effects, const bed_sizes *sizes, device *device, const char *kernels, settled_bed *out,
                        failure *why); /* sizes NULL: all alike */
void settled_bed_free(settled_bed *bed);

/* How the bed is put together: columns by rows of mirror images of one part. */
typedef struct bed_layout {
    int columns, rows;
    int64_t part;                        /* grains of the part */
    int64_t surplus;                     /* grains to leave out, fewer than there are images */
    double side, part_x, part_y, height; /* m; height before it settles */
    bed_sizes sizes;
} bed_layout;

bed_layout settled_bed_layout(int64_t particles, const bed_sizes *sizes);
/* Places the images of a part; the surplus is left out from the top, one grain an image. */
status settled_bed_assemble(const bed_layout *layout, const bed *part, int64_t particles, bed *out, failure *why);

#endif
