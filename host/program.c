#include "program.h"

#include "cache.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A product with what is always 0 may be left out: no sign of a 0 counts, and no number is infinite or none but in a run that a guard will stop, which
 * looks at bits (kernels/stage/observe.cl). */
static const char build_options[] = "-cl-std=CL1.2 -cl-kernel-arg-info -cl-no-signed-zeros -cl-finite-math-only";

static status read_kernel_file(const char *directory, const char *name, char **text, failure *why)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s%s", directory, strcmp(name, "shared.h") == 0 ? "../include/clast/" : "", name);
    FILE *file = fopen(path, "rb");
    if (!file)
        return fail(why, STATUS_BAD_INPUT, "%s: cannot read this kernel file (%s); --kernels takes a directory laid out like kernels/", path,
                    strerror(errno));
    size_t size = 0, capacity = 1 << 16;
    char *content = malloc(capacity);
    for (size_t got; content && (got = fread(content + size, 1, capacity - size - 1, file)) > 0;) {
        size += got;
        if (size + 1 == capacity)
            content = realloc(content, capacity *= 2);
    }
    fclose(file);
    if (!content)
        return fail(why, STATUS_ERROR, "out of memory while reading %s", path);
    content[size] = '\0';
    *text = content;
    return STATUS_OK;
}

static const char *embedded_text(const char *name)
{
    for (const kernel_file *f = kernels_embedded; f->name; f++)
        if (strcmp(f->name, name) == 0)
            return f->text;
    return NULL;
}

status program_assemble(const char *constants, const char *const *files, int file_count, const char *directory, char **text, failure *why)
{
    const char *first[] = {"shared.h", "base.cl"};
    size_t size = 0;
    char *source = NULL;
    FILE *out = open_memstream(&source, &size);
    if (!out)
        return fail(why, STATUS_ERROR, "out of memory while assembling a program");
    fputs(constants, out);
    for (int f = -2; f < file_count; f++) {
        const char *name = f < 0 ? first[f + 2] : files[f];
        char *read = NULL;
        if (directory) {
            status result = read_kernel_file(directory, name, &read, why);
            if (result != STATUS_OK) {
                fclose(out);
                free(source);
                return result;
            }
        }
        const char *content = read ? read : embedded_text(name);
        if (!content) {
            fclose(out);
            free(source);
            return fail(why, STATUS_ERROR, "kernel file %s is not part of this build", name);
        }
        fprintf(out, "#line 1 \"%s\"\n%s\n", name, content);
        free(read);
    }
    fclose(out);
    *text = source;
    return STATUS_OK;
}

/* FNV-1a, 64 bits. */
static uint64_t hash_text(uint64_t hash, const char *text)
{
    for (const unsigned char *c = (const unsigned char *)text; *c; c++)
        hash = (hash ^ *c) * 1099511628211u;
    return (hash ^ 0xffu) * 1099511628211u;
}

static bool load_binary(const device *device, const char *path, cl_program *out)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return false;
    unsigned char *binary = NULL;
    long size = 0;
    if (fseek(file, 0, SEEK_END) == 0 && (size = ftell(file)) > 0) {
        rewind(file);
        binary = malloc((size_t)size);
    }
    bool whole = binary && fread(binary, 1, (size_t)size, file) == (size_t)size;
    fclose(file);
    cl_program program = NULL;
    if (whole) {
        size_t length = (size_t)size;
        cl_int code, loaded;
        const unsigned char *start = binary;
        program = clCreateProgramWithBinary(device->context, 1, &device->info.id, &length, &start, &loaded, &code);
        if (code != CL_SUCCESS)
            program = NULL;
        else if (clBuildProgram(program, 1, &device->info.id, build_options, NULL, NULL) != CL_SUCCESS) {
            clReleaseProgram(program);
            program = NULL;
        }
    }
    free(binary);
    *out = program;
    return program != NULL;
}

/* A cache that cannot be written is no error: the next run builds again. */
static void store_binary(cl_program program, const char *path)
{
    size_t size = 0;
    if (clGetProgramInfo(program, CL_PROGRAM_BINARY_SIZES, sizeof size, &size, NULL) != CL_SUCCESS || size == 0)
        return;
    unsigned char *binary = malloc(size);
    char temporary[4200];
    snprintf(temporary, sizeof temporary, "%s.%ld", path, (long)getpid());
    FILE *file = binary && clGetProgramInfo(program, CL_PROGRAM_BINARIES, sizeof binary, &binary, NULL) == CL_SUCCESS ? fopen(temporary, "wb") : NULL;
    if (file) {
        bool written = fwrite(binary, 1, size, file) == size;
        written = fclose(file) == 0 && written;
        if (!written || rename(temporary, path) != 0)
            unlink(temporary);
    }
    free(binary);
}

/* pocl keeps what it has compiled itself, kernel by kernel as they are used; asked for a program as a whole it would compile every kernel twice,
 * in a form that it then does not run. */
static bool driver_keeps_programs(const device *device)
{
    const char *switched = getenv("POCL_KERNEL_CACHE");
    return strcmp(device->info.platform_name, "Portable Computing Language") == 0 && !(switched && strcmp(switched, "0") == 0);
}

static status report_build(const device *device, cl_program program, const char *text, uint64_t key, failure *why)
{
    size_t size = 0;
    char path[4096] = "clast-program.cl";
    if (cache_directory(path, sizeof path)) {
        size_t used = strlen(path);
        snprintf(path + used, sizeof path - used, "/failed-%016llx.cl", (unsigned long long)key);
    }
    FILE *file = fopen(path, "wb");
    if (file) {
        fputs(text, file);
        fclose(file);
    }
    clGetProgramBuildInfo(program, device->info.id, CL_PROGRAM_BUILD_LOG, 0, NULL, &size);
    char *log = calloc(size + 1, 1);
    if (log)
        clGetProgramBuildInfo(program, device->info.id, CL_PROGRAM_BUILD_LOG, size, log, NULL);
    fail(why, STATUS_DEVICE, "the program does not build on %s; its source is in %s; the driver says:\n%.3000s", device->info.name,
         file ? path : "(not written)", log ? log : "");
    free(log);
    return STATUS_DEVICE;
}

/* ---- built before ---- */

#define SHELF_PLACES 16

struct program_shelf {
    struct shelved {
        char *text;
        cl_program program;
    } place[SHELF_PLACES];
    int next; /* place to be filled */
};

program_shelf *program_shelf_open(void)
{
    return calloc(1, sizeof(program_shelf));
}

static void clear(struct shelved *place)
{
    if (place->program)
        clReleaseProgram(place->program);
    free(place->text);
    *place = (struct shelved){NULL, NULL};
}

void program_shelf_close(program_shelf *shelf)
{
    for (int p = 0; shelf && p < SHELF_PLACES; p++)
        clear(&shelf->place[p]);
    free(shelf);
}

static bool take_from_shelf(const program_shelf *shelf, const char *text, cl_program *out)
{
    for (int p = 0; shelf && p < SHELF_PLACES; p++)
        if (shelf->place[p].program && strcmp(shelf->place[p].text, text) == 0 && clRetainProgram(shelf->place[p].program) == CL_SUCCESS) {
            *out = shelf->place[p].program;
            return true;
        }
    return false;
}

static void put_on_shelf(program_shelf *shelf, const char *text, cl_program program)
{
    char *copy = shelf ? strdup(text) : NULL;
    if (!copy)
        return;
    if (clRetainProgram(program) != CL_SUCCESS) {
        free(copy);
        return;
    }
    clear(&shelf->place[shelf->next]);
    shelf->place[shelf->next] = (struct shelved){copy, program};
    shelf->next = (shelf->next + 1) % SHELF_PLACES;
}

/* ---- building ---- */

static status build(const device *device, const char *text, cl_program *out, failure *why)
{
    uint64_t key = hash_text(14695981039346656037u, text);
    key = hash_text(hash_text(key, build_options), device->info.name);
    key = hash_text(hash_text(key, device->info.driver), device->info.version);
    char path[4096];
    bool cached = !driver_keeps_programs(device) && cache_directory(path, sizeof path);
    if (cached) {
        size_t used = strlen(path);
        snprintf(path + used, sizeof path - used, "/%016llx.bin", (unsigned long long)key);
        if (load_binary(device, path, out))
            return STATUS_OK;
    }
    cl_int code;
    cl_program program = clCreateProgramWithSource(device->context, 1, &text, NULL, &code);
    if (code != CL_SUCCESS)
        return fail(why, STATUS_DEVICE, "the device refuses the program: %s", device_error_name(code));
    if (clBuildProgram(program, 1, &device->info.id, build_options, NULL, NULL) != CL_SUCCESS) {
        status result = report_build(device, program, text, key, why);
        clReleaseProgram(program);
        return result;
    }
    if (cached)
        store_binary(program, path);
    *out = program;
    return STATUS_OK;
}

status program_build(const device *device, const char *text, cl_program *out, failure *why)
{
    if (take_from_shelf(device->programs, text, out))
        return STATUS_OK;
    TRY(build(device, text, out, why));
    put_on_shelf(device->programs, text, *out);
    return STATUS_OK;
}
