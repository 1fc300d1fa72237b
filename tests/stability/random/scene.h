/* A random small scene as lines that can be left out one by one. */
#ifndef CLAST_TESTS_RANDOM_SCENE_H
#define CLAST_TESTS_RANDOM_SCENE_H
#include <stdbool.h>
#include <stdint.h>

#define LINES_MAX 80

typedef struct lines {
    int count;
    char *line[LINES_MAX];
} lines;

/* The scene of these laws and shapes (`structure`: what decides the program) and of these stages, motions and numbers (`numbers`). */
void random_scene(uint64_t structure, uint64_t numbers, lines *t);
/* The text without the lines that are left out (NULL: all); caller frees. */
char *lines_join(const lines *t, const bool *left_out);
void lines_free(lines *t);

#endif
