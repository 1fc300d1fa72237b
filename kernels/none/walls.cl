/* walls: none. */
#define WALLS_PAIR_FIELDS(READ, WRITE)
#define WALLS_CONTACT(launch, face, x, v, c, touch) (void)(x), walls_none(touch)

typedef struct wall_touch {
    vec3 point, velocity, pivot;
    real distance;
    int party;
} wall_touch;

INLINE void walls_none(wall_touch *touch)
{
    touch->point = touch->velocity = touch->pivot = v3(R(0.0), R(0.0), R(0.0));
    touch->distance = R(1e30);
    touch->party = 0;
}
