/* What a device has been tuned to: kept, read back, refused where it makes no sense, and taken up by a simulation. */
#include "simulation_case.h"

#include "tuning.h"

#include <unistd.h>

static char folder[] = "/tmp/clast-tuning-XXXXXX";

static int own_cache(void **state)
{
    (void)state;
    return mkdtemp(folder) && setenv("XDG_CACHE_HOME", folder, 1) == 0 && unsetenv("CLAST_TUNING") == 0 ? 0 : -1;
}

static int drop_cache(void **state)
{
    (void)state;
    char inner[128];
    snprintf(inner, sizeof inner, "%s/clast", folder);
    rmdir(inner);
    return rmdir(folder);
}

static device_info some_device(const char *driver)
{
    device_info info = {.cpu = true, .compute_units = 2, .name = "some device", .vendor = "some vendor", .platform_name = "P", .version = "OpenCL 1.2"};
    snprintf(info.driver, sizeof info.driver, "%s", driver);
    return info;
}

static void assert_same(const tuning *a, const tuning *b)
{
    assert_int_equal(a->block, b->block);
    assert_int_equal(a->batch_steps, b->batch_steps);
    assert_int_equal(a->chunk_records, b->chunk_records);
    assert_int_equal(a->loop_records, b->loop_records);
}

static void test_kept(void **state)
{
    (void)state;
    char path[4096];
    device_info info = some_device("1"), newer = some_device("2");
    tuning usual = tuning_default(&info), of = {.block = 128, .batch_steps = 32, .chunk_records = 65536, .loop_records = 700}, found = tuning_load(&info);
    assert_same(&found, &usual);
    assert_false(found.measured);
    MUST(tuning_store(&info, &of, path, sizeof path, why));
    found = tuning_load(&info);
    assert_same(&found, &of);
    assert_true(found.measured);
    found = tuning_load(&newer); /* another driver is another device */
    assert_same(&found, &usual);
    setenv("CLAST_TUNING", "off", 1);
    found = tuning_load(&info);
    assert_same(&found, &usual);
    unsetenv("CLAST_TUNING");
    MUST(tuning_forget(&info, path, sizeof path, why));
    found = tuning_load(&info);
    assert_same(&found, &usual);
    MUST(tuning_forget(&info, path, sizeof path, why)); /* there is nothing left to forget */
}

static void test_nonsense(void **state)
{
    (void)state;
    static const char *const texts[] = {"", "{\"block\": 128}", "{\"block\": 100, \"batch_steps\": 32, \"chunk_records\": 0, \"loop_records\": 0}",
                                        "{\"block\": 64, \"batch_steps\": 0, \"chunk_records\": 0, \"loop_records\": 0}",
                                        "{\"block\": 64, \"batch_steps\": 8, \"chunk_records\": 100, \"loop_records\": 0}",
                                        "{\"block\": 64, \"batch_steps\": 8, \"chunk_records\": 32, \"loop_records\": 0}",
                                        "{\"block\": 64, \"batch_steps\": 8, \"chunk_records\": 0, \"loop_records\": -1}"};
    char path[4096];
    device_info info = some_device("3");
    tuning usual = tuning_default(&info);
    MUST(tuning_store(&info, &usual, path, sizeof path, why));
    for (size_t n = 0; n < sizeof texts / sizeof *texts; n++) {
        FILE *file = fopen(path, "w");
        assert_non_null(file);
        fputs(texts[n], file);
        fclose(file);
        tuning found = tuning_load(&info);
        assert_same(&found, &usual);
    }
    MUST(tuning_forget(&info, path, sizeof path, why));
}

static void test_taken_up(void **state)
{
    (void)state;
    static const char scene[] =
        "effects: [{slot: normal, law: hertz}]\nmaterials: [{name: m, density_kg_m3: 2500, youngs_modulus_pa: 5.0e6, poissons_ratio: 0.3}]\n"
        "interactions: [{between: default, restitution: 0.5}]\n"
        "particles: [{name: bed, material: m, generator: lattice, lattice: simple_cubic, counts: [12, 12, 12], spacing_m: 0.0019, radius_m: 0.001}]\n"
        "stages: [{name: go, until: {steps: 1}, step_s: 1.0e-6}]\n";
    tuning usual = case_device()->tuning;
    sim_case c;
    case_device()->tuning = (tuning){.block = 128, .batch_steps = 5, .chunk_records = 256, .loop_records = 0};
    case_open(&c, scene);
    assert_int_equal(c.sim->batch_limit, 5);
    assert_int_equal(c.sim->stride, (12 * 12 * 12 + 127) / 128 * 128);
    assert_int_equal(c.sim->table.record_count % 128, 0);
    bool several = case_device()->info.compute_units > 1; /* each with a stream, of smaller chunks */
    assert_int_equal(c.sim->plan.chunk_records, several ? 128 : 256);
    assert_int_equal(step_loop_members(c.sim), case_device()->info.compute_units);
    case_close(&c);
    case_device()->tuning.loop_records = 1000000;
    case_open(&c, scene);
    assert_true(step_loop_now(c.sim));
    assert_int_equal(step_loop_members(c.sim), 1);
    case_close(&c);
    case_device()->tuning = usual;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_kept), cmocka_unit_test(test_nonsense), cmocka_unit_test(test_taken_up)};
    case_device();
    return cmocka_run_group_tests(tests, own_cache, drop_cache);
}
