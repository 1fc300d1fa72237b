/* Kernels of the stage's program, and their arguments: those of the core by name, then what each live law adds, in the order of the slots. */
#include "laws/fields.h"
#include "laws/laws.h"
#include "precision.h"
#include "program.h"
#include "simulation.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FILES_MAX 128 /* of a program */

/* The field lists of kernels/stage: core names, then the slots whose fields follow. */
typedef enum list_part { LIST_PAIR, LIST_PARTICLE, LIST_SPIN, LIST_TORQUE } list_part;

typedef struct stage_list {
    const char *kernel;
    const char *core[10];
    list_part part;
} stage_list;

static const stage_list stage_lists[] = {
    {"pair_stage", {"owner", "other", "position", "velocity", "radius", "mass", "contact_constants", "force"}, LIST_PAIR},
    {"pair_probe", {"owner", "other", "position", "velocity", "radius", "mass", "contact_constants", "force"}, LIST_PAIR},
    {"observe_records", {"owner", "other", "position", "velocity", "radius", "mass", "contact_constants", "force"}, LIST_PAIR},
    {"heat_areas", {"owner", "other", "position", "velocity", "radius", "mass", "contact_constants", "force"}, LIST_PAIR},
    {"heat_conductances", {"owner", "other", "position", "velocity", "radius", "mass", "contact_constants", "force"}, LIST_PAIR},
    {"guard_records", {"owner", "other", "position", "velocity", "radius", "mass", "contact_constants", "force"}, LIST_PAIR},
    {"limit_records", {"owner", "other", "position", "velocity", "radius", "mass", "contact_constants", "force"}, LIST_PAIR},
    {"pair_catch_up", {"owner", "other", "position", "velocity", "radius", "mass", "contact_constants", "force"}, LIST_PAIR},
    {"particle_stage", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"particle_pack", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"particle_synchronise", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"stiffness_rate", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"heat_limit", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"heat_frozen_given", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"heat_frozen_links", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"heat_frozen_stage", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"heat_frozen_error", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"heat_frozen_findings", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"heat_frozen_accept", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"heat_frozen_probe", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"heat_frozen_spectrum", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"beam_bounds", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"beam_surface", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"beam_depth", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"heat_frozen_residual", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"heat_frozen_correct", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"heat_frozen_hold", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"heat_frozen_sinks", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"heat_frozen_scale", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"heat_frozen_store", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"heat_flush", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"heat_sums", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"heat_ahead", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
    {"heat_surfaces", {"slot_offset", "slots", "force", "radius", "mass", "position", "velocity", "built_position"}, LIST_PARTICLE},
};

/* The order in which PAIR_FIELDS and PARTICLE_FIELDS name the slots. */
static const slot_id pair_slots[] = {SLOT_TABLES, SLOT_COMPOSITION, SLOT_MOTION, SLOT_ROTATION, SLOT_BONDING, SLOT_BOND, SLOT_COHESION,
                                     SLOT_SLIP,        SLOT_TANGENTIAL, SLOT_ROLLING, SLOT_DISSIPATION, SLOT_DISSIPATION_HEAT, SLOT_LEDGER, SLOT_WALLS, SLOT_TEMPERATURE, SLOT_MODULUS, SLOT_SOFTENING, SLOT_EXPANSION, SLOT_CONDUCTIVITY, SLOT_CONDUCTION, SLOT_WALL_HEAT,
                                     SLOT_INTEGRATOR, SLOT_PACKED, SLOT_TOUCHED};
static const slot_id particle_slots[] = {SLOT_MOTION, SLOT_ROTATION, SLOT_ORIENTATION, SLOT_TEMPERATURE, SLOT_SUBSTANCE, SLOT_TABLES, SLOT_CONDUCTIVITY, SLOT_RADIUS, SLOT_EXPANSION, SLOT_ENVIRONMENT,
                                         SLOT_CONDUCTION, SLOT_SOURCE, SLOT_HEAT_STEPS, SLOT_THERMAL_GROUPS, SLOT_HEAT_TALLY, SLOT_MODULUS, SLOT_DISSIPATION, SLOT_DISSIPATION_HEAT, SLOT_LEDGER, SLOT_INTEGRATOR, SLOT_PACKED, SLOT_TOUCHED};

int launch_argument_names(const live_laws *live, const char *kernel, const char **names, int max)
{
    int count = 0;
    if (strcmp(kernel, "step_loop") == 0) {
        count = launch_argument_names(live, "pair_stage", names, max);
        return count + launch_argument_names(live, "particle_stage", names + count, max - count);
    }
    for (size_t l = 0; l < sizeof stage_lists / sizeof *stage_lists; l++) {
        const stage_list *list = &stage_lists[l];
        if (strcmp(list->kernel, kernel) != 0)
            continue;
        for (int n = 0; list->core[n] && count < max; n++)
            names[count++] = list->core[n];
        bool pair = list->part == LIST_PAIR;
        size_t slots = pair ? sizeof pair_slots / sizeof *pair_slots : sizeof particle_slots / sizeof *particle_slots;
        for (size_t s = 0; s < slots; s++) {
            const law *l1 = live->law[pair ? pair_slots[s] : particle_slots[s]];
            const field *const *fields = !l1 ? NULL : pair ? l1->pair_fields : l1->particle_fields;
            for (int f = 0; fields && f < LAW_ARGUMENTS_MAX && fields[f] && count < max; f++)
                names[count++] = fields[f]->name;
        }
    }
    return count;
}

static cl_mem named_buffer(simulation *sim, const char *name)
{
    contact_table *t = &sim->table;
    const struct {
        const char *name;
        cl_mem mem;
    } own[] = {{"owner", t->owner[t->now]},
               {"other", t->other[t->now]},
               {"slots", t->slots[t->now]},
               {"slot_offset", t->slot_offset[t->now]},
               {"contact_constants", sim->constants},
               {"built_position", sim->built_position},
               {"faces", sim->faces},
               {"movers", sim->movers},
               {"grain_constants", sim->heat.constants},
               {"environment", sim->heat.environment},
               {"profile", sim->heat.profile},
               {"wall_heat", sim->heat.walls},
               {"wall_area", sim->heat.areas},
               {"group_heat", sim->heat.groups},
               {"property_tables", sim->heat.tables},
               {"beams", sim->beams.device_rows},
               {"beam_meets", sim->beams.meets}};
    for (size_t n = 0; n < sizeof own / sizeof *own; n++)
        if (strcmp(own[n].name, name) == 0)
            return own[n].mem;
    stored_field *stored = store_find(sim, name);
    return stored ? stored->mem : NULL;
}

status launch_bind(simulation *sim, const char *kernel, int first, failure *why)
{
    const char *names[LAUNCH_NAMES_MAX];
    int count = launch_argument_names(&sim->live, kernel, names, LAUNCH_NAMES_MAX);
    cl_kernel k = launch_kernel(sim, kernel);
    for (int a = 0; a < count; a++) {
        cl_mem mem = named_buffer(sim, names[a]);
        if (!mem)
            return fail(why, STATUS_ERROR, "internal: no array named %s for %s", names[a], kernel);
        TRY_CL(clSetKernelArg(k, (cl_uint)(first + a), sizeof mem, &mem), kernel);
    }
    return STATUS_OK;
}

/* The particle stage finds forces where chunks share places for them. */
status launch_bind_placed_slots(simulation *sim, const char *kernel, int first, failure *why)
{
    const char *names[LAUNCH_NAMES_MAX];
    int count = launch_argument_names(&sim->live, kernel, names, LAUNCH_NAMES_MAX);
    for (int a = 0; a < count && sim->plan.force_records > 0; a++)
        if (strcmp(names[a], "slots") == 0)
            TRY_CL(clSetKernelArg(launch_kernel(sim, kernel), (cl_uint)(first + a), sizeof sim->table.placed, &sim->table.placed), kernel);
    return STATUS_OK;
}

/* After a table has been built its buffers may be others. */
status launch_bind_stages(simulation *sim, failure *why)
{
    cl_kernel pair = launch_kernel(sim, "pair_stage"), particle = launch_kernel(sim, "particle_stage");
    TRY(launch_bind(sim, "pair_stage", 2, why));
    TRY(launch_bind(sim, "particle_stage", 2, why));
    TRY(launch_bind_placed_slots(sim, "particle_stage", 2, why));
    TRY_CL(clSetKernelArg(pair, 1, sizeof sim->control, &sim->control), "pair_stage");
    TRY_CL(clSetKernelArg(particle, 1, sizeof sim->control, &sim->control), "particle_stage");
    const char *const others[] = {"pair_probe", "observe_records", "limit_records"};
    for (size_t k = 0; k < sizeof others / sizeof *others; k++)
        TRY(launch_bind(sim, others[k], 1, why));
    TRY(step_loop_bind(sim, why));
    if (sim->live.law[SLOT_PACKED])
        TRY(launch_bind(sim, "particle_pack", 1, why));
    if (!live_keeps_half_steps(&sim->live))
        return STATUS_OK;
    TRY(launch_bind(sim, "pair_catch_up", 1, why));
    return launch_bind(sim, "particle_synchronise", 5, why);
}

static status open_program(simulation *sim, const char *constants, const char *const *files, int count, cl_program *out, failure *why)
{
    char *text = NULL;
    TRY(program_assemble(constants, files, count, sim->kernels_directory, &text, why));
    status result = program_build(sim->device, text, out, why);
    free(text);
    return result;
}

/* Kernels that build tables are in a program of their own. */
static bool is_of_table(const char *name)
{
    return strncmp(name, "table_", 6) == 0 || strncmp(name, "scan_", 5) == 0;
}

static bool has_kernel(const simulation *sim, const char *name)
{
    if (strcmp(name, "step_loop") == 0)
        return step_loop_wanted(sim);
    if (strcmp(name, "table_phases") == 0)
        return sim->live.blocks;
    if (strcmp(name, "particle_synchronise") == 0 || strcmp(name, "pair_catch_up") == 0)
        return live_keeps_half_steps(&sim->live);
    if (strcmp(name, "particle_pack") == 0)
        return sim->live.law[SLOT_PACKED] != NULL;
    if (strcmp(name, "heat_ahead") == 0)
        return live_keeps_half_steps(&sim->live) && sim->live.law[SLOT_DISSIPATION_HEAT];
    if (strcmp(name, "heat_flush") == 0)
        return sim->live.law[SLOT_HEAT_STEPS] != NULL;
    if (strcmp(name, "heat_areas") == 0)
        return sim->live.law[SLOT_WALL_HEAT] == &law_wall_flux;
    if (strcmp(name, "stiffness_rate") == 0)
        return live_changes_stiffness(&sim->live);
    if (strncmp(name, "heat_frozen_", 12) == 0)
        return sim->live.frozen;
    if (strncmp(name, "beam_", 5) == 0)
        return sim->live.law[SLOT_SOURCE] != NULL;
    if (strncmp(name, "heat_", 5) == 0)
        return sim->live.law[SLOT_TEMPERATURE] != NULL;
    if (strncmp(name, "servo_", 6) == 0)
        return sim->live.servo;
    if (strstr(name, "_bond_"))
        return sim->live.law[SLOT_BOND] != NULL;
    return !strstr(name, "_walls") || sim->live.law[SLOT_WALLS];
}

/* What of a device its programs are to know. Where the block is the usual one, programs are as they were before the device was tuned, and so taken
 * from the cache. */
static void define_device(const simulation *sim, char *text, size_t size)
{
    size_t used = strlen(text);
    if (sim->device->info.cpu)
        snprintf(text + used, size - used, "#define BODY OUTLINE\n");
    used = strlen(text);
    if (sim->block != CLAST_BLOCK)
        snprintf(text + used, size - used, "#define CLAST_BLOCK %d\n", sim->block);
}

status launch_open(simulation *sim, failure *why)
{
    const char *files[FILES_MAX], *table_files[LIVE_TABLE_FILES];
    char constants[8192], table_constants[256];
    live_table_constants(&sim->live, table_constants, sizeof table_constants);
    live_constants(&sim->live, sim->scene, constants, sizeof constants);
    define_device(sim, table_constants, sizeof table_constants);
    define_device(sim, constants, sizeof constants);
    int count = live_files(&sim->live, files, FILES_MAX - 1);
    if (step_loop_in_program(sim))
        files[count++] = "stage/step_loop.cl";
    TRY(open_program(sim, constants, files, count, &sim->program, why));
    TRY(open_program(sim, table_constants, table_files, live_table_files(&sim->live, table_files), &sim->table_program, why));
    static const char *const names[] = {"pair_stage",       "pair_probe",      "particle_stage",  "particle_pack",    "scan_chunks",       "scan_sums",
                                        "scan_write",       "scan_whole",       "table_bin",       "table_order",       "table_order_cells", "table_permute",
                                        "table_count",    "table_fill",        "table_pad",         "table_widths", "table_totals",
                                        "table_slots",      "table_sort_slots", "table_match",      "table_carry",       "table_where",       "table_travel",
                                        "table_last_records", "table_releases", "table_place", "table_phases",
                                        "observe_particles", "observe_records", "limit_records",    "limit_particles",   "limit_expected",
                                        "guard_particles",  "guard_records",   "table_count_walls", "table_fill_walls",
                                        "pair_catch_up", "particle_synchronise", "step_loop", "servo_place", "servo_stage", "table_bond_sums", "table_bond_inverse", "table_bond_count", "table_bond_fill",
                                        "heat_conductances", "heat_limit", "stiffness_rate", "heat_sums", "heat_ahead", "heat_surfaces", "heat_areas", "heat_flush",
                                        "heat_frozen_given", "heat_frozen_links", "heat_frozen_stage", "heat_frozen_error",
                                        "heat_frozen_findings", "heat_frozen_accept", "heat_frozen_probe", "heat_frozen_spectrum", "heat_frozen_residual",
                                        "heat_frozen_correct", "heat_frozen_hold", "heat_frozen_sinks", "heat_frozen_store",
                                        "heat_frozen_scale", "heat_frozen_cg_begin",
                                        "heat_frozen_cg_apply", "heat_frozen_cg_update", "heat_frozen_cg_turn", "heat_frozen_cg_fold",
                                        "beam_bounds", "beam_surface", "beam_depth"};
    sim->kernel_count = 0;
    for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
        if (!has_kernel(sim, names[n]))
            continue;
        cl_int code;
        cl_kernel kernel = clCreateKernel(is_of_table(names[n]) ? sim->table_program : sim->program, names[n], &code);
        if (code != CL_SUCCESS)
            return fail(why, STATUS_DEVICE, "the device failed: kernel %s (%s)", names[n], device_error_name(code));
        sim->kernel[sim->kernel_count++] = (kernel_slot){names[n], kernel};
    }
    return STATUS_OK;
}

void launch_close(simulation *sim)
{
    for (int k = 0; k < sim->kernel_count; k++)
        clReleaseKernel(sim->kernel[k].kernel);
    sim->kernel_count = 0;
    if (sim->program)
        clReleaseProgram(sim->program);
    if (sim->table_program)
        clReleaseProgram(sim->table_program);
    sim->program = sim->table_program = NULL;
}

cl_kernel launch_kernel(const simulation *sim, const char *name)
{
    for (int k = 0; k < sim->kernel_count; k++)
        if (strcmp(sim->kernel[k].name, name) == 0)
            return sim->kernel[k].kernel;
    return NULL;
}

/* Skins wider than this share of the mean radius are those of beds that move fast; a bed at rest takes a fifth at most (host/skin.c). */
#define LOOSE_SKIN 0.25

clast_launch launch_values(const simulation *sim)
{
    const domain *d = &sim->scene->domain;
    /* what rounding takes of a distance in mixed precision is far below this share of the skin */
    double travel = 0.5 * sim->table.skin * (sim->mixed ? 1.0 - 1e-3 : 1.0);
    clast_launch v = {
        .dt = sim->dt,
        .lag = sim->lag,
        .kick = sim->dt,
        .heat_span = sim->dt,
        .travel2 = travel * travel,
        .record_stride = sim->table.record_stride,
        .particle_count = (clast_i32)sim->count,
        .first_wall_group = sim->table.wall_base / sim->block,
        .first_wall_place = sim->table.wall_base,
        .loose = sim->table.skin > LOOSE_SKIN * sim->mean_radius,
        .keeps_zeros = sim->plan.force_records == 0,
        .face_count = sim->face_count,
        .mover_count = sim->mover_count,
        .mixed = sim->mixed,
    };
    for (int c = 0; c < 3; c++) {
        bool periodic = d->given && d->periodic[c];
        v.gravity[c] = sim->gravity[c];
        v.low[c] = d->given ? d->low_m[c] - sim->origin[c] : -1e30;
        v.high[c] = d->given ? d->high_m[c] - sim->origin[c] : 1e30;
        v.length[c] = periodic ? d->high_m[c] - d->low_m[c] : 0.0;
    }
    return v;
}

clast_launch launch_as_passed(clast_launch launch)
{
    if (launch.mixed)
        precision_split_launch(&launch);
    return launch;
}

status launch_pass(cl_kernel kernel, const char *name, const clast_launch *launch, failure *why)
{
    const clast_launch passed = launch_as_passed(*launch);
    TRY_CL(clSetKernelArg(kernel, 0, sizeof passed, &passed), name);
    return STATUS_OK;
}

status launch_run(simulation *sim, cl_kernel kernel, const char *name, int64_t items, int64_t group, failure *why)
{
    if (items <= 0)
        return STATUS_OK;
    size_t local = (size_t)group, global = ((size_t)items + local - 1) / local * local;
    cl_event event;
    TRY_CL(clEnqueueNDRangeKernel(sim->device->queue, kernel, 1, NULL, &global, &local, 0, NULL, sim->watch ? &event : NULL), name);
    if (sim->watch)
        sim->watch->seen(sim->watch->context, name, kernel, global, event);
    return STATUS_OK;
}

static cl_int set_arguments(cl_kernel kernel, cl_uint first, const char *types, va_list values)
{
    cl_int code = CL_SUCCESS;
    for (cl_uint a = first; *types && code == CL_SUCCESS; a++, types++) {
        if (*types == 'm') {
            cl_mem mem = va_arg(values, cl_mem);
            code = clSetKernelArg(kernel, a, sizeof mem, &mem);
        } else if (*types == 'i') {
            cl_int number = va_arg(values, cl_int);
            code = clSetKernelArg(kernel, a, sizeof number, &number);
        } else if (*types == 'l') {
            clast_i64 number = va_arg(values, clast_i64);
            code = clSetKernelArg(kernel, a, sizeof number, &number);
        } else if (*types == 'd') {
            double number = va_arg(values, double);
            code = clSetKernelArg(kernel, a, sizeof number, &number);
        } else if (*types == 'f') {
            float number = (float)va_arg(values, double);
            code = clSetKernelArg(kernel, a, sizeof number, &number);
        } else {
            clast_launch launch = *va_arg(values, const clast_launch *);
            if (launch.mixed)
                precision_split_launch(&launch);
            code = clSetKernelArg(kernel, a, sizeof launch, &launch);
        }
    }
    return code;
}

status launch_set_list(cl_kernel kernel, const char *name, failure *why, const char *types, va_list values)
{
    TRY_CL(set_arguments(kernel, 0, types, values), name);
    return STATUS_OK;
}

status launch_set(cl_kernel kernel, const char *name, failure *why, const char *types, ...)
{
    va_list values;
    va_start(values, types);
    status result = launch_set_list(kernel, name, why, types, values);
    va_end(values);
    return result;
}

status launch_set_from(cl_kernel kernel, const char *name, cl_uint first, failure *why, const char *types, ...)
{
    va_list values;
    va_start(values, types);
    cl_int code = set_arguments(kernel, first, types, values);
    va_end(values);
    TRY_CL(code, name);
    return STATUS_OK;
}
