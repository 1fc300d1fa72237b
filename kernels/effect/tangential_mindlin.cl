/* tangential: stick-slip with Mindlin's stiffness, TM Eq. 7-13 with a radial return (docs/theory.md).
 * k = 8 G* sqrt(r* d), c = 2 xi sqrt(8 G* m* sqrt(r*)) d^(1/4).
 * Reads TANGENTIAL_MODULUS = 8 G* (Pa), TANGENTIAL_DAMPING = 2 xi sqrt(8 G*) (Pa^1/2),
 * TANGENTIAL_COMPLIANCE = 1/(8 G*); history: tangential_spring (m). */
#ifndef TANGENTIAL_MODULUS
#define TANGENTIAL_MODULUS 0
#define TANGENTIAL_DAMPING 1
#define TANGENTIAL_COMPLIANCE 2
#endif
#ifndef LEVER_ARM_SHRINKS
#define LEVER_ARM_SHRINKS R(1.0)
#endif
#ifndef TANGENTIAL_RESCALED
#define TANGENTIAL_RESCALED 0
#endif
#define TANGENTIAL_STIFFNESS_OF(c) (modulus_tangential(c) * (c)->value[TANGENTIAL_MODULUS] * (c)->contact_radius)
#define TANGENTIAL_DAMPING_OF(c) (modulus_root(modulus_tangential(c)) * (c)->value[TANGENTIAL_DAMPING] * (c)->inertia_root)
#define TANGENTIAL_COMPLIANCE_OF(c) (modulus_inverse(modulus_tangential(c)) * (c)->value[TANGENTIAL_COMPLIANCE] * (c)->contact_inverse)
