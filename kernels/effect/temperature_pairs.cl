/* temperature of the bodies of a contact, for the laws that read it. */
#define TEMPERATURE_PAIR_FIELDS(READ, WRITE) READ(exact, temperature)
#define TEMPERATURE_OF_BODY(i) number(temperature[i])
