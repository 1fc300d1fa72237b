/* bond: grains do not bond. */
#define BOND_PAIR_FIELDS(READ, WRITE)
#define BOND_ASK_FOR(launch, k)
#define BOND_LOAD(launch, k, s) (s).unused = 0
#define BOND_STORE(launch, k, s)

typedef struct bond_state {
    int unused;
} bond_state;

/* 1 while the contact is bonded. */
INLINE real bond_holds(const bond_state *s)
{
    (void)s;
    return R(0.0);
}

/* Before the other laws: what a bond changes of the geometry of bodies that stand apart. */
INLINE void bond_geometry(contact *c, const bond_state *s)
{
    (void)c;
    (void)s;
}

INLINE void bond_normal(const contact *c, bond_state *s, response *out)
{
    (void)c;
    (void)s;
    (void)out;
}

/* After friction and rolling: forces and moments of the bond's own. */
INLINE void bond_shear(const contact *c, bond_state *s, response *out)
{
    (void)c;
    (void)s;
    (void)out;
}

/* What the bond's springs hold, to be added to the energy of the contact. */
INLINE real bond_energy(const contact *c, const bond_state *s)
{
    (void)c;
    (void)s;
    return R(0.0);
}

/* Changes the modes of the contact to those with the bond. */
INLINE void bond_modes(const contact *c, const bond_state *s, mode *normal, mode *tangential, mode *rolling)
{
    (void)c;
    (void)s;
    (void)normal;
    (void)tangential;
    (void)rolling;
}

/* The state of a bond that lives, for the step limit of contacts to be expected. */
INLINE bond_state bond_expected(const contact *c)
{
    bond_state s = {0};
    (void)c;
    return s;
}

/* Whether the two may still get a bond that they do not have. */
INLINE bool bond_may_come(const contact *c, const bond_state *s)
{
    (void)c;
    (void)s;
    return false;
}
