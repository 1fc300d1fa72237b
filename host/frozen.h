/* Heat while nothing moves: on the contact network as it stands, with steps of its own. */
#ifndef CLAST_HOST_FROZEN_H
#define CLAST_HOST_FROZEN_H
#include "simulation.h"

/* Takes steps of the stage's method until the time given, or `most` of them; the last one ends on that time exactly. */
status frozen_advance(simulation *sim, double until, int64_t most, failure *why);
/* Forgets what was found about the contacts; a new stage also forgets how it went so far. */
void frozen_forget(simulation *sim);
void frozen_restart(simulation *sim);
void frozen_free(simulation *sim);
/* Largest step of Euler's method under which no temperature leaves the interval of those around it, s; infinite where nothing draws any. */
status frozen_limit(simulation *sim, double *out, failure *why);
/* Refuses a stage that only a small rate of temperature ends, where a cluster of grains that nothing cools is heated for good. */
status frozen_refuse_endless(simulation *sim, failure *why);
/* The interval of temperatures that there are, and are prescribed, in the present stage, K. */
status frozen_range(simulation *sim, double *out, failure *why);
const char *frozen_method_name(heat_method method);

#endif
