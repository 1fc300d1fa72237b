/* Moduli of the grains at their temperatures, where the device has not set them yet: at the start, and where a stage takes softening up. */
#include "laws/fields.h"
#include "laws/laws.h"
#include "simulation.h"

#include <stdlib.h>

status softening_refresh(simulation *sim, failure *why)
{
    stored_field *factor = store_find(sim, field_modulus_factor.name), *material = store_find(sim, "material");
    if (!factor)
        return STATUS_OK;
    uint64_t n = (uint64_t)sim->stride;
    double *value = malloc(n * sizeof *value);
    int32_t *of = calloc(n, sizeof *of);
    status result = value && of ? store_get_grains(sim, store_find(sim, "temperature"), sim->stride, value, why) : fail(why, STATUS_ERROR, "out of memory");
    if (result == STATUS_OK && material)
        result = store_read(sim, material->mem, 0, 4 * n, of, why);
    for (uint64_t i = 0; i < n && result == STATUS_OK; i++)
        value[i] = modulus_factor_at(sim->scene, of[i], value[i]);
    if (result == STATUS_OK)
        result = store_put_grains(sim, factor, sim->stride, value, why);
    free(value);
    free(of);
    return result;
}
