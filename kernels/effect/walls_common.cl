/* What all wall shapes share. A wall contact is the contact of a grain with a body that is infinitely large, heavy and stiff (TM Remark 1). */
#define WALLS_PAIR_FIELDS(READ, WRITE) READ(clast_face, faces)
#define WALLS_CONTACT(launch, face, x, v, c, touch) \
    walls_contact(faces + (launch)->face_row * (launch)->face_count, (launch)->face_count, face, x, v, c, touch)

/* Whether a grain may touch a face: surely so where it does. */
#define WALLS_NEAR(launch, face, x, r) walls_near(faces + (launch)->face_row * (launch)->face_count + (face), x, r)

typedef struct wall_touch {
    precise3 point;   /* of the wall, nearest to the grain's centre */
    vec3 velocity;    /* of the wall there */
    precise3 pivot;   /* about which torques on the wall are taken */
    precise distance; /* from the centre; huge where another face has this contact */
    int party;
} wall_touch;

/* Nearest point of a face with borders. */
typedef struct wall_nearest {
    precise3 point;
    vec3 outward; /* unit vector from the point to the centre */
    precise distance;
    bool on_face;
} wall_nearest;

/* n, spin_j and turn of the contact; a face turns with its wall, an edge or a corner with the grain's passage. */
INLINE void walls_fill(const __global clast_face *face, vec3 n, precise3 point, precise distance, bool on_face, vec3 velocity_i, contact *c,
                       wall_touch *touch)
{
    vec3 spin = from3(face->spin), at_pivot = from3(face->velocity);
    precise3 pivot = PRECISE3(face->pivot);
    touch->point = point;
    touch->pivot = pivot;
    touch->velocity = add(at_pivot, cross3(spin, rounded3(precise3_sub(point, pivot))));
    touch->distance = distance;
    touch->party = face->party;
    vec3 passing = scale(R(1.0) / rounded(distance), cross3(n, sub(touch->velocity, velocity_i)));
    vec3 across = add_scaled(spin, -dot3(spin, n), n);
    c->n = n;
    c->spin_j = spin;
    c->turn = v3(on_face ? across.x : passing.x, on_face ? across.y : passing.y, on_face ? across.z : passing.z);
}
