/* What cohesion laws without history share: the stiffness of the contact bounds theirs from above. */
INLINE cohesion_state cohesion_expected(const contact *c)
{
    cohesion_state s = {0};
    (void)c;
    return s;
}

INLINE void cohesion_mode(const contact *c, const cohesion_state *s, mode *normal)
{
    (void)c;
    (void)s;
    (void)normal;
}
