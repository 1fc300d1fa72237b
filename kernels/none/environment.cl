/* environment: no law asks for it. */
#define ENVIRONMENT_PARTICLE_FIELDS(READ, WRITE)
#define ENVIRONMENT_AT(launch, g)
