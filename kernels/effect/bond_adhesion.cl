/* bond: adhesion, BM Eq. 15, 22 to 26. While the contact is bonded the normal force is repulsion less adhesion, with a damper on its
 * tangent stiffness,
 *     N = k2 d^a2 - k d^a + 2 xi sqrt(m* k*) d',   k* = max(d/dd (k2 d^a2 - k d^a), 0),   k = K r*^p;
 * k2 d^a2 is whatever the normal law gives. A contact bonds when the criterion is met and d > d_crit, which is where k* > 0 (a < a2), and the
 * bond ends where k* = 0 again, or at a strength; broken by that, it does not bond again before d <= d_crit.
 * With ADHESION_MELTS the bond is liquid while the criterion is met and solid afterwards: then it does not end at d_crit, but resists from there on
 * with the stiffness k_eq that it has at equilibrium, however far it is drawn,
 *     N = -F_pull - k_eq (d_crit - d) + damper,   F_pull = (1 - a/a2) k d_crit^a,   k_eq = (a2 - a) k d_eq^(a-1),
 * and only a strength ends it, over the area pi r* d_eq of the neck at rest (at a wall, also a gap of one radius).
 * Reads ADHESION_STIFFNESS = K, ADHESION_RADIUS_POWER = p, ADHESION_EXPONENT = a, ADHESION_DAMPING = 2 xi, and tensile and shear strength as
 * forces over the area pi r* d; for solid necks d_crit = ADHESION_CRITICAL r*^ADHESION_CRITICAL_POWER (times E*'s factor to the power
 * ADHESION_CRITICAL_MODULUS where adhesion does not follow it), ADHESION_SHARE = a/a2, ADHESION_REST = d_eq/d_crit; history: bonded, twice the bonds that the contact has had, one less while the last one lives; negative after a
 * strength has broken it. Writes normal force and bearing (the repulsion alone). */
#ifndef ADHESION_STIFFNESS
#define ADHESION_STIFFNESS 0
#define ADHESION_RADIUS_POWER 1
#define ADHESION_EXPONENT 2
#define ADHESION_DAMPING 3
#define ADHESION_TENSILE 4
#define ADHESION_SHEAR 5
#define ADHESION_CRITICAL 6
#define ADHESION_CRITICAL_POWER 7
#define ADHESION_CRITICAL_MODULUS 8
#define ADHESION_SHARE 9
#define ADHESION_REST 10
#endif
/* 1: solid once the criterion is no longer met. */
#ifndef ADHESION_MELTS
#define ADHESION_MELTS 0
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
/* 1: all contacts of the scene share 4 a and 4 p, two whole numbers, and roots will do. */
#ifndef ADHESION_SHARED
#define ADHESION_SHARED 0
#define ADHESION_QUARTERS 4
#define ADHESION_RADIUS_QUARTERS 0
#endif
#define BOND_PAIR_FIELDS(READ, WRITE) WRITE(real, bonded)
#define BOND_ASK_FOR(launch, k) RECORDS_ASK_FOR(launch, bonded, 1, k)
#define BOND_LOAD(launch, k, s)                  \
    do {                                         \
        (s).count = bonded[k];                   \
        (s).bonding = BONDING_LOAD(launch, k);   \
    } while (0)
#define BOND_STORE(launch, k, s) bonded[k] = (s).count

typedef struct bond_state {
    real count, bonding; /* bonding: TO_COME for a bond that is to come */
} bond_state;
#define TO_COME R(1e29)

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

/* k d^a, and 0 where d is. */
INLINE real adhesion_at(const contact *c, real d)
{
    real k = (ADHESION_FOLLOWS ? modulus_normal(c) : R(1.0)) * c->value[ADHESION_STIFFNESS];
    if (ADHESION_SHARED)
        return k * adhesion_power(ADHESION_RADIUS_QUARTERS < 0 ? c->radius_inverse : c->radius_eff, abs(ADHESION_RADIUS_QUARTERS), d, ADHESION_QUARTERS);
    bool touches = d > R(0.0);
    real force = k * power_of(c->radius_eff, c->value[ADHESION_RADIUS_POWER]) * power_of(touches ? d : R(1.0), c->value[ADHESION_EXPONENT]);
    return touches ? force : R(0.0);
}

INLINE real adhesion_force(const contact *c)
{
    return adhesion_at(c, c->overlap);
}

/* A solid neck drawn below the critical overlap. */
typedef struct adhesion_neck {
    real critical, pull, stiffness; /* d_crit, F_pull, k_eq */
    real adhered;                   /* k d_crit^a */
    real drawn;                     /* d_crit - d */
} adhesion_neck;

INLINE adhesion_neck adhesion_neck_of(const contact *c)
{
    adhesion_neck n;
    real softened = ADHESION_FOLLOWS ? R(1.0) : power_of(modulus_normal(c), c->value[ADHESION_CRITICAL_MODULUS]);
    real a = c->value[ADHESION_EXPONENT], share = c->value[ADHESION_SHARE];
    n.critical = softened * c->value[ADHESION_CRITICAL] * power_of(c->radius_eff, c->value[ADHESION_CRITICAL_POWER]);
    n.adhered = adhesion_at(c, n.critical);
    n.pull = (R(1.0) - share) * n.adhered;
    n.stiffness = (a / share - a) * n.adhered * power_of(c->value[ADHESION_REST], a - R(1.0)) / n.critical;
    n.drawn = n.critical + c->gap;
    return n;
}

INLINE bool adhesion_is_solid(const contact *c, const bond_state *s)
{
    return ADHESION_MELTS && !(bonding_value(c, s->bonding) > c->value[BONDING_THRESHOLD]);
}

/* The overlap whose neck bears a strength, m. */
INLINE real adhesion_bearing(const contact *c)
{
    return ADHESION_MELTS ? c->value[ADHESION_REST] * adhesion_neck_of(c).critical : c->overlap;
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
    real lived = bond_lives(s->count);
    bool solid = adhesion_is_solid(c, s) && lived > R(0.5), drawn = false;
    if (ADHESION_MELTS) {
        adhesion_neck neck = adhesion_neck_of(c);
        drawn = solid && !holds;
        tangent = drawn ? neck.stiffness : tangent;
        net = drawn ? -neck.pull - neck.stiffness * neck.drawn : net;
    }
    real damper = c->value[ADHESION_DAMPING] * sqrt(c->mass_eff * (holds || drawn ? tangent : R(0.0))) * c->approach;
    bool may = bonding_value(c, s->bonding) > c->value[BONDING_THRESHOLD] && s->count >= R(0.0);
    bool torn = ADHESION_TEARS && -net > c->value[ADHESION_TENSILE] * c->radius_eff * adhesion_bearing(c);
    if (ADHESION_MELTS) /* what is liquid has no strength; further from a wall the table does not look */
        torn = solid && (torn || (!(c->arm_j > R(0.0)) && c->gap > c->radius_i));
    bool lives = (holds || drawn) && !torn && (lived > R(0.5) || may);
    real force = net + damper;
    if (ADHESION_CLAMPS) { /* beyond equilibrium no net pull, short of it no net push (BM sec. 4) */
        real push = force > R(0.0) ? force : R(0.0), pulled = force < R(0.0) ? force : R(0.0);
        force = net > R(0.0) ? push : pulled;
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
    if (!ADHESION_TEARS)
        return;
    real most = c->value[ADHESION_SHEAR] * c->radius_eff * adhesion_bearing(c);
    bool bears = bond_lives(s->count) > R(0.5);
    if (ADHESION_MELTS)
        bears = bears && adhesion_is_solid(c, s);
    bool torn = bears && dot3(out->tangential, out->tangential) > most * most;
    s->count = torn ? -(s->count + R(1.0)) : s->count;
}

/* Below d_crit: to there that of spring and adhesion, then that of the line, less what the normal law counts. */
INLINE real bond_energy(const contact *c, const bond_state *s)
{
    bool lives = bond_lives(s->count) > R(0.5);
    real a = c->value[ADHESION_EXPONENT], energy = -adhesion_force(c) * c->overlap / (a + R(1.0));
    if (ADHESION_MELTS) {
        adhesion_neck neck = adhesion_neck_of(c);
        real share = c->value[ADHESION_SHARE], start = neck.adhered * neck.critical * (share / (a / share + R(1.0)) - R(1.0) / (a + R(1.0)));
        real line = start + neck.drawn * (neck.pull + R(0.5) * neck.stiffness * neck.drawn);
        real counted = c->overlap > R(0.0) ? normal_energy(c) : R(0.0);
        energy = neck.drawn > R(0.0) && s->bonding < TO_COME ? line - counted : energy;
    }
    return lives ? energy : R(0.0);
}

INLINE void bond_modes(const contact *c, const bond_state *s, mode *normal, mode *tangential, mode *rolling)
{
    real tangent = normal_mode(c).stiffness - adhesion_softening(c, adhesion_force(c));
    if (ADHESION_MELTS) {
        adhesion_neck neck = adhesion_neck_of(c);
        tangent = neck.drawn > R(0.0) ? neck.stiffness : tangent;
    }
    tangent = tangent > R(0.0) ? tangent : R(0.0);
    bool lives = bond_lives(s->count) > R(0.5);
    normal->stiffness = lives ? tangent : normal->stiffness;
    normal->damping = lives ? c->value[ADHESION_DAMPING] * sqrt(c->mass_eff * tangent) : normal->damping;
    (void)tangential;
    (void)rolling;
}

/* Whether the two, as near as they are, may still get a bond that they do not have. */
INLINE bool bond_may_come(const contact *c, const bond_state *s)
{
    bool holds = bond_holds(s) > R(0.5);
    return !holds && s->count >= R(0.0) && c->gap <= R(0.0) && c->value[BONDING_THRESHOLD] < R(1e29) && BONDING_COMES(s->bonding);
}

/* A pair that cannot bond has no adhesion: it keeps the modes of its contact. An impact comes from outside, where no neck is drawn. */
INLINE bond_state bond_expected(const contact *c)
{
    bond_state s = {c->value[BONDING_THRESHOLD] < R(1e29) ? R(1.0) : R(0.0), TO_COME};
    return s;
}
