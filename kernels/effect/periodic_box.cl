/* periodic: nearest image, and positions kept inside the box. The length of a direction that is not periodic is 0, which
 * changes nothing. */
/* Without comparisons: pocl packs those of x and y into one, and then no longer vectorises over pairs. */
INLINE real periodic_nearest1(real d, real length)
{
    return d - length * rint(d * (R(1.0) / (length + R(1e-30))));
}

INLINE vec3 periodic_nearest(const clast_launch *launch, vec3 d)
{
    return v3(periodic_nearest1(d.x, (real)launch->length[0]), periodic_nearest1(d.y, (real)launch->length[1]),
              periodic_nearest1(d.z, (real)launch->length[2]));
}

INLINE real periodic_wrap1(real x, real low, real length)
{
    x = x >= low + length ? x - length : x;
    return x < low ? x + length : x;
}

INLINE vec3 periodic_wrap(const clast_launch *launch, vec3 x)
{
    return v3(periodic_wrap1(x.x, (real)launch->low[0], (real)launch->length[0]),
              periodic_wrap1(x.y, (real)launch->low[1], (real)launch->length[1]),
              periodic_wrap1(x.z, (real)launch->low[2], (real)launch->length[2]));
}
