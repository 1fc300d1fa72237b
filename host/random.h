/* Random numbers from Random123's counter-based philox4x32-10: a number is a function of (seed, group, purpose, index, draw) alone, so
 * that it depends neither on the machine nor on the order in which numbers are asked for. The elementary functions that go with it use
 * only + - * / and sqrt, because the last bit of libm's log or cos differs between machines, and a packing grows such a bit into
 * another bed. */
#ifndef CLAST_HOST_RANDOM_H
#define CLAST_HOST_RANDOM_H
#include <stdbool.h>
#include <stdint.h>

typedef enum random_purpose { RANDOM_RADIUS = 1, RANDOM_POSITION = 2, RANDOM_VELOCITY = 3 } random_purpose;

typedef struct random_stream {
    uint64_t seed;
    uint32_t group, purpose, index, draw;
    double uniform[2];
    int uniforms_left;
    double normal;
    bool normal_left;
} random_stream;

random_stream random_start(uint64_t seed, uint32_t group, random_purpose purpose, uint32_t index);
/* Uniform in the open interval (0, 1), 52 bits. */
double random_uniform(random_stream *stream);
/* Standard normal, by Box and Muller. */
double random_normal(random_stream *stream);

/* Within some units in the last place of the true value, and the same bits on every machine with IEEE doubles. */
double portable_log(double x);
double portable_exp(double x);
/* cos(2 pi x) and sin(2 pi x) for |x| < 2^20. */
void portable_turn(double x, double *cosine, double *sine);

#endif
