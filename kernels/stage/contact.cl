/* From records to forces: what the pair stage, the probe and the step limit share. A record is a pair of grains, or a grain and a face of a
 * wall; records of walls stand in work-groups of their own behind the pairs. Rows that pad a work-group name the same grain twice. */
#define PAIR_FIELDS(READ, WRITE)                                                                                          \
    READ(int, owner) READ(int, other) READ(exact, position) READ(exact, velocity) READ(exact, radius) READ(real, mass)          \
    READ(real, contact_constants) \
    WRITE(real, force) TABLES_PAIR_FIELDS(READ, WRITE) COMPOSITION_PAIR_FIELDS(READ, WRITE) MOTION_PAIR_FIELDS(READ, WRITE) ROTATION_PAIR_FIELDS(READ, WRITE)    \
    BONDING_PAIR_FIELDS(READ, WRITE) BOND_PAIR_FIELDS(READ, WRITE) COHESION_PAIR_FIELDS(READ, WRITE)                           \
    SLIP_PAIR_FIELDS(READ, WRITE) TANGENTIAL_PAIR_FIELDS(READ, WRITE) ROLLING_PAIR_FIELDS(READ, WRITE)                                        \
    DISSIPATION_PAIR_FIELDS(READ, WRITE) DISSIPATION_HEAT_PAIR_FIELDS(READ, WRITE) LEDGER_PAIR_FIELDS(READ, WRITE) WALLS_PAIR_FIELDS(READ, WRITE)                                  \
    TEMPERATURE_PAIR_FIELDS(READ, WRITE) MODULUS_PAIR_FIELDS(READ, WRITE) SOFTENING_PAIR_FIELDS(READ, WRITE) EXPANSION_PAIR_FIELDS(READ, WRITE) CONDUCTIVITY_PAIR_FIELDS(READ, WRITE)                       \
    CONDUCTION_PAIR_FIELDS(READ, WRITE) WALL_HEAT_PAIR_FIELDS(READ, WRITE) INTEGRATOR_PAIR_FIELDS(READ, WRITE) PACKED_PAIR_FIELDS(READ, WRITE) TOUCHED_PAIR_FIELDS(READ, WRITE)
#define PAIR_DECLARE PAIR_FIELDS(DECLARE_READ, DECLARE_WRITE)
#define PAIR_PASS PAIR_FIELDS(PASS, PASS)

/* What follows from normal, overlap and the two bodies. */
INLINE void contact_complete(contact *c)
{
    real a = sqrt(c->radius_eff * c->overlap);
    bool touches = c->overlap > R(0.0);
    /* one division for both reciprocals */
    real inverse = R(1.0) / ((touches ? a : R(1.0)) * c->radius_eff);
    c->neck = R(0.0);
    c->contact_radius = a;
    c->inertia_root = sqrt(c->mass_eff * a);
    c->contact_inverse = touches ? inverse * c->radius_eff : R(0.0);
    c->radius_inverse = inverse * (touches ? a : R(1.0));
}

/* What every contact reads of a grain. */
typedef struct sphere {
    precise3 position;
    precise radius;
    vec3 velocity, past_velocity, spin, past_spin;
    real mass, temperature;
} sphere;

INLINE void sphere_load(const clast_launch *launch, int i, sphere *s PAIR_DECLARE)
{
    s->position = PRECISE_GRAIN_POLAR3(position, i);
    s->radius = precise_load(radius[i]);
    s->velocity = GRAIN_POLAR3(velocity, i);
    s->past_velocity = INTEGRATOR_PAST_VELOCITY(i, s->velocity);
    s->spin = ROTATION_LOAD(launch, i);
    s->past_spin = INTEGRATOR_PAST_SPIN(i, s->spin);
    s->mass = mass[i];
    s->temperature = TEMPERATURE_OF_BODY(i);
}

/* `touching`: false where the two are known not to touch, so that all that an overlap brings about is left out. */
INLINE void contact_of_spheres(const clast_launch *launch, int i, int j, const sphere *s_i, const sphere *s_j, const bool touching, contact *c PAIR_DECLARE)
{
    apart3 way = periodic_nearest(launch, apart_of(s_j->position, s_i->position));
    vec3 d = apart_vector(way), u = sub(s_i->velocity, s_j->velocity), past = sub(s_i->past_velocity, s_j->past_velocity);
    real d2 = dot3(d, d);
    precise radius_i = s_i->radius, radius_j = s_j->radius;
    c->radius_i = rounded(radius_i);
    c->radius_j = rounded(radius_j);
    c->spin_i = s_i->spin;
    c->spin_j = s_j->spin;
    c->past_spin_i = s_i->past_spin;
    c->past_spin_j = s_j->past_spin;
    c->modulus_i = MODULUS_OF(i);
    c->modulus_j = MODULUS_OF(j);
    c->growth_i = GROWTH_OF(i);
    c->growth_j = GROWTH_OF(j);
    c->resists_i = RESISTIVITY_OF(i);
    c->resists_j = RESISTIVITY_OF(j);
    c->tables = TABLES_OF_PAIRS;
    c->ahead = sub(DISSIPATION_AHEAD(i), DISSIPATION_AHEAD(j));
    c->ahead_spin_i = DISSIPATION_AHEAD_SPIN(i);
    c->ahead_spin_j = DISSIPATION_AHEAD_SPIN(j);
    c->mass_i = motion_mass(MOTION_GRAIN(i), s_i->mass);
    c->mass_j = motion_mass(MOTION_GRAIN(j), s_j->mass);
    c->class = composition_class(COMPOSITION_GRAIN(i), COMPOSITION_GRAIN(j));
    real sum = c->radius_i + c->radius_j, mass_sum = c->mass_i + c->mass_j;
    real both = R(1.0) / (sum * mass_sum); /* one division for both reciprocals */
    bool apart = d2 > R(0.0);
    real inverse = R(1.0) / sqrt(apart ? d2 : R(1.0)), distance = d2 * inverse;
    real overlap = sphere_overlap(way, distance, radius_i, radius_j);
    c->gap = apart ? -overlap : R(1e30);
    overlap = touching && apart && overlap > R(0.0) ? overlap : R(0.0);
    c->touch = overlap;
    c->overlap = motion_overlap(MOTION_GRAIN(i), MOTION_GRAIN(j), overlap);
    c->temperature_i = s_i->temperature;
    c->temperature_j = s_j->temperature;
    c->n = scale(inverse, d);
    c->radius_eff = c->radius_i * c->radius_j * (both * mass_sum);
    c->mass_eff = c->mass_i * c->mass_j * (both * sum);
    real shrink = LEVER_ARM_SHRINKS * c->overlap * (both * mass_sum);
    c->arm_i = c->radius_i - shrink * c->radius_j;
    c->arm_j = c->radius_j - shrink * c->radius_i;
    c->approach = dot3(u, c->n);
    c->past_approach = dot3(past, c->n);
    c->turn = scale(-inverse, cross3(c->n, past));
    c->slip = add(add_scaled(u, -c->approach, c->n), cross3(add_scaled(scale(c->arm_i, c->spin_i), c->arm_j, c->spin_j), c->n));
    c->past_slip = add(add_scaled(past, -c->past_approach, c->n),
                       cross3(add_scaled(scale(c->arm_i, c->past_spin_i), c->arm_j, c->past_spin_j), c->n));
    contact_complete(c);
}

INLINE void contact_of_grains(const clast_launch *launch, int k, contact *c PAIR_DECLARE)
{
    int i = owner[k], j = other[k];
    sphere s_i, s_j;
    sphere_load(launch, i, &s_i PAIR_PASS);
    sphere_load(launch, j, &s_j PAIR_PASS);
    contact_of_spheres(launch, i, j, &s_i, &s_j, true, c PAIR_PASS);
}

INLINE void contact_of_wall(const clast_launch *launch, int k, contact *c, wall_touch *touch PAIR_DECLARE)
{
    int i = owner[k];
    precise3 x = PRECISE_GRAIN_POLAR3(position, i);
    precise radius_i = precise_load(radius[i]);
    vec3 v = GRAIN_POLAR3(velocity, i);
    c->radius_i = rounded(radius_i);
    c->radius_j = c->radius_i;
    c->spin_i = ROTATION_LOAD(launch, i);
    c->past_spin_i = INTEGRATOR_PAST_SPIN(i, c->spin_i);
    c->modulus_i = MODULUS_OF(i);
    c->modulus_j = R(1.0);
    c->growth_i = GROWTH_OF(i);
    c->growth_j = R(0.0);
    c->resists_i = c->resists_j = RESISTIVITY_OF(i);
    c->tables = TABLES_OF_PAIRS;
    c->ahead = DISSIPATION_AHEAD(i);
    c->ahead_spin_i = DISSIPATION_AHEAD_SPIN(i);
    c->ahead_spin_j = v3(R(0.0), R(0.0), R(0.0));
    c->mass_i = mass[i];
    c->mass_j = HEAVY;
    WALLS_CONTACT(launch, other[k], x, v, c, touch);
    c->class = composition_class(COMPOSITION_GRAIN(i), touch->party);
    real overlap = rounded(precise_sub(radius_i, touch->distance));
    c->gap = -overlap;
    c->touch = overlap > R(0.0) ? overlap : R(0.0);
    c->overlap = motion_overlap(MOTION_GRAIN(i), 0, c->touch);
    c->temperature_i = c->temperature_j = TEMPERATURE_OF_BODY(i);
    c->radius_eff = c->radius_i;
    c->mass_eff = c->mass_i;
    c->arm_i = c->radius_i - LEVER_ARM_SHRINKS * c->overlap;
    c->arm_j = R(0.0);
    vec3 u = sub(v, touch->velocity);
    c->approach = dot3(u, c->n);
    c->slip = add(add_scaled(u, -c->approach, c->n), cross3(scale(c->arm_i, c->spin_i), c->n));
    vec3 past = sub(INTEGRATOR_PAST_VELOCITY(i, v), touch->velocity);
    c->past_approach = dot3(past, c->n);
    c->past_slip = add(add_scaled(past, -c->past_approach, c->n), cross3(scale(c->arm_i, c->past_spin_i), c->n));
    c->past_spin_j = c->spin_j;
    contact_complete(c);
}

typedef struct contact_state {
    bond_state bond;
    cohesion_state cohesion;
    slip_state slip;
    tangential_state tangential;
    rolling_state rolling;
    softening_state softening;
    expansion_state expansion;
    dissipation_state dissipation;
    ledger_state ledger;
} contact_state;

/* Spring and damper together never pull; a bond or cohesion, which come after this, may. */
INLINE void normal_total(const contact *c, response *out)
{
    normal_force(c, out);
    real force = out->spring + out->damper;
    out->normal = force > R(0.0) ? force : R(0.0);
    out->bearing = out->normal;
}

/* A bond is all the adhesion of its contact: cohesion is silent while it lives, and follows its own history meanwhile. */
INLINE void cohesion_unless_bonded(const contact *c, contact_state *s, response *out)
{
    bool bonded = bond_holds(&s->bond) > R(0.5);
    real normal = out->normal, bearing = out->bearing, spring = out->spring, damper = out->damper;
    cohesion_force(c, &s->cohesion, out);
    out->normal = bonded ? normal : out->normal;
    out->bearing = bonded ? bearing : out->bearing;
    out->spring = bonded ? spring : out->spring;
    out->damper = bonded ? damper : out->damper;
}

/* What the springs along the surface are after the step, with nothing for the ledger. */
INLINE void contact_springs(const contact *c, contact_state *s, response *out)
{
    tangential_force(c, &s->slip, &s->tangential, out);
    rolling_moment(c, &s->rolling, out);
    bond_shear(c, &s->bond, out);
}

/* The slots in their order. */
INLINE void contact_laws(contact *c, contact_state *s, response *out)
{
    bond_geometry(c, &s->bond);
    normal_total(c, out);
    bond_normal(c, &s->bond, out);
    cohesion_unless_bonded(c, s, out);
    tangential_force(c, &s->slip, &s->tangential, out);
    rolling_moment(c, &s->rolling, out);
    out->lost = dissipation_of(c, out, &s->dissipation);
    out->lost.stiffness += softening_work(c, &s->softening);
    expansion_contact(c, out->spring, &s->expansion);
    ledger_contact(&s->ledger, out->lost);
    bond_shear(c, &s->bond, out);
}
