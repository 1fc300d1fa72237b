/* Phases of a table for bonds: none. */
#define TABLE_BOND_PHASES
