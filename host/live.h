/* Which law fills which slot in a scene stage, and what follows: the program's files and constants, the contact classes. */
#ifndef CLAST_HOST_LIVE_H
#define CLAST_HOST_LIVE_H
#include "bed.h"
#include "scene.h"

/* NULL: the slot's none twin. */
typedef struct live_laws {
    const law *law[SLOT_COUNT];
    const double *option[SLOT_COUNT];
    bool frozen; /* nothing moves: heat advances by methods of its own */
    bool servo; /* some wall keeps a force, in some stage */
    bool blocks; /* a work-item of the two stages takes a block instead of one record or grain: the form for CPUs */
    int lanes;   /* numbers in the device's widest register; 0: not known */
    int loop_items; /* work-items of the loop over steps; 0: one */
} live_laws;

/* The union over all stages, which decides what is allocated. */
void live_laws_of(const scene *scene, const bed *bed, live_laws *out);
/* The laws of one stage, from the union: what the stage switches off is gone. */
void live_laws_in_stage(const scene *scene, const live_laws *all, int stage, live_laws *out);
/* What only stages that go by blocks have: packets of grains in mixed precision (kernels/stage/rows_packed.cl), marks of those that touch
 * (kernels/effect/touched_marks.cl). */
void live_for_blocks(live_laws *all);
/* Files of the program that builds contact tables; it is the same for all laws, so that a new scene seldom waits for it. */
#define LIVE_TABLE_FILES 9
int live_table_files(const live_laws *live, const char **files);
void live_table_constants(const live_laws *live, char *text, size_t size);
/* Files of the program of the stages in order; returns their number (at most `max`). */
int live_files(const live_laws *live, const char **files, int max);
/* "#define" lines: options, places of the constants in a row, number of constants a class. */
void live_constants(const live_laws *live, const scene *scene, char *text, size_t size);
/* Constants a class. */
int live_constant_count(const live_laws *live);
/* Rows of contact classes: by material of the owner, then by the other's party (materials, then walls). */
int live_class_count(const live_laws *live, const scene *scene);
/* Fills rows x constants. */
void live_class_constants(const live_laws *live, const scene *scene, int stage, double *out);
/* Constants a material, and their rows: by material. */
int live_grain_constant_count(const live_laws *live);
void live_grain_constants(const live_laws *live, const scene *scene, int stage, double *out);
bool live_uses(const live_laws *live, const field *field);
/* True where velocities stand half a step behind the positions. */
bool live_keeps_half_steps(const live_laws *live);
/* True where heat changes the stiffness of contacts that move. */
bool live_changes_stiffness(const live_laws *live);

#endif
