/* bond: a neck of solid material between two grains that sinters: a beam (bond_beam.cl) whose radius is that of the neck, a, and whose length at
 * rest creeps. Along its axis an elastic spring stands in series with a viscous contact (Bouvier and McMeeking 1996, Parhami and McMeeking 1998:
 * diffusion along the grain boundary), with h the approach that has been accommodated and N the push of the spring,
 *     pi a^4/(8 D) dh/dt = N + F,   F = 9/4 pi gamma r*,   D = Omega (delta D_b)/(k_B T) exp(-Q/(R T)),
 * and the neck is Coble's (1958), a^2 = 4 r* h. Free of load this is d(a^6)/dt = 216 D gamma r*^2 (54 D gamma r^2 for two grains of radius r), and
 * in g = (a/2r*)^6, which is what is followed, dg/dt = 27/8 D gamma/r*^4 (1 + N/F), with N as it will be at the end of the step, when the spring
 * of stiffness k has crept by dh and been pressed by d' dt: however stiff it is, it relaxes and does not swing. Shear, bending and torsion are elastic. T is the mean of the two temperatures.
 * A bond is made when the criterion is met and the two touch (or nearly), with Hertz's radius of contact or a least one, whichever is larger, and with
 * the push of the contact, whose place it takes: no friction or rolling resistance beside it. It grows up to a largest radius.
 * Reads SINTER_YOUNG = E, SINTER_SHEAR = G, SINTER_DAMPING = 2 xi, SINTER_TENSILE, SINTER_SHEAR_STRENGTH, SINTER_ROOT = sqrt(G/E),
 * SINTER_RATE = 27/8 gamma Omega delta D_0/k_B (m4 K/s), SINTER_ACTIVATION = Q/R (K), SINTER_PULL = 9/4 pi gamma, SINTER_LEAST and SINTER_MOST =
 * radii of necks over that of the smaller grain, SINTER_GAP = gap up to which one is made over it; temperatures; history: bonded (as for adhesion), bond_gap (the gap between the surfaces at rest,
 * with h), bond_shear, bond_turn, neck_growth and neck_growth_low = g and what rounding leaves of it. */
#ifndef SINTER_YOUNG
#define SINTER_YOUNG 0
#define SINTER_SHEAR 1
#define SINTER_DAMPING 2
#define SINTER_TENSILE 3
#define SINTER_SHEAR_STRENGTH 4
#define SINTER_ROOT 5
#define SINTER_RATE 6
#define SINTER_ACTIVATION 7
#define SINTER_PULL 8
#define SINTER_LEAST 9
#define SINTER_MOST 10
#define SINTER_GAP 11
#endif
#define BEAM_YOUNG          SINTER_YOUNG
#define BEAM_SHEAR          SINTER_SHEAR
#define BEAM_DAMPING        SINTER_DAMPING
#define BEAM_TENSILE        SINTER_TENSILE
#define BEAM_SHEAR_STRENGTH SINTER_SHEAR_STRENGTH
#define BEAM_ROOT           SINTER_ROOT
#define BEAM_LIQUID         0
#define BEAM_ALONE          1
#define BOND_PAIR_FIELDS(READ, WRITE)                                                              \
    WRITE(real, bonded) WRITE(real, bond_gap) WRITE(real, bond_shear) WRITE(real, bond_turn)       \
    WRITE(real, neck_growth) WRITE(real, neck_growth_low)
#define BOND_ASK_FOR(launch, k)                        \
    do {                                              \
        RECORDS_ASK_FOR(launch, bonded, 1, k);          \
        RECORDS_ASK_FOR(launch, bond_gap, 1, k);        \
        RECORDS_ASK_FOR(launch, bond_shear, 3, k);      \
        RECORDS_ASK_FOR(launch, bond_turn, 3, k);       \
        RECORDS_ASK_FOR(launch, neck_growth, 1, k);     \
        RECORDS_ASK_FOR(launch, neck_growth_low, 1, k); \
    } while (0)
#define BOND_LOAD(launch, k, s)                                          \
    do {                                                                 \
        (s).count = bonded[k];                                           \
        (s).bonding = BONDING_LOAD(launch, k);                           \
        (s).gap = bond_gap[k];                                           \
        (s).shear = LOAD_POLAR3(bond_shear, (launch)->record_stride, k);       \
        (s).turn = LOAD_AXIAL3(bond_turn, (launch)->record_stride, k);         \
        (s).growth = neck_growth[k];                                     \
        (s).growth_low = neck_growth_low[k];                             \
    } while (0)
#define BOND_STORE(launch, k, s)                                         \
    do {                                                                 \
        bonded[k] = (s).count;                                           \
        bond_gap[k] = (s).gap;                                           \
        STORE_POLAR3(bond_shear, (launch)->record_stride, k, (s).shear);       \
        STORE_AXIAL3(bond_turn, (launch)->record_stride, k, (s).turn);         \
        neck_growth[k] = (s).growth;                                     \
        neck_growth_low[k] = (s).growth_low;                             \
    } while (0)

typedef struct bond_state {
    real count, bonding, gap;
    vec3 shear, turn;
    real growth, growth_low; /* g, and what rounding leaves of it */
} bond_state;

/* (a/2r*)^2 = h/r* of a neck */
INLINE real sinter_square(real growth)
{
    return cube_root(growth > R(0.0) ? growth : R(1e-30));
}

/* g of a neck whose radius is `ratio` of the smaller grain's. */
INLINE real sinter_growth(const contact *c, real ratio)
{
    real x = R(0.5) * ratio * (c->radius_i < c->radius_j ? c->radius_i : c->radius_j) / c->radius_eff, square = x * x;
    return square * square * square;
}

INLINE real beam_radius(const contact *c, const bond_state *s)
{
    return R(2.0) * c->radius_eff * sqrt(sinter_square(s->growth));
}

INLINE real beam_rest(const contact *c, const bond_state *s)
{
    return s->gap - c->radius_eff * sinter_square(s->growth);
}

INLINE real beam_reach(const contact *c)
{
    return c->value[SINTER_GAP] * (c->radius_i < c->radius_j ? c->radius_i : c->radius_j);
}

/* Stiffness of the stretch by (a/2r*)^2 where the surfaces are about to touch. */
INLINE real sinter_stiffness(const contact *c, real square)
{
    real length = c->radius_i + (c->arm_j > R(0.0) ? c->radius_j : R(0.0));
    return c->value[SINTER_YOUNG] * R(12.5663706143591730) * c->radius_eff * c->radius_eff * square / length;
}

INLINE void beam_made(const contact *c, bond_state *s, const response *out, bool made)
{
    real least = sinter_growth(c, c->value[SINTER_LEAST]), most = sinter_growth(c, c->value[SINTER_MOST]);
    real hertz = R(0.25) * c->overlap / c->radius_eff, growth = hertz * hertz * hertz; /* of a radius sqrt(r* d) */
    growth = growth > least ? growth : least;
    growth = growth < most ? growth : most;
    real square = sinter_square(growth), young = c->value[SINTER_YOUNG];
    real shortened = young > R(0.0) ? out->spring / sinter_stiffness(c, square) : R(0.0);
    s->gap = made ? c->gap + shortened + c->radius_eff * square : s->gap;
    s->growth = made ? growth : s->growth;
    s->growth_low = made ? R(0.0) : s->growth_low;
}

/* exp(-u) for u >= 0 without a call, which would end vectorisation: to the 128th power of exp(-u/128), one over its series. */
INLINE real sinter_exponential(real u)
{
    real v = u * R(0.0078125);
    real series = R(1.0) + v * (R(1.0) / R(10.0));
    series = R(1.0) + v * (R(1.0) / R(9.0)) * series;
    series = R(1.0) + v * (R(1.0) / R(8.0)) * series;
    series = R(1.0) + v * (R(1.0) / R(7.0)) * series;
    series = R(1.0) + v * (R(1.0) / R(6.0)) * series;
    series = R(1.0) + v * (R(1.0) / R(5.0)) * series;
    series = R(1.0) + v * (R(1.0) / R(4.0)) * series;
    series = R(1.0) + v * (R(1.0) / R(3.0)) * series;
    series = R(1.0) + v * R(0.5) * series;
    series = R(1.0) + v * series;
    real power = R(1.0) / series;
    power *= power;
    power *= power;
    power *= power;
    power *= power;
    power *= power;
    power *= power;
    return power * power;
}

/* A step of growth under the push of the spring; the rate at which the length at rest falls, dh/dt = r* dg/dt/(3 g^(2/3)), m/s. Material that joins the neck is not sheared or bent: springs keep their forces. */
INLINE real beam_aged(const contact *c, bond_state *s, real push, bool lives)
{
    real temperature = R(0.5) * (c->temperature_i + c->temperature_j), inverse = R(1.0) / (temperature > R(0.0) ? temperature : R(1.0));
    real pull = c->value[SINTER_PULL] * c->radius_eff, square = sinter_square(s->growth), per_radius = c->radius_inverse * c->radius_inverse;
    real rate = c->value[SINTER_RATE] * inverse * per_radius * per_radius * sinter_exponential(c->value[SINTER_ACTIVATION] * inverse);
    bool fast = !(c->elapsed * rate < R(1e6)); /* g is at most 1: what is faster, or no number, is done in this step */
    rate = fast ? R(1e6) / (c->elapsed > R(0.0) ? c->elapsed : R(1.0)) : rate;
    real stretch = sinter_stiffness(c, square), relaxed = stretch * c->elapsed * rate / (R(3.0) * c->value[SINTER_PULL] * square * square);
    real least = sinter_growth(c, c->value[SINTER_LEAST]), most = sinter_growth(c, c->value[SINTER_MOST]);
    real growing = rate * (R(1.0) + (push + stretch * c->elapsed * c->approach) / pull) / (R(1.0) + relaxed);
    precise next = precise_add(precise_of(s->growth, s->growth_low), precise_from(c->elapsed * growing));
    real after = rounded(next);
    bool within = after > least && after < most, moves = lives && c->elapsed > R(0.0);
    real bound = after > least ? most : least;
    s->growth_low = moves ? (within ? precise_rest(next) : R(0.0)) : s->growth_low;
    s->growth = moves ? (within ? after : bound) : s->growth;
    real share = square / sinter_square(s->growth);
    s->shear = scale(lives ? share : R(1.0), s->shear);
    s->turn = scale(lives ? share * share : R(1.0), s->turn);
    return within ? c->radius_eff * growing / (R(3.0) * square * square) : R(0.0);
}

INLINE real beam_neck(const contact *c, const bond_state *s)
{
    return beam_radius(c, s);
}

/* As wide as a neck becomes. */
INLINE void beam_expected(const contact *c, bond_state *s)
{
    s->growth = sinter_growth(c, c->value[SINTER_MOST]);
    s->growth_low = R(0.0);
    s->gap = c->radius_eff * sinter_square(s->growth);
}
