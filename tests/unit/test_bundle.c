#include "bundle.h"

#include <hdf5.h>
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static char folder[64];

static const char *in_folder(const char *name)
{
    static char path[4][256];
    static int next;
    next = (next + 1) % 4;
    snprintf(path[next], sizeof path[next], "%s/%s", folder, name);
    return path[next];
}

static int set_up(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/clast_bundle_XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int tear_down(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command) == 0 ? 0 : -1;
}

static const double numbers[6] = {0.1, -0.0, 1e308, 4.9e-324, INFINITY, NAN};
static const char prose[] = "title: \xc3\xbc\r\n\ttrailing blanks  \n\n";

static bundle example(void)
{
    bundle b;
    bundle_init(&b);
    const int64_t wide[3] = {INT64_MAX, INT64_MIN, -1};
    const int32_t narrow[2] = {INT32_MIN, 7};
    bundle_add(&b, "position", BUNDLE_F64, 2, 3, numbers);
    bundle_add(&b, "wide", BUNDLE_I64, 3, 1, wide);
    bundle_add(&b, "narrow", BUNDLE_I32, 1, 2, narrow);
    bundle_add(&b, "empty", BUNDLE_F64, 0, 3, NULL);
    bundle_add(&b, "zeros", BUNDLE_I32, 1000, 1, NULL);
    bundle_add_text(&b, "scene", prose);
    bundle_add_text(&b, "run/stage/name", "");
    bundle_add_f64(&b, "time", 1.0 / 3.0);
    bundle_add_i64(&b, "run/step", (int64_t)1 << 53 | 1);
    return b;
}

static void write_example(const char *path)
{
    failure why;
    bundle b = example();
    assert_int_equal(bundle_write(&b, path, &why), STATUS_OK);
    bundle_free(&b);
}

static void check_example(const char *path)
{
    failure why;
    bundle b;
    const bundle_entry *e;
    assert_int_equal(bundle_read(path, &b, &why), STATUS_OK);
    assert_int_equal(b.count, 9);
    assert_int_equal(bundle_get(&b, path, "position", BUNDLE_F64, 2, 3, &e, &why), STATUS_OK);
    assert_memory_equal(e->data, numbers, sizeof numbers); /* bit for bit, the sign of zero too */
    assert_int_equal(bundle_get(&b, path, "wide", BUNDLE_I64, 3, 1, &e, &why), STATUS_OK);
    assert_true(((int64_t *)e->data)[0] == INT64_MAX && ((int64_t *)e->data)[1] == INT64_MIN);
    assert_int_equal(bundle_get(&b, path, "narrow", BUNDLE_I32, -1, 2, &e, &why), STATUS_OK);
    assert_true(((int32_t *)e->data)[0] == INT32_MIN && ((int32_t *)e->data)[1] == 7);
    assert_int_equal(bundle_get(&b, path, "empty", BUNDLE_F64, 0, 3, &e, &why), STATUS_OK);
    assert_int_equal(bundle_get(&b, path, "zeros", BUNDLE_I32, 1000, -1, &e, &why), STATUS_OK);
    for (int k = 0; k < 1000; k++)
        assert_int_equal(((int32_t *)e->data)[k], 0);
    assert_int_equal(bundle_get(&b, path, "scene", BUNDLE_TEXT, -1, -1, &e, &why), STATUS_OK);
    assert_string_equal(e->data, prose);
    assert_int_equal(bundle_get(&b, path, "run/stage/name", BUNDLE_TEXT, 0, -1, &e, &why), STATUS_OK);
    assert_string_equal(e->data, "");
    assert_true(*(double *)bundle_find(&b, "time")->data == 1.0 / 3.0);
    assert_true(*(int64_t *)bundle_find(&b, "run/step")->data == ((int64_t)1 << 53 | 1));
    bundle_free(&b);
}

static void test_round_trip(void **state)
{
    (void)state;
    write_example(in_folder("a.h5"));
    check_example(in_folder("a.h5"));
    write_example(in_folder("a.h5")); /* over itself */
    check_example(in_folder("a.h5"));
    assert_int_equal(access(in_folder("a.h5.tmp"), F_OK), -1);
}

static void test_get_names_what_is_wrong(void **state)
{
    (void)state;
    failure why;
    bundle b = example();
    const bundle_entry *e;
    assert_int_equal(bundle_get(&b, "run.h5", "spin", BUNDLE_F64, -1, -1, &e, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.text, "run.h5"));
    assert_non_null(strstr(why.text, "'spin'"));
    assert_null(e);
    assert_int_equal(bundle_get(&b, "run.h5", "wide", BUNDLE_F64, 3, 1, &e, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.text, "64-bit integers"));
    assert_int_equal(bundle_get(&b, "run.h5", "position", BUNDLE_F64, 4, 3, &e, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.text, "2 x 3"));
    assert_non_null(strstr(why.text, "4 x 3"));
    assert_int_equal(bundle_get(&b, "run.h5", "position", BUNDLE_F64, -1, 1, &e, &why), STATUS_BAD_INPUT);
    assert_null(bundle_find(&b, "spin"));
    bundle_free(&b);
}

static void refused(const char *path, const char *words)
{
    failure why = {{0}};
    bundle b;
    assert_int_equal(bundle_read(path, &b, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.text, path));
    if (!strstr(why.text, words))
        fail_msg("'%s' is not in '%s'", words, why.text);
    assert_int_equal(b.count, 0);
}

static void test_foreign_files(void **state)
{
    (void)state;
    refused(in_folder("missing.h5"), "No such file");
    refused(folder, "not a regular file");
    FILE *text = fopen(in_folder("text.h5"), "w");
    fputs("position: 1 2 3\n", text);
    fclose(text);
    refused(in_folder("text.h5"), "not a Clast checkpoint");
    fclose(fopen(in_folder("nothing.h5"), "w"));
    refused(in_folder("nothing.h5"), "not a Clast checkpoint");
    hid_t file = H5Fcreate(in_folder("other.h5"), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    H5Fclose(file);
    refused(in_folder("other.h5"), "another kind");
}

static size_t load(const char *path, unsigned char *bytes, size_t size)
{
    FILE *in = fopen(path, "rb");
    size_t have = fread(bytes, 1, size, in);
    fclose(in);
    return have;
}

static void store(const char *path, const unsigned char *bytes, size_t size)
{
    FILE *out = fopen(path, "wb");
    fwrite(bytes, 1, size, out);
    fclose(out);
}

static void test_truncated_at_every_length(void **state)
{
    (void)state;
    static unsigned char bytes[1 << 20];
    write_example(in_folder("a.h5"));
    size_t size = load(in_folder("a.h5"), bytes, sizeof bytes);
    assert_in_range(size, 1000, sizeof bytes - 1);
    for (size_t cut = 0; cut < size; cut += 61) {
        store(in_folder("cut.h5"), bytes, cut);
        refused(in_folder("cut.h5"), cut < 40 ? "not a Clast checkpoint" : "damaged");
    }
    store(in_folder("long.h5"), bytes, size + 1);
    refused(in_folder("long.h5"), "damaged");
}

static void test_other_format(void **state)
{
    (void)state;
    static unsigned char bytes[1 << 20];
    write_example(in_folder("a.h5"));
    size_t size = load(in_folder("a.h5"), bytes, sizeof bytes);
    bytes[16] = 99;
    store(in_folder("v.h5"), bytes, size);
    refused(in_folder("v.h5"), "format 99");
}

/* One wrong bit anywhere behind the seal, in the values too. */
static void test_damaged_bytes(void **state)
{
    (void)state;
    static unsigned char bytes[1 << 20];
    write_example(in_folder("a.h5"));
    size_t size = load(in_folder("a.h5"), bytes, sizeof bytes);
    for (size_t at = 512; at < size; at += 7) {
        unsigned char bit = (unsigned char)(1 << at % 8);
        bytes[at] ^= bit;
        store(in_folder("bad.h5"), bytes, size);
        bytes[at] ^= bit;
        refused(in_folder("bad.h5"), "damaged");
    }
}

/* What other programs read. */
static void test_is_plain_hdf5(void **state)
{
    (void)state;
    write_example(in_folder("a.h5"));
    hid_t file = H5Fopen(in_folder("a.h5"), H5F_ACC_RDONLY, H5P_DEFAULT), dataset = H5Dopen2(file, "position", H5P_DEFAULT);
    double value[6];
    assert_true(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0);
    assert_memory_equal(value, numbers, sizeof numbers);
    H5Dclose(dataset);
    H5Fclose(file);
}

static void limit_file_size(rlim_t size)
{
    struct rlimit limit;
    getrlimit(RLIMIT_FSIZE, &limit);
    limit.rlim_cur = size;
    setrlimit(RLIMIT_FSIZE, &limit);
}

/* A checkpoint that does not fit must not cost the one before. */
static void test_full_disk_keeps_the_old(void **state)
{
    (void)state;
    failure why;
    signal(SIGXFSZ, SIG_IGN);
    write_example(in_folder("a.h5"));
    bundle large = example();
    bundle_add(&large, "large", BUNDLE_F64, 100000, 3, NULL);
    for (rlim_t size = 0; size < 2000000; size += 333333) {
        limit_file_size(size);
        status result = bundle_write(&large, in_folder("a.h5"), &why);
        limit_file_size(RLIM_INFINITY);
        assert_int_equal(result, STATUS_ERROR);
        assert_non_null(strstr(why.text, "File too large"));
        check_example(in_folder("a.h5"));
        assert_int_equal(access(in_folder("a.h5.tmp"), F_OK), -1);
    }
    bundle_free(&large);
    bundle b = example();
    assert_int_equal(bundle_write(&b, in_folder("no/a.h5"), &why), STATUS_ERROR);
    assert_non_null(strstr(why.text, "no folder"));
    bundle_free(&b);
}

/* What an interrupted write left under the temporary name is in nobody's way. */
static void test_leftover_temporary(void **state)
{
    (void)state;
    FILE *out = fopen(in_folder("a.h5.tmp"), "w");
    fputs("half", out);
    fclose(out);
    write_example(in_folder("a.h5"));
    check_example(in_folder("a.h5"));
}

int main(void)
{
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_round_trip, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_get_names_what_is_wrong, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_foreign_files, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_other_format, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_is_plain_hdf5, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_truncated_at_every_length, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_damaged_bytes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_full_disk_keeps_the_old, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_leftover_temporary, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
