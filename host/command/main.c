/* The `clast` program: finds the subcommand, runs it, and reports what went wrong. */
#include "command.h"
#include "parameter.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
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
enum { COMMANDS = sizeof commands / sizeof commands[0] };

static const command *find_command(const char *name)
{
    for (int k = 0; k < COMMANDS; k++)
        if (strcmp(commands[k].name, name) == 0)
            return &commands[k];
    return NULL;
}

static status refuse_command(const char *name, failure *why)
{
    const char *known[COMMANDS];
    for (int k = 0; k < COMMANDS; k++)
        known[k] = commands[k].name;
    const char *nearest = word_nearest(name, known, COMMANDS);
    if (nearest)
        return fail(why, STATUS_BAD_INPUT, "there is no command `%.100s`; did you mean `%s`?", name, nearest);
    return fail(why, STATUS_BAD_INPUT, "there is no command `%.100s`; `clast --help` lists them", name);
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
    fprintf(stream, "Commands:\n");
    for (int k = 0; k < COMMANDS; k++)
        fprintf(stream, "  %-10s %s\n", commands[k].name, commands[k].doc);
    fprintf(stream, "\n`clast COMMAND --help` explains one.\n\nExit status: 0 done; 2 bad input; 3 device trouble; 4 stopped by a guard;"
                    " 130 interrupted; 1 anything else.");
    fclose(stream);
    return list;
}

/* Stops at the first argument that is no option: what follows belongs to the command. */
static error_t parse_main(int key, char *argument, struct argp_state *state)
{
    (void)argument;
    int *first = state->input;
    if (key != ARGP_KEY_ARG)
        return ARGP_ERR_UNKNOWN;
    *first = state->next - 1;
    state->next = state->argc;
    return 0;
}

static const struct argp main_argp = {
    .parser = parse_main,
    .args_doc = "COMMAND [ARGUMENT...]",
    .doc = "Particle simulation on OpenCL devices.\v ",
    .help_filter = help_text,
};

static status dispatch(int argc, char **argv, failure *why)
{
    int first = 0;
    argv[0] = (char[]){"clast"};
    error_t error = argp_parse(&main_argp, argc, argv, ARGP_IN_ORDER, NULL, &first);
    if (error)
        return fail(why, STATUS_ERROR, "%s", strerror(error));
    if (first == 0)
        return fail(why, STATUS_BAD_INPUT, "no command given; `clast --help` lists them");
    const command *found = find_command(argv[first]);
    if (!found)
        return refuse_command(argv[first], why);
    char name[64];
    snprintf(name, sizeof name, "clast %s", found->name);
    argv[first] = name;
    status result = found->run(argc - first, argv + first, why);
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
