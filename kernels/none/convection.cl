/* convection: none. */
INLINE real convection_coefficient(const grain *g, real temperature)
{
    (void)g;
    (void)temperature;
    return R(0.0);
}
