/* How much temperatures change: from look to look where grains move, and from round to round where stages are repeated. */
#ifndef CLAST_HOST_STEADY_H
#define CLAST_HOST_STEADY_H
#include "simulation.h"

/* Temperatures at an earlier moment, by permanent id. */
typedef struct temperature_look {
    double *value; /* NULL: none yet */
    double time;
} temperature_look;

/* Rounds of stages so far. */
typedef struct stage_rounds {
    int64_t round;
    double range; /* of temperatures that frozen stages knew, K */
    temperature_look last;
} stage_rounds;

/* Steps between two looks at the rates of temperatures in a stage that moves. */
int64_t steady_interval(const scene_stage *stage);
/* Keeps the temperatures of now and finds their largest change since the last look, K, and the time since; infinite at the first. */
status look_at_temperatures(simulation *sim, temperature_look *last, double *change, double *span, failure *why);
/* At the end of a stage that repeats others: whether there is another round. `text` says how far this one has come. */
status rounds_end(stage_rounds *rounds, simulation *sim, bool *again, char *text, size_t size, failure *why);

void look_free(temperature_look *look);
void look_save(const temperature_look *look, const simulation *sim, const char *name, bundle *out);
status look_load(temperature_look *look, const simulation *sim, const char *name, const bundle *in, failure *why);
void rounds_save(const stage_rounds *rounds, const simulation *sim, bundle *out);
status rounds_load(stage_rounds *rounds, const simulation *sim, const bundle *in, const char *path, failure *why);

#endif
