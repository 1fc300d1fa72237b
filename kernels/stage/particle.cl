/* The particle stage: gathers the contacts of a grain in slot order, adds what acts on the grain itself, and advances it. Its kernel is in
 * by_items.cl or by_blocks.cl. */
#define PARTICLE_FIELDS(READ, WRITE)                                                                                              \
    READ(uint, slot_offset) READ(int, slots) READ(real, force) RADIUS_OWN(READ, WRITE) READ(real, mass) WRITE(exact, position) WRITE(exact, velocity)   \
    READ(exact, built_position) MOTION_PARTICLE_FIELDS(READ, WRITE) \
    ROTATION_PARTICLE_FIELDS(READ, WRITE) ORIENTATION_PARTICLE_FIELDS(READ, WRITE) TEMPERATURE_PARTICLE_FIELDS(READ, WRITE)                \
    SUBSTANCE_PARTICLE_FIELDS(READ, WRITE) TABLES_PARTICLE_FIELDS(READ, WRITE) CONDUCTIVITY_PARTICLE_FIELDS(READ, WRITE) RADIUS_PARTICLE_FIELDS(READ, WRITE) EXPANSION_PARTICLE_FIELDS(READ, WRITE) ENVIRONMENT_PARTICLE_FIELDS(READ, WRITE) CONDUCTION_PARTICLE_FIELDS(READ, WRITE)             \
    SOURCE_PARTICLE_FIELDS(READ, WRITE) HEAT_STEPS_PARTICLE_FIELDS(READ, WRITE) THERMAL_GROUP_PARTICLE_FIELDS(READ, WRITE) HEAT_TALLY_PARTICLE_FIELDS(READ, WRITE) MODULUS_PARTICLE_FIELDS(READ, WRITE) DISSIPATION_PARTICLE_FIELDS(READ, WRITE) DISSIPATION_HEAT_PARTICLE_FIELDS(READ, WRITE) LEDGER_PARTICLE_FIELDS(READ, WRITE)           \
    INTEGRATOR_PARTICLE_FIELDS(READ, WRITE) PACKED_PARTICLE_FIELDS(READ, WRITE) TOUCHED_PARTICLE_FIELDS(READ, WRITE)
#define PARTICLE_DECLARE PARTICLE_FIELDS(DECLARE_READ, DECLARE_WRITE)
#define PARTICLE_PASS PARTICLE_FIELDS(PASS, PASS)

/* Sums force, torque and heat over the slots of a grain; they end at the first empty one. */
INLINE void particle_gather(const clast_launch *launch, int block, int lane, vec3 *total, vec3 *moment, grain_heat *h PARTICLE_DECLARE)
{
    vec3 f = v3(R(0.0), R(0.0), R(0.0)), t = f;
    real heat_in = R(0.0), from_walls = R(0.0);
    uint first = slot_offset[block], end = slot_offset[block + 1];
    for (uint s = first; s < end; s += CLAST_BLOCK) {
        int entry = slots[s + lane];
        if (entry == 0)
            break;
        /* without a branch, which nobody could foretell */
        int other = entry >> 31, k = (entry ^ other) - other - 1;
        real sign = (real)(2 * other + 1);
        f = add_scaled(f, sign, LOAD_POLAR3(force, launch->record_stride, k));
        t = add(t, ROTATION_GATHER(launch, k, other));
        real flow = CONDUCTION_GATHER(launch, k, sign);
        heat_in += flow;
        from_walls += k >= launch->first_wall_place ? flow : R(0.0);
    }
    *total = f;
    *moment = t;
    h->contacts = heat_in;
    h->walls = from_walls;
}

/* A grain as its heat laws see it. */
INLINE void particle_grain(const clast_launch *launch, int i, grain *g PARTICLE_DECLARE)
{
    g->position = GRAIN_POLAR3(position, i);
    g->velocity = GRAIN_POLAR3(velocity, i);
    g->radius = GRAIN_RADIUS(i);
    g->mass = mass[i];
    g->temperature = TEMPERATURE_OF_GRAIN(i);
    g->value = TEMPERATURE_CONSTANTS(SUBSTANCE_ROW(i));
    g->tables = TABLES_OF_GRAINS;
    g->surroundings = R(0.0);
    g->gas = v3(R(0.0), R(0.0), R(0.0));
    ENVIRONMENT_AT(launch, g);
}

/* One thermal step of grain i, from the flows at its start: `h` holds those of its contacts (W) and what they dissipate (J). What a prescribed
 * temperature takes comes from a source. Returns what the radius grows by. */
INLINE real particle_heat(const clast_launch *launch, int i, const grain *g, grain_heat *h PARTICLE_DECLARE)
{
    h->contacts = number(launch->dt) * h->contacts;
    h->walls = number(launch->dt) * h->walls;
    HEAT_STEPS_GATHER(launch, i, h);
    if (HEAT_STEPS_WAITS(launch))
        return R(0.0);
    real span = HEAT_STEPS_SPAN(launch), apart = g->surroundings - g->temperature;
    real absorbed = SOURCE_HEAT(launch, i, g), given = absorbed + generation_heat(g) + THERMAL_GROUP_HEAT(launch, i);
    h->convection = span * (convection_coefficient(g, g->temperature) * apart);
    h->radiation = span * (radiation_coefficient(g, g->temperature) * apart);
    h->absorbed = span * absorbed;
    real gain = h->contacts + span * given + (h->convection + h->radiation) + h->rubbed;
    precise after = temperature_after(TEMPERATURE_PRECISE(i), temperature_rise(g, gain));
    precise held = THERMAL_GROUP_TEMPERATURE(launch, i, after);
    grain then = *g;
    then.temperature = rounded(after);
    h->sources = span * given + temperature_heat(&then, rounded(precise_sub(held, after)));
    TEMPERATURE_STORE(i, held);
    MODULUS_STORE(i, g, held);
    RESISTIVITY_STORE(i, g, held);
    HEAT_TALLY_ADD(i, h);
    return RADIUS_STORE(i, g, held);
}

/* The temperature of grain i once it has what its contacts dissipate in the half step by which velocities stand behind the positions: the records
 * hold that after a probe. `h` gets the heat, J. */
INLINE precise particle_heat_ahead(const clast_launch *launch, int i, const grain *g, grain_heat *h PARTICLE_DECLARE)
{
    DISSIPATION_HEAT_GATHER(launch, i, h->rubbed);
    if (!THERMAL_GROUP_HOLDS(launch, i))
        return temperature_after(TEMPERATURE_PRECISE(i), temperature_rise(g, h->rubbed));
    h->sources = -h->rubbed;
    return TEMPERATURE_PRECISE(i);
}

/* What moves of a grain, with all its bits. */
typedef struct moving {
    precise3 position, built_position, velocity, spin;
    precise3 kept_velocity, kept_spin; /* what the integrator advances */
} moving;

INLINE void moving_load(const clast_launch *launch, int i, moving *g PARTICLE_DECLARE)
{
    g->position = PRECISE_GRAIN_POLAR3(position, i);
    g->built_position = PRECISE_GRAIN_POLAR3(built_position, i);
    g->velocity = PRECISE_GRAIN_POLAR3(velocity, i);
    g->spin = ROTATION_PRECISE(launch, i);
    g->kept_velocity = INTEGRATOR_VELOCITY(i, g->velocity);
    g->kept_spin = INTEGRATOR_SPIN(i, g->spin);
}

/* One step of grain i, whose radius has grown; returns the square of its displacement since the table was built, relative to the common one, its
 * growth included. */
INLINE real particle_advance(const clast_launch *launch, int i, const moving *g, real grown, vec3 f, vec3 t PARTICLE_DECLARE)
{
    real dt = number(launch->dt), kick = number(launch->kick), r = GRAIN_RADIUS(i);
    real m = mass[i], inertia = R(0.4) * m * r * r;
    int mover_i = MOTION_GRAIN(i);
    precise3 x = g->position, v = g->velocity, w = RADIUS_SPIN(i, g->spin, grown), turning = RADIUS_SPIN(i, g->kept_spin, grown);
    __global const clast_mover *row = MOTION_ROW(launch);
    f = add_scaled(f, m, POLAR3(launch->gravity));
    vec3 damped = body_force(f, rounded3(v), m), damped_t = body_force(t, rounded3(w), inertia);
    vec3 a = scale(R(1.0) / m, damped);
    precise3 v1 = integrate_velocity(g->kept_velocity, a, kick);
    precise3 w1 = rotation_advance(turning, damped_t, inertia, kick);
    precise3 x1 = motion_position(row, mover_i, integrate_position(x, v1, dt), x);
    precise3 v2 = motion_velocity(row, mover_i, INTEGRATOR_AHEAD(v1, integrate_velocity(v1, a, R(0.5) * dt)), x1);
    precise3 w2 = motion_spin(row, mover_i, INTEGRATOR_AHEAD(w1, rotation_advance(w1, damped_t, inertia, R(0.5) * dt)));
    grain_step step = {m, inertia, kick, rounded3(g->kept_velocity), rounded3(motion_velocity(row, mover_i, v1, x1)),
                       rounded3(turning), rounded3(motion_spin(row, mover_i, w1)), f, damped, t, damped_t, mover_i >= 0,
                       RADIUS_SPIN_WORK(i, rounded3(g->kept_spin), grown, inertia)};
    (void)step;
    INTEGRATOR_KEEP_VELOCITY(i, motion_velocity(row, mover_i, v1, x1));
    INTEGRATOR_KEEP_SPIN(i, motion_spin(row, mover_i, w1));
    w1 = motion_spin(row, mover_i, w1);
    x1 = periodic_wrap(launch, x1);
    SET_GRAIN_POLAR3(position, i, x1);
    SET_GRAIN_POLAR3(velocity, i, v2);
    ROTATION_STORE(launch, i, w2);
    ORIENTATION_ADVANCE(launch, i, rounded3(w1));
    DISSIPATION_KEEP(i, &step);
    LEDGER_ADVANCE(launch, i, &step);
    apart3 since_built = apart_less(apart_of(x1, g->built_position), PRECISE_POLAR3(launch->drift));
    vec3 moved = apart_vector(periodic_nearest(launch, since_built));
    GROWTH_KEEP(i, grown);
    return RADIUS_TRAVEL(i, dot3(moved, moved));
}

/* A grain that has used up half the skin, or has left the domain, stops the batch after this step. Whoever writes, writes the same. */
INLINE bool particle_is_far(const clast_launch *launch, int i, real travel2)
{
    return i < launch->particle_count && !(travel2 <= number(launch->travel2));
}

INLINE void particle_halt(const clast_launch *launch, __global clast_control *control)
{
    control->reason = CLAST_HALT_TRAVEL;
    control->halt_step = launch->step + 1;
}

/* Heat, then motion, from what the contacts gave; returns whether the grain is far from where the table found it. */
INLINE bool particle_step(const clast_launch *launch, int i, const moving *m, vec3 f, vec3 t, grain_heat *h PARTICLE_DECLARE)
{
    grain g;
    particle_grain(launch, i, &g PARTICLE_PASS);
    h->rubbed = R(0.0);
    DISSIPATION_HEAT_GATHER(launch, i, h->rubbed);
    real grown = particle_heat(launch, i, &g, h PARTICLE_PASS);
    return particle_is_far(launch, i, particle_advance(launch, i, m, grown, f, t PARTICLE_PASS));
}
