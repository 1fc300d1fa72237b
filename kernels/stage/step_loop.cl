/* Many steps in one launch: both stages by the bodies that the two kernels run, their pieces (host/step_plan.c) one after the other, and meetings
 * between them in place of launches. On a GPU a team is the work-items of one work-group, for beds so small that launches would cost more than the
 * work. On a CPU it is a work-group of one item for every core, for beds of any size (by_blocks.cl). Or a launch does the one phase `only` (counted
 * from the start of the batch) instead of -1, and its work-groups need not wait for each other. Halts exactly as the two kernels do. */
/* A stage's arguments under names of its own: what both stages use stands twice in the signature, and neither sees the other's. */
#define DECLARE_LOOP_PAIR(type, name) , __global type *pair_##name
#define DECLARE_LOOP_PARTICLE(type, name) , __global type *particle_##name
#define PASS_LOOP_PAIR(type, name) , pair_##name
#define PASS_LOOP_PARTICLE(type, name) , particle_##name

__kernel void step_loop(__global const clast_launch *restrict launches, __global clast_control *control, __global clast_team *team,
                        __global const clast_phases *restrict phases, __global const clast_piece *restrict pieces, const int steps,
                        const int team_most, const int only PAIR_FIELDS(DECLARE_LOOP_PAIR, DECLARE_LOOP_PAIR) PARTICLE_FIELDS(DECLARE_LOOP_PARTICLE, DECLARE_LOOP_PARTICLE))
{
    team_member me;
    if (!team_join(team, team_most, only, &me))
        return;
    int end = only < 0 ? steps * phases->count : only + 1;
    while (me.meetings < end) {
        int s = me.meetings / phases->count, phase = me.meetings % phases->count, of = me.place, unit;
        if (control->halt_step <= s)
            break;
        while ((unit = team_next(team, &me, &of, phases->phase[phase].units)) >= 0) {
            team_share share = team_share_of(phases, pieces, phase, unit);
            for (int p = share.first; p < share.end; p++) {
                clast_launch launch = launches[s];
                launch.first_group = pieces[p].first;
                launch.force_shift = pieces[p].force_shift;
                const clast_launch for_walls = launch;
                int to = min(share.to, PIECE_UNITS(pieces[p]));
                if (pieces[p].pairs)
                    team_pairs(&me, &launch, &for_walls, share.from, to PAIR_FIELDS(PASS_LOOP_PAIR, PASS_LOOP_PAIR));
                else
                    team_grains(&me, &launch, control, share.from, to PARTICLE_FIELDS(PASS_LOOP_PARTICLE, PASS_LOOP_PARTICLE));
            }
        }
        team_meet(team, team_most, &me);
    }
    team_leave(team);
}
