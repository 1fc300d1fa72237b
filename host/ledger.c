#include "ledger.h"

#include "laws/fields.h"
#include "simulation.h"

#include <stdlib.h>
#include <string.h>

const char *const ledger_terms[LEDGER_TERMS] = {"dissipated_normal", "dissipated_tangential", "dissipated_rolling",
                                                "work_walls",        "work_stiffness",        "work_expansion",
                                                "work_gravity",      "dissipated_body",       "work_groups"};

static const field *const sums[LEDGER_FIELDS] = {&field_dissipated, &field_work_contacts, &field_work_grains};

status ledger_add_half_step(simulation *sim, const field *term, double *rows, failure *why)
{
    int at = 0;
    while (at < LEDGER_FIELDS && sums[at] != term)
        at++;
    if (at == LEDGER_FIELDS || !sim->live.law[SLOT_LEDGER])
        return STATUS_OK;
    cl_mem velocity, spin;
    double *now = malloc(sizeof *now * (size_t)(3 * LEDGER_FIELDS * sim->count + 1));
    status result = now ? observe_velocities(sim, &velocity, &spin, why) : fail(why, STATUS_ERROR, "out of memory");
    if (result == STATUS_OK)
        result = store_get(sim, sim->ledger_now, FIELD_EXACT, 0, 3 * LEDGER_FIELDS * sim->count, now, why);
    for (int64_t i = 0; i < sim->count && result == STATUS_OK; i++)
        for (int c = 0; c < 3; c++)
            rows[3 * i + c] += now[3 * (LEDGER_FIELDS * i + at) + c];
    free(now);
    return result;
}

status ledger_read(simulation *sim, double *out, failure *why)
{
    memcpy(out, sim->left_energy, sizeof sim->left_energy);
    for (int f = 0; f < LEDGER_FIELDS; f++) {
        double *value = NULL;
        status result = observe_field(sim, sums[f]->name, &value, why);
        for (int64_t n = 0; n < sim->id_count && result == STATUS_OK; n++)
            for (int c = 0; c < 3; c++)
                out[3 * f + c] += value[3 * n + c] == value[3 * n + c] ? value[3 * n + c] : 0.0; /* NAN: it has left */
        free(value);
        TRY(result);
    }
    return STATUS_OK;
}

status ledger_leave(simulation *sim, const int32_t *index, int64_t count, failure *why)
{
    for (int f = 0; f < LEDGER_FIELDS && sim->all.law[SLOT_LEDGER]; f++) {
        stored_field *stored = store_find(sim, sums[f]->name);
        double *value = malloc(3 * sizeof *value * (size_t)sim->stride);
        status result = value ? store_get_grains(sim, stored, sim->stride, value, why) : fail(why, STATUS_ERROR, "out of memory");
        for (int64_t k = 0; k < count && result == STATUS_OK; k++)
            for (int c = 0; c < 3; c++)
                sim->left_energy[3 * f + c] += value[3 * (int64_t)index[k] + c];
        free(value);
        TRY(result);
    }
    return STATUS_OK;
}
