/* conduction: TM Eqs. 32-35, H = k_ij A/|x_j - x_i| with the area of the circle in which the two spheres cut each other.
 * With the overlap d, D = r_i + r_j - d and R = r_i + r_j Eq. 34 is A = pi d (2 r_i - d)(2 r_j - d)(2 R - d)/(4 D^2): the same for both
 * bodies to the last bit, and without the difference of two squares. A wall is the grain's mirror image, or a plane (twice as much).
 * A neck of solid material has its own area pi a^2 instead.
 * Reads resistivities 1/k of the two, the resistance t/k of the films between them, and the factors of the soft modulus. */
#ifndef CONDUCTION_RESISTIVITY_I
#define CONDUCTION_RESISTIVITY_I 0
#define CONDUCTION_RESISTIVITY_J 1
#define CONDUCTION_FILM 2
#define CONDUCTION_OVERLAP_FACTOR 3
#define CONDUCTION_TIME_FACTOR 4
#endif
#ifndef CONDUCTION_WALL_FACTOR
#define CONDUCTION_WALL_FACTOR R(1.0)
#endif

INLINE real conduction_overlap_area(const contact *c, real d)
{
    real ri = c->radius_i, rj = c->radius_j, both = ri + rj, distance = both - d;
    real resistance = ri * (c->resists_i * c->value[CONDUCTION_RESISTIVITY_I]) + rj * (c->resists_j * c->value[CONDUCTION_RESISTIVITY_J]) + c->value[CONDUCTION_FILM];
    real through = c->neck > R(0.0) ? c->neck : R(0.0), share = R(3.14159265358979324) * through * through * both;
    real cut = d * (R(2.0) * ri - d) * (R(2.0) * rj - d) * (R(2.0) * both - d) * both;
    real circle = R(0.78539816339744831) * c->value[CONDUCTION_TIME_FACTOR] * cut / (distance * distance * distance * resistance);
    return through > R(0.0) ? share / (distance * resistance) : circle;
}

INLINE real conduction_conductance(const contact *c)
{
    return conduction_overlap_area(c, c->value[CONDUCTION_OVERLAP_FACTOR] * c->touch);
}

INLINE real conduction_wall_conductance(const contact *c)
{
    return CONDUCTION_WALL_FACTOR * conduction_overlap_area(c, R(2.0) * c->value[CONDUCTION_OVERLAP_FACTOR] * c->touch);
}
