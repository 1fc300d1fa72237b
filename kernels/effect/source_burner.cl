/* source: burner (TM Eq. 30): what passes falls linearly to 0 at the depth d_max. Reads reach = 1/d_max, 1/m. */
INLINE real beam_burner(const clast_beam *b, real depth)
{
    real share = R(1.0) - number(b->reach) * depth;
    return share > R(0.0) ? share : R(0.0);
}
