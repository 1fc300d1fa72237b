/* radius: linear thermal expansion, HC Eq. 8: r = r_ref (1 + alpha (T - T_ref)). Mass and angular momentum stay: as the moment of inertia grows
 * with r^2 the spin falls. Reads EXPANSION = alpha (1/K), EXPANSION_FROM = T_ref (K), the radius at T_ref, and that at the last table, since a
 * grain uses up the skin by its growth, too. Writes radius where the temperature is written. */
#ifndef EXPANSION
#define EXPANSION 0
#define EXPANSION_FROM 1
#endif
#define RADIUS_OWN(READ, WRITE) WRITE(exact, radius)
#define RADIUS_PARTICLE_FIELDS(READ, WRITE) READ(exact, reference_radius) READ(exact, built_radius)
#define RADIUS_STORE(i, g, t) radius_store(radius + (i), reference_radius[i], g, t)
#define RADIUS_RATE(i, g, rate) (number(reference_radius[i]) * (g)->value[EXPANSION] * (rate))
#define RADIUS_SPIN(i, w, growth) radius_spin(w, radius_turn_lost(number(radius[i]), growth))
#define RADIUS_SPIN_WORK(i, w, growth, inertia) radius_spin_work(number(radius[i]), w, growth, inertia)
#define RADIUS_TRAVEL(i, moved2) radius_travel(moved2, precise_load(radius[i]), precise_load(built_radius[i]))

/* Returns the growth, m. */
INLINE real radius_store(__global exact *radius, exact reference, const grain *g, precise temperature)
{
    precise strain = precise_mul(precise_from(g->value[EXPANSION]), precise_sub(temperature, precise_from(g->value[EXPANSION_FROM])));
    precise rest = precise_load(reference), now = precise_add(rest, precise_mul(rest, strain));
    real growth = rounded(precise_sub(now, precise_load(*radius)));
    *radius = precise_store(now);
    return growth;
}

/* Share of its spin that a grain loses by growing to the radius r: 1 - (r - growth)^2/r^2. */
INLINE real radius_turn_lost(real r, real growth)
{
    return growth * (R(2.0) * r - growth) / (r * r);
}

INLINE precise3 radius_spin(precise3 spin, real lost)
{
    return precise3_add_scaled(spin, -lost, spin);
}

/* Rotational energy gained by that, J; `inertia` is that of the radius r. With L = j w kept it changes as 1/j. */
INLINE real radius_spin_work(real r, vec3 spin, real growth, real inertia)
{
    real before = r - growth;
    return R(-0.5) * inertia * (before * before) / (r * r) * dot3(spin, spin) * radius_turn_lost(r, growth);
}

INLINE real radius_travel(real moved2, precise now, precise built)
{
    real grown = rounded(precise_sub(now, built)), way = sqrt(moved2) + (grown > R(0.0) ? grown : R(0.0));
    return way * way;
}
