/* Random small scenes, put together from the descriptors of the laws: each keeps the invariants or is refused with a message.
 *
 *     fuzz_scenes [--seed S] [--structures N] [--sets M] [--seconds T] [--out DIR]     N choices of laws, shapes and precision, M sets of stages and numbers each
 *     fuzz_scenes SCENE.yaml...                                                         scenes from files, one by one
 *
 * A scene that fails is made smaller, line by line, as long as it fails in the same way, and is left in DIR (default: here) as fuzz-S.yaml.
 * fuzz-running.yaml is the scene under way, in case the program itself ends. Programs are compiled once for each structure. */
#include "random/run.h"
#include "random/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define LAWS_MOST       128
#define REFUSALS_ENOUGH 10

static device the_device;

/* ---- what has been covered ---- */

typedef struct coverage {
    const law *law[LAWS_MOST];
    int scenes[LAWS_MOST], count;
    bool together[LAWS_MOST][LAWS_MOST];
} coverage;

static int place_of(coverage *c, const law *one)
{
    int k = 0;
    while (k < c->count && c->law[k] != one)
        k++;
    if (k == LAWS_MOST)
        abort();
    if (k == c->count)
        c->law[c->count++] = one;
    return k;
}

static void cover(coverage *c, const outcome *o)
{
    for (int a = 0; a < SLOT_COUNT; a++) {
        if (!o->law[a])
            continue;
        int p = place_of(c, o->law[a]);
        c->scenes[p]++;
        for (int b = 0; b < a; b++)
            if (o->law[b])
                c->together[p][place_of(c, o->law[b])] = c->together[place_of(c, o->law[b])][p] = true;
    }
}

static void say_coverage(const coverage *c)
{
    int pairs = 0;
    for (int a = 0; a < c->count; a++)
        for (int b = 0; b < a; b++)
            pairs += c->together[a][b];
    printf("%d laws, %d pairs of laws; scenes with each:", c->count, pairs);
    for (int k = 0; k < c->count; k++)
        printf("%s %s.%s %d", k ? "," : "", slot_name(c->law[k]->slot), c->law[k]->name, c->scenes[k]);
    printf("\n");
}

/* ---- making a failure smaller ---- */

#define SHRINK_SECONDS 120.0 /* each try may have a program to compile */

static void shrink(const lines *t, const char *what, bool *left)
{
    bool smaller = true;
    time_t begun = time(NULL);
    memset(left, 0, sizeof(bool) * LINES_MAX);
    while (smaller) {
        smaller = false;
        for (int k = t->count - 1; k >= 0 && difftime(time(NULL), begun) < SHRINK_SECONDS; k--) {
            if (left[k])
                continue;
            left[k] = true;
            char *text = lines_join(t, left);
            outcome o = run_text(&the_device, text, "smaller.yaml");
            free(text);
            if (o.verdict == BROKEN && strcmp(o.what, what) == 0)
                smaller = true;
            else
                left[k] = false;
        }
    }
}

static void write_scene(const char *folder, const char *name, const char *comment, const char *text)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    if (!file)
        return;
    for (const char *c = comment; *c; c++)
        fprintf(file, "%s%c", c == comment ? "# " : "", *c == '\n' ? ' ' : *c);
    fprintf(file, "%s%s", *comment ? "\n" : "", text);
    fclose(file);
}

static bool one_scene(uint64_t structure, uint64_t numbers, const char *folder, int counts[4], coverage *covered)
{
    lines t = {0};
    bool left[LINES_MAX];
    random_scene(structure, numbers, &t);
    char *text = lines_join(&t, NULL);
    write_scene(folder, "fuzz-running.yaml", "", text);
    outcome o = run_text(&the_device, text, "fuzz.yaml");
    counts[o.verdict]++;
    if (o.verdict == KEPT)
        cover(covered, &o);
    if (getenv("CLAST_FUZZ_SAYS") && o.verdict != KEPT)
        printf("%llu/%llu: %s\n", (unsigned long long)structure, (unsigned long long)numbers, o.text);
    if (o.verdict == BROKEN) {
        char name[64], *small;
        printf("structure %llu, numbers %llu, %s: %s\n", (unsigned long long)structure, (unsigned long long)numbers, o.what, o.text);
        fflush(stdout);
        shrink(&t, o.what, left);
        small = lines_join(&t, left);
        snprintf(name, sizeof name, "fuzz-%llu-%llu.yaml", (unsigned long long)structure, (unsigned long long)numbers);
        write_scene(folder, name, o.text, small);
        printf("  made smaller: %s/%s\n", folder, name);
        free(small);
    }
    free(text);
    lines_free(&t);
    return o.verdict != BROKEN;
}

static int run_file(const char *path)
{
    FILE *file = fopen(path, "r");
    char text[65536];
    if (!file) {
        fprintf(stderr, "%s: cannot be read\n", path);
        return 2;
    }
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    outcome o = run_text(&the_device, text, path);
    printf("%s: %s %s\n", path, o.verdict == BROKEN ? o.what : o.verdict == KEPT ? "keeps the invariants" : "refused or stopped:", o.text);
    return o.verdict == BROKEN;
}

int main(int argc, char **argv)
{
    failure why;
    uint64_t seed = 1, structures = 3, sets = 12;
    double seconds = INFINITY;
    const char *folder = ".";
    int counts[4] = {0}, failed = 0, files = 0;
    static coverage covered;
    setvbuf(stdout, NULL, _IOLBF, 0);
    if (device_open(NULL, true, &the_device, &why) != STATUS_OK) {
        fprintf(stderr, "%s\n", why.text);
        return 3;
    }
    for (int k = 1; k < argc; k++) {
        const char *value = k + 1 < argc ? argv[k + 1] : "";
        if (strcmp(argv[k], "--seed") == 0)
            seed = strtoull(value, NULL, 10), k++;
        else if (strcmp(argv[k], "--structures") == 0)
            structures = strtoull(value, NULL, 10), k++;
        else if (strcmp(argv[k], "--sets") == 0)
            sets = strtoull(value, NULL, 10), k++;
        else if (strcmp(argv[k], "--seconds") == 0)
            seconds = strtod(value, NULL), k++;
        else if (strcmp(argv[k], "--out") == 0)
            folder = value, k++;
        else
            failed += run_file(argv[k]) != 0, files++;
    }
    if (files > 0)
        return failed > 0;
    time_t start = time(NULL);
    for (uint64_t s = seed; s < seed + structures && difftime(time(NULL), start) < seconds; s++) {
        int refused_before = counts[REFUSED];
        for (uint64_t n = 1; n <= sets && difftime(time(NULL), start) < seconds; n++) {
            failed += !one_scene(s, n, folder, counts, &covered);
            if (n == REFUSALS_ENOUGH && counts[REFUSED] - refused_before == REFUSALS_ENOUGH)
                break; /* laws that do not go together */
        }
    }
    printf("%d scenes kept the invariants, %d were refused, %d were stopped by a guard, %d broke an invariant\n", counts[KEPT],
           counts[REFUSED], counts[STOPPED], counts[BROKEN]);
    say_coverage(&covered);
    char running[4096];
    snprintf(running, sizeof running, "%s/fuzz-running.yaml", folder);
    remove(running);
    return failed > 0;
}
