/* Random beds: nothing overlaps, exactly; everything is where it should be; the same bed everywhere. */
#include "unit/bed_case.h"

#include <time.h>

/* A cube (square) that `count` grains of radius 1 mm +-`spread` fill to `fraction` on average. */
static scene random_case(particle_group *g, int dimensions, int64_t count, double fraction, double spread)
{
    scene s = case_scene(g, dimensions);
    double a = 1.0e-3 * (1.0 - spread), b = 1.0e-3 * (1.0 + spread);
    double side = dimensions == 2 ? sqrt((double)count * mean_area_uniform(a, b) / fraction)
                                  : cbrt((double)count * mean_volume_uniform(a, b) / fraction);
    g->generator = GENERATOR_RANDOM;
    g->count = count;
    g->radius_m = radius_uniform(a, b);
    g->region_given = true;
    for (int d = 0; d < dimensions; d++) {
        g->region_low_m[d] = -0.25 * side;
        g->region_high_m[d] = 0.75 * side;
    }
    return s;
}

/* Every face of the region that is a face of a periodic direction is left out. */
static void assert_inside(const bed *b, const scene *s, const particle_group *g, int64_t first)
{
    for (int64_t i = first; i < b->count; i++)
        for (int d = 0; d < s->dimensions; d++) {
            bool open = s->domain.given && s->domain.periodic[d];
            double keep = open ? 0.0 : b->radius[i];
            assert_true(b->position[i][d] - keep >= g->region_low_m[d] && b->position[i][d] + keep <= g->region_high_m[d]);
        }
}

static double fraction_of(const bed *b, const particle_group *g, int dimensions)
{
    double grains = 0.0, region = 1.0;
    for (int64_t i = 0; i < b->count; i++)
        grains += dimensions == 2 ? PI * pow(b->radius[i], 2) : 4.0 / 3.0 * PI * pow(b->radius[i], 3);
    for (int d = 0; d < dimensions; d++)
        region *= g->region_high_m[d] - g->region_low_m[d];
    return grains / region;
}

static void nothing_overlaps(void **state)
{
    (void)state;
    struct {
        int dimensions;
        int64_t count;
        double fraction, spread;
        bool periodic;
    } cases[] = {{3, 1, 0.1, 0, false},       {3, 2, 0.05, 0.1, true},    {3, 2000, 0.05, 0.5, false}, {3, 2000, 0.3, 0.1, false},
                 {3, 3000, 0.55, 0.1, false}, {3, 3000, 0.55, 0, true},   {3, 3000, 0.55, 0.9, false}, {3, 300, 0.5, 0.1, true},
                 {2, 2000, 0.4, 0.1, false},  {2, 2000, 0.75, 0.1, true}, {2, 2000, 0.72, 0.5, false}};
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        particle_group g;
        scene s = random_case(&g, cases[n].dimensions, cases[n].count, cases[n].fraction, cases[n].spread);
        if (cases[n].periodic) {
            s.domain.given = true;
            for (int d = 0; d < 3; d++) {
                s.domain.low_m[d] = g.region_low_m[d];
                s.domain.high_m[d] = g.region_high_m[d];
                s.domain.periodic[d] = d < cases[n].dimensions;
            }
        }
        bed b = case_generate(&s);
        assert_int_equal(b.count, cases[n].count);
        assert_true(brute_force_overlap(&b, &s.domain) == 0.0);
        assert_true(bed_largest_overlap(&b, &s.domain, NULL, NULL) == 0.0);
        assert_inside(&b, &s, &g, 0);
        /* The sum of the volumes scatters about its mean: at most 100 % of one grain's each. */
        double scatter = cases[n].fraction * 5.0 * cases[n].spread * 1.8 / sqrt((double)cases[n].count);
        assert_true(fabs(fraction_of(&b, &g, cases[n].dimensions) - cases[n].fraction) <= scatter + 1.0e-12);
        if (cases[n].dimensions == 2)
            assert_true(b.low[2] == 0.0 && b.high[2] == 0.0);
        bed_free(&b);
    }
}

/* Where chance alone decides, centres are spread evenly over what the faces leave: mean and variance in each direction. */
static void sparse_beds_are_uniform(void **state)
{
    (void)state;
    particle_group g;
    scene s = random_case(&g, 3, 20000, 0.001, 0);
    bed b = case_generate(&s);
    for (int d = 0; d < 3; d++) {
        double low = g.region_low_m[d] + 1.0e-3, high = g.region_high_m[d] - 1.0e-3, mean = 0.0, square = 0.0;
        for (int64_t i = 0; i < b.count; i++) {
            double x = (b.position[i][d] - low) / (high - low);
            mean += x / (double)b.count;
            square += x * x / (double)b.count;
        }
        assert_true(fabs(mean - 0.5) < 5.0 * sqrt(1.0 / 12.0 / (double)b.count));
        assert_true(fabs(square - 1.0 / 3.0) < 5.0 * sqrt((1.0 / 5.0 - 1.0 / 9.0) / (double)b.count));
    }
    bed_free(&b);
}

static bool same_places(const bed *a, const bed *b, int64_t first)
{
    return memcmp(a->position + first, b->position + first, (size_t)(a->count - first) * sizeof *a->position) == 0 &&
           memcmp(a->radius + first, b->radius + first, (size_t)(a->count - first) * sizeof *a->radius) == 0;
}

static void the_seed_makes_the_bed(void **state)
{
    (void)state;
    particle_group g;
    scene s = random_case(&g, 3, 1000, 0.54, 0.1);
    bed a = case_generate(&s), again = case_generate(&s);
    assert_true(same_places(&a, &again, 0));
    s.seed = 2;
    bed other = case_generate(&s);
    assert_false(same_places(&a, &other, 0));
    assert_true(a.radius[0] != other.radius[0]);
    bed_free(&a);
    bed_free(&again);
    bed_free(&other);
}

/* A group that is elsewhere changes nothing. */
static void groups_elsewhere_do_not_matter(void **state)
{
    (void)state;
    particle_group g[2];
    particle_item item = {.position_m = {10, 10, 10}, .radius_m = 0.1, .temperature_k = NAN};
    scene s = random_case(&g[1], 3, 1000, 0.54, 0.1);
    s.group = g;
    s.group_count = 2;
    g[0] = (particle_group){.name = "far", .generator = GENERATOR_LIST, .item = &item, .item_count = 1, .temperature_k = NAN};
    bed a = case_generate(&s);
    item.position_m[0] = -20;
    bed b = case_generate(&s);
    assert_true(same_places(&a, &b, 1));
    bed_free(&a);
    bed_free(&b);
}

/* Earlier grains inside the region, large and small, and one that reaches in across a periodic face, stay where they are and are kept clear of. */
static void earlier_groups_are_obstacles(void **state)
{
    (void)state;
    particle_group g[2];
    scene s = random_case(&g[1], 3, 1500, 0.5, 0.1);
    double side = g[1].region_high_m[0] - g[1].region_low_m[0];
    particle_item items[] = {{.radius_m = 0.2 * side, .temperature_k = NAN},
                             {.position_m = {0.5 * side, 0.5 * side, 0.5 * side}, .radius_m = 1.0e-4, .temperature_k = NAN},
                             {.position_m = {side - 1.0e-6, 0.4 * side, 0}, .radius_m = 3.0e-3, .temperature_k = NAN}};
    g[0] = (particle_group){.name = "stones", .generator = GENERATOR_LIST, .item = items, .item_count = 3, .temperature_k = NAN};
    g[1].count = 1200;
    s.group = g;
    s.group_count = 2;
    s.domain = (domain){
        .given = true, .low_m = {-0.25 * side, -side, -side}, .high_m = {side, side, side}, .periodic = {true, false, false}};
    bed b = case_generate(&s);
    assert_int_equal(b.count, 1203);
    assert_true(b.position[0][0] == 0.0 && b.radius[2] == 3.0e-3);
    assert_true(brute_force_overlap(&b, &s.domain) == 0.0);
    assert_inside(&b, &s, &g[1], 3);
    bed_free(&b);
}

/* A region that is only part of a periodic direction has hard faces there. */
static void a_part_of_a_period_has_faces(void **state)
{
    (void)state;
    particle_group g;
    scene s = random_case(&g, 3, 1000, 0.5, 0.1);
    s.domain = (domain){.given = true, .low_m = {-1, -1, -1}, .high_m = {1, 1, 1}, .periodic = {true, true, true}};
    bed b = case_generate(&s);
    s.domain.given = false; /* for the check: no face is open */
    assert_inside(&b, &s, &g, 0);
    assert_true(brute_force_overlap(&b, &s.domain) == 0.0);
    bed_free(&b);
}

/* Grains from 1 to 50 in radius with the same mass in each class. */
static void sizes_of_one_to_fifty(void **state)
{
    (void)state;
    double size[] = {1.0e-3, 4.0e-3, 20.0e-3, 50.0e-3}, fraction[] = {0.3, 0.3, 0.4};
    particle_group g;
    scene s = random_case(&g, 3, 20000, 0.5, 0);
    g.radius_m = (radius_spec){.distribution = RADIUS_SIEVE, .count = 3, .size_m = size, .mass_fraction = fraction};
    double per_volume = 0.0; /* grains: of each class, its mass over the mean of r^3, 2 a^2 b^2/(a + b) */
    for (int k = 0; k < 3; k++)
        per_volume += fraction[k] * (size[k] + size[k + 1]) / (2.0 * pow(size[k] * size[k + 1], 2)) / (4.0 / 3.0 * PI);
    for (int d = 0; d < 3; d++)
        g.region_high_m[d] = g.region_low_m[d] + cbrt((double)g.count / per_volume / 0.5);
    bed b = case_generate(&s);
    double small = INFINITY, large = 0.0;
    for (int64_t i = 0; i < b.count; i++) {
        small = fmin(small, b.radius[i]);
        large = fmax(large, b.radius[i]);
    }
    assert_true(large / small > 20.0);
    print_message("volume fraction %.3f, radii 1 to %.1f\n", fraction_of(&b, &g, 3), large / small);
    assert_true(fraction_of(&b, &g, 3) > 0.3); /* the few largest hold much of the volume: it scatters */
    assert_true(bed_largest_overlap(&b, &s.domain, NULL, NULL) == 0.0);
    assert_true(brute_force_overlap(&b, &s.domain) == 0.0);
    bed_free(&b);
}

static void what_cannot_be_reached_is_refused(void **state)
{
    (void)state;
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        particle_group g;
        scene s = random_case(&g, dimensions, 1000, dimensions == 2 ? 0.9 : 0.75, 0);
        REFUSED(&s, "scene.yaml:12:5: particles[bed]: 1000 particles",
                dimensions == 2 ? "an area fraction of 0.900" : "a volume fraction of 0.750", "ask for at most");
    }
    particle_group g;
    scene s = random_case(&g, 3, 1000, 5.0, 0);
    REFUSED(&s, "a volume fraction of 5.000", "ask for at most", "or a region of at least");
    g.radius_m.low = g.radius_m.high = 1.0;
    REFUSED(&s, "particle 0 of radius 1 m does not fit", "wide along x");
    g.region_high_m[1] = g.region_low_m[1];
    REFUSED(&s, "along y", "low must be below high");
    g.region_given = false;
    REFUSED(&s, "needs a region");
    g.count = 0;
    g.region_given = true;
    g.region_high_m[1] = 1.0;
    REFUSED(&s, "the group has 0 particles");
}

/* In a narrow box chance reaches less than in a wide one; what the message advises must work, count and region both. */
static void the_advice_holds(void **state)
{
    (void)state;
    particle_group g;
    scene s = random_case(&g, 3, 30, 0.6, 0);
    bed b;
    failure why;
    assert_int_equal(bed_generate(&s, &b, &why), STATUS_BAD_INPUT);
    const char *count = strstr(why.text, "at most "), *region = strstr(why.text, "at least ");
    assert_non_null(count);
    assert_non_null(region);
    double volume = strtod(region + strlen("at least "), NULL);
    g.count = strtol(count + strlen("at most "), NULL, 10);
    assert_in_range(g.count, 10, 29);
    b = case_generate(&s);
    bed_free(&b);
    g.count = 30;
    for (int d = 0; d < 3; d++)
        g.region_high_m[d] = g.region_low_m[d] + cbrt(volume);
    b = case_generate(&s);
    bed_free(&b);
}

static void a_hundred_thousand_at_the_limit(void **state)
{
    (void)state;
    particle_group g;
    scene s = random_case(&g, 3, 100000, 0.55, 0.1);
    struct timespec start, end;
    clock_gettime(CLOCK_MONOTONIC, &start);
    bed b = case_generate(&s);
    clock_gettime(CLOCK_MONOTONIC, &end);
    print_message("100,000 grains at a volume fraction of %.4f: %.2f s\n", fraction_of(&b, &g, 3),
                  (double)(end.tv_sec - start.tv_sec) + 1.0e-9 * (double)(end.tv_nsec - start.tv_nsec));
    assert_true(bed_largest_overlap(&b, &s.domain, NULL, NULL) == 0.0);
    assert_inside(&b, &s, &g, 0);
    bed_free(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_overlaps),
        cmocka_unit_test(sparse_beds_are_uniform),
        cmocka_unit_test(the_seed_makes_the_bed),
        cmocka_unit_test(groups_elsewhere_do_not_matter),
        cmocka_unit_test(earlier_groups_are_obstacles),
        cmocka_unit_test(a_part_of_a_period_has_faces),
        cmocka_unit_test(sizes_of_one_to_fifty),
        cmocka_unit_test(what_cannot_be_reached_is_refused),
        cmocka_unit_test(the_advice_holds),
        cmocka_unit_test(a_hundred_thousand_at_the_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
