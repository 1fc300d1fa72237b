/* What bonds have in common that are a beam between two bodies (Potyondy and Cundall 2004), of radius b and length L, the distance of the centres
 * at which it is at rest; it stretches, shears, bends and twists, with area A = pi b^2 and moments I = pi b^4/4, J = 2 I:
 *     F = (E A/L) u n, u the extension,                  S = -(G A/L) D,
 *     B = -(E I/L) theta across n,                       T = -(G J/L) theta along n,
 * each with a damper of 2 xi sqrt(k m) (inertia m for moments). D (m) and theta (rad) are followed step by step and turned with the pair. The
 * bond breaks where F/A + |B| b/I passes the tensile strength or |S|/A + |T| b/J the shear strength; it may be stretched to any length that its
 * strength allows, at a wall to the radius.
 * The law names its constants (BEAM_YOUNG, ...), its state, and gives radius and length at rest: beam_radius, beam_rest, beam_reach, beam_made,
 * beam_aged, beam_neck, beam_expected. BEAM_ALONE: the beam takes the place of the contact's own forces. */
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

INLINE real bond_holds(const bond_state *s)
{
    return bond_lives(s->count);
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

INLINE parallel_beam parallel_of(const contact *c, const bond_state *s, bool lives)
{
    parallel_beam p;
    real inverse = R(1.0) / parallel_length(c, lives ? beam_rest(c, s) : R(0.0));
    p.radius = beam_radius(c, s);
    p.area = R(3.14159265358979324) * p.radius * p.radius;
    p.inertia = R(0.25) * p.area * p.radius * p.radius;
    real young = c->value[BEAM_YOUNG] * inverse, shear = c->value[BEAM_SHEAR] * inverse;
    p.stretch = young * p.area;
    p.shear = shear * p.area;
    p.bend = young * p.inertia;
    p.twist = R(2.0) * shear * p.inertia;
    real ii = R(0.4) * c->mass_i * c->radius_i * c->radius_i, jj = R(0.4) * c->mass_j * c->radius_j * c->radius_j;
    /* roots of products alike are packed into vectors, which ends that over pairs: one root of a product, one of a ratio */
    p.move_damping = c->value[BEAM_DAMPING] * sqrt(p.stretch * c->mass_eff);
    p.bend_damping = R(0.5) * p.radius * p.move_damping * sqrt(ii / ((R(1.0) + ii / jj) * c->mass_eff));
    return p;
}

/* Bodies that a bond holds apart: arms and slip at the point between the surfaces, so that they still add up to the distance of the centres. */
INLINE void bond_geometry(contact *c, const bond_state *s)
{
    bool lives = bond_lives(s->count) > R(0.5);
    real gap = c->gap > R(0.0) && lives ? c->gap : R(0.0);
    real share = parallel_at_wall(c) ? R(1.0) : c->radius_j / (c->radius_i + c->radius_j);
    real more_i = gap * share, more_j = gap * (R(1.0) - share);
    c->arm_i += more_i;
    c->arm_j += more_j;
    c->slip = add(c->slip, cross3(add_scaled(scale(more_i, c->spin_i), more_j, c->spin_j), c->n));
    c->past_slip = add(c->past_slip, cross3(add_scaled(scale(more_i, c->past_spin_i), more_j, c->past_spin_j), c->n));
    c->neck = lives ? beam_neck(c, s) : R(0.0);
}

INLINE bool beam_is_liquid(const contact *c, const bond_state *s)
{
    return BEAM_LIQUID && bonding_value(c, s->bonding) > c->value[BONDING_THRESHOLD];
}

INLINE void bond_normal(const contact *c, bond_state *s, response *out)
{
    bool lived = bond_lives(s->count) > R(0.5), liquid = beam_is_liquid(c, s);
    bool apart = c->gap > beam_reach(c), drained = lived && liquid && apart;
    bool may = bonding_value(c, s->bonding) > c->value[BONDING_THRESHOLD] && s->count >= R(0.0) && !apart;
    bool made = may && !lived;
    beam_made(c, s, out, made || (lived && liquid));
    s->count = made || drained ? s->count + R(1.0) : (apart && s->count < R(0.0) ? -s->count : s->count);
    bool lives = (lived || made) && !drained;
    vec3 nothing = v3(R(0.0), R(0.0), R(0.0));
    s->shear = liquid ? nothing : s->shear;
    s->turn = liquid ? nothing : s->turn;
    parallel_beam p = parallel_of(c, s, lives);
    real spring = p.stretch * (beam_rest(c, s) - c->gap);
    real damper = liquid ? R(0.0) : p.move_damping * (c->approach - beam_aged(c, s, spring, lives)); /* creep is not damped */
    real own = BEAM_ALONE ? R(0.0) : R(1.0);
    out->spring = lives ? own * out->spring + spring : out->spring;
    out->damper = lives ? own * out->damper + damper : out->damper;
    out->normal = lives ? own * out->normal + spring + damper : out->normal;
    out->bearing = lives ? own * out->bearing : out->bearing;
}

INLINE vec3 bond_turned(const contact *c, vec3 v)
{
    real twist = R(0.5) * dot3(add(c->past_spin_i, c->past_spin_j), c->n);
    return turn_by(v, scale(c->elapsed, add_scaled(c->turn, twist, c->n)));
}

INLINE void bond_shear(const contact *c, bond_state *s, response *out)
{
    bool lives = bond_lives(s->count) > R(0.5), liquid = beam_is_liquid(c, s);
    real keep = lives && !liquid ? R(1.0) : R(0.0), root = c->value[BEAM_ROOT], rest = beam_rest(c, s);
    parallel_beam p = parallel_of(c, s, lives);
    vec3 spring = bond_turned(c, s->shear), turn = bond_turned(c, s->turn), rate = sub(c->spin_i, c->spin_j);
    spring = add_scaled(add_scaled(spring, -dot3(spring, c->n), c->n), c->elapsed, c->past_slip);
    turn = add_scaled(turn, c->elapsed, sub(c->past_spin_i, c->past_spin_j));
    real along = dot3(turn, c->n), rate_along = dot3(rate, c->n);
    vec3 bend = add_scaled(turn, -along, c->n), rate_across = add_scaled(rate, -rate_along, c->n);
    vec3 force = scale(-p.shear, spring), moment = scale(-p.bend, bend);
    real torsion = -p.twist * along, tension = p.stretch * (c->gap - rest);
    /* |B| b/I against what tension leaves of the strength, |S|/A against what torsion does: squared */
    real tensile = (c->value[BEAM_TENSILE] - tension / p.area) * p.inertia / p.radius;
    real shear = (c->value[BEAM_SHEAR_STRENGTH] - fabs(torsion) * p.radius / (R(2.0) * p.inertia)) * p.area;
    bool bent = tensile < R(0.0) || dot3(moment, moment) > tensile * tensile;
    bool sheared = shear < R(0.0) || dot3(force, force) > shear * shear;
    bool gone = parallel_at_wall(c) && c->gap > c->radius_i; /* further the table does not look for walls */
    bool torn = lives && !liquid && (gone || bent || sheared);
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
    real extension = c->gap - beam_rest(c, s), along = dot3(s->turn, c->n);
    parallel_beam p = parallel_of(c, s, lives);
    real energy = p.stretch * extension * extension + p.shear * dot3(s->shear, s->shear) + p.twist * along * along +
                  p.bend * (dot3(s->turn, s->turn) - along * along);
    real instead = BEAM_ALONE && c->overlap > R(0.0) ? normal_energy(c) : R(0.0);
    return lives ? R(0.5) * energy - instead : R(0.0);
}

INLINE void bond_modes(const contact *c, const bond_state *s, mode *normal, mode *tangential, mode *rolling)
{
    bool lives = bond_lives(s->count) > R(0.5);
    parallel_beam p = parallel_of(c, s, lives);
    real root = c->value[BEAM_ROOT], keep = lives ? R(1.0) : R(0.0), turn = p.bend > p.twist ? p.bend : p.twist;
    real twist_root = R(1.41421356237309505) * root, own = BEAM_ALONE && lives ? R(0.0) : R(1.0);
    normal->stiffness = own * normal->stiffness + keep * p.stretch;
    normal->damping = own * normal->damping + keep * p.move_damping;
    tangential->stiffness = own * tangential->stiffness + keep * p.shear;
    tangential->damping = own * tangential->damping + keep * root * p.move_damping;
    rolling->stiffness = own * rolling->stiffness + keep * turn;
    rolling->damping = own * rolling->damping + keep * (twist_root > R(1.0) ? twist_root : R(1.0)) * p.bend_damping;
}

/* Whether the two, as near as they are, may still get a bond that they do not have. */
INLINE bool bond_may_come(const contact *c, const bond_state *s)
{
    bool holds = bond_holds(s) > R(0.5);
    return !holds && s->count >= R(0.0) && c->gap <= beam_reach(c) && c->value[BONDING_THRESHOLD] < R(1e29) && BONDING_COMES(s->bonding);
}

/* A pair that cannot bond keeps the modes of its contact. */
INLINE bond_state bond_expected(const contact *c)
{
    bond_state s;
    s.count = c->value[BONDING_THRESHOLD] < R(1e29) ? R(1.0) : R(0.0);
    s.bonding = R(0.0);
    s.shear = s.turn = v3(R(0.0), R(0.0), R(0.0));
    beam_expected(c, &s);
    return s;
}
