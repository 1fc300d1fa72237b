/* clast study: finds which study is asked for; each parses its own arguments (study_accuracy.c, study_stability.c). */
#include "command.h"

#include <stdio.h>
#include <string.h>

static const command studies[] = {
    {"accuracy", "what the answers of a scene cost in time, and how far off they are", command_study_accuracy},
    {"stability", "the largest stable step of a scene against the step that is taken", command_study_stability},
};
enum { STUDIES = sizeof studies / sizeof studies[0] };

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
    fprintf(stream, "Studies:\n");
    for (int k = 0; k < STUDIES; k++)
        fprintf(stream, "  %-10s %s\n", studies[k].name, studies[k].doc);
    fprintf(stream, "\n`clast study STUDY --help` explains one.");
    fclose(stream);
    return list;
}

/* Stops at the first argument that is no option: what follows belongs to the study. */
static error_t parse_study(int key, char *argument, struct argp_state *state)
{
    (void)argument;
    int *first = state->input;
    if (key != ARGP_KEY_ARG)
        return ARGP_ERR_UNKNOWN;
    *first = state->next - 1;
    state->next = state->argc;
    return 0;
}

static const struct argp study_argp = {
    .parser = parse_study,
    .args_doc = "STUDY SCENE.yaml [ARGUMENT...]",
    .doc = "Find out how accurate or how stable a scene's answers are, by running it many times.\v ",
    .help_filter = help_text,
};

status command_study(int argc, char **argv, failure *why)
{
    int first = 0;
    error_t error = argp_parse(&study_argp, argc, argv, ARGP_IN_ORDER, NULL, &first);
    if (error)
        return fail(why, STATUS_ERROR, "%s", strerror(error));
    if (first == 0)
        return fail(why, STATUS_BAD_INPUT, "which study? `clast study accuracy SCENE.yaml` or `clast study stability SCENE.yaml`");
    for (int k = 0; k < STUDIES; k++)
        if (strcmp(argv[first], studies[k].name) == 0) {
            char name[64];
            snprintf(name, sizeof name, "clast study %s", studies[k].name);
            argv[first] = name;
            return studies[k].run(argc - first, argv + first, why);
        }
    return fail(why, STATUS_BAD_INPUT, "there is no study `%.100s`; there are accuracy and stability", argv[first]);
}
