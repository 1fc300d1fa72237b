/* Random clusters of spinning grains that fall together, and scenes that are images of one another under a rotation or a mirror. */
#ifndef CLAST_TESTS_CLUSTER_H
#define CLAST_TESTS_CLUSTER_H
#include "case.h"

#define CLUSTER_MAX 128

typedef struct cluster {
    int count;
    double radius[CLUSTER_MAX], position[CLUSTER_MAX][3], velocity[CLUSTER_MAX][3], spin[CLUSTER_MAX][3];
} cluster;

/* A fixed sequence in [0, 1) (Numerical Recipes' 64-bit congruential generator). */
static inline double random_number(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 9007199254740992.0;
}

static inline double random_between(uint64_t *state, double low, double high)
{
    return low + (high - low) * random_number(state);
}

/* Grains on a loose cubic grid of `side` cells, each shaken within its cell, flying towards the centre. */
static inline cluster cluster_make(int side, double radius, double speed, double spin, uint64_t seed)
{
    cluster c = {0};
    double cell = 2.6 * radius, middle = 0.5 * cell * (side - 1);
    for (int n = 0; n < side * side * side; n++) {
        const int index[3] = {n % side, n / side % side, n / (side * side)};
        c.radius[n] = radius * random_between(&seed, 0.7, 1.0);
        for (int k = 0; k < 3; k++) {
            double home = cell * index[k] - middle;
            c.position[n][k] = home + random_between(&seed, -0.2, 0.2) * radius;
            c.velocity[n][k] = -speed * home / cell + random_between(&seed, -0.3, 0.3) * speed;
            c.spin[n][k] = random_between(&seed, -spin, spin);
        }
    }
    c.count = side * side * side;
    return c;
}

static inline void put_cluster(text *t, const cluster *c)
{
    put(t, "particles:\n  - name: cluster\n    material: m\n    generator: list\n    items:\n");
    for (int n = 0; n < c->count; n++)
        put_grain(t, c->radius[n], c->position[n], c->velocity[n], c->spin[n]);
}

/* An orthogonal matrix applied; `determinant` -1 (a mirror) turns the sign of axial vectors. */
static inline void image(const double m[9], double factor, const double *a, double *b)
{
    for (int i = 0; i < 3; i++)
        b[i] = factor * (m[3 * i] * a[0] + m[3 * i + 1] * a[1] + m[3 * i + 2] * a[2]);
}

static inline cluster cluster_image(const cluster *c, const double m[9], double determinant)
{
    cluster r = *c;
    for (int n = 0; n < c->count; n++) {
        image(m, 1.0, c->position[n], r.position[n]);
        image(m, 1.0, c->velocity[n], r.velocity[n]);
        image(m, determinant, c->spin[n], r.spin[n]);
    }
    return r;
}

/* Deviation of b from the image of a, the largest over all grains, for a vector field. */
static inline double image_error(const double *a, const double *b, int count, const double m[9], double factor)
{
    double worst = 0.0;
    for (int n = 0; n < count; n++) {
        double expected[3];
        image(m, factor, a + 3 * n, expected);
        for (int k = 0; k < 3; k++)
            worst = fmax(worst, fabs(b[3 * n + k] - expected[k]));
    }
    return worst;
}

#endif
