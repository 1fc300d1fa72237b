/* Answers of a scene: numbers that a study compares, by the names that the scene gives them. */
#ifndef CLAST_HOST_ANSWER_H
#define CLAST_HOST_ANSWER_H
#include "parameter.h"

typedef struct answer {
    const char *text; /* as the scene names it */
    char source[128]; /* observable ("walls/floor/force"), or field of the grains */
    int group;        /* particle group; -1: an observable */
    int64_t item;     /* grain of the group; -1: all of it */
    int components;   /* of the source */
    int component;    /* -1: all */
} answer;

/* Samples of an answer: value[sample][width]. */
typedef struct answer_series {
    int samples, width;
    double *time, *value;
} answer_series;

/* What a name means in the scene; `why` says what is wrong with it. */
status answer_find(const scene *scene, const char *text, answer *out, failure *why);
/* Numbers a sample; `first` is the first grain of every group, with one entry more. */
int answer_width(const answer *a, const int64_t *first);
/* Reads it from a results file. */
status answer_read(const char *path, const answer *a, const int64_t *first, answer_series *out, failure *why);
/* Drops samples that another follows within so many seconds: the end of a stage that is not quite the time of a frame. */
void answer_merge(answer_series *series, double within_s);
void answer_free(answer_series *series);

/* Answers and closed forms of a scene's `study`. A run does not need them, and a --set may take away what they name. */
status answer_check_study(const scene *scene, failure *why);
/* The same of a scene as it stands in its file, under the settings that its `study` lays over it. */
status answer_check_scene(const scene *scene, failure *why);

#endif
