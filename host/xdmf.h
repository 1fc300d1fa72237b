/* The XDMF file beside the results: tells ParaView and VisIt how to read the HDF5 file. */
#ifndef CLAST_HOST_XDMF_H
#define CLAST_HOST_XDMF_H
#include "results.h"

/* `path` with its ending replaced by .xdmf; caller frees. */
char *xdmf_path(const char *results_path);
/* Writes to a temporary name in the same folder and renames, so that a reader never sees half a file. */
status xdmf_write(const char *path, const char *results_path, int64_t count, int field_count, const results_field *field, int64_t frames,
                  const double *time, failure *why);

#endif
