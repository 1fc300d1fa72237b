/* composition: several materials. Reads the material of every grain; parties are the materials, then the walls. */
#ifndef PARTIES
#define PARTIES 1
#endif
#define COMPOSITION_PAIR_FIELDS(READ, WRITE) READ(int, material)
#define COMPOSITION_GRAIN(i) material[i]

INLINE int composition_class(int material_i, int party)
{
    return material_i * PARTIES + party;
}
