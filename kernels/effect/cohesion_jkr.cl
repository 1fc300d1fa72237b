/* cohesion: Johnson, Kendall and Roberts 1971, with its hysteresis. The contact radius a follows from the overlap d,
 *     d = a^2/r* - sqrt(2 pi w a/E*),   P = 4 E* a^3/(3 r*),   N = [P + damper]_+ - sqrt(8 pi w E* a^3).
 * Two bodies stick as soon as they touch (d = 0) and let go at d = -3 a_c^2/r*, a_c^3 = pi w r*^2/(8 E*): in between there is a neck, and the
 * history says whether there is contact. With a = a_c y^2 the first equation is y^4 - 4 y = r* d/a_c^2, whose upper branch is z = y - 1 from
 * z^2 (z^2 + 4 z + 6) = p = 3 + r* d/a_c^2. Friction is limited by [P + damper]_+.
 * Takes the place of Hertz's spring and damper. Reads JKR_MODULUS = E*, JKR_LENGTH = (pi w/(8 E*))^(1/3), NORMAL_DAMPING of Hertz;
 * history: neck. */
#ifndef JKR_MODULUS
#define JKR_MODULUS 0
#define JKR_LENGTH 1
#endif
#ifndef NORMAL_DAMPING
#define NORMAL_DAMPING 0
#endif
#define COHESION_PAIR_FIELDS(READ, WRITE) WRITE(real, neck)
#define COHESION_LOAD(launch, k, s) (s).neck = neck[k]
#define COHESION_STORE(launch, k, s) neck[k] = (s).neck

typedef struct cohesion_state {
    real neck; /* 1 while there is contact */
} cohesion_state;

typedef struct jkr_neck {
    real critical, radius; /* a_c, a; 0 where there is no contact */
    bool holds;
} jkr_neck;

/* One of Newton's steps for z sqrt(z^2 + 4 z + 6) = sqrt(p). */
INLINE real jkr_newton(real z, real wanted)
{
    real t = sqrt(z * z + R(4.0) * z + R(6.0));
    return z - (z * t - wanted) * t / (R(2.0) * z * z + R(6.0) * z + R(6.0));
}

INLINE jkr_neck jkr_of(const contact *c, real before)
{
    jkr_neck k;
    real root = cube_root(c->radius_eff);
    k.critical = c->value[JKR_LENGTH] * root * root;
    bool sticky = k.critical > R(0.0);
    real scale2 = sticky ? k.critical * k.critical : R(1.0);
    real p = R(3.0) - c->gap * c->radius_eff / scale2;
    k.holds = sticky && (c->gap < R(0.0) || (before > R(0.5) && p > R(0.0)));
    p = k.holds ? p : R(0.0);
    real wanted = sqrt(p), z = R(0.40824829046386302) * wanted;
    real other = sqrt(wanted);
    z = z < other ? z : other;
    z = jkr_newton(jkr_newton(jkr_newton(jkr_newton(jkr_newton(z, wanted), wanted), wanted), wanted), wanted);
    k.radius = k.holds ? k.critical * (R(1.0) + z) * (R(1.0) + z) : R(0.0);
    return k;
}

/* sqrt(8 pi w E*) = 8 E* a_c^(3/2)/r* */
INLINE void cohesion_force(const contact *c, cohesion_state *s, response *out)
{
    jkr_neck k = jkr_of(c, s->neck);
    real modulus = c->value[JKR_MODULUS], cube = k.radius * k.radius * k.radius;
    real push = R(1.33333333333333333) * modulus * cube * c->radius_inverse;
    real damper = c->value[NORMAL_DAMPING] * sqrt(c->mass_eff * k.radius) * c->approach;
    real pull = R(8.0) * modulus * sqrt(k.critical * k.critical * k.critical * cube) * c->radius_inverse;
    real bearing = push + damper > R(0.0) ? push + damper : R(0.0);
    bool plain = !(k.critical > R(0.0)); /* no cohesion between these two: Hertz stays */
    out->spring = plain ? out->spring : push - pull;
    out->damper = plain ? out->damper : damper;
    out->normal = plain ? out->normal : bearing - pull;
    out->bearing = plain ? out->bearing : bearing;
    s->neck = k.holds ? R(1.0) : R(0.0);
}

/* The integral of N over d from a = 0, less what the normal law counts: 8 E* a^5/(15 r*^2) - 16/3 E* (a a_c)^(3/2) a^2/r*^2 + 8 E* a_c^3 a^2/r*^2. */
INLINE real cohesion_energy(const contact *c, const cohesion_state *s)
{
    jkr_neck k = jkr_of(c, s->neck);
    real a = k.radius, b = k.critical, modulus = c->value[JKR_MODULUS], hertz = c->overlap > R(0.0) ? normal_energy(c) : R(0.0);
    real sum = R(0.53333333333333333) * a * a * a - R(5.33333333333333333) * sqrt(a * b) * a * b + R(8.0) * b * b * b;
    real energy = modulus * a * a * c->radius_inverse * c->radius_inverse * sum - hertz;
    return b > R(0.0) ? energy : R(0.0);
}

INLINE cohesion_state cohesion_expected(const contact *c)
{
    cohesion_state s = {R(1.0)};
    (void)c;
    return s;
}

/* dN/dd = 2 E* a (1 - 3 y^-3)/(1 - y^-3), at most 2 E* a. */
INLINE void cohesion_mode(const contact *c, const cohesion_state *s, mode *normal)
{
    jkr_neck k = jkr_of(c, s->neck);
    bool plain = !(k.critical > R(0.0));
    normal->stiffness = plain ? normal->stiffness : R(2.0) * c->value[JKR_MODULUS] * k.radius;
    normal->damping = plain ? normal->damping : c->value[NORMAL_DAMPING] * sqrt(c->mass_eff * k.radius);
}
