/* bond: a cemented beam beside the contact (Potyondy and Cundall 2004), of radius b = lambda min(ri, rj) and length L, the distance of the centres
 * when it was made; it stretches, shears, bends and twists, with area A = pi b^2 and moments I = pi b^4/4, J = 2 I:
 *     F = (E A/L) u n, u the extension since then,       S = -(G A/L) D,
 *     B = -(E I/L) theta across n,                       T = -(G J/L) theta along n,
 * each with a damper of 2 xi sqrt(k m) (inertia m for moments). D (m) and theta (rad) are followed step by step and turned with the pair. The
 * contact stays as it is beside it. The bond breaks where F/A + |B| b/I passes the tensile strength or |S|/A + |T| b/J the shear strength.
 * A bond is made when the criterion is met and the surfaces are no further apart than a share of the smaller radius; it may be stretched to any
 * length that its strength allows, at a wall to the radius.
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
#define BOND_PAIR_FIELDS(READ, WRITE) WRITE(real, bonded) WRITE(real, bond_gap) WRITE(real, bond_shear) WRITE(real, bond_turn)
#define BOND_LOAD(launch, k, s)                                          \
    do {                                                                 \
        (s).count = bonded[k];                                           \
        (s).bonding = BONDING_LOAD(launch, k);                           \
        (s).gap = bond_gap[k];                                     \
        (s).shear = LOAD3(bond_shear, (launch)->record_stride, k);       \
        (s).turn = LOAD3(bond_turn, (launch)->record_stride, k);         \
    } while (0)
#define BOND_STORE(launch, k, s)                                         \
    do {                                                                 \
        bonded[k] = (s).count;                                           \
        bond_gap[k] = (s).gap;                                     \
        STORE3(bond_shear, (launch)->record_stride, k, (s).shear);       \
        STORE3(bond_turn, (launch)->record_stride, k, (s).turn);         \
    } while (0)

typedef struct bond_state {
    real count, bonding, gap;
    vec3 shear, turn;
} bond_state;

typedef struct parallel_beam {
    real stretch, shear, bend, twist; /* stiffnesses: N/m, N/m, N m, N m */
    real radius, area, inertia;       /* b, pi b^2, pi b^4/4 */
    real move_damping, bend_damping;  /* 2 xi sqrt(k m*) of the stretch, 2 xi sqrt(k j*) of the bending: the others are constants times these */
} parallel_beam;

/* 1 for an odd count. */
INLINE real bond_lives(real count)
{
    real size = fabs(count);
    return size - R(2.0) * floor(R(0.5) * size);
}

INLINE bool parallel_at_wall(const contact *c)
{
    return !(c->arm_j > R(0.0));
}

/* Length of the beam where the surfaces are `gap` apart: from centre to centre, or from the centre to a wall. */
INLINE real parallel_length(const contact *c, real gap)
{
    return c->radius_i + (parallel_at_wall(c) ? R(0.0) : c->radius_j) + gap;
}

/* `rest`: gap between the surfaces when the bond was made. */
INLINE parallel_beam parallel_of(const contact *c, real rest)
{
    parallel_beam p;
    real smaller = c->radius_i < c->radius_j ? c->radius_i : c->radius_j, inverse = R(1.0) / parallel_length(c, rest);
    p.radius = c->value[PARALLEL_RADIUS] * smaller;
    p.area = R(3.14159265358979324) * p.radius * p.radius;
    p.inertia = R(0.25) * p.area * p.radius * p.radius;
    real young = c->value[PARALLEL_YOUNG] * inverse, shear = c->value[PARALLEL_SHEAR] * inverse;
    p.stretch = young * p.area;
    p.shear = shear * p.area;
    p.bend = young * p.inertia;
    p.twist = R(2.0) * shear * p.inertia;
    real ii = R(0.4) * c->mass_i * c->radius_i * c->radius_i, jj = R(0.4) * c->mass_j * c->radius_j * c->radius_j;
    /* roots of products alike are packed into vectors, which ends that over pairs: one root of a product, one of a ratio */
    p.move_damping = c->value[PARALLEL_DAMPING] * sqrt(p.stretch * c->mass_eff);
    p.bend_damping = R(0.5) * p.radius * p.move_damping * sqrt(ii / ((R(1.0) + ii / jj) * c->mass_eff));
    return p;
}

/* Gap up to which a bond is made. */
INLINE real parallel_reach(const contact *c)
{
    return c->value[PARALLEL_GAP] * (c->radius_i < c->radius_j ? c->radius_i : c->radius_j);
}

/* Bodies that a bond holds apart: arms and slip at the point between the surfaces, so that they still add up to the distance of the centres. */
INLINE void bond_geometry(contact *c, const bond_state *s)
{
    real gap = c->gap > R(0.0) && bond_lives(s->count) > R(0.5) ? c->gap : R(0.0);
    real share = parallel_at_wall(c) ? R(1.0) : c->radius_j / (c->radius_i + c->radius_j);
    real more_i = gap * share, more_j = gap * (R(1.0) - share);
    c->arm_i += more_i;
    c->arm_j += more_j;
    c->slip = add(c->slip, cross3(add_scaled(scale(more_i, c->spin_i), more_j, c->spin_j), c->n));
    c->past_slip = add(c->past_slip, cross3(add_scaled(scale(more_i, c->past_spin_i), more_j, c->past_spin_j), c->n));
}

INLINE void bond_normal(const contact *c, bond_state *s, response *out)
{
    bool lived = bond_lives(s->count) > R(0.5);
    bool may = bonding_value(c, s->bonding) > c->value[BONDING_THRESHOLD] && s->count >= R(0.0) && c->gap <= parallel_reach(c);
    bool made = may && !lived, apart = c->gap > parallel_reach(c);
    s->gap = made ? c->gap : s->gap;
    s->count = made ? s->count + R(1.0) : (apart && s->count < R(0.0) ? -s->count : s->count);
    bool lives = lived || made;
    parallel_beam p = parallel_of(c, lives ? s->gap : R(0.0));
    real spring = p.stretch * (s->gap - c->gap), damper = p.move_damping * c->approach;
    out->spring += lives ? spring : R(0.0);
    out->damper += lives ? damper : R(0.0);
    out->normal += lives ? spring + damper : R(0.0);
}

INLINE vec3 bond_turned(const contact *c, vec3 v)
{
    real twist = R(0.5) * dot3(add(c->past_spin_i, c->past_spin_j), c->n);
    return turn_by(v, scale(c->elapsed, add_scaled(c->turn, twist, c->n)));
}

INLINE void bond_shear(const contact *c, bond_state *s, response *out)
{
    bool lives = bond_lives(s->count) > R(0.5);
    real keep = lives ? R(1.0) : R(0.0), root = c->value[PARALLEL_ROOT];
    parallel_beam p = parallel_of(c, lives ? s->gap : R(0.0));
    vec3 spring = bond_turned(c, s->shear), turn = bond_turned(c, s->turn), rate = sub(c->spin_i, c->spin_j);
    spring = add_scaled(add_scaled(spring, -dot3(spring, c->n), c->n), c->elapsed, c->past_slip);
    turn = add_scaled(turn, c->elapsed, sub(c->past_spin_i, c->past_spin_j));
    real along = dot3(turn, c->n), rate_along = dot3(rate, c->n);
    vec3 bend = add_scaled(turn, -along, c->n), rate_across = add_scaled(rate, -rate_along, c->n);
    vec3 force = scale(-p.shear, spring), moment = scale(-p.bend, bend);
    real torsion = -p.twist * along, tension = p.stretch * (c->gap - s->gap);
    /* |B| b/I against what tension leaves of the strength, |S|/A against what torsion does: squared */
    real tensile = (c->value[PARALLEL_TENSILE] - tension / p.area) * p.inertia / p.radius;
    real shear = (c->value[PARALLEL_SHEAR_STRENGTH] - fabs(torsion) * p.radius / (R(2.0) * p.inertia)) * p.area;
    bool bent = tensile < R(0.0) || dot3(moment, moment) > tensile * tensile;
    bool sheared = shear < R(0.0) || dot3(force, force) > shear * shear;
    bool gone = parallel_at_wall(c) && c->gap > c->radius_i; /* further the table does not look for walls */
    bool torn = lives && (gone || bent || sheared);
    force = add_scaled(force, -root * p.move_damping, c->slip);
    moment = add_scaled(moment, -p.bend_damping, rate_across);
    moment = add_scaled(moment, torsion - R(1.41421356237309505) * root * p.bend_damping * rate_along, c->n);
    out->tangential = add_scaled(out->tangential, keep, force);
    out->rolling = add_scaled(out->rolling, keep, moment);
    real stays = lives && !torn ? R(1.0) : R(0.0);
    s->shear = scale(stays, spring);
    s->turn = scale(stays, turn);
    s->gap *= stays;
    s->count = torn ? -(s->count + R(1.0)) : s->count;
}

INLINE real bond_energy(const contact *c, const bond_state *s)
{
    bool lives = bond_lives(s->count) > R(0.5);
    real extension = c->gap - s->gap, along = dot3(s->turn, c->n);
    parallel_beam p = parallel_of(c, lives ? s->gap : R(0.0));
    real energy = p.stretch * extension * extension + p.shear * dot3(s->shear, s->shear) + p.twist * along * along +
                  p.bend * (dot3(s->turn, s->turn) - along * along);
    return lives ? R(0.5) * energy : R(0.0);
}

INLINE void bond_modes(const contact *c, const bond_state *s, mode *normal, mode *tangential, mode *rolling)
{
    bool lives = bond_lives(s->count) > R(0.5);
    parallel_beam p = parallel_of(c, lives ? s->gap : R(0.0));
    real root = c->value[PARALLEL_ROOT], keep = lives ? R(1.0) : R(0.0), turn = p.bend > p.twist ? p.bend : p.twist;
    real twist_root = R(1.41421356237309505) * root;
    normal->stiffness += keep * p.stretch;
    normal->damping += keep * p.move_damping;
    tangential->stiffness += keep * p.shear;
    tangential->damping += keep * root * p.move_damping;
    rolling->stiffness += keep * turn;
    rolling->damping += keep * (twist_root > R(1.0) ? twist_root : R(1.0)) * p.bend_damping;
}

/* A pair that cannot bond keeps the modes of its contact. */
INLINE bond_state bond_expected(const contact *c)
{
    bond_state s;
    s.count = c->value[BONDING_THRESHOLD] < R(1e29) ? R(1.0) : R(0.0);
    s.bonding = R(0.0);
    s.gap = R(0.0);
    s.shear = s.turn = v3(R(0.0), R(0.0), R(0.0));
    return s;
}
