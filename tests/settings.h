/* Settings for every scene of a test program, from CLAST_TEST_SET, with blanks between: `integrator=velocity_verlet precision=mixed`. */
#ifndef CLAST_TESTS_SETTINGS_H
#define CLAST_TESTS_SETTINGS_H
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SETTINGS_MAX 4

typedef struct settings {
    char text[256], *at[SETTINGS_MAX];
    int count;
} settings;

static inline void settings_read(settings *s)
{
    const char *set = getenv("CLAST_TEST_SET");
    char *rest = s->text, *word;
    s->count = 0;
    snprintf(s->text, sizeof s->text, "%s", set ? set : "");
    while ((word = strsep(&rest, " ")) && s->count < SETTINGS_MAX)
        if (*word)
            s->at[s->count++] = word;
}

/* True where they name `word`. */
static inline bool settings_name(const char *word)
{
    const char *set = getenv("CLAST_TEST_SET");
    return set && strstr(set, word);
}

/* True where scenes advance by velocity Verlet. */
static inline bool case_verlet(void)
{
    return settings_name("velocity_verlet");
}

/* True where they run in mixed precision. */
static inline bool case_mixed(void)
{
    return settings_name("mixed");
}

#endif
