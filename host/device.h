/* OpenCL devices: which there are, which one to use, and what it can hold. */
#ifndef CLAST_HOST_DEVICE_H
#define CLAST_HOST_DEVICE_H
#include "status.h"

#include <CL/cl.h>
#include <stdint.h>

typedef struct device_info {
    cl_platform_id platform;
    cl_device_id id;
    char name[256], vendor[256], driver[128], version[128], platform_name[256];
    bool cpu, gpu, fp64;
    uint64_t memory_bytes;        /* as the device reports it */
    uint64_t buffer_bytes;        /* largest single buffer, as reported */
    uint64_t usable_bytes;        /* what a plan is held against: on a CPU device the host's available memory */
    uint32_t compute_units;
    uint32_t float_lanes; /* floats in its widest register; 1 where it does not say */
    uint64_t argument_bytes;
} device_info;

/* What is fastest on the device (tuning.h). Results do not depend on it, but for the last bits of implicit steps of heat. */
typedef struct tuning {
    int block;         /* grains or records a work-group */
    int batch_steps;   /* steps between two looks of the host */
    int chunk_records; /* of large beds that go through the stages in chunks; 0: none do */
    int loop_records;  /* beds of fewer go through many steps in one work-group */
    bool measured;
} tuning;

typedef struct device {
    device_info info;
    cl_context context;
    cl_command_queue queue; /* in order */
    tuning tuning;
    struct program_shelf *programs; /* those built last, for the next run of the same laws (program.h) */
} device;

/* Every device of every platform, in the order in which the loader lists them. No platform or no device: STATUS_DEVICE with what to
 * install. Caller frees. */
status device_list(device_info **out, int *count, failure *why);
/* Index of the device that `choice` (NULL or "": automatic; an index; "cpu"; "gpu"; part of a name, any case) means. Automatic takes a GPU
 * where there is one (with fp64 if needed), else the first. Several matches: the first. None: STATUS_DEVICE and the list of what there is. */
status device_choose(const device_info *list, int count, const char *choice, bool needs_fp64, int *index, failure *why);
status device_open(const char *choice, bool needs_fp64, device *out, failure *why);
void device_close(device *d);
/* Name of an OpenCL error code ("CL_OUT_OF_RESOURCES"). */
const char *device_error_name(cl_int code);
/* "44.5 kB", "1.20 GB" */
void device_bytes(uint64_t bytes, char *text, size_t size);
/* "pthread-... (pocl 3.1, driver ...)" in one line, for results and messages. */
void device_describe(const device_info *info, char *text, size_t size);

#define TRY_CL(call, what)                                                                                       \
    do {                                                                                                         \
        cl_int try_code_ = (call);                                                                               \
        if (try_code_ != CL_SUCCESS)                                                                             \
            return fail(why, STATUS_DEVICE, "the device failed: %s (%s)", what, device_error_name(try_code_));   \
    } while (0)

#endif
