/* What builds a table, one thing after the other: kernels, and fills and copies between them.
 *
 * On a GPU each is a command of its own. On a CPU a launch costs more than the work of most of them in a small bed, and hands grains to whatever
 * core is free. There they are put down in a list, and a team goes through it in one launch (kernels/stage/table_phases.cl) before anybody waits for
 * what comes of it. Who makes up the team is as with steps (step_loop.c). */
#include "simulation.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#define LIST_ARGUMENTS 5 /* before the buffers */
/* Pocl hands work-groups to a thread several at a time; all but one for each core return at once. */
#define GROUPS_EACH 32
/* Units of a phase for each core, so that who is late leaves some to others. */
#define UNITS_EACH 8
/* Words of a fill or a copy that go together at least. */
#define WORDS_TOGETHER 64

#define NAME(name)     #name,
static const char *const kind_name[CLAST_TABLE_KINDS] = {CLAST_TABLE_KERNELS(NAME)};

/* Where launches are watched each is one. */
static bool lists(const simulation *sim)
{
    return sim->live.blocks && !sim->watch;
}

static int kind_of(const char *name)
{
    int kind = 0;
    while (kind < CLAST_TABLE_KINDS && strcmp(kind_name[kind], name) != 0)
        kind++;
    return kind;
}

/* ---- a launch ---- */

static status run_one_by_one(simulation *sim, cl_kernel kernel, failure *why)
{
    const table_list *list = &sim->table.list;
    for (int p = 0; p < list->count; p++) {
        const clast_table_phase *phase = &list->rows->phase[p];
        int units = (phase->items + phase->unit_items - 1) / phase->unit_items;
        TRY(launch_set_from(kernel, "table_phases", LIST_ARGUMENTS - 1, why, "i", (cl_int)p));
        TRY(launch_run(sim, kernel, kind_name[phase->kind], units, 1, why));
    }
    return STATUS_OK;
}

status table_flush(simulation *sim, failure *why)
{
    table_list *list = &sim->table.list;
    cl_kernel kernel = launch_kernel(sim, "table_phases");
    if (list->count == 0)
        return STATUS_OK;
    loop_manner manner = step_loop_table_manner(sim);
    int most = manner == LOOP_TEAM ? step_loop_team(sim) : 1;
    TRY(store_write(sim, list->device, 0, offsetof(clast_table_list, phase) + sizeof *list->rows->phase * (uint64_t)list->count, list->rows,
                    why));
    TRY(launch_set(kernel, "table_phases", why, "Lmiii", &list->launch, list->device, (cl_int)list->count, (cl_int)most, (cl_int)-1));
    for (int m = 0; m < CLAST_TABLE_MEMORIES; m++)
        TRY(launch_set_from(kernel, "table_phases", (cl_uint)(LIST_ARGUMENTS + m), why, "m",
                            m < list->memories ? list->memory[m] : (cl_mem)NULL));
    if (manner == LOOP_PHASES)
        TRY(run_one_by_one(sim, kernel, why));
    else
        TRY(launch_run(sim, kernel, "table_phases", most > 1 ? most * GROUPS_EACH : 1, 1, why));
    list->count = list->memories = 0;
    list->launched = false;
    return STATUS_OK;
}

void table_list_free(simulation *sim)
{
    store_release(sim, &sim->table.list.device, sizeof(clast_table_list));
    free(sim->table.list.rows);
    sim->table.list = (table_list){0};
}

/* ---- the list ---- */

static clast_i32 place_of(simulation *sim, cl_mem memory)
{
    table_list *list = &sim->table.list;
    int m = 0;
    if (memory == sim->table.grid)
        return CLAST_TABLE_MEMORIES;
    while (m < list->memories && list->memory[m] != memory)
        m++;
    if (m == list->memories)
        list->memory[list->memories++] = memory;
    return (clast_i32)m;
}

/* Room for one more phase. */
static status make_room(simulation *sim, failure *why)
{
    table_list *list = &sim->table.list;
    if (!list->device)
        TRY(store_buffer(sim, &list->device, sizeof(clast_table_list), "the contact table", why));
    if (!list->rows)
        list->rows = calloc(1, sizeof *list->rows);
    if (!list->rows)
        return fail(why, STATUS_ERROR, "out of memory");
    bool full = list->count == CLAST_TABLE_PHASES_MAX || list->memories + CLAST_TABLE_ARGUMENTS > CLAST_TABLE_MEMORIES;
    return full ? table_flush(sim, why) : STATUS_OK;
}

/* A list has one launch for all its phases. */
static status take_launch(simulation *sim, const clast_launch *launch, failure *why)
{
    table_list *list = &sim->table.list;
    if (list->launched && memcmp(&list->launch, launch, sizeof *launch) != 0)
        TRY(table_flush(sim, why));
    list->launch = *launch;
    list->launched = true;
    return STATUS_OK;
}

/* Work-items to a unit: whole groups of so many. */
static int64_t unit_of(const simulation *sim, int64_t items, int64_t group)
{
    int64_t units = UNITS_EACH * step_loop_team(sim), groups = (items + group - 1) / group;
    return (groups + units - 1) / units * group;
}

static status put_down(simulation *sim, int kind, int64_t items, int64_t group, failure *why, const char *types, va_list values)
{
    table_list *list = &sim->table.list;
    int memories = 0, numbers = 0;
    TRY(make_room(sim, why));
    if (*types == 'L') {
        TRY(take_launch(sim, va_arg(values, const clast_launch *), why));
        types++;
    }
    clast_table_phase *phase = &list->rows->phase[list->count++];
    memset(phase, 0, sizeof *phase);
    phase->kind = (clast_i32)kind;
    phase->items = (clast_i32)items;
    phase->unit_items = (clast_i32)unit_of(sim, items, group);
    for (; *types; types++)
        if (*types == 'm')
            phase->memory[memories++] = place_of(sim, va_arg(values, cl_mem));
        else
            phase->number[numbers++] = *types == 'l' ? va_arg(values, clast_i64) : va_arg(values, cl_int);
    return STATUS_OK;
}

static status put_down_words(simulation *sim, const char *name, uint64_t bytes, failure *why, const char *types, ...)
{
    va_list values;
    va_start(values, types);
    status result = put_down(sim, kind_of(name), (int64_t)(bytes / 4), WORDS_TOGETHER, why, types, values);
    va_end(values);
    return result;
}

status table_do(simulation *sim, const char *name, int64_t items, int64_t group, failure *why, const char *types, ...)
{
    int kind = kind_of(name);
    if (items <= 0)
        return STATUS_OK;
    va_list values;
    va_start(values, types);
    status result = STATUS_OK;
    if (kind < CLAST_TABLE_KINDS && lists(sim))
        result = put_down(sim, kind, items, group, why, types, values);
    else {
        cl_kernel kernel = launch_kernel(sim, name);
        result = launch_set_list(kernel, name, why, types, values);
        if (result == STATUS_OK)
            result = launch_run(sim, kernel, name, items, group, why);
    }
    va_end(values);
    return result;
}

status table_do_fill(simulation *sim, cl_mem memory, uint64_t bytes, cl_int value, failure *why)
{
    if (bytes == 0)
        return STATUS_OK;
    if (lists(sim))
        return put_down_words(sim, "table_set", bytes, why, "mi", memory, value);
    TRY_CL(clEnqueueFillBuffer(sim->device->queue, memory, &value, sizeof value, 0, bytes, 0, NULL, NULL), "clearing a buffer");
    return STATUS_OK;
}

status table_give_grid(simulation *sim, const clast_grid *grid, failure *why)
{
    if (!lists(sim))
        return store_write(sim, sim->table.grid, 0, sizeof *grid, grid, why);
    TRY(table_flush(sim, why));
    TRY(make_room(sim, why));
    sim->table.list.rows->grid = *grid;
    return STATUS_OK;
}

status table_do_copy(simulation *sim, cl_mem from, cl_mem to, uint64_t bytes, failure *why)
{
    if (bytes == 0 || !lists(sim))
        return store_copy(sim, from, to, 0, 0, bytes, why);
    return put_down_words(sim, "table_copy", bytes, why, "mm", from, to);
}
