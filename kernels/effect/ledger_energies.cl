/* ledger: where the mechanical energy goes. Every record writes what it dissipates and what work is done on it in this step; every grain adds
 * up those of the records that it owns, in slot order, and what acts on the grain alone (docs/theory.md, "The energy ledger"). */
#define LEDGER_PAIR_FIELDS(READ, WRITE) WRITE(real, record_energy)
#define LEDGER_PARTICLE_FIELDS(READ, WRITE) \
    READ(real, record_energy) WRITE(exact, dissipated) WRITE(exact, work_contacts) WRITE(exact, work_grains)
#define LEDGER_LOAD(launch, k, s) (s).walls = R(0.0)
#define LEDGER_STORE(launch, k, s)                                                                \
    do {                                                                                          \
        STORE3(record_energy, (launch)->record_stride, k, (s).dissipated);                        \
        AT(record_energy, (launch)->record_stride, 3, k) = (s).walls;                             \
        AT(record_energy, (launch)->record_stride, 4, k) = (s).stiffness;                         \
    } while (0)

typedef struct ledger_state {
    vec3 dissipated;          /* normal, tangential, rolling */
    real walls, stiffness;    /* work of the wall on its grain; of stiffnesses that change under a stretched spring */
} ledger_state;

INLINE void ledger_contact(ledger_state *s, dissipation lost)
{
    s->dissipated = v3(lost.normal, lost.tangential, lost.rolling);
    s->stiffness = lost.stiffness;
}

INLINE void ledger_wall(ledger_state *s, real work)
{
    s->walls = work;
}

#define LEDGER_ADD(sum, i, v) SET_GRAIN3(sum, i, precise3_add(PRECISE_GRAIN3(sum, i), precise3_from(v)))

/* What the records lose that grain i owns, and the work on them. */
#define LEDGER_GATHER(launch, i, lost, work)                                                  \
    do {                                                                                      \
        uint first = slot_offset[(i) / CLAST_BLOCK], end = slot_offset[(i) / CLAST_BLOCK + 1]; \
        for (uint s = first; s < end; s += CLAST_BLOCK) {                                     \
            int entry = slots[s + (i) % CLAST_BLOCK];                                         \
            if (entry == 0)                                                                   \
                break;                                                                        \
            if (entry < 0)                                                                    \
                continue;                                                                     \
            lost = add(lost, LOAD3(record_energy, (launch)->record_stride, entry - 1));       \
            work.x += AT(record_energy, (launch)->record_stride, 3, entry - 1);               \
            work.y += AT(record_energy, (launch)->record_stride, 4, entry - 1);               \
            EXPANSION_GATHER(launch, entry - 1, work.z);                                      \
        }                                                                                     \
    } while (0)

#define LEDGER_ADVANCE(launch, i, step)                              \
    do {                                                             \
        vec3 lost = v3(R(0.0), R(0.0), R(0.0)), work = lost;         \
        LEDGER_GATHER(launch, i, lost, work);                        \
        work.z += (step)->grown;                                     \
        LEDGER_ADD(dissipated, i, lost);                             \
        LEDGER_ADD(work_contacts, i, work);                          \
        LEDGER_ADD(work_grains, i, ledger_grain(launch, step));      \
    } while (0)

/* The half step that brings velocities to the time of the positions: added where it is taken for good, else left in `now`, nine numbers a grain. */
#define LEDGER_HALF_STEP(launch, i, step, now, ends)                         \
    do {                                                                     \
        if (ends)                                                            \
            LEDGER_ADVANCE(launch, i, step);                                 \
        else {                                                               \
            vec3 lost = v3(R(0.0), R(0.0), R(0.0)), work = lost;             \
            LEDGER_GATHER(launch, i, lost, work);                            \
            SET_GRAIN3(now, 3 * (i), precise3_from(lost));                   \
            SET_GRAIN3(now, 3 * (i) + 1, precise3_from(work));               \
            SET_GRAIN3(now, 3 * (i) + 2, precise3_from(ledger_grain(launch, step))); \
        }                                                                    \
    } while (0)

/* Gravity, background damping (what it takes out), and what holds or moves a grain as prescribed. Over a step the kinetic energy changes by
 * the forces times the mean of the velocities before and after. */
INLINE vec3 ledger_grain(const clast_launch *launch, const grain_step *g)
{
    real dt = g->span;
    vec3 v = scale(R(0.5), add(g->velocity, g->velocity_next)), w = scale(R(0.5), add(g->spin, g->spin_next));
    vec3 weight = scale(g->mass, from3(launch->gravity));
    if (!g->prescribed) {
        real drag = dot3(sub(g->force, g->force_damped), v) + dot3(sub(g->torque, g->torque_damped), w);
        return v3(dt * dot3(weight, v), dt * drag, R(0.0));
    }
    vec3 dv = sub(g->velocity_next, g->velocity), dw = sub(g->spin_next, g->spin);
    real gained = g->mass * dot3(dv, v) + g->inertia * dot3(dw, w);
    return v3(dt * dot3(weight, v), R(0.0), gained - dt * (dot3(g->force, v) + dot3(g->torque, w)));
}
