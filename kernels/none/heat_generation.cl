/* heat generation: none. */
INLINE real generation_heat(const grain *g)
{
    (void)g;
    return R(0.0);
}
