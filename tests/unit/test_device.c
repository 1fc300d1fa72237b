/* Devices: which one a choice means, on made-up lists, and that the machine's own can be opened. */
#include "device.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* cmocka has a macro called fail, so it comes after the headers that declare the function. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static device_info made_up(const char *name, bool gpu, bool fp64)
{
    device_info info = {.gpu = gpu, .cpu = !gpu, .fp64 = fp64};
    snprintf(info.name, sizeof info.name, "%s", name);
    return info;
}

static int chosen(const device_info *list, int count, const char *choice, bool needs_fp64)
{
    int index = -1;
    failure why = {.text = ""};
    status result = device_choose(list, count, choice, needs_fp64, &index, &why);
    if (result != STATUS_OK) {
        assert_int_equal(result, STATUS_DEVICE);
        assert_true(strlen(why.text) > 0);
        return -1;
    }
    return index;
}

static void test_automatic(void **state)
{
    (void)state;
    const device_info list[] = {made_up("Xeon", false, true), made_up("Small GPU", true, false), made_up("Big GPU", true, true)};
    assert_int_equal(chosen(list, 3, NULL, true), 2);
    assert_int_equal(chosen(list, 3, "", true), 2);
    assert_int_equal(chosen(list, 3, NULL, false), 1);
    /* A CPU that can hold doubles beats a GPU that cannot. */
    assert_int_equal(chosen(list, 2, NULL, true), 0);
    assert_int_equal(chosen(list, 1, NULL, true), 0);
    assert_int_equal(chosen(list + 1, 1, NULL, true), -1);
}

static void test_named(void **state)
{
    (void)state;
    const device_info list[] = {made_up("Xeon", false, true), made_up("Radeon 1", true, false), made_up("Radeon 2", true, true)};
    assert_int_equal(chosen(list, 3, "cpu", true), 0);
    assert_int_equal(chosen(list, 3, "CPU", true), 0);
    assert_int_equal(chosen(list, 3, "gpu", false), 1);
    assert_int_equal(chosen(list, 3, "gpu", true), 2);
    assert_int_equal(chosen(list, 3, "radeon", false), 1);
    assert_int_equal(chosen(list, 3, "radeon", true), 2);
    assert_int_equal(chosen(list, 3, "EON 2", true), 2);
    assert_int_equal(chosen(list, 3, "1", false), 1);
    assert_int_equal(chosen(list, 3, "3", false), -1);
    assert_int_equal(chosen(list, 3, "99999999999999999999", false), -1);
    assert_int_equal(chosen(list, 3, "arc", false), -1);
    assert_int_equal(chosen(list, 1, "gpu", false), -1);
    assert_int_equal(chosen(NULL, 0, NULL, true), -1);
}

static void test_messages(void **state)
{
    (void)state;
    const device_info list[] = {made_up("Xeon", false, true), made_up("Radeon", true, false)};
    int index;
    failure why;
    assert_int_equal(device_choose(list, 2, "arc", true, &index, &why), STATUS_DEVICE);
    assert_non_null(strstr(why.text, "`arc`"));
    assert_non_null(strstr(why.text, "0: Xeon (CPU), 1: Radeon (GPU, no fp64)"));
    assert_int_equal(device_choose(list, 2, "gpu", true, &index, &why), STATUS_DEVICE);
    assert_non_null(strstr(why.text, "Radeon has no fp64"));
    assert_int_equal(device_choose(list, 2, "1", true, &index, &why), STATUS_DEVICE);
    assert_non_null(strstr(why.text, "Radeon has no fp64"));
}

/* Names fill their place to the last byte at most, and long lists are cut rather than overrun. */
static void test_long_names(void **state)
{
    (void)state;
    enum { MANY = 40 };
    device_info list[MANY];
    char name[256];
    memset(name, 'x', sizeof name - 1);
    name[sizeof name - 1] = '\0';
    for (int k = 0; k < MANY; k++)
        list[k] = made_up(name, true, true);
    assert_int_equal(chosen(list, MANY, "y", true), -1);
    assert_int_equal(chosen(list, MANY, "39", true), 39);
    char text[16];
    device_describe(&list[0], text, sizeof text);
    assert_int_equal(strlen(text), sizeof text - 1);
}

static void test_error_names(void **state)
{
    (void)state;
    assert_string_equal(device_error_name(CL_SUCCESS), "CL_SUCCESS");
    assert_string_equal(device_error_name(CL_OUT_OF_RESOURCES), "CL_OUT_OF_RESOURCES");
    assert_string_equal(device_error_name(CL_INVALID_DEVICE_PARTITION_COUNT), "CL_INVALID_DEVICE_PARTITION_COUNT");
    assert_string_equal(device_error_name(-1001), "CL_PLATFORM_NOT_FOUND_KHR");
    assert_non_null(device_error_name(12345));
}

static void test_this_machine(void **state)
{
    (void)state;
    device_info *list;
    int count;
    failure why;
    if (device_list(&list, &count, &why) != STATUS_OK) {
        print_message("%s\n", why.text);
        skip();
    }
    assert_true(count > 0);
    for (int k = 0; k < count; k++) {
        char index[16], text[1024];
        device d;
        snprintf(index, sizeof index, "%d", k);
        assert_int_equal(device_open(index, false, &d, &why), STATUS_OK);
        assert_string_equal(d.info.name, list[k].name);
        assert_true(d.info.usable_bytes > 0 && d.info.buffer_bytes > 0 && d.info.compute_units > 0 && d.info.argument_bytes >= 1024);
        device_describe(&d.info, text, sizeof text);
        assert_non_null(strstr(text, d.info.name));
        cl_int code;
        int32_t sent = 4711, back = 0;
        cl_mem memory = clCreateBuffer(d.context, CL_MEM_READ_WRITE, sizeof sent, NULL, &code);
        assert_int_equal(code, CL_SUCCESS);
        assert_int_equal(clEnqueueWriteBuffer(d.queue, memory, CL_TRUE, 0, sizeof sent, &sent, 0, NULL, NULL), CL_SUCCESS);
        assert_int_equal(clEnqueueReadBuffer(d.queue, memory, CL_TRUE, 0, sizeof back, &back, 0, NULL, NULL), CL_SUCCESS);
        assert_int_equal(back, sent);
        clReleaseMemObject(memory);
        device_close(&d);
        assert_null(d.context);
    }
    free(list);
}

static void test_close_nothing(void **state)
{
    (void)state;
    device d;
    failure why;
    assert_int_equal(device_open("no such device", false, &d, &why), STATUS_DEVICE);
    device_close(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_automatic),     cmocka_unit_test(test_named),       cmocka_unit_test(test_messages),
        cmocka_unit_test(test_long_names),    cmocka_unit_test(test_error_names), cmocka_unit_test(test_this_machine),
        cmocka_unit_test(test_close_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
