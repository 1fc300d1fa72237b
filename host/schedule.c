#include "schedule.h"

#include "steady.h"

#include <math.h>

/* Two times are the same within this share of a step, or of an interval of output: what the roundings of steps leave. In mixed precision the last step
 * of a stage is the float at or above what is left. */
#define SAME 1e-6

void schedule_init(schedule *s, const scene *scene)
{
    *s = (schedule){.scene = scene, .next_frame = 1, .next_observation = 1, .next_checkpoint = 1};
}

static const scene_stage *stage_of(const schedule *s, const simulation *sim)
{
    return &s->scene->stage[sim->stage];
}

static double observation_interval(const schedule *s)
{
    return isnan(s->scene->output.observables_every_s) ? s->scene->output.every_s : s->scene->output.observables_every_s;
}

static double stage_end_time(const schedule *s, const simulation *sim)
{
    return s->stage_start + stage_of(s, sim)->until_time_s; /* NAN where time does not end it */
}

double schedule_next_time(const schedule *s, const simulation *sim)
{
    double end = stage_end_time(s, sim), next = isnan(end) ? INFINITY : end;
    const double every[] = {s->scene->output.every_s, observation_interval(s)};
    const int64_t number[] = {s->next_frame, s->next_observation};
    for (int k = 0; k < 2; k++) {
        double due = (double)number[k] * every[k];
        if (!isnan(due) && !(fabs(due - end) <= SAME * every[k])) /* what is due at the end of the stage is written there */
            next = fmin(next, due);
    }
    return next;
}

/* A step where nothing binds: a small part of what is asked for. */
static double unbound_step(const schedule *s, const simulation *sim)
{
    const scene_stage *stage = stage_of(s, sim);
    double span = !isnan(stage->until_time_s) ? stage->until_time_s : s->scene->output.every_s;
    return isnan(span) ? 1e-4 : 1e-4 * span;
}

void schedule_adapt(schedule *s, simulation *sim, double recommended_s)
{
    s->recommended_s = isfinite(recommended_s) ? recommended_s : unbound_step(s, sim);
    double left = schedule_next_time(s, sim) - sim->time, dt = s->recommended_s;
    if (isfinite(left) && left > SAME * dt)
        dt = left / fmax(1.0, ceil(left / dt - SAME));
    simulation_set_step(sim, dt);
}

void schedule_begin_stage(schedule *s, simulation *sim, double recommended_s)
{
    const scene_stage *stage = stage_of(s, sim);
    s->stage_start = sim->time;
    s->rest_checks = 0;
    s->automatic = isnan(stage->step_s) && !stage->frozen;
    if (stage->frozen)
        simulation_set_step(sim, recommended_s);
    else if (s->automatic)
        schedule_adapt(s, sim, recommended_s);
    else
        simulation_set_step(sim, stage->step_s);
}

static int64_t to_multiple(int64_t steps, int64_t every)
{
    return every > 0 ? every - steps % every : INT64_MAX;
}

static int64_t least(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/* Steps of the present size that reach `time`: the nearest step for what is written, none beyond it for the end of a stage. */
static int64_t steps_to(const simulation *sim, double time, bool never_beyond)
{
    double steps = (time - sim->segment_time) / sim->dt;
    int64_t target = sim->segment_step + (int64_t)(never_beyond ? floor(steps + SAME) : rint(steps));
    return target > sim->step ? target - sim->step : 0;
}

int64_t schedule_steps(schedule *s, simulation *sim)
{
    const scene_stage *stage = stage_of(s, sim);
    int64_t steps = INT64_MAX;
    double end = stage_end_time(s, sim);
    if (!isnan(end) && steps_to(sim, end, true) == 0 && end > sim->time)
        simulation_set_step(sim, end - sim->time); /* the last step ends on the end of the stage */
    if (!isnan(end))
        steps = least(steps, steps_to(sim, end, true));
    if (!isnan(s->scene->output.every_s))
        steps = least(steps, steps_to(sim, s->next_frame * s->scene->output.every_s, false));
    if (!isnan(observation_interval(s)))
        steps = least(steps, steps_to(sim, s->next_observation * observation_interval(s), false));
    if (!isnan(s->scene->output.checkpoint_every_s))
        steps = least(steps, steps_to(sim, s->next_checkpoint * s->scene->output.checkpoint_every_s, false));
    if (stage->until_steps >= 0)
        steps = least(steps, stage->until_steps - sim->stage_steps);
    if (!isnan(stage->until_rest) || !isnan(stage->until_rest_j))
        steps = least(steps, to_multiple(sim->stage_steps, REST_CHECK_STEPS));
    if (!isnan(stage->until_steady_k_s))
        steps = least(steps, to_multiple(sim->stage_steps, steady_interval(stage)));
    steps = least(steps, to_multiple(sim->stage_steps, s->scene->guards.every_steps));
    if (s->automatic)
        steps = least(steps, to_multiple(sim->stage_steps, LIMIT_CHECK_STEPS));
    return steps < 1 ? 1 : least(steps, 100000);
}

/* True once the present time is the nearest to, or past, a multiple of the interval. Frozen stages end their steps on what is due. */
static bool reached(const simulation *sim, int64_t number, double interval)
{
    double early = sim->scene->stage[sim->stage].frozen ? SAME * interval : 0.5 * sim->dt * (1.0 + SAME);
    return !isnan(interval) && sim->time >= (double)number * interval - early;
}

bool schedule_stage_over(const schedule *s, const simulation *sim)
{
    const scene_stage *stage = stage_of(s, sim);
    double end = stage_end_time(s, sim);
    double early = stage->frozen ? 0.0 : SAME * sim->dt;
    bool steady = !isnan(stage->until_steady_k_s) && sim->stage_steps > 0 && sim->frozen.rate < stage->until_steady_k_s;
    return steady || (!isnan(end) && sim->time >= end - early) || (stage->until_steps >= 0 && sim->stage_steps >= stage->until_steps) ||
           s->rest_checks >= REST_CHECKS;
}

due schedule_due(schedule *s, const simulation *sim)
{
    due now = {false, false, false, false};
    while (reached(sim, s->next_frame, s->scene->output.every_s)) {
        now.frame = true;
        s->next_frame++;
    }
    while (reached(sim, s->next_observation, observation_interval(s))) {
        now.observation = true;
        s->next_observation++;
    }
    while (reached(sim, s->next_checkpoint, s->scene->output.checkpoint_every_s)) {
        now.checkpoint = true;
        s->next_checkpoint++;
    }
    now.stage_end = schedule_stage_over(s, sim);
    return now;
}
