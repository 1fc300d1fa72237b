/* The pair stage: force and torque of every record, and its history one step on. Its kernel is in by_items.cl or by_blocks.cl. */
#define PAIR_LOAD_STATE(launch, k, s)             \
    BOND_LOAD(launch, k, (s).bond);               \
    COHESION_LOAD(launch, k, (s).cohesion);       \
    SLIP_LOAD(launch, k, (s).slip);               \
    TANGENTIAL_LOAD(launch, k, (s).tangential);   \
    ROLLING_LOAD(launch, k, (s).rolling);         \
    SOFTENING_LOAD(launch, k, (s).softening);     \
    EXPANSION_LOAD(launch, k, (s).expansion);     \
    DISSIPATION_LOAD(launch, k, (s).dissipation); \
    LEDGER_LOAD(launch, k, (s).ledger)
#define PAIR_STORE_STATE(launch, k, s)            \
    BOND_STORE(launch, k, (s).bond);              \
    COHESION_STORE(launch, k, (s).cohesion);      \
    SLIP_STORE(launch, k, (s).slip);              \
    TANGENTIAL_STORE(launch, k, (s).tangential);  \
    ROLLING_STORE(launch, k, (s).rolling);        \
    SOFTENING_STORE(launch, k, (s).softening);    \
    EXPANSION_STORE(launch, k, (s).expansion);    \
    DISSIPATION_STORE(launch, k, (s).dissipation);\
    PAIR_STORE_WORK(launch, k, s)
/* What the ledger asks of this step alone. */
#define PAIR_STORE_WORK(launch, k, s)               \
    EXPANSION_STORE_WORK(launch, k, (s).expansion); \
    LEDGER_STORE(launch, k, (s).ledger)

/* The rest of a record once its geometry is known; `account` may add to the ledger, `keep` writes the history. */
#define PAIR_LAWS(keep, account)                                             \
    c.dt = number(launch->dt);                                           \
    c.elapsed = number(INTEGRATOR_ELAPSED(launch));                      \
    c.span = number(launch->kick);                                       \
    c.value = contact_constants + c.class * CONTACT_CONSTANTS;           \
    PAIR_LOAD_STATE(launch, k, s);                                       \
    contact_laws(&c, &s, &out);                                          \
    vec3 total = add_scaled(out.tangential, -out.normal, c.n);           \
    vec3 lever = cross3(c.n, out.tangential);                            \
    account;                                                             \
    keep(launch, k, s)
#define PAIR_WORK_OF_WALL ledger_wall(&s.ledger, c.span *(dot3(total, touch.velocity) + dot3(out.rolling, c.spin_j)))
#define PAIR_PLACE (k - launch->force_shift)
/* Force and torques of a record to its place. Steps by blocks have a way of their own (stage/wrenches_together.cl). */
#define PAIR_PUT(on_other)                                                                          \
    STORE_POLAR3(force, launch->record_stride, PAIR_PLACE, total);                                  \
    ROTATION_STORE_TORQUE(launch, PAIR_PLACE, add_scaled(out.rolling, c.arm_i, lever), on_other)

/* The rest of a pair of grains, whose contact `c` is known. */
#define PAIR_FROM_CONTACT(keep, put)                                                                \
    do {                                                                                            \
        contact_state s;                                                                            \
        response out;                                                                               \
        PAIR_LAWS(keep, (void)0);                                                                   \
        DISSIPATION_HEAT_STORE(launch, k, out.lost, R(0.5));                                        \
        CONDUCTION_STORE(launch, PAIR_PLACE, conduction_conductance(&c) * (c.temperature_j - c.temperature_i)); \
        put(add_scaled(scale(R(-1.0), out.rolling), c.arm_j, lever));                               \
    } while (0)

#define PAIR_OF_GRAINS(name, keep)                                                                  \
    INLINE void name(const clast_launch *launch, int k PAIR_DECLARE)                                \
    {                                                                                               \
        contact c;                                                                                  \
        contact_of_grains(launch, k, &c PAIR_PASS);                                                 \
        PAIR_FROM_CONTACT(keep, PAIR_PUT);                                                          \
    }

/* `more`: what `put` asks for, as arguments with a comma before each. */
#define PAIR_OF_WALL(form, name, keep, put, more)                                                   \
    form void name(const clast_launch *launch, int k more PAIR_DECLARE)                             \
    {                                                                                               \
        contact c;                                                                                  \
        contact_state s;                                                                            \
        response out;                                                                               \
        wall_touch touch;                                                                           \
        contact_of_wall(launch, k, &c, &touch PAIR_PASS);                                           \
        PAIR_LAWS(keep, PAIR_WORK_OF_WALL);                                                         \
        DISSIPATION_HEAT_STORE(launch, k, out.lost, R(1.0));                                        \
        CONDUCTION_STORE(launch, PAIR_PLACE, WALL_HEAT_FLOW(launch, other[k], &c, conduction_wall_conductance(&c))); \
        put(sub(cross3(total, rounded3(precise3_sub(touch.point, touch.pivot))), out.rolling));     \
    }

PAIR_OF_GRAINS(pair_of_grains, PAIR_STORE_STATE)
PAIR_OF_WALL(OUTLINE, pair_of_wall, PAIR_STORE_STATE, PAIR_PUT, )
PAIR_OF_GRAINS(pair_of_grains_as_is, PAIR_STORE_WORK)
PAIR_OF_WALL(OUTLINE, pair_of_wall_as_is, PAIR_STORE_WORK, PAIR_PUT, )
