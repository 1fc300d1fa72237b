#include "precision.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

typedef struct float_pair {
    float high, low;
} float_pair;

void precision_split(void *numbers, int64_t count)
{
    char *at = numbers;
    for (int64_t n = 0; n < count; n++, at += sizeof(double)) {
        double value;
        memcpy(&value, at, sizeof value);
        float_pair pair = {(float)value, 0.0f};
        if (isfinite(pair.high))
            pair.low = (float)(value - (double)pair.high);
        memcpy(at, &pair, sizeof pair);
    }
}

void precision_join(void *numbers, int64_t count)
{
    char *at = numbers;
    for (int64_t n = 0; n < count; n++, at += sizeof(double)) {
        float_pair pair;
        memcpy(&pair, at, sizeof pair);
        double value = (double)pair.high + (double)pair.low;
        memcpy(at, &value, sizeof value);
    }
}

/* The numbers of a struct stand first. */
#define NUMBERS(type, first_other) ((int64_t)(offsetof(type, first_other) / sizeof(double)))

void precision_split_launch(clast_launch *launch)
{
    precision_split(launch, NUMBERS(clast_launch, record_stride));
}

static void move(double *position, const double *origin)
{
    for (int c = 0; c < 3; c++)
        position[c] -= origin[c];
}

void precision_split_faces(clast_face *face, int64_t count, const double *origin)
{
    for (int64_t f = 0; f < count; f++) {
        move(face[f].origin, origin);
        move(face[f].pivot, origin);
        precision_split(face + f, NUMBERS(clast_face, shape));
    }
}

void precision_split_movers(clast_mover *mover, int64_t count, const double *origin)
{
    for (int64_t m = 0; m < count; m++) {
        move(mover[m].pivot, origin);
        move(mover[m].pivot_end, origin);
        precision_split(mover + m, sizeof *mover / sizeof(double));
    }
}

/* Places along the axis are positions. */
void precision_split_profiles(clast_profile *profile, int count, const double *origin)
{
    for (int p = 0; p < count; p++) {
        for (int k = 0; k < CLAST_PROFILE_MAX; k++)
            profile[p].at[k] -= origin[profile[p].axis];
        precision_split(profile + p, NUMBERS(clast_profile, axis));
    }
}

void precision_split_beams(clast_beam *beam, int64_t count, const double *origin)
{
    for (int64_t b = 0; b < count; b++) {
        move(beam[b].position, origin);
        precision_split(beam + b, NUMBERS(clast_beam, law));
    }
}

void precision_split_columns(clast_columns *columns, int64_t count, const double *origin)
{
    for (int64_t c = 0; c < count; c++) {
        move(columns[c].origin, origin);
        precision_split(columns + c, NUMBERS(clast_columns, first_u));
    }
}

void precision_split_grid(clast_grid *grid, const double *origin)
{
    move(grid->origin, origin);
    precision_split(grid, NUMBERS(clast_grid, level));
    for (int l = 0; l < CLAST_LEVELS_MAX; l++)
        precision_split(grid->level[l].inverse_size, 3);
}
