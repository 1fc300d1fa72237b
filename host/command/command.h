/* The subcommands of `clast`. Each parses its own arguments with argp, which exits on --help and on bad usage. */
#ifndef CLAST_COMMAND_H
#define CLAST_COMMAND_H
#include "../run.h"
#include "status.h"

#include <argp.h>
#include <stdint.h>

typedef struct command {
    const char *name;
    const char *doc; /* one line for `clast --help` */
    /* argv[0] is the name in messages, "clast run". */
    status (*run)(int argc, char **argv, failure *why);
} command;

/* Commands below a name: `clast`, `clast study`. */
typedef struct command_group {
    const char *name;    /* as in messages */
    const char *kind;    /* what one of them is called: "command" */
    const char *title;   /* above their list in --help */
    const char *usage, *doc;
    const char *after;   /* below the list */
    int count;
    const command *commands;
} command_group;

/* Finds the command that the arguments name and runs it. */
status command_group_run(const command_group *group, int argc, char **argv, failure *why);
/* Parses; what argp itself fails at is told. Bad usage has ended the program. */
status command_parse(const struct argp *argp, unsigned flags, int argc, char **argv, void *input, failure *why);
/* Text of a list for --help; caller frees. */
char *command_list(const char *title, int count, const char *const *names, const char *const *docs, const char *after);

status command_run(int argc, char **argv, failure *why);
status command_resume(int argc, char **argv, failure *why);
status command_check(int argc, char **argv, failure *why);
status command_devices(int argc, char **argv, failure *why);
status command_bench(int argc, char **argv, failure *why);
status command_study(int argc, char **argv, failure *why);
/* Studies, found by command_study. */
status command_study_accuracy(int argc, char **argv, failure *why);
status command_study_stability(int argc, char **argv, failure *why);
status command_reference(int argc, char **argv, failure *why);

/* Options that several commands have. The first is an argp child, whose input is the struct of the same name. */
typedef struct device_options {
    const char *device;
    const char *kernels;
} device_options;
extern const struct argp device_options_argp;

typedef struct set_options {
    int count;
    char **value;
} set_options;
void set_options_free(set_options *options);

/* What commands on a scene are given, as an argp child: the scene, --device, --kernels and --set. `run` has them once parsing is over. */
typedef struct scene_input {
    run_options run;
    device_options device;
    set_options set;
} scene_input;
extern const struct argp scene_input_argp;
void scene_input_free(scene_input *input);

/* Ends the program with STATUS_BAD_INPUT and one line. */
void option_refuse(const struct argp_state *state, const char *format, ...) __attribute__((format(printf, 2, 3), noreturn));
/* A number from low to high, both included; where high is INFINITY, one above 0. */
double option_number(const struct argp_state *state, const char *name, const char *text, double low, double high);
/* One of the words that `precision` takes. */
const char *option_precision(const struct argp_state *state, const char *text);
/* Adds PATH=... to a list. `form`: what stands behind the =. */
error_t option_add(const struct argp_state *state, const char *name, const char *form, set_options *options, char *argument);
/* A whole number within the range, which may be written like 1e6. */
int64_t option_count(const struct argp_state *state, const char *name, const char *text, int64_t low, int64_t high);
/* Takes the only positional argument of a command. */
void option_only(const struct argp_state *state, const char **store, const char *argument);

#endif
