/* Work-groups of one item on a CPU that go through phases together, and meet after each instead of a launch for each: steps (step_loop.c on the host),
 * or the commands of a table (table_phases.c). A GPU has the work-items of one work-group for it (by_items.cl). */

/* A member of the work-groups that go through steps together; `meetings`: those held so far, which tells the step and the piece. */
typedef struct team_member {
    int place, size, meetings;
    int taken; /* units of its own part, where nobody else takes any; -1 in a team */
} team_member;

/* What another thread writes; volatile, so that it is read each time. An atomic operation must follow before what it guards is read. */
#define TEAM_LOOK(word) (*(volatile __global int *)&(word))
/* Meetings held and members, in one word. */
#define TEAM_STATE(meetings, size) ((meetings) * (2 * CLAST_TEAM_MAX) + (size))

INLINE void team_read(team_member *me, int state)
{
    me->size = state % (2 * CLAST_TEAM_MAX);
    me->meetings = state / (2 * CLAST_TEAM_MAX);
}

/* Nobody may wait for a work-group that has not begun, since it may never begin before this one ends. So the first to come begins alone, and
 * others are taken in at the next meeting after they have come. False: this work-group is not in it, and has nothing to do. */
INLINE bool team_join(__global clast_team *team, int most, int only, team_member *me)
{
    me->taken = only < 0 ? -1 : 0;
    if (only >= 0) {
        me->place = (int)get_group_id(0);
        me->size = (int)get_num_groups(0);
        me->meetings = only;
        return true;
    }
    me->place = atomic_inc(&team->arrived);
    if (me->place >= most)
        return false;
    if (me->place == 0)
        atomic_xchg(&team->state, TEAM_STATE(0, 1));
    int state = TEAM_LOOK(team->state);
    while (state % (2 * CLAST_TEAM_MAX) <= me->place) {
        if (TEAM_LOOK(team->closed))
            return false;
        state = TEAM_LOOK(team->state);
    }
    team_read(me, atomic_or(&team->state, 0));
    return true;
}

/* All members have come here before any goes on; the last one puts the counts back, and takes in who has come since. */
INLINE void team_meet(__global clast_team *team, int most, team_member *me)
{
    if (me->taken >= 0) {
        me->meetings++;
        return;
    }
    if (atomic_inc(&team->waiting) == me->size - 1) {
        int size = min(TEAM_LOOK(team->arrived), most);
        for (int m = 0; m < size; m++)
            team->taken[m * CLAST_TEAM_APART] = 0;
        team->waiting = 0;
        atomic_xchg(&team->state, TEAM_STATE(me->meetings + 1, size));
    } else
        while (TEAM_LOOK(team->state) / (2 * CLAST_TEAM_MAX) == me->meetings)
            ;
    team_read(me, atomic_or(&team->state, 0));
}

INLINE void team_leave(__global clast_team *team)
{
    atomic_xchg(&team->closed, 1);
}

/* The next of `count` units for this member, in its own part (`of` is its own place at first) or in that of one who has not begun with it; -1: none
 * is left. */
INLINE int team_next(__global clast_team *team, team_member *me, int *of, int count)
{
    if (me->taken >= 0) {
        int first = (int)((long)count * me->place / me->size), at = first + me->taken++;
        return at < (int)((long)count * (me->place + 1) / me->size) ? at : -1;
    }
    for (int tried = 0; tried < me->size; tried++) {
        int first = (int)((long)count * *of / me->size), end = (int)((long)count * (*of + 1) / me->size);
        int at = first + atomic_inc(&team->taken[*of * CLAST_TEAM_APART]);
        if (at < end)
            return at;
        *of = *of + 1 < me->size ? *of + 1 : 0;
    }
    return -1;
}
