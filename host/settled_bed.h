/* The bed that benchmarks run on: spheres of 1 mm +-10 % at rest in a square box with four side walls and a floor, about as high as wide,
 * with about five contacts each. */
#ifndef CLAST_HOST_SETTLED_BED_H
#define CLAST_HOST_SETTLED_BED_H
#include "bed.h"
#include "device.h"

#define SETTLED_BED_LEAST 100

typedef struct settled_bed {
    bed bed;
    double side_m; /* of the box */
    scene *scene;  /* under which it is at rest */
} settled_bed;

/* Takes the bed from the cache, or makes it: small ones are poured and come to rest, large ones are put together from mirror images of a
 * part with that height. Progress goes to standard error. */
status settled_bed_make(int64_t particles, bool rolling, device *device, const char *kernels, settled_bed *out, failure *why);
void settled_bed_free(settled_bed *bed);

#endif
