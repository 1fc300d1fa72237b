/* clast check */
#include "../plan.h"
#include "command.h"

#include <string.h>

enum { KEY_JSON = 256, KEY_PROBE };

typedef struct check_input {
    const char *scene_path;
    bool json, probe;
    device_options device;
    set_options set;
} check_input;

static error_t parse_check(int key, char *argument, struct argp_state *state)
{
    check_input *input = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &input->device;
        state->child_inputs[1] = &input->set;
        return 0;
    case KEY_JSON:
        input->json = true;
        return 0;
    case KEY_PROBE:
        input->probe = true;
        return 0;
    case ARGP_KEY_ARG:
        option_only(state, &input->scene_path, argument);
        return 0;
    case ARGP_KEY_END:
        if (!input->scene_path)
            option_refuse(state, "which scene? Name a SCENE.yaml");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_option check_option[] = {
    {"json", KEY_JSON, NULL, 0, "Write the plan as JSON", 0},
    {"probe", KEY_PROBE, NULL, 0, "Run a few steps to estimate the speed", 0},
    {0},
};
static const struct argp_child check_children[] = {{.argp = &device_options_argp}, {.argp = &set_options_argp}, {0}};
static const struct argp check_argp = {
    .options = check_option,
    .parser = parse_check,
    .args_doc = "SCENE.yaml",
    .doc = "Check a scene and show its plan: live laws, unused properties, memory, time steps and what binds them.",
    .children = check_children,
};

status command_check(int argc, char **argv, failure *why)
{
    check_input input = {0};
    error_t error = argp_parse(&check_argp, argc, argv, 0, NULL, &input);
    if (error)
        return fail(why, STATUS_ERROR, "%s", strerror(error));
    status result = plan_command(input.scene_path, input.set.count, input.set.value, input.device.device, input.device.kernels, input.json,
                                 input.probe, why);
    set_options_free(&input.set);
    return result;
}
