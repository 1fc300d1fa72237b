/* expansion: work that grains do on the springs of their contacts by growing: the mean of the spring's force before and after times the growth of
 * the two radii, and what a larger r* does to the energy of the normal law at the same overlap. Reads and writes growth, that of the radius in
 * the last step; history: pushed, the force of the spring in the last step. A record keeps the work of this step. */
#define EXPANSION_PAIR_FIELDS(READ, WRITE) READ(real, growth) WRITE(real, pushed) WRITE(real, expansion_work)
#define EXPANSION_PARTICLE_FIELDS(READ, WRITE) WRITE(real, growth) READ(real, expansion_work)
#define EXPANSION_LOAD(launch, k, s) (s).pushed = pushed[k]
#define EXPANSION_STORE(launch, k, s) pushed[k] = (s).pushed
#define EXPANSION_STORE_WORK(launch, k, s) expansion_work[k] = (s).work
#define EXPANSION_GATHER(launch, k, sum) sum += expansion_work[k]
#define GROWTH_OF(i) growth[i]
#define GROWTH_KEEP(i, grown) growth[i] = (grown)

typedef struct expansion_state {
    real pushed, work;
} expansion_state;

INLINE void expansion_contact(const contact *c, real spring, expansion_state *s)
{
    real both = c->growth_i + c->growth_j;
    /* d ln r*: with r* = r_i at a wall, whose growth is none */
    real by_i = c->growth_i / (c->radius_i * c->radius_i), by_j = c->growth_j / (c->radius_j * c->radius_j);
    real stretched = NORMAL_ENERGY_BY_RADIUS * normal_energy(c) * c->radius_eff * (by_i + by_j);
    s->work = R(0.5) * (s->pushed + spring) * both + stretched;
    s->pushed = spring;
}
