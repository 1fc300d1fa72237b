/* Random numbers of scenes, and values of properties. */
#ifndef CLAST_TESTS_RANDOM_NUMBERS_H
#define CLAST_TESTS_RANDOM_NUMBERS_H
#include "property.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

double uniform(uint64_t *state, double low, double high);
/* 10 to a power that is uniform. */
double decades(uint64_t *state, double low, double high);
bool chance(uint64_t *state, double share);
int below(uint64_t *state, int count);

/* A value of a property or an option with that range and default. */
double draw(const char *key, double low, double high, double fallback, uint64_t *state);
/* Appends ", key: value" for the properties of a list, some of them as tables against temperature where there is one (`warm`), Young's modulus where
 * its law wants that (`modulus`). */
void put_properties(char *text, size_t size, const property *const *list, bool warm, bool modulus, uint64_t *shape, uint64_t *state);

#endif
