/* periodic: nearest image, and positions kept inside the box. The length of a direction that is not periodic is 0, which
 * changes nothing. */
/* Without comparisons: pocl packs those of x and y into one, and then no longer vectorises over pairs. */
INLINE real periodic_images(real d, real length)
{
    return rint(d * (R(1.0) / (length + R(1e-30))));
}

INLINE apart3 periodic_nearest(const clast_launch *launch, apart3 d)
{
    precise x = precise_load(launch->length[0]), y = precise_load(launch->length[1]), z = precise_load(launch->length[2]);
    vec3 v = apart_vector(d);
    vec3 n = v3(periodic_images(v.x, rounded(x)), periodic_images(v.y, rounded(y)), periodic_images(v.z, rounded(z)));
    return apart_image(d, n, x, y, z);
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
