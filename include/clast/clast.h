/* Clast's public C API: everything the command does, and a bed in memory that a program drives step by step.
 *
 *     clast_bed *bed;
 *     char message[CLAST_MESSAGE_SIZE];
 *     if (clast_bed_open("scene.yaml", NULL, 0, NULL, &bed, message) != CLAST_OK) { fputs(message, stderr); ... }
 *     clast_bed_advance(bed, 1000, message);
 *     double *x = malloc(sizeof *x * 3 * clast_bed_count(bed));
 *     clast_bed_field(bed, "position", x, message);
 *     clast_bed_close(bed);
 *
 * SI units throughout. Functions that can fail return a status and write one message of at most CLAST_MESSAGE_SIZE bytes. A bed belongs to one
 * thread at a time. */
#ifndef CLAST_CLAST_H
#define CLAST_CLAST_H
#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define CLAST_API __attribute__((visibility("default")))
#define CLAST_MESSAGE_SIZE 4096

/* The values are the exit codes of the command. */
typedef enum clast_status {
    CLAST_OK = 0,
    CLAST_ERROR = 1,
    CLAST_BAD_INPUT = 2,
    CLAST_DEVICE = 3,
    CLAST_GUARD = 4,
    CLAST_INTERRUPTED = 130
} clast_status;

/* "0.1.0" */
CLAST_API const char *clast_version(void);

/* ---- what the command does ---- */

typedef struct clast_run_options {
    const char *scene;      /* path of a scene; or NULL for resume */
    const char *checkpoint; /* path of a checkpoint, for resume */
    const char *out;        /* results file; NULL on resume goes on in the run's own */
    const char *device;     /* index, "cpu", "gpu" or part of a name; NULL chooses */
    const char *kernels;    /* directory of kernels instead of those compiled in; or NULL */
    char *const *sets;      /* "path=value", applied in order */
    int set_count;
    bool quiet;             /* nothing on standard error */
} clast_run_options;

CLAST_API clast_status clast_run(const clast_run_options *options, char *message);
CLAST_API clast_status clast_resume(const clast_run_options *options, char *message);
/* Writes the plan of a scene to standard output. */
CLAST_API clast_status clast_check(const char *scene, char *const *sets, int set_count, const char *device, bool json, bool probe, char *message);
/* The scene reference page as Markdown; the caller frees it. */
CLAST_API char *clast_scene_reference(void);

typedef struct clast_device {
    char name[256], driver[128];
    bool cpu, gpu, fp64;
    uint64_t memory_bytes, buffer_bytes;
    uint32_t compute_units;
} clast_device;

/* At most `max` devices; *count is how many there are. */
CLAST_API clast_status clast_devices(clast_device *list, int max, int *count, char *message);

/* ---- a bed in memory ---- */

typedef struct clast_bed clast_bed;

/* Reads a scene, generates its grains, and stands at the start of its first stage. */
CLAST_API clast_status clast_bed_open(const char *scene, char *const *sets, int set_count, const char *device, clast_bed **out, char *message);
CLAST_API void clast_bed_close(clast_bed *bed);
/* The stage's laws, gravity and motions from the present time on. */
CLAST_API clast_status clast_bed_begin_stage(clast_bed *bed, int stage, char *message);
/* Largest stable and recommended step for the bed as it is, s; infinite where nothing binds. */
CLAST_API clast_status clast_bed_limit(clast_bed *bed, double *limit_s, double *recommended_s, char *message);
/* The step from here on; the stage's own, or the recommended one, until then. */
CLAST_API void clast_bed_set_step(clast_bed *bed, double step_s);
CLAST_API clast_status clast_bed_advance(clast_bed *bed, int64_t steps, char *message);
CLAST_API double clast_bed_time(const clast_bed *bed);
CLAST_API int64_t clast_bed_step(const clast_bed *bed);
/* Grains of the scene: rows of every field, in permanent-id order; a grain that has left has NaN. */
CLAST_API int64_t clast_bed_count(const clast_bed *bed);
/* Components of a field of grains (position, velocity, spin, orientation, radius, mass, ...); 0 where the bed does not have it. */
CLAST_API int clast_bed_components(clast_bed *bed, const char *field);
/* Fills out[count][components]. */
CLAST_API clast_status clast_bed_field(clast_bed *bed, const char *field, double *out, char *message);

typedef struct clast_contact {
    int32_t i, j, wall;   /* permanent ids with i < j; j = -1 at a wall, wall = -1 between grains */
    double overlap, area; /* m, m2 */
    double force[3];      /* on i, N */
} clast_contact;

/* Live contacts in the order of ids; the caller frees *out. */
CLAST_API clast_status clast_bed_contacts(clast_bed *bed, clast_contact **out, int64_t *count, char *message);

#ifdef __cplusplus
}
#endif
#endif
