/* Where programs and beds are kept between runs. */
#ifndef CLAST_HOST_CACHE_H
#define CLAST_HOST_CACHE_H
#include <stdbool.h>
#include <stddef.h>

/* ${XDG_CACHE_HOME:-~/.cache}/clast, made if need be; false where there is none to be had. */
bool cache_directory(char *path, size_t size);

#endif
