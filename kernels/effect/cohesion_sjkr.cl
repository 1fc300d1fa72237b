/* cohesion: simplified JKR; the adhesive term of JKR with Hertz's contact radius, N = [Hertz]_+ - sqrt(8 pi w E*) (r* d)^(3/4) while the two touch.
 * No hysteresis; the largest pull is 3/2 pi w r*, as for JKR. The slot's functions are in cohesion_stateless.cl.
 * Reads COHESION_PULL = sqrt(8 pi w E*). Writes the normal force. */
#ifndef COHESION_PULL
#define COHESION_PULL 0
#endif

INLINE real cohesion_pull(const contact *c)
{
    return modulus_root(modulus_normal(c)) * c->value[COHESION_PULL] * c->contact_radius * sqrt(c->contact_radius);
}

/* Work of the pull from touch on, over pull times overlap: 1/(1 + 3/4). */
#define COHESION_WORK R(0.57142857142857143)
