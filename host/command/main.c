/* The `clast` program: finds the subcommand, runs it, and reports what went wrong. */
#include "command.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>

static const command commands[] = {
    {"run", "run a scene and write its results", command_run},
    {"resume", "go on with a run from its checkpoint", command_resume},
    {"check", "check a scene and show what it will do and cost", command_check},
    {"devices", "list the devices that can compute", command_devices},
    {"bench", "measure speed and memory", command_bench},
    {"study", "find out how accurate or stable a scene is", command_study},
    {"reference", "print the reference of all scene keys", command_reference},
};

static const command_group group = {
    .name = "clast",
    .kind = "command",
    .title = "Commands",
    .usage = "COMMAND [ARGUMENT...]",
    .doc = "Particle simulation on OpenCL devices.",
    .after = "`clast COMMAND --help` explains one.\n\nExit status: 0 done; 2 bad input; 3 device trouble; 4 stopped by a guard; 130 "
             "interrupted; 1 anything"
             " else.",
    .count = sizeof commands / sizeof *commands,
    .commands = commands,
};

static status dispatch(int argc, char **argv, failure *why)
{
    argv[0] = (char[]){"clast"};
    status result = command_group_run(&group, argc, argv, why);
    if (result == STATUS_OK && (fflush(stdout) != 0 || ferror(stdout)))
        return fail(why, STATUS_ERROR, "standard output cannot be written: %s", strerror(errno));
    return result;
}

/* True for "scene.yaml:12:5: ...": such a message already says where it comes from. */
static bool begins_with_place(const char *message)
{
    const char *colon = strstr(message, ": ");
    if (!colon)
        return false;
    const char *digits = colon;
    while (digits > message && isdigit((unsigned char)digits[-1]))
        digits--;
    return digits < colon && digits > message && digits[-1] == ':';
}

int main(int argc, char **argv)
{
    failure why = {.text = ""};
    argp_err_exit_status = STATUS_BAD_INPUT;
    argp_program_version = "clast " CLAST_VERSION; /* gives every command --version */
    status result = dispatch(argc, argv, &why);
    if (result != STATUS_OK && why.text[0])
        fprintf(stderr, "%s%s\n", begins_with_place(why.text) ? "" : "clast: ", why.text);
    return result;
}
