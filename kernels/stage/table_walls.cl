/* Wall records: a grain and each face of a wall that it can reach before the next table. */
/* In the plane of the axis and the centre a cylinder or a cone is a straight line, from end to end. */
INLINE bool table_reaches_round(__global const clast_face *face, vec3 axis, vec3 from, real reach)
{
    real height = dot3(from, axis);
    vec3 across = add_scaled(from, -height, axis);
    real off = sqrt(dot3(across, across)), length = number(face->slant_length);
    real beyond = (face->shape == CLAST_FACE_ROUND_FAR ? -off : off) - number(face->extent[0]);
    real along = height * number(face->slant[0]) + beyond * number(face->slant[1]);
    along = along < R(0.0) ? R(0.0) : (along > length ? length : along);
    real apart = height - along * number(face->slant[0]), apart_off = beyond - along * number(face->slant[1]);
    return apart * apart + apart_off * apart_off < reach * reach;
}

INLINE bool table_reaches(__global const clast_face *face, precise3 x, real reach)
{
    precise3 apart = precise3_sub(x, PRECISE3(face->origin));
    vec3 from = rounded3(apart);
    if (face->shape >= CLAST_FACE_ROUND)
        return table_reaches_round(face, from3(face->normal), from, reach);
    real height = rounded(precise3_dot(apart, PRECISE3(face->normal)));
    if (face->shape == CLAST_FACE_PLANE)
        return height < reach;
    if (fabs(height) >= reach)
        return false;
    real u = fabs(dot3(from, from3(face->e1))), v = fabs(dot3(from, from3(face->e2))), a = number(face->extent[0]);
    if (face->shape == CLAST_FACE_DISC)
        return u * u + v * v < (a + reach) * (a + reach);
    return u < a + reach && v < number(face->extent[1]) + reach;
}

INLINE void table_count_walls_unit(int i, const clast_launch *launch, __global const clast_grid *restrict grid,
                                 __global const exact *restrict position, __global const exact *restrict radius,
                                 __global const clast_face *restrict faces, __global uint *restrict wall_count,
                                 __global uint *restrict slot_count)
{
    uint found = 0;
    if (i < launch->particle_count) {
        precise3 x = PRECISE_GRAIN_POLAR3(position, i);
        for (int f = 0; f < launch->face_count; f++)
            found += table_reaches(faces + f, x, GRAIN_RADIUS(i) * (R(1.0) + number(grid->wall_share)) + number(grid->skin)) ? 1 : 0;
        slot_count[i] += found;
    }
    wall_count[i] = found;
}

__kernel void table_count_walls(const clast_launch launch, __global const clast_grid *restrict grid,
                                __global const exact *restrict position, __global const exact *restrict radius,
                                __global const clast_face *restrict faces, __global uint *restrict wall_count,
                                __global uint *restrict slot_count)
{
    table_count_walls_unit(get_global_id(0), &launch, grid, position, radius, faces, wall_count, slot_count);
}

INLINE void table_fill_walls_unit(int i, const clast_launch *launch, __global const clast_grid *restrict grid,
                                __global const exact *restrict position, __global const exact *restrict radius,
                                __global const clast_face *restrict faces, __global const uint *restrict wall_start,
                                __global int *restrict owner, __global int *restrict other, const int wall_base)
{
    if (i >= launch->particle_count)
        return;
    precise3 x = PRECISE_GRAIN_POLAR3(position, i);
    uint k = wall_base + wall_start[i];
    for (int f = 0; f < launch->face_count; f++)
        if (table_reaches(faces + f, x, GRAIN_RADIUS(i) * (R(1.0) + number(grid->wall_share)) + number(grid->skin))) {
            owner[k] = i;
            other[k] = f;
            k++;
        }
}

__kernel void table_fill_walls(const clast_launch launch, __global const clast_grid *restrict grid, __global const exact *restrict position,
                               __global const exact *restrict radius, __global const clast_face *restrict faces,
                               __global const uint *restrict wall_start, __global int *restrict owner, __global int *restrict other,
                               const int wall_base)
{
    table_fill_walls_unit(get_global_id(0), &launch, grid, position, radius, faces, wall_start, owner, other, wall_base);
}

#define TABLE_WALL_PHASES                                                                                                                              \
    TABLE_PHASE(table_count_walls, launch, READ(0, clast_grid), READ(1, exact), READ(2, exact), READ(3, clast_face), WRITE(4, uint), WRITE(5, uint))    \
    TABLE_PHASE(table_fill_walls, launch, READ(0, clast_grid), READ(1, exact), READ(2, exact), READ(3, clast_face), READ(4, uint), WRITE(5, int),       \
                WRITE(6, int), (int)n0)
