#include "../scene.h"
#include "command.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void option_refuse(const struct argp_state *state, const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    fprintf(stderr, "%s: %s\n", state->name, text);
    exit(STATUS_BAD_INPUT);
}

int64_t option_count(const struct argp_state *state, const char *name, const char *text, int64_t low, int64_t high)
{
    char *end;
    errno = 0;
    double value = strtod(text, &end);
    bool whole = end != text && *end == '\0' && errno == 0 && value == floor(value);
    if (!whole || value < (double)low || value > (double)high)
        option_refuse(state, "%s: `%s` is not a whole number from %lld to %lld", name, text, (long long)low, (long long)high);
    return (int64_t)value;
}

double option_number(const struct argp_state *state, const char *name, const char *text, double low, double high)
{
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(value) || value < low || value > high) {
        if (isfinite(high))
            option_refuse(state, "%s: `%s` is not a number from %g to %g", name, text, low, high);
        option_refuse(state, "%s: `%s` is not a number above 0", name, text);
    }
    return value;
}

const char *option_precision(const struct argp_state *state, const char *text)
{
    enum precision found;
    if (!precision_find(text, &found))
        option_refuse(state, "--precision: `%s` is none of auto, double, mixed", text);
    return text;
}

void option_only(const struct argp_state *state, const char **store, const char *argument)
{
    if (*store)
        option_refuse(state, "`%s` is one argument too many after `%s`", argument, *store);
    *store = argument;
}

static error_t parse_device(int key, char *argument, struct argp_state *state)
{
    device_options *options = state->input;
    switch (key) {
    case 'd':
        options->device = argument;
        return 0;
    case 'k':
        options->kernels = argument;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_option device_option[] = {
    {"device", 'd', "DEVICE", 0, "Compute on this device: an index of `clast devices`, cpu, gpu, or part of a name", 0},
    {"kernels", 'k', "DIR", 0, "Take the kernels from this directory instead of those in the program", 0},
    {0},
};
const struct argp device_options_argp = {.options = device_option, .parser = parse_device};

error_t option_add(const struct argp_state *state, const char *name, const char *form, set_options *options, char *argument)
{
    if (!strchr(argument, '='))
        option_refuse(state, "%s %s: write PATH=%s", name, argument, form);
    char **value = realloc(options->value, ((size_t)options->count + 1) * sizeof *value);
    if (!value)
        return ENOMEM;
    options->value = value;
    options->value[options->count++] = argument;
    return 0;
}

static error_t parse_set(int key, char *argument, struct argp_state *state)
{
    return key == 's' ? option_add(state, "--set", "VALUE", state->input, argument) : ARGP_ERR_UNKNOWN;
}

static const struct argp_option set_option[] = {
    {"set", 's', "PATH=VALUE", 0, "Change a key of the scene, as in interactions[default].friction_static=0.3; may be repeated", 0},
    {0},
};
static const struct argp set_options_argp = {.options = set_option, .parser = parse_set};

void set_options_free(set_options *options)
{
    free(options->value);
    *options = (set_options){0};
}

/* argp ends the children of a command before the command itself. */
static error_t parse_scene(int key, char *argument, struct argp_state *state)
{
    scene_input *input = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &input->device;
        state->child_inputs[1] = &input->set;
        return 0;
    case ARGP_KEY_ARG:
        option_only(state, &input->run.scene_path, argument);
        return 0;
    case ARGP_KEY_END:
        if (!input->run.scene_path)
            option_refuse(state, "which scene? Name a SCENE.yaml");
        input->run.device = input->device.device;
        input->run.kernels = input->device.kernels;
        input->run.set_count = input->set.count;
        input->run.sets = input->set.value;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child scene_children[] = {{.argp = &device_options_argp}, {.argp = &set_options_argp}, {0}};
const struct argp scene_input_argp = {.parser = parse_scene, .children = scene_children};

void scene_input_free(scene_input *input)
{
    set_options_free(&input->set);
}
