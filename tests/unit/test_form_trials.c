/* Which way through the steps is taken, where each costs what the test says: the cheapest, for nearly all batches, and another once that is cheaper. */
#include "simulation.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#define STEPS 64

/* Seconds a step of each manner, and a table after each so many batches. */
typedef struct costs {
    double step[LOOP_MANNERS], table[LOOP_MANNERS];
    int batches_a_table;
} costs;

/* Share of the last half of so many batches that each manner has. */
static void go(form_trials *t, const costs *c, int batches, bool small, double *share)
{
    int count[LOOP_MANNERS] = {0};
    for (int b = 0; b < batches; b++) {
        loop_manner m = form_trials_next(t, LOOP_MANNERS, small);
        assert_in_range(m, LOOP_PHASES, LOOP_ALONE);
        form_trials_note(t, STEPS, 1.0, STEPS * c->step[m], small);
        if (c->batches_a_table > 0 && b % c->batches_a_table == 0)
            form_trials_note_table(t, (int64_t)STEPS * c->batches_a_table, c->table[m]);
        count[m] += 2 * b >= batches;
    }
    for (int m = 0; m < LOOP_MANNERS; m++)
        share[m] = count[m] / (0.5 * batches);
}

/* Whichever is the fastest, it gets all but the trials' batches: those of each other manner lose half a per cent of the time. */
static void test_fastest(void **state)
{
    (void)state;
    for (int small = 0; small < 2; small++)
        for (loop_manner best = LOOP_PHASES; best < (small ? LOOP_MANNERS : LOOP_ALONE); best++) {
            form_trials t = {0};
            costs c = {.step = {60e-6, 60e-6, 60e-6}};
            double share[LOOP_MANNERS];
            c.step[best] = 40e-6;
            go(&t, &c, 20000, small, share);
            assert_int_equal(t.best, best);
            assert_true(share[best] > 1.0 - 2.0 * 0.005 / (1.0 - 40.0 / 60.0) - 0.005);
        }
}

/* As in the batches of one that flies and piles up in turn: what each costs goes up and down fourfold, and the fastest is still found. */
static void test_costs_that_swing(void **state)
{
    (void)state;
    form_trials t = {0};
    double count = 0.0;
    for (int b = 0; b < 40000; b++) {
        double state_of_bed = b / 600 % 2 ? 4.0 : 1.0;
        const double step[LOOP_MANNERS] = {[LOOP_PHASES] = 64e-6, [LOOP_TEAM] = 36e-6, [LOOP_ALONE] = 50e-6};
        loop_manner m = form_trials_next(&t, LOOP_MANNERS, true);
        form_trials_note(&t, STEPS, 1.0, STEPS * step[m] * state_of_bed, true);
        count += b >= 20000 && m == LOOP_TEAM;
    }
    assert_true(count / 20000 > 0.95);
}

/* Where another process takes a core, a team loses; once that is gone it is taken again. */
static void test_follows_the_machine(void **state)
{
    (void)state;
    form_trials t = {0};
    const costs quiet = {.step = {64e-6, 36e-6, 50e-6}}, busy = {.step = {64e-6, 5000e-6, 50e-6}};
    double share[LOOP_MANNERS];
    go(&t, &quiet, 4000, true, share);
    assert_int_equal(t.best, LOOP_TEAM);
    go(&t, &busy, 4000, true, share);
    assert_int_equal(t.best, LOOP_ALONE);
    assert_true(share[LOOP_ALONE] > 0.98);
    go(&t, &quiet, 100000, true, share);
    assert_int_equal(t.best, LOOP_TEAM);
}

/* A table counts with the steps between two. */
static void test_tables_count(void **state)
{
    (void)state;
    form_trials t = {0};
    const costs c = {.step = {64e-6, 40e-6, 44e-6}, .table = {900e-6, 900e-6, 100e-6}, .batches_a_table = 1}; /* 40 + 14, 44 + 2 us a step */
    double share[LOOP_MANNERS];
    go(&t, &c, 20000, true, share);
    assert_int_equal(t.best, LOOP_ALONE);
}

/* One that is asked for is taken at once, and leaves no trial half done. */
static void test_asked_for(void **state)
{
    (void)state;
    form_trials t = {0};
    const costs c = {.step = {64e-6, 36e-6, 50e-6}};
    double share[LOOP_MANNERS];
    go(&t, &c, 4000, true, share);
    for (int b = 0; b < 100; b++) {
        assert_int_equal(form_trials_next(&t, LOOP_ALONE, true), LOOP_ALONE);
        form_trials_note(&t, STEPS, 1.0, 1.0, true);
    }
    go(&t, &c, 100, true, share);
    assert_int_equal(t.best, LOOP_TEAM);
    assert_true(share[LOOP_TEAM] > 0.85);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_fastest), cmocka_unit_test(test_costs_that_swing), cmocka_unit_test(test_follows_the_machine),
                                       cmocka_unit_test(test_tables_count), cmocka_unit_test(test_asked_for)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
