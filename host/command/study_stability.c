/* clast study stability */
#include "command.h"

status command_study_stability(int argc, char **argv, failure *why)
{
    (void)argc;
    (void)argv;
    return fail(why, STATUS_BAD_INPUT, "`clast study stability` is not in this version");
}
