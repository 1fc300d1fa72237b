/* clast study: its place is kept, so that the message says more than that the command is unknown. */
#include "command.h"

#include <string.h>

enum { KEY_TOLERANCE = 256 };

static error_t parse_study(int key, char *argument, struct argp_state *state)
{
    (void)argument;
    (void)state;
    return key == 'o' || key == KEY_TOLERANCE || key == ARGP_KEY_ARG ? 0 : ARGP_ERR_UNKNOWN;
}

static const struct argp_option study_option[] = {
    {"tolerance", KEY_TOLERANCE, "X", 0, "Largest change of the answers that is allowed", 0},
    {"out", 'o', "DIR", 0, "Folder for the results", 0},
    {0},
};
static const struct argp study_argp = {
    .options = study_option,
    .parser = parse_study,
    .args_doc = "accuracy|stability SCENE.yaml",
    .doc = "Find out how accurate or stable a scene's answers are. This version does not have it yet.",
};

status command_study(int argc, char **argv, failure *why)
{
    error_t error = argp_parse(&study_argp, argc, argv, 0, NULL, NULL);
    if (error)
        return fail(why, STATUS_ERROR, "%s", strerror(error));
    return fail(why, STATUS_BAD_INPUT, "`clast study` is not in this version");
}
