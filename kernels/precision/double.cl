/* precision: everything in double. Its twin is mixed.cl; what the functions promise stands there. */
#define HEAVY R(1e30)
#define SEAM R(1e-9)

typedef clast_f64 exact;
typedef real precise;
typedef vec3 precise3;

INLINE real number(exact stored)
{
    return stored;
}

INLINE precise precise_load(exact stored)
{
    return stored;
}

INLINE exact precise_store(precise a)
{
    return a;
}

#define STORE_PRECISE(place, a) (place) = (a)

INLINE precise precise_from(real a)
{
    return a;
}

/* From and to two reals: the number rounded, and what that leaves, which is 0 here. */
INLINE precise precise_of(real hi, real lo)
{
    return hi + lo;
}

INLINE real precise_rest(precise a)
{
    (void)a;
    return R(0.0);
}

INLINE precise precise_from_int(int a)
{
    return a;
}

INLINE real rounded(precise a)
{
    return a;
}

INLINE precise precise_add(precise a, precise b)
{
    return a + b;
}

INLINE precise precise_sub(precise a, precise b)
{
    return a - b;
}

INLINE precise precise_mul(precise a, precise b)
{
    return a * b;
}

/* a + s b */
INLINE precise precise_add_scaled(precise a, real s, precise b)
{
    return a + s * b;
}

INLINE precise precise_quotient(precise a, precise b)
{
    return a / b;
}

INLINE precise precise_abs(precise a)
{
    return fabs(a);
}

INLINE precise precise_max(precise a, precise b)
{
    return fmax(a, b);
}

INLINE bool precise_less(precise a, precise b)
{
    return a < b;
}

INLINE precise precise_root(precise a)
{
    return sqrt(a);
}

INLINE precise3 precise3_of(precise x, precise y, precise z)
{
    return v3(x, y, z);
}

INLINE precise3 precise3_from(vec3 a)
{
    return a;
}

INLINE vec3 rounded3(precise3 a)
{
    return a;
}

INLINE precise3 precise3_add(precise3 a, precise3 b)
{
    return add(a, b);
}

INLINE precise3 precise3_sub(precise3 a, precise3 b)
{
    return sub(a, b);
}

INLINE precise3 precise3_add_scaled(precise3 a, real s, precise3 b)
{
    return add_scaled(a, s, b);
}

INLINE precise3 precise3_scale(precise s, precise3 a)
{
    return scale(s, a);
}

INLINE precise precise3_dot(precise3 a, precise3 b)
{
    return dot3(a, b);
}

INLINE precise3 precise3_cross(precise3 a, precise3 b)
{
    return cross3(a, b);
}

typedef vec3 apart3;

INLINE apart3 apart_of(precise3 to, precise3 from)
{
    return sub(to, from);
}

INLINE apart3 apart_less(apart3 a, precise3 b)
{
    return sub(a, b);
}

INLINE vec3 apart_vector(apart3 a)
{
    return a;
}

INLINE apart3 apart_image(apart3 a, vec3 n, precise x, precise y, precise z)
{
    return v3(a.x - x * n.x, a.y - y * n.y, a.z - z * n.z);
}

INLINE real sphere_overlap(apart3 d, real distance, precise radius_i, precise radius_j)
{
    (void)d;
    return radius_i + radius_j - distance;
}

INLINE bool is_number(real a)
{
    return ((as_ulong(a) >> 52) & 0x7ff) != 0x7ff;
}

/* Rows of the stages by blocks (stage/by_blocks.cl): four stored numbers, given by their bits, to a row. */
#define EXACT_REALS 1
#define ROW_PRECISE(rows, n, lane) ROW_NUMBER(rows, n, lane)

INLINE void row_rounded(ulong4 stored, real *to)
{
    vstore4(as_double4(stored), 0, to);
}

INLINE void row_exact(ulong4 stored, real *to, int stride)
{
    (void)stride;
    vstore4(as_double4(stored), 0, to);
}
