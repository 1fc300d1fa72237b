/* Phases of a table for walls: none. */
#define TABLE_WALL_PHASES
