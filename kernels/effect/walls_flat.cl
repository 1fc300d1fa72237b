/* walls: no round faces. */
#define walls_is_round(face) false
#define walls_are_twins(a, b) false
#define walls_find_round(face, origin, axis, from) walls_nowhere(origin)
#define walls_turn_round(face, x, velocity_i, mine, c, touch) ((c)->turn)

INLINE wall_nearest walls_nowhere(precise3 origin)
{
    wall_nearest r;
    r.point = origin;
    r.outward = rounded3(origin);
    r.distance = precise_from(R(1e30));
    r.on_face = false;
    return r;
}
