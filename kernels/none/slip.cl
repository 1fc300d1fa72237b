/* slip: no friction, nothing slips. */
#define SLIP_PAIR_FIELDS(READ, WRITE)
#define SLIP_LOAD(launch, k, s) (s).sliding = R(0.0)
#define SLIP_STORE(launch, k, s)

typedef struct slip_state {
    real sliding;
} slip_state;
