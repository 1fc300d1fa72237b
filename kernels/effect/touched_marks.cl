/* touched: in a loose bed, where most that stand near each other do not touch, the pair stage marks the grains that may have a contact, and the particle
 * stage sums over the slots of those alone, and takes the mark away. And the lots of a block of records (stage/by_blocks.cl) whose forces and histories
 * are 0 since the last step are a bit each, so that nobody stores them again: not in the first step of a batch, since a table, or another kernel, may have
 * moved what stood there, nor where chunks share the places of forces, nor in blocks of more lots than an int has bits. */
#define TOUCHED_PAIR_FIELDS(READ, WRITE) WRITE(int, touched) WRITE(uint, quiet_lots)
#define TOUCHED_PARTICLE_FIELDS(READ, WRITE) WRITE(int, touched)
#define TOUCHED_LOOKS(launch) ((launch)->loose)
#define TOUCHED_MARK(i) touched[i] = 1
#define TOUCHED_TAKE(launch, i) touched_take(launch, touched + (i))
#define TOUCHED_QUIET(launch, group) (LOTS <= 32 && (launch)->step > 0 && (launch)->keeps_zeros ? quiet_lots[group] : 0)
#define TOUCHED_SET_QUIET(group, lots) quiet_lots[group] = (lots)

INLINE bool touched_take(const clast_launch *launch, __global int *mark)
{
    if (!launch->loose)
        return true;
    bool marked = *mark != 0;
    if (marked)
        *mark = 0;
    return marked;
}
