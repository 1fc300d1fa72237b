/* orientation: unit quaternions, turned by the spin of the step and normalised. (TM Eq. 45, the Rodrigues vector, is singular at half a
 * turn.) Reads and writes orientation w x y z. */
#define ORIENTATION_PARTICLE_FIELDS(READ, WRITE) WRITE(exact, orientation)
#define ORIENTATION_ADVANCE(launch, i, spin)                       \
    do {                                                           \
        __global exact *now = orientation + 4 * (size_t)(i);       \
        quaternion q = {precise_load(now[0]), PRECISE3(now + 1)};  \
        q = orientation_turn(q, (spin), number((launch)->dt));     \
        now[0] = precise_store(q.w);                               \
        now[1] = precise_store(q.v.x);                             \
        now[2] = precise_store(q.v.y);                             \
        now[3] = precise_store(q.v.z);                             \
    } while (0)

typedef struct quaternion {
    precise w;
    precise3 v;
} quaternion;

/* dq = (cos a/2, sin a/2 axis) with a = |w| dt, from the half-angle tangent series where a is small; exact to rounding below a = 0.5 by
 * the product form tan(a/2) ~ Pade; the result is normalised, so only the direction of the turn matters. */
INLINE quaternion orientation_turn(quaternion q, vec3 spin, real dt)
{
    vec3 halved = scale(R(0.5) * dt, spin);
    real h2 = dot3(halved, halved);
    /* tan(h)/h = (945 - 105 h^2 + h^4)/(945 - 420 h^2 + 15 h^4) */
    real t = (R(945.0) - R(105.0) * h2 + h2 * h2) / (R(945.0) - R(420.0) * h2 + R(15.0) * h2 * h2);
    precise3 b = precise3_from(scale(t, halved));
    precise3 turned = precise3_add(precise3_add(q.v, precise3_scale(q.w, b)), precise3_cross(b, q.v));
    quaternion r = {precise_sub(q.w, precise3_dot(b, q.v)), turned};
    precise norm = precise_root(precise_add(precise_mul(r.w, r.w), precise3_dot(r.v, r.v)));
    norm = precise_quotient(precise_from(R(1.0)), norm);
    r.w = precise_mul(norm, r.w);
    r.v = precise3_scale(norm, r.v);
    return r;
}
