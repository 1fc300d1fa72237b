/* walls: none. */
#define WALLS_LOOP
#define PAIR_OF_WALLS pair_of_face
#define WALLS_PAIR_FIELDS(READ, WRITE)
#define WALLS_NEAR(launch, face, x, r) false
#define WALLS_CONTACT(launch, face, x, v, c, touch) (void)(x), walls_none(touch)

typedef struct wall_touch {
    precise3 point, pivot;
    vec3 velocity;
    precise distance;
    int party;
} wall_touch;

INLINE void walls_none(wall_touch *touch)
{
    touch->velocity = v3(R(0.0), R(0.0), R(0.0));
    touch->point = touch->pivot = precise3_from(touch->velocity);
    touch->distance = precise_from(R(1e30));
    touch->party = 0;
}
