/* Which of several ways through the steps is the fastest: a launch a phase, a team, or one work-group (step_loop.c).
 *
 * Nothing foretells it, since a team waits by looking and so loses where other processes want the cores. Results are the same to the bit, so
 * the batches of the run itself are timed: one way is the best of late, and the others are tried from time to time. What a step costs changes with what the
 * grains do, so a trial is held against the best's batches of late, the last of which were just before it.
 *
 *   best, settling -> best, timed -> trial, settling -> trial, timed -> best, settling -> ...
 *
 * Batches that settle are not timed: they fetch the grains from the caches of other cores. */
#include "simulation.h"

#include <math.h>
#include <string.h>

#define SETTLING_BATCHES 2
/* Batches of a trial of a small bed that are timed, and of the best at least before one; a large bed's are long, and one of each does. */
#define TIMED_BATCHES 3
/* What a trial takes of the best's time where it wins; in a small bed it wins so often in a row before it is the best, or by far, since batches are
 * short, and the grains may do something else meanwhile. */
#define TRIAL_WINS        0.95
#define TRIALS_TO_WIN     3
#define TRIAL_WINS_BY_FAR 0.5
/* Of the time, what trials of a manner may lose; and the least rest after one, in times that it took. */
#define TRIAL_SHARE 0.005
#define TRIAL_REST  16.0

void form_trials_forget(form_trials *t)
{
    *t = (form_trials){.manner = t->manner, .best = LOOP_PHASES};
}

static int batches_to_time(bool small)
{
    return small ? TIMED_BATCHES : 1;
}

static void begin(form_trials *t, loop_manner manner, bool small)
{
    t->trial = manner != t->best;
    t->settling = small && manner != t->manner ? SETTLING_BATCHES : 0;
    t->timed = 0;
    t->manner = manner;
    t->began = t->spent;
    t->work = t->timed_work = t->timed_seconds = 0.0;
}

loop_manner form_trials_next(form_trials *t, loop_manner only, bool small)
{
    if (only != LOOP_MANNERS) {
        if (t->manner != only || t->trial)
            begin(t, only, small);
        t->trial = false;
        return only;
    }
    if (!t->trial && t->manner != t->best)
        begin(t, t->best, small);
    bool may_try = !t->trial && t->settling == 0 && t->timed >= batches_to_time(small);
    for (loop_manner m = LOOP_PHASES; m < LOOP_MANNERS && may_try; m++)
        if (m != t->best && t->spent >= t->due[m] && (m != LOOP_ALONE || small)) {
            begin(t, m, small);
            break;
        }
    return t->manner;
}

/* Seconds a step of so much work at this pace, and of the tables between: who has gone through the steps has the grains in its caches, and a table
 * costs more where two have. */
static double cost(const form_trials *t, loop_manner m, double pace, double step_work)
{
    double table = t->table[m];
    for (loop_manner other = LOOP_PHASES; other < LOOP_MANNERS && t->table[m] <= 0.0; other++)
        if (t->table[other] > 0.0 && (table <= 0.0 || t->table[other] < table))
            table = t->table[other];
    return pace * step_work + (t->table_steps > 0.0 ? table / t->table_steps : 0.0);
}

/* What a trial costs more than the best would have tells when the next may come. */
static void end_trial(form_trials *t, double step_work, bool small)
{
    loop_manner m = t->manner;
    double pace = t->timed_seconds / t->timed_work, took = t->spent - t->began, lost = took - t->pace * t->work;
    double ratio = cost(t, m, pace, step_work) / cost(t, t->best, t->pace, step_work);
    t->trial = false;
    t->wins[m] = ratio < TRIAL_WINS ? t->wins[m] + 1 : 0;
    t->due[m] = t->spent + (t->wins[m] > 0 ? TRIAL_REST * took : fmax(TRIAL_REST * took, lost / TRIAL_SHARE));
    if (ratio < TRIAL_WINS_BY_FAR || t->wins[m] >= (small ? TRIALS_TO_WIN : 1)) {
        t->due[t->best] = t->spent + TRIAL_REST * took;
        t->best = m;
        t->pace = pace;
        memset(t->wins, 0, sizeof t->wins);
    }
}

/* The mean of late, which begins with the first. */
static void follow(double *mean, double value)
{
    *mean = *mean > 0.0 ? *mean + 0.2 * (value - *mean) : value;
}

void form_trials_note(form_trials *t, int64_t steps, double step_work, double seconds, bool small)
{
    if (t->batches++ == 0 || steps <= 0)
        return; /* the first one compiles */
    double work = (double)steps * step_work;
    t->spent += seconds;
    t->work += work;
    if (t->settling > 0) {
        t->settling--;
        return;
    }
    t->timed++;
    if (!t->trial) {
        if (t->manner == t->best)
            follow(&t->pace, seconds / work);
        return;
    }
    t->timed_work += work;
    t->timed_seconds += seconds;
    if (t->timed >= batches_to_time(small))
        end_trial(t, step_work, small);
}

void form_trials_note_table(form_trials *t, int64_t lasted, double seconds)
{
    if (t->batches < 2 || t->settling > 0 || lasted <= 0)
        return;
    follow(&t->table[t->manner], seconds);
    follow(&t->table_steps, (double)lasted);
}
