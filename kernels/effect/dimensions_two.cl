/* dimensions: two. Grains move in the plane of x and y and turn about z: no third component of a position, velocity or force, nor a first or second
 * of a spin or moment, is read or computed with; what is stored of a grain is 0. The host builds such programs so that a product with 0 may be left out. */
#define SPACE_NUMBER(a) R(0.0)
#define SPACE_PRECISE(a) precise_from(R(0.0))
#define SPACE_STORE(statement) (void)0
