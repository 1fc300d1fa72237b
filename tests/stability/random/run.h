/* Runs a random scene and looks at what must hold. */
#ifndef CLAST_TESTS_RANDOM_RUN_H
#define CLAST_TESTS_RANDOM_RUN_H
#include "device.h"
#include "law.h"

typedef enum verdict { KEPT, REFUSED, STOPPED, BROKEN } verdict;

typedef struct outcome {
    verdict verdict;
    char what[64]; /* the invariant */
    char text[1024];
    const law *law[SLOT_COUNT]; /* that it ran with; NULL: none */
} outcome;

/* `text`: what a scene file holds. */
outcome run_text(device *on, const char *text, const char *name);

#endif
