/* Results files whose writer was killed, whose disk was full, and runs that continue them. */
#include "results_case.h"

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
int main(void)
{
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_kill_leaves_frames, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_kill_at_every_write, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_continue_cuts, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_continue_refuses_what_does_not_fit, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_full_disk, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_unwritable_paths, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
