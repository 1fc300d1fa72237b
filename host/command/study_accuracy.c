/* clast study accuracy */
#include "../study.h"
#include "command.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { KEY_TOLERANCE = 256, KEY_CHOICES, KEY_LEVELS, KEY_BUDGET, KEY_JOBS, KEY_REPEATS };

typedef struct accuracy_input {
    study_options options;
    device_options device;
    set_options set;
} accuracy_input;

static double positive(const struct argp_state *state, const char *name, const char *text)
{
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(value) || value <= 0.0)
        option_refuse(state, "%s: `%s` is not a number above 0", name, text);
    return value;
}

static error_t parse(int key, char *argument, struct argp_state *state)
{
    accuracy_input *input = state->input;
    study_options *o = &input->options;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &input->device;
        state->child_inputs[1] = &input->set;
        return 0;
    case 'o':
        o->run.out = argument;
        return 0;
    case 'q':
        o->run.quiet = true;
        return 0;
    case KEY_TOLERANCE:
        o->tolerance = positive(state, "--tolerance", argument);
        return 0;
    case KEY_BUDGET:
        o->budget_s = positive(state, "--budget", argument);
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
    case ARGP_KEY_ARG:
        option_only(state, &o->run.scene_path, argument);
        return 0;
    case ARGP_KEY_END:
        if (!o->run.scene_path)
            option_refuse(state, "which scene? Name a SCENE.yaml");
        if (!o->run.out)
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
    char *list = NULL;
    size_t size;
    FILE *stream = open_memstream(&list, &size);
    if (!stream)
        return NULL;
    fprintf(stream, "Choices (the step is always one):\n");
    for (int k = 0; study_choice_names[k]; k++)
        fprintf(stream, "  %-10s %s\n", study_choice_names[k], study_choice_docs[k]);
    fprintf(stream, "\nThe scene names its answers under `study`, where `clast reference` lists its other keys. The folder gets "
                    "accuracy.csv, accuracy.h5 and the"
                    " work-precision diagram as accuracy.png and accuracy.svg.");
    fclose(stream);
    return list;
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
static const struct argp_child children[] = {{.argp = &device_options_argp}, {.argp = &set_options_argp}, {0}};
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
    error_t error = argp_parse(&accuracy_argp, argc, argv, 0, NULL, &input);
    if (error)
        return fail(why, STATUS_ERROR, "%s", strerror(error));
    input.options.run.device = input.device.device;
    input.options.run.kernels = input.device.kernels;
    input.options.run.set_count = input.set.count;
    input.options.run.sets = input.set.value;
    status result = study_accuracy(&input.options, why);
    set_options_free(&input.set);
    return result;
}
