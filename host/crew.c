#include "crew.h"

#include "clock.h"
#include "run.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* Grains up to which a run is small: it gains little from a second core. */
#define SMALL_BED 20000

/* Set by the signal handler alone. */
static volatile sig_atomic_t interrupted;

static void note_signal(int signal_number)
{
    (void)signal_number;
    interrupted = 1;
}

void crew_catch_signals(void)
{
    struct sigaction action = {.sa_handler = note_signal};
    interrupted = 0;
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

bool crew_interrupted(void)
{
    return interrupted != 0;
}

typedef struct member {
    pid_t child; /* 0: not started, or done */
    double begun;
} member;

static void work(const crew *c, int index)
{
    failure why = {{0}};
    char threads[32];
    int log = open(c->log(c->context, index), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (log >= 0)
        dup2(log, STDERR_FILENO);
    if (c->jobs > 1) { /* members side by side share the cores of a CPU device out */
        long cores = sysconf(_SC_NPROCESSORS_ONLN) / c->jobs;
        snprintf(threads, sizeof threads, "%ld", cores > 1 ? cores : 1);
        setenv("POCL_MAX_PTHREAD_COUNT", threads, 0);
    }
    run_catch_signals();
    status result = c->work(c->context, index, &why);
    if (result != STATUS_OK)
        fprintf(stderr, "%s\n", why.text);
    fflush(NULL);
    _exit((int)result);
}

static status start(const crew *c, member *m, int index, failure *why)
{
    fflush(NULL);
    m->begun = clock_seconds();
    m->child = fork();
    if (m->child < 0) {
        m->child = 0;
        return fail(why, STATUS_ERROR, "a run cannot be started: %s", strerror(errno));
    }
    if (m->child == 0)
        work(c, index);
    return STATUS_OK;
}

static void stop_all(const crew *c, const member *m)
{
    for (int k = 0; k < c->count; k++)
        if (m[k].child > 0)
            kill(m[k].child, SIGTERM);
}

static bool note_end(const crew *c, member *m, pid_t child, int wait_status)
{
    for (int k = 0; k < c->count; k++)
        if (m[k].child == child) {
            m[k].child = 0;
            c->ended(c->context, k, WIFEXITED(wait_status) ? (status)WEXITSTATUS(wait_status) : STATUS_ERROR, clock_seconds() - m[k].begun);
            return true;
        }
    return false;
}

static status run_all(const crew *c, member *m, failure *why)
{
    int next = 0, running = 0;
    bool stopped = false;
    while (running > 0 || (next < c->count && !interrupted)) {
        for (; running < c->jobs && next < c->count && !interrupted; running++, next++)
            TRY(start(c, &m[next], next, why));
        int wait_status;
        pid_t child = waitpid(-1, &wait_status, 0);
        if (interrupted && !stopped) {
            stop_all(c, m);
            stopped = true;
        }
        if (child > 0 && note_end(c, m, child, wait_status))
            running--;
        if (child < 0 && errno != EINTR)
            return fail(why, STATUS_ERROR, "waiting for the runs: %s", strerror(errno));
    }
    return STATUS_OK;
}

status crew_run(const crew *c, failure *why)
{
    member *m = calloc((size_t)c->count + 1, sizeof *m);
    status result = m ? run_all(c, m, why) : fail(why, STATUS_ERROR, "out of memory");
    free(m);
    return result;
}

int crew_jobs(int asked, int64_t grains, int members)
{
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    int jobs = asked > 0 ? asked : grains <= SMALL_BED && cores > 1 ? (int)cores : 1;
    return jobs > members ? members : jobs;
}

void crew_last_line(const char *path, char *text, size_t size)
{
    FILE *file = fopen(path, "r");
    char line[2048];
    text[0] = '\0';
    while (file && fgets(line, sizeof line, file))
        if (line[0] != '\n')
            snprintf(text, size, "%s", line);
    if (file)
        fclose(file);
    text[strcspn(text, "\n")] = '\0';
}

void *crew_shared(size_t size)
{
    void *memory = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    return memory == MAP_FAILED ? NULL : memory;
}

status crew_folder(const char *path, failure *why)
{
    struct stat found;
    if (mkdir(path, 0777) == 0)
        return STATUS_OK;
    if (errno == EEXIST && stat(path, &found) == 0 && S_ISDIR(found.st_mode))
        return STATUS_OK;
    return fail(why, STATUS_BAD_INPUT, "%s: cannot be made a folder for the runs: %s", path, strerror(errno == EEXIST ? ENOTDIR : errno));
}
