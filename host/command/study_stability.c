/* clast study stability */
#include "../study_stability.h"
#include "../scene.h"
#include "command.h"

#include <stdlib.h>
#include <string.h>

enum { KEY_TOLERANCE = 256, KEY_STEPS, KEY_STAGE, KEY_JSON, KEY_PRECISION };

typedef struct stability_input {
    stability_options options;
    device_options device;
    set_options set;
} stability_input;

static double tolerance_of(const struct argp_state *state, const char *text)
{
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end != '\0' || !(value >= 1e-3 && value <= 1.0))
        option_refuse(state, "--tolerance: `%s` is not a number from 0.001 to 1", text);
    return value;
}

static const char *precision_of(const struct argp_state *state, const char *text)
{
    enum precision found;
    if (!precision_find(text, &found))
        option_refuse(state, "--precision: `%s` is none of auto, double, mixed", text);
    return text;
}

static error_t parse_stability(int key, char *argument, struct argp_state *state)
{
    stability_input *input = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &input->device;
        state->child_inputs[1] = &input->set;
        return 0;
    case 'o':
        input->options.out = argument;
        return 0;
    case KEY_TOLERANCE:
        input->options.tolerance = tolerance_of(state, argument);
        return 0;
    case KEY_STEPS:
        input->options.steps = option_count(state, "--steps", argument, 100, 1000000000);
        return 0;
    case KEY_STAGE:
        input->options.stage = argument;
        return 0;
    case KEY_JSON:
        input->options.json = true;
        return 0;
    case KEY_PRECISION:
        input->options.precision = precision_of(state, argument);
        return 0;
    case ARGP_KEY_ARG:
        option_only(state, &input->options.scene_path, argument);
        return 0;
    case ARGP_KEY_END:
        if (!input->options.scene_path)
            option_refuse(state, "which scene? Name a SCENE.yaml");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_option stability_option[] = {
    {"out", 'o', "DIR", 0, "Folder for stability.json and stability.csv", 0},
    {"steps", KEY_STEPS, "N", 0, "Steps of auto's size a run, at most (default 10000)", 0},
    {"tolerance", KEY_TOLERANCE, "X", 0, "How close the bisection comes, as a share of the factor (default 0.05)", 0},
    {"stage", KEY_STAGE, "NAME", 0, "Study this stage alone; the stages before it run with auto's step", 0},
    {"json", KEY_JSON, NULL, 0, "Write JSON to standard output, and nothing else", 0},
    {"precision", KEY_PRECISION, "P", 0, "auto, double or mixed, instead of the scene's", 0},
    {0},
};
static const struct argp_child stability_children[] = {{.argp = &device_options_argp}, {.argp = &set_options_argp}, {0}};
static const struct argp stability_argp = {
    .options = stability_option,
    .parser = parse_stability,
    .args_doc = "SCENE.yaml",
    .doc =
        "Find the largest stable step of every stage of a scene, and how far above the step that `step_s: auto` takes it is."
        "\vA step is stable where no guard stops the run, and where energy, motion at the end and temperatures stay within what a run at a"
        " quarter of auto's step has. Stages longer than --steps are cut.",
    .children = stability_children,
};

status command_study_stability(int argc, char **argv, failure *why)
{
    stability_input input = {.options = {.steps = 10000, .tolerance = 0.05}};
    error_t error = argp_parse(&stability_argp, argc, argv, 0, NULL, &input);
    if (error)
        return fail(why, STATUS_ERROR, "%s", strerror(error));
    input.options.device = input.device.device;
    input.options.kernels = input.device.kernels;
    input.options.set_count = input.set.count;
    input.options.sets = input.set.value;
    status result = study_stability(&input.options, why);
    set_options_free(&input.set);
    return result;
}
