/* When frames are due: each once, however the ends of stages and the multiples of the interval round. Time is counted here; no device takes part. */
#include "schedule.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

enum { FRAMES = 40 };

/* Two stages of times `first` and `second` one after the other, frames every `every`; the first ends `late` after its time, as a last step does that is
 * rounded up. Times of frames; returns their number. */
static int frames_of(double first, double second, double every, double late, bool frozen, double *times)
{
    scene_stage stages[2] = {{.until_time_s = first,
                              .until_steps = -1,
                              .until_rest = NAN,
                              .until_rest_j = NAN,
                              .until_steady_k_s = NAN,
                              .step_s = NAN,
                              .frozen = frozen},
                             {.until_time_s = second,
                              .until_steps = -1,
                              .until_rest = NAN,
                              .until_rest_j = NAN,
                              .until_steady_k_s = NAN,
                              .step_s = NAN,
                              .frozen = frozen}};
    scene scene = {.stage = stages, .stage_count = 2, .output = {.every_s = every, .observables_every_s = NAN, .checkpoint_every_s = NAN}};
    simulation *sim = calloc(1, sizeof *sim);
    schedule s;
    int count = 0;
    sim->scene = &scene;
    schedule_init(&s, &scene);
    for (int k = 0; k < 2; k++) {
        sim->stage = k;
        schedule_begin_stage(&s, sim, 0.3 * every);
        while (!schedule_stage_over(&s, sim)) {
            if (frozen) {
                sim->time = schedule_next_time(&s, sim);
            } else {
                schedule_adapt(&s, sim, 0.3 * every);
                assert_true(sim->dt > 0.01 * every);
                sim->step += 1;
                sim->time = sim->segment_time + (double)(sim->step - sim->segment_step) * sim->dt;
            }
            bool ends = schedule_stage_over(&s, sim);
            if (ends && k == 0)
                sim->time += frozen ? fmax(late, 0.0) : late;
            due now = schedule_due(&s, sim);
            assert_int_equal(now.stage_end, ends);
            if ((now.frame || now.stage_end) && count < FRAMES)
                times[count++] = sim->time;
        }
    }
    free(sim);
    return count;
}

static void test_each_frame_once(void **state)
{
    (void)state;
    const struct {
        double first, second, every;
        int frames; /* multiples of `every`, and ends of stages that are none */
    } cases[] = {{0.006, 0.04, 0.002, 23}, {0.1, 0.7, 0.1, 8}, {0.3, 0.6, 0.1, 9}, {0.1, 0.2, 0.3, 2}, {0.25, 0.5, 0.1, 9}};
    const double late[] = {0.0, 1e-13, -1e-17, 8.5e-14};
    for (int c = 0; c < (int)(sizeof cases / sizeof *cases); c++)
        for (int n = 0; n < 4; n++)
            for (int frozen = 0; frozen < 2; frozen++) {
                double times[FRAMES];
                int count = frames_of(cases[c].first, cases[c].second, cases[c].every, late[n], frozen, times);
                assert_int_equal(count, cases[c].frames);
                for (int k = 1; k < count; k++)
                    assert_true(times[k] - times[k - 1] > 0.1 * cases[c].every);
                assert_true(fabs(times[count - 1] - cases[c].first - cases[c].second) < 1e-12);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_each_frame_once)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
