/* friction: coefficients that depend on the mean temperature of the two bodies, by tables; a wall has that of its grain. A constant below 0 names
 * a table (tables.cl). */
#define FRICTION_OF(c, k) friction_at(c, (c)->value[k])

INLINE real friction_at(const contact *c, real value)
{
    return tabled_at(c->tables, value, R(0.5) * (c->temperature_i + c->temperature_j));
}
