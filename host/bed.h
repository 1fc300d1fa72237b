/* The particles as generated, in permanent-id order (scene order: group by group), on the host in double. */
#ifndef CLAST_HOST_BED_H
#define CLAST_HOST_BED_H
#include "scene.h"
#include "status.h"

#include <stdint.h>

typedef struct bed {
    int64_t count;
    double (*position)[3]; /* m */
    double (*velocity)[3]; /* m/s */
    double (*spin)[3];     /* rad/s */
    double *radius;        /* m */
    double *scalar;        /* what a bond criterion looks at; NULL: 0 everywhere */
    double *temperature;   /* K; NAN where the scene gives none */
    int32_t *material;
    int32_t *group;
    double low[3], high[3]; /* of the centres' box */
} bed;

/* Generates all groups. Everything random comes from scene->seed through Random123's counter-based generators, keyed by group and
 * particle, so that a bed does not depend on the machine, the number of threads or other groups. Fails with STATUS_BAD_INPUT and the
 * reachable number where a region cannot hold the particles asked for, where a file is bad (path:line: ...), or where a position lies
 * outside the domain. */
status bed_generate(const scene *scene, bed *out, failure *why);
void bed_free(bed *bed);

/* Largest overlap between any two spheres as a fraction of the smaller radius (periodic images included), with the pair; 0 if none. */
double bed_largest_overlap(const bed *bed, const domain *domain, int64_t *i, int64_t *j);

#endif
