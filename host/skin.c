/* How far beyond contact the contact table looks, where the scene does not say. */
#include "simulation.h"

#include <math.h>

/* The skin that balances the pairs it adds against the tables it saves, for grains that travel `used` a step (docs/performance.md): a step
 * costs about 1 + 2.7 s/r in a dense bed and less in a loose one, and with discs two thirds of that; a table about 10 steps, and in a small bed more,
 * since launches and waits count there; and it lasts s/(2 used) steps. The factor leans to the side of few tables, since it is the fast and loose beds that
 * need many. */
static double best_skin(const simulation *sim, double used)
{
    double commands = 1400.0 / (double)(sim->count > 140 ? sim->count : 140),
           weight = 24.0 * (1.0 + commands) * (sim->scene->dimensions == 2 ? 1.5 : 1.0);
    double best = fmin(fmax(sqrt(weight * used * sim->mean_radius), 0.02 * sim->mean_radius), 1.4 * sim->mean_radius);
    const domain *d = &sim->scene->domain;
    for (int c = 0; d->given && c < 3; c++)
        if (d->periodic[c])
            best = fmin(best, 0.5 * (d->high_m[c] - d->low_m[c]) - 2.0 * sim->radius_max);
    return best;
}

void skin_adapt(simulation *sim)
{
    contact_table *t = &sim->table;
    int64_t lasted = sim->step - sim->rebuild_step;
    if (t->skin_is_given || !t->built || lasted <= 0)
        return;
    double best = best_skin(sim, 0.5 * t->skin / (double)lasted);
    t->skin = fmin(fmax(best, t->skin / 1.5), t->skin * 1.5);
}

/* A table that lasts long has too many pairs: a smaller skin may do. Says so by *rebuild. */
status skin_look(simulation *sim, bool *rebuild, failure *why)
{
    contact_table *t = &sim->table;
    int64_t lasted = sim->step - sim->rebuild_step;
    double travel;
    *rebuild = false;
    if (t->skin_is_given || lasted < t->skin_look)
        return STATUS_OK;
    t->skin_look *= 2;
    TRY(table_travel(sim, &travel, why));
    double best = best_skin(sim, travel / (double)lasted);
    if (best < 0.6 * t->skin) {
        t->skin = best;
        *rebuild = true;
    }
    return STATUS_OK;
}
