/* clast study accuracy */
#include "command.h"

status command_study_accuracy(int argc, char **argv, failure *why)
{
    (void)argc;
    (void)argv;
    return fail(why, STATUS_BAD_INPUT, "`clast study accuracy` is not in this version");
}
