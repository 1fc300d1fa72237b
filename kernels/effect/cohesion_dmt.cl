/* cohesion: Derjaguin, Muller and Toporov 1975; the contact pulls with 2 pi w r* while the two touch, whatever the overlap: N = [Hertz]_+ - 2 pi w r*.
 * The slot's functions are in cohesion_stateless.cl. Reads COHESION_PULL = 2 pi w (N/m). Writes the normal force. */
#ifndef COHESION_PULL
#define COHESION_PULL 0
#endif

INLINE real cohesion_pull(const contact *c)
{
    return c->overlap > R(0.0) ? c->value[COHESION_PULL] * c->radius_eff : R(0.0);
}

/* Work of the pull from touch on, over pull times overlap. */
#define COHESION_WORK R(1.0)
