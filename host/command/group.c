/* Commands below a name: which one is meant, their list in --help, and the first parsing of arguments. */
#include "command.h"
#include "parameter.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define COMMANDS_MAX 16

typedef struct choice {
    const command_group *group;
    int first; /* argument that names the command; 0: none does */
} choice;

char *command_list(const char *title, int count, const char *const *names, const char *const *docs, const char *after)
{
    char *list = NULL;
    size_t size;
    FILE *stream = open_memstream(&list, &size);
    if (!stream)
        return NULL;
    fprintf(stream, "%s:\n", title);
    for (int k = 0; k < count; k++)
        fprintf(stream, "  %-10s %s\n", names[k], docs[k]);
    fprintf(stream, "\n%s", after);
    fclose(stream);
    return list;
}

static int names_of(const command_group *group, const char **name, const char **doc)
{
    int count = group->count < COMMANDS_MAX ? group->count : COMMANDS_MAX;
    for (int k = 0; k < count; k++) {
        name[k] = group->commands[k].name;
        doc[k] = group->commands[k].doc;
    }
    return count;
}

static char *help_text(int key, const char *text, void *input)
{
    const choice *chosen = input;
    const char *name[COMMANDS_MAX], *doc[COMMANDS_MAX];
    if (key != ARGP_KEY_HELP_POST_DOC || !chosen)
        return (char *)text;
    int count = names_of(chosen->group, name, doc);
    return command_list(chosen->group->title, count, name, doc, chosen->group->after);
}

/* Stops at the first argument that is no option: what follows belongs to the command. */
static error_t parse_first(int key, char *argument, struct argp_state *state)
{
    (void)argument;
    choice *chosen = state->input;
    if (key != ARGP_KEY_ARG)
        return ARGP_ERR_UNKNOWN;
    chosen->first = state->next - 1;
    state->next = state->argc;
    return 0;
}

static status refuse(const command_group *group, const char *asked, failure *why)
{
    const char *name[COMMANDS_MAX], *doc[COMMANDS_MAX];
    int count = names_of(group, name, doc);
    const char *nearest = word_nearest(asked, name, count);
    if (nearest)
        return fail(why, STATUS_BAD_INPUT, "there is no %s `%.100s`; did you mean `%s`?", group->kind, asked, nearest);
    return fail(why, STATUS_BAD_INPUT, "there is no %s `%.100s`; `%s --help` lists them", group->kind, asked, group->name);
}

status command_parse(const struct argp *argp, unsigned flags, int argc, char **argv, void *input, failure *why)
{
    error_t error = argp_parse(argp, argc, argv, flags, NULL, input);
    return error ? fail(why, STATUS_ERROR, "%s", strerror(error)) : STATUS_OK;
}

status command_group_run(const command_group *group, int argc, char **argv, failure *why)
{
    choice chosen = {.group = group};
    char doc[512];
    snprintf(doc, sizeof doc, "%s\v ", group->doc); /* help_text takes the place of what is behind the \v */
    const struct argp argp = {.parser = parse_first, .args_doc = group->usage, .doc = doc, .help_filter = help_text};
    TRY(command_parse(&argp, ARGP_IN_ORDER, argc, argv, &chosen, why));
    if (chosen.first == 0)
        return fail(why, STATUS_BAD_INPUT, "no %s given; `%s --help` lists them", group->kind, group->name);
    for (int k = 0; k < group->count; k++)
        if (strcmp(group->commands[k].name, argv[chosen.first]) == 0) {
            char name[64];
            snprintf(name, sizeof name, "%s %s", group->name, group->commands[k].name);
            argv[chosen.first] = name;
            return group->commands[k].run(argc - chosen.first, argv + chosen.first, why);
        }
    return refuse(group, argv[chosen.first], why);
}
