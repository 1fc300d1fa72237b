/* Scalars and vectors; what is `precise` and `exact` is defined in precision/. A struct of three scalars vectorises where float3/double3 do not; functions are inlined always, since one call
 * ends vectorisation. */
/* Loops that may become vector code need not. */
#pragma clang diagnostic ignored "-Wpass-failed"
#ifndef REAL_IS_FLOAT
typedef clast_f64 real;
typedef double4 real4;
#define R(x) ((real)(x))
/* How a real stands in memory, for what takes it apart: bits behind the exponent, its bias, and the leading half of the rest. */
typedef ulong real_bits;
#define REAL_BITS(x) as_ulong(x)
#define REAL_OF_BITS(b) as_double(b)
#define REAL_FRACTION_BITS 52
#define REAL_BIAS 1023
#define REAL_LOW_BITS 0x7ffffffUL
#define REAL_ROOT_HALF 0x3fe6a09e667f3bcdUL
#else
typedef float real;
typedef float4 real4;
#define R(x) ((real)(x##f))
typedef uint real_bits;
#define REAL_BITS(x) as_uint(x)
#define REAL_OF_BITS(b) as_float(b)
#define REAL_FRACTION_BITS 23
#define REAL_BIAS 127
#define REAL_LOW_BITS 0xfffU
#define REAL_ROOT_HALF 0x3f3504f3U
#endif

#define INLINE static inline __attribute__((always_inline))
/* For what few work-items do: kept out of the loop that is to vectorise. */
#define OUTLINE static __attribute__((noinline))
/* The body of a kernel that calls it once for much work. Pocl compiles a kernel three times, for three ways to start it, but a function of its own
 * once: there the host defines it as OUTLINE (host/launch.c). */
#ifndef BODY
#define BODY INLINE
#endif

typedef struct vec3 {
    real x, y, z;
} vec3;

INLINE vec3 v3(real x, real y, real z)
{
    vec3 r;
    r.x = x;
    r.y = y;
    r.z = z;
    return r;
}

INLINE vec3 add(vec3 a, vec3 b)
{
    return v3(a.x + b.x, a.y + b.y, a.z + b.z);
}

INLINE vec3 sub(vec3 a, vec3 b)
{
    return v3(a.x - b.x, a.y - b.y, a.z - b.z);
}

INLINE vec3 scale(real s, vec3 a)
{
    return v3(s * a.x, s * a.y, s * a.z);
}

/* a + s b */
INLINE vec3 add_scaled(vec3 a, real s, vec3 b)
{
    return v3(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}

INLINE real dot3(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

INLINE vec3 cross3(vec3 a, vec3 b)
{
    return v3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

/* v turned by the angle |w| about w, for angles of a step: Cayley's form, which keeps the length to |w|^6/64 and needs no root. */
INLINE vec3 turn_by(vec3 v, vec3 w)
{
    vec3 h = scale(R(0.5), w);
    real h2 = dot3(h, h);
    real weight = R(2.0) * (R(1.0) - h2 * (R(1.0) - h2));
    return add_scaled(v, weight, cross3(h, add(v, cross3(h, v))));
}

/* Cube root from square roots (1/4 + 1/16 + 1/64 is nearly 1/3) and three of Halley's steps; no call that would end vectorisation. */
INLINE real cube_root_step(real r, real x)
{
    real cube = r * r * r;
    return r * (cube + R(2.0) * x) / (R(2.0) * cube + x);
}

INLINE real cube_root(real x)
{
    real f = sqrt(sqrt(x)), g = sqrt(sqrt(f)), h = sqrt(sqrt(g));
    return cube_root_step(cube_root_step(cube_root_step(f * g * h, x), x), x);
}

/* x = 2^e m with m between the roots of 1/2 and 2: e, and log2(m) = 2 artanh(t)/ln 2 with t = (m - 1)/(m + 1), |t| < 0.1716, by its series. */
INLINE real logarithm_of_rest(real x, real *e)
{
    real_bits above = REAL_BITS(x) - (real_bits)REAL_ROOT_HALF + ((real_bits)REAL_BIAS << REAL_FRACTION_BITS);
    *e = (real)((int)(above >> REAL_FRACTION_BITS) - REAL_BIAS);
    real m = REAL_OF_BITS((above & (((real_bits)1 << REAL_FRACTION_BITS) - 1)) + (real_bits)REAL_ROOT_HALF);
    real t = (m - R(1.0)) / (m + R(1.0)), t2 = t * t;
    real series = R(1.0) / R(21.0);
    series = R(1.0) / R(19.0) + t2 * series;
    series = R(1.0) / R(17.0) + t2 * series;
    series = R(1.0) / R(15.0) + t2 * series;
    series = R(1.0) / R(13.0) + t2 * series;
    series = R(1.0) / R(11.0) + t2 * series;
    series = R(1.0) / R(9.0) + t2 * series;
    series = R(1.0) / R(7.0) + t2 * series;
    series = R(1.0) / R(5.0) + t2 * series;
    series = R(1.0) / R(3.0) + t2 * series;
    series = R(1.0) + t2 * series;
    return R(2.88539008177792681) * t * series;
}

/* 2^(n + r) for a whole number n and |r| <= 1/2. */
INLINE real power_of_two(real n, real r)
{
    real u = R(0.693147180559945309) * r;
    real series = R(1.0) + u * (R(1.0) / R(14.0));
    series = R(1.0) + u * (R(1.0) / R(13.0)) * series;
    series = R(1.0) + u * (R(1.0) / R(12.0)) * series;
    series = R(1.0) + u * (R(1.0) / R(11.0)) * series;
    series = R(1.0) + u * (R(1.0) / R(10.0)) * series;
    series = R(1.0) + u * (R(1.0) / R(9.0)) * series;
    series = R(1.0) + u * (R(1.0) / R(8.0)) * series;
    series = R(1.0) + u * (R(1.0) / R(7.0)) * series;
    series = R(1.0) + u * (R(1.0) / R(6.0)) * series;
    series = R(1.0) + u * (R(1.0) / R(5.0)) * series;
    series = R(1.0) + u * R(0.25) * series;
    series = R(1.0) + u * (R(1.0) / R(3.0)) * series;
    series = R(1.0) + u * R(0.5) * series;
    series = R(1.0) + u * series;
    return series * REAL_OF_BITS((real_bits)((int)n + REAL_BIAS) << REAL_FRACTION_BITS);
}

/* x^y for x > 0 by arithmetic alone, where a call of pow() would end vectorisation; to a few last places. x and the result are normal numbers;
 * beyond their range it stops there. The exponent of x times the leading half of y is exact, so that what is left is small and known well. */
INLINE real power_of(real x, real y)
{
    real e, l = logarithm_of_rest(x, &e);
    real leading = REAL_OF_BITS(REAL_BITS(y) & ~(real_bits)REAL_LOW_BITS);
    real exact_part = leading * e, rest = (y - leading) * e + y * l;
    real n = floor(exact_part + rest + R(0.5));
    n = n < (real)(1 - REAL_BIAS) ? (real)(1 - REAL_BIAS) : n > (real)REAL_BIAS ? (real)REAL_BIAS : n;
    real r = (exact_part - n) + rest;
    r = r < R(-0.5) ? R(-0.5) : r > R(0.5) ? R(0.5) : r;
    return power_of_two(n, r);
}

/* Three exact numbers in a row, as reals and with all their bits; a macro, since they may stand in private or in global memory. */
#define from3(a) v3(number((a)[0]), number((a)[1]), number((a)[2]))
#define PRECISE3(a) precise3_of(precise_load((a)[0]), precise_load((a)[1]), precise_load((a)[2]))

/* Fields of grains keep the components of one grain together: a pair reads a grain that stands anywhere, and finds it in one or two cache
 * lines (docs/performance.md). They are exact, and read as reals or with all their bits. */
#define PRECISE_GRAIN3(field, i) PRECISE3((field) + 3 * (size_t)(i))
#define SET_GRAIN3(field, i, v)                              \
    do {                                                     \
        STORE_PRECISE((field)[3 * (size_t)(i)], (v).x);      \
        STORE_PRECISE((field)[3 * (size_t)(i) + 1], (v).y);  \
        STORE_PRECISE((field)[3 * (size_t)(i) + 2], (v).z);  \
    } while (0)
/* Polar vectors (position, velocity, force) lie in the plane of a scene of two dimensions, axial ones (spin, moment) along its normal. What is always
 * 0 there is not read, and of records not stored; of grains it is stored as 0, since three numbers side by side go as one run (effect/dimensions_two.cl). */
#define POLAR3(a) v3(number((a)[0]), number((a)[1]), SPACE_NUMBER(number((a)[2])))
#define AXIAL3(a) v3(SPACE_NUMBER(number((a)[0])), SPACE_NUMBER(number((a)[1])), number((a)[2]))
#define PRECISE_POLAR3(a) precise3_of(precise_load((a)[0]), precise_load((a)[1]), SPACE_PRECISE(precise_load((a)[2])))
#define PRECISE_AXIAL3(a) precise3_of(SPACE_PRECISE(precise_load((a)[0])), SPACE_PRECISE(precise_load((a)[1])), precise_load((a)[2]))
#define GRAIN_POLAR3(field, i) POLAR3((field) + 3 * (size_t)(i))
#define GRAIN_AXIAL3(field, i) AXIAL3((field) + 3 * (size_t)(i))
#define PRECISE_GRAIN_POLAR3(field, i) PRECISE_POLAR3((field) + 3 * (size_t)(i))
#define PRECISE_GRAIN_AXIAL3(field, i) PRECISE_AXIAL3((field) + 3 * (size_t)(i))
#define SET_GRAIN_POLAR3(field, i, v)                                    \
    do {                                                                 \
        STORE_PRECISE((field)[3 * (size_t)(i)], (v).x);                  \
        STORE_PRECISE((field)[3 * (size_t)(i) + 1], (v).y);              \
        STORE_PRECISE((field)[3 * (size_t)(i) + 2], SPACE_PRECISE((v).z));   \
    } while (0)
#define SET_GRAIN_AXIAL3(field, i, v)                                    \
    do {                                                                 \
        STORE_PRECISE((field)[3 * (size_t)(i)], SPACE_PRECISE((v).x));     \
        STORE_PRECISE((field)[3 * (size_t)(i) + 1], SPACE_PRECISE((v).y)); \
        STORE_PRECISE((field)[3 * (size_t)(i) + 2], (v).z);              \
    } while (0)
#define GRAIN_RADIUS(i) number(radius[i])
/* Fields of records are read one record after the other, a component each: component c of a field of `stride` elements a component. */
#define AT(field, stride, c, k) (field)[(size_t)(c) * (size_t)(stride) + (size_t)(k)]
#define LOAD3(field, stride, k) v3(AT(field, stride, 0, k), AT(field, stride, 1, k), AT(field, stride, 2, k))
#define STORE3(field, stride, k, v)        \
    do {                                   \
        AT(field, stride, 0, k) = (v).x;   \
        AT(field, stride, 1, k) = (v).y;   \
        AT(field, stride, 2, k) = (v).z;   \
    } while (0)

#define LOAD_POLAR3(field, stride, k) v3(AT(field, stride, 0, k), AT(field, stride, 1, k), SPACE_NUMBER(AT(field, stride, 2, k)))
#define LOAD_AXIAL3(field, stride, k) v3(SPACE_NUMBER(AT(field, stride, 0, k)), SPACE_NUMBER(AT(field, stride, 1, k)), AT(field, stride, 2, k))
#define STORE_POLAR3(field, stride, k, v)            \
    do {                                             \
        AT(field, stride, 0, k) = (v).x;             \
        AT(field, stride, 1, k) = (v).y;             \
        SPACE_STORE(AT(field, stride, 2, k) = (v).z); \
    } while (0)
#define STORE_AXIAL3(field, stride, k, v)            \
    do {                                             \
        SPACE_STORE(AT(field, stride, 0, k) = (v).x); \
        SPACE_STORE(AT(field, stride, 1, k) = (v).y); \
        AT(field, stride, 2, k) = (v).z;             \
    } while (0)

/* How a slot names its kernel arguments once and has them declared and passed: SLOT_PAIR_FIELDS(READ, WRITE) lists type and name. */
#define DECLARE_READ(type, name) , __global const type *restrict name
#define DECLARE_WRITE(type, name) , __global type *restrict name
#define PASS(type, name) , name

/* A contact, from its owner i to the other body j: a grain, or a wall (infinitely large, heavy and stiff). */
typedef struct contact {
    vec3 n;              /* unit normal from i to j */
    real overlap;        /* m; 0 where the two do not touch */
    real gap;            /* between the surfaces, m; below 0 where the two touch */
    real approach;       /* rate of the overlap, m/s */
    real radius_i, radius_j, mass_i, mass_j;
    real radius_eff;     /* r* = ri rj/(ri + rj); r at a wall */
    real mass_eff;       /* m*; m at a wall */
    real contact_radius; /* sqrt(r* d) */
    real inertia_root;   /* sqrt(m* sqrt(r* d)): every damper of TM is a constant times this */
    real contact_inverse, radius_inverse; /* 1/sqrt(r* d), 0 where the two do not touch; 1/r* */
    real arm_i, arm_j;   /* of the friction force */
    vec3 slip;           /* tangential relative velocity of the surfaces */
    vec3 spin_i, spin_j;
    real neck;           /* radius of a neck of solid material between the two, m; 0 without */
    real touch;          /* overlap whether or not the two act on each other with forces, m */
    real growth_i, growth_j;   /* of the radii in the last step, m */
    real resists_i, resists_j; /* factors of the thermal resistivities, k/k(T) */
    __global const real *tables; /* of properties by temperature */
    real modulus_i, modulus_j; /* factors of Young's moduli; 1 at a wall */
    real temperature_i, temperature_j; /* K; of a wall: that of the grain */
    real dt;             /* of the step to come */
    real span;           /* for which the forces act: the step to come, or the mean of two */
    vec3 ahead, ahead_spin_i, ahead_spin_j; /* what carries relative velocity and spins on to the time of the forces, for the energies */
    /* what histories advance by: motion over the step that led here (under semi-implicit Euler that of its end) */
    real elapsed;        /* its length */
    real past_approach;
    vec3 past_slip, past_spin_i, past_spin_j;
    vec3 turn;           /* rate at which the normal turned */
    int class;           /* row of the contact constants */
    __global const real *value; /* that row */
} contact;

/* A spring, damper and slider over one step, for the energies. */
typedef struct spring_step {
    real stiffness;     /* 0 where the two do not touch */
    real before, after; /* energy at this stiffness, of the stretch before this step and of the stretch now */
    real between;       /* the same of half the product of the two stretches */
    real limit;         /* the most that the spring can give back: of a stretch at which the slider gives way */
    real rescaled;      /* factor by which the law itself shortened the spring */
    bool slides;
    vec3 damper;        /* force or moment of the damper on i */
} spring_step;

/* What a contact dissipates in a step, and the work of stiffnesses that change under a stretched spring, J. */
typedef struct dissipation {
    real normal, tangential, rolling, stiffness;
} dissipation;

/* What the laws make of it. */
typedef struct response {
    real spring, damper; /* the two parts of the normal force */
    real normal;     /* their sum: pushes, and never pulls but where a bond or cohesion lets it */
    real bearing;    /* what friction and rolling are limited by: the normal force, or its compressive part where something also pulls */
    vec3 tangential; /* force on i */
    vec3 rolling;    /* moment on i; j gets the opposite */
    spring_step sliding, turning;
    dissipation lost;
} response;

/* A grain over one step, for what adds up its energies: velocities and spins before and after, total force and torque without and with the
 * background damping. */
typedef struct grain_step {
    real mass, inertia, span; /* span: for which the forces act, s */
    vec3 velocity, velocity_next, spin, spin_next, force, force_damped, torque, torque_damped;
    bool prescribed;
    real grown; /* rotational energy gained by growing, before the torque acts, J */
} grain_step;

INLINE spring_step no_spring(bool slides)
{
    spring_step s = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(1.0), slides, {R(0.0), R(0.0), R(0.0)}};
    return s;
}

/* A spring may hold more than the slider lets it give back: the damper of a sliding contact is balanced by its stretch. */
INLINE real spring_energy(real stiffness, real compliance, vec3 stretch, real limit)
{
    real energy = R(0.5) * stiffness * dot3(stretch, stretch), most = R(0.5) * compliance * limit * limit;
    return energy < most ? energy : most;
}

/* Stiffness and damping of one mode, for the step limit. */
typedef struct mode {
    real stiffness, damping;
} mode;

/* A grain as the laws of its heat see it. */
typedef struct grain {
    vec3 position, velocity;
    real radius, mass, temperature;
    real surroundings; /* temperature of the environment where the grain is, K */
    vec3 gas;          /* velocity of the gas there */
    __global const real *value; /* constants of its material */
    __global const real *tables; /* of properties by temperature */
} grain;

/* Heat that a grain gains, by path: W, or J over a step. */
typedef struct grain_heat {
    real contacts; /* all of them, walls included */
    real walls, sources, convection, radiation, absorbed; /* absorbed: of the sources' that of beams */
    real rubbed; /* from dissipation */
} grain_heat;
