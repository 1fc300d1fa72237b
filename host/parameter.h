/* The parameter table: one row per scene key, with its type, unit, range, default and what it means. Parsing, range checks, messages
 * about unknown keys and the scene reference all come from these rows. */
#ifndef CLAST_HOST_PARAMETER_H
#define CLAST_HOST_PARAMETER_H
#include "document.h"
#include "law.h"
#include "scene.h"

typedef enum parameter_type {
    PARAMETER_NUMBER,    /* double */
    PARAMETER_INTEGER,   /* int64_t */
    PARAMETER_FLAG,      /* bool */
    PARAMETER_CHOICE,    /* an enum */
    PARAMETER_TEXT,      /* char * */
    PARAMETER_NAME,      /* char *, a word that can stand in paths */
    PARAMETER_VECTOR,    /* double[3] */
    PARAMETER_DIRECTION, /* double[3], normalised */
    PARAMETER_COUNTS,    /* int64_t[3] */
    PARAMETER_NUMBERS,   /* double * and its count */
    PARAMETER_WORDS,     /* char ** and its count */
    PARAMETER_FLAGS,     /* bool[], one per choice, from a list of words */
    PARAMETER_SECTION,   /* a mapping into the struct at the offset */
    PARAMETER_LIST,      /* a list of mappings, an array of structs and its count */
    PARAMETER_OTHER,     /* what `read` makes of it */
    PARAMETER_LATER      /* known, but not in this version: an error that says so */
} parameter_type;

struct section;
struct parameter;

typedef struct reader {
    document *document;
    scene *scene;
    failure *why;
} reader;

typedef struct parameter {
    const char *key;
    parameter_type type;
    const char *unit; /* NULL: none */
    double low, high; /* both ends included unless open_low; both 0: any number */
    bool open_low;
    bool required;
    bool keep;            /* when absent leave what is there */
    const char *fallback; /* default as text; NULL: NAN, -1, empty */
    const char *shown;    /* default for the reference, where it is not `fallback` */
    const char *word;     /* accepted instead of a number and stored like an absent one ("auto") */
    double absent;        /* what an integer stores then; NAN: so does a double of PARAMETER_OTHER */
    const char *choices;  /* "a|b|c" */
    const char *later;    /* choices of the interface that this version lacks */
    int first;            /* enum value of the first choice */
    bool as_number;       /* a choice stored as a double */
    bool as_flag;         /* a choice of two stored as a bool: true is the second */
    const char *only;     /* values of the section's selector under which the key exists, "a|b"; NULL: all */
    const char *doc;
    const char *form; /* for the reference: what the value looks like, where the type does not say it */
    size_t offset;    /* in the section's struct */
    size_t count;     /* offset of an int: length of a list */
    size_t given;     /* offset of a bool set when the key is there; 0: none */
    size_t size;      /* of one struct of a list */
    const struct section *section;
    status (*read)(reader *r, const struct parameter *row, int node, void *target);
} parameter;

typedef struct section {
    const char *name; /* "wall", as messages call it */
    const char *doc;
    const char *selector;                       /* key of the choice that says which rows exist, or NULL */
    const parameter *row;                       /* ends with a NULL key */
    const property *const *(*properties)(void); /* further keys, one number each */
    size_t values;                              /* offset of the double * that holds them */
    bool placed;
    size_t at;                                           /* offset of a place */
    status (*finish)(reader *r, int node, void *target); /* checks over several keys; normalising */
} section;

/* Reads a mapping into the struct, row by row in the table's order; what is absent gets its default. `node` 0: defaults only. */
status parameter_section(reader *r, const section *s, int node, void *target);
/* Reads one key's value. */
status parameter_value(reader *r, const parameter *row, int node, void *target);
/* Stores the index of a choice as its row says. */
void parameter_store_choice(const parameter *row, int index, void *store);
status parameter_number(reader *r, const parameter *row, int node, double *out);
status parameter_vector(reader *r, const parameter *row, int node, double out[3]);
status parameter_numbers(reader *r, const parameter *row, int node, double **out, int *count);
status parameter_word(reader *r, const char *key, int node, const char **out);
/* A list, or an error; `least` entries at least. */
status parameter_list_length(reader *r, const parameter *row, int node, int *out);

/* A property that is a table against temperature: keeps it in the scene, and the number that stands for it in *value (scene_quantity.c). */
status read_property_table(reader *r, const parameter *row, const property *property, int node, double *value);
/* A property as a row. */
parameter parameter_of_property(const property *p);
/* "Pa" from "youngs_modulus_pa"; NULL where the key ends in no unit. */
const char *parameter_unit(const char *key);
/* "a number in m, above 0 and at most 1". */
void parameter_allowed(const parameter *row, char *text, size_t size);
/* The range alone, for the reference: "> 0, <= 1"; empty when any number will do. */
void parameter_range(const parameter *row, char *text, size_t size);

/* "a wall", "an effect": as messages begin. */
const char *article(const char *name);

/* Words of "a|b|c". */
int words_find(const char *words, const char *word);
int words_count(const char *words);
/* "a, b, c", quoted with backticks. */
void words_list(const char *words, char *text, size_t size);
/* The nearest of a NULL-terminated list when it is near enough to be a slip of the pen, else NULL. */
const char *word_nearest(const char *word, const char *const *known, int count);

/* Never NULL: the host cannot go on without a few bytes, and says so. */
void *scene_allocate(size_t count, size_t size);
char *scene_copy(const char *text);
/* Normalises; false for a zero vector. */
bool vector_normalise(double v[3]);

#endif
