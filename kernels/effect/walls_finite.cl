/* walls: planes, rectangles and discs. A rectangle or a disc acts from both sides, at its face, its edge and its corners. An edge or a
 * corner counts only where no other face is nearer at that point, and once where several faces share it: the smallest index has it. */
INLINE real walls_clamp(real x, real limit)
{
    return x > limit ? limit : (x < -limit ? -limit : x);
}

/* Inside the border by more than rounding, so that a grain right over a seam is on the edge of both faces and not on both faces. */
INLINE bool walls_within(const __global clast_face *face, real u, real v)
{
    real a = R(0.999999999) * (real)face->extent[0], b = R(0.999999999) * (real)face->extent[1];
    return face->shape == CLAST_FACE_RECTANGLE ? fabs(u) < a && fabs(v) < b : u * u + v * v < a * a;
}

INLINE wall_nearest walls_find(const __global clast_face *face, vec3 x)
{
    vec3 normal = v3((real)face->normal[0], (real)face->normal[1], (real)face->normal[2]);
    vec3 origin = v3((real)face->origin[0], (real)face->origin[1], (real)face->origin[2]);
    vec3 from = sub(x, origin);
    if (walls_is_round(face))
        return walls_find_round(face, origin, normal, from);
    real height = dot3(from, normal);
    wall_nearest r;
    if (face->shape == CLAST_FACE_PLANE) {
        r.point = add_scaled(x, -height, normal);
        r.outward = normal;
        r.distance = height;
        r.on_face = true;
        return r;
    }
    vec3 e1 = v3((real)face->e1[0], (real)face->e1[1], (real)face->e1[2]);
    vec3 e2 = v3((real)face->e2[0], (real)face->e2[1], (real)face->e2[2]);
    real u = dot3(from, e1), v = dot3(from, e2), uc, vc;
    if (face->shape == CLAST_FACE_RECTANGLE) {
        uc = walls_clamp(u, (real)face->extent[0]);
        vc = walls_clamp(v, (real)face->extent[1]);
    } else {
        real rho = sqrt(u * u + v * v), radius = (real)face->extent[0];
        real shrink = rho > radius ? radius / rho : R(1.0);
        uc = shrink * u;
        vc = shrink * v;
    }
    r.on_face = walls_within(face, u, v);
    r.point = add_scaled(add_scaled(origin, uc, e1), vc, e2);
    vec3 apart = r.on_face ? scale(height, normal) : sub(x, r.point);
    r.distance = r.on_face ? fabs(height) : sqrt(dot3(apart, apart));
    r.outward = r.distance > R(0.0) ? scale(R(1.0) / r.distance, apart) : normal;
    return r;
}

/* True where another face has the contact that this face would make with its edge. */
INLINE bool walls_taken(const __global clast_face *row, int face_count, int index, vec3 x, const wall_nearest *mine)
{
    real near = R(1e-6) * mine->distance;
    for (int f = 0; f < face_count; f++) {
        if (f == index || walls_are_twins(row + f, row + index))
            continue;
        wall_nearest there = walls_find(row + f, mine->point);
        if (fabs(there.distance) > near)
            continue;
        wall_nearest theirs = walls_find(row + f, x);
        real gain = mine->distance - fabs(theirs.distance);
        if (gain > near || (gain > -near && (theirs.on_face || f < index)))
            return true;
    }
    return false;
}

INLINE void walls_contact(const __global clast_face *row, int face_count, int index, vec3 x, vec3 velocity_i, contact *c, wall_touch *touch)
{
    wall_nearest mine = walls_find(row + index, x);
    bool taken = !mine.on_face && mine.distance < c->radius_i && walls_taken(row, face_count, index, x, &mine);
    walls_fill(row + index, scale(R(-1.0), mine.outward), mine.point, mine.distance, mine.on_face, velocity_i, c, touch);
    if (walls_is_round(row + index))
        c->turn = walls_turn_round(row + index, x, velocity_i, &mine, c, touch);
    touch->distance = taken ? R(1e30) : touch->distance;
}
