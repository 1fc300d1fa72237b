/* Arrays on the device: allocation held against its limits, copies, and fields by name. */
#include "laws/fields.h"
#include "precision.h"
#include "simulation.h"

#include <stdlib.h>
#include <string.h>

const field field_position = {"position", PER_PARTICLE, FIELD_EXACT, 3, FIELD_STATE, "m", "position of the centre"};
const field field_velocity = {"velocity", PER_PARTICLE, FIELD_EXACT, 3, FIELD_STATE, "m/s", "velocity"};
const field field_radius = {"radius", PER_PARTICLE, FIELD_EXACT, 1, FIELD_STATE, "m", "radius"};
const field field_mass = {"mass", PER_PARTICLE, FIELD_REAL, 1, FIELD_STATE, "kg", "mass"};
const field field_id = {"id", PER_PARTICLE, FIELD_INT, 1, FIELD_STATE, "", "permanent id"};
const field field_force = {"force", PER_RECORD, FIELD_REAL, 3, FIELD_RESULT, "N", "force of a contact on its owner"};

/* Four numbers are loaded where three are wanted (kernels/stage/by_blocks.cl): one more behind the last grain's. */
static uint64_t buffer_bytes(uint64_t bytes)
{
    return (bytes > 64 ? bytes : 64) + 8;
}

status store_buffer(simulation *sim, cl_mem *mem, uint64_t bytes, const char *what, failure *why)
{
    const device_info *info = &sim->device->info;
    char needed[32], held[32], most[32];
    bytes = buffer_bytes(bytes);
    device_bytes(bytes, needed, sizeof needed);
    device_bytes(sim->bytes, held, sizeof held);
    if (sim->bytes + bytes > info->usable_bytes) {
        device_bytes(info->usable_bytes, most, sizeof most);
        return fail(why, STATUS_DEVICE,
                    "%s does not hold this scene: %s needs %s on top of %s, %s can be used; use fewer grains or a larger device",
                    info->name, what, needed, held, most);
    }
    if (!info->cpu && bytes > info->buffer_bytes) {
        device_bytes(info->buffer_bytes, most, sizeof most);
        return fail(why, STATUS_DEVICE, "%s does not allow buffers of more than %s; %s needs %s", info->name, most, what, needed);
    }
    cl_int code;
    *mem = clCreateBuffer(sim->device->context, CL_MEM_READ_WRITE, bytes, NULL, &code);
    if (code != CL_SUCCESS) {
        *mem = NULL;
        return fail(why, STATUS_DEVICE, "%s cannot allocate %s for %s (%s), with %s allocated before", info->name, needed, what,
                    device_error_name(code), held);
    }
    sim->bytes += bytes;
    return STATUS_OK;
}

void store_release(simulation *sim, cl_mem *mem, uint64_t bytes)
{
    if (*mem) {
        clReleaseMemObject(*mem);
        sim->bytes -= buffer_bytes(bytes);
    }
    *mem = NULL;
}

uint64_t store_item(const simulation *sim, field_type type)
{
    return type == FIELD_INT || (type == FIELD_REAL && sim->mixed) ? 4 : 8;
}

uint64_t field_bytes_at(const simulation *sim, const field *field, int64_t record_stride)
{
    int64_t count = sim->stride;
    if (field->extent == PER_RECORD || field->extent == PER_RECORD_BLOCK)
        count = field->extent == PER_RECORD ? record_stride : record_stride / sim->block + 1;
    return store_item(sim, field->type) * (uint64_t)(count * field->components);
}

uint64_t field_bytes(const simulation *sim, const field *field)
{
    return field_bytes_at(sim, field, sim->table.record_stride);
}

static status add_field(simulation *sim, const field *field, failure *why)
{
    stored_field *stored = &sim->field[sim->field_count];
    TRY(store_buffer(sim, &stored->mem, field_bytes(sim, field), field->name, why));
    stored->field = field;
    sim->field_count++;
    return store_fill(sim, stored->mem, field_bytes(sim, field), why);
}

static void need_field(const field *field, const struct field **out, int *count, int max)
{
    bool known = !field || field->extent == PER_SCENE;
    for (int f = 0; f < *count && !known; f++)
        known = strcmp(out[f]->name, field->name) == 0;
    if (!known && *count < max)
        out[(*count)++] = field;
}

int store_needs(const live_laws *all, const field **out, int max)
{
    const field *const core[] = {&field_position, &field_velocity, &field_radius, &field_mass, &field_id, &field_force};
    int count = 0;
    for (size_t f = 0; f < sizeof core / sizeof *core; f++)
        need_field(core[f], out, &count, max);
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
        for (int f = 0; all->law[slot] && f < LAW_ARGUMENTS_MAX; f++) {
            need_field(all->law[slot]->pair_fields[f], out, &count, max);
            need_field(all->law[slot]->particle_fields[f], out, &count, max);
        }
    return count;
}

status store_fields(simulation *sim, failure *why)
{
    const field *needed[SIMULATION_FIELDS_MAX];
    int count = store_needs(&sim->all, needed, SIMULATION_FIELDS_MAX);
    for (int f = 0; f < count; f++)
        TRY(add_field(sim, needed[f], why));
    return STATUS_OK;
}

stored_field *store_find(simulation *sim, const char *name)
{
    for (int f = 0; f < sim->field_count; f++)
        if (strcmp(sim->field[f].field->name, name) == 0)
            return &sim->field[f];
    return NULL;
}

/* What is small is copied and written without waiting for it: to wait costs more than many a kernel. The copies stay until something has been
 * waited for, which all that was enqueued before it has ended by then. */
status store_write(simulation *sim, cl_mem mem, uint64_t offset, uint64_t bytes, const void *data, failure *why)
{
    outbox *box = &sim->outbox;
    if (bytes == 0)
        return STATUS_OK;
    if (!box->copy)
        box->copy = malloc(OUTBOX_BYTES);
    bool waits = !box->copy || bytes > OUTBOX_BYTES - box->used;
    if (!waits) {
        data = memcpy(box->copy + box->used, data, bytes);
        box->used += (bytes + 63) / 64 * 64;
    }
    TRY_CL(clEnqueueWriteBuffer(sim->device->queue, mem, waits ? CL_TRUE : CL_FALSE, offset, bytes, data, 0, NULL, NULL),
           "writing to the device");
    box->used = waits ? 0 : box->used;
    return STATUS_OK;
}

status store_read(simulation *sim, cl_mem mem, uint64_t offset, uint64_t bytes, void *data, failure *why)
{
    if (bytes == 0)
        return STATUS_OK;
    TRY_CL(clEnqueueReadBuffer(sim->device->queue, mem, CL_TRUE, offset, bytes, data, 0, NULL, NULL), "reading from the device");
    sim->outbox.used = 0;
    return STATUS_OK;
}

status store_put(simulation *sim, cl_mem mem, field_type type, int64_t first, int64_t count, const double *values, failure *why)
{
    uint64_t item = store_item(sim, type), offset = item * (uint64_t)first, bytes = item * (uint64_t)count;
    if (!sim->mixed)
        return store_write(sim, mem, offset, bytes, values, why);
    void *copy = malloc(bytes + 1);
    if (!copy)
        return fail(why, STATUS_ERROR, "out of memory");
    if (type == FIELD_EXACT)
        precision_split(memcpy(copy, values, bytes), count);
    for (int64_t n = 0; type == FIELD_REAL && n < count; n++)
        ((float *)copy)[n] = (float)values[n];
    status result = store_write(sim, mem, offset, bytes, copy, why);
    free(copy);
    return result;
}

status store_get(simulation *sim, cl_mem mem, field_type type, int64_t first, int64_t count, double *values, failure *why)
{
    uint64_t item = store_item(sim, type), offset = item * (uint64_t)first, bytes = item * (uint64_t)count;
    TRY(store_read(sim, mem, offset, bytes, values, why));
    if (sim->mixed && type == FIELD_EXACT)
        precision_join(values, count);
    for (int64_t n = count; sim->mixed && type == FIELD_REAL && n-- > 0;) { /* from the end, in place */
        float narrow;
        memcpy(&narrow, (const char *)values + 4 * n, sizeof narrow);
        values[n] = narrow;
    }
    return STATUS_OK;
}

status store_put_grains(simulation *sim, const stored_field *stored, int64_t count, const double *values, failure *why)
{
    int components = stored->field->components;
    if (!sim->mixed || stored->field != &field_position)
        return store_put(sim, stored->mem, stored->field->type, 0, count * components, values, why);
    double *moved = malloc(sizeof *moved * (size_t)(3 * count + 1));
    if (!moved)
        return fail(why, STATUS_ERROR, "out of memory");
    for (int64_t n = 0; n < 3 * count; n++)
        moved[n] = values[n] - sim->origin[n % 3];
    status result = store_put(sim, stored->mem, FIELD_EXACT, 0, 3 * count, moved, why);
    free(moved);
    return result;
}

status store_get_grains(simulation *sim, const stored_field *stored, int64_t count, double *values, failure *why)
{
    TRY(store_get(sim, stored->mem, stored->field->type, 0, count * stored->field->components, values, why));
    for (int64_t n = 0; sim->mixed && stored->field == &field_position && n < 3 * count; n++)
        values[n] += sim->origin[n % 3];
    return STATUS_OK;
}

status store_fill(simulation *sim, cl_mem mem, uint64_t bytes, failure *why)
{
    const cl_uint zero = 0;
    if (bytes > 0)
        TRY_CL(clEnqueueFillBuffer(sim->device->queue, mem, &zero, sizeof zero, 0, bytes, 0, NULL, NULL), "clearing a buffer");
    return STATUS_OK;
}

status store_copy(simulation *sim, cl_mem from, cl_mem to, uint64_t from_offset, uint64_t to_offset, uint64_t bytes, failure *why)
{
    if (bytes > 0)
        TRY_CL(clEnqueueCopyBuffer(sim->device->queue, from, to, from_offset, to_offset, bytes, 0, NULL, NULL), "copying on the device");
    return STATUS_OK;
}

status store_clear_ints(simulation *sim, cl_mem mem, int64_t first, int64_t count, failure *why)
{
    const cl_uint zero = 0;
    TRY_CL(clEnqueueFillBuffer(sim->device->queue, mem, &zero, sizeof zero, 4 * (size_t)first, 4 * (size_t)count, 0, NULL, NULL),
           "clearing a buffer");
    return STATUS_OK;
}
