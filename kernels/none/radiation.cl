/* radiation: none. */
INLINE real radiation_coefficient(const grain *g, real temperature)
{
    (void)g;
    (void)temperature;
    return R(0.0);
}
