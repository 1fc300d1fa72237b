/* orientation: unit quaternions, turned by the spin of the step and normalised. (TM Eq. 45, the Rodrigues vector, is singular at half a
 * turn.) Reads and writes orientation w x y z. */
#define ORIENTATION_PARTICLE_FIELDS(READ, WRITE) WRITE(real, orientation)
#define ORIENTATION_ADVANCE(launch, i, spin)                       \
    do {                                                           \
        __global real *now = orientation + 4 * (size_t)(i);        \
        quaternion q = {now[0], {now[1], now[2], now[3]}};         \
        q = orientation_turn(q, (spin), (real)(launch)->dt);           \
        now[0] = q.w;                                              \
        now[1] = q.v.x;                                            \
        now[2] = q.v.y;                                            \
        now[3] = q.v.z;                                            \
    } while (0)

typedef struct quaternion {
    real w;
    vec3 v;
} quaternion;

/* dq = (cos a/2, sin a/2 axis) with a = |w| dt, from the half-angle tangent series where a is small; exact to rounding below a = 0.5 by
 * the product form tan(a/2) ~ Pade; the result is normalised, so only the direction of the turn matters. */
INLINE quaternion orientation_turn(quaternion q, vec3 spin, real dt)
{
    vec3 halved = scale(R(0.5) * dt, spin);
    real h2 = dot3(halved, halved);
    /* tan(h)/h = (945 - 105 h^2 + h^4)/(945 - 420 h^2 + 15 h^4) */
    real t = (R(945.0) - R(105.0) * h2 + h2 * h2) / (R(945.0) - R(420.0) * h2 + R(15.0) * h2 * h2);
    vec3 b = scale(t, halved);
    quaternion r = {q.w - dot3(b, q.v), add(add_scaled(q.v, q.w, b), cross3(b, q.v))};
    real norm = R(1.0) / sqrt(r.w * r.w + dot3(r.v, r.v));
    r.w *= norm;
    r.v = scale(norm, r.v);
    return r;
}
