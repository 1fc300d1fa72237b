/* What every user of libhdf5 here needs: silence, reasons, opening, text. */
#ifndef CLAST_HOST_HDF5_COMMON_H
#define CLAST_HOST_HDF5_COMMON_H
#include "status.h"

#include <hdf5.h>

/* libhdf5 prints its error stack by default; the reason goes into our one message instead. */
void hdf5_quiet(void);
/* Why the last call failed, innermost reason of the error stack. */
void hdf5_reason(char *text, size_t size);
/* True when an open file begins like an HDF5 file. */
bool hdf5_signature(int descriptor);
/* Read-only opening with the plain driver. A missing, truncated or foreign file is STATUS_BAD_INPUT; `kind` says what it should be. */
status hdf5_open_read(const char *path, const char *kind, hid_t *file, failure *why);
/* A scalar text attribute and a scalar text dataset (replaced if present). False on failure. */
bool hdf5_text_attribute(hid_t object, const char *name, const char *text);
bool hdf5_text_dataset(hid_t parent, const char *name, const char *text);

#endif
