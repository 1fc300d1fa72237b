/* softening: work on the normal spring of a modulus that changes under the overlap. History: factor of the modulus in the last step; 0 where the
 * two did not touch. */
#define SOFTENING_PAIR_FIELDS(READ, WRITE) WRITE(real, softened)
#define SOFTENING_LOAD(launch, k, s) (s).factor = softened[k]
#define SOFTENING_STORE(launch, k, s) softened[k] = (s).factor

typedef struct softening_state {
    real factor;
} softening_state;

INLINE real softening_work(const contact *c, softening_state *s)
{
    bool touches = c->overlap > R(0.0), touched = s->factor > R(0.0);
    real now = modulus_normal(c), before = touched ? s->factor : now;
    s->factor = touches ? now : R(0.0);
    return touches ? normal_energy(c) * (R(1.0) - before / now) : R(0.0);
}
