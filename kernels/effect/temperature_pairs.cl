/* temperature of the bodies of a contact, for the laws that read it. */
#define TEMPERATURE_PAIR_FIELDS(READ, WRITE) READ(real, temperature)
#define TEMPERATURE_OF_BODY(i) temperature[i]
