/* touched: every grain sums over its slots. */
#define TOUCHED_PAIR_FIELDS(READ, WRITE)
#define TOUCHED_PARTICLE_FIELDS(READ, WRITE)
#define TOUCHED_LOOKS(launch) false
#define TOUCHED_MARK(i) (void)0
#define TOUCHED_TAKE(launch, i) true
#define TOUCHED_QUIET(launch, group) 0u
#define TOUCHED_SET_QUIET(group, lots) (void)(lots)
