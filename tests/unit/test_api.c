/* The public C API, used as a program would: only clast.h and the shared library's exported names. */
#include <clast/clast.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define SCENE CLAST_SOURCE_DIR "/scenarios/two_spheres.yaml"

static void test_version_and_devices(void **state)
{
    (void)state;
    char message[CLAST_MESSAGE_SIZE];
    clast_device device;
    int count = 0;
    assert_non_null(strchr(clast_version(), '.'));
    assert_int_equal(clast_devices(&device, 1, &count, message), CLAST_OK);
    assert_true(count >= 1);
    assert_true(device.compute_units >= 1);
}

/* Two spheres fly apart with the speed that they met with, and momentum is kept on the way. */
static void test_bed_in_memory(void **state)
{
    (void)state;
    char message[CLAST_MESSAGE_SIZE];
    clast_bed *bed = NULL;
    double v[2][3], limit, recommended;
    assert_int_equal(clast_bed_open(SCENE, NULL, 0, NULL, &bed, message), CLAST_OK);
    assert_int_equal(clast_bed_count(bed), 2);
    assert_int_equal(clast_bed_components(bed, "velocity"), 3);
    assert_int_equal(clast_bed_components(bed, "spin"), 0); /* nothing turns them */
    assert_int_equal(clast_bed_limit(bed, &limit, &recommended, message), CLAST_OK);
    assert_true(recommended > 0.0 && recommended < limit);
    clast_bed_set_step(bed, 2e-8);
    assert_int_equal(clast_bed_advance(bed, 1000, message), CLAST_OK); /* 20 us: about the deepest point */
    clast_contact *contact = NULL;
    int64_t contacts = 0;
    assert_int_equal(clast_bed_contacts(bed, &contact, &contacts, message), CLAST_OK);
    assert_int_equal(contacts, 1);
    assert_true(contact[0].i == 0 && contact[0].j == 1 && contact[0].force[0] < 0.0);
    free(contact);
    assert_int_equal(clast_bed_advance(bed, 2000, message), CLAST_OK);
    assert_int_equal(clast_bed_step(bed), 3000);
    assert_true(fabs(clast_bed_time(bed) - 3000 * 2e-8) < 1e-15);
    assert_int_equal(clast_bed_field(bed, "velocity", &v[0][0], message), CLAST_OK);
    assert_true(fabs(v[0][0] + 10.0) < 1e-5);
    assert_true(fabs(v[0][0] + v[1][0]) < 1e-13);
    assert_int_equal(clast_bed_field(bed, "temperature", &v[0][0], message), CLAST_BAD_INPUT);
    assert_non_null(strstr(message, "temperature"));
    clast_bed_close(bed);
}

static void test_errors(void **state)
{
    (void)state;
    char message[CLAST_MESSAGE_SIZE];
    clast_bed *bed = NULL;
    char *const bad[] = {"seed=no"};
    assert_int_equal(clast_bed_open("no/such/scene.yaml", NULL, 0, NULL, &bed, message), CLAST_BAD_INPUT);
    assert_null(bed);
    assert_non_null(strstr(message, "no/such/scene.yaml"));
    assert_int_equal(clast_bed_open(SCENE, bad, 1, NULL, &bed, message), CLAST_BAD_INPUT);
    assert_non_null(strstr(message, "seed"));
    assert_int_equal(clast_bed_open(SCENE, NULL, 0, "no such device", &bed, message), CLAST_DEVICE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_version_and_devices),
        cmocka_unit_test(test_bed_in_memory),
        cmocka_unit_test(test_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
