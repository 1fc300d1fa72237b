/* How functions report what went wrong: a status that is passed up, and one message for the person at the terminal. */
#ifndef CLAST_HOST_STATUS_H
#define CLAST_HOST_STATUS_H
#include <stdbool.h>
#include <stddef.h>

/* The values are the exit codes of the command. */
typedef enum status {
    STATUS_OK = 0,
    STATUS_ERROR = 1,
    STATUS_BAD_INPUT = 2,
    STATUS_DEVICE = 3,
    STATUS_GUARD = 4,
    STATUS_INTERRUPTED = 130
} status;

/* Filled by the function that fails; every caller passes it up with TRY. A message says where, what value, what is allowed, what to do. */
typedef struct failure {
    char text[4096];
} failure;

/* Writes the message and returns `code`, so that a function can `return fail(...)`. */
status fail(failure *why, status code, const char *format, ...) __attribute__((format(printf, 3, 4)));

#define TRY(call)                              \
    do {                                       \
        status try_status_ = (call);           \
        if (try_status_ != STATUS_OK)          \
            return try_status_;                \
    } while (0)

/* Like TRY, for a function that must release what it holds: goes to `label` with the status in `result`. */
#define TRY_GOTO(result, label, call)          \
    do {                                       \
        (result) = (call);                     \
        if ((result) != STATUS_OK)             \
            goto label;                        \
    } while (0)

#endif
