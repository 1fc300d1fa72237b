/* Results files: layout, texts, and reading. */
#include "results_case.h"

static void test_layout_is_h5md(void **state)
{
    (void)state;
    write_example(in_folder("a.h5"), 3);
    assert_int_equal(check_whole(in_folder("a.h5")), 3);
    hid_t file = H5Fopen(in_folder("a.h5"), H5F_ACC_RDONLY, H5P_DEFAULT);
    char text[128];
    int version[2] = {0};
    hid_t top = H5Gopen2(file, "/h5md", H5P_DEFAULT), a = H5Aopen(top, "version", H5P_DEFAULT);
    assert_true(H5Aread(a, H5T_NATIVE_INT, version) >= 0);
    assert_int_equal(version[0], 1);
    assert_int_equal(version[1], 1);
    H5Aclose(a);
    H5Gclose(top);
    hid_t author = H5Gopen2(file, "/h5md/author", H5P_DEFAULT), creator = H5Gopen2(file, "/h5md/creator", H5P_DEFAULT);
    text_of(author, "name", text, sizeof text);
    assert_true(strlen(text) > 0);
    text_of(creator, "name", text, sizeof text);
    assert_string_equal(text, "clast");
    text_of(creator, "version", text, sizeof text);
    H5Gclose(author);
    H5Gclose(creator);

    hid_t box = H5Gopen2(file, "/particles/all/box", H5P_DEFAULT);
    int dimension = 0;
    a = H5Aopen(box, "dimension", H5P_DEFAULT);
    assert_true(H5Aread(a, H5T_NATIVE_INT, &dimension) >= 0);
    assert_int_equal(dimension, 3);
    H5Aclose(a);
    text_of(box, "boundary", text, sizeof text); /* three fixed strings of length 8 */
    assert_memory_equal(text, "periodicnone\0\0\0\0none\0\0\0\0", 24);
    H5Gclose(box);
    double *edges = all(file, "/particles/all/box/edges"), *low = all(file, "/particles/all/box/offset");
    assert_true(edges[0] == 2 && edges[1] == 4 && edges[2] == 7);
    assert_true(low[0] == -1 && low[1] == -2 && low[2] == -3);
    free(edges);
    free(low);

    assert_int_equal(extent(file, "/particles/all/position/value", 1), COUNT);
    assert_int_equal(extent(file, "/particles/all/position/value", 2), 3);
    assert_int_equal(extent(file, "/particles/all/temperature/value", 2), -1);
    assert_int_equal(extent(file, "/particles/all/id", 0), COUNT);
    assert_true(same_object(file, "/particles/all/position/step", "/contacts/step"));
    assert_true(same_object(file, "/particles/all/position/time", "/particles/all/velocity/time"));
    assert_true(same_object(file, "/observables/momentum/time", "/observables/walls/floor/force_z/time"));
    assert_unit(file, "/particles/all/velocity/value", "m/s");
    assert_unit(file, "/particles/all/velocity/time", "s");
    assert_unit(file, "/particles/all/radius", "m");
    assert_unit(file, "/observables/kinetic_energy/value", "J");
    hid_t id = H5Dopen2(file, "/particles/all/id", H5P_DEFAULT), type = H5Dget_type(id);
    assert_true(H5Tequal(type, H5T_STD_I32LE) > 0);
    H5Tclose(type);
    H5Dclose(id);
    H5Fclose(file);
}

static void read_text(const char *path, const char *name, char *text, size_t size)
{
    hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT), dataset = H5Dopen2(file, name, H5P_DEFAULT), type = H5Dget_type(dataset);
    memset(text, 0, size);
    assert_true(H5Tget_size(type) < size);
    assert_true(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) >= 0);
    H5Tclose(type);
    H5Dclose(dataset);
    H5Fclose(file);
}

static void test_texts(void **state)
{
    (void)state;
    failure why;
    results *r;
    results_spec spec = example();
    char text[64];
    assert_int_equal(results_create(in_folder("t.h5"), &spec, &r, &why), STATUS_OK);
    assert_int_equal(results_text(r, "summary", "first, and longer", &why), STATUS_OK);
    assert_int_equal(results_text(r, "summary", "second", &why), STATUS_OK);
    assert_int_equal(put_both(r, 0, &why), STATUS_OK);
    assert_int_equal(results_close(r, &why), STATUS_OK);
    read_text(in_folder("t.h5"), "/clast/summary", text, sizeof text);
    assert_string_equal(text, "second");
    read_text(in_folder("t.h5"), "/clast/scene", text, sizeof text);
    assert_string_equal(text, spec.scene_text);
    read_text(in_folder("t.h5"), "/clast/plan", text, sizeof text);
    assert_string_equal(text, "");
    assert_int_equal(check_whole(in_folder("t.h5")), 1);
}

static void test_no_box_no_contacts_no_particles(void **state)
{
    (void)state;
    failure why;
    results *r;
    results_spec spec = example();
    spec.box_given = spec.contacts = false;
    spec.count = 0;
    const void *value[FIELDS] = {&spec, &spec, &spec, &spec, &spec, &spec};
    assert_int_equal(results_create(in_folder("n.h5"), &spec, &r, &why), STATUS_OK);
    assert_int_equal(results_frame(r, 0, 0, value, NULL, &why), STATUS_OK);
    assert_int_equal(results_frame(r, 1, 1, value, NULL, &why), STATUS_OK);
    assert_int_equal(results_close(r, &why), STATUS_OK);
    hid_t file = H5Fopen(in_folder("n.h5"), H5F_ACC_RDONLY, H5P_DEFAULT);
    assert_int_equal(extent(file, "/particles/all/position/value", 0), 2);
    assert_true(H5Lexists(file, "/particles/all/box/edges", H5P_DEFAULT) == 0);
    assert_true(H5Lexists(file, "/contacts", H5P_DEFAULT) == 0);
    char text[64];
    hid_t box = H5Gopen2(file, "/particles/all/box", H5P_DEFAULT);
    text_of(box, "boundary", text, sizeof text);
    assert_memory_equal(text, "none\0\0\0\0none\0\0\0\0none\0\0\0\0", 24);
    H5Gclose(box);
    H5Fclose(file);
    assert_int_equal(results_continue(in_folder("n.h5"), &spec, 0, &r, &why), STATUS_OK);
    assert_int_equal(results_close(r, &why), STATUS_OK);
}

static void test_reading_particles(void **state)
{
    (void)state;
    failure why;
    results_particles p;
    write_example(in_folder("p.h5"), 4);
    assert_int_equal(results_read_particles(in_folder("p.h5"), -1, &p, &why), STATUS_OK);
    assert_int_equal(p.count, COUNT);
    assert_true(p.time == 1.5 && p.position[3 * 2 + 1] == expected(0, 3, 2, 1) && p.velocity[0] == expected(1, 3, 0, 0));
    assert_true(p.temperature[6] == expected(2, 3, 6, 0) && p.radius[6] == 0.007);
    assert_null(p.spin);
    results_particles_free(&p);
    assert_int_equal(results_read_particles(in_folder("p.h5"), 1, &p, &why), STATUS_OK);
    assert_true(p.time == 0.5 && p.position[0] == expected(0, 1, 0, 0));
    results_particles_free(&p);
    assert_int_equal(results_read_particles(in_folder("p.h5"), 4, &p, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.text, "0 to 3"));
    assert_int_equal(results_read_particles(in_folder("missing.h5"), 0, &p, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.text, "missing.h5"));
    assert_non_null(strstr(why.text, "No such file"));
    assert_int_equal(results_read_particles("/dev/zero", 0, &p, &why), STATUS_BAD_INPUT);
    assert_int_equal(truncate(in_folder("p.h5"), 3000), 0);
    assert_int_equal(results_read_particles(in_folder("p.h5"), 0, &p, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.text, "cut short"));
}

static void test_xdmf(void **state)
{
    (void)state;
    write_example(in_folder("x&y.h5"), 3);
    FILE *in = fopen(in_folder("x&y.xdmf"), "r");
    assert_non_null(in);
    char text[65536] = {0};
    size_t size = fread(text, 1, sizeof text - 1, in);
    fclose(in);
    assert_true(size > 0 && size < sizeof text - 1);
    int grids = 0, times = 0;
    for (const char *at = text; (at = strstr(at, "GridType=\"Uniform\"")); at++)
        grids++;
    for (const char *at = text; (at = strstr(at, "<Time Value=")); at++)
        times++;
    assert_int_equal(grids, 3);
    assert_int_equal(times, 3);
    assert_non_null(strstr(text, "x&amp;y.h5:/particles/all/position/value"));
    assert_null(strstr(text, "x&y.h5"));
    assert_non_null(strstr(text, "<DataItem Dimensions=\"7\" NumberType=\"Float\" Precision=\"8\" Format=\"HDF\">"
                                 "x&amp;y.h5:/particles/all/radius<"));
    assert_non_null(strstr(text, ">2 0 0  1 1 1  1 7 3<"));
    assert_non_null(strstr(text, "<DataItem Dimensions=\"3 7 3\""));
    assert_int_equal(access(in_folder("x&y.xdmf.tmp"), F_OK), -1);
}

/* More samples than fit in memory at once, and none between frames. */
static void test_many_samples(void **state)
{
    (void)state;
    failure why;
    results *r;
    results_spec spec = example();
    assert_int_equal(results_create(in_folder("m.h5"), &spec, &r, &why), STATUS_OK);
    for (int64_t k = 0; k < 5000; k++)
        assert_int_equal(put_sample(r, k, &why), STATUS_OK);
    assert_int_equal(results_close(r, &why), STATUS_OK);
    hid_t file = H5Fopen(in_folder("m.h5"), H5F_ACC_RDONLY, H5P_DEFAULT);
    assert_int_equal(extent(file, "/observables/momentum/value", 0), 5000);
    H5Fclose(file);
    assert_int_equal(check_whole(in_folder("m.h5")), 0);
}
int main(void)
{
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_layout_is_h5md, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_texts, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_no_box_no_contacts_no_particles, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_reading_particles, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_xdmf, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_many_samples, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
