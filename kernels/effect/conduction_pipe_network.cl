/* conduction: TM Eq. 36 (Feng et al. 2008), discs: the conductance of one is pi k/(-ln a + 3/2 + a^2/36 + a^4/2700) a unit of depth, a the half
 * angle under which it sees the contact, sin a = radius of the contact over its own; those of the two are in series. Spheres of a scene in two
 * dimensions are discs of a depth, by default their diameter. A wall is the grain's mirror image, or of one temperature (twice as much).
 * Reads conductivities of the two and the factors of the soft modulus. */
#ifndef CONDUCTION_K_I
#define CONDUCTION_K_I 0
#define CONDUCTION_K_J 1
#define CONDUCTION_OVERLAP_FACTOR 2
#define CONDUCTION_TIME_FACTOR 3
#endif
#ifndef CONDUCTION_WALL_FACTOR
#define CONDUCTION_WALL_FACTOR R(1.0)
#endif
#ifndef CONDUCTION_DEPTH
#define CONDUCTION_DEPTH R(0.0)
#endif

/* W/K of one disc towards a contact of radius `a` */
INLINE real conduction_pipe(real k, real radius, real a)
{
    real sine = a / radius, alpha = asin(sine < R(1.0) ? sine : R(1.0)), square = alpha * alpha;
    real depth = CONDUCTION_DEPTH > R(0.0) ? CONDUCTION_DEPTH : R(2.0) * radius;
    real drop = R(1.5) - log(alpha) + square * (R(1.0) / R(36.0) + square / R(2700.0));
    return R(3.14159265358979324) * k * depth / drop;
}

/* The two spheres cut each other in a circle of radius a, as in TM Eqs. 33-34, or are joined by a neck of that radius. */
INLINE real conduction_pipes(const contact *c, real d)
{
    real ri = c->radius_i, rj = c->radius_j, both = ri + rj, distance = both - d;
    real square = d * (R(2.0) * ri - d) * (R(2.0) * rj - d) * (R(2.0) * both - d) / (R(4.0) * distance * distance);
    square = c->neck > R(0.0) ? c->neck * c->neck : square;
    bool touches = square > R(0.0);
    real a = sqrt(touches ? square : ri * rj);
    real i = conduction_pipe(c->value[CONDUCTION_K_I] / c->resists_i, ri, a), j = conduction_pipe(c->value[CONDUCTION_K_J] / c->resists_j, rj, a);
    real sum = i + j;
    return touches && sum > R(0.0) ? c->value[CONDUCTION_TIME_FACTOR] * i * j / sum : R(0.0);
}

INLINE real conduction_conductance(const contact *c)
{
    return conduction_pipes(c, c->value[CONDUCTION_OVERLAP_FACTOR] * c->touch);
}

INLINE real conduction_wall_conductance(const contact *c)
{
    return CONDUCTION_WALL_FACTOR * conduction_pipes(c, R(2.0) * c->value[CONDUCTION_OVERLAP_FACTOR] * c->touch);
}
