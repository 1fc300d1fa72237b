/* dimensions: three. What a scene of two dimensions leaves out (effect/dimensions_two.cl), as a number, one with all its bits, and a statement. */
#define SPACE_NUMBER(a) (a)
#define SPACE_PRECISE(a) (a)
#define SPACE_STORE(statement) statement
