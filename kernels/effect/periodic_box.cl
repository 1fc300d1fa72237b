/* periodic: nearest image, and positions kept inside the box. The length of a direction that is not periodic is 0, which
 * changes nothing. */
/* Without comparisons: pocl packs those of x and y into one, and then no longer vectorises over pairs. */
INLINE precise periodic_nearest1(precise d, exact stored)
{
    precise length = precise_load(stored);
    return precise_image(d, rint(rounded(d) * (R(1.0) / (rounded(length) + R(1e-30)))), length);
}

INLINE precise3 periodic_nearest(const clast_launch *launch, precise3 d)
{
    return precise3_of(periodic_nearest1(d.x, launch->length[0]), periodic_nearest1(d.y, launch->length[1]),
                       periodic_nearest1(d.z, launch->length[2]));
}

INLINE precise periodic_wrap1(precise x, exact stored_low, exact stored_length)
{
    precise low = precise_load(stored_low), length = precise_load(stored_length);
    x = precise_less(x, precise_add(low, length)) ? x : precise_sub(x, length);
    return precise_less(x, low) ? precise_add(x, length) : x;
}

INLINE precise3 periodic_wrap(const clast_launch *launch, precise3 x)
{
    return precise3_of(periodic_wrap1(x.x, launch->low[0], launch->length[0]), periodic_wrap1(x.y, launch->low[1], launch->length[1]),
                       periodic_wrap1(x.z, launch->low[2], launch->length[2]));
}
