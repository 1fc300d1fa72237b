/* Put before a program with LD_PRELOAD: makes calls of OpenCL or writes to files fail, or kills the program at them, as the environment says.
 *
 * CLAST_FAULT_CALL    clCreateBuffer, clSetKernelArg, ..., or write: anything that changes a file below CLAST_FAULT_FOLDER
 * CLAST_FAULT_AT      which of these calls, from 1 on; 0: none, they are only counted
 *                     (paths that begin at the working directory count as below it)
 * CLAST_FAULT_ACTION  fail: this call alone; full: this write and all later ones, as on a full disk; kill: SIGKILL in its place
 * CLAST_FAULT_COUNT   file that the number of calls is written to at the end
 *
 * Or makes a device out of the CPU that is less than it:
 * CLAST_FAULT_DEVICE  its memory and its largest buffer in bytes, `1000000,20000`: a GPU without fp64 */
#define _GNU_SOURCE
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

static long calls;

/* True where the call, by that name, is to fail. */
static bool fails(const char *name)
{
    const char *call = getenv("CLAST_FAULT_CALL"), *at = getenv("CLAST_FAULT_AT"), *action = getenv("CLAST_FAULT_ACTION");
    if (!call || strcmp(call, name) != 0)
        return false;
    long now = __atomic_add_fetch(&calls, 1, __ATOMIC_SEQ_CST), wanted = at ? atol(at) : 0;
    if (wanted == 0 || !action)
        return false;
    if (strcmp(action, "full") == 0)
        return now >= wanted;
    if (now == wanted && strcmp(action, "kill") == 0)
        raise(SIGKILL);
    return now == wanted;
}

__attribute__((destructor)) static void tell(void)
{
    const char *path = getenv("CLAST_FAULT_COUNT");
    FILE *file = path ? fopen(path, "w") : NULL;
    if (file) {
        fprintf(file, "%ld\n", calls);
        fclose(file);
    }
}

#define NEXT(name) ((__typeof__(&name))(uintptr_t)dlsym(RTLD_NEXT, #name))

/* ---- a lesser device ---- */

cl_int clGetDeviceInfo(cl_device_id device, cl_device_info what, size_t size, void *value, size_t *needed)
{
    const char *less = getenv("CLAST_FAULT_DEVICE"), *comma = less ? strchr(less, ',') : NULL;
    cl_int code = NEXT(clGetDeviceInfo)(device, what, size, value, needed);
    if (!comma || !value || code != CL_SUCCESS)
        return code;
    if (what == CL_DEVICE_TYPE)
        *(cl_device_type *)value = CL_DEVICE_TYPE_GPU;
    if (what == CL_DEVICE_DOUBLE_FP_CONFIG)
        *(cl_device_fp_config *)value = 0;
    if (what == CL_DEVICE_GLOBAL_MEM_SIZE)
        *(cl_ulong *)value = (cl_ulong)atoll(less);
    if (what == CL_DEVICE_MAX_MEM_ALLOC_SIZE)
        *(cl_ulong *)value = (cl_ulong)atoll(comma + 1);
    return code;
}

/* ---- files ---- */

static bool below(const char *path)
{
    const char *folder = getenv("CLAST_FAULT_FOLDER");
    return folder && (path[0] != '/' || strncmp(path, folder, strlen(folder)) == 0);
}

static bool watched(int descriptor)
{
    char link[64], path[4096];
    snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    ssize_t length = readlink(link, path, sizeof path - 1);
    if (length <= 0)
        return false;
    path[length] = '\0';
    return below(path);
}

static bool disk_fails(void)
{
    if (!fails("write"))
        return false;
    errno = ENOSPC;
    return true;
}

ssize_t write(int descriptor, const void *bytes, size_t size)
{
    return watched(descriptor) && disk_fails() ? -1 : NEXT(write)(descriptor, bytes, size);
}

ssize_t pwrite(int descriptor, const void *bytes, size_t size, off_t at)
{
    return watched(descriptor) && disk_fails() ? -1 : NEXT(pwrite)(descriptor, bytes, size, at);
}

ssize_t pwrite64(int descriptor, const void *bytes, size_t size, off64_t at)
{
    return watched(descriptor) && disk_fails() ? -1 : NEXT(pwrite64)(descriptor, bytes, size, at);
}

int rename(const char *from, const char *to)
{
    return below(to) && disk_fails() ? -1 : NEXT(rename)(from, to);
}

int fsync(int descriptor)
{
    return watched(descriptor) && disk_fails() ? -1 : NEXT(fsync)(descriptor);
}

/* ---- OpenCL ---- */

cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void *host, cl_int *error)
{
    if (!fails("clCreateBuffer"))
        return NEXT(clCreateBuffer)(context, flags, size, host, error);
    if (error)
        *error = CL_MEM_OBJECT_ALLOCATION_FAILURE;
    return NULL;
}

cl_kernel clCreateKernel(cl_program program, const char *name, cl_int *error)
{
    if (!fails("clCreateKernel"))
        return NEXT(clCreateKernel)(program, name, error);
    if (error)
        *error = CL_OUT_OF_HOST_MEMORY;
    return NULL;
}

cl_context clCreateContext(const cl_context_properties *properties, cl_uint count, const cl_device_id *devices,
                           void(CL_CALLBACK *notify)(const char *, const void *, size_t, void *), void *data, cl_int *error)
{
    if (!fails("clCreateContext"))
        return NEXT(clCreateContext)(properties, count, devices, notify, data, error);
    if (error)
        *error = CL_OUT_OF_HOST_MEMORY;
    return NULL;
}

cl_command_queue clCreateCommandQueue(cl_context context, cl_device_id device, cl_command_queue_properties properties, cl_int *error)
{
    if (!fails("clCreateCommandQueue"))
        return NEXT(clCreateCommandQueue)(context, device, properties, error);
    if (error)
        *error = CL_OUT_OF_RESOURCES;
    return NULL;
}

cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id *devices, const char *options,
                      void(CL_CALLBACK *notify)(cl_program, void *), void *data)
{
    return fails("clBuildProgram") ? CL_OUT_OF_RESOURCES : NEXT(clBuildProgram)(program, count, devices, options, notify, data);
}

#include "calls.h"
