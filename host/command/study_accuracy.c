/* clast study accuracy */
#include "../study.h"
#include "command.h"

#include <float.h>
#include <math.h>

enum { KEY_TOLERANCE = 256, KEY_CHOICES, KEY_LEVELS, KEY_BUDGET, KEY_JOBS, KEY_REPEATS };

typedef struct accuracy_input {
    study_options options;
    scene_input scene;
} accuracy_input;

static error_t parse(int key, char *argument, struct argp_state *state)
{
    accuracy_input *input = state->input;
    study_options *o = &input->options;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &input->scene;
        return 0;
    case 'o':
        input->scene.run.out = argument;
        return 0;
    case 'q':
        input->scene.run.quiet = true;
        return 0;
    case KEY_TOLERANCE:
        o->tolerance = option_number(state, "--tolerance", argument, DBL_MIN, INFINITY);
        return 0;
    case KEY_BUDGET:
        o->budget_s = option_number(state, "--budget", argument, DBL_MIN, INFINITY);
        return 0;
    case KEY_CHOICES:
        o->choices = argument;
        return 0;
    case KEY_LEVELS:
        o->levels = (int)option_count(state, "--levels", argument, 3, STUDY_LEVELS_MAX - STUDY_LEVELS_PAST);
        return 0;
    case KEY_JOBS:
        o->jobs = (int)option_count(state, "--jobs", argument, 1, 10000);
        return 0;
    case KEY_REPEATS:
        o->repeats = (int)option_count(state, "--repeats", argument, 1, STUDY_REPEATS_MAX);
        return 0;
    case ARGP_KEY_END:
        if (!input->scene.run.out)
            option_refuse(state, "where to? Name a folder: --out DIR");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static char *help_text(int key, const char *text, void *input)
{
    (void)input;
    if (key != ARGP_KEY_HELP_POST_DOC)
        return (char *)text;
    int count = 0;
    while (study_choice_names[count])
        count++;
    return command_list(
        "Choices (the step is always one)", count, study_choice_names, study_choice_docs,
        "The scene names its answers under `study`, where `clast reference` lists its other keys. The folder gets accuracy.csv, accuracy.h5"
        " and the work-precision diagram as accuracy.png and accuracy.svg.");
}

static const struct argp_option option[] = {
    {"out", 'o', "DIR", 0, "Folder for the tables and the diagram", 0},
    {"tolerance", KEY_TOLERANCE, "X", 0, "End with the cheapest settings whose error is at most X", 0},
    {"choices", KEY_CHOICES, "A,B", 0, "Only these choices (default: all that the scene has)", 0},
    {"levels", KEY_LEVELS, "N", 0, "Steps of a ladder, each half of the one before (default: as many as the budget allows)", 0},
    {"budget", KEY_BUDGET, "SECONDS", 0, "Wall time that the study may take, roughly (default: 150)", 0},
    {"jobs", KEY_JOBS, "N", 0, "Runs at a time (default: one a core where beds are small)", 0},
    {"repeats", KEY_REPEATS, "N", 0, "Runs whose median gives the cost of a step (default: 5)", 0},
    {"quiet", 'q', NULL, 0, "Show no progress", 0},
    {0},
};
static const struct argp_child children[] = {{.argp = &scene_input_argp}, {0}};
static const struct argp accuracy_argp = {
    .options = option,
    .parser = parse,
    .args_doc = "SCENE.yaml",
    .doc = "Run a scene over a grid of choices and show what each error costs in time.\v ",
    .children = children,
    .help_filter = help_text,
};

status command_study_accuracy(int argc, char **argv, failure *why)
{
    accuracy_input input = {.options = {.tolerance = NAN, .budget_s = 150.0, .repeats = 5}};
    TRY(command_parse(&accuracy_argp, 0, argc, argv, &input, why));
    input.options.run = input.scene.run;
    status result = study_accuracy(&input.options, why);
    scene_input_free(&input.scene);
    return result;
}
