/* radius: a constant of the grain. */
#define RADIUS_OWN(READ, WRITE) READ(exact, radius)
#define RADIUS_PARTICLE_FIELDS(READ, WRITE)
#define RADIUS_STORE(i, g, t) R(0.0)
#define RADIUS_RATE(i, g, rate) R(0.0)
#define RADIUS_SPIN(i, w, growth) (w)
#define RADIUS_SPIN_WORK(i, w, growth, inertia) R(0.0)
#define RADIUS_TRAVEL(i, moved2) (moved2)
