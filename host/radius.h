/* Radii drawn from a distribution. */
#ifndef CLAST_HOST_RADIUS_H
#define CLAST_HOST_RADIUS_H
#include "scene.h"
#include "status.h"

#include <stdint.h>

typedef struct radius_sampler {
    const radius_spec *spec;
    double log_mean, log_std; /* lognormal: of ln r */
    double *cumulative;       /* sieve: share of the number of grains up to and with each class */
} radius_sampler;

/* Fails with STATUS_BAD_INPUT where the numbers cannot make a positive radius; the message has no place in it, the caller adds one. */
status radius_sampler_init(const radius_spec *spec, radius_sampler *out, failure *why);
void radius_sampler_free(radius_sampler *sampler);
/* Radius of grain `index` of a group: a function of its arguments alone. */
double radius_draw(const radius_sampler *sampler, uint64_t seed, uint32_t group, uint32_t index);

#endif
