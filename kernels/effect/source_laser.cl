/* source: laser, Lambert-Beer (TM Eq. 31): what passes to the depth s below the bed's surface is exp(-mu s). Reads reach = mu, 1/m. */
INLINE real beam_laser(const clast_beam *b, real depth)
{
    return exp(-number(b->reach) * depth);
}
