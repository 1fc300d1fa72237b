/* heat steps: heat advances in every n-th step only. What contacts bring, and what they dissipate, adds up step by step (J) until then; what
 * surroundings and sources bring is that of the n-th step over the whole time. Reads and writes heat_waiting: contacts, walls among them, friction. */
#define HEAT_STEPS_PARTICLE_FIELDS(READ, WRITE) WRITE(exact, heat_waiting)
#define HEAT_STEPS_GATHER(launch, i, h) heat_steps_gather(heat_waiting + 3 * (size_t)(i), number((launch)->heat_span) > R(0.0), h)
#define HEAT_STEPS_WAITS(launch) !(number((launch)->heat_span) > R(0.0))
#define HEAT_STEPS_SPAN(launch) number((launch)->heat_span)

INLINE real heat_steps_add(__global exact *waiting, bool due, real more)
{
    precise sum = precise_add(precise_load(*waiting), precise_from(more));
    *waiting = precise_store(due ? precise_from(R(0.0)) : sum);
    return rounded(sum);
}

INLINE void heat_steps_gather(__global exact *waiting, bool due, grain_heat *h)
{
    h->contacts = heat_steps_add(waiting, due, h->contacts);
    h->walls = heat_steps_add(waiting + 1, due, h->walls);
    h->rubbed = heat_steps_add(waiting + 2, due, h->rubbed);
}
