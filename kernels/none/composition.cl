/* composition: one material; the class of a contact is 0 between grains, else that of the wall. */
#define COMPOSITION_PAIR_FIELDS(READ, WRITE)
#define COMPOSITION_GRAIN(i) 0

INLINE int composition_class(int material_i, int party)
{
    (void)material_i;
    return party;
}
