/* tangential: stick-slip with a constant stiffness; damper and return as in TM Eq. 7-13.
 * Reads TANGENTIAL_STIFFNESS = k (N/m), TANGENTIAL_DAMPING = 2 xi sqrt(k), TANGENTIAL_COMPLIANCE = 1/k; history: tangential_spring (m). */
#ifndef TANGENTIAL_STIFFNESS
#define TANGENTIAL_STIFFNESS 0
#define TANGENTIAL_DAMPING 1
#define TANGENTIAL_COMPLIANCE 2
#endif
#ifndef LEVER_ARM_SHRINKS
#define LEVER_ARM_SHRINKS R(1.0)
#endif
#define TANGENTIAL_RESCALED 0
#define TANGENTIAL_STIFFNESS_OF(c) ((c)->overlap > R(0.0) ? modulus_tangential(c) * (c)->value[TANGENTIAL_STIFFNESS] : R(0.0))
#define TANGENTIAL_DAMPING_OF(c) ((c)->overlap > R(0.0) ? modulus_root(modulus_tangential(c)) * (c)->value[TANGENTIAL_DAMPING] * sqrt((c)->mass_eff) : R(0.0))
#define TANGENTIAL_COMPLIANCE_OF(c) ((c)->overlap > R(0.0) ? modulus_inverse(modulus_tangential(c)) * (c)->value[TANGENTIAL_COMPLIANCE] : R(0.0))
