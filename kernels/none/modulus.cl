/* modulus: moduli are constants of the materials. */
#define MODULUS_PAIR_FIELDS(READ, WRITE)
#define MODULUS_PARTICLE_FIELDS(READ, WRITE)
#define MODULUS_OF(i) R(1.0)
#define MODULUS_STORE(i, g, t)
#define MODULUS_RATE(g, rate) R(0.0)
#define MODULUS_EXPECTED(c)

INLINE real modulus_normal(const contact *c)
{
    (void)c;
    return R(1.0);
}

INLINE real modulus_tangential(const contact *c)
{
    (void)c;
    return R(1.0);
}

INLINE real modulus_rolling(const contact *c)
{
    (void)c;
    return R(1.0);
}

INLINE real modulus_root(real factor)
{
    return factor;
}

INLINE real modulus_inverse(real factor)
{
    return factor;
}
