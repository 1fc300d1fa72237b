/* Exclusive prefix sums in three launches: every work-item adds up a chunk, one adds up the chunks, every work-item writes its own. */
#define SCAN_CHUNK 1024

INLINE void scan_chunks_unit(int chunk, __global const uint *restrict values, __global uint *restrict sums, const int count)
{
    int first = chunk * SCAN_CHUNK;
    int end = min(first + SCAN_CHUNK, count);
    uint sum = 0;
    for (int i = first; i < end; i++)
        sum += values[i];
    sums[chunk] = sum;
}

__kernel void scan_chunks(__global const uint *restrict values, __global uint *restrict sums, const int count)
{
    scan_chunks_unit(get_global_id(0), values, sums, count);
}

INLINE void scan_sums_unit(__global uint *restrict sums, const int chunks)
{
    uint sum = 0;
    for (int c = 0; c < chunks; c++) {
        uint here = sums[c];
        sums[c] = sum;
        sum += here;
    }
    sums[chunks] = sum;
}

__kernel void scan_sums(__global uint *restrict sums, const int chunks)
{
    scan_sums_unit(sums, chunks);
}

/* All of it by one work-item, where three launches would cost more. */
INLINE void scan_whole_unit(__global const uint *restrict values, __global uint *restrict result, const int count)
{
    uint sum = 0;
    for (int i = 0; i < count; i++) {
        uint here = values[i];
        result[i] = sum;
        sum += here;
    }
    result[count] = sum;
}

__kernel void scan_whole(__global const uint *restrict values, __global uint *restrict result, const int count)
{
    scan_whole_unit(values, result, count);
}

/* result[count] holds the total. */
INLINE void scan_write_unit(int chunk, __global const uint *restrict values, __global const uint *restrict sums, __global uint *restrict result,
                            const int count)
{
    int first = chunk * SCAN_CHUNK;
    int end = min(first + SCAN_CHUNK, count);
    uint sum = sums[chunk];
    for (int i = first; i < end; i++) {
        result[i] = sum;
        sum += values[i];
    }
    if (end == count)
        result[count] = sum;
}

__kernel void scan_write(__global const uint *restrict values, __global const uint *restrict sums, __global uint *restrict result, const int count)
{
    scan_write_unit(get_global_id(0), values, sums, result, count);
}
