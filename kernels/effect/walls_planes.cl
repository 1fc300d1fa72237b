/* walls: infinite planes with the grains on the side of the normal. Their records are vector code where stages go by blocks
 * (stage/by_blocks.cl). */
#define WALLS_LOOP VECTOR_LOOP
#define PAIR_OF_WALLS pair_of_plane
INLINE bool walls_near(const __global clast_face *face, precise3 x, real r)
{
    return rounded(precise3_dot(precise3_sub(x, PRECISE3(face->origin)), PRECISE3(face->normal))) < R(1.00001) * r;
}

INLINE void walls_contact(const __global clast_face *row, int face_count, int index, precise3 x, vec3 velocity_i, contact *c, wall_touch *touch)
{
    const __global clast_face *face = row + index;
    precise3 normal = PRECISE3(face->normal);
    precise distance = precise3_dot(precise3_sub(x, PRECISE3(face->origin)), normal);
    precise3 point = precise3_add_scaled(x, -rounded(distance), normal);
    walls_fill(face, scale(R(-1.0), rounded3(normal)), point, distance, true, velocity_i, c, touch);
    (void)face_count;
}
