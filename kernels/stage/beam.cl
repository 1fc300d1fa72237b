/* How deep every grain lies below the bed's surface, as each direction of beams sees it: the distance from the highest top in the grain's own
 * column to its own top, against the beam. Columns stand along the beam and are fixed in space, one mean diameter wide. Heights are whole
 * numbers of a millionth of the mean diameter, so that the order in which grains are looked at does not matter. */

/* Height of a grain's top against the beam. */
INLINE int beam_top(const clast_columns *c, vec3 x, real r)
{
    real top = (r - dot3(from3(c->direction), sub(x, from3(c->origin)))) * number(c->inverse_quantum);
    return (int)clamp(rint(top), R(-2147483000.0), R(2147483000.0));
}

INLINE int beam_place(const clast_columns *c, vec3 across, vec3 d)
{
    return (int)floor(dot3(across, d) * number(c->inverse_width));
}

INLINE int beam_column(const clast_columns *c, vec3 x)
{
    vec3 d = sub(x, from3(c->origin));
    int u = beam_place(c, from3(c->across), d) - c->first_u, v = beam_place(c, from3(c->beside), d) - c->first_v;
    return c->first + v * c->count_u + u;
}

/* Lowest and highest place of a column in both directions, for every direction of beams: four numbers each. */
__kernel void beam_bounds(const clast_launch launch, __global const clast_columns *restrict columns, __global int *restrict bounds PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    if (i >= launch.particle_count)
        return;
    for (int s = 0; s < BEAM_SIDES; s++) {
        const clast_columns c = columns[s];
        vec3 d = sub(GRAIN_POLAR3(position, i), from3(c.origin));
        int u = beam_place(&c, from3(c.across), d), v = beam_place(&c, from3(c.beside), d);
        atomic_min(&bounds[4 * s], u);
        atomic_max(&bounds[4 * s + 1], u);
        atomic_min(&bounds[4 * s + 2], v);
        atomic_max(&bounds[4 * s + 3], v);
    }
}

__kernel void beam_surface(const clast_launch launch, __global const clast_columns *restrict columns, __global int *restrict surface PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    if (i >= launch.particle_count)
        return;
    vec3 x = GRAIN_POLAR3(position, i);
    for (int s = 0; s < BEAM_SIDES; s++) {
        const clast_columns c = columns[s];
        atomic_max(&surface[beam_column(&c, x)], beam_top(&c, x, GRAIN_RADIUS(i)));
    }
}

__kernel void beam_depth(const clast_launch launch, __global const clast_columns *restrict columns, __global const int *restrict surface,
                         __global real *restrict depth_out PARTICLE_DECLARE)
{
    int i = get_global_id(0);
    if (i >= launch.particle_count)
        return;
    vec3 x = GRAIN_POLAR3(position, i);
    for (int s = 0; s < BEAM_SIDES; s++) {
        const clast_columns c = columns[s];
        long below = (long)surface[beam_column(&c, x)] - (long)beam_top(&c, x, GRAIN_RADIUS(i));
        depth_out[BEAM_SIDES * (size_t)i + s] = (real)below / number(c.inverse_quantum);
    }
}
