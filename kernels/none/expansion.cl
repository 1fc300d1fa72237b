/* expansion: nobody asks for the work of growing grains. */
#define EXPANSION_PAIR_FIELDS(READ, WRITE)
#define EXPANSION_PARTICLE_FIELDS(READ, WRITE)
#define EXPANSION_LOAD(launch, k, s) (s).unused = 0
#define EXPANSION_STORE(launch, k, s)
#define EXPANSION_STORE_WORK(launch, k, s)
#define EXPANSION_GATHER(launch, k, sum)
#define GROWTH_OF(i) R(0.0)
#define GROWTH_KEEP(i, growth) (void)(growth)

typedef struct expansion_state {
    int unused;
} expansion_state;

INLINE void expansion_contact(const contact *c, real spring, expansion_state *s)
{
    (void)c;
    (void)spring;
    (void)s;
}
