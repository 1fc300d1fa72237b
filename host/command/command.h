/* The subcommands of `clast`. Each parses its own arguments with argp, which exits on --help and on bad usage. */
#ifndef CLAST_COMMAND_H
#define CLAST_COMMAND_H
#include "status.h"

#include <argp.h>
#include <stdint.h>

typedef struct command {
    const char *name;
    const char *doc; /* one line for `clast --help` */
    /* argv[0] is the name in messages, "clast run". */
    status (*run)(int argc, char **argv, failure *why);
} command;

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

/* Options that several commands have, as argp children; their input is the struct of the same name. */
typedef struct device_options {
    const char *device;
    const char *kernels;
} device_options;
extern const struct argp device_options_argp;

typedef struct set_options {
    int count;
    char **value;
} set_options;
extern const struct argp set_options_argp;
void set_options_free(set_options *options);

/* Ends the program with STATUS_BAD_INPUT and one line. */
void option_refuse(const struct argp_state *state, const char *format, ...) __attribute__((format(printf, 2, 3), noreturn));
/* A whole number within the range, which may be written like 1e6. */
int64_t option_count(const struct argp_state *state, const char *name, const char *text, int64_t low, int64_t high);
/* Takes the only positional argument of a command. */
void option_only(const struct argp_state *state, const char **store, const char *argument);

#endif
