/* environment: temperature, velocity of the gas, or both as tables along an axis; linear between the points, constant outside. */
#define ENVIRONMENT_PARTICLE_FIELDS(READ, WRITE) READ(clast_environment, environment) READ(clast_profile, profile)
#define ENVIRONMENT_AT(launch, g) environment_at(environment + (launch)->heat_row, profile, g)

/* Place of x in a rising table: the point before it, and the share of the way to the next. */
INLINE int environment_find(__global const clast_profile *p, real x, real *share)
{
    int k = 0, last = p->count - 1;
    while (k + 1 < last && x > number(p->at[k + 1]))
        k++;
    int next = last > k ? k + 1 : k;
    real from = number(p->at[k]), length = number(p->at[next]) - from;
    real s = length > R(0.0) ? (x - from) / length : R(0.0);
    *share = s < R(0.0) ? R(0.0) : (s > R(1.0) ? R(1.0) : s);
    return k;
}

INLINE real environment_blend(__global const clast_f64 *value, int k, int last, real share)
{
    real from = number(value[k]), to = number(value[k < last ? k + 1 : k]);
    return from + share * (to - from);
}

INLINE real environment_component(vec3 x, int axis)
{
    return axis == 0 ? x.x : (axis == 1 ? x.y : x.z);
}

/* profile[0]: temperature; profile[1]: velocity of the gas. A count of 0: the row's value holds. */
INLINE void environment_at(__global const clast_environment *row, __global const clast_profile *profile, grain *g)
{
    real share;
    g->surroundings = number(row->temperature);
    g->gas = from3(row->gas_velocity);
    if (profile[0].count > 0) {
        int k = environment_find(profile, environment_component(g->position, profile[0].axis), &share);
        g->surroundings = environment_blend(profile[0].value[0], k, profile[0].count - 1, share);
    }
    if (profile[1].count > 0) {
        int last = profile[1].count - 1, k = environment_find(profile + 1, environment_component(g->position, profile[1].axis), &share);
        g->gas = v3(environment_blend(profile[1].value[0], k, last, share), environment_blend(profile[1].value[1], k, last, share),
                    environment_blend(profile[1].value[2], k, last, share));
    }
}
