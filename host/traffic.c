#include "traffic.h"

#include "clock.h"
#include "program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SCAN_CHUNK 1024 /* kernels/stage/scan.cl */

/* How long an array is. */
typedef enum extent { OF_ONE, OF_GRAINS, OF_RECORDS, OF_SLOTS, OF_BLOCKS, OF_CELLS, OF_SCAN, OF_MOVED } extent;

/* Arrays that are no fields of a law, by the name of the argument; `passes` of those that a kernel writes: 1 where it does not read them.
 * What is not here has a size that does not grow with the bed. */
static const struct {
    const char *name;
    extent extent;
    int components, passes;
} arrays[] = {
    {"owner", OF_RECORDS, 1, 1},
    {"other", OF_RECORDS, 1, 1},
    {"old_owner", OF_RECORDS, 1, 1},
    {"old_other", OF_RECORDS, 1, 1},
    {"match", OF_RECORDS, 1, 1},
    {"slots", OF_SLOTS, 1, 1},
    {"old_slots", OF_SLOTS, 1, 1},
    {"placed", OF_SLOTS, 1, 1},
    {"slot_offset", OF_BLOCKS, 1, 1},
    {"old_slot_offset", OF_BLOCKS, 1, 1},
    {"width", OF_BLOCKS, 1, 1},
    {"last_record", OF_BLOCKS, 1, 1},
    {"built_position", OF_GRAINS, 3, 1},
    {"cell_of", OF_GRAINS, 1, 1},
    {"rank_of", OF_GRAINS, 1, 1},
    {"order", OF_GRAINS, 1, 1},
    {"where", OF_GRAINS, 1, 1},
    {"inverse", OF_GRAINS, 1, 1},
    {"found_count", OF_GRAINS, 1, 1},
    {"slot_count", OF_GRAINS, 1, 1},
    {"wall_count", OF_GRAINS, 1, 1},
    {"found_start", OF_GRAINS, 1, 1},
    {"wall_start", OF_GRAINS, 1, 1},
    {"cursor", OF_GRAINS, 1, 2},
    {"cell_count", OF_CELLS, 1, 2},
    {"cell_start", OF_CELLS, 1, 1},
    {"values", OF_SCAN, 1, 1},
    {"result", OF_SCAN, 1, 1},
    {"from", OF_MOVED, 1, 1},
    {"to", OF_MOVED, 1, 1},
};

/* ---- one argument ---- */

/* Of the fields that tables move, kernel launch by kernel launch: numbers of an element's size, on average. */
static double mean_elements(const simulation *sim, field_extent extent, double element)
{
    field_role moved = extent == PER_RECORD ? FIELD_HISTORY : FIELD_STATE;
    double sum = 0.0;
    int count = 0;
    for (int f = 0; f < sim->field_count; f++) {
        const field *field = sim->field[f].field;
        if (field->extent != extent || field->role != moved)
            continue;
        sum += field->components * (double)store_item(sim, field->type) / element;
        count++;
    }
    return count > 0 ? sum / count : 1.0;
}

static double elements(const simulation *sim, extent extent, const char *kernel, size_t items)
{
    const contact_table *t = &sim->table;
    bool carried = strcmp(kernel, "table_carry") == 0;
    switch (extent) {
    case OF_GRAINS:
        return (double)sim->count;
    case OF_RECORDS:
        return (double)t->record_count;
    case OF_SLOTS:
        return (double)t->slot_count;
    case OF_BLOCKS:
        return (double)sim->stride / sim->block;
    case OF_CELLS:
        return (double)t->grid_host.cell_count;
    case OF_SCAN:
        return (double)items * SCAN_CHUNK;
    case OF_MOVED:
        return carried ? (double)t->record_count * mean_elements(sim, PER_RECORD, (double)store_item(sim, FIELD_REAL))
                       : (double)sim->count * mean_elements(sim, PER_PARTICLE, 4.0);
    default:
        return 0.0;
    }
}

/* Bytes of an element by the argument's type; 0: no array of numbers. */
static double element_bytes(const simulation *sim, const char *type)
{
    if (strncmp(type, "exact", 5) == 0 || strncmp(type, "double", 6) == 0 || strncmp(type, "clast_f64", 9) == 0)
        return 8.0;
    if (strncmp(type, "real", 4) == 0)
        return sim->mixed ? 4.0 : 8.0;
    return strncmp(type, "int", 3) == 0 || strncmp(type, "uint", 4) == 0 || strncmp(type, "float", 5) == 0 ? 4.0 : 0.0;
}

/* Marks of what touches: only in a loose bed does anybody look at them. */
static bool is_left_alone(const simulation *sim, const field *field)
{
    const law *marks = sim->live.law[SLOT_TOUCHED];
    bool one = false;
    for (int f = 0; marks && f < LAW_ARGUMENTS_MAX; f++)
        one = one || marks->pair_fields[f] == field;
    return one && !launch_values(sim).loose;
}

static double field_traffic(const simulation *sim, const field *field, bool constant)
{
    if (is_left_alone(sim, field))
        return 0.0;
    double records = (double)sim->table.record_count,
           count[] = {[PER_PARTICLE] = (double)sim->count, [PER_RECORD] = records, [PER_RECORD_BLOCK] = records / sim->block, [PER_SCENE] = 0.0};
    return count[field->extent] * field->components * (double)store_item(sim, field->type) * (constant || field->role == FIELD_RESULT ? 1.0 : 2.0);
}

/* In the kernel of the loop the arguments of both stages stand side by side under names of their own. */
static const char *plain_name(const char *kernel, const char *name)
{
    if (strcmp(kernel, "step_loop") != 0)
        return name;
    return name + (strncmp(name, "pair_", 5) == 0 ? 5 : strncmp(name, "particle_", 9) == 0 ? 9 : 0);
}

static double argument_traffic(simulation *sim, const char *kernel, const char *name, const char *type, bool constant, size_t items)
{
    const stored_field *stored = store_find(sim, name);
    if (stored)
        return field_traffic(sim, stored->field, constant);
    for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++)
        if (strcmp(arrays[a].name, name) == 0)
            return elements(sim, arrays[a].extent, kernel, items) * arrays[a].components * element_bytes(sim, type) *
                   (constant ? 1 : arrays[a].passes);
    return 0.0;
}

/* ---- a launch, a step ---- */

/* Share of its arrays that a launch goes through: of a stage, or of what fills up the last work-groups. */
static double share_of(const simulation *sim, const char *kernel, size_t items)
{
    double grains = (double)((sim->count + sim->block - 1) / sim->block * sim->block), records = (double)sim->table.record_count;
    bool of_records = strcmp(kernel, "pair_stage") == 0 || strcmp(kernel, "table_pad") == 0;
    double whole = of_records ? records : strcmp(kernel, "particle_stage") == 0 ? grains : (double)items;
    return whole > 0.0 ? (double)items / whole : 0.0;
}

status traffic_of_launch(simulation *sim, cl_kernel kernel, const char *name, size_t items, double *bytes, failure *why)
{
    cl_uint arguments = 0;
    char argument[256], type[256];
    double sum = 0.0;
    TRY_CL(clGetKernelInfo(kernel, CL_KERNEL_NUM_ARGS, sizeof arguments, &arguments, NULL), name);
    for (cl_uint a = 0; a < arguments; a++) {
        cl_kernel_arg_address_qualifier space;
        cl_kernel_arg_type_qualifier qualifier;
        TRY_CL(clGetKernelArgInfo(kernel, a, CL_KERNEL_ARG_ADDRESS_QUALIFIER, sizeof space, &space, NULL), name);
        if (space != CL_KERNEL_ARG_ADDRESS_GLOBAL)
            continue;
        TRY_CL(clGetKernelArgInfo(kernel, a, CL_KERNEL_ARG_NAME, sizeof argument, argument, NULL), name);
        TRY_CL(clGetKernelArgInfo(kernel, a, CL_KERNEL_ARG_TYPE_NAME, sizeof type, type, NULL), name);
        TRY_CL(clGetKernelArgInfo(kernel, a, CL_KERNEL_ARG_TYPE_QUALIFIER, sizeof qualifier, &qualifier, NULL), name);
        sum += argument_traffic(sim, name, plain_name(name, argument), type, (qualifier & CL_KERNEL_ARG_TYPE_CONST) != 0, items);
    }
    *bytes = sum * share_of(sim, name, items);
    return STATUS_OK;
}

static status count_arguments(cl_kernel kernel, const char *name, int *out, failure *why)
{
    cl_uint arguments = 0;
    TRY_CL(clGetKernelInfo(kernel, CL_KERNEL_NUM_ARGS, sizeof arguments, &arguments, NULL), name);
    *out = (int)arguments;
    return STATUS_OK;
}

status traffic_of_step(simulation *sim, step_traffic *out, failure *why)
{
    cl_kernel pair = launch_kernel(sim, "pair_stage"), particle = launch_kernel(sim, "particle_stage");
    size_t grains = (size_t)((sim->count + sim->block - 1) / sim->block * sim->block);
    TRY(traffic_of_launch(sim, pair, "pair_stage", (size_t)sim->table.record_count, &out->pair_bytes, why));
    TRY(traffic_of_launch(sim, particle, "particle_stage", grains, &out->particle_bytes, why));
    TRY(count_arguments(pair, "pair_stage", &out->pair_arguments, why));
    return count_arguments(particle, "particle_stage", &out->particle_arguments, why);
}

field_sizes traffic_field_sizes(const simulation *sim)
{
    field_sizes sizes = {.grain = 3 * (double)store_item(sim, FIELD_EXACT), .record = 2 * 4.0}; /* where it was; owner and other */
    for (int f = 0; f < sim->field_count; f++) {
        const field *field = sim->field[f].field;
        double bytes = field->components * (double)store_item(sim, field->type);
        if (field->extent == PER_RECORD)
            sizes.record += bytes;
        else if (field->extent == PER_PARTICLE)
            sizes.grain += bytes;
    }
    return sizes;
}

/* ---- a copy of the same size ---- */

#define COPIES 15

static const char copy_source[] = "__kernel void copy(__global const uint4 *restrict from, __global uint4 *restrict to)\n"
                                  "{\n    size_t i = get_global_id(0);\n    to[i] = from[i];\n}\n";

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static status time_copies(device *device, cl_kernel kernel, size_t items, double *median, failure *why)
{
    size_t local = CLAST_BLOCK;
    double taken[COPIES];
    for (int c = -2; c < COPIES; c++) {
        double start = clock_seconds();
        TRY_CL(clEnqueueNDRangeKernel(device->queue, kernel, 1, NULL, &items, &local, 0, NULL, NULL), "a copy");
        TRY_CL(clFinish(device->queue), "a copy");
        if (c >= 0)
            taken[c] = clock_seconds() - start;
    }
    qsort(taken, COPIES, sizeof *taken, by_value);
    *median = taken[COPIES / 2];
    return STATUS_OK;
}

static status copy_between(device *device, cl_kernel kernel, cl_mem from, cl_mem to, size_t bytes, double *speed, failure *why)
{
    const cl_uint zero = 0;
    double median = 0.0;
    TRY_CL(clEnqueueFillBuffer(device->queue, from, &zero, sizeof zero, 0, bytes, 0, NULL, NULL), "a copy");
    TRY_CL(clEnqueueFillBuffer(device->queue, to, &zero, sizeof zero, 0, bytes, 0, NULL, NULL), "a copy");
    TRY_CL(clSetKernelArg(kernel, 0, sizeof from, &from), "a copy");
    TRY_CL(clSetKernelArg(kernel, 1, sizeof to, &to), "a copy");
    TRY(time_copies(device, kernel, bytes / 16, &median, why));
    *speed = 2.0 * (double)bytes / median;
    return STATUS_OK;
}

status traffic_copy_speed(device *device, double bytes, double *bytes_per_s, failure *why)
{
    size_t each = ((size_t)(0.5 * bytes) / (16 * CLAST_BLOCK) + 1) * (16 * CLAST_BLOCK);
    cl_program program;
    cl_int code, code_to;
    TRY(program_build(device, copy_source, &program, why));
    cl_kernel kernel = clCreateKernel(program, "copy", &code);
    if (code != CL_SUCCESS) {
        clReleaseProgram(program);
        return fail(why, STATUS_DEVICE, "the device failed: a copy (%s)", device_error_name(code));
    }
    cl_mem from = clCreateBuffer(device->context, CL_MEM_READ_WRITE, each, NULL, &code);
    cl_mem to = clCreateBuffer(device->context, CL_MEM_READ_WRITE, each, NULL, &code_to);
    status result = code == CL_SUCCESS && code_to == CL_SUCCESS
                        ? copy_between(device, kernel, from, to, each, bytes_per_s, why)
                        : fail(why, STATUS_DEVICE, "%s has no room for a copy of %.3g MB", device->info.name, 1e-6 * bytes);
    if (code == CL_SUCCESS)
        clReleaseMemObject(from);
    if (code_to == CL_SUCCESS)
        clReleaseMemObject(to);
    clReleaseKernel(kernel);
    clReleaseProgram(program);
    return result;
}
