/* Biot numbers: whether grains may be taken as isothermal (docs/theory.md). */
#include "property.h"
#include "simulation.h"

#include <math.h>
#include <stdlib.h>

static void note(double *out, int material, double value)
{
    if (value > out[material])
        out[material] = value;
}

static int material_of(const simulation *sim, const int32_t *id, int64_t i)
{
    return sim->scene->group[sim->group_of_id[id[i]]].material;
}

typedef struct biot_arrays {
    int32_t *owner, *other, *id;
    double *heat, *radius, *surface;
} biot_arrays;

static void free_arrays(biot_arrays *a)
{
    free(a->owner);
    free(a->other);
    free(a->id);
    free(a->heat);
    free(a->radius);
    free(a->surface);
}

static status read_arrays(simulation *sim, biot_arrays *a, failure *why)
{
    contact_table *t = &sim->table;
    size_t records = (size_t)t->record_count + 1, grains = (size_t)sim->stride + 1;
    a->owner = malloc(records * sizeof *a->owner);
    a->other = malloc(records * sizeof *a->other);
    a->heat = calloc(records, sizeof *a->heat);
    a->id = malloc(grains * sizeof *a->id);
    a->radius = malloc(grains * sizeof *a->radius);
    a->surface = malloc(grains * sizeof *a->surface);
    if (!a->owner || !a->other || !a->heat || !a->id || !a->radius || !a->surface)
        return fail(why, STATUS_ERROR, "out of memory");
    TRY(store_read(sim, t->owner[t->now], 0, 4 * (uint64_t)t->record_count, a->owner, why));
    TRY(store_read(sim, t->other[t->now], 0, 4 * (uint64_t)t->record_count, a->other, why));
    TRY(store_read(sim, store_find(sim, "id")->mem, 0, 4 * (uint64_t)sim->stride, a->id, why));
    if (sim->live.law[SLOT_CONDUCTION])
        TRY(store_get(sim, store_find(sim, "heat")->mem, store_find(sim, "heat")->field->type, 0, t->record_count, a->heat, why));
    TRY(store_get(sim, store_find(sim, "radius")->mem, store_find(sim, "radius")->field->type, 0, sim->stride, a->radius, why));
    return store_get(sim, sim->partial, FIELD_EXACT, 0, sim->count, a->surface, why);
}

/* H/(pi r k) of every contact (HC Eq. 13), and h r/3k = (h A)/(12 pi r k) of every surface. */
static void collect(const simulation *sim, const biot_arrays *a, double *contact, double *surface)
{
    const contact_table *t = &sim->table;
    for (int64_t k = 0; k < t->wall_base + t->wall_record_count; k++)
        for (int side = 0; side < 2 && a->heat[k] > 0.0; side++) {
            int64_t i = side ? a->other[k] : a->owner[k];
            if (side && k >= t->wall_base)
                continue;
            int m = material_of(sim, a->id, i);
            note(contact, m, a->heat[k] / (M_PI * a->radius[i] * scene_material(sim->scene, m, &property_conductivity)));
        }
    for (int64_t i = 0; i < sim->count; i++) {
        int m = material_of(sim, a->id, i);
        note(surface, m, a->surface[i] / (12.0 * M_PI * a->radius[i] * scene_material(sim->scene, m, &property_conductivity)));
    }
}

status heat_biot(simulation *sim, double *contact, double *surface, failure *why)
{
    biot_arrays a = {0};
    if (!sim->live.law[SLOT_TEMPERATURE] || sim->count == 0)
        return STATUS_OK;
    TRY(heat_enqueue_coefficients(sim, why));
    status result = read_arrays(sim, &a, why);
    if (result == STATUS_OK)
        collect(sim, &a, contact, surface);
    free_arrays(&a);
    return result;
}
