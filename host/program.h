/* OpenCL programs: a short list of kernel files behind a block of constants, built for one device and kept between runs. */
#ifndef CLAST_HOST_PROGRAM_H
#define CLAST_HOST_PROGRAM_H
#include "device.h"
#include "status.h"

typedef struct kernel_file {
    const char *name; /* below kernels/; "shared.h" is the header that host and kernels share */
    const char *text;
} kernel_file;

/* Every kernel file, compiled in. Ends with a NULL name. */
extern const kernel_file kernels_embedded[];

/* The source of one program: `constants` ("#define ..." lines), then shared.h, base.cl and `files` in order. `directory` replaces the embedded
 * files while developing; or NULL. Caller frees. */
status program_assemble(const char *constants, const char *const *files, int file_count, const char *directory, char **text, failure *why);

/* Builds, or takes the program that this device has built from the same text before, or the binary of an earlier run from the cache (key: source,
 * options, device, driver). Caller releases the program. When the build fails the message holds the driver's log and where the source was written. */
status program_build(const device *device, const char *text, cl_program *out, failure *why);

/* The programs that a device has built last: stages, copies of a scene and studies ask for the same ones again and again, and even a driver that
 * keeps what it has compiled parses the source for each. NULL, where memory is out, keeps none. */
typedef struct program_shelf program_shelf;
program_shelf *program_shelf_open(void);
void program_shelf_close(program_shelf *shelf);

#endif
