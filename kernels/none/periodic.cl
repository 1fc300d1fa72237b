/* periodic: no periodic direction. */
INLINE vec3 periodic_nearest(const clast_launch *launch, vec3 d)
{
    (void)launch;
    return d;
}

INLINE vec3 periodic_wrap(const clast_launch *launch, vec3 x)
{
    (void)launch;
    return x;
}
