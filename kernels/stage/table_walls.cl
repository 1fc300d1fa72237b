/* Wall records: a grain and each face of a wall that it can reach before the next table. */
/* In the plane of the axis and the centre a cylinder or a cone is a straight line, from end to end. */
INLINE bool table_reaches_round(__global const clast_face *face, vec3 axis, vec3 from, real reach)
{
    real height = dot3(from, axis);
    vec3 across = add_scaled(from, -height, axis);
    real off = sqrt(dot3(across, across)), length = (real)face->slant_length;
    real beyond = (face->shape == CLAST_FACE_ROUND_FAR ? -off : off) - (real)face->extent[0];
    real along = height * (real)face->slant[0] + beyond * (real)face->slant[1];
    along = along < R(0.0) ? R(0.0) : (along > length ? length : along);
    real apart = height - along * (real)face->slant[0], apart_off = beyond - along * (real)face->slant[1];
    return apart * apart + apart_off * apart_off < reach * reach;
}

INLINE bool table_reaches(__global const clast_face *face, vec3 x, real reach)
{
    vec3 normal = v3((real)face->normal[0], (real)face->normal[1], (real)face->normal[2]);
    vec3 origin = v3((real)face->origin[0], (real)face->origin[1], (real)face->origin[2]);
    vec3 from = sub(x, origin);
    if (face->shape >= CLAST_FACE_ROUND)
        return table_reaches_round(face, normal, from, reach);
    real height = dot3(from, normal);
    if (face->shape == CLAST_FACE_PLANE)
        return height < reach;
    if (fabs(height) >= reach)
        return false;
    vec3 e1 = v3((real)face->e1[0], (real)face->e1[1], (real)face->e1[2]);
    vec3 e2 = v3((real)face->e2[0], (real)face->e2[1], (real)face->e2[2]);
    real u = fabs(dot3(from, e1)), v = fabs(dot3(from, e2)), a = (real)face->extent[0];
    if (face->shape == CLAST_FACE_DISC)
        return u * u + v * v < (a + reach) * (a + reach);
    return u < a + reach && v < (real)face->extent[1] + reach;
}

__kernel void table_count_walls(const clast_launch launch, __global const clast_grid *restrict grid, __global const real *restrict position,
                                __global const real *restrict radius, __global const clast_face *restrict faces, __global uint *restrict wall_count,
                                __global uint *restrict slot_count)
{
    int i = get_global_id(0);
    uint found = 0;
    if (i < launch.particle_count) {
        vec3 x = GRAIN3(position, i);
        for (int f = 0; f < launch.face_count; f++)
            found += table_reaches(faces + f, x, radius[i] + (real)grid->skin) ? 1 : 0;
        slot_count[i] += found;
    }
    wall_count[i] = found;
}

__kernel void table_fill_walls(const clast_launch launch, __global const clast_grid *restrict grid, __global const real *restrict position,
                               __global const real *restrict radius, __global const clast_face *restrict faces,
                               __global const uint *restrict wall_start, __global int *restrict owner, __global int *restrict other, const int wall_base)
{
    int i = get_global_id(0);
    if (i >= launch.particle_count)
        return;
    vec3 x = GRAIN3(position, i);
    uint k = wall_base + wall_start[i];
    for (int f = 0; f < launch.face_count; f++)
        if (table_reaches(faces + f, x, radius[i] + (real)grid->skin)) {
            owner[k] = i;
            other[k] = f;
            k++;
        }
}
