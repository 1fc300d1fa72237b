/* Damping ratio from a coefficient of restitution, for collisions whose force never attracts (the clamp of TM Eq. 6, stated in BM sec. 4). */
#ifndef CLAST_HOST_RESTITUTION_H
#define CLAST_HOST_RESTITUTION_H

/* Coefficient of restitution of a clamped Hertz contact with damping ratio xi; independent of velocity. */
double hertz_restitution(double damping_ratio);
double hertz_damping_ratio(double restitution);
/* The same for the linear spring: exp(-xi phi / sqrt(1 - xi^2)), phi the phase at which the clamped force ends. */
double linear_restitution(double damping_ratio);
double linear_damping_ratio(double restitution);

#endif
