/* clast reference */
#include "../scene.h"
#include "command.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct argp reference_argp = {.doc = "Print the reference of all scene keys and laws, as Markdown."};

status command_reference(int argc, char **argv, failure *why)
{
    TRY(command_parse(&reference_argp, 0, argc, argv, NULL, why));
    char *text = scene_reference();
    fputs(text, stdout);
    free(text);
    return STATUS_OK;
}
