/* Bonds on the device: the step in which they are made at a given time, and how many there are and were. */
#include "laws/fields.h"
#include "laws/laws.h"
#include "simulation.h"

#include <stdlib.h>

#define CHUNK 1024

int bonds_step(const simulation *sim, int steps)
{
    if (sim->live.law[SLOT_BONDING] != &law_bonding_at_time || sim->bonding_done)
        return -1;
    double due = sim->live.option[SLOT_BOND][BOND_TIME];
    for (int s = 0; s < steps; s++)
        if (sim->segment_time + (double)(sim->step + s - sim->segment_step) * sim->dt >= due - 1e-9 * sim->dt)
            return s;
    return -1;
}

static status count_records(simulation *sim, int64_t *made, int64_t *alive, failure *why)
{
    stored_field *bonded = store_find(sim, field_bonded.name);
    cl_kernel kernel = launch_kernel(sim, "table_bond_sums");
    int records = sim->table.record_count;
    int64_t chunks = (records + CHUNK - 1) / CHUNK;
    *made = *alive = 0;
    if (!bonded || !kernel || !sim->table.built || records == 0)
        return STATUS_OK;
    double *sum = malloc(2 * sizeof *sum * (size_t)chunks);
    status result = sum ? observe_partial(sim, 2 * chunks, why) : fail(why, STATUS_ERROR, "out of memory");
    if (result == STATUS_OK)
        result = launch_set(kernel, "table_bond_sums", why, "mmi", bonded->mem, sim->partial, (cl_int)records);
    if (result == STATUS_OK)
        result = launch_run(sim, kernel, "table_bond_sums", chunks, 1, why);
    if (result == STATUS_OK)
        result = store_get(sim, sim->partial, FIELD_EXACT, 0, 2 * chunks, sum, why);
    for (int64_t c = 0; c < chunks && result == STATUS_OK; c++) {
        *made += (int64_t)sum[2 * c];
        *alive += (int64_t)sum[2 * c + 1];
    }
    free(sum);
    return result;
}

status bonds_count(simulation *sim, bond_sums *out, failure *why)
{
    int64_t made;
    TRY(count_records(sim, &made, &out->alive, why));
    out->made = sim->bonds_gone + made;
    out->broken = out->made - out->alive;
    return STATUS_OK;
}

/* Records are about to be left behind, with the bonds that they have had. */
status bonds_before(simulation *sim, failure *why)
{
    int64_t made, alive;
    TRY(count_records(sim, &made, &alive, why));
    sim->bonds_gone += made;
    return STATUS_OK;
}

/* Those that have been taken along count again where they are. */
status bonds_after(simulation *sim, failure *why)
{
    int64_t made, alive;
    TRY(count_records(sim, &made, &alive, why));
    sim->bonds_gone -= made;
    return STATUS_OK;
}
