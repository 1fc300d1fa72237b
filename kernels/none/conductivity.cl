/* conductivity: a constant of the material. */
#define CONDUCTIVITY_PAIR_FIELDS(READ, WRITE)
#define CONDUCTIVITY_PARTICLE_FIELDS(READ, WRITE)
#define RESISTIVITY_OF(i) R(1.0)
#define RESISTIVITY_STORE(i, g, t)

/* Factor of the conductance of two half-spaces, `share` the first one's share of the resistance. */
INLINE real conductivity_shared(const contact *c, real share)
{
    (void)c;
    (void)share;
    return R(1.0);
}
