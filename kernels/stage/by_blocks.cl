/* The two stages with a block to a work-item, whose loops over records and grains are what the compiler makes vector code of: the form for CPUs.
 * Its twin is by_items.cl, and both give the same bits. docs/performance.md has what the parts of this gain.
 *
 * A CPU gathers one number at a time, and a record needs some twenty of its two grains. So a block reads its grains first, three numbers of a
 * grain with one load, and turns them into rows: one number of 64 records side by side, which the loop reads in order (rows.cl). And it asks for the
 * grains of a block to come, because the loop leaves no room to wait for them. The particle stage gathers the forces on its grains into rows. */
/* LANES: numbers in the widest register of the device (host/live.c). */
#define VECTOR_LOOP _Pragma("clang loop vectorize(assume_safety) vectorize_width(LANES)")
/* Blocks by which what records keep is asked for before it is wanted; for grains it depends on how they stand (rows_gathered.cl, rows_packed.cl). */
#define RECORDS_AHEAD 2
/* Work-groups of records of beds that do not fit the caches next to a core: only there does asking pay. */
#define BLOCKS_TO_ASK 128

/* ---- records ---- */

INLINE void sphere_of_rows(const real *rows, int lane, sphere *s)
{
    s->position = ROW_PRECISE_POLAR3(rows, ROW_POSITION, lane);
    s->radius = ROW_PRECISE(rows, ROW_RADIUS, lane);
    s->mass = ROW_NUMBER(rows, ROW_MASS, lane);
    s->velocity = ROW_POLAR3(rows, ROW_VELOCITY, lane);
    s->spin = ROTATION_OF_ROWS(rows, ROW_SPIN, lane);
    s->past_velocity = INTEGRATOR_VELOCITY_OF_ROWS(rows, ROW_PAST, lane, s->velocity);
    s->past_spin = INTEGRATOR_SPIN_OF_ROWS(rows, ROW_PAST + 3, lane, s->spin);
    s->temperature = TEMPERATURE_OF_ROWS(rows, ROW_TEMPERATURE, lane);
}

INLINE void pair_of_rows(const clast_launch *launch, const real *owners, const real *others, int lane, int k WRENCH_DECLARE PAIR_DECLARE)
{
    sphere s_i, s_j;
    contact c;
    sphere_of_rows(owners, lane, &s_i);
    sphere_of_rows(others, lane, &s_j);
    contact_of_spheres(launch, owner[k], other[k], &s_i, &s_j, true, &c PAIR_PASS);
    PAIR_FROM_CONTACT(PAIR_STORE_STATE, WRENCH_PUT);
}

/* Of one whose rows hold nothing but its place. */
INLINE void stranger_of_rows(const real *rows, int lane, sphere *s)
{
    s->position = ROW_PRECISE_POLAR3(rows, ROW_POSITION, lane);
    s->radius = ROW_PRECISE(rows, ROW_RADIUS, lane);
    s->mass = R(1.0);
    s->velocity = s->past_velocity = s->spin = s->past_spin = v3(R(0.0), R(0.0), R(0.0));
    s->temperature = R(0.0);
}

/* The same where the two do not touch and no law acts on them: of the laws nothing is left but that forces and histories are 0. */
INLINE void pair_of_strangers(const clast_launch *launch, const real *owners, const real *others, int lane, int k WRENCH_DECLARE PAIR_DECLARE)
{
    sphere s_i, s_j;
    contact c;
    stranger_of_rows(owners, lane, &s_i);
    stranger_of_rows(others, lane, &s_j);
    contact_of_spheres(launch, owner[k], other[k], &s_i, &s_j, false, &c PAIR_PASS);
    PAIR_FROM_CONTACT(PAIR_STORE_STATE, WRENCH_PUT);
}

/* Whether the two of a record may touch: surely so where they do. Two at one place do not (stage/contact.cl); those of padding are one grain. */
INLINE int pair_is_near(const clast_launch *launch, const real *owners, const real *others, int lane)
{
    precise3 from = ROW_PRECISE_POLAR3(owners, ROW_POSITION, lane), to = ROW_PRECISE_POLAR3(others, ROW_POSITION, lane);
    vec3 d = apart_vector(periodic_nearest(launch, apart_of(to, from)));
    real sum = rounded(ROW_PRECISE(owners, ROW_RADIUS, lane)) + rounded(ROW_PRECISE(others, ROW_RADIUS, lane));
    real d2 = dot3(d, d);
    return d2 > R(0.0) && d2 < R(1.00001) * sum * sum;
}

/* Grains of a block of records to come. */
INLINE void grains_ask_ahead(__global const int *which, int k PAIR_DECLARE)
{
    for (int lane = 0; lane < CLAST_BLOCK; lane++)
        grain_ask_for(which[k + lane] PAIR_PASS);
}

/* Reals in a line of a cache. */
#define LINE_REALS (64 / (int)sizeof(real))
/* What a block of records to come keeps, a component of a field at a time: there are more of them than a processor follows by itself, and it begins
 * anew at every page. `names`: the block whose grains are to be asked for RECORDS_AHEAD blocks from here. */
#define RECORDS_ASK_FOR(launch, field, components, k)                                        \
    for (int c = 0; c < (components); c++)                                                  \
        for (int lane = 0; lane < CLAST_BLOCK; lane += LINE_REALS)                          \
    ASK_TO_CHANGE(&AT(field, (launch)->record_stride, c, (k) + lane))
INLINE void records_ask_ahead(const clast_launch *launch, int k, int names PAIR_DECLARE)
{
    BOND_ASK_FOR(launch, k);
    TANGENTIAL_ASK_FOR(launch, k);
    ROLLING_ASK_FOR(launch, k);
    for (int lane = 0; lane < CLAST_BLOCK; lane += 64 / (int)sizeof(int)) {
        ASK_FOR(owner + names + lane);
        ASK_FOR(other + names + lane);
    }
}

/* Where a function deals in vectors of 512 bits, a compiler that would rather not use such registers takes them: here they gain a fifth. */
INLINE ulong8 widest(ulong8 x)
{
    return x + (ulong8)(1);
}

INLINE void pair_fill_lots(const clast_launch *launch, int group, int k, real *owners, real *others, int *kind PAIR_DECLARE)
{
    int near[CLAST_BLOCK];
    uint was_quiet = TOUCHED_QUIET(launch, group), quiet = 0;
    bool all = PAIRS_ACT_APART || !launch->loose;
    if (!all) {
        VECTOR_LOOP
        for (int lane = 0; lane < CLAST_BLOCK; lane++)
            near[lane] = pair_is_near(launch, owners, others, lane);
    }
    for (int lot = 0; lot < LOTS; lot++) {
        int some = all;
        for (int lane = LOT * lot; !all && lane < LOT * (lot + 1); lane++)
            some |= near[lane];
        kind[lot] = some ? LOT_OF_PAIRS : was_quiet & LOT_BIT(lot) ? LOT_QUIET : LOT_OF_STRANGERS;
        quiet |= some ? 0 : LOT_BIT(lot);
        for (int lane = LOT * lot; some && !all && lane < LOT * (lot + 1); lane++)
            if (near[lane]) {
                TOUCHED_MARK(owner[k + lane]);
                TOUCHED_MARK(other[k + lane]);
            }
    }
    for (int lane = 0; lane < CLAST_BLOCK; lane += ROWS_FILLED) {
        bool some = all;
        for (int lot = lane / LOT; lot <= (lane + ROWS_FILLED - 1) / LOT; lot++)
            some |= kind[lot] == LOT_OF_PAIRS;
        if (some) {
            rows_fill_rest(owner + k + lane, all, owners + lane PAIR_PASS);
            rows_fill_rest(other + k + lane, all, others + lane PAIR_PASS);
        }
    }
    if (!all)
        TOUCHED_SET_QUIET(group, quiet);
}

/* Lots of one kind in a row go in one loop, so that a block in which all touch costs what it would without a look. */
INLINE void pair_block(const clast_launch *launch, int group PAIR_DECLARE)
{
    real owners[ROWS_OF_GRAIN * CLAST_BLOCK], others[ROWS_OF_GRAIN * CLAST_BLOCK];
    WRENCH_ROWS;
    int k = (int)(widest((ulong8)((ulong)(CLAST_BLOCK * group))).s0 - 1), kind[LOTS];
    bool all = PAIRS_ACT_APART || !launch->loose;
    rows_fill_places(owner + k, all, owners PAIR_PASS);
    rows_fill_places(other + k, all, others PAIR_PASS);
    if (launch->first_wall_group >= BLOCKS_TO_ASK && group + GRAINS_AHEAD < launch->first_wall_group) {
        grains_ask_ahead(other, k + GRAINS_AHEAD * CLAST_BLOCK PAIR_PASS);
        records_ask_ahead(launch, k + RECORDS_AHEAD * CLAST_BLOCK, k + (GRAINS_AHEAD + RECORDS_AHEAD) * CLAST_BLOCK PAIR_PASS);
    }
    pair_fill_lots(launch, group, k, owners, others, kind PAIR_PASS);
    for (int lot = 0, end; lot < LOTS; lot = end) {
        for (end = lot + 1; end < LOTS && (all || kind[end] == kind[lot]);)
            end++;
        if (all || kind[lot] == LOT_OF_PAIRS) {
            VECTOR_LOOP
            for (int lane = LOT * lot; lane < LOT * end; lane++)
                pair_of_rows(launch, owners, others, lane, k + lane WRENCH_PASS PAIR_PASS);
        } else if (kind[lot] == LOT_OF_STRANGERS) {
            VECTOR_LOOP
            for (int lane = LOT * lot; lane < LOT * end; lane++)
                pair_of_strangers(launch, owners, others, lane, k + lane WRENCH_PASS PAIR_PASS);
        }
    }
    WRENCHES_STORE(k - launch->force_shift, all ? NULL : kind);
}

#define WALL_DECLARE , int lane WRENCH_DECLARE
/* Of a wall without borders, whose contact takes no loop: as vector code. */
PAIR_OF_WALL(INLINE, pair_of_plane, PAIR_STORE_STATE, WRENCH_PUT, WALL_DECLARE)
/* Of any other. */
PAIR_OF_WALL(OUTLINE, pair_of_face, PAIR_STORE_STATE, WRENCH_PUT, WALL_DECLARE)

/* In a loose bed: the lots in which nobody touches a wall are left alone once their zeros stand there. */
INLINE void pair_wall_lots(const clast_launch *launch, int group PAIR_DECLARE)
{
    uint was_quiet = TOUCHED_QUIET(launch, group), quiet = 0;
    int kind[LOTS];
    WRENCH_ROWS;
    for (int lot = 0; lot < LOTS; lot++) {
        int first = CLAST_BLOCK * group, some = 0;
        for (int k = first + LOT * lot; k < first + LOT * (lot + 1); k++)
            if (WALLS_NEAR(launch, other[k], PRECISE_GRAIN_POLAR3(position, owner[k]), GRAIN_RADIUS(owner[k]))) {
                TOUCHED_MARK(owner[k]);
                some = 1;
            }
        kind[lot] = some || !(was_quiet & LOT_BIT(lot)) ? LOT_OF_PAIRS : LOT_QUIET;
        if (kind[lot] == LOT_OF_PAIRS) {
            WALLS_LOOP
            for (int lane = LOT * lot; lane < LOT * (lot + 1); lane++)
                PAIR_OF_WALLS(launch, first + lane, lane WRENCH_PASS PAIR_PASS);
        }
        quiet |= some ? 0 : LOT_BIT(lot);
    }
    WRENCHES_STORE(CLAST_BLOCK * group - launch->force_shift, kind);
    TOUCHED_SET_QUIET(group, quiet);
}

/* Walls' records come first in a step, when no grain has been looked at for long: all that a block needs is asked for at once. */
INLINE void pair_wall_block(const clast_launch *launch, int group PAIR_DECLARE)
{
    if (launch->first_wall_group >= BLOCKS_TO_ASK) {
        grains_ask_ahead(owner, CLAST_BLOCK * group PAIR_PASS);
        records_ask_ahead(launch, CLAST_BLOCK * group, CLAST_BLOCK * group PAIR_PASS);
    }
    if (TOUCHED_LOOKS(launch)) {
        pair_wall_lots(launch, group PAIR_PASS);
        return;
    }
    WRENCH_ROWS;
    WALLS_LOOP
    for (int lane = 0; lane < CLAST_BLOCK; lane++)
        PAIR_OF_WALLS(launch, CLAST_BLOCK * group + lane, lane WRENCH_PASS PAIR_PASS);
    WRENCHES_STORE(CLAST_BLOCK * group - launch->force_shift, NULL);
}

/* Work-groups of records from..to of those that start at the launch's first; walls' are given a copy, so that the other is nobody else's. */
BODY void pair_blocks(const clast_launch *given, const clast_launch *for_walls, int from, int to PAIR_DECLARE)
{
    const clast_launch own = *given, *launch = &own;
    for (int group = launch->first_group + from; group < launch->first_group + to; group++)
        if (group < launch->first_wall_group)
            pair_block(launch, group PAIR_PASS);
        else
            pair_wall_block(for_walls, group PAIR_PASS);
}

__kernel void pair_stage(const clast_launch launch, __global const clast_control *restrict control PAIR_DECLARE)
{
    int at = get_global_id(0);
    if (control->halt_step > launch.step)
        pair_blocks(&launch, &launch, at, at + 1 PAIR_PASS);
}

/* A kernel that calls one(launch, k, wall) for every record: a work-group's records by its first item. */
#define RECORD_KERNEL(name, one)                                             \
    BODY void name##_unit(const clast_launch *given, int group PAIR_DECLARE) \
    {                                                                        \
        const clast_launch own = *given, *launch = &own;                     \
        if (group < launch->first_wall_group) {                              \
            VECTOR_LOOP                                                      \
            for (int lane = 0; lane < CLAST_BLOCK; lane++)                   \
                one(launch, CLAST_BLOCK *group + lane, false PAIR_PASS);     \
        } else                                                               \
            for (int lane = 0; lane < CLAST_BLOCK; lane++)                   \
                one(given, CLAST_BLOCK *group + lane, true PAIR_PASS);       \
    }                                                                        \
    __kernel void name(const clast_launch launch PAIR_DECLARE)               \
    {                                                                        \
        if (get_local_id(0) == 0)                                            \
            name##_unit(&launch, get_group_id(0) PAIR_PASS);                 \
    }

/* ---- grains ---- */

INLINE void moving_fill(int4 i, real *to PARTICLE_DECLARE)
{
    rows_exact_polar3(position, i, ROW(to, ROW_PLACE));
    rows_exact_polar3(built_position, i, ROW(to, ROW_BUILT));
    rows_exact_polar3(velocity, i, ROW(to, ROW_TRAVEL));
    ROTATION_EXACT_ROWS_FILL(i, ROW(to, ROW_TURNING));
    INTEGRATOR_EXACT_ROWS_FILL(i, ROW(to, ROW_KEPT));
}

INLINE void moving_of_rows(const real *rows, int lane, moving *m)
{
    m->position = ROW_PRECISE_POLAR3(rows, ROW_PLACE, lane);
    m->built_position = ROW_PRECISE_POLAR3(rows, ROW_BUILT, lane);
    m->velocity = ROW_PRECISE_POLAR3(rows, ROW_TRAVEL, lane);
    m->spin = ROTATION_PRECISE_OF_ROWS(rows, ROW_TURNING, lane);
    m->kept_velocity = INTEGRATOR_PRECISE_VELOCITY_OF_ROWS(rows, ROW_KEPT, lane, m->velocity);
    m->kept_spin = INTEGRATOR_PRECISE_SPIN_OF_ROWS(rows, ROW_KEPT + 3 * EXACT_REALS, lane, m->spin);
}

/* Rows of slots stand a block apart, and only a few are read of each, so that no processor foresees them: they are asked for as the grains of
 * two units before are advanced. */
INLINE void slots_ask_ahead(const clast_launch *launch, int first PARTICLE_DECLARE)
{
    if (first >= launch->particle_count || launch->first_wall_group < BLOCKS_TO_ASK)
        return;
    uint end = slot_offset[first / CLAST_BLOCK + 1];
    for (uint s = slot_offset[first / CLAST_BLOCK]; s < end; s += CLAST_BLOCK)
        for (int lane = 0; lane < PARTICLE_LANES; lane += 16)
            ASK_FOR(slots + s + first % CLAST_BLOCK + lane);
}

/* Grains `first` to first + PARTICLE_LANES - 1, which stand in one block. */
INLINE void particle_block(const clast_launch *launch, __global clast_control *control, int first PARTICLE_DECLARE)
{
    real rows[ROWS_OF_MOTION * CLAST_BLOCK];
    int far = 0;
    for (int lane = 0; lane < PARTICLE_LANES; lane += 4)
        moving_fill((int4)(first + lane, first + lane + 1, first + lane + 2, first + lane + 3), rows + lane PARTICLE_PASS);
    slots_ask_ahead(launch, first + 2 * PARTICLE_LANES PARTICLE_PASS);
    grains_gather(launch, first, rows PARTICLE_PASS);
    VECTOR_LOOP
    for (int lane = 0; lane < PARTICLE_LANES; lane++) {
        grain_heat h;
        moving m;
        moving_of_rows(rows, lane, &m);
        CONDUCTION_OF_ROWS(rows, ROW_HEAT, lane, h);
        far |= particle_step(launch, first + lane, &m, ROW_POLAR3(rows, ROW_FORCE, lane), ROTATION_OF_ROWS(rows, ROW_TORQUE, lane), &h PARTICLE_PASS);
    }
    grains_pack(first, PARTICLE_LANES PARTICLE_PASS);
    if (far)
        particle_halt(launch, control);
}

/* Units from..to of grains. */
BODY void particle_blocks(const clast_launch *given, __global clast_control *control, int from, int to PARTICLE_DECLARE)
{
    const clast_launch own = *given, *launch = &own;
    for (int unit = from; unit < to; unit++)
        particle_block(launch, control, CLAST_BLOCK * launch->first_group + PARTICLE_LANES * unit PARTICLE_PASS);
}

__kernel void particle_stage(const clast_launch launch, __global clast_control *restrict control PARTICLE_DECLARE)
{
    int at = get_global_id(0);
    if (control->halt_step > launch.step)
        particle_blocks(&launch, control, at, at + 1 PARTICLE_PASS);
}

/* Before steps: what is kept of grains a second time, as they are now (rows_packed.cl). */
__kernel void particle_pack(const int blocks PARTICLE_DECLARE)
{
    int block = get_global_id(0);
    if (block == 0)
        WRENCH_OF_NOBODY;
    if (block < blocks)
        grains_pack(CLAST_BLOCK * block, CLAST_BLOCK PARTICLE_PASS);
}

/* ---- pieces of a step for a team (team.cl) ---- */

/* Units of a piece: a work-item's of the two stages. */
#define PIECE_UNITS(piece) ((piece).count * ((piece).pairs ? 1 : CLAST_BLOCK / PARTICLE_LANES))

/* Units from..to of pieces first..end, as a member takes them. */
typedef struct team_share {
    int first, end, from, to;
} team_share;

/* Of a unit that members share the piece and its place there; of a stream all its pieces whole. */
INLINE team_share team_share_of(__global const clast_phases *phases, __global const clast_piece *pieces, int phase, int unit)
{
    team_share share;
    if (phases->phase[phase].streams) {
        share.first = phases->stream[unit];
        share.end = phases->stream[unit + 1];
        share.from = 0;
        share.to = INT_MAX;
        return share;
    }
    int p = phases->phase[phase].first;
    for (; unit >= PIECE_UNITS(pieces[p]); p++)
        unit -= PIECE_UNITS(pieces[p]);
    share.first = p;
    share.end = p + 1;
    share.from = unit;
    share.to = unit + 1;
    return share;
}

INLINE void team_pairs(const team_member *me, const clast_launch *launch, const clast_launch *for_walls, int from, int to PAIR_DECLARE)
{
    (void)me;
    pair_blocks(launch, for_walls, from, to PAIR_PASS);
}

INLINE void team_grains(const team_member *me, const clast_launch *launch, __global clast_control *control, int from, int to PARTICLE_DECLARE)
{
    (void)me;
    particle_blocks(launch, control, from, to PARTICLE_PASS);
}
