/* softening: nobody asks for the work of moduli that change under a contact. */
#define SOFTENING_PAIR_FIELDS(READ, WRITE)
#define SOFTENING_LOAD(launch, k, s) (s).unused = 0
#define SOFTENING_STORE(launch, k, s)

typedef struct softening_state {
    int unused;
} softening_state;

INLINE real softening_work(const contact *c, softening_state *s)
{
    (void)c;
    (void)s;
    return R(0.0);
}
