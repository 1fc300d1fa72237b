/* bond: adhesion, BM Eq. 15, 22 to 26. While the contact is bonded the normal force is repulsion less adhesion, with a damper on its
 * tangent stiffness,
 *     N = k2 d^a2 - k d^a + 2 xi sqrt(m* k*) d',   k* = max(d/dd (k2 d^a2 - k d^a), 0),   k = K r*^p;
 * k2 d^a2 is whatever the normal law gives. A contact bonds when the criterion is met and d > d_crit, which is where k* > 0 (a < a2), and the
 * bond ends where k* = 0 again, or at a strength; broken by that, it does not bond again before d <= d_crit.
 * Reads ADHESION_STIFFNESS = K, ADHESION_RADIUS_POWER = p, ADHESION_EXPONENT = a, ADHESION_DAMPING = 2 xi, and tensile and shear strength as
 * forces over the area pi r* d; history: bonded, twice the bonds that the contact has had, one less while the last one lives; negative after a
 * strength has broken it. Writes normal force and bearing (the repulsion alone). */
#ifndef ADHESION_STIFFNESS
#define ADHESION_STIFFNESS 0
#define ADHESION_RADIUS_POWER 1
#define ADHESION_EXPONENT 2
#define ADHESION_DAMPING 3
#define ADHESION_TENSILE 4
#define ADHESION_SHEAR 5
#endif
/* 1: adhesion softens with the modulus of the contact, so that the overlaps at rest stay. */
#ifndef ADHESION_FOLLOWS
#define ADHESION_FOLLOWS 1
#endif
#ifndef ADHESION_CLAMPS
#define ADHESION_CLAMPS 1
#endif
/* 0: no contact of the scene has a strength, and none is torn. */
#ifndef ADHESION_TEARS
#define ADHESION_TEARS 1
#endif
/* 1: all contacts of the scene share 4 a and 4 p, two whole numbers, and roots will do; pow() ends the vector code of the pair stage. */
#ifndef ADHESION_SHARED
#define ADHESION_SHARED 0
#define ADHESION_QUARTERS 4
#define ADHESION_RADIUS_QUARTERS 0
#endif
#define BOND_PAIR_FIELDS(READ, WRITE) WRITE(real, bonded)
#define BOND_LOAD(launch, k, s)                  \
    do {                                         \
        (s).count = bonded[k];                   \
        (s).bonding = BONDING_LOAD(launch, k);   \
    } while (0)
#define BOND_STORE(launch, k, s) bonded[k] = (s).count

typedef struct bond_state {
    real count, bonding;
} bond_state;

/* 1 for an odd count. */
INLINE real bond_lives(real count)
{
    real size = fabs(count);
    return size - R(2.0) * floor(R(0.5) * size);
}

INLINE real bond_holds(const bond_state *s)
{
    return bond_lives(s->count);
}

INLINE real adhesion_whole(real x, int n)
{
    real square = x * x, result = (n & 1) != 0 ? x : R(1.0);
    result = (n & 2) != 0 ? result * square : result;
    return (n & 4) != 0 ? result * square * square : result;
}

/* x^(m/4) y^(n/4) for constants in 0..31: what is not called for folds away. One chain of roots for both, since two alike are packed into one
 * vector, which ends that over pairs. */
INLINE real adhesion_power(real x, int m, real y, int n)
{
    real fourth = ((m & 1) != 0 ? x : R(1.0)) * ((n & 1) != 0 ? y : R(1.0));
    real second = ((m & 2) != 0 ? x : R(1.0)) * ((n & 2) != 0 ? y : R(1.0));
    return sqrt(second * sqrt(fourth)) * adhesion_whole(x, m >> 2) * adhesion_whole(y, n >> 2);
}

/* k d^a where the two touch. */
INLINE real adhesion_force(const contact *c)
{
    real k = (ADHESION_FOLLOWS ? modulus_normal(c) : R(1.0)) * c->value[ADHESION_STIFFNESS], d = c->overlap;
    if (ADHESION_SHARED)
        return k * adhesion_power(ADHESION_RADIUS_QUARTERS < 0 ? c->radius_inverse : c->radius_eff, abs(ADHESION_RADIUS_QUARTERS), d, ADHESION_QUARTERS);
    bool touches = d > R(0.0);
    real force = k * pow(c->radius_eff, c->value[ADHESION_RADIUS_POWER]) * pow(touches ? d : R(1.0), c->value[ADHESION_EXPONENT]);
    return touches ? force : R(0.0);
}

/* a k d^(a-1); 1/d from 1/sqrt(r* d). */
INLINE real adhesion_softening(const contact *c, real force)
{
    return c->value[ADHESION_EXPONENT] * force * (c->contact_inverse * c->contact_inverse * c->radius_eff);
}

INLINE void bond_geometry(contact *c, const bond_state *s)
{
    (void)c;
    (void)s;
}

INLINE void bond_normal(const contact *c, bond_state *s, response *out)
{
    real pull = adhesion_force(c), tangent = normal_mode(c).stiffness - adhesion_softening(c, pull);
    bool holds = tangent > R(0.0) && c->overlap > R(0.0);
    real net = out->spring - pull;
    real damper = c->value[ADHESION_DAMPING] * sqrt(c->mass_eff * (holds ? tangent : R(0.0))) * c->approach;
    real lived = bond_lives(s->count);
    bool may = bonding_value(c, s->bonding) > c->value[BONDING_THRESHOLD] && s->count >= R(0.0);
    bool torn = ADHESION_TEARS && -net > c->value[ADHESION_TENSILE] * c->radius_eff * c->overlap;
    bool lives = holds && !torn && (lived > R(0.5) || may);
    real force = net + damper;
    if (ADHESION_CLAMPS) { /* beyond equilibrium no net pull, short of it no net push (BM sec. 4) */
        real push = force > R(0.0) ? force : R(0.0), drawn = force < R(0.0) ? force : R(0.0);
        force = net > R(0.0) ? push : drawn;
    }
    out->normal = lives ? force : out->normal;
    out->bearing = lives ? out->spring : out->bearing;
    out->spring = lives ? net : out->spring;
    out->damper = lives ? damper : out->damper;
    real size = fabs(s->count), now = lives ? R(1.0) : R(0.0);
    size = now == lived ? size : size + R(1.0);
    bool blocked = ADHESION_TEARS && holds && !lives && (s->count < R(0.0) || (torn && lived > R(0.5)));
    s->count = blocked ? -size : size;
}

/* The force along the surface that the bond's area can bear. */
INLINE void bond_shear(const contact *c, bond_state *s, response *out)
{
    real most = c->value[ADHESION_SHEAR] * c->radius_eff * c->overlap;
    bool torn = bond_lives(s->count) > R(0.5) && dot3(out->tangential, out->tangential) > most * most;
    s->count = torn ? -(s->count + R(1.0)) : s->count;
}

INLINE real bond_energy(const contact *c, const bond_state *s)
{
    return bond_lives(s->count) > R(0.5) ? -adhesion_force(c) * c->overlap / (c->value[ADHESION_EXPONENT] + R(1.0)) : R(0.0);
}

INLINE void bond_modes(const contact *c, const bond_state *s, mode *normal, mode *tangential, mode *rolling)
{
    real tangent = normal_mode(c).stiffness - adhesion_softening(c, adhesion_force(c));
    tangent = tangent > R(0.0) ? tangent : R(0.0);
    bool lives = bond_lives(s->count) > R(0.5);
    normal->stiffness = lives ? tangent : normal->stiffness;
    normal->damping = lives ? c->value[ADHESION_DAMPING] * sqrt(c->mass_eff * tangent) : normal->damping;
    (void)tangential;
    (void)rolling;
}

/* A pair that cannot bond has no adhesion: it keeps the modes of its contact. */
INLINE bond_state bond_expected(const contact *c)
{
    bond_state s = {c->value[BONDING_THRESHOLD] < R(1e29) ? R(1.0) : R(0.0), R(0.0)};
    return s;
}
