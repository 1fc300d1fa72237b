/* Every call that creates something on the device, sets an argument or enqueues work fails in its turn, within one process: the run ends with the
 * device's status and one line, gives back all that it had created, and leaves results that open. A place in the program (the way of calls that
 * led there) is tried once over all scenes, every allocation in each; CLAST_LONG=1 takes every call there is. Programs and the context are kept between
 * runs, so that a run takes milliseconds. test_faults.py does the same with the whole command, for some calls. */
#include "../physics/case.h"
#include "run.h"

#include <dlfcn.h>
#include <execinfo.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <unistd.h>

#define DEPTH 24
#define NEXT(name) ((__typeof__(&name))(uintptr_t)dlsym(RTLD_NEXT, #name))

/* ---- the calls ---- */

typedef struct call_site {
    const char *name;
    uint64_t way;
} call_site;

static struct {
    long count, fail_at;
    bool recording;
    call_site *site;
    long room;
    const char *failed; /* name of the call that was made to fail */
    long mems, kernels, queues, programs, contexts; /* that live */
} calls;

static uint64_t way_here(void)
{
    void *frame[DEPTH];
    int depth = backtrace(frame, DEPTH);
    uint64_t hash = 14695981039346656037u;
    for (int k = 2; k < depth; k++)
        hash = (hash ^ (uint64_t)(uintptr_t)frame[k]) * 1099511628211u;
    return hash;
}

static bool fails(const char *name)
{
    long n = __atomic_add_fetch(&calls.count, 1, __ATOMIC_SEQ_CST);
    if (calls.recording) {
        if (n > calls.room) {
            calls.room = 2 * n;
            calls.site = realloc(calls.site, sizeof *calls.site * (size_t)calls.room);
            assert_non_null(calls.site);
        }
        calls.site[n - 1] = (call_site){name, way_here()};
    }
    if (n != calls.fail_at)
        return false;
    calls.failed = name;
    return true;
}

static void count(long *live, int change)
{
    __atomic_add_fetch(live, change, __ATOMIC_SEQ_CST);
}

cl_context clCreateContext(const cl_context_properties *properties, cl_uint devices, const cl_device_id *device,
                           void(CL_CALLBACK *notify)(const char *, const void *, size_t, void *), void *data, cl_int *error)
{
    static cl_context only;
    if (fails("clCreateContext")) {
        *error = CL_OUT_OF_HOST_MEMORY;
        return NULL;
    }
    if (!only)
        only = NEXT(clCreateContext)(properties, devices, device, notify, data, error);
    clRetainContext(only);
    *error = CL_SUCCESS;
    count(&calls.contexts, 1);
    return only;
}

cl_int clReleaseContext(cl_context context)
{
    count(&calls.contexts, -1);
    return NEXT(clReleaseContext)(context);
}

cl_command_queue clCreateCommandQueue(cl_context context, cl_device_id device, cl_command_queue_properties properties, cl_int *error)
{
    if (fails("clCreateCommandQueue")) {
        *error = CL_OUT_OF_RESOURCES;
        return NULL;
    }
    count(&calls.queues, 1);
    return NEXT(clCreateCommandQueue)(context, device, properties, error);
}

cl_int clReleaseCommandQueue(cl_command_queue queue)
{
    count(&calls.queues, -1);
    return NEXT(clReleaseCommandQueue)(queue);
}

static struct {
    char *text;
    cl_program program;
    bool built;
} known[32];
static int known_count;

cl_program clCreateProgramWithSource(cl_context context, cl_uint strings, const char **text, const size_t *lengths, cl_int *error)
{
    if (fails("clCreateProgramWithSource")) {
        *error = CL_OUT_OF_HOST_MEMORY;
        return NULL;
    }
    count(&calls.programs, 1);
    int k = 0;
    while (k < known_count && strcmp(known[k].text, text[0]) != 0)
        k++;
    if (k == known_count) {
        assert_true(known_count < 32);
        known[known_count].text = strdup(text[0]);
        known[known_count++].program = NEXT(clCreateProgramWithSource)(context, strings, text, lengths, error);
    }
    *error = CL_SUCCESS;
    NEXT(clRetainProgram)(known[k].program);
    return known[k].program;
}

cl_int clRetainProgram(cl_program program)
{
    count(&calls.programs, 1);
    return NEXT(clRetainProgram)(program);
}

cl_int clBuildProgram(cl_program program, cl_uint devices, const cl_device_id *device, const char *options,
                      void(CL_CALLBACK *notify)(cl_program, void *), void *data)
{
    if (fails("clBuildProgram"))
        return CL_OUT_OF_RESOURCES;
    for (int k = 0; k < known_count; k++)
        if (known[k].program == program && !known[k].built) {
            known[k].built = true;
            return NEXT(clBuildProgram)(program, devices, device, options, notify, data);
        }
    return CL_SUCCESS;
}

cl_int clReleaseProgram(cl_program program)
{
    count(&calls.programs, -1);
    return NEXT(clReleaseProgram)(program);
}

cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void *host, cl_int *error)
{
    if (fails("clCreateBuffer")) {
        *error = CL_MEM_OBJECT_ALLOCATION_FAILURE;
        return NULL;
    }
    count(&calls.mems, 1);
    return NEXT(clCreateBuffer)(context, flags, size, host, error);
}

cl_int clReleaseMemObject(cl_mem mem)
{
    count(&calls.mems, -1);
    return NEXT(clReleaseMemObject)(mem);
}

cl_kernel clCreateKernel(cl_program program, const char *name, cl_int *error)
{
    if (fails("clCreateKernel")) {
        *error = CL_OUT_OF_HOST_MEMORY;
        return NULL;
    }
    count(&calls.kernels, 1);
    return NEXT(clCreateKernel)(program, name, error);
}

cl_int clReleaseKernel(cl_kernel kernel)
{
    count(&calls.kernels, -1);
    return NEXT(clReleaseKernel)(kernel);
}

#include "faults/calls.h"

/* ---- runs ---- */

static char folder[] = "/tmp/clast-device-faults-XXXXXX";

static const char *path_of(const char *name)
{
    static char path[8][4096];
    static int turn;
    char *at = path[turn = (turn + 1) % 8];
    snprintf(at, sizeof *path, "%s/%s", folder, name);
    return at;
}

static void remove_results(void)
{
    static const char *const names[] = {"r.h5", "r.xdmf", "r.checkpoint.h5"};
    for (int k = 0; k < COUNT_OF(names); k++)
        unlink(path_of(names[k]));
}

static status run_failing_at(long at, failure *why)
{
    run_options options = {.scene_path = path_of("scene.yaml"), .out = path_of("r.h5"), .device = "cpu", .quiet = true};
    remove_results();
    why->text[0] = '\0';
    calls.count = 0;
    calls.fail_at = at;
    calls.failed = NULL;
    return run_scene(&options, why);
}

static void check_given_back(long at, const char *said)
{
    if (calls.mems || calls.kernels || calls.queues || calls.programs || calls.contexts)
        fail_msg("after call %ld (%s) has failed, %ld buffers, %ld kernels, %ld queues, %ld programs, %ld contexts are left; the run said: %s", at,
                 calls.failed, calls.mems, calls.kernels, calls.queues, calls.programs, calls.contexts, said);
}

static void check_results(long at)
{
    struct stat about;
    if (stat(path_of("r.h5"), &about) != 0)
        return;
    hid_t file;
    H5E_BEGIN_TRY
    {
        file = H5Fopen(path_of("r.h5"), H5F_ACC_RDONLY, H5P_DEFAULT);
    }
    H5E_END_TRY
    if (file < 0)
        fail_msg("after call %ld (%s) has failed the results cannot be opened", at, calls.failed);
    H5Fclose(file);
}

static void check_failure(long at)
{
    failure why;
    status result = run_failing_at(at, &why);
    if (!calls.failed) { /* fewer calls this time: how often the last good state is kept depends on the clock */
        assert_int_equal(result, STATUS_OK);
        return;
    }
    if (calls.count == at && strcmp(calls.failed, "clFinish") == 0 && result == STATUS_OK) /* the last wait, when all has been written */
        return;
    bool one_line = strchr(why.text, '\n') == NULL || strcmp(calls.failed, "clBuildProgram") == 0; /* which shows what the driver says */
    if (result != STATUS_DEVICE || why.text[0] == '\0' || !one_line)
        fail_msg("call %ld (%s) fails: status %d, message '%s'", at, calls.failed, result, why.text);
    check_given_back(at, why.text);
    check_results(at);
}

static struct {
    uint64_t way[8192];
    int count;
} seen; /* in this scene and in those before */

static bool is_new(uint64_t way)
{
    for (int k = 0; k < seen.count; k++)
        if (seen.way[k] == way)
            return false;
    assert_true(seen.count < COUNT_OF(seen.way));
    seen.way[seen.count++] = way;
    return true;
}

static void each_call_fails(const char *scene)
{
    failure why;
    const char *asked = getenv("CLAST_LONG");
    calls.mems = calls.kernels = calls.queues = calls.programs = calls.contexts = 0;
    FILE *file = fopen(path_of("scene.yaml"), "w");
    assert_non_null(file);
    fputs(scene, file);
    fclose(file);
    if (run_failing_at(0, &why) != STATUS_OK) /* once before, so that what runs once alone is no place of its own */
        fail_msg("%s", why.text);
    check_given_back(0, "");
    calls.recording = true;
    assert_int_equal(run_failing_at(0, &why), STATUS_OK);
    calls.recording = false;
    long all = calls.count, tried = 0;
    bool every = asked && atoi(asked) > 0;
    for (long n = 0; n < all; n++)
        if (is_new(calls.site[n].way) || every || strcmp(calls.site[n].name, "clCreateBuffer") == 0) {
            check_failure(n + 1);
            tried++;
        }
    print_message("%ld of %ld calls\n", tried, all);
    assert_true(tried > 50);
}

#define CONTACTS                                                                                                                          \
    "gravity_m_s2: [2, 0, -30]\n"                                                                                                         \
    "materials: [{name: glass, density_kg_m3: 2500, youngs_modulus_pa: 5.0e6, poissons_ratio: 0.3, conductivity_w_mk: 5, specific_heat_j_kgk: 8, emissivity: 0.9, absorptance: 0.5}]\n" \
    "interactions: [{between: default, restitution: 0.5, friction_static: 0.4, rolling_friction: 0.02, bond_threshold: 0, bond_gap_ratio: 0.05, " \
    "bond_youngs_modulus_pa: 1.0e7, bond_shear_modulus_pa: 4.0e6, bond_radius_ratio: 0.5, bond_damping_ratio: 0.1}]\n"                     \
    "particles:\n"                                                                                                                        \
    "  - {name: bed, material: glass, generator: random, count: 30, radius_m: {distribution: uniform, low: 8.0e-4, high: 1.2e-3}, "        \
    "region: {low_m: [0, 0, 0.001], high_m: [0.007, 0.007, 0.009]}, velocity_m_s: [0.3, 0.2, -0.8], temperature_k: 400}\n"

static void test_contacts(void **state)
{
    (void)state;
    each_call_fails(CONTACTS
                    "effects: [{slot: normal, law: hertz}, {slot: tangential, law: mindlin}, {slot: rolling, law: elastic_plastic}]\n"
                    "walls: [{name: box, shape: box, low_m: [0, 0, 0], high_m: [0.007, 0.007, 0.03], open: [z_high]}]\n"
                    "stages: [{name: go, until: {steps: 60}, step_s: 1.2e-5}, {name: on, until: {steps: 20}}]\n"
                    "guards: {every_steps: 20}\n"
                    "output: {every_s: 3.0e-4, fields: [position, velocity, spin], observables: [kinetic_energy, contacts, dissipated_normal], contacts: true, "
                    "checkpoint_every_s: 5.0e-4}\n");
}

static void test_heat(void **state)
{
    (void)state;
    each_call_fails(CONTACTS
                    "environment: {temperature_k: 300}\n"
                    "precision: mixed\n"
                    "effects: [{slot: normal, law: hertz}, {slot: conduction, law: overlap_area}, {slot: radiation, law: stefan_boltzmann}, {slot: source, law: laser, "
                    "name: beam, diameter_m: 2.0e-3, attenuation_1_m: 1000, direction: [0, 0, -1], path: {time_s: [0, 0.01], position_m: [[0.003, 0.003, 0], [0.003, 0.003, 0]], power_w: [0.01, 0]}}]\n"
                    "walls: [{name: box, shape: box, low_m: [0, 0, 0], high_m: [0.007, 0.007, 0.03], open: [z_high], temperature_k: 350}]\n"
                    "stages: [{name: go, until: {steps: 30}}, {name: still, until: {time_s: 1.0e-4}, motion: frozen, heat: {method: implicit}}]\n"
                    "output: {fields: [position, temperature], observables: [temperature_mean]}\n");
}

static void test_bonds_and_servo(void **state)
{
    (void)state;
    each_call_fails(CONTACTS
                    "integrator: velocity_verlet\n"
                    "effects: [{slot: normal, law: hertz}, {slot: bond, law: parallel, criterion: at_time, time_s: 0}]\n"
                    "walls:\n"
                    "  - {name: box, shape: box, low_m: [0, 0, 0], high_m: [0.007, 0.007, 0.03], open: [z_high]}\n"
                    "  - {name: lid, shape: plane, point_m: [0, 0, 0.011], normal: [0, 0, -1], servo: {direction: [0, 0, -1], pressure_pa: 50, speed_max_m_s: 0.5, "
                    "area_m2: 4.9e-5}}\n"
                    "stages: [{name: go, until: {steps: 40}}]\n"
                    "output: {every_s: 1.0e-3, fields: [position], observables: [bonds_alive, kinetic_energy]}\n");
}

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    remove_results();
    unlink(path_of("scene.yaml"));
    return rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_contacts), cmocka_unit_test(test_heat), cmocka_unit_test(test_bonds_and_servo)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
