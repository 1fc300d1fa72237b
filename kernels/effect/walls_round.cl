/* walls: cylinders and cones with open ends, from both sides. A centre and the axis span a plane; in it the face is a straight line, the
 * meridian, and the nearest point of the face is the nearest point of that line. Beyond its ends this is a rim, which acts like an edge.
 *
 * A sphere wedged in a cone touches it all round. Two contacts stand for the ring, on either side of the axis: that of the face, and that of
 * its twin across the axis, which only a wedged sphere can reach. On the axis itself they lie along e1, and their pushes to the side cancel. */
#define walls_is_round(face) ((face)->shape >= CLAST_FACE_ROUND)
#define walls_are_twins(a, b) ((a)->wall == (b)->wall && walls_is_round(a) && walls_is_round(b))

/* Cylindrical coordinates about the axis: height over the first end, distance from the axis, and the direction away from it. */
typedef struct wall_polar {
    real height, off;
    vec3 away;
} wall_polar;

INLINE wall_polar walls_polar(const __global clast_face *face, vec3 axis, vec3 from)
{
    wall_polar p;
    p.height = dot3(from, axis);
    vec3 across = add_scaled(from, -p.height, axis);
    p.off = sqrt(dot3(across, across));
    bool apart = p.off > R(0.0);
    real inverse = R(1.0) / (apart ? p.off : R(1.0));
    vec3 side = WALLS_VECTOR(face->e1);
    p.away = v3(apart ? inverse * across.x : side.x, apart ? inverse * across.y : side.y, apart ? inverse * across.z : side.z);
    return p;
}

INLINE wall_nearest walls_find_round(const __global clast_face *face, vec3 origin, vec3 axis, vec3 from)
{
    wall_polar at = walls_polar(face, axis, from);
    real sign = face->shape == CLAST_FACE_ROUND_FAR ? R(-1.0) : R(1.0);
    real up = (real)face->slant[0], off = (real)face->slant[1], length = (real)face->slant_length, first = (real)face->extent[0];
    real beyond = sign * at.off - first; /* negative inside of a cylinder */
    real along = at.height * up + beyond * off, inward = at.height * off - beyond * up;
    real nearest = along < R(0.0) ? R(0.0) : (along > length ? length : along);
    wall_nearest r;
    r.on_face = along > R(1e-9) * length && along < R(0.999999999) * length;
    real apart_up = at.height - nearest * up, apart_off = beyond - nearest * off;
    r.distance = r.on_face ? fabs(inward) : sqrt(apart_up * apart_up + apart_off * apart_off);
    bool apart = r.distance > R(0.0);
    real inverse = R(1.0) / (apart ? r.distance : R(1.0)), side = inward < R(0.0) ? R(-1.0) : R(1.0);
    real outward_up = r.on_face || !apart ? side * off : inverse * apart_up;
    real outward_off = r.on_face || !apart ? -side * up : inverse * apart_off;
    r.outward = add_scaled(scale(outward_up, axis), sign * outward_off, at.away);
    r.point = add_scaled(add_scaled(origin, nearest * up, axis), sign * (first + nearest * off), at.away);
    return r;
}

/* The normal turns with the wall, with the centre's way about the axis, and at a rim also about the rim. Close to the axis the second rate
 * is kept finite: springs that turn faster than that have lost their meaning. */
INLINE vec3 walls_turn_round(const __global clast_face *face, vec3 x, vec3 velocity_i, const wall_nearest *mine, const contact *c,
                             const wall_touch *touch)
{
    vec3 axis = WALLS_VECTOR(face->normal);
    wall_polar at = walls_polar(face, axis, sub(x, WALLS_VECTOR(face->origin)));
    vec3 at_centre = add(WALLS_VECTOR(face->velocity), cross3(c->spin_j, sub(x, touch->pivot)));
    vec3 u = sub(velocity_i, at_centre), round = cross3(axis, at.away);
    real about = dot3(u, round), least = R(0.01) * c->radius_i, off = at.off > least ? at.off : least;
    real rate = about * at.off / (off * off);
    vec3 turn = add_scaled(c->spin_j, rate, axis);
    vec3 meridian = add_scaled(u, -about, round), passing = scale(R(-1.0) / mine->distance, cross3(c->n, meridian));
    bool rim = !mine->on_face;
    turn = add(turn, v3(rim ? passing.x : R(0.0), rim ? passing.y : R(0.0), rim ? passing.z : R(0.0)));
    return add_scaled(turn, -dot3(turn, c->n), c->n);
}
