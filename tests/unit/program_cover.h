/* A few programs in which every pair of laws meets every gap that it can meet: for any two laws and any slot that they leave empty there is a
 * program with both and with that slot's empty twin, and one in either form of the stages. What two laws and a twin do to each other then shows
 * without a program for every pair alone, of which there would be ten times as many. Needs with() and complete() of the including test. */
#ifndef CLAST_TESTS_PROGRAM_COVER_H
#define CLAST_TESTS_PROGRAM_COVER_H
#include "every_law.h"

#define COVER_VALUES (LAWS + SLOT_COUNT + 2) /* a law, an empty slot, a form of the stages */
#define COVER_TRIES  64

/* needed[a][b][z]: laws a < b have not yet met the gap or the form z. */
typedef struct cover {
    bool (*needed)[LAWS][COVER_VALUES];
    uint64_t random;
    long left;
} cover;

/* What is in a program: its laws, and the gaps and the form that they meet. */
typedef struct cover_content {
    size_t law[LAWS], gap[SLOT_COUNT + 1];
    size_t laws, gaps;
} cover_content;

static cover_content cover_look(const live_laws *live)
{
    cover_content c = {.laws = 0};
    for (size_t n = 0; n < LAWS; n++)
        if (live->law[every_law[n]->slot] == every_law[n])
            c.law[c.laws++] = n;
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
        if (!live->law[slot])
            c.gap[c.gaps++] = LAWS + slot;
    c.gap[c.gaps++] = LAWS + SLOT_COUNT + (live->blocks ? 1 : 0);
    return c;
}

/* Counts what a program newly shows, and where `take` notes it. */
static long cover_count(cover *all, const live_laws *live, bool take)
{
    cover_content c = cover_look(live);
    long count = 0;
    for (size_t a = 0; a < c.laws; a++)
        for (size_t b = a + 1; b < c.laws; b++)
            for (size_t z = 0; z < c.gaps; z++) {
                bool *needed = &all->needed[c.law[a]][c.law[b]][c.gap[z]];
                count += *needed;
                *needed = *needed && !take;
            }
    all->left -= take ? count : 0;
    return count;
}

/* What is to be seen: what the programs of each pair alone would show. */
static cover cover_begin(void)
{
    cover all = {.needed = calloc(LAWS, sizeof *all.needed), .random = 1};
    assert_non_null(all.needed);
    for (size_t a = 0; a < LAWS; a++)
        for (size_t b = a + 1; b < LAWS; b++) {
            live_laws live = with(every_law[a], every_law[b]);
            if (live.law[every_law[a]->slot] != every_law[a] || live.law[every_law[b]->slot] != every_law[b])
                continue;
            cover_content c = cover_look(&live);
            c.gap[c.gaps++] = LAWS + SLOT_COUNT + 1;
            for (size_t z = 0; z < c.gaps; z++)
                all.needed[a][b][c.gap[z]] = true;
            all.left += (long)c.gaps;
        }
    return all;
}

static size_t cover_draw(cover *all, size_t choices)
{
    all->random = all->random * 6364136223846793005u + 1442695040888963407u;
    return (size_t)(all->random >> 33) % choices;
}

/* The program of some laws, by slot, or of what they call for as well; false where it lacks a or b or fills z. */
static bool cover_complete(const live_laws *some, size_t a, size_t b, size_t z, live_laws *out)
{
    *out = *some;
    complete(out);
    out->blocks = z >= LAWS + SLOT_COUNT ? z > LAWS + SLOT_COUNT : some->blocks;
    return out->law[every_law[a]->slot] == every_law[a] && out->law[every_law[b]->slot] == every_law[b] &&
           (z >= LAWS + SLOT_COUNT || !out->law[z - LAWS]);
}

/* Two laws, a gap that stays, and about half of the other laws that leave all three as they are. */
static live_laws cover_try(cover *all, size_t a, size_t b, size_t z)
{
    live_laws some, out;
    memset(&some, 0, sizeof some);
    some.law[every_law[a]->slot] = every_law[a];
    some.law[every_law[b]->slot] = every_law[b];
    some.blocks = cover_draw(all, 2) != 0;
    size_t first = cover_draw(all, LAWS);
    for (size_t n = 0; n < LAWS; n++) {
        const law *l = every_law[(first + n) % LAWS];
        live_laws more = some;
        more.law[l->slot] = l;
        if (!some.law[l->slot] && cover_draw(all, 2) == 0 && cover_complete(&more, a, b, z, &out))
            some = more;
    }
    cover_complete(&some, a, b, z, &out);
    return out;
}

/* The program that shows most of several tries, for the first thing still to be seen; the pair alone shows it in any case. */
static live_laws cover_best(cover *all, size_t a, size_t b, size_t z)
{
    live_laws best = with(every_law[a], every_law[b]);
    best.blocks = z > LAWS + SLOT_COUNT;
    long most = cover_count(all, &best, false);
    for (int n = 0; n < COVER_TRIES; n++) {
        live_laws tried = cover_try(all, a, b, z);
        long count = cover_count(all, &tried, false);
        if (count > most) {
            best = tried;
            most = count;
        }
    }
    return best;
}

/* The next program; false when all has been seen. */
static bool cover_next(cover *all, live_laws *live)
{
    for (size_t a = 0; a < LAWS; a++)
        for (size_t b = a + 1; b < LAWS; b++)
            for (size_t z = 0; z < COVER_VALUES; z++)
                if (all->needed[a][b][z]) {
                    *live = cover_best(all, a, b, z);
                    assert_true(cover_count(all, live, true) > 0);
                    return true;
                }
    assert_int_equal(all->left, 0);
    free(all->needed);
    return false;
}

#endif
