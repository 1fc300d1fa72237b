/* What the fuzz targets share: each is a function of some bytes that a coverage-guided fuzzer calls (tools/fuzz), and that replay.c calls with files. */
#ifndef CLAST_TESTS_FUZZ_H
#define CLAST_TESTS_FUZZ_H
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static inline void fuzz_say(const char *format, ...) __attribute__((format(printf, 1, 2)));
static inline void fuzz_say(const char *format, ...)
{
    va_list values;
    va_start(values, format);
    vfprintf(stderr, format, values);
    va_end(values);
}

/* What must hold for any input. */
#define FUZZ_HOLDS(condition)                                                       \
    do {                                                                            \
        if (!(condition)) {                                                         \
            fuzz_say("%s:%d: does not hold: %s\n", __FILE__, __LINE__, #condition); \
            abort();                                                                \
        }                                                                           \
    } while (0)

/* With an end; caller frees. */
static inline char *fuzz_text(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    FUZZ_HOLDS(text);
    memcpy(text, data, size);
    text[size] = '\0';
    return text;
}

/* A file in memory that a reader can open by its path; caller closes. */
static inline int fuzz_file(const uint8_t *data, size_t size, char *path, size_t room)
{
    int file = memfd_create("fuzz", 0);
    FUZZ_HOLDS(file >= 0);
    for (size_t done = 0; done < size;) {
        ssize_t some = write(file, data + done, size - done);
        FUZZ_HOLDS(some > 0);
        done += (size_t)some;
    }
    snprintf(path, room, "/proc/self/fd/%d", file);
    return file;
}

#endif
