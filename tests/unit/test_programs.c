/* The programs that a scene can be assembled into: every law alone, every pair of laws with what it leaves out and all at once are clean OpenCL C 1.2, a dozen of
 * them on the device with the arguments that the descriptors name; and the structs that host and kernels share have one layout. */
#include "every_law.h"
#include "simulation_case.h"

#include "laws/laws.h"
#include "program.h"

#include <sys/wait.h>
#include <unistd.h>

#define FILES_MAX 128

/* What laws read of a scene: sources are as many as it lists. */
static effect sources[] = {{.law = &law_laser, .beam = {.direction = {0, 0, -1}}}, {.law = &law_burner, .beam = {.direction = {1, 0, 0}}}};
static const scene plain = {.material_count = 2, .wall_count = 3, .effect_count = 2, .effect = sources};

/* Laws of heat come with a temperature, those of surfaces with an environment, a wall's temperature with conduction. */
static void complete_heat(live_laws *live)
{
    if (live->law[SLOT_WALL_HEAT] && !live->law[SLOT_CONDUCTION])
        live->law[SLOT_CONDUCTION] = &law_overlap_area;
    if (live->law[SLOT_WALL_HEAT] && !live->law[SLOT_WALLS])
        live->law[SLOT_WALLS] = &law_walls_planes;
    if ((live->law[SLOT_CONVECTION] || live->law[SLOT_RADIATION]) && !live->law[SLOT_ENVIRONMENT])
        live->law[SLOT_ENVIRONMENT] = &law_environment_uniform;
    if (live->law[SLOT_SOURCE])
        live->law[SLOT_SOURCE] = law_of_beams(&plain);
    static const slot_id thermal[] = {SLOT_SUBSTANCE, SLOT_SOURCE, SLOT_CONDUCTION, SLOT_ENVIRONMENT, SLOT_HEAT_GENERATION, SLOT_THERMAL_GROUPS, SLOT_HEAT_TALLY, SLOT_HEAT_STEPS};
    for (size_t n = 0; n < sizeof thermal / sizeof *thermal; n++)
        if (live->law[thermal[n]] && (!live->law[SLOT_TEMPERATURE] || thermal[n] == SLOT_CONDUCTION))
            live->law[SLOT_TEMPERATURE] = live->law[SLOT_CONDUCTION] || live->law[SLOT_BONDING] == &law_bonding_temperature || live->law[SLOT_BOND] == &law_sintering ? &law_temperature_pairs : &law_temperature_grains;
}

/* Laws that look properties up by temperature come with the tables. */
static void complete_tables(live_laws *live)
{
    const law *temperature = live->law[SLOT_TEMPERATURE], *tables = live->law[SLOT_TABLES];
    bool pairs = live->law[SLOT_FRICTION] || tables == &law_tables_of_pairs || tables == &law_tables_of_both;
    bool grains = live->law[SLOT_CONDUCTIVITY] || live->law[SLOT_MODULUS] == &law_modulus_table || temperature == &law_temperature_grains_tabled ||
                  temperature == &law_temperature_pairs_tabled || tables == &law_tables_of_grains || tables == &law_tables_of_both;
    live->law[SLOT_TABLES] = pairs && grains ? &law_tables_of_both : pairs ? &law_tables_of_pairs : grains ? &law_tables_of_grains : NULL;
}

/* What a scene derives from the laws that it names: friction and rolling turn grains, a friction law comes with a spring and the reverse. */
static void complete(live_laws *live)
{
    static double options[SLOT_COUNT][LAW_OPTIONS_MAX];
    if (live->law[SLOT_SLIP] && !live->law[SLOT_TANGENTIAL])
        live->law[SLOT_TANGENTIAL] = &law_mindlin;
    if (live->law[SLOT_TANGENTIAL] && !live->law[SLOT_SLIP])
        live->law[SLOT_SLIP] = &law_slip_single;
    if (live->law[SLOT_BOND] && !live->law[SLOT_BONDING])
        live->law[SLOT_BONDING] = &law_bonding_always;
    if (live->law[SLOT_BONDING] && !live->law[SLOT_BOND])
        live->law[SLOT_BOND] = &law_adhesion;
    if ((live->law[SLOT_BOND] && live->law[SLOT_BOND]->turns) || live->law[SLOT_TANGENTIAL] || live->law[SLOT_ROLLING] || live->law[SLOT_ORIENTATION])
        live->law[SLOT_ROTATION] = &law_rotation_spin;
    if (live->law[SLOT_BONDING] == &law_bonding_temperature || live->law[SLOT_BOND] == &law_sintering)
        live->law[SLOT_TEMPERATURE] = &law_temperature_pairs;
    if (live->law[SLOT_LEDGER] || live->law[SLOT_DISSIPATION_HEAT])
        live->law[SLOT_DISSIPATION] = live->law[SLOT_INTEGRATOR] ? &law_dissipation_synchronous : &law_dissipation_tracked;
    if (live->law[SLOT_EXPANSION])
        live->law[SLOT_RADIUS] = &law_linear_expansion;
    if (live->law[SLOT_MODULUS] || live->law[SLOT_RADIUS] || live->law[SLOT_DISSIPATION_HEAT])
        live->law[SLOT_TEMPERATURE] = &law_temperature_grains;
    complete_heat(live);
    complete_tables(live);
    live->frozen = live->law[SLOT_TEMPERATURE] != NULL;
    const law *verlet = live->law[SLOT_ROTATION] ? &law_velocity_verlet_spin : &law_velocity_verlet;
    live->law[SLOT_INTEGRATOR] = live->law[SLOT_INTEGRATOR] ? verlet : &law_semi_implicit_euler;
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++) {
        live->option[slot] = live->law[slot] ? options[slot] : NULL;
        for (int o = 0; live->law[slot] && o < LAW_OPTIONS_MAX; o++)
            options[slot][o] = live->law[slot]->options[o].key ? live->law[slot]->options[o].fallback : 0.0;
    }
}

static live_laws with(const law *a, const law *b)
{
    live_laws live;
    memset(&live, 0, sizeof live);
    if (a)
        live.law[a->slot] = a;
    if (b)
        live.law[b->slot] = b;
    complete(&live);
    return live;
}

/* All slots filled, with the first or the second law where there are two. */
static live_laws all_at_once(bool second, bool mixed)
{
    live_laws live;
    memset(&live, 0, sizeof live);
    for (size_t n = 0; n < LAWS; n++)
        if (!live.law[every_law[n]->slot] || second)
            live.law[every_law[n]->slot] = every_law[n];
    live.law[SLOT_PRECISION] = mixed ? &law_precision_mixed : NULL;
    complete(&live);
    live.servo = true;
    return live;
}

/* The files of the stages' program and of the tables', as one: returns their number. */
static int files_of(const live_laws *live, const char **files)
{
    const char *table[LIVE_TABLE_FILES];
    live_laws packed = *live;
    live_for_blocks(&packed);
    int count = live_files(&packed, files, FILES_MAX - 1 - LIVE_TABLE_FILES), tables = live_table_files(live, table);
    for (int f = 0, own = count; f < tables; f++) { /* some are in both */
        int same = 0;
        while (same < own && strcmp(files[same], table[f]) != 0)
            same++;
        if (same == own)
            files[count++] = table[f];
    }
    files[count++] = "stage/step_loop.cl";
    live_laws moving = *live; /* these are of a frozen stage, which has all files but that of stages that move */
    moving.frozen = false;
    if (live->frozen && live_changes_stiffness(&moving))
        files[count++] = "stage/stiffness.cl";
    return count;
}

static char *assemble(const live_laws *live)
{
    const char *files[FILES_MAX];
    char constants[8192], *text = NULL;
    live_laws packed = *live;
    live_for_blocks(&packed);
    live_constants(&packed, &plain, constants, sizeof constants);
    MUST(program_assemble(constants, files, files_of(live, files), NULL, &text, why));
    return text;
}

static void describe(const live_laws *live, char *text, size_t size)
{
    text[0] = '\0';
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
        if (live->law[slot])
            snprintf(text + strlen(text), size - strlen(text), " %s", live->law[slot]->name);
}

/* ---- offline ---- */

#include "program_cover.h"

static bool have_clang(void)
{
    return system("clang --version >/dev/null 2>&1") == 0;
}

/* A compiler at work on one program. One in mixed precision is compiled for a device without fp64, which refuses any double. */
typedef struct compilation {
    pid_t child;
    char path[64], what[512];
} compilation;

static void start_clang(compilation *c, const live_laws *live)
{
    char *text = assemble(live);
    describe(live, c->what, sizeof c->what);
    strcpy(c->path, "/tmp/clast-program-XXXXXX");
    int descriptor = mkstemp(c->path);
    assert_true(descriptor >= 0);
    FILE *file = fdopen(descriptor, "w");
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
    free(text);
    c->child = fork();
    if (c->child == 0) {
        execlp("clang", "clang", "-x", "cl", "-cl-std=CL1.2", "-Xclang", "-finclude-default-header", "-Xclang", "-fdeclare-opencl-builtins",
               "-fsyntax-only", "-Xclang", live->law[SLOT_PRECISION] ? "-cl-ext=-cl_khr_fp64" : "-cl-ext=+cl_khr_fp64", "-Wall", "-Wextra", "-Werror", "-Wno-unused-parameter", "-Wno-unused-function", c->path, (char *)NULL);
        _exit(127);
    }
    assert_true(c->child > 0);
}

static void end_clang(compilation *c)
{
    int ended = -1;
    if (c->child <= 0)
        return;
    assert_int_equal(waitpid(c->child, &ended, 0), c->child);
    unlink(c->path);
    c->child = 0;
    if (!WIFEXITED(ended) || WEXITSTATUS(ended) != 0)
        fail_msg("clang refuses the program with%s", c->what);
}

#define AT_ONCE 2

typedef struct compilations {
    compilation slot[AT_ONCE];
    int next, count;
} compilations;

static void compile_offline(compilations *all, const live_laws *live)
{
    compilation *c = &all->slot[all->next];
    all->next = (all->next + 1) % AT_ONCE;
    all->count++;
    end_clang(c);
    start_clang(c, live);
}

/* By hand, for a compiler that has changed: every pair without any other law, in some minutes. */
static void compile_pairs_alone(compilations *all)
{
    for (size_t a = 0; a < LAWS; a++)
        for (size_t b = a + 1; b < LAWS; b++) {
            if (every_law[b]->slot == every_law[a]->slot)
                continue;
            live_laws live = with(every_law[a], every_law[b]);
            live.blocks = all->count % 2 != 0; /* either form of the stages */
            compile_offline(all, &live);
        }
}

static void test_offline(void **state)
{
    (void)state;
    compilations all;
    memset(&all, 0, sizeof all);
    if (!have_clang()) {
        print_message("no clang: programs are not compiled offline\n");
        skip();
    }
    for (int k = 0; k < 8; k++) {
        live_laws live = all_at_once(k % 2 != 0, k / 2 % 2 != 0);
        live.blocks = k >= 4;
        compile_offline(&all, &live);
        live = with(NULL, NULL);
        live.blocks = k >= 4;
        compile_offline(&all, &live);
    }
    for (size_t a = 0; a < LAWS; a++) {
        live_laws live = with(every_law[a], NULL);
        live.blocks = a % 2 != 0;
        compile_offline(&all, &live);
    }
    live_laws live;
    for (cover pairs = cover_begin(); cover_next(&pairs, &live);)
        compile_offline(&all, &live);
    if (getenv("CLAST_TEST_PAIRS_ALONE"))
        compile_pairs_alone(&all);
    for (int n = 0; n < AT_ONCE; n++)
        end_clang(&all.slot[n]);
    print_message("%d programs\n", all.count);
}

/* Every law that a scene may name is among those tried here. */
static void test_no_law_forgotten(void **state)
{
    (void)state;
    for (const law *const *l = laws; *l; l++) {
        bool found = false;
        for (size_t n = 0; n < LAWS; n++)
            found = found || every_law[n] == *l;
        if (!found)
            fail_msg("%s is not tried", (*l)->name);
    }
}

/* Every kernel file is in some program. */
static void test_no_file_forgotten(void **state)
{
    (void)state;
    for (const kernel_file *f = kernels_embedded; f->name; f++) {
        bool found = strcmp(f->name, "shared.h") == 0 || strcmp(f->name, "base.cl") == 0;
        for (size_t n = 0; n <= LAWS + 3 && !found; n++) {
            const char *files[FILES_MAX];
            live_laws live = n > LAWS + 2 ? all_at_once(true, true) : n > LAWS ? with(&law_precision_mixed, n > LAWS + 1 ? &law_elastic_plastic : &law_mindlin) : with(n < LAWS ? every_law[n] : NULL, NULL);
            live.servo = n <= LAWS;
            live.blocks = n % 2 != 0 || n > LAWS;
            int count = files_of(&live, files);
            for (int k = 0; k < count; k++)
                found = found || strcmp(files[k], f->name) == 0;
        }
        if (!found)
            fail_msg("%s is in no program", f->name);
    }
}

/* ---- on the device ---- */

static void check_arguments(cl_program program, const live_laws *live, const char *kernel_name, const char *what)
{
    const char *names[LAUNCH_NAMES_MAX];
    cl_int code;
    cl_uint arguments = 0;
    bool loop = strcmp(kernel_name, "step_loop") == 0;
    int count = launch_argument_names(live, kernel_name, names, LAUNCH_NAMES_MAX);
    cl_kernel kernel = clCreateKernel(program, kernel_name, &code);
    assert_int_equal(code, CL_SUCCESS);
    assert_int_equal(clGetKernelInfo(kernel, CL_KERNEL_NUM_ARGS, sizeof arguments, &arguments, NULL), CL_SUCCESS);
    int first = (int)arguments - count;
    char name[256];
    for (int a = 0; a < (int)arguments; a++) {
        assert_int_equal(clGetKernelArgInfo(kernel, (cl_uint)a, CL_KERNEL_ARG_NAME, sizeof name, name, NULL), CL_SUCCESS);
        const char *expected = a >= first ? names[a - first] : a == 0 ? "launch" : "control", *known = name;
        if (loop)
            known += strncmp(name, "pair_", 5) == 0 ? 5 : strncmp(name, "particle_", 9) == 0 ? 9 : 0;
        if (strcmp(known, expected) != 0 && !(loop && a < first))
            fail_msg("%s, program with%s: argument %d is %s, not %s", kernel_name, what, a, name, expected);
    }
    bool stage = strstr(kernel_name, "_stage") != NULL;
    assert_int_equal(first, loop ? 8 : stage ? 2 : 1);
    clReleaseKernel(kernel);
}

static void check_on_device(const live_laws *live)
{
    static const char *const kernels[] = {"pair_stage", "particle_stage", "pair_probe", "observe_records", "limit_records", "step_loop"};
    char *text = assemble(live), what[512], log[4000] = "";
    const char *lines = text;
    cl_int code;
    describe(live, what, sizeof what);
    cl_program program = clCreateProgramWithSource(case_device()->context, 1, &lines, NULL, &code);
    assert_int_equal(code, CL_SUCCESS);
    /* what is asked here does not depend on optimising, which takes most of the time */
    if (clBuildProgram(program, 1, &case_device()->info.id, "-cl-std=CL1.2 -cl-kernel-arg-info -cl-opt-disable", NULL, NULL) != CL_SUCCESS) {
        clGetProgramBuildInfo(program, case_device()->info.id, CL_PROGRAM_BUILD_LOG, sizeof log, log, NULL);
        fail_msg("the program with%s does not build: %s", what, log);
    }
    live_laws packed = *live;
    live_for_blocks(&packed);
    for (size_t k = 0; k < sizeof kernels / sizeof *kernels; k++)
        check_arguments(program, &packed, kernels[k], what);
    if (live->law[SLOT_TEMPERATURE])
        check_arguments(program, &packed, "heat_conductances", what);
    clReleaseProgram(program);
    free(text);
}

static void test_on_device(void **state)
{
    (void)state;
    const law *const pairs[][2] = {
        {NULL, NULL},
        {&law_hertz, NULL},
        {&law_hertz, &law_walls_planes},
        {&law_hertz, &law_mindlin},
        {&law_linear, &law_coulomb_linear},
        {&law_slip_two, &law_walls_finite},
        {&law_hertz, &law_walls_round},
        {&law_elastic_plastic, &law_periodic_box},
        {&law_constant_torque, &law_motion_groups},
        {&law_composition_several, &law_orientation_quaternion},
        {&law_local_damping, &law_rotation_spin},
        {&law_overlap_area, &law_substance_several},
        {&law_wall_temperature, &law_environment_profile},
        {&law_nusselt, &law_thermal_groups},
        {&law_hertz, &law_ledger_energies},
        {&law_precision_mixed, &law_mindlin},
        {&law_precision_mixed, &law_mindlin},
        {&law_precision_mixed, &law_elastic_plastic},
        {&law_precision_mixed, &law_elastic_plastic},
    };
    for (size_t n = 0; n < sizeof pairs / sizeof *pairs; n++) {
        live_laws live = with(pairs[n][0], pairs[n][1]);
        live.blocks = n % 2 != 0;
        check_on_device(&live);
    }
    for (int second = 0; second < 2; second++) {
        live_laws live = all_at_once(second != 0, second != 0);
        check_on_device(&live);
    }
}

/* ---- a scene pays for what it calls for ---- */

static bool names_what_is_not_live(const char *name)
{
    return strstr(name, "heat") || strstr(name, "temperature") || strstr(name, "environment") || strstr(name, "grain_constants") || strstr(name, "spin") || strstr(name, "torque") || strstr(name, "spring") || strstr(name, "sliding");
}

static void test_pays_for_nothing(void **state)
{
    (void)state;
    sim_case c;
    case_open(&c, "effects: [{slot: normal, law: hertz}]\n"
                  "materials: [{name: m, density_kg_m3: 2500, youngs_modulus_pa: 5.0e6, poissons_ratio: 0.3}]\n"
                  "interactions: [{between: default, restitution: 0.5, friction_static: 0.5}]\n"
                  "particles: [{name: bed, material: m, generator: list, items: [{position_m: [0, 0, 0], radius_m: 0.01}]}]\n"
                  "walls: [{name: floor, shape: plane, point_m: [0, 0, -1], normal: [0, 0, 1]}]\n"
                  "stages: [{name: go, until: {steps: 1}, step_s: 1.0e-5}]\n");
    for (int f = 0; f < c.sim->field_count; f++)
        assert_false(names_what_is_not_live(c.sim->field[f].field->name));
    for (int k = 0; k < c.sim->kernel_count; k++) {
        cl_uint arguments = 0;
        char name[256];
        assert_int_equal(clGetKernelInfo(c.sim->kernel[k].kernel, CL_KERNEL_NUM_ARGS, sizeof arguments, &arguments, NULL), CL_SUCCESS);
        for (cl_uint a = 0; a < arguments; a++) {
            assert_int_equal(clGetKernelArgInfo(c.sim->kernel[k].kernel, a, CL_KERNEL_ARG_NAME, sizeof name, name, NULL), CL_SUCCESS);
            if (names_what_is_not_live(name))
                fail_msg("%s has an argument %s", c.sim->kernel[k].name, name);
        }
    }
    char *text = assemble(&c.sim->live);
    assert_null(strstr(text, "tangential_spring"));
    assert_null(strstr(text, "rolling_spring"));
    free(text);
    case_close(&c);
}

/* ---- shared structs ---- */

typedef struct shared_place {
    const char *type, *member; /* member NULL: the size */
    size_t host;
} shared_place;

#define SIZE(t)             \
    {                       \
#t, NULL, sizeof(t) \
    }
#define PLACE(t, m)            \
    {                          \
#t, #m, offsetof(t, m) \
    }
static const shared_place places[] = {
    SIZE(clast_launch),
    PLACE(clast_launch, gravity),
    PLACE(clast_launch, drift),
    PLACE(clast_launch, travel2),
    PLACE(clast_launch, low),
    PLACE(clast_launch, high),
    PLACE(clast_launch, length),
    PLACE(clast_launch, record_stride),
    PLACE(clast_launch, particle_count),
    PLACE(clast_launch, first_wall_group),
    PLACE(clast_launch, first_group),
    PLACE(clast_launch, force_shift),
    PLACE(clast_launch, step),
    PLACE(clast_launch, face_row),
    PLACE(clast_launch, mover_row),
    PLACE(clast_launch, face_count),
    PLACE(clast_launch, mover_count),
    PLACE(clast_launch, heat_row),
    PLACE(clast_launch, bonding),
    PLACE(clast_launch, mixed),
    SIZE(clast_control),
    PLACE(clast_control, halt_step),
    PLACE(clast_control, reason),
    PLACE(clast_control, spare),
    SIZE(clast_face),
    PLACE(clast_face, origin),
    PLACE(clast_face, normal),
    PLACE(clast_face, e1),
    PLACE(clast_face, e2),
    PLACE(clast_face, extent),
    PLACE(clast_face, slant),
    PLACE(clast_face, slant_length),
    PLACE(clast_face, velocity),
    PLACE(clast_face, spin),
    PLACE(clast_face, pivot),
    PLACE(clast_face, shape),
    PLACE(clast_face, party),
    PLACE(clast_face, wall),
    PLACE(clast_face, drive),
    SIZE(clast_table_phase),
    PLACE(clast_table_phase, kind),
    PLACE(clast_table_phase, memory),
    SIZE(clast_table_list),
    PLACE(clast_table_list, grid),
    PLACE(clast_table_list, phase),
    SIZE(clast_servo),
    PLACE(clast_servo, target),
    PLACE(clast_servo, speed_max),
    PLACE(clast_servo, inverse_unit),
    PLACE(clast_servo, shift),
    PLACE(clast_servo, travel_max),
    PLACE(clast_servo, fastest),
    PLACE(clast_servo, reversals),
    PLACE(clast_servo, live),
    SIZE(clast_mover),
    PLACE(clast_mover, shift),
    PLACE(clast_mover, pivot),
    PLACE(clast_mover, pivot_end),
    PLACE(clast_mover, axis),
    PLACE(clast_mover, sine),
    PLACE(clast_mover, versine),
    PLACE(clast_mover, velocity),
    PLACE(clast_mover, spin),
    SIZE(clast_environment),
    PLACE(clast_environment, gas_velocity),
    SIZE(clast_profile),
    PLACE(clast_profile, value),
    PLACE(clast_profile, axis),
    PLACE(clast_profile, count),
    SIZE(clast_wall_heat),
    PLACE(clast_wall_heat, flux),
    PLACE(clast_wall_heat, quantum),
    PLACE(clast_wall_heat, kind),
    PLACE(clast_wall_heat, wall),
    SIZE(clast_group_heat),
    PLACE(clast_group_heat, heat),
    PLACE(clast_group_heat, prescribed),
    PLACE(clast_group_heat, spare),
    SIZE(clast_level),
    PLACE(clast_level, inverse_size),
    PLACE(clast_level, cells),
    PLACE(clast_level, first_cell),
    SIZE(clast_grid),
    PLACE(clast_grid, origin),
    PLACE(clast_grid, radius_max),
    PLACE(clast_grid, skin),
    PLACE(clast_grid, wall_share),
    PLACE(clast_grid, level),
    PLACE(clast_grid, level_count),
    PLACE(clast_grid, cell_count),
    PLACE(clast_grid, drop_outside),
    PLACE(clast_grid, spare),
};
#define PLACES (sizeof places / sizeof *places)

/* Writes back sizes and offsets in the order of `places`. */
static char *place_kernel(void)
{
    char *text = NULL, *source = NULL;
    size_t size = 0;
    MUST(program_assemble("", NULL, 0, NULL, &text, why));
    FILE *out = open_memstream(&source, &size);
    assert_non_null(out);
    fprintf(out, "%s\n__kernel void shared_places(__global ulong *restrict result)\n{\n", text);
    for (size_t n = 0; n < PLACES; n++)
        if (places[n].member)
            fprintf(out, "    { %s s; result[%zu] = (ulong)((__private char *)&s.%s - (__private char *)&s); }\n", places[n].type, n,
                    places[n].member);
        else
            fprintf(out, "    result[%zu] = sizeof(%s);\n", n, places[n].type);
    fputs("}\n", out);
    fclose(out);
    free(text);
    return source;
}

static void test_shared_structs(void **state)
{
    (void)state;
    char *text = place_kernel();
    cl_program program;
    cl_int code;
    cl_ulong result[PLACES];
    size_t one = 1;
    device *d = case_device();
    MUST(program_build(d, text, &program, why));
    cl_kernel kernel = clCreateKernel(program, "shared_places", &code);
    assert_int_equal(code, CL_SUCCESS);
    cl_mem mem = clCreateBuffer(d->context, CL_MEM_READ_WRITE, sizeof result, NULL, &code);
    assert_int_equal(code, CL_SUCCESS);
    assert_int_equal(clSetKernelArg(kernel, 0, sizeof mem, &mem), CL_SUCCESS);
    assert_int_equal(clEnqueueNDRangeKernel(d->queue, kernel, 1, NULL, &one, &one, 0, NULL, NULL), CL_SUCCESS);
    assert_int_equal(clEnqueueReadBuffer(d->queue, mem, CL_TRUE, 0, sizeof result, result, 0, NULL, NULL), CL_SUCCESS);
    for (size_t n = 0; n < PLACES; n++)
        if (result[n] != places[n].host)
            fail_msg("%s.%s: %llu on the device, %zu on the host", places[n].type, places[n].member ? places[n].member : "(size)",
                     (unsigned long long)result[n], places[n].host);
    clReleaseMemObject(mem);
    clReleaseKernel(kernel);
    clReleaseProgram(program);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_law_forgotten), cmocka_unit_test(test_no_file_forgotten), cmocka_unit_test(test_offline),
        cmocka_unit_test(test_on_device),        cmocka_unit_test(test_pays_for_nothing),      cmocka_unit_test(test_shared_structs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
