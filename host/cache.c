#include "cache.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

bool cache_directory(char *path, size_t size)
{
    const char *base = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    int length;
    if (base && *base)
        length = snprintf(path, size, "%s", base);
    else if (home && *home)
        length = snprintf(path, size, "%s/.cache", home);
    else
        return false;
    if (length < 0 || (size_t)length + sizeof "/clast" > size)
        return false;
    mkdir(path, 0777);
    strcat(path, "/clast");
    return mkdir(path, 0777) == 0 || errno == EEXIST;
}
