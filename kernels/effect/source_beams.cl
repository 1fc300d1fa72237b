/* source: beams, Q = a pi r^2 sum over beams of I(distance from the axis) times what passes to the grain's depth (TM Eq. 29). Reads the beams
 * of the step, the depths below the bed's surface that stage/beam.cl found, and the absorptance; notes which beams meet a grain. A grain is
 * in a beam of even intensity when its centre is. */
#ifndef BEAM_COUNT
#define BEAM_COUNT 1
#define BEAM_SIDES 1
#endif
#ifndef BEAM_PASSES
#define BEAM_PASSES(b, s) R(1.0)
#endif
#ifndef SOURCE_ABSORPTANCE
#define SOURCE_ABSORPTANCE 0
#endif
#define SOURCE_PARTICLE_FIELDS(READ, WRITE) READ(clast_beam, beams) READ(real, depth) WRITE(int, beam_meets)
#define SOURCE_HEAT(launch, i, g) \
    source_heat(launch, beams + BEAM_COUNT * (size_t)(launch)->heat_row, depth + BEAM_SIDES * (size_t)(i), beam_meets, (i) < (launch)->particle_count, g)

/* W/m2 at a distance from the axis. */
INLINE real beam_intensity(const clast_beam *b, real distance2)
{
    real share = distance2 / (number(b->radius) * number(b->radius));
    if (b->profile == CLAST_BEAM_GAUSSIAN)
        return number(b->intensity) * exp(R(-2.0) * share);
    return share <= R(1.0) ? number(b->intensity) : R(0.0);
}

/* W */
INLINE real source_heat(const clast_launch *launch, __global const clast_beam *beam, __global const real *depth_of, __global int *meets, bool live,
                        const grain *g)
{
    real sum = R(0.0);
    for (int b = 0; b < BEAM_COUNT; b++) {
        const clast_beam one = beam[b];
        vec3 along = from3(one.direction);
        vec3 d = apart_vector(periodic_nearest(launch, apart_of(precise3_from(g->position), PRECISE3(one.position))));
        d = add_scaled(d, -dot3(d, along), along);
        real intensity = beam_intensity(&one, dot3(d, d));
        if (intensity <= R(0.0))
            continue;
        sum += intensity * BEAM_PASSES(&one, depth_of[one.side]);
        if (live && dot3(d, d) <= number(one.radius) * number(one.radius))
            meets[b] = 1; /* whoever writes, writes the same */
    }
    return g->value[SOURCE_ABSORPTANCE] * R(3.141592653589793) * g->radius * g->radius * sum;
}
