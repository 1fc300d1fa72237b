/* Bonds on the device: the step in which they are made at a given time, and how many there are and were. */
#include "laws/fields.h"
#include "laws/laws.h"
#include "simulation.h"

#include <math.h>
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
    int records = sim->table.wall_base + sim->table.wall_record_count;
    int64_t chunks = (records + CHUNK - 1) / CHUNK;
    *made = *alive = 0;
    if (!bonded || !kernel || !sim->table.built || records == 0)
        return STATUS_OK;
    double *sum = malloc(2 * sizeof *sum * (size_t)chunks);
    status result = sum ? observe_partial(sim, 2 * chunks, why) : fail(why, STATUS_ERROR, "out of memory");
    if (result == STATUS_OK)
        result = launch_set(kernel, "table_bond_sums", why, "mmiii", bonded->mem, sim->partial, sim->table.pair_count, sim->table.wall_base,
                            records);
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

bool bonds_are_kept(const simulation *sim)
{
    const law *bond = sim->live.law[SLOT_BOND];
    return bond && bond->keeps_bonds && bond->keeps_bonds(sim->live.option[SLOT_BOND]);
}

/* Indices are no longer those of the ids once grains have been sorted, so the array that leads from ids to them is free. */
static status find_inverse(simulation *sim, const clast_launch *launch, failure *why)
{
    sim->particles_stale = true;
    TRY(table_do_fill(sim, sim->where, 4 * (uint64_t)sim->stride, -1, why));
    return table_do(sim, "table_bond_inverse", sim->count, sim->block, why, "Lmm", launch, sim->table.work[2], sim->where);
}

status bonds_keep(simulation *sim, const clast_launch *launch, int room, bool fill, failure *why)
{
    contact_table *t = &sim->table;
    if (!bonds_are_kept(sim) || !t->built)
        return STATUS_OK;
    const char *name = fill ? "table_bond_fill" : "table_bond_count";
    int next = 1 - t->now;
    if (!fill)
        TRY(find_inverse(sim, launch, why));
    cl_mem first = fill ? t->work[3] : t->work[0], second = fill ? t->owner[next] : t->work[1];
    cl_mem third = fill ? t->other[next] : store_find(sim, "force")->mem;
    return table_do(sim, name, sim->count, sim->block, why, "Lmmmmmmmmmmmmmmii", launch, t->grid, store_find(sim, "position")->mem,
                    table_radii(sim), store_find(sim, "id")->mem, t->work[2], sim->where, t->owner[t->now], t->other[t->now],
                    t->slot_offset[t->now], t->slots[t->now], store_find(sim, field_bonded.name)->mem, first, second, third, room,
                    t->old_wall_base);
}

/* Over all kinds of contacts in all stages, for the largest grains. */
double bonds_reach(const scene *scene, const live_laws *live, double radius)
{
    double reach = 0.0;
    for (int s = 0; s < scene->stage_count; s++)
        for (int a = 0; a < scene->material_count; a++)
            for (int p = 0; p < scene->material_count + scene->wall_count; p++) {
                bool wall = p >= scene->material_count;
                contact_class class = {scene, s, a, wall ? -1 : p, wall ? p - scene->material_count : -1};
                for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
                    if (live->law[slot] && live->law[slot]->reach)
                        reach = fmax(reach, live->law[slot]->reach(&class, radius));
            }
    return reach;
}
