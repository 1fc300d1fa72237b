/* clast devices */
#include "../device.h"
#include "command.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { KEY_JSON = 256 };

#define COLUMNS 8

static error_t parse_devices(int key, char *argument, struct argp_state *state)
{
    (void)argument;
    bool *json = state->input;
    if (key != KEY_JSON)
        return ARGP_ERR_UNKNOWN;
    *json = true;
    return 0;
}

static const struct argp_option devices_option[] = {{"json", KEY_JSON, NULL, 0, "Write the list as JSON", 0}, {0}};
static const struct argp devices_argp = {
    .options = devices_option,
    .parser = parse_devices,
    .doc = "List every OpenCL device, and which one a run would use.\vThe memory of a CPU device is what the host has available; the "
           "driver may"
           " report less and still allocate more.",
};

static const char *type_name(const device_info *info)
{
    return info->gpu ? "gpu" : info->cpu ? "cpu" : "accelerator";
}

static void print_bytes(char *text, size_t size, uint64_t bytes)
{
    snprintf(text, size, "%.1f GiB", (double)bytes / (1024.0 * 1024.0 * 1024.0));
}

/* One row's cells; `info` NULL is the heading. */
static void fill_row(char cell[COLUMNS][300], const device_info *info, int index)
{
    static const char *const heading[COLUMNS] = {"#", "name", "type", "memory", "largest buffer", "fp64", "units", "driver"};
    if (!info) {
        for (int c = 0; c < COLUMNS; c++)
            strcpy(cell[c], heading[c]);
        return;
    }
    snprintf(cell[0], sizeof cell[0], "%d", index);
    strcpy(cell[1], info->name);
    strcpy(cell[2], type_name(info));
    print_bytes(cell[3], sizeof cell[3], info->usable_bytes);
    print_bytes(cell[4], sizeof cell[4], info->buffer_bytes);
    strcpy(cell[5], info->fp64 ? "yes" : "no");
    snprintf(cell[6], sizeof cell[6], "%u", info->compute_units);
    strcpy(cell[7], info->driver);
}

static void print_table(const device_info *list, int count, int used)
{
    char cell[COLUMNS][300];
    int width[COLUMNS] = {0};
    for (int k = -1; k < count; k++) {
        fill_row(cell, k < 0 ? NULL : &list[k], k);
        for (int c = 0; c < COLUMNS; c++)
            width[c] = (int)strlen(cell[c]) > width[c] ? (int)strlen(cell[c]) : width[c];
    }
    for (int k = -1; k < count; k++) {
        fill_row(cell, k < 0 ? NULL : &list[k], k);
        printf("%c", k == used && k >= 0 ? '*' : ' ');
        for (int c = 0; c < COLUMNS; c++)
            printf(" %-*s%s", c == COLUMNS - 1 ? 0 : width[c], cell[c], c == COLUMNS - 1 ? "\n" : " ");
    }
    if (used >= 0)
        printf("* is used unless --device says otherwise%s.\n",
               list[used].fp64 ? "" : "; it has no fp64, so scenes run in mixed precision");
}

static status print_json(const device_info *list, int count, int used, failure *why)
{
    json_t *array = json_array();
    for (int k = 0; k < count; k++) {
        const device_info *info = &list[k];
        json_t *entry = json_pack("{s:i, s:s, s:s, s:s, s:s, s:I, s:I, s:I, s:b, s:I, s:s, s:s, s:b}", "index", k, "name", info->name,
                                  "type", type_name(info), "vendor", info->vendor, "platform", info->platform_name, "memory_bytes",
                                  (json_int_t)info->memory_bytes, "usable_bytes", (json_int_t)info->usable_bytes, "largest_buffer_bytes",
                                  (json_int_t)info->buffer_bytes, "fp64", info->fp64, "compute_units", (json_int_t)info->compute_units,
                                  "driver", info->driver, "version", info->version, "used", k == used);
        json_array_append_new(array, entry);
    }
    int failed = json_dumpf(array, stdout, JSON_INDENT(2));
    json_decref(array);
    printf("\n");
    return failed ? fail(why, STATUS_ERROR, "the list of devices cannot be written as JSON") : STATUS_OK;
}

status command_devices(int argc, char **argv, failure *why)
{
    bool json = false;
    TRY(command_parse(&devices_argp, 0, argc, argv, &json, why));
    device_info *list;
    int count, used;
    TRY(device_list(&list, &count, why));
    failure unused;
    if (device_choose(list, count, NULL, true, &used, &unused) != STATUS_OK &&
        device_choose(list, count, NULL, false, &used, &unused) != STATUS_OK)
        used = -1;
    status result = STATUS_OK;
    if (json)
        result = print_json(list, count, used, why);
    else
        print_table(list, count, used);
    free(list);
    return result;
}
