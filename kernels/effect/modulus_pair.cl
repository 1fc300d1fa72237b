/* modulus: each grain has a factor e = E(T)/E of its own, and Poisson's ratio is kept, so that shear follows. For a contact
 * 1/E* = a_i/e_i + a_j/e_j with a = (1 - nu^2)/E, so E* changes by e_i e_j/(s e_j + (1 - s) e_i), s = a_i/(a_i + a_j); G* likewise with shares of
 * its own. A wall is rigid: s = 1. Springs go with the factor, dampers with its root. The laws take all of it from here.
 * Reads MODULUS_SHARE_NORMAL, MODULUS_SHARE_TANGENTIAL, MODULUS_SHARE_ROLLING = s, MODULUS_MOST = largest factor there can be; and
 * modulus_factor, which the particle stage writes where it writes the temperature. */
#ifndef MODULUS_SHARE_NORMAL
#define MODULUS_SHARE_NORMAL 0
#define MODULUS_SHARE_TANGENTIAL 1
#define MODULUS_SHARE_ROLLING 2
#define MODULUS_MOST 3
#endif
#define MODULUS_PAIR_FIELDS(READ, WRITE) READ(real, modulus_factor)
#define MODULUS_PARTICLE_FIELDS(READ, WRITE) WRITE(real, modulus_factor)
#define MODULUS_OF(i) modulus_factor[i]
#define MODULUS_STORE(i, g, t) modulus_factor[i] = modulus_at(g, rounded(t))
/* Rate of change of the factor's logarithm, 1/s, where the temperature changes at `rate`: over the kelvin ahead. */
#define MODULUS_RATE(g, rate) ((rate)*sign(rate) * log(modulus_at(g, (g)->temperature + sign(rate)) / modulus_at(g, (g)->temperature)))
/* Contacts to be expected: as stiff as they can become. */
#define MODULUS_EXPECTED(c) (c)->modulus_i = (c)->modulus_j = (c)->value[MODULUS_MOST]

INLINE real modulus_shared(const contact *c, real share)
{
    return c->modulus_i * c->modulus_j / (share * c->modulus_j + (R(1.0) - share) * c->modulus_i);
}

INLINE real modulus_normal(const contact *c)
{
    return modulus_shared(c, c->value[MODULUS_SHARE_NORMAL]);
}

INLINE real modulus_tangential(const contact *c)
{
    return modulus_shared(c, c->value[MODULUS_SHARE_TANGENTIAL]);
}

INLINE real modulus_rolling(const contact *c)
{
    return modulus_shared(c, c->value[MODULUS_SHARE_ROLLING]);
}

INLINE real modulus_root(real factor)
{
    return sqrt(factor);
}

INLINE real modulus_inverse(real factor)
{
    return R(1.0) / factor;
}
