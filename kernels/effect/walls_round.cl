/* walls: cylinders and cones with open ends, from both sides. A centre and the axis span a plane; in it the face is a straight line, the
 * meridian, and the nearest point of the face is the nearest point of that line. Beyond its ends this is a rim, which acts like an edge.
 *
 * A sphere wedged in a cone touches it all round. Two contacts stand for the ring, on either side of the axis: that of the face, and that of
 * its twin across the axis, which only a wedged sphere can reach. On the axis itself they lie along e1, and their pushes to the side cancel. */
#define walls_is_round(face) ((face)->shape >= CLAST_FACE_ROUND)
#define walls_are_twins(a, b) ((a)->wall == (b)->wall && walls_is_round(a) && walls_is_round(b))

/* Cylindrical coordinates about the axis: height over the first end, distance from the axis, and the direction away from it. */
typedef struct wall_polar {
    precise height, off;
    precise3 away;
} wall_polar;

INLINE wall_polar walls_polar(const __global clast_face *face, precise3 axis, precise3 from)
{
    wall_polar p;
    p.height = precise3_dot(from, axis);
    precise3 across = precise3_sub(from, precise3_scale(p.height, axis));
    p.off = precise_root(precise3_dot(across, across));
    p.away = PRECISE3(face->e1);
    if (rounded(p.off) > R(0.0))
        p.away = precise3_scale(precise_quotient(precise_from(R(1.0)), p.off), across);
    return p;
}

INLINE wall_nearest walls_find_round(const __global clast_face *face, precise3 origin, precise3 axis, precise3 from)
{
    wall_polar at = walls_polar(face, axis, from);
    precise sign = precise_from(face->shape == CLAST_FACE_ROUND_FAR ? R(-1.0) : R(1.0)), zero = precise_from(R(0.0));
    precise up = precise_load(face->slant[0]), off = precise_load(face->slant[1]);
    precise length = precise_load(face->slant_length), first = precise_load(face->extent[0]);
    precise beyond = precise_sub(precise_mul(sign, at.off), first); /* negative inside of a cylinder */
    precise along = precise_add(precise_mul(at.height, up), precise_mul(beyond, off));
    precise inward = precise_sub(precise_mul(at.height, off), precise_mul(beyond, up)), nearest = along;
    if (precise_less(along, zero))
        nearest = zero;
    if (precise_less(length, along))
        nearest = length;
    wall_nearest r;
    r.on_face = rounded(along) > SEAM * rounded(length) && rounded(along) < (R(1.0) - SEAM) * rounded(length);
    precise apart_up = precise_sub(at.height, precise_mul(nearest, up)), apart_off = precise_sub(beyond, precise_mul(nearest, off));
    r.distance = precise_abs(inward);
    if (!r.on_face)
        r.distance = precise_root(precise_add(precise_mul(apart_up, apart_up), precise_mul(apart_off, apart_off)));
    real distance = rounded(r.distance), side = rounded(inward) < R(0.0) ? R(-1.0) : R(1.0);
    bool apart = distance > R(0.0);
    real inverse = R(1.0) / (apart ? distance : R(1.0));
    real outward_up = r.on_face || !apart ? side * rounded(off) : inverse * rounded(apart_up);
    real outward_off = r.on_face || !apart ? -side * rounded(up) : inverse * rounded(apart_off);
    r.outward = add_scaled(scale(outward_up, rounded3(axis)), rounded(sign) * outward_off, rounded3(at.away));
    precise reach = precise_mul(sign, precise_add(first, precise_mul(nearest, off)));
    r.point = precise3_add(precise3_add(origin, precise3_scale(precise_mul(nearest, up), axis)), precise3_scale(reach, at.away));
    return r;
}

/* The normal turns with the wall, with the centre's way about the axis, and at a rim also about the rim. Close to the axis the second rate
 * is kept finite: springs that turn faster than that have lost their meaning. */
INLINE vec3 walls_turn_round(const __global clast_face *face, precise3 x, vec3 velocity_i, const wall_nearest *mine, const contact *c,
                             const wall_touch *touch)
{
    vec3 axis = from3(face->normal);
    wall_polar at = walls_polar(face, PRECISE3(face->normal), precise3_sub(x, PRECISE3(face->origin)));
    vec3 at_centre = add(from3(face->velocity), cross3(c->spin_j, rounded3(precise3_sub(x, touch->pivot))));
    vec3 u = sub(velocity_i, at_centre), round = cross3(axis, rounded3(at.away));
    real about = dot3(u, round), least = R(0.01) * c->radius_i, away = rounded(at.off), off = away > least ? away : least;
    real rate = about * away / (off * off);
    vec3 turn = add_scaled(c->spin_j, rate, axis);
    vec3 meridian = add_scaled(u, -about, round), passing = scale(R(-1.0) / rounded(mine->distance), cross3(c->n, meridian));
    bool rim = !mine->on_face;
    turn = add(turn, v3(rim ? passing.x : R(0.0), rim ? passing.y : R(0.0), rim ? passing.z : R(0.0)));
    return add_scaled(turn, -dot3(turn, c->n), c->n);
}
