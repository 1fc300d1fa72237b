/* What the host and the kernels share: fixed-width types, widest member first, explicit padding, no pointers. */
#ifndef CLAST_SHARED_H
#define CLAST_SHARED_H

#if defined(__OPENCL_VERSION__) || defined(__OPENCL_C_VERSION__)
#ifdef REAL_IS_FLOAT
/* In mixed precision a number of 64 bits is two floats: the number rounded, and what that leaves (kernels/precision/mixed.cl). The host turns
 * its doubles into such pairs before they leave it. A struct, so that nobody takes the bits for a number. */
typedef struct __attribute__((aligned(8))) clast_f64 {
    float high, low;
} clast_f64;
#else
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
typedef double clast_f64;
#endif
typedef long clast_i64;
typedef int clast_i32;
#else
#include <stdint.h>
typedef double clast_f64;
typedef int64_t clast_i64;
typedef int32_t clast_i32;
#endif

/* Particles a block: one work-group, and the unit of the sliced slot table. A device that has been tuned may have another. */
#ifndef CLAST_BLOCK
#define CLAST_BLOCK 64
#endif

/* Passed by value to every stage. */
typedef struct clast_launch {
    clast_f64 dt;            /* s */
    clast_f64 lag;           /* s; twice the time by which half-step velocities are behind at the start of the step */
    clast_f64 kick;          /* s; what velocities advance by: dt, or the mean of two steps where they stand half a step behind */
    clast_f64 heat_span;     /* s by which temperatures advance in this step; 0: they wait */
    clast_f64 gravity[3];    /* m/s2 */
    clast_f64 drift[3];      /* common displacement since the table was built, m */
    clast_f64 travel2;       /* square of the displacement that asks for a new table, m2 */
    clast_f64 low[3];        /* domain, m */
    clast_f64 high[3];
    clast_f64 length[3];     /* periodic lengths; 0 where not periodic */
    clast_i64 record_stride;   /* elements between the components of a field of records */
    clast_i32 particle_count;
    clast_i32 first_group;      /* place of this launch's first work-group among those of the whole stage */
    clast_i32 first_wall_group; /* work-groups of the pair stage from here on hold wall records */
    clast_i32 force_shift;      /* the pair stage puts the force of record k at k - force_shift */
    clast_i32 first_wall_place; /* forces from here on are those of walls, where the particle stage finds them */
    clast_i32 loose;            /* 1: few records touch, and it pays to look which (on CPUs) */
    clast_i32 keeps_zeros;      /* 1: forces of a record stand where nobody else's do */
    clast_i32 step;             /* counts from the start of the batch */
    clast_i32 face_row;         /* row of the wall and mover tables for this step */
    clast_i32 mover_row;
    clast_i32 face_count;
    clast_i32 mover_count;
    clast_i32 heat_row;         /* row of the tables of heat for this step */
    clast_i32 bonding;          /* 1 in the step in which contacts bond at a given time */
    clast_i32 mixed;            /* for the host: the numbers are to be passed as pairs of floats */
    clast_i32 spare;
} clast_launch;

/* Written by stages that find something; the host reads it once a batch. */
typedef struct clast_control {
    clast_i32 halt_step; /* stages of this step and later ones return at once */
    clast_i32 reason;    /* bits: CLAST_HALT_* */
    clast_i32 spare[2];
} clast_control;

/* A part of a step: blocks of records through the pair stage, or blocks of grains through the particle stage. */
typedef struct clast_piece {
    clast_i32 pairs; /* 1: records */
    clast_i32 first, count;
    clast_i32 force_shift;
} clast_piece;

#define CLAST_TEAM_MAX 64  /* members */
#define CLAST_PHASES_MAX 3

/* What a team does between two meetings: pieces that it shares, or streams, each of them some pieces one after the other by one member. */
typedef struct clast_phase {
    clast_i32 streams; /* 0: shared pieces */
    clast_i32 first, end; /* pieces, or streams */
    clast_i32 units;   /* what members take: work-items of the two stages, or streams */
} clast_phase;

#define CLAST_TEAM_APART 32 /* words between what different members write all the time: two cache lines */

typedef struct clast_phases {
    clast_i32 count;
    clast_phase phase[CLAST_PHASES_MAX];
    clast_i32 stream[CLAST_TEAM_MAX + 1]; /* first piece of every stream; behind the last, where it ends */
} clast_phases;

/* Work-groups that go through many steps together (kernels/stage/by_blocks.cl). All zero before each launch. */
typedef struct clast_team {
    clast_i32 arrived; /* work-groups that have begun */
    clast_i32 closed;  /* 1: all steps are done */
    clast_i32 room[CLAST_TEAM_APART - 2];
    clast_i32 waiting; /* members that have come to the next meeting */
    clast_i32 room2[CLAST_TEAM_APART - 1];
    clast_i32 state;   /* meetings held, and members */
    clast_i32 room3[CLAST_TEAM_APART - 1];
    clast_i32 taken[CLAST_TEAM_MAX * CLAST_TEAM_APART]; /* of each member's part of a piece, what has been begun */
} clast_team;

#define CLAST_HALT_TRAVEL 1
#define CLAST_HALT_LEFT 2

#define CLAST_FACE_PLANE 0
#define CLAST_FACE_RECTANGLE 1
#define CLAST_FACE_DISC 2
#define CLAST_FACE_ROUND 3     /* a cylinder, or a cone */
#define CLAST_FACE_ROUND_FAR 4 /* a cone as seen across its axis */

/* A face of a wall at one step. A plane: origin and unit normal towards the grains. A rectangle: origin at its centre, unit edges e1, e2
 * and half lengths `extent`. A disc: extent[0] is the radius. A round face: origin on the axis at the first end, `normal` along the axis,
 * extent holds the radii at both ends, and its meridian, from end to end, is `slant_length` long and runs `slant` (along the axis, off it). */
typedef struct clast_face {
    clast_f64 origin[3];
    clast_f64 normal[3];
    clast_f64 e1[3];
    clast_f64 e2[3];
    clast_f64 extent[2];
    clast_f64 slant[2];
    clast_f64 slant_length;
    clast_f64 velocity[3]; /* of the point of the wall at `pivot` */
    clast_f64 spin[3];
    clast_f64 pivot[3];    /* torques on the wall are about this point */
    clast_i32 shape;
    clast_i32 party;       /* index of the named wall among materials and walls */
    clast_i32 wall;
    clast_i32 drive;       /* index of the servo that moves it beside its prescribed motion, or -1 */
} clast_face;

/* A wall, or a group of walls, that keeps a force: it has moved `shift` along `direction`. */
typedef struct clast_servo {
    clast_f64 direction[3];
    clast_f64 target;        /* force, N */
    clast_f64 mass, damping; /* kg, N s/m */
    clast_f64 speed_max;
    clast_f64 unit, inverse_unit; /* forces are summed in whole numbers of this, N */
    clast_f64 shift, velocity;
    clast_f64 built;         /* shift when the table was built */
    clast_f64 travel_max;    /* way since then that asks for a new table */
    clast_f64 force;         /* with which the bed pushed back in the last step */
    clast_f64 fastest;       /* speed since it last turned round */
    clast_i32 reversals;     /* turns from more than half of the largest speed */
    clast_i32 live;
} clast_servo;

/* A prescribed motion over one step: x -> pivot + R (x - pivot) + shift; at its end the velocity is velocity + spin x (x - pivot_end). */
typedef struct clast_mover {
    clast_f64 shift[3];
    clast_f64 pivot[3];
    clast_f64 pivot_end[3];
    clast_f64 axis[3];
    clast_f64 sine, versine; /* of the angle turned in the step: sin, 1 - cos */
    clast_f64 velocity[3];
    clast_f64 spin[3];
} clast_mover;

/* What surrounds the bed at one step. */
typedef struct clast_environment {
    clast_f64 temperature;     /* K */
    clast_f64 gas_velocity[3]; /* m/s */
} clast_environment;

#define CLAST_PROFILE_MAX 64

/* A table along an axis: up to three components at rising places. */
typedef struct clast_profile {
    clast_f64 at[CLAST_PROFILE_MAX]; /* m */
    clast_f64 value[3][CLAST_PROFILE_MAX];
    clast_i32 axis;
    clast_i32 count; /* 0: no table */
} clast_profile;

#define CLAST_WALL_ADIABATIC 0
#define CLAST_WALL_TEMPERATURE 1
#define CLAST_WALL_FLUX 2

/* The heat of a face of a wall at one step. */
typedef struct clast_wall_heat {
    clast_f64 temperature; /* K */
    clast_f64 flux;        /* W into the grains that touch the wall */
    clast_f64 quantum;     /* 1/m2: areas are summed as whole numbers of its inverse, so that their order does not matter */
    clast_i32 kind;
    clast_i32 wall;
} clast_wall_heat;

/* A group of grains that is heated or whose temperature is prescribed, over one step. */
typedef struct clast_group_heat {
    clast_f64 temperature; /* at the end of the step, K */
    clast_f64 heat;        /* into each grain, W */
    clast_i32 prescribed;
    clast_i32 spare;
} clast_group_heat;

#define CLAST_BEAM_TOP_HAT 0
#define CLAST_BEAM_GAUSSIAN 1

/* A beam that heats, at one step. */
typedef struct clast_beam {
    clast_f64 position[3];  /* of a point of its axis */
    clast_f64 direction[3]; /* unit vector */
    clast_f64 intensity;    /* on the axis, W/m2 */
    clast_f64 radius;       /* m; of a Gaussian beam where the intensity is 1/e2 of that on the axis */
    clast_f64 reach;        /* 1/m: attenuation of a laser, inverse of the largest depth of a burner */
    clast_i32 law;          /* index of its law: laser, burner */
    clast_i32 profile;
    clast_i32 side;         /* which of the directions that depths are kept for */
    clast_i32 spare;
} clast_beam;

#define CLAST_BEAM_SIDES_MAX 4

/* Columns along one direction of beams, in which the surface of the bed is looked for. */
typedef struct clast_columns {
    clast_f64 direction[3], across[3], beside[3]; /* an orthonormal set */
    clast_f64 origin[3];
    clast_f64 inverse_width, inverse_quantum; /* 1/m */
    clast_i32 first_u, first_v, count_u, count_v;
    clast_i32 first; /* of its columns among those of all directions */
    clast_i32 spare;
} clast_columns;

/* What is added up for each grain, J. */
#define CLAST_TALLY_SOURCES 0
#define CLAST_TALLY_CONVECTION 1
#define CLAST_TALLY_RADIATION 2
#define CLAST_TALLY_WALLS 3
#define CLAST_TALLY_ABSORBED 4 /* the part of the sources' that beams brought */
#define CLAST_TALLY_DISSIPATION 5
#define CLAST_TALLIES 6

/* Places of a table of a property against temperature. */
#define CLAST_TABLE_PLACES 32

#define CLAST_LEVELS_MAX 12

/* One level of the cell grid: radii within a factor of two. Coordinates wrap at `cells`, so that no position is outside. */
typedef struct clast_level {
    clast_f64 inverse_size[3]; /* 1/m */
    clast_i32 cells[3];
    clast_i32 first_cell;
} clast_level;

typedef struct clast_grid {
    clast_f64 origin[3];
    clast_f64 radius_max;
    clast_f64 skin;        /* with the gap over which laws act */
    clast_f64 wall_share;  /* of its radius by which a grain looks further for walls */
    clast_level level[CLAST_LEVELS_MAX];
    clast_i32 level_count;
    clast_i32 cell_count; /* of all levels; one more bucket holds what has left */
    clast_i32 drop_outside; /* grains outside low..high go to the last bucket */
    clast_i32 spare;
} clast_grid;

/* What builds a table, by the names of the kernels that do one of it each; the first two stand for what a queue does by itself. On a CPU a list of
 * them goes in one launch (kernels/stage/table_phases.cl). */
#define CLAST_TABLE_KERNELS(X)                                                                                                                       \
    X(table_set)                                                                                                                                     \
    X(table_copy)                                                                                                                                    \
    X(scan_whole) X(scan_chunks) X(scan_sums) X(scan_write) X(table_bin) X(table_order) X(table_order_cells) X(table_permute) X(table_count)         \
    X(table_count_walls) X(table_fill) X(table_fill_walls) X(table_pad) X(table_widths) X(table_totals) X(table_slots) X(table_sort_slots) X(table_match) X(table_carry) \
    X(table_last_records) X(table_releases) X(table_place) X(table_bond_inverse) X(table_bond_count) X(table_bond_fill)
#define CLAST_TABLE_KIND(name) CLAST_KIND_##name,
enum clast_table_kind { CLAST_TABLE_KERNELS(CLAST_TABLE_KIND) CLAST_TABLE_KINDS };

#define CLAST_TABLE_PHASES_MAX 96   /* in a list */
#define CLAST_TABLE_MEMORIES 48     /* buffers of a list */
#define CLAST_TABLE_ARGUMENTS 14    /* buffers of a phase */
#define CLAST_TABLE_NUMBERS 5
#define CLAST_TABLE_EACH_NUMBER(X) X(0) X(1) X(2) X(3) X(4)
#define CLAST_TABLE_EACH_ARGUMENT(X) X(0) X(1) X(2) X(3) X(4) X(5) X(6) X(7) X(8) X(9) X(10) X(11) X(12) X(13)
#define CLAST_TABLE_EACH_MEMORY(X)                                                                                                       \
    CLAST_TABLE_EACH_ARGUMENT(X)                                                                                                         \
    X(14) X(15) X(16) X(17) X(18) X(19) X(20) X(21) X(22) X(23) X(24) X(25) X(26) X(27) X(28) X(29) X(30) X(31) X(32) X(33) X(34) X(35)   \
    X(36) X(37) X(38) X(39) X(40) X(41) X(42) X(43) X(44) X(45) X(46) X(47)

/* A phase: its work-items, so many to a unit of a team, and the arguments of the kernel of that name, in their order: which of the list's buffers,
 * and numbers. */
typedef struct clast_table_phase {
    clast_i64 number[CLAST_TABLE_NUMBERS];
    clast_i32 kind, items, unit_items;
    clast_i32 memory[CLAST_TABLE_ARGUMENTS];
    clast_i32 spare;
} clast_table_phase;

typedef struct clast_table_list {
    clast_team team; /* zero */
    clast_grid grid; /* stands for a buffer behind all others */
    clast_table_phase phase[CLAST_TABLE_PHASES_MAX];
} clast_table_list;

#endif
