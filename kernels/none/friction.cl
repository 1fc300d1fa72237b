/* friction: coefficients are constants of the contact. */
#define FRICTION_OF(c, k) (c)->value[k]
