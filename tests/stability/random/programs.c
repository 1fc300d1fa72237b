/* Programs are kept between the scenes of one structure, which would else be parsed for every scene anew: the calls of OpenCL that make them stand
 * before those of the library. */
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <dlfcn.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define KEPT_MOST 8
/* The library's own; ISO C knows no way from an address of data to one of code. */
#define NEXT(name) ((__typeof__(&name))(uintptr_t)dlsym(RTLD_NEXT, #name))

typedef struct kept_program {
    char *text;
    cl_program program;
    bool built;
    unsigned long used;
} kept_program;

static kept_program kept[KEPT_MOST];
static unsigned long clock_of_uses;

/* A place that is free, or that of the program used longest ago. */
static kept_program *place_for_another(void)
{
    kept_program *oldest = &kept[0];
    for (int k = 0; k < KEPT_MOST; k++)
        if (kept[k].used < oldest->used)
            oldest = &kept[k];
    if (oldest->program)
        clReleaseProgram(oldest->program);
    free(oldest->text);
    *oldest = (kept_program){0};
    return oldest;
}

cl_program clCreateProgramWithSource(cl_context context, cl_uint count, const char **strings, const size_t *lengths, cl_int *error)
{
    for (int k = 0; k < KEPT_MOST; k++)
        if (kept[k].built && strcmp(kept[k].text, strings[0]) == 0) {
            kept[k].used = ++clock_of_uses;
            clRetainProgram(kept[k].program);
            *error = CL_SUCCESS;
            return kept[k].program;
        }
    cl_program program = NEXT(clCreateProgramWithSource)(context, count, strings, lengths, error);
    if (program && count == 1 && !lengths) {
        clRetainProgram(program);
        *place_for_another() = (kept_program){.text = strdup(strings[0]), .program = program, .used = ++clock_of_uses};
    }
    return program;
}

cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id *devices, const char *options,
                      void(CL_CALLBACK *notify)(cl_program, void *), void *data)
{
    kept_program *found = NULL;
    for (int k = 0; k < KEPT_MOST; k++)
        if (kept[k].program == program)
            found = &kept[k];
    if (found && found->built)
        return CL_SUCCESS;
    cl_int code = NEXT(clBuildProgram)(program, count, devices, options, notify, data);
    if (found)
        found->built = code == CL_SUCCESS;
    return code;
}
