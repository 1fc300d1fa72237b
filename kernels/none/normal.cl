/* normal: grains do not touch. */
#define NORMAL_STIFF 0
#define NORMAL_ENERGY_BY_RADIUS R(0.0)

INLINE void normal_force(const contact *c, response *out)
{
    (void)c;
    out->spring = out->damper = R(0.0);
}

INLINE real normal_energy(const contact *c)
{
    (void)c;
    return R(0.0);
}

INLINE mode normal_mode(const contact *c)
{
    (void)c;
    mode m = {R(0.0), R(0.0)};
    return m;
}
