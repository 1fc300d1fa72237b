/* clast check */
#include "../plan.h"
#include "command.h"

#include <string.h>

enum { KEY_JSON = 256, KEY_PROBE };

typedef struct check_input {
    scene_input scene;
    bool json, probe;
} check_input;

static error_t parse_check(int key, char *argument, struct argp_state *state)
{
    check_input *input = state->input;
    (void)argument;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &input->scene;
        return 0;
    case KEY_JSON:
        input->json = true;
        return 0;
    case KEY_PROBE:
        input->probe = true;
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
static const struct argp_child check_children[] = {{.argp = &scene_input_argp}, {0}};
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
    TRY(command_parse(&check_argp, 0, argc, argv, &input, why));
    const run_options *run = &input.scene.run;
    status result = plan_command(run->scene_path, run->set_count, run->sets, run->device, run->kernels, input.json, input.probe, why);
    scene_input_free(&input.scene);
    return result;
}
