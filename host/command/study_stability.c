/* clast study stability */
#include "../study_stability.h"
#include "command.h"

enum { KEY_TOLERANCE = 256, KEY_STEPS, KEY_STAGE, KEY_JSON, KEY_PRECISION };

typedef struct stability_input {
    stability_options options;
    scene_input scene;
} stability_input;

static error_t parse_stability(int key, char *argument, struct argp_state *state)
{
    stability_input *input = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &input->scene;
        return 0;
    case 'o':
        input->scene.run.out = argument;
        return 0;
    case KEY_TOLERANCE:
        input->options.tolerance = option_number(state, "--tolerance", argument, 1e-3, 1.0);
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
        input->scene.run.precision = option_precision(state, argument);
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
static const struct argp_child stability_children[] = {{.argp = &scene_input_argp}, {0}};
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
    TRY(command_parse(&stability_argp, 0, argc, argv, &input, why));
    input.options.run = input.scene.run;
    status result = study_stability(&input.options, why);
    scene_input_free(&input.scene);
    return result;
}
