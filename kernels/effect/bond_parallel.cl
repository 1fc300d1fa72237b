/* bond: a cemented beam beside the contact (Potyondy and Cundall 2004; bond_beam.cl), of radius b = lambda min(ri, rj). The contact stays as it is
 * beside it. A bond is made when the criterion is met and the surfaces are no further apart than a share of the smaller radius.
 * With PARALLEL_LIQUID the beam is liquid while the criterion is met: it carries nothing, and its length at rest is the present one; it is gone
 * once the surfaces are too far apart for a new one. It sets when the criterion is no longer met, and only a strength ends it then.
 * Reads PARALLEL_YOUNG = E, PARALLEL_SHEAR = G, PARALLEL_RADIUS = lambda, PARALLEL_DAMPING = 2 xi, PARALLEL_TENSILE, PARALLEL_SHEAR_STRENGTH,
 * PARALLEL_GAP, PARALLEL_ROOT = sqrt(G/E); history: bonded (as for adhesion), bond_gap, bond_shear, bond_turn. Writes forces and moments. */
#ifndef PARALLEL_YOUNG
#define PARALLEL_YOUNG 0
#define PARALLEL_SHEAR 1
#define PARALLEL_RADIUS 2
#define PARALLEL_DAMPING 3
#define PARALLEL_TENSILE 4
#define PARALLEL_SHEAR_STRENGTH 5
#define PARALLEL_GAP 6
#define PARALLEL_ROOT 7
#endif
#ifndef PARALLEL_LIQUID
#define PARALLEL_LIQUID 0
#endif
#define BEAM_YOUNG          PARALLEL_YOUNG
#define BEAM_SHEAR          PARALLEL_SHEAR
#define BEAM_DAMPING        PARALLEL_DAMPING
#define BEAM_TENSILE        PARALLEL_TENSILE
#define BEAM_SHEAR_STRENGTH PARALLEL_SHEAR_STRENGTH
#define BEAM_ROOT           PARALLEL_ROOT
#define BEAM_LIQUID         PARALLEL_LIQUID
#define BEAM_ALONE          0
#define BOND_PAIR_FIELDS(READ, WRITE) WRITE(real, bonded) WRITE(real, bond_gap) WRITE(real, bond_shear) WRITE(real, bond_turn)
#define BOND_ASK_FOR(launch, k)                   \
    do {                                         \
        RECORDS_ASK_FOR(launch, bonded, 1, k);     \
        RECORDS_ASK_FOR(launch, bond_gap, 1, k);   \
        RECORDS_ASK_FOR(launch, bond_shear, 3, k); \
        RECORDS_ASK_FOR(launch, bond_turn, 3, k);  \
    } while (0)
#define BOND_LOAD(launch, k, s)                                          \
    do {                                                                 \
        (s).count = bonded[k];                                           \
        (s).bonding = BONDING_LOAD(launch, k);                           \
        (s).gap = bond_gap[k];                                           \
        (s).shear = LOAD_POLAR3(bond_shear, (launch)->record_stride, k);       \
        (s).turn = LOAD_AXIAL3(bond_turn, (launch)->record_stride, k);         \
    } while (0)
#define BOND_STORE(launch, k, s)                                         \
    do {                                                                 \
        bonded[k] = (s).count;                                           \
        bond_gap[k] = (s).gap;                                           \
        STORE_POLAR3(bond_shear, (launch)->record_stride, k, (s).shear);       \
        STORE_AXIAL3(bond_turn, (launch)->record_stride, k, (s).turn);         \
    } while (0)

typedef struct bond_state {
    real count, bonding, gap;
    vec3 shear, turn;
} bond_state;

INLINE real beam_radius(const contact *c, const bond_state *s)
{
    (void)s;
    return c->value[PARALLEL_RADIUS] * (c->radius_i < c->radius_j ? c->radius_i : c->radius_j);
}

/* Gap between the surfaces at which the beam is at rest: where it was made. */
INLINE real beam_rest(const contact *c, const bond_state *s)
{
    (void)c;
    return s->gap;
}

/* Gap up to which a bond is made. */
INLINE real beam_reach(const contact *c)
{
    return c->value[PARALLEL_GAP] * (c->radius_i < c->radius_j ? c->radius_i : c->radius_j);
}

INLINE void beam_made(const contact *c, bond_state *s, const response *out, bool made)
{
    (void)out;
    s->gap = made ? c->gap : s->gap;
}

/* A step on, under the push of its spring: nothing changes. The rate at which the length at rest falls, m/s. */
INLINE real beam_aged(const contact *c, bond_state *s, real push, bool lives)
{
    (void)c;
    (void)s;
    (void)push;
    (void)lives;
    return R(0.0);
}

/* Radius of the neck that conducts; 0: the contact's own. */
INLINE real beam_neck(const contact *c, const bond_state *s)
{
    (void)c;
    (void)s;
    return R(0.0);
}

INLINE void beam_expected(const contact *c, bond_state *s)
{
    (void)c;
    s->gap = R(0.0);
}
