/* precision: arithmetic in float, and no double anywhere. What takes small increments over many steps, and what the overlap is a small
 * difference of, is kept as the unevaluated sum of two floats (`precise`, about 48 bits): positions, radii, velocities, spins,
 * orientations, the places of walls. In memory such a number is 64 bits (`exact`), the size of a double, so that both precisions share
 * their structs and their layouts. Sums and products of two floats are split without error (Knuth, The Art of Computer Programming 2,
 * sec. 4.2.2; Dekker 1971). A fused multiply-add gives the error of a product; contracting others must not change what is split, hence the
 * pragma, in these functions only: the laws are contracted as in double precision. */
/* Stands for an infinite mass: its square, and its product with a square of a length, are numbers still. */
#define HEAVY R(1e16)
/* Of the size of a wall's face: positions in a face are known better than this. */
#define SEAM R(1e-6)

typedef clast_f64 exact;

typedef struct precise {
    real hi, lo; /* |lo| is at most half of hi's last place */
} precise;

typedef struct precise3 {
    precise x, y, z;
} precise3;

/* The nearest real of a stored number. These two are macros, since a struct of two floats that is passed on becomes a vector of two on some
 * devices, and that ends the vectorisation over pairs. */
#define number(stored) ((stored).high)
#define precise_load(stored) precise_of((stored).high, (stored).low)

INLINE precise precise_of(real hi, real lo)
{
    precise r;
    r.hi = hi;
    r.lo = lo;
    return r;
}

INLINE exact precise_store(precise a)
{
    exact r;
    r.high = a.hi;
    r.low = a.lo;
    return r;
}

/* The same without the struct on its way, where the compiler is to make vector code. */
#define STORE_PRECISE(place, a) (place).high = (a).hi, (place).low = (a).lo

INLINE precise precise_from(real a)
{
    precise r;
    r.hi = a;
    r.lo = R(0.0);
    return r;
}

INLINE precise precise_from_int(int a)
{
    precise r;
    r.hi = (real)a;
    r.lo = (real)(a - (int)r.hi);
    return r;
}

INLINE real rounded(precise a)
{
    return a.hi;
}

INLINE real precise_rest(precise a)
{
    return a.lo;
}

/* a + b where |a| >= |b|, or a = 0. */
INLINE precise precise_join(real a, real b)
{
#pragma OPENCL FP_CONTRACT OFF
    precise r;
    r.hi = a + b;
    r.lo = b - (r.hi - a);
    return r;
}

/* a + b without error. */
INLINE precise precise_sum(real a, real b)
{
#pragma OPENCL FP_CONTRACT OFF
    precise r;
    r.hi = a + b;
    real taken = r.hi - a;
    r.lo = (a - (r.hi - taken)) + (b - taken);
    return r;
}

/* a b without error. */
INLINE precise precise_product(real a, real b)
{
#pragma OPENCL FP_CONTRACT OFF
    precise r;
    r.hi = a * b;
    r.lo = fma(a, b, -r.hi);
    return r;
}

INLINE precise precise_add(precise a, precise b)
{
#pragma OPENCL FP_CONTRACT OFF
    precise s = precise_sum(a.hi, b.hi);
    return precise_join(s.hi, s.lo + (a.lo + b.lo));
}

INLINE precise precise_sub(precise a, precise b)
{
#pragma OPENCL FP_CONTRACT OFF
    precise s = precise_sum(a.hi, -b.hi);
    return precise_join(s.hi, s.lo + (a.lo - b.lo));
}

INLINE precise precise_mul(precise a, precise b)
{
#pragma OPENCL FP_CONTRACT OFF
    precise p = precise_product(a.hi, b.hi);
    return precise_join(p.hi, fma(a.hi, b.lo, fma(a.lo, b.hi, p.lo)));
}

/* a + s b */
INLINE precise precise_add_scaled(precise a, real s, precise b)
{
#pragma OPENCL FP_CONTRACT OFF
    precise p = precise_product(s, b.hi), t = precise_sum(a.hi, p.hi);
    return precise_join(t.hi, t.lo + (a.lo + fma(s, b.lo, p.lo)));
}

INLINE precise precise_quotient(precise a, precise b)
{
    real q = a.hi / b.hi;
    precise rest = precise_add_scaled(a, -q, b);
    return precise_join(q, rest.hi / b.hi);
}

INLINE precise precise_abs(precise a)
{
    precise r;
    bool turned = a.hi < R(0.0);
    r.hi = turned ? -a.hi : a.hi;
    r.lo = turned ? -a.lo : a.lo;
    return r;
}

INLINE bool precise_less(precise a, precise b)
{
    return a.hi < b.hi || (a.hi == b.hi && a.lo < b.lo);
}

INLINE precise precise_max(precise a, precise b)
{
    bool less = precise_less(a, b);
    precise r;
    r.hi = less ? b.hi : a.hi;
    r.lo = less ? b.lo : a.lo;
    return r;
}

/* One step of Newton's method on the root of the nearest real. */
INLINE precise precise_root(precise a)
{
#pragma OPENCL FP_CONTRACT OFF
    bool some = a.hi > R(0.0);
    real h = sqrt(some ? a.hi : R(1.0));
    real rest = fma(-h, h, a.hi) + a.lo;
    precise r = precise_join(h, rest / (R(2.0) * h));
    r.hi = some ? r.hi : R(0.0);
    r.lo = some ? r.lo : R(0.0);
    return r;
}

INLINE precise3 precise3_of(precise x, precise y, precise z)
{
    precise3 r;
    r.x = x;
    r.y = y;
    r.z = z;
    return r;
}

INLINE precise3 precise3_from(vec3 a)
{
    return precise3_of(precise_from(a.x), precise_from(a.y), precise_from(a.z));
}

INLINE vec3 rounded3(precise3 a)
{
    return v3(a.x.hi, a.y.hi, a.z.hi);
}

INLINE precise3 precise3_add(precise3 a, precise3 b)
{
    return precise3_of(precise_add(a.x, b.x), precise_add(a.y, b.y), precise_add(a.z, b.z));
}

INLINE precise3 precise3_sub(precise3 a, precise3 b)
{
    return precise3_of(precise_sub(a.x, b.x), precise_sub(a.y, b.y), precise_sub(a.z, b.z));
}

/* a + s b */
INLINE precise3 precise3_add_scaled(precise3 a, real s, precise3 b)
{
    return precise3_of(precise_add_scaled(a.x, s, b.x), precise_add_scaled(a.y, s, b.y), precise_add_scaled(a.z, s, b.z));
}

INLINE precise3 precise3_scale(precise s, precise3 a)
{
    return precise3_of(precise_mul(s, a.x), precise_mul(s, a.y), precise_mul(s, a.z));
}

INLINE precise precise3_dot(precise3 a, precise3 b)
{
    return precise_add(precise_add(precise_mul(a.x, b.x), precise_mul(a.y, b.y)), precise_mul(a.z, b.z));
}

INLINE precise3 precise3_cross(precise3 a, precise3 b)
{
    return precise3_of(precise_sub(precise_mul(a.y, b.z), precise_mul(a.z, b.y)), precise_sub(precise_mul(a.z, b.x), precise_mul(a.x, b.z)), precise_sub(precise_mul(a.x, b.y), precise_mul(a.y, b.x)));
}

/* The way between two places. Coordinates lie far from 0 (host/simulation.c), so that those of neighbours differ by few bits and the
 * difference of their high parts is exact; what is left is small and added where it counts. */
typedef struct apart3 {
    vec3 whole, rest;
} apart3;

INLINE apart3 apart_of(precise3 to, precise3 from)
{
    apart3 r;
    real one = fma(R(0.0), to.y.lo, R(1.0));
    r.whole = v3(to.x.hi - from.x.hi, fma(to.y.hi, one, -from.y.hi), to.z.hi - from.z.hi);
    r.rest = v3(fma(to.x.lo, one, -from.x.lo), to.y.lo - from.y.lo, fma(to.z.lo, one, -from.z.lo));
    return r;
}

INLINE apart3 apart_less(apart3 a, precise3 b)
{
    a.whole = sub(a.whole, v3(b.x.hi, b.y.hi, b.z.hi));
    a.rest = sub(a.rest, v3(b.x.lo, b.y.lo, b.z.lo));
    return a;
}

INLINE vec3 apart_vector(apart3 a)
{
    return add(a.whole, a.rest);
}

/* Less n times a length, for the whole number n that makes it small: exact where n is 1 or -1. */
INLINE apart3 apart_image(apart3 a, vec3 n, precise x, precise y, precise z)
{
    a.whole = v3(fma(-n.x, x.hi, a.whole.x), fma(-n.y, y.hi, a.whole.y), fma(-n.z, z.hi, a.whole.z));
    a.rest = v3(fma(-n.x, x.lo, a.rest.x), fma(-n.y, y.lo, a.rest.y), fma(-n.z, z.lo, a.rest.z));
    return a;
}

/* x = whole numbers of a quantum + the rest: of a few more than 11 bits, so that sums of their squares are exact in float. Adding and
 * taking away `magic`, whose last place is the quantum, rounds to it. */
INLINE real quantised(real x, real magic)
{
#pragma OPENCL FP_CONTRACT OFF
    real moved = x + magic;
    return moved - magic;
}

/* (ri + rj) - |d| = ((ri + rj)^2 - d^2)/((ri + rj) + |d|): in the difference of squares those of whole quanta cancel exactly, and the rest is
 * small enough for float. radius_i is not the larger one; `distance` is |d| in float. */
INLINE real sphere_overlap(apart3 d, real distance, precise radius_i, precise radius_j)
{
#pragma OPENCL FP_CONTRACT OFF
    real sum = radius_j.hi + radius_i.hi, magic = R(6144.0) * sum;
    real s = quantised(sum, magic), x = quantised(d.whole.x, magic), y = quantised(d.whole.y, magic), z = quantised(d.whole.z, magic);
    real sr = (radius_i.hi - (s - radius_j.hi)) + (radius_i.lo + radius_j.lo);
    real xr = (d.whole.x - x) + d.rest.x, yr = (d.whole.y - y) + d.rest.y, zr = (d.whole.z - z) + d.rest.z;
    real squares = fma(-z, z, fma(-y, y, fma(-x, x, s * s)));
    real rest = fma(-zr, zr + z + z, fma(-yr, yr + y + y, fma(-xr, xr + x + x, fma(sr, sr + s + s, squares))));
    return rest / (sum + distance);
}

INLINE bool is_number(real a)
{
    return ((as_uint(a) >> 23) & 0xff) != 0xff;
}

/* Rows of the stages by blocks (stage/by_blocks.cl): four stored numbers, given by their bits, to a row of high and one of low parts. */
#define EXACT_REALS 2
#define ROW_PRECISE(rows, n, lane) precise_of(ROW_NUMBER(rows, n, lane), ROW_NUMBER(rows, (n) + 1, lane))

INLINE void row_rounded(ulong4 stored, real *to)
{
    vstore4(as_float8(stored).even, 0, to);
}

INLINE void row_exact(ulong4 stored, real *to, int stride)
{
    vstore4(as_float8(stored).even, 0, to);
    vstore4(as_float8(stored).odd, 0, to + stride);
}
