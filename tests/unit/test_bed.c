/* Lists, lattices, frames of earlier results, and what every generator shares. */
#include "unit/bed_case.h"

#include "results.h"

#include <unistd.h>

static void list_takes_items_as_they_are(void **state)
{
    (void)state;
    particle_group g;
    scene s = case_scene(&g, 3);
    particle_item items[] = {
        {.position_m = {1, 2, 3}, .radius_m = 0.1, .velocity_m_s = {4, 5, 6}, .spin_rad_s = {7, 8, 9}, .temperature_k = 400},
        {.position_m = {-1, 0, 2}, .radius_m = 0.2, .velocity_m_s = {NAN, NAN, NAN}, .temperature_k = NAN}};
    g.generator = GENERATOR_LIST;
    g.item = items;
    g.item_count = 2;
    g.material = 3;
    g.temperature_k = 300;
    memcpy(g.velocity_m_s, (double[]){0.1, 0.2, 0.3}, sizeof g.velocity_m_s);
    bed b = case_generate(&s);
    assert_int_equal(b.count, 2);
    for (int d = 0; d < 3; d++) {
        assert_true(b.position[0][d] == items[0].position_m[d]);
        assert_true(b.velocity[0][d] == items[0].velocity_m_s[d]);
        assert_true(b.spin[0][d] == items[0].spin_rad_s[d]);
        assert_true(b.velocity[1][d] == g.velocity_m_s[d]); /* not given */
        assert_true(b.spin[1][d] == 0.0);
    }
    assert_true(b.radius[0] == 0.1 && b.radius[1] == 0.2);
    assert_true(b.temperature[0] == 400 && b.temperature[1] == 300);
    assert_int_equal(b.material[1], 3);
    assert_int_equal(b.group[1], 0);
    assert_true(b.low[0] == -1 && b.high[0] == 1 && b.low[2] == 2 && b.high[2] == 3);
    bed_free(&b);
    assert_int_equal(b.count, 0);
}

static void groups_follow_each_other(void **state)
{
    (void)state;
    particle_item item = {.position_m = {5, 5, 5}, .radius_m = 0.1, .temperature_k = NAN};
    particle_group g[2];
    scene s = case_scene(&g[0], 3);
    g[1] = g[0];
    g[0].generator = GENERATOR_LATTICE;
    g[0].spacing_m = 1.0;
    g[0].radius_m.value = 0.5;
    memcpy(g[0].counts, (int64_t[]){2, 1, 1}, sizeof g[0].counts);
    g[1].generator = GENERATOR_LIST;
    g[1].item = &item;
    g[1].item_count = 1;
    g[1].material = 1;
    s.group_count = 2;
    bed b = case_generate(&s);
    assert_int_equal(b.count, 3);
    assert_int_equal(b.group[1], 0);
    assert_int_equal(b.group[2], 1);
    assert_int_equal(b.material[2], 1);
    assert_true(b.position[2][0] == 5 && isnan(b.temperature[2]));
    bed_free(&b);
}

static particle_group lattice_group(lattice kind, int64_t nx, int64_t ny, int64_t nz, double spacing)
{
    return (particle_group){.name = "rows",
                            .generator = GENERATOR_LATTICE,
                            .lattice = kind,
                            .counts = {nx, ny, nz},
                            .spacing_m = spacing,
                            .origin_m = {0.1, 0.2, 0.3},
                            .radius_m = {.value = 0.5 * spacing * (1.0 - 1.0e-12)},
                            .temperature_k = NAN};
}

/* Neighbours within 1 % of the spacing of the grain nearest to the middle. */
static int coordination(const bed *b, double spacing)
{
    int64_t centre = 0;
    double least = INFINITY;
    for (int64_t i = 0; i < b->count; i++) {
        double distance2 = 0.0;
        for (int d = 0; d < 3; d++)
            distance2 += pow(b->position[i][d] - 0.5 * (b->low[d] + b->high[d]), 2);
        if (distance2 < least) {
            least = distance2;
            centre = i;
        }
    }
    int touching = 0;
    for (int64_t i = 0; i < b->count; i++)
        if (i != centre)
            touching += hypot(hypot(b->position[i][0] - b->position[centre][0], b->position[i][1] - b->position[centre][1]),
                              b->position[i][2] - b->position[centre][2]) < 1.01 * spacing;
    return touching;
}

/* Touching grains: the number of neighbours, no overlap, and the cell's share of the volume. */
static void lattices_are_what_they_are_called(void **state)
{
    (void)state;
    struct {
        lattice kind;
        int neighbours;
        double rise[3], fraction; /* step of the last count's direction; volume fraction of an endless lattice */
    } expected[] = {{LATTICE_SIMPLE_CUBIC, 6, {1, 1, 1}, PI / 6.0},
                    {LATTICE_HEXAGONAL, 12, {1, sqrt(0.75), sqrt(2.0 / 3.0)}, PI / sqrt(18.0)}};
    double spacing = 1.5e-3;
    for (int k = 0; k < 2; k++) {
        particle_group g = lattice_group(expected[k].kind, 7, 8, 9, spacing);
        scene s = {.dimensions = 3, .group_count = 1, .group = &g};
        bed b = case_generate(&s);
        double volume = spacing * spacing * spacing, radius = 0.5 * spacing;
        for (int d = 0; d < 3; d++) {
            volume *= expected[k].rise[d];
            assert_true(b.position[0][d] == g.origin_m[d]);
        }
        assert_int_equal(b.count, 7 * 8 * 9);
        assert_int_equal(coordination(&b, spacing), expected[k].neighbours);
        assert_true(brute_force_overlap(&b, &s.domain) < 1.0e-9);
        assert_true(fabs(4.0 / 3.0 * PI * radius * radius * radius / volume - expected[k].fraction) < 1.0e-12);
        assert_true(fabs(b.high[2] - b.low[2] - 8 * expected[k].rise[2] * spacing) < 1.0e-12);
        bed_free(&b);
    }
}

/* The heated layer: 200 grains in even rows, 199 in odd ones. */
static void triangular_rows(void **state)
{
    (void)state;
    double spacing = 1.5e-3;
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        particle_group g = lattice_group(LATTICE_TRIANGULAR, 200, dimensions == 2 ? 1 : 2, 9, spacing);
        scene s = {.dimensions = dimensions, .group_count = 1, .group = &g};
        int up = dimensions == 2 ? 1 : 2;
        g.origin_m[2] = dimensions == 2 ? 0.0 : g.origin_m[2];
        bed b = case_generate(&s);
        assert_int_equal(b.count, 1796 * (dimensions - 1));
        assert_true(b.low[0] == g.origin_m[0] && fabs(b.high[0] - g.origin_m[0] - 199 * spacing) < 1.0e-12);
        assert_true(fabs(b.high[up] - b.low[up] - 8 * spacing * sqrt(0.75)) < 1.0e-12);
        assert_true(dimensions == 2 ? b.high[2] == 0.0 : fabs(b.high[1] - b.low[1] - spacing) < 1.0e-12);
        assert_int_equal(coordination(&b, spacing), dimensions == 2 ? 6 : 7);
        bed_free(&b);
    }
}

static void bad_lattices(void **state)
{
    (void)state;
    particle_group g = lattice_group(LATTICE_SIMPLE_CUBIC, 10, 0, 1, 1.0);
    scene s = {.dimensions = 3, .group_count = 1, .group = &g, .path = "scene.yaml"};
    REFUSED(&s, "scene.yaml: particles[rows]", "counts[1] is 0");
    memcpy(g.counts, (int64_t[]){100000, 100000, 1000}, sizeof g.counts);
    REFUSED(&s, "[100000, 100000, 1000]", "1e+13", "2147483647");
    memcpy(g.counts, (int64_t[]){1, 1, 2}, sizeof g.counts);
    s.dimensions = 2;
    REFUSED(&s, "counts[2] is 2", "2 dimensions");
    s.dimensions = 3;
    g.spacing_m = 0.0;
    REFUSED(&s, "spacing_m is 0");
}

static void shared_checks(void **state)
{
    (void)state;
    particle_group g;
    scene s = case_scene(&g, 3);
    particle_item items[] = {{.radius_m = 0.1, .temperature_k = NAN}, {.radius_m = 0.1, .temperature_k = NAN}}, *item = &items[1];
    g.generator = GENERATOR_LIST;
    g.item = items;
    g.item_count = 2;
    s.domain = (domain){.given = true, .low_m = {-1, -1, -1}, .high_m = {1, 1, 1}, .periodic = {true, false, false}};
    item->position_m[1] = 1.5;
    REFUSED(&s, "scene.yaml:12:5: particles[bed]: particle 1 is at y = 1.5 m", "(-1 to 1 m)");
    item->position_m[1] = NAN;
    REFUSED(&s, "particle 1 has y = nan m");
    item->position_m[1] = 1.0; /* on the face: inside */
    item->radius_m = 0.0;
    REFUSED(&s, "particle 1 has radius 0 m");
    item->radius_m = INFINITY;
    REFUSED(&s, "particle 1 has radius inf m");
    item->radius_m = 0.1;
    item->velocity_m_s[2] = INFINITY;
    REFUSED(&s, "particle 1 has vz = inf m/s");
    item->velocity_m_s[2] = 0.0;
    item->temperature_k = -1.0;
    REFUSED(&s, "particle 1 has temperature -1 K");
    item->temperature_k = NAN;
    s.dimensions = 2;
    item->position_m[2] = 0.5;
    REFUSED(&s, "particle 1 has z = 0.5", "2 dimensions");
    item->position_m[2] = 0.0;
    item->spin_rad_s[0] = 2.0;
    REFUSED(&s, "particle 1 has wx = 2", "2 dimensions");
    item->spin_rad_s[0] = 0.0;
    item->position_m[0] = 1.25; /* wraps */
    bed b = case_generate(&s);
    assert_true(b.position[1][0] == -0.75 && b.position[1][1] == 1.0);
    bed_free(&b);
    g.item_count = 0;
    REFUSED(&s, "particles[bed]: the group has 0 particles");
    s.group_count = 0;
    REFUSED(&s, "the scene has no particles");
}

static void write_result(const char *path)
{
    const results_field fields[] = {{.name = "position", .unit = "m", .components = 3},
                                    {.name = "velocity", .unit = "m s-1", .components = 3},
                                    {.name = "spin", .unit = "rad s-1", .components = 3},
                                    {.name = "radius", .unit = "m", .components = 1, .constant = true}};
    results_spec spec = {
        .count = 3, .field_count = 4, .field = fields, .scene_text = "", .plan_text = "", .version_text = "", .device_text = ""};
    results *r;
    failure why = {0};
    double position[] = {1, 2, 3, NAN, NAN, NAN, 4, 5, 6}, velocity[] = {7, 8, 9, NAN, NAN, NAN, 10, 11, 12};
    double spin[] = {-1, -2, -3, NAN, NAN, NAN, -4, -5, -6}, radius[] = {0.1, 0.2, 0.3};
    const void *value[] = {position, velocity, spin, radius};
    assert_int_equal(results_create(path, &spec, &r, &why), STATUS_OK);
    assert_int_equal(results_frame(r, 0, 0.0, value, NULL, &why), STATUS_OK);
    position[0] = 1.5;
    assert_int_equal(results_frame(r, 10, 1.0, value, NULL, &why), STATUS_OK);
    assert_int_equal(results_close(r, &why), STATUS_OK);
}

static void a_frame_of_a_result_goes_on(void **state)
{
    (void)state;
    char folder[] = "/tmp/clast_bed_XXXXXX", path[64], xdmf[64];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/run.h5", folder);
    snprintf(xdmf, sizeof xdmf, "%s/run.xdmf", folder);
    write_result(path);
    particle_group g;
    scene s = case_scene(&g, 3);
    g.generator = GENERATOR_RESULT;
    g.path = path;
    g.frame = -1;
    g.material = 2;
    g.temperature_k = 350;
    bed b = case_generate(&s);
    assert_int_equal(b.count, 2); /* the deleted one is left out */
    assert_true(b.position[0][0] == 1.5 && b.position[1][2] == 6 && b.velocity[1][0] == 10 && b.spin[0][2] == -3);
    assert_true(b.radius[0] == 0.1 && b.radius[1] == 0.3 && b.temperature[1] == 350);
    assert_int_equal(b.material[1], 2);
    bed_free(&b);
    g.frame = 0;
    b = case_generate(&s);
    assert_true(b.position[0][0] == 1);
    bed_free(&b);
    g.frame = 7;
    REFUSED(&s, "run.h5");
    unlink(path);
    REFUSED(&s, "run.h5");
    unlink(xdmf);
    rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(list_takes_items_as_they_are),
                                       cmocka_unit_test(groups_follow_each_other),
                                       cmocka_unit_test(lattices_are_what_they_are_called),
                                       cmocka_unit_test(triangular_rows),
                                       cmocka_unit_test(bad_lattices),
                                       cmocka_unit_test(shared_checks),
                                       cmocka_unit_test(a_frame_of_a_result_goes_on)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
