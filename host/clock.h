/* The time that passes, for what is said of it. */
#ifndef CLAST_CLOCK_H
#define CLAST_CLOCK_H

/* Seconds since some moment, which never go back. */
double clock_seconds(void);

#endif
