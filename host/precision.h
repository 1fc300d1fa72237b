/* Numbers of the host in the form of mixed precision: two floats in the place of a double (kernels/precision/mixed.cl). */
#ifndef CLAST_HOST_PRECISION_H
#define CLAST_HOST_PRECISION_H
#include <clast/shared.h>

/* In place. Of a double of 53 bits two floats keep at least 48. */
void precision_split(void *numbers, int64_t count);
/* And back, without error. */
void precision_join(void *numbers, int64_t count);
/* Structs that kernels read: their numbers in place, positions from `origin`. */
void precision_split_launch(clast_launch *launch);
void precision_split_faces(clast_face *face, int64_t count, const double *origin);
void precision_split_movers(clast_mover *mover, int64_t count, const double *origin);
void precision_split_profiles(clast_profile *profile, int count, const double *origin);
void precision_split_beams(clast_beam *beam, int64_t count, const double *origin);
void precision_split_columns(clast_columns *columns, int64_t count, const double *origin);
void precision_split_grid(clast_grid *grid, const double *origin);

#endif
