/* Bonds as the table sees them. Per chunk of records: bonds that they have had, and those that live now (the field `bonded` holds twice the
 * first, less one while the last lives, with a sign that does not matter here). */
__kernel void table_bond_sums(__global const real *restrict bonded, __global exact *restrict partial, const int record_count)
{
    int chunk = get_global_id(0), first = chunk * SCAN_CHUNK, end = min(first + SCAN_CHUNK, record_count);
    int made = 0, alive = 0;
    for (int k = first; k < end; k++) {
        int count = (int)(fabs(bonded[k]) + R(0.5));
        made += (count + 1) / 2;
        alive += count % 2;
    }
    partial[2 * chunk] = precise_store(precise_from_int(made));
    partial[2 * chunk + 1] = precise_store(precise_from_int(alive));
}
