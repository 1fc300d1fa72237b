/* Pieces of work that run in processes of their own, several at a time: runs of a sweep, runs of a study. */
#ifndef CLAST_HOST_CREW_H
#define CLAST_HOST_CREW_H
#include "status.h"

#include <stdint.h>

typedef struct crew {
    int count, jobs; /* members, and how many run at a time */
    void *context;
    /* File that takes a member's standard error. */
    const char *(*log)(void *context, int member);
    /* In the member's process, whose exit code is what it returns; the message goes to the log. No device may have been opened before. */
    status (*work)(void *context, int member, failure *why);
    /* In the first process, once the member has ended. */
    void (*ended)(void *context, int member, status result, double wall_s);
} crew;

/* Before the first crew_run: an interrupt stops the members, which may write checkpoints, and is remembered. */
void crew_catch_signals(void);
bool crew_interrupted(void);
/* Fails only where a process cannot be started or waited for; after an interrupt no more members are started. */
status crew_run(const crew *c, failure *why);
/* As many jobs as there are cores where beds are small, else one; `asked` where it is not 0; never more than members. */
int crew_jobs(int asked, int64_t grains, int members);
/* The last line of a log that is not empty. */
void crew_last_line(const char *path, char *text, size_t size);
/* Zeroed memory that members and the first process share until they end; NULL where there is none. */
void *crew_shared(size_t size);
/* Makes the folder, or takes it where it is there. */
status crew_folder(const char *path, failure *why);

#endif
