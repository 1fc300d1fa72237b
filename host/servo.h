/* Walls, and groups of walls, that move to keep a force (docs/theory.md, "Servo"). Between batches the host knows where they are; within one
 * the device moves them (kernels/stage/servo.cl). */
#ifndef CLAST_HOST_SERVO_H
#define CLAST_HOST_SERVO_H
#include "bundle.h"
#include "device.h"
#include "pose.h"
#include "scene.h"

/* One wall or group that has a servo in some stage. */
typedef struct drive {
    int wall, group;        /* one of them, the other -1 */
    const servo_spec *spec; /* now; NULL: it stands, but for its prescribed motion */
    double base[3];         /* way of the servos before this one */
    double area, bound;     /* m2; way after which a guard stops the run */
    int32_t reversals_seen, looks;
    clast_servo state;
} drive;

typedef struct drives {
    int count;
    drive *drive;
    int *of_wall; /* -1: none */
    cl_mem mem;
} drives;

struct simulation;
struct guard_finding;
status servo_create(struct simulation *sim, failure *why);
void servo_free(struct simulation *sim);
bool servo_live(const struct simulation *sim);
/* Takes up what a stage changes; `replay`: for a state that is in the stage already. */
void servo_change(struct simulation *sim, const scene_stage *stage, bool replay);
/* Forces to keep, inertia and bounds, once the stage's servos are known. */
status servo_enter(struct simulation *sim, failure *why);
/* Index into the servos for the device, -1 where none moves the wall now. */
int servo_of_wall(const struct simulation *sim, int wall);
/* Adds the way of the servos before, or all of it and the present velocity. */
void servo_shift(const struct simulation *sim, int wall, bool all, body_pose *pose);
/* State to the device, and faces of row 0 put in their place. */
status servo_begin(struct simulation *sim, failure *why);
/* After a step: sum, advance, place. `rows` of faces stand on the device. */
status servo_step(struct simulation *sim, const clast_launch *launch, int rows, failure *why);
/* State from the device. */
status servo_end(struct simulation *sim, failure *why);
/* A table has been built. */
void servo_note_table(struct simulation *sim);
/* Share of the skin that a wall may use up: half, or half of that for servos and as much for prescribed motion. */
double servo_share(const struct simulation *sim);
double servo_speed_max(const struct simulation *sim);
void servo_guard(struct simulation *sim, struct guard_finding *out);
void servo_save(const struct simulation *sim, bundle *out);
status servo_load(struct simulation *sim, const bundle *in, const char *path, int stage, failure *why);

#endif
