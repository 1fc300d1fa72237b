/* When what is due: frames, observables, checkpoints and the ends of stages, as steps. */
#ifndef CLAST_HOST_SCHEDULE_H
#define CLAST_HOST_SCHEDULE_H
#include "simulation.h"

/* Steps between looks at the rest criterion; a stage is at rest after this many looks in a row. */
#define REST_CHECK_STEPS 100
#define REST_CHECKS 100
/* Steps between looks at the step limit where the step is automatic. */
#define LIMIT_CHECK_STEPS 200

typedef struct schedule {
    const scene *scene;
    int64_t next_frame, next_observation, next_checkpoint; /* multiples of the intervals of `output` */
    double stage_start;    /* s */
    int64_t rest_checks;   /* in a row */
    double recommended_s;  /* of an automatic step, at the last look */
    bool automatic;
} schedule;

typedef struct due {
    bool frame, observation, checkpoint, stage_end;
} due;

void schedule_init(schedule *s, const scene *scene);
/* Begins a stage at the simulation's present time with the step that it asks for, or the recommended one. */
void schedule_begin_stage(schedule *s, simulation *sim, double recommended_s);
/* Takes a new recommended step: steps to come end on the next time that is due. */
void schedule_adapt(schedule *s, simulation *sim, double recommended_s);
/* Steps until something is due or must be looked at; sets sim->dt for them. At least 1. */
int64_t schedule_steps(schedule *s, simulation *sim);
/* The next time at which something is due; infinite where nothing is. */
double schedule_next_time(const schedule *s, const simulation *sim);
/* True from the end of the stage on: no step of it is left. */
bool schedule_stage_over(const schedule *s, const simulation *sim);
/* What is due now, at the present step and time; moves on to the next. */
due schedule_due(schedule *s, const simulation *sim);

#endif
