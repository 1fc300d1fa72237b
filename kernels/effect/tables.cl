/* tables: properties that depend on temperature, linear between the places of a table and constant outside. A row holds its places (rising, from
 * the last one on 1e30), the values and the slopes from there on (from the last one on 0). A constant of a material or a contact below zero
 * names a row, -1 - row; else it is the value. No loops and no branches where contacts look one up. */
#define TABLED_PLACES CLAST_TABLE_PLACES
#define TABLED_ROW(tables, value) ((tables) + ((value) < R(0.0) ? 3 * TABLED_PLACES * ((int)(-(value)) - 1) : 0))

/* The last place at or below the temperature; 0 where all are above it. */
INLINE int tabled_place(__global const real *row, real temperature)
{
    int p = temperature >= row[16] ? 16 : 0;
    p += temperature >= row[p + 8] ? 8 : 0;
    p += temperature >= row[p + 4] ? 4 : 0;
    p += temperature >= row[p + 2] ? 2 : 0;
    return p + (temperature >= row[p + 1] ? 1 : 0);
}

INLINE real tabled_at(__global const real *tables, real value, real temperature)
{
    __global const real *row = TABLED_ROW(tables, value);
    int p = tabled_place(row, temperature);
    real past = temperature - row[p];
    past = past > R(0.0) ? past : R(0.0);
    real found = row[TABLED_PLACES + p] + row[2 * TABLED_PLACES + p] * past;
    return value < R(0.0) ? found : value;
}

/* From a temperature on, the way x to the next place in the given direction (at most `most`), the value c here and its slope over that way. */
INLINE real tabled_stretch(__global const real *row, real temperature, bool up, real most, real *c, real *slope)
{
    int p = tabled_place(row, temperature);
    bool below = temperature < row[0] || (!up && temperature == row[0]);
    if (!up && !below && temperature == row[p])
        p--; /* on a place, looking down */
    real past = temperature - row[p];
    *slope = below ? R(0.0) : row[2 * TABLED_PLACES + p];
    *c = row[TABLED_PLACES + p] + *slope * past;
    real next = up ? (below ? row[0] : row[min(p + 1, TABLED_PLACES - 1)]) : (below ? R(-1e30) : row[p]);
    real way = next - temperature;
    return fabs(way) < fabs(most) && p + 1 < TABLED_PLACES ? way : most;
}

/* Integral of a table over x from a temperature on. */
INLINE real tabled_integral(__global const real *tables, real value, real temperature, real x)
{
    __global const real *row = TABLED_ROW(tables, value);
    real sum = R(0.0), left = x, t = temperature;
    for (int n = 0; n <= TABLED_PLACES && left != R(0.0); n++) {
        real c, slope, way = tabled_stretch(row, t, x > R(0.0), left, &c, &slope);
        sum += way * (c + R(0.5) * slope * way);
        left -= way;
        t += way;
    }
    return value < R(0.0) ? sum : value * x;
}

/* The x over which the integral of a table from a temperature on is q. */
INLINE real tabled_inverse(__global const real *tables, real value, real temperature, real q)
{
    __global const real *row = TABLED_ROW(tables, value);
    real x = R(0.0), left = q, t = temperature;
    for (int n = 0; n <= TABLED_PLACES && left != R(0.0); n++) {
        real c, slope, way = tabled_stretch(row, t, q > R(0.0), q > R(0.0) ? R(1e30) : R(-1e30), &c, &slope);
        real all = way * (c + R(0.5) * slope * way), square = c * c + R(2.0) * slope * left;
        bool inside = fabs(left) <= fabs(all);
        real step = inside ? R(2.0) * left / (c + sqrt(square > R(0.0) ? square : R(0.0))) : way;
        x += step;
        t += step;
        left = inside ? R(0.0) : left - all;
    }
    return value < R(0.0) ? x : q / value;
}
