/* Words: lists written "a|b|c", and which known word a misspelt one is nearest to. */
#include "parameter.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *article(const char *name)
{
    return strchr("aeiou", name[0]) ? "an" : "a";
}

int words_find(const char *words, const char *word)
{
    size_t wanted = strlen(word);
    for (int index = 0; words && *words; index++) {
        size_t length = strcspn(words, "|");
        if (length == wanted && memcmp(words, word, length) == 0)
            return index;
        words += length + (words[length] == '|');
    }
    return -1;
}

int words_count(const char *words)
{
    int count = words && *words ? 1 : 0;
    for (; words && *words; words++)
        count += *words == '|';
    return count;
}

void words_list(const char *words, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    while (words && *words && used + 2 < size) {
        size_t length = strcspn(words, "|");
        int written = snprintf(text + used, size - used, "%s`%.*s`", used ? ", " : "", (int)length, words);
        used += (size_t)written;
        words += length + (words[length] == '|');
    }
}

#define NEAREST_MAX 63

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

/* Levenshtein's distance, for words up to NEAREST_MAX letters. */
static int edit_distance(const char *a, const char *b)
{
    size_t m = strlen(a), n = strlen(b);
    int row[NEAREST_MAX + 1];
    for (size_t j = 0; j <= n; j++)
        row[j] = (int)j;
    for (size_t i = 1; i <= m; i++) {
        int diagonal = row[0];
        row[0] = (int)i;
        for (size_t j = 1; j <= n; j++) {
            int above = row[j];
            row[j] = smaller(smaller(above, row[j - 1]) + 1, diagonal + (a[i - 1] != b[j - 1]));
            diagonal = above;
        }
    }
    return row[n];
}

const char *word_nearest(const char *word, const char *const *known, int count)
{
    const char *best = NULL;
    size_t length = strlen(word);
    if (length > NEAREST_MAX)
        return NULL;
    int least = smaller(6, (int)(length / 2) + 1);
    for (int k = 0; k < count; k++) {
        size_t other = strlen(known[k]);
        if (other > NEAREST_MAX)
            continue;
        int distance = edit_distance(word, known[k]);
        /* A key written without its unit is a frequent slip, however long the unit. */
        if (length > 3 && other > length && memcmp(word, known[k], length) == 0 && known[k][length] == '_')
            distance = smaller(distance, 1);
        if (distance < least) {
            least = distance;
            best = known[k];
        }
    }
    return best;
}
