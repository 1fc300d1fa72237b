/* walls: infinite planes with the grains on the side of the normal. */
INLINE void walls_contact(const __global clast_face *row, int face_count, int index, vec3 x, vec3 velocity_i, contact *c, wall_touch *touch)
{
    const __global clast_face *face = row + index;
    vec3 normal = v3((real)face->normal[0], (real)face->normal[1], (real)face->normal[2]);
    vec3 origin = v3((real)face->origin[0], (real)face->origin[1], (real)face->origin[2]);
    real distance = dot3(sub(x, origin), normal);
    walls_fill(face, scale(R(-1.0), normal), add_scaled(x, -distance, normal), distance, true, velocity_i, c, touch);
    (void)face_count;
}
