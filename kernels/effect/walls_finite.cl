/* walls: planes, rectangles and discs. A rectangle or a disc acts from both sides, at its face, its edge and its corners. An edge or a
 * corner counts only where no other face is nearer at that point, and once where several faces share it: the smallest index has it.
 * So a record takes a loop over faces, and is taken by itself (stage/by_blocks.cl). */
#define WALLS_LOOP
#define PAIR_OF_WALLS pair_of_face
INLINE precise walls_clamp(precise x, precise limit)
{
    if (precise_less(limit, x))
        return limit;
    precise low = precise_sub(precise_from(R(0.0)), limit);
    return precise_less(x, low) ? low : x;
}

/* By its plane alone. */
INLINE bool walls_near(const __global clast_face *face, precise3 x, real r)
{
    real height = rounded(precise3_dot(precise3_sub(x, PRECISE3(face->origin)), PRECISE3(face->normal)));
    return walls_is_round(face) || (height < R(1.00001) * r && (face->shape == CLAST_FACE_PLANE || -height < R(1.00001) * r));
}

/* Inside the border by more than rounding, so that a grain right over a seam is on the edge of both faces and not on both faces. */
INLINE bool walls_within(const __global clast_face *face, real u, real v)
{
    real a = (R(1.0) - SEAM) * number(face->extent[0]), b = (R(1.0) - SEAM) * number(face->extent[1]);
    return face->shape == CLAST_FACE_RECTANGLE ? fabs(u) < a && fabs(v) < b : u * u + v * v < a * a;
}

INLINE wall_nearest walls_find(const __global clast_face *face, precise3 x)
{
    precise3 normal = PRECISE3(face->normal), origin = PRECISE3(face->origin);
    precise3 from = precise3_sub(x, origin);
    if (walls_is_round(face))
        return walls_find_round(face, origin, normal, from);
    precise height = precise3_dot(from, normal);
    wall_nearest r;
    if (face->shape == CLAST_FACE_PLANE) {
        r.point = precise3_add_scaled(x, -rounded(height), normal);
        r.outward = rounded3(normal);
        r.distance = height;
        r.on_face = true;
        return r;
    }
    precise3 e1 = PRECISE3(face->e1), e2 = PRECISE3(face->e2);
    precise u = precise3_dot(from, e1), v = precise3_dot(from, e2), uc, vc;
    if (face->shape == CLAST_FACE_RECTANGLE) {
        uc = walls_clamp(u, precise_load(face->extent[0]));
        vc = walls_clamp(v, precise_load(face->extent[1]));
    } else {
        precise rho = precise_root(precise_add(precise_mul(u, u), precise_mul(v, v))), radius = precise_load(face->extent[0]);
        precise shrink = precise_less(radius, rho) ? precise_quotient(radius, rho) : precise_from(R(1.0));
        uc = precise_mul(shrink, u);
        vc = precise_mul(shrink, v);
    }
    r.on_face = walls_within(face, rounded(u), rounded(v));
    r.point = precise3_add(precise3_add(origin, precise3_scale(uc, e1)), precise3_scale(vc, e2));
    precise3 apart = precise3_sub(x, r.point);
    if (r.on_face)
        apart = precise3_scale(height, normal);
    r.distance = precise_abs(height);
    if (!r.on_face)
        r.distance = precise_root(precise3_dot(apart, apart));
    real distance = rounded(r.distance);
    r.outward = distance > R(0.0) ? scale(R(1.0) / distance, rounded3(apart)) : rounded3(normal);
    return r;
}

/* True where another face has the contact that this face would make with its edge. */
INLINE bool walls_taken(const __global clast_face *row, int face_count, int index, precise3 x, const wall_nearest *mine)
{
    real near = R(1e-6) * rounded(mine->distance);
    for (int f = 0; f < face_count; f++) {
        if (f == index || walls_are_twins(row + f, row + index))
            continue;
        wall_nearest there = walls_find(row + f, mine->point);
        if (fabs(rounded(there.distance)) > near)
            continue;
        wall_nearest theirs = walls_find(row + f, x);
        real gain = rounded(precise_sub(mine->distance, precise_abs(theirs.distance)));
        if (gain > near || (gain > -near && (theirs.on_face || f < index)))
            return true;
    }
    return false;
}

INLINE void walls_contact(const __global clast_face *row, int face_count, int index, precise3 x, vec3 velocity_i, contact *c, wall_touch *touch)
{
    wall_nearest mine = walls_find(row + index, x);
    bool taken = !mine.on_face && rounded(mine.distance) <= c->radius_i && walls_taken(row, face_count, index, x, &mine);
    walls_fill(row + index, scale(R(-1.0), mine.outward), mine.point, mine.distance, mine.on_face, velocity_i, c, touch);
    if (walls_is_round(row + index))
        c->turn = walls_turn_round(row + index, x, velocity_i, &mine, c, touch);
    if (taken)
        touch->distance = precise_from(R(1e30));
}
