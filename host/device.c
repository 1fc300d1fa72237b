#include "device.h"

#include "program.h"
#include "tuning.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PLATFORMS_MAX 32
#define DEVICES_MAX   64 /* of one platform */

/* What the loader answers when it finds no platform (cl_khr_icd), which CL/cl.h does not name. */
#define PLATFORM_NOT_FOUND (-1001)

#define INSTALL_HINT       "on Debian or Ubuntu, `apt install pocl-opencl-icd` lets the CPU compute; a GPU needs its vendor's driver"

static const struct {
    cl_int code;
    const char *name;
} error_names[] = {
#define ERROR(name) \
    {               \
        name, #name \
    }
    ERROR(CL_SUCCESS),
    ERROR(CL_DEVICE_NOT_FOUND),
    ERROR(CL_DEVICE_NOT_AVAILABLE),
    ERROR(CL_COMPILER_NOT_AVAILABLE),
    ERROR(CL_MEM_OBJECT_ALLOCATION_FAILURE),
    ERROR(CL_OUT_OF_RESOURCES),
    ERROR(CL_OUT_OF_HOST_MEMORY),
    ERROR(CL_PROFILING_INFO_NOT_AVAILABLE),
    ERROR(CL_MEM_COPY_OVERLAP),
    ERROR(CL_IMAGE_FORMAT_MISMATCH),
    ERROR(CL_IMAGE_FORMAT_NOT_SUPPORTED),
    ERROR(CL_BUILD_PROGRAM_FAILURE),
    ERROR(CL_MAP_FAILURE),
    ERROR(CL_MISALIGNED_SUB_BUFFER_OFFSET),
    ERROR(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST),
    ERROR(CL_COMPILE_PROGRAM_FAILURE),
    ERROR(CL_LINKER_NOT_AVAILABLE),
    ERROR(CL_LINK_PROGRAM_FAILURE),
    ERROR(CL_DEVICE_PARTITION_FAILED),
    ERROR(CL_KERNEL_ARG_INFO_NOT_AVAILABLE),
    ERROR(CL_INVALID_VALUE),
    ERROR(CL_INVALID_DEVICE_TYPE),
    ERROR(CL_INVALID_PLATFORM),
    ERROR(CL_INVALID_DEVICE),
    ERROR(CL_INVALID_CONTEXT),
    ERROR(CL_INVALID_QUEUE_PROPERTIES),
    ERROR(CL_INVALID_COMMAND_QUEUE),
    ERROR(CL_INVALID_HOST_PTR),
    ERROR(CL_INVALID_MEM_OBJECT),
    ERROR(CL_INVALID_IMAGE_FORMAT_DESCRIPTOR),
    ERROR(CL_INVALID_IMAGE_SIZE),
    ERROR(CL_INVALID_SAMPLER),
    ERROR(CL_INVALID_BINARY),
    ERROR(CL_INVALID_BUILD_OPTIONS),
    ERROR(CL_INVALID_PROGRAM),
    ERROR(CL_INVALID_PROGRAM_EXECUTABLE),
    ERROR(CL_INVALID_KERNEL_NAME),
    ERROR(CL_INVALID_KERNEL_DEFINITION),
    ERROR(CL_INVALID_KERNEL),
    ERROR(CL_INVALID_ARG_INDEX),
    ERROR(CL_INVALID_ARG_VALUE),
    ERROR(CL_INVALID_ARG_SIZE),
    ERROR(CL_INVALID_KERNEL_ARGS),
    ERROR(CL_INVALID_WORK_DIMENSION),
    ERROR(CL_INVALID_WORK_GROUP_SIZE),
    ERROR(CL_INVALID_WORK_ITEM_SIZE),
    ERROR(CL_INVALID_GLOBAL_OFFSET),
    ERROR(CL_INVALID_EVENT_WAIT_LIST),
    ERROR(CL_INVALID_EVENT),
    ERROR(CL_INVALID_OPERATION),
    ERROR(CL_INVALID_GL_OBJECT),
    ERROR(CL_INVALID_BUFFER_SIZE),
    ERROR(CL_INVALID_MIP_LEVEL),
    ERROR(CL_INVALID_GLOBAL_WORK_SIZE),
    ERROR(CL_INVALID_PROPERTY),
    ERROR(CL_INVALID_IMAGE_DESCRIPTOR),
    ERROR(CL_INVALID_COMPILER_OPTIONS),
    ERROR(CL_INVALID_LINKER_OPTIONS),
    ERROR(CL_INVALID_DEVICE_PARTITION_COUNT),
#undef ERROR
    {PLATFORM_NOT_FOUND, "CL_PLATFORM_NOT_FOUND_KHR"},
};

const char *device_error_name(cl_int code)
{
    for (size_t k = 0; k < sizeof error_names / sizeof error_names[0]; k++)
        if (error_names[k].code == code)
            return error_names[k].name;
    return "an error code that OpenCL 1.2 does not define";
}

/* Drivers pad names with blanks. */
static void trim(char *text)
{
    size_t first = strspn(text, " \t\n"), length = strlen(text + first);
    while (length > 0 && isspace((unsigned char)text[first + length - 1]))
        length--;
    memmove(text, text + first, length);
    text[length] = '\0';
}

/* A text too long for its place is cut, which clGetDeviceInfo itself will not do. */
static void copy_text(char *text, size_t size, char *from)
{
    trim(from);
    snprintf(text, size, "%.*s", (int)size - 1, from);
}

static void device_text(cl_device_id id, cl_device_info what, char *text, size_t size)
{
    char whole[4096] = "";
    if (clGetDeviceInfo(id, what, sizeof whole - 1, whole, NULL) != CL_SUCCESS)
        whole[0] = '\0';
    copy_text(text, size, whole);
}

/* What the host can give without swapping; 0 when /proc does not say. */
static uint64_t available_bytes(void)
{
    FILE *file = fopen("/proc/meminfo", "r");
    if (!file)
        return 0;
    char line[256];
    unsigned long long kilobytes = 0;
    while (fgets(line, sizeof line, file))
        if (sscanf(line, "MemAvailable: %llu kB", &kilobytes) == 1)
            break;
    fclose(file);
    return (uint64_t)kilobytes * 1024;
}

static void describe_platform(cl_platform_id platform, char *text, size_t size)
{
    char whole[4096] = "";
    if (clGetPlatformInfo(platform, CL_PLATFORM_NAME, sizeof whole - 1, whole, NULL) != CL_SUCCESS)
        whole[0] = '\0';
    copy_text(text, size, whole);
}

static cl_int read_info(cl_platform_id platform, cl_device_id id, device_info *out)
{
    cl_device_type type = 0;
    cl_ulong memory = 0, buffer = 0;
    cl_uint units = 0, lanes = 1;
    size_t argument = 0;
    cl_device_fp_config fp64 = 0;
    cl_int code = clGetDeviceInfo(id, CL_DEVICE_TYPE, sizeof type, &type, NULL);
    if (code == CL_SUCCESS)
        code = clGetDeviceInfo(id, CL_DEVICE_GLOBAL_MEM_SIZE, sizeof memory, &memory, NULL);
    if (code == CL_SUCCESS)
        code = clGetDeviceInfo(id, CL_DEVICE_MAX_MEM_ALLOC_SIZE, sizeof buffer, &buffer, NULL);
    if (code == CL_SUCCESS)
        code = clGetDeviceInfo(id, CL_DEVICE_MAX_COMPUTE_UNITS, sizeof units, &units, NULL);
    if (code == CL_SUCCESS)
        code = clGetDeviceInfo(id, CL_DEVICE_MAX_PARAMETER_SIZE, sizeof argument, &argument, NULL);
    if (code != CL_SUCCESS)
        return code;
    /* Old drivers answer with an error where they have no fp64. */
    if (clGetDeviceInfo(id, CL_DEVICE_DOUBLE_FP_CONFIG, sizeof fp64, &fp64, NULL) != CL_SUCCESS)
        fp64 = 0;
    if (clGetDeviceInfo(id, CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT, sizeof lanes, &lanes, NULL) != CL_SUCCESS || lanes < 1)
        lanes = 1;
    *out = (device_info){.platform = platform,
                         .id = id,
                         .cpu = (type & CL_DEVICE_TYPE_CPU) != 0,
                         .gpu = (type & CL_DEVICE_TYPE_GPU) != 0,
                         .fp64 = fp64 != 0,
                         .memory_bytes = memory,
                         .buffer_bytes = buffer,
                         .usable_bytes = memory,
                         .compute_units = units,
                         .float_lanes = lanes,
                         .argument_bytes = argument};
    /* pocl reports only part of the host's memory, and allocates more. */
    uint64_t available = out->cpu ? available_bytes() : 0;
    if (available > 0)
        out->usable_bytes = available;
    device_text(id, CL_DEVICE_NAME, out->name, sizeof out->name);
    device_text(id, CL_DEVICE_VENDOR, out->vendor, sizeof out->vendor);
    device_text(id, CL_DRIVER_VERSION, out->driver, sizeof out->driver);
    device_text(id, CL_DEVICE_VERSION, out->version, sizeof out->version);
    describe_platform(platform, out->platform_name, sizeof out->platform_name);
    return CL_SUCCESS;
}

/* Appends a platform's devices. A platform that fails is passed over, since another one may work, but its code is kept. */
static cl_int add_platform(cl_platform_id platform, device_info *list, int *count)
{
    cl_device_id id[DEVICES_MAX];
    cl_uint found = 0;
    cl_int code = clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, DEVICES_MAX, id, &found);
    if (code != CL_SUCCESS)
        return code;
    for (cl_uint k = 0; k < found && k < DEVICES_MAX; k++) {
        cl_int one = read_info(platform, id[k], &list[*count]);
        if (one == CL_SUCCESS)
            (*count)++;
        else
            code = one;
    }
    return code;
}

status device_list(device_info **out, int *count, failure *why)
{
    *out = NULL;
    *count = 0;
    cl_platform_id platform[PLATFORMS_MAX];
    cl_uint platforms = 0;
    cl_int code = clGetPlatformIDs(PLATFORMS_MAX, platform, &platforms);
    if (code == PLATFORM_NOT_FOUND || (code == CL_SUCCESS && platforms == 0))
        return fail(why, STATUS_DEVICE, "there is no OpenCL platform on this machine; " INSTALL_HINT);
    if (code != CL_SUCCESS)
        return fail(why, STATUS_DEVICE, "the OpenCL platforms cannot be listed (%s); " INSTALL_HINT, device_error_name(code));
    if (platforms > PLATFORMS_MAX)
        platforms = PLATFORMS_MAX;
    device_info *list = calloc((size_t)platforms * DEVICES_MAX, sizeof *list);
    if (!list)
        return fail(why, STATUS_ERROR, "out of memory while listing devices");
    cl_int trouble = CL_DEVICE_NOT_FOUND;
    for (cl_uint k = 0; k < platforms; k++) {
        code = add_platform(platform[k], list, count);
        if (code != CL_SUCCESS && code != CL_DEVICE_NOT_FOUND)
            trouble = code;
    }
    if (*count == 0) {
        free(list);
        return fail(why, STATUS_DEVICE, "none of the %u OpenCL platforms on this machine has a device (%s); " INSTALL_HINT,
                    (unsigned)platforms, device_error_name(trouble));
    }
    *out = list;
    return STATUS_OK;
}

static bool is_index(const char *choice)
{
    return choice[0] != '\0' && choice[strspn(choice, "0123456789")] == '\0';
}

static bool matches(const device_info *info, const char *choice)
{
    if (strcasecmp(choice, "cpu") == 0)
        return info->cpu;
    if (strcasecmp(choice, "gpu") == 0)
        return info->gpu;
    return strcasestr(info->name, choice) != NULL;
}

/* "0: name (GPU), 1: name (CPU)". */
static void list_names(const device_info *list, int count, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (int k = 0; k < count && used < size; k++) {
        const char *type = list[k].gpu ? "GPU" : list[k].cpu ? "CPU" : "accelerator";
        const char *fp64 = list[k].fp64 ? "" : ", no fp64";
        int written = snprintf(text + used, size - used, "%s%d: %s (%s%s)", k ? ", " : "", k, list[k].name, type, fp64);
        used += written > 0 ? (size_t)written : 0;
    }
}

/* First of the devices that fit, those that can hold doubles before those that cannot; -1: none. */
static int first_match(const device_info *list, int count, const char *choice, bool needs_fp64)
{
    int without = -1;
    for (int k = 0; k < count; k++) {
        if (!matches(&list[k], choice))
            continue;
        if (list[k].fp64 || !needs_fp64)
            return k;
        if (without < 0)
            without = k;
    }
    return without;
}

static int automatic(const device_info *list, int count, bool needs_fp64)
{
    int gpu = first_match(list, count, "gpu", needs_fp64);
    if (gpu >= 0 && (list[gpu].fp64 || !needs_fp64))
        return gpu;
    return first_match(list, count, "", needs_fp64);
}

status device_choose(const device_info *list, int count, const char *choice, bool needs_fp64, int *index, failure *why)
{
    char names[2048];
    list_names(list, count, names, sizeof names);
    if (count <= 0)
        return fail(why, STATUS_DEVICE, "there is no OpenCL device on this machine; " INSTALL_HINT);
    int found;
    if (!choice || !choice[0]) {
        found = automatic(list, count, needs_fp64);
    } else if (is_index(choice)) {
        errno = 0;
        long wanted = strtol(choice, NULL, 10);
        found = errno == 0 && wanted < count ? (int)wanted : -1;
    } else {
        found = first_match(list, count, choice, needs_fp64);
    }
    if (found < 0)
        return fail(why, STATUS_DEVICE, "no device answers to `%.200s`; there is %s", choice, names);
    if (needs_fp64 && !list[found].fp64)
        return fail(why, STATUS_DEVICE,
                    "the device %s has no fp64, which double precision needs; `precision: mixed` does without; there is %s",
                    list[found].name, names);
    *index = found;
    return STATUS_OK;
}

static status open_info(const device_info *info, device *out, failure *why)
{
    cl_int code;
    *out = (device){.info = *info, .tuning = tuning_load(info)};
    const cl_context_properties properties[] = {CL_CONTEXT_PLATFORM, (cl_context_properties)info->platform, 0};
    out->context = clCreateContext(properties, 1, &info->id, NULL, NULL, &code);
    if (code != CL_SUCCESS)
        return fail(why, STATUS_DEVICE, "the device %s cannot be opened: clCreateContext (%s)", info->name, device_error_name(code));
    out->queue = clCreateCommandQueue(out->context, info->id, 0, &code);
    if (code != CL_SUCCESS) {
        clReleaseContext(out->context);
        *out = (device){0};
        return fail(why, STATUS_DEVICE, "the device %s cannot be opened: clCreateCommandQueue (%s)", info->name, device_error_name(code));
    }
    out->programs = program_shelf_open();
    return STATUS_OK;
}

void device_bytes(uint64_t bytes, char *text, size_t size)
{
    double b = (double)bytes;
    if (b < 1e6)
        snprintf(text, size, "%.1f kB", 1e-3 * b);
    else if (b < 1e9)
        snprintf(text, size, "%.1f MB", 1e-6 * b);
    else
        snprintf(text, size, "%.2f GB", 1e-9 * b);
}

status device_open(const char *choice, bool needs_fp64, device *out, failure *why)
{
    device_info *list;
    int count, index;
    *out = (device){0};
    TRY(device_list(&list, &count, why));
    status result = device_choose(list, count, choice, needs_fp64, &index, why);
    if (result == STATUS_OK)
        result = open_info(&list[index], out, why);
    free(list);
    return result;
}

void device_close(device *d)
{
    program_shelf_close(d->programs);
    if (d->queue)
        clReleaseCommandQueue(d->queue);
    if (d->context)
        clReleaseContext(d->context);
    *d = (device){0};
}

void device_describe(const device_info *info, char *text, size_t size)
{
    snprintf(text, size, "%s (%s, driver %s)", info->name, info->platform_name, info->driver);
}
