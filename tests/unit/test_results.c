#include "results.h"

#include <hdf5.h>
#include <inttypes.h>
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

enum { COUNT = 7, WIDTH = 5 };

static const results_field fields[] = {
    {"position", "m", 3, false, false},  {"velocity", "m/s", 3, false, false}, {"temperature", "K", 1, false, false},
    {"contacts", "", 1, false, true},    {"id", "", 1, true, true},            {"radius", "m", 1, true, false},
};
enum { FIELDS = sizeof fields / sizeof fields[0] };
static const results_observable observables[] = {
    {"kinetic_energy", "J", 1},
    {"momentum", "kg m/s", 3},
    {"walls/floor/force_z", "N", 1},
};

static results_spec example(void)
{
    return (results_spec){.count = COUNT,
                          .field_count = FIELDS,
                          .field = fields,
                          .observable_count = 3,
                          .observable = observables,
                          .contacts = true,
                          .box_given = true,
                          .box_low = {-1, -2, -3},
                          .box_high = {1, 2, 4},
                          .periodic = {true, false, false},
                          .scene_text = "title: \xc3\xbc & <x>\n",
                          .plan_text = "",
                          .version_text = "clast test",
                          .device_text = "none"};
}

/* Values that tell field, frame, particle and component. */
static double expected(int field, int64_t frame, int64_t row, int component)
{
    return 1000.0 * field + 10.0 * (double)frame + (double)row + 0.1 * component;
}

static int64_t contact_count(int64_t frame)
{
    return frame % 4;
}

static status put_frame(results *r, int64_t frame, failure *why)
{
    double real[3][COUNT * 3];
    int32_t whole[2][COUNT];
    double radius[COUNT];
    for (int row = 0; row < COUNT; row++) {
        for (int c = 0; c < 3; c++) {
            real[0][3 * row + c] = expected(0, frame, row, c);
            real[1][3 * row + c] = expected(1, frame, row, c);
        }
        real[2][row] = expected(2, frame, row, 0);
        whole[0][row] = (int32_t)expected(3, frame, row, 0);
        whole[1][row] = row;
        radius[row] = 0.001 * (row + 1);
    }
    const void *value[FIELDS] = {real[0], real[1], real[2], whole[0], frame ? NULL : whole[1], frame ? NULL : radius};
    int32_t i[3] = {0, 1, 2}, j[3] = {1, 2, -1}, wall[3] = {-1, -1, 0};
    double overlap[3], area[3] = {1, 2, 3}, force[3][3] = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
    for (int k = 0; k < 3; k++)
        overlap[k] = (double)frame + 0.1 * k;
    results_contacts contacts = {contact_count(frame), i, j, wall, overlap, area, (const double(*)[3])force, NULL, NULL};
    return results_frame(r, 100 * frame, 0.5 * (double)frame, value, &contacts, why);
}

static status put_sample(results *r, int64_t sample, failure *why)
{
    double value[WIDTH];
    for (int k = 0; k < WIDTH; k++)
        value[k] = (double)sample + 0.1 * k;
    return results_observe(r, 10 * sample, 0.05 * (double)sample, value, why);
}

/* Ten samples a frame. */
static status put_both(results *r, int64_t frame, failure *why)
{
    TRY(put_frame(r, frame, why));
    for (int64_t k = 0; k < 10; k++)
        TRY(put_sample(r, 10 * frame + k, why));
    return STATUS_OK;
}

static void write_example(const char *path, int64_t frames)
{
    failure why;
    results *r;
    results_spec spec = example();
    assert_int_equal(results_create(path, &spec, &r, &why), STATUS_OK);
    for (int64_t k = 0; k < frames; k++)
        assert_int_equal(put_both(r, k, &why), STATUS_OK);
    assert_int_equal(results_close(r, &why), STATUS_OK);
}

/* ---- reading back with libhdf5 alone ---- */

static int64_t extent(hid_t file, const char *path, int dimension)
{
    hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT);
    assert_true(dataset >= 0);
    hid_t space = H5Dget_space(dataset);
    hsize_t dims[8] = {0};
    int rank = H5Sget_simple_extent_dims(space, dims, NULL);
    H5Sclose(space);
    H5Dclose(dataset);
    return dimension < rank ? (int64_t)dims[dimension] : -1;
}

static double *all(hid_t file, const char *path)
{
    hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT);
    assert_true(dataset >= 0);
    hid_t space = H5Dget_space(dataset);
    hssize_t count = H5Sget_simple_extent_npoints(space);
    double *value = malloc((size_t)(count + 1) * sizeof *value);
    if (count > 0)
        assert_true(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0);
    H5Sclose(space);
    H5Dclose(dataset);
    return value;
}

static void text_of(hid_t object, const char *attribute, char *text, size_t size)
{
    hid_t a = H5Aopen(object, attribute, H5P_DEFAULT);
    assert_true(a >= 0);
    hid_t type = H5Aget_type(a);
    size_t length = H5Tget_size(type);
    assert_true(length < size);
    memset(text, 0, size);
    assert_true(H5Aread(a, type, text) >= 0);
    H5Tclose(type);
    H5Aclose(a);
}

static void assert_unit(hid_t file, const char *path, const char *unit)
{
    char text[64];
    hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT);
    text_of(dataset, "unit", text, sizeof text);
    assert_string_equal(text, unit);
    H5Dclose(dataset);
}

static bool same_object(hid_t file, const char *a, const char *b)
{
    H5O_info_t one, two;
    assert_true(H5Oget_info_by_name(file, a, &one, H5P_DEFAULT) >= 0);
    assert_true(H5Oget_info_by_name(file, b, &two, H5P_DEFAULT) >= 0);
    return one.addr == two.addr;
}

/* Every frame and sample that has a step has its rows, and they hold what was written; `torn` allows a row that has no step yet. Returns
 * the frames found. */
static int64_t check_rows(const char *path, bool torn)
{
    const int64_t extra = torn ? 1 : 0;
    hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    assert_true(file >= 0);
    int64_t frames = extent(file, "/particles/all/position/step", 0), contacts = 0;
    for (int k = 0; k < 4; k++) {
        char name[128];
        snprintf(name, sizeof name, "/particles/all/%s/value", fields[k].name);
        assert_in_range(extent(file, name, 0), frames, frames + extra);
        double *value = all(file, name);
        for (int64_t f = 0; f < frames; f++)
            for (int64_t row = 0; row < COUNT; row++)
                for (int c = 0; c < fields[k].components; c++)
                    assert_true(value[(f * COUNT + row) * fields[k].components + c] == expected(k, f, row, c));
        free(value);
    }
    double *step = all(file, "/particles/all/position/step"), *offset = all(file, "/contacts/offset");
    double *overlap = all(file, "/contacts/overlap");
    assert_in_range(extent(file, "/contacts/offset", 0), frames, frames + extra);
    for (int64_t f = 0; f < frames; f++) {
        assert_true(step[f] == 100.0 * (double)f);
        assert_true(offset[f] == (double)contacts);
        for (int64_t k = 0; k < contact_count(f); k++)
            assert_true(overlap[contacts + k] == (double)f + 0.1 * (double)k);
        contacts += contact_count(f);
    }
    assert_in_range(extent(file, "/contacts/overlap", 0), contacts, contacts + 3 * extra);
    free(step);
    free(offset);
    free(overlap);
    int64_t samples = extent(file, "/observables/momentum/step", 0);
    double *momentum = all(file, "/observables/momentum/value"), *force = all(file, "/observables/walls/floor/force_z/value");
    assert_in_range(extent(file, "/observables/momentum/value", 0), samples, samples + 10 * extra);
    for (int64_t s = 0; s < samples; s++) {
        for (int c = 0; c < 3; c++)
            assert_true(momentum[3 * s + c] == (double)s + 0.1 * (1 + c));
        assert_true(force[s] == (double)s + 0.1 * 4);
    }
    free(momentum);
    free(force);
    H5Fclose(file);
    return frames;
}

static int64_t check_whole(const char *path)
{
    return check_rows(path, false);
}

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
    strcpy(folder, "/tmp/clast_results_XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int tear_down(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command) == 0 ? 0 : -1;
}

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

/* Whatever the moment of the kill, the file opens and holds every frame whose call had returned. */
static void test_kill_leaves_frames(void **state)
{
    (void)state;
    for (int round = 0; round < 12; round++) {
        int done[2];
        assert_int_equal(pipe(done), 0);
        pid_t child = fork();
        if (child == 0) {
            failure why;
            results *r;
            results_spec spec = example();
            if (results_create(in_folder("k.h5"), &spec, &r, &why) != STATUS_OK)
                _exit(1);
            for (int64_t k = 0;; k++)
                if (put_both(r, k, &why) != STATUS_OK || write(done[1], &k, sizeof k) != sizeof k)
                    _exit(1);
        }
        close(done[1]);
        int64_t last = -1, next;
        while (last < 3 + 40 * round && read(done[0], &next, sizeof next) == sizeof next)
            last = next;
        usleep((useconds_t)(137 * round));
        kill(child, SIGKILL);
        int how;
        assert_int_equal(waitpid(child, &how, 0), child);
        assert_true(WIFSIGNALED(how));
        while (read(done[0], &next, sizeof next) == sizeof next)
            last = next;
        close(done[0]);
        int64_t frames = check_rows(in_folder("k.h5"), true);
        assert_in_range(frames, last + 1, last + 2);

        failure why;
        results *r;
        results_spec spec = example();
        assert_int_equal(results_continue(in_folder("k.h5"), &spec, 100 * last, &r, &why), STATUS_OK);
        assert_int_equal(put_frame(r, last + 1, &why), STATUS_OK);
        assert_int_equal(results_close(r, &why), STATUS_OK);
        assert_int_equal(check_whole(in_folder("k.h5")), last + 2);
    }
}

/* Writes three frames, and after the creation and after each frame one byte into the pipe. */
static void traced_child(int done)
{
    failure why;
    results *r;
    results_spec spec = example();
    ptrace(PTRACE_TRACEME, 0, NULL, NULL);
    raise(SIGSTOP);
    bool good = results_create(in_folder("w.h5"), &spec, &r, &why) == STATUS_OK && write(done, "", 1) == 1;
    for (int64_t k = 0; k < 3 && good; k++)
        good = put_both(r, k, &why) == STATUS_OK && write(done, "", 1) == 1;
    _exit(good && results_close(r, &why) == STATUS_OK ? 0 : 1);
}

/* Kills the child as it enters its `count`th write. False when it ended before. */
static bool kill_at_write(pid_t child, int count)
{
    int how;
    waitpid(child, &how, 0);
    ptrace(PTRACE_SETOPTIONS, child, NULL, (void *)(uintptr_t)(PTRACE_O_TRACESYSGOOD | PTRACE_O_EXITKILL));
    for (int writes = 0;;) {
        ptrace(PTRACE_SYSCALL, child, NULL, NULL);
        if (waitpid(child, &how, 0) != child || WIFEXITED(how))
            return false;
        struct __ptrace_syscall_info info;
        if (!WIFSTOPPED(how) || WSTOPSIG(how) != (SIGTRAP | 0x80) ||
            ptrace(PTRACE_GET_SYSCALL_INFO, child, (void *)(uintptr_t)sizeof info, &info) <= 0)
            continue;
        if (info.op == PTRACE_SYSCALL_INFO_ENTRY && info.entry.nr == SYS_pwrite64 && ++writes == count) {
            kill(child, SIGKILL);
            waitpid(child, &how, 0);
            return true;
        }
    }
}

/* Every single write of three frames in turn is the one that does not happen any more. */
static void test_kill_at_every_write(void **state)
{
    (void)state;
    bool killed = true;
    int whole = 0;
    for (int count = 1; killed; count++) {
        int done[2];
        assert_int_equal(pipe(done), 0);
        pid_t child = fork();
        if (child == 0)
            traced_child(done[1]);
        close(done[1]);
        killed = kill_at_write(child, count);
        char bytes[8];
        ssize_t told = read(done[0], bytes, sizeof bytes); /* all were written before the kill */
        close(done[0]);
        if (told < 1)
            continue; /* not even created */
        assert_in_range(check_rows(in_folder("w.h5"), true), told - 1, told);
        whole++;
    }
    if (whole <= 1)
        skip(); /* no tracing here */
    assert_true(whole > 60);
}

static void test_continue_cuts(void **state)
{
    (void)state;
    failure why;
    results *r;
    results_spec spec = example();
    write_example(in_folder("c.h5"), 9);
    /* A checkpoint at step 450: frames 0 to 4 and samples 0 to 45 remain. */
    assert_int_equal(results_continue(in_folder("c.h5"), &spec, 450, &r, &why), STATUS_OK);
    for (int64_t s = 46; s < 50; s++)
        assert_int_equal(put_sample(r, s, &why), STATUS_OK);
    for (int64_t k = 5; k < 12; k++)
        assert_int_equal(put_both(r, k, &why), STATUS_OK);
    assert_int_equal(results_close(r, &why), STATUS_OK);
    assert_int_equal(check_whole(in_folder("c.h5")), 12);
    hid_t file = H5Fopen(in_folder("c.h5"), H5F_ACC_RDONLY, H5P_DEFAULT);
    assert_int_equal(extent(file, "/observables/momentum/step", 0), 120);
    double *radius = all(file, "/particles/all/radius");
    assert_true(radius[3] == 0.004);
    free(radius);
    H5Fclose(file);

    assert_int_equal(results_continue(in_folder("c.h5"), &spec, -1, &r, &why), STATUS_OK);
    assert_int_equal(results_close(r, &why), STATUS_OK);
    assert_int_equal(check_whole(in_folder("c.h5")), 0);
}

static void test_continue_refuses_what_does_not_fit(void **state)
{
    (void)state;
    failure why;
    results *r;
    results_spec spec = example();
    write_example(in_folder("f.h5"), 2);
    spec.count = COUNT + 1;
    assert_int_equal(results_continue(in_folder("f.h5"), &spec, 0, &r, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.text, "/particles/all/position"));
    spec = example();
    results_field other[FIELDS];
    memcpy(other, fields, sizeof other);
    other[1].name = "spin";
    spec.field = other;
    assert_int_equal(results_continue(in_folder("f.h5"), &spec, 0, &r, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.text, "/particles/all/spin"));
    spec = example();
    assert_int_equal(results_continue(in_folder("none.h5"), &spec, 0, &r, &why), STATUS_BAD_INPUT);
    assert_int_equal(check_whole(in_folder("f.h5")), 2); /* nothing was cut by the refused ones */
    assert_int_equal(results_create(in_folder("f.h5"), &spec, &r, &why), STATUS_OK);
    results *second;
    assert_int_equal(results_continue(in_folder("f.h5"), &spec, 0, &second, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.text, "another run"));
    assert_int_equal(results_close(r, &why), STATUS_OK);
}

static void limit_file_size(rlim_t size)
{
    struct rlimit limit;
    getrlimit(RLIMIT_FSIZE, &limit);
    limit.rlim_cur = size;
    setrlimit(RLIMIT_FSIZE, &limit);
}

/* The disk fills up at every kind of byte: raw data, chunk index, header. What was there before stays whole, and nothing crashes. */
static void test_full_disk(void **state)
{
    (void)state;
    signal(SIGXFSZ, SIG_IGN);
    write_example(in_folder("d.h5"), 1);
    struct stat about;
    assert_int_equal(stat(in_folder("d.h5"), &about), 0);
    int failures = 0;
    for (rlim_t size = (rlim_t)about.st_size + 4000; size < (rlim_t)about.st_size + 2000000; size += 99991) {
        failure why = {{0}}, again = {{0}};
        results *r;
        results_spec spec = example();
        limit_file_size(size);
        assert_int_equal(results_create(in_folder("d.h5"), &spec, &r, &why), STATUS_OK);
        int64_t frame = 0;
        status result = STATUS_OK;
        for (; frame < 10000 && result == STATUS_OK; frame++)
            result = put_both(r, frame, &why);
        assert_int_equal(result, STATUS_ERROR);
        assert_non_null(strstr(why.text, "File too large"));
        assert_non_null(strstr(why.text, "/d."));
        assert_int_equal(put_frame(r, frame, &again), STATUS_ERROR);
        assert_string_equal(again.text, why.text);
        assert_int_equal(results_close(r, &again), STATUS_ERROR);
        limit_file_size(RLIM_INFINITY);
        int64_t frames = check_whole(in_folder("d.h5"));
        assert_in_range(frames, frame - 1, frame);
        failures++;

        assert_int_equal(results_continue(in_folder("d.h5"), &spec, 100 * frames, &r, &why), STATUS_OK);
        assert_int_equal(put_frame(r, frames, &why), STATUS_OK);
        assert_int_equal(results_close(r, &why), STATUS_OK);
        assert_int_equal(check_whole(in_folder("d.h5")), frames + 1);
    }
    assert_true(failures > 15);
}

static void test_unwritable_paths(void **state)
{
    (void)state;
    failure why;
    results *r;
    results_spec spec = example();
    assert_int_equal(results_create(in_folder("no/such/a.h5"), &spec, &r, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.text, "no folder"));
    assert_null(r);
    assert_int_equal(results_create(folder, &spec, &r, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.text, folder));
    assert_int_equal(results_create("/dev/full", &spec, &r, &why), STATUS_BAD_INPUT);
    assert_int_equal(results_create("/proc/clast.h5", &spec, &r, &why), STATUS_BAD_INPUT);
    FILE *scene = fopen(in_folder("scene.yaml"), "w");
    fputs("title: precious\n", scene);
    fclose(scene);
    assert_int_equal(results_create(in_folder("scene.yaml"), &spec, &r, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.text, "not overwritten"));
    struct stat about;
    assert_int_equal(stat(in_folder("scene.yaml"), &about), 0);
    assert_int_equal(about.st_size, 16);

    signal(SIGXFSZ, SIG_IGN);
    limit_file_size(5000);
    status result = results_create(in_folder("full.h5"), &spec, &r, &why);
    limit_file_size(RLIM_INFINITY);
    assert_int_equal(result, STATUS_BAD_INPUT);
    assert_non_null(strstr(why.text, "File too large"));
    assert_int_equal(access(in_folder("full.h5"), F_OK), -1);
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
        cmocka_unit_test_setup_teardown(test_kill_leaves_frames, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_kill_at_every_write, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_continue_cuts, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_continue_refuses_what_does_not_fit, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_full_disk, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_unwritable_paths, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_xdmf, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_many_samples, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
