/* Roots and powers that kernels work out by arithmetic alone, in both precisions, against those of the C library. */
#include "device.h"
#include "program.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* cmocka has a macro called fail, so it comes after the headers that declare the function. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define NUMBERS 4096

static const char kernel_text[] = "__kernel void powers(__global const real *x, __global const real *y, __global real *power, __global real *root)\n"
                                  "{\n"
                                  "    int i = get_global_id(0);\n"
                                  "    power[i] = power_of(x[i], y[i]);\n"
                                  "    root[i] = cube_root(x[i]);\n"
                                  "}\n";

static device *opened(void)
{
    static device d;
    failure why = {.text = ""};
    if (!d.context && device_open(NULL, false, &d, &why) != STATUS_OK)
        fail_msg("%s", why.text);
    return &d;
}

/* Both precisions at 32 or 64 bits a number. */
typedef struct numbers {
    size_t size;
    void *x, *y, *power, *root;
} numbers;

static double get(const numbers *n, const void *from, int i)
{
    return n->size == 4 ? ((const float *)from)[i] : ((const double *)from)[i];
}

static void set(const numbers *n, void *to, int i, double value)
{
    if (n->size == 4)
        ((float *)to)[i] = (float)value;
    else
        ((double *)to)[i] = value;
}

static void run(numbers *n)
{
    device *d = opened();
    failure why = {.text = ""};
    char *base, *text;
    cl_program program;
    cl_int code;
    assert_int_equal(program_assemble(n->size == 4 ? "#define REAL_IS_FLOAT\n" : "", NULL, 0, getenv("CLAST_KERNELS"), &base, &why), STATUS_OK);
    assert_true(asprintf(&text, "%s\n%s", base, kernel_text) > 0);
    if (program_build(d, text, &program, &why) != STATUS_OK)
        fail_msg("%s", why.text);
    cl_kernel kernel = clCreateKernel(program, "powers", &code);
    assert_int_equal(code, CL_SUCCESS);
    void *const at[] = {n->x, n->y, n->power, n->root};
    cl_mem memory[4];
    for (int a = 0; a < 4; a++) {
        memory[a] = clCreateBuffer(d->context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, n->size * NUMBERS, at[a], &code);
        assert_int_equal(code, CL_SUCCESS);
        assert_int_equal(clSetKernelArg(kernel, (cl_uint)a, sizeof memory[a], &memory[a]), CL_SUCCESS);
    }
    const size_t items = NUMBERS;
    assert_int_equal(clEnqueueNDRangeKernel(d->queue, kernel, 1, NULL, &items, NULL, 0, NULL, NULL), CL_SUCCESS);
    for (int a = 0; a < 4; a++) {
        assert_int_equal(clEnqueueReadBuffer(d->queue, memory[a], CL_TRUE, 0, n->size * NUMBERS, at[a], 0, NULL, NULL), CL_SUCCESS);
        clReleaseMemObject(memory[a]);
    }
    clReleaseKernel(kernel);
    clReleaseProgram(program);
    free(text);
    free(base);
}

/* What rounds: log2 of what is left of x, which is at most 1/2 and taken times y (2|y| of half a last place at most), and the last series. */
static void check(size_t size, double last_place)
{
    numbers n = {size, calloc(NUMBERS, size), calloc(NUMBERS, size), calloc(NUMBERS, size), calloc(NUMBERS, size)};
    const double range = size == 4 ? 5.0 : 40.0;
    for (int i = 0; i < NUMBERS; i++) {
        double u = fmod(0.6180339887498949 * i, 1.0), v = fmod(0.7548776662466927 * i, 1.0);
        set(&n, n.x, i, pow(10.0, range * (2.0 * u - 1.0)));
        set(&n, n.y, i, i % 8 == 0 ? (i / 8) % 13 * 0.25 - 1.5 : 12.0 * v - 6.0);
    }
    set(&n, n.x, 1, 1.0);
    set(&n, n.y, 2, 0.0);
    run(&n);
    assert_true(get(&n, n.power, 1) == 1.0 && get(&n, n.power, 2) == 1.0);
    for (int i = 0; i < NUMBERS; i++) {
        double x = get(&n, n.x, i), y = get(&n, n.y, i), power = pow(x, y), root = cbrt(x);
        if (fabs(log2(x) * y) < (size == 4 ? 125.0 : 1020.0) && fabs(get(&n, n.power, i) / power - 1.0) > (2.0 + fabs(y)) * last_place)
            fail_msg("%.17g^%.17g: %.17g, off by %.3g last places", x, y, get(&n, n.power, i), (get(&n, n.power, i) / power - 1.0) / last_place);
        if (fabs(log10(x)) < 20.0 && fabs(get(&n, n.root, i) / root - 1.0) > 4.0 * last_place) /* beyond, three of its steps are too few */
            fail_msg("cube root of %.17g: %.17g, off by %.3g last places", x, get(&n, n.root, i), (get(&n, n.root, i) / root - 1.0) / last_place);
    }
    free(n.x);
    free(n.y);
    free(n.power);
    free(n.root);
}

static void test_in_double(void **state)
{
    if (!opened()->info.fp64)
        skip();
    (void)state;
    check(sizeof(double), DBL_EPSILON);
}

static void test_in_float(void **state)
{
    (void)state;
    check(sizeof(float), FLT_EPSILON);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_in_double), cmocka_unit_test(test_in_float)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
