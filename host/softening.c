/* What follows the grains' temperatures where the device has not set it yet: at the start, and where a stage takes a law up. */
#include "laws/fields.h"
#include "laws/laws.h"
#include "simulation.h"

#include <stdlib.h>

static status refresh(simulation *sim, const char *name, double (*at)(const scene *scene, int material, double temperature), failure *why)
{
    stored_field *factor = store_find(sim, name), *material = store_find(sim, "material");
    if (!factor)
        return STATUS_OK;
    uint64_t n = (uint64_t)sim->stride;
    double *value = malloc(n * sizeof *value);
    int32_t *of = calloc(n, sizeof *of);
    status result = value && of ? store_get_grains(sim, store_find(sim, "temperature"), sim->stride, value, why) : fail(why, STATUS_ERROR, "out of memory");
    if (result == STATUS_OK && material)
        result = store_read(sim, material->mem, 0, 4 * n, of, why);
    for (uint64_t i = 0; i < n && result == STATUS_OK; i++)
        value[i] = at(sim->scene, of[i], value[i]);
    if (result == STATUS_OK)
        result = store_put_grains(sim, factor, sim->stride, value, why);
    free(value);
    free(of);
    return result;
}

status softening_refresh(simulation *sim, failure *why)
{
    TRY(refresh(sim, field_modulus_factor.name, modulus_factor_at, why));
    return refresh(sim, field_resistivity.name, resistivity_at, why);
}
