/* Calls a fuzz target with the files of the folders that are named: what fuzzing has found stays a test, with any compiler. */
#include "fuzz.h"

#include <dirent.h>

static int replay(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return 0;
    char *data = NULL;
    size_t size = 0, room = 0, some;
    do {
        room += 65536;
        data = realloc(data, room);
        FUZZ_HOLDS(data);
        some = fread(data + size, 1, room - size, file);
        size += some;
    } while (some > 0 && size == room);
    fclose(file);
    printf("%s\n", path);
    fflush(stdout);
    LLVMFuzzerTestOneInput((const uint8_t *)data, size);
    free(data);
    return 1;
}

int main(int argc, char **argv)
{
    int files = 0;
    for (int k = 1; k < argc; k++) {
        DIR *folder = opendir(argv[k]);
        FUZZ_HOLDS(folder);
        for (struct dirent *entry; (entry = readdir(folder));) {
            char path[4096];
            snprintf(path, sizeof path, "%s/%s", argv[k], entry->d_name);
            if (entry->d_name[0] != '.')
                files += replay(path);
        }
        closedir(folder);
    }
    printf("%d inputs\n", files);
    return files > 0 ? 0 : 1;
}
