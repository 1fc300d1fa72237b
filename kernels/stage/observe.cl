/* What guards, observables and the step limit read. Sums run in the order of permanent ids, chunk by chunk, so that they do not depend on
 * when the table was built. */
#define OBSERVE_CHUNK 256

/* kinetic and rotational energy; potential in gravity; mass; momentum; angular momentum about the origin; largest speed and m g r. */
#define OBSERVE_PARTICLE_SUMS 12

INLINE void observe_add(precise *sum, precise value)
{
    *sum = precise_add(*sum, value);
}

INLINE void observe_add3(precise *sum, precise factor, precise3 value)
{
    observe_add(sum, precise_mul(factor, value.x));
    observe_add(sum + 1, precise_mul(factor, value.y));
    observe_add(sum + 2, precise_mul(factor, value.z));
}

BODY void observe_particles_unit(int chunk, const clast_launch *launch, __global const int *restrict where,
                                 __global const exact *restrict position, __global const exact *restrict velocity,
                                 __global const exact *restrict radius, __global const real *restrict mass,
                                 __global exact *restrict partial, const int id_count ROTATION_OBSERVE_FIELDS(DECLARE_READ, DECLARE_WRITE))
{
    int first = chunk * OBSERVE_CHUNK, end = min(first + OBSERVE_CHUNK, id_count);
    precise sum[OBSERVE_PARTICLE_SUMS], one_half = precise_from(R(0.5));
    for (int q = 0; q < OBSERVE_PARTICLE_SUMS; q++)
        sum[q] = precise_from(R(0.0));
    precise3 g = PRECISE_POLAR3(launch->gravity);
    for (int n = first; n < end; n++) {
        int i = where[n];
        if (i < 0)
            continue;
        precise3 x = PRECISE_GRAIN_POLAR3(position, i), v = PRECISE_GRAIN_POLAR3(velocity, i), w = ROTATION_PRECISE(launch, i);
        precise m = precise_from(mass[i]), r = precise_load(radius[i]);
        precise inertia = precise_mul(precise_mul(precise_mul(precise_from(R(0.4)), m), r), r);
        observe_add(sum, precise_mul(precise_mul(one_half, m), precise3_dot(v, v)));
        observe_add(sum + 1, precise_mul(precise_mul(one_half, inertia), precise3_dot(w, w)));
        sum[2] = precise_sub(sum[2], precise_mul(m, precise3_dot(g, x)));
        observe_add(sum + 3, m);
        observe_add3(sum + 4, m, v);
        observe_add3(sum + 7, m, precise3_cross(x, v));
        observe_add3(sum + 7, inertia, w);
        sum[10] = precise_max(sum[10], precise3_dot(v, v));
        observe_add(sum + 11, precise_mul(m, r));
    }
    for (int q = 0; q < OBSERVE_PARTICLE_SUMS; q++)
        partial[chunk * OBSERVE_PARTICLE_SUMS + q] = precise_store(sum[q]);
}

__kernel void observe_particles(const clast_launch launch, __global const int *restrict where, __global const exact *restrict position,
                                __global const exact *restrict velocity, __global const exact *restrict radius,
                                __global const real *restrict mass, __global exact *restrict partial,
                                const int id_count ROTATION_OBSERVE_FIELDS(DECLARE_READ, DECLARE_WRITE))
{
    observe_particles_unit(get_global_id(0), &launch, where, position, velocity, radius, mass, partial,
                           id_count ROTATION_OBSERVE_FIELDS(PASS, PASS));
}

/* The forces as they stand, with no step taken: what output and observables read. Leaves history alone. */
INLINE void probe_record(const clast_launch *launch, int k, bool wall PAIR_DECLARE)
{
    if (wall)
        pair_of_wall_as_is(launch, k PAIR_PASS);
    else
        pair_of_grains_as_is(launch, k PAIR_PASS);
}

RECORD_KERNEL(pair_probe, probe_record)

/* Per record, where its force stands: overlap over the smaller radius, elastic energy, overlap. History and pair list stay. */
INLINE void observe_record(const clast_launch *launch, int k, bool wall PAIR_DECLARE)
{
    contact c;
    contact_state s;
    wall_touch touch;
    if (wall)
        contact_of_wall(launch, k, &c, &touch PAIR_PASS);
    else
        contact_of_grains(launch, k, &c PAIR_PASS);
    c.dt = R(0.0);
    c.elapsed = number(INTEGRATOR_ELAPSED(launch)); /* 0 where histories are those of the velocities as they stand */
    c.span = R(0.0);
    c.value = contact_constants + c.class * CONTACT_CONSTANTS;
    PAIR_LOAD_STATE(launch, k, s);
    response out;
    bond_geometry(&c, &s.bond);
    normal_total(&c, &out);
    bond_normal(&c, &s.bond, &out);
    cohesion_unless_bonded(&c, &s, &out);
    INTEGRATOR_CATCH_UP(&c, &s, &out);
    real smaller = wall || c.radius_i < c.radius_j ? c.radius_i : c.radius_j;
    real springs = normal_energy(&c) + tangential_energy(&c, &s.slip, &s.tangential, out.bearing) + rolling_energy(&c, &s.rolling, out.bearing);
    AT(force, launch->record_stride, 0, k) = c.overlap / smaller;
    real cohered = bond_holds(&s.bond) > R(0.5) ? R(0.0) : cohesion_energy(&c, &s.cohesion);
    AT(force, launch->record_stride, 1, k) = (c.overlap > R(0.0) ? springs : R(0.0)) + bond_energy(&c, &s.bond) + cohered;
    AT(force, launch->record_stride, 2, k) = c.overlap;
}

RECORD_KERNEL(observe_records, observe_record)

INLINE mode mode_of(bool first, mode a, mode b)
{
    mode m = {first ? a.stiffness : b.stiffness, first ? a.damping : b.damping};
    return m;
}

/* b, or what is larger of a where `also`. */
INLINE mode mode_stiffer(bool also, mode a, mode b)
{
    mode m = {also && a.stiffness > b.stiffness ? a.stiffness : b.stiffness, also && a.damping > b.damping ? a.damping : b.damping};
    return m;
}

/* Every record's normal, and stiffness and damping of its modes, where its force and torque stand. Both count twice between two grains: of
 * the energy of a spring, (a + b)^2 <= 2 a^2 + 2 b^2 goes to its two ends (docs/theory.md). Two that are near enough to bond, and may, count as bonded
 * too: the step is chosen before they do. */
INLINE void limit_record(const clast_launch *launch, int k, bool wall PAIR_DECLARE)
{
    contact c;
    wall_touch touch;
    if (wall)
        contact_of_wall(launch, k, &c, &touch PAIR_PASS);
    else
        contact_of_grains(launch, k, &c PAIR_PASS);
    c.dt = c.elapsed = R(0.0);
    c.value = contact_constants + c.class * CONTACT_CONSTANTS;
    real twice = wall ? R(1.0) : R(2.0);
    mode n = normal_mode(&c), t = tangential_mode(&c), r = rolling_mode(&c);
    bond_state bond;
    cohesion_state cohesion;
    BOND_LOAD(launch, k, bond);
    COHESION_LOAD(launch, k, cohesion);
    bool holds = bond_holds(&bond) > R(0.5), to_come = bond_may_come(&c, &bond);
    mode coming[3] = {n, t, r};
    bond_state expected = bond_expected(&c);
    bond_modes(&c, &expected, &coming[0], &coming[1], &coming[2]);
    bond_modes(&c, &bond, &n, &t, &r);
    const mode without = n;
    cohesion_mode(&c, &cohesion, &n);
    n = mode_of(holds, without, n);
    n = mode_stiffer(to_come, coming[0], n);
    t = mode_stiffer(to_come, coming[1], t);
    r = mode_stiffer(to_come, coming[2], r);
    LIMIT_STORE(launch, k, twice, c.n, n, t, r);
}

RECORD_KERNEL(limit_records, limit_record)

/* Largest dt with dt^2 a + 2 dt b < 4; b counts twice where laws are given an extrapolated velocity (docs/theory.md). */
INLINE real limit_step(real a, real damping)
{
    real b = INTEGRATOR_DAMPING_LAG * damping, s = b + sqrt(b * b + R(4.0) * a);
    return s > R(0.0) ? R(4.0) / s : R(1e30);
}

/* A symmetric 3 x 3 matrix: sum of s I + d n n^T over contacts. */
typedef struct limit_matrix {
    real xx, yy, zz, xy, xz, yz;
} limit_matrix;

INLINE void limit_add(limit_matrix *m, real s, real d, vec3 n)
{
    m->xx += s + d * n.x * n.x;
    m->yy += s + d * n.y * n.y;
    m->zz += s + d * n.z * n.z;
    m->xy += d * n.x * n.y;
    m->xz += d * n.x * n.z;
    m->yz += d * n.y * n.z;
}

/* Largest eigenvalue, by the trigonometric form. */
INLINE real limit_eigenvalue(const limit_matrix *m)
{
    real q = (m->xx + m->yy + m->zz) / R(3.0);
    real a = m->xx - q, b = m->yy - q, c = m->zz - q, off = m->xy * m->xy + m->xz * m->xz + m->yz * m->yz;
    real p = sqrt((a * a + b * b + c * c + R(2.0) * off) / R(6.0));
    if (!(p > R(0.0)))
        return q;
    real det = a * (b * c - m->yz * m->yz) - m->xy * (m->xy * c - m->yz * m->xz) + m->xz * (m->xy * m->yz - b * m->xz);
    real r = det / (R(2.0) * p * p * p);
    r = r > R(1.0) ? R(1.0) : (r < R(-1.0) ? R(-1.0) : r);
    return q + R(2.0) * p * cos(acos(r) / R(3.0));
}

/* Motion and spin of one grain on its contacts, for stiffness or for damping: [[A, C], [C^T, B]] with spins scaled so that a turn weighs as
 * much as a displacement. A: translation, B: rotation, C = cross product with `twist`. */
typedef struct limit_block {
    limit_matrix move, turn;
    vec3 twist;
} limit_block;

INLINE void limit_contact(limit_block *b, vec3 n, real normal, real tangential, real rolling)
{
    limit_add(&b->move, tangential, normal - tangential, n);
    limit_add(&b->turn, R(2.5) * tangential + rolling, R(-2.5) * tangential, n);
    b->twist = add_scaled(b->twist, R(1.58113883008418967) * tangential, n);
}

OUTLINE real limit_largest(const limit_block *b)
{
    real move = limit_eigenvalue(&b->move), turn = limit_eigenvalue(&b->turn), apart = R(0.5) * (move - turn);
    return R(0.5) * (move + turn) + sqrt(apart * apart + dot3(b->twist, b->twist));
}

/* Per chunk of grains the smallest limit with the normal modes alone, and with all. */
BODY void limit_particles_unit(int chunk, const clast_launch *launch, __global const uint *restrict slot_offset,
                               __global const int *restrict slots, __global const real *restrict force,
                               __global const exact *restrict radius, __global const real *restrict mass,
                               __global exact *restrict partial ROTATION_LIMIT_FIELDS(DECLARE_READ, DECLARE_WRITE))
{
    int first = chunk * OBSERVE_CHUNK, end = min(first + OBSERVE_CHUNK, launch->particle_count);
    real alone = R(1e30), all = R(1e30);
    for (int i = first; i < end; i++) {
        limit_block zero = {{0, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0}, {0, 0, 0}};
        limit_block stiff = zero, damp = zero, stiff_normal = zero, damp_normal = zero;
        uint last = slot_offset[i / CLAST_BLOCK + 1];
        for (uint s = slot_offset[i / CLAST_BLOCK] + i % CLAST_BLOCK; s < last; s += CLAST_BLOCK) {
            int entry = slots[s];
            if (entry == 0)
                break;
            int k = (entry > 0 ? entry : -entry) - 1;
            vec3 n;
            mode normal, tangential, rolling;
            LIMIT_LOAD(launch, k, n, normal, tangential, rolling);
            real r = GRAIN_RADIUS(i), spin = R(2.5) / (r * r);
            limit_contact(&stiff, n, normal.stiffness, tangential.stiffness, spin * rolling.stiffness);
            limit_contact(&damp, n, normal.damping, tangential.damping, spin * rolling.damping);
            limit_contact(&stiff_normal, n, normal.stiffness, R(0.0), R(0.0));
            limit_contact(&damp_normal, n, normal.damping, R(0.0), R(0.0));
        }
        real m = R(1.0) / mass[i];
        alone = fmin(alone, limit_step(m * limit_largest(&stiff_normal), m * limit_largest(&damp_normal)));
        all = fmin(all, limit_step(m * limit_largest(&stiff), m * limit_largest(&damp)));
    }
    partial[2 * chunk] = precise_store(precise_from(alone));
    partial[2 * chunk + 1] = precise_store(precise_from(all));
}

__kernel void limit_particles(const clast_launch launch, __global const uint *restrict slot_offset, __global const int *restrict slots,
                              __global const real *restrict force, __global const exact *restrict radius,
                              __global const real *restrict mass,
                              __global exact *restrict partial ROTATION_LIMIT_FIELDS(DECLARE_READ, DECLARE_WRITE))
{
    limit_particles_unit(get_global_id(0), &launch, slot_offset, slots, force, radius, mass, partial ROTATION_LIMIT_FIELDS(PASS, PASS));
}

/* The contact to expect between two bodies of a class: that of an impact at `speed`, or under `weight`, whichever is deeper.
 * result: overlap (m), limits of the normal and of the turning modes (s), duration of the impact without damping (s), conductance (W/K). */
#define EXPECTED_BISECTIONS 200
#define EXPECTED_POINTS 400

INLINE void expected_at(contact *c, real overlap)
{
    c->overlap = overlap;
    c->gap = -overlap;
    contact_complete(c);
}

BODY void limit_expected_unit(__global const real *restrict contact_constants, __global exact *restrict result, const int class,
                              const real radius_i, const real radius_j, const real mass_i, const real mass_j, const real speed,
                              const real weight)
{
    contact c = {0}; /* no velocity, no spin, no direction */
    bool wall = mass_j <= R(0.0);
    c.radius_i = radius_i;
    c.radius_j = wall ? c.radius_i : radius_j;
    c.mass_i = mass_i;
    c.mass_j = wall ? HEAVY : mass_j;
    c.radius_eff = wall ? c.radius_i : c.radius_i * c.radius_j / (c.radius_i + c.radius_j);
    c.mass_eff = c.mass_i * c.mass_j / (c.mass_i + c.mass_j);
    c.arm_i = c.radius_i;
    c.arm_j = wall ? R(0.0) : c.radius_j;
    c.approach = R(0.0);
    c.class = class;
    c.value = contact_constants + class * CONTACT_CONSTANTS;
    c.modulus_i = c.modulus_j = R(1.0);
    MODULUS_EXPECTED(&c);
    c.resists_i = c.resists_j = R(1.0); /* the most that they conduct */
    c.dt = c.elapsed = R(0.0);
    real energy = R(0.5) * c.mass_eff * speed * speed, impact_low = R(0.0), impact_high = c.radius_eff;
    real rest_low = R(0.0), rest_high = c.radius_eff;
    real pulled_low = R(0.0), pulled_high = c.radius_eff; /* an impact with what pulls: deeper */
    bond_state bond = bond_expected(&c);
    cohesion_state cohesion = cohesion_expected(&c);
    for (int n = 0; n < EXPECTED_BISECTIONS; n++) {
        real middle = R(0.5) * (impact_low + impact_high);
        response out;
        expected_at(&c, middle);
        bool deep = normal_energy(&c) > energy;
        impact_high = deep ? middle : impact_high;
        impact_low = deep ? impact_low : middle;
        middle = R(0.5) * (pulled_low + pulled_high);
        expected_at(&c, middle);
        deep = normal_energy(&c) + bond_energy(&c, &bond) + cohesion_energy(&c, &cohesion) > energy;
        pulled_high = deep ? middle : pulled_high;
        pulled_low = deep ? pulled_low : middle;
        middle = R(0.5) * (rest_low + rest_high);
        expected_at(&c, middle);
        normal_total(&c, &out);
        deep = out.normal > weight;
        rest_high = deep ? middle : rest_high;
        rest_low = deep ? rest_low : middle;
    }
    /* time = 2 int_0^d dx/sqrt(v^2 - 2 E(x)/m*), x = d sin(phi) */
    real duration = R(0.0);
    for (int n = 0; n < EXPECTED_POINTS; n++) {
        real phi = R(1.5707963267948966) * ((real)n + R(0.5)) / (real)EXPECTED_POINTS;
        expected_at(&c, impact_high * sin(phi));
        real left = speed * speed - R(2.0) * normal_energy(&c) / c.mass_eff;
        duration += left > R(0.0) ? cos(phi) / sqrt(left) : R(0.0);
    }
    duration *= R(2.0) * impact_high * R(1.5707963267948966) / (real)EXPECTED_POINTS;
    real deepest = pulled_high > impact_high ? pulled_high : impact_high; /* a bond may be made at the bottom of an impact */
    expected_at(&c, deepest > rest_high ? deepest : rest_high);
    real inverse = R(1.0) / c.mass_eff;
    mode a = normal_mode(&c), t = tangential_mode(&c), r = rolling_mode(&c);
    mode cohering = a; /* with cohesion or with a bond: the stiffer of the two may come */
    cohesion_mode(&c, &cohesion, &cohering);
    bond_modes(&c, &bond, &a, &t, &r);
    a.stiffness = a.stiffness > cohering.stiffness ? a.stiffness : cohering.stiffness;
    a.damping = a.damping > cohering.damping ? a.damping : cohering.damping;
    real spin_i = R(1.0) / (R(0.4) * c.mass_i * c.radius_i * c.radius_i);
    real spin_both = wall ? spin_i : spin_i + R(1.0) / (R(0.4) * c.mass_j * c.radius_j * c.radius_j);
    real turning = limit_step(R(3.5) * t.stiffness * inverse + spin_both * r.stiffness, R(3.5) * t.damping * inverse + spin_both * r.damping);
    c.touch = c.overlap;
    bond_geometry(&c, &bond);
    real conductance = wall ? conduction_wall_conductance(&c) : conduction_conductance(&c);
    result[0] = precise_store(precise_from(c.overlap));
    result[1] = precise_store(precise_from(limit_step(a.stiffness * inverse, a.damping * inverse)));
    result[2] = precise_store(precise_from(turning));
    result[3] = precise_store(precise_from(duration));
    result[4] = precise_store(precise_from(conductance));
}

__kernel void limit_expected(__global const real *restrict contact_constants, __global exact *restrict result, const int class,
                             const real radius_i, const real radius_j, const real mass_i, const real mass_j, const real speed,
                             const real weight)
{
    limit_expected_unit(contact_constants, result, class, radius_i, radius_j, mass_i, mass_j, speed, weight);
}

/* Guards, per chunk: first grain that is not a number, that moves too far in a step, that has left the domain (sorted indices; -1: none),
 * and the largest speed squared. Programs are built as if every number were one; so what is read is tested, by its bits, and not what comes of it. */
#define GUARD_FINDINGS 4

INLINE bool are_numbers(vec3 a)
{
    return is_number(a.x) && is_number(a.y) && is_number(a.z);
}

BODY void guard_particles_unit(int chunk, const clast_launch *launch, __global const exact *restrict position,
                               __global const exact *restrict velocity, __global exact *restrict partial, const int bounded)
{
    int first = chunk * OBSERVE_CHUNK, end = min(first + OBSERVE_CHUNK, launch->particle_count);
    int bad = -1, fastest = -1, left = -1;
    real most = R(0.0);
    vec3 low = from3(launch->low), high = from3(launch->high), common = POLAR3(launch->drift); /* of velocity here */
    for (int i = first; i < end; i++) {
        vec3 x = GRAIN_POLAR3(position, i), moves = GRAIN_POLAR3(velocity, i), v = sub(moves, common);
        real speed2 = dot3(v, v);
        if (!are_numbers(x) || !are_numbers(moves)) {
            if (bad < 0)
                bad = i;
        } else {
            if (speed2 > most) {
                most = speed2;
                fastest = i;
            }
            bool inside = x.x >= low.x && x.x <= high.x && x.y >= low.y && x.y <= high.y && x.z >= low.z && x.z <= high.z;
            if (bounded && !inside && left < 0)
                left = i;
        }
    }
    partial[chunk * GUARD_FINDINGS] = precise_store(precise_from_int(bad));
    partial[chunk * GUARD_FINDINGS + 1] = precise_store(precise_from_int(fastest));
    partial[chunk * GUARD_FINDINGS + 2] = precise_store(precise_from_int(left));
    partial[chunk * GUARD_FINDINGS + 3] = precise_store(precise_from(most));
}

__kernel void guard_particles(const clast_launch launch, __global const exact *restrict position, __global const exact *restrict velocity,
                              __global exact *restrict partial, const int bounded)
{
    guard_particles_unit(get_global_id(0), &launch, position, velocity, partial, bounded);
}

INLINE real guard_of_pair(const clast_launch *launch, int k PAIR_DECLARE)
{
    int i = owner[k], j = other[k];
    apart3 d = periodic_nearest(launch, apart_of(PRECISE_GRAIN_POLAR3(position, j), PRECISE_GRAIN_POLAR3(position, i)));
    precise radius_i = precise_load(radius[i]), radius_j = precise_load(radius[j]);
    real smaller = fmin(rounded(radius_i), rounded(radius_j)), distance = sqrt(dot3(apart_vector(d), apart_vector(d)));
    return sphere_overlap(d, distance, radius_i, radius_j) / smaller;
}

/* A grain that is held may stand in a wall. */
INLINE real guard_of_wall(const clast_launch *launch, int k PAIR_DECLARE)
{
    contact c;
    wall_touch touch;
    contact_of_wall(launch, k, &c, &touch PAIR_PASS);
    return c.overlap / c.radius_i;
}

/* Per chunk of records the largest overlap over the smaller radius, and its record; chunks of pairs first, those of walls behind them.
 * Geometry only: cheap, and touches no field. */
BODY void guard_records_unit(int chunk, const clast_launch *launch, __global exact *restrict partial, const int pair_count, const int pair_chunks,
                             const int wall_count PAIR_DECLARE)
{
    bool walls = chunk >= pair_chunks;
    int first = walls ? launch->first_wall_place + (chunk - pair_chunks) * OBSERVE_CHUNK : chunk * OBSERVE_CHUNK;
    int end = min(first + OBSERVE_CHUNK, walls ? launch->first_wall_place + wall_count : pair_count);
    real most = R(0.0);
    int where = -1;
    for (int k = first; k < end; k++) {
        real ratio = walls ? guard_of_wall(launch, k PAIR_PASS) : guard_of_pair(launch, k PAIR_PASS);
        if (ratio > most) {
            most = ratio;
            where = k;
        }
    }
    partial[2 * chunk] = precise_store(precise_from(most));
    partial[2 * chunk + 1] = precise_store(precise_from_int(where));
}

/* Behind the numbers of the grains, of which there are `from`. */
__kernel void guard_records(const clast_launch launch, __global exact *restrict partial, const int from, const int pair_count, const int pair_chunks,
                            const int wall_count PAIR_DECLARE)
{
    guard_records_unit(get_global_id(0), &launch, partial + from, pair_count, pair_chunks, wall_count PAIR_PASS);
}
