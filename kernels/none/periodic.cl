/* periodic: no periodic direction. */
INLINE apart3 periodic_nearest(const clast_launch *launch, apart3 d)
{
    (void)launch;
    return d;
}

INLINE precise3 periodic_wrap(const clast_launch *launch, precise3 x)
{
    (void)launch;
    return x;
}
