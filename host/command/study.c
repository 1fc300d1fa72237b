/* clast study: which study is asked for; each parses its own arguments (study_accuracy.c, study_stability.c). */
#include "command.h"

static const command studies[] = {
    {"accuracy", "what the answers of a scene cost in time, and how far off they are", command_study_accuracy},
    {"stability", "the largest stable step of a scene against the step that is taken", command_study_stability},
};

status command_study(int argc, char **argv, failure *why)
{
    static const command_group group = {
        .name = "clast study",
        .kind = "study",
        .title = "Studies",
        .usage = "STUDY SCENE.yaml [ARGUMENT...]",
        .doc = "Find out how accurate or how stable a scene's answers are, by running it many times.",
        .after = "`clast study STUDY --help` explains one.",
        .count = sizeof studies / sizeof *studies,
        .commands = studies,
    };
    return command_group_run(&group, argc, argv, why);
}
