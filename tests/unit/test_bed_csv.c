/* Tables of particles: what is read, and the message for each way in which one can be bad. */
#include "unit/bed_case.h"

#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

typedef struct folder {
    char path[32], file[64];
} folder;

static int make_folder(void **state)
{
    folder *f = calloc(1, sizeof *f);
    strcpy(f->path, "/tmp/clast_csv_XXXXXX");
    if (!mkdtemp(f->path))
        return -1;
    snprintf(f->file, sizeof f->file, "%s/grains.csv", f->path);
    *state = f;
    return 0;
}

static int remove_folder(void **state)
{
    folder *f = *state;
    unlink(f->file);
    rmdir(f->path);
    free(f);
    return 0;
}

static void write_file(const char *path, const char *bytes, size_t length)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, length, file), length);
    assert_int_equal(fclose(file), 0);
}

static scene csv_case(particle_group *g, char *path)
{
    scene s = case_scene(g, 3);
    g->generator = GENERATOR_CSV;
    g->path = path;
    return s;
}

static void columns_by_name(void **state)
{
    folder *f = *state;
    particle_group g;
    scene s = csv_case(&g, f->file);
    const char text[] = "\xef\xbb\xbf# from the lab\r\n\r\n radius_m , z_m,x_m,y_m,vy_m_s,wz_rad_s,temperature_k\r\n"
                        "1e-3,3,1,2,0.5,9,350 # the first\r\n\n   \n2.0E-3, -3 ,\t-1,-2,-0.5,-9,0.5\r\n0.1,0,0,0,0,0,1";
    write_file(f->file, text, sizeof text - 1);
    g.velocity_m_s[0] = 7;
    g.velocity_m_s[1] = 8;
    g.material = 1;
    bed b = case_generate(&s);
    assert_int_equal(b.count, 3);
    assert_true(b.position[0][0] == 1 && b.position[0][1] == 2 && b.position[0][2] == 3 && b.radius[0] == 1.0e-3);
    assert_true(b.velocity[0][0] == 7 && b.velocity[0][1] == 0.5 && b.spin[0][2] == 9 && b.spin[0][0] == 0 && b.temperature[0] == 350);
    assert_true(b.position[1][0] == -1 && b.position[1][1] == -2 && b.position[1][2] == -3 && b.radius[1] == 2.0e-3);
    assert_true(b.velocity[1][1] == -0.5 && b.temperature[1] == 0.5 && b.temperature[2] == 1);
    assert_int_equal(b.material[2], 1);
    bed_free(&b);
}

static void radius_of_the_scene(void **state)
{
    folder *f = *state;
    particle_group g;
    scene s = csv_case(&g, f->file);
    const char text[] = "x_m,y_m,z_m\n1,2,3\n4,5,6\n";
    write_file(f->file, text, sizeof text - 1);
    REFUSED(&s, "grains.csv:1: column `radius_m` is missing", "the group gives no radius_m");
    g.radius_m.value = 0.25;
    g.temperature_k = 310;
    bed b = case_generate(&s);
    assert_true(b.count == 2 && b.radius[0] == 0.25 && b.radius[1] == 0.25 && b.temperature[1] == 310);
    bed_free(&b);
}

static void bad_tables(void **state)
{
    folder *f = *state;
    particle_group g;
    scene s = csv_case(&g, f->file);
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"", "grains.csv: the file is empty"},
        {"\n# nothing\n", "grains.csv: the file is empty"},
        {"x_m,y_m,z_m,radius_m\n", "grains.csv: the table has no rows"},
        {"x_m,y_m,z_m,radius_m,colour\n0,0,0,1,2\n", "grains.csv:1:22: column `colour` is unknown; known are x_m, y_m"},
        {"x_m;y_m;z_m;radius_m\n0;0;0;1\n", "grains.csv:1:1: column `x_m;y_m;z_m;radius_m` is unknown"},
        {"0,0,0,1\n", "grains.csv:1:1: column `0` is unknown"},
        {"x_m,y_m,x_m,z_m,radius_m\n", "grains.csv:1:9: column `x_m` appears twice"},
        {"# a\nx_m,z_m,radius_m\n0,0,1\n", "grains.csv:2: column `y_m` is missing"},
        {"x_m,y_m,z_m,radius_m\n0,0,0,1\n\n# c\n0,0,0\n", "grains.csv:5: the row has 3 columns, the header 4"},
        {"x_m,y_m,z_m,radius_m\n0,0,0,1,\n", "grains.csv:2: the row has 5 columns, the header 4"},
        {"x_m,y_m,z_m,radius_m\n0,,0,1\n", "grains.csv:2:3: y_m is ``, which is not a number"},
        {"x_m,y_m,z_m,radius_m\n0,0,0,1 mm\n", "grains.csv:2:7: radius_m is `1 mm`, which is not a number"},
        {"x_m,y_m,z_m,radius_m\n0,0,0,1\n0,nan,0,1\n", "grains.csv:3:3: y_m is `nan`; it must be finite"},
        {"x_m,y_m,z_m,radius_m\n0,0,1e999,1\n", "grains.csv:2:5: z_m is `1e999`; it must be finite"},
        {"x_m,y_m,z_m,radius_m\n0,0,0,0\n", "grains.csv:2:7: radius_m is `0`; it must be above 0"},
        {"x_m,y_m,z_m,radius_m\n0,0,0,-1\n", "grains.csv:2:7: radius_m is `-1`; it must be above 0"},
        {"x_m,y_m,z_m,radius_m,temperature_k\n0,0,0,1,-5\n", "grains.csv:2:9: temperature_k is `-5`; it must be above 0"},
    };
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        write_file(f->file, cases[n].text, strlen(cases[n].text));
        REFUSED(&s, cases[n].message);
    }
}

static void files_that_are_no_tables(void **state)
{
    folder *f = *state;
    particle_group g;
    scene s = csv_case(&g, f->file);
    unlink(f->file);
    REFUSED(&s, "scene.yaml:12:5: particles[bed]: cannot read", "grains.csv: No such file or directory");
    g.path = f->path;
    REFUSED(&s, "cannot read", "it is a directory");
    g.path = NULL;
    REFUSED(&s, "needs a path");
    g.path = f->file;
    write_file(f->file, "x_m,y_m,z_m,radius_m\n0,0\0,0,1\n", 30);
    REFUSED(&s, "grains.csv:2: byte 4 is 0x00; this is not a text file");
    size_t length = 1 << 20;
    char *bytes = malloc(length);
    memset(bytes, '7', length);
    write_file(f->file, bytes, length);
    REFUSED(&s, "grains.csv:1: the line is longer than 65535 bytes");
    /* Garbage of any kind is refused, whatever the message. */
    uint32_t x = 1;
    for (int trial = 0; trial < 200; trial++) {
        for (size_t n = 0; n < 4096; n++) {
            x = x * 1664525u + 1013904223u;
            bytes[n] = trial % 2 ? (char)(x >> 24) : "0123456789.,-+e#\n\r xym_radius"[(x >> 16) % 29];
        }
        write_file(f->file, bytes, 4096);
        REFUSED(&s, "grains.csv");
    }
    free(bytes);
}

static void a_million_rows(void **state)
{
    folder *f = *state;
    particle_group g;
    scene s = csv_case(&g, f->file);
    FILE *file = fopen(f->file, "w");
    assert_non_null(file);
    fprintf(file, "x_m,y_m,z_m,radius_m,vx_m_s,vy_m_s,vz_m_s\n");
    for (int i = 0; i < 1000000; i++)
        fprintf(file, "%.17g,%.17g,%.17g,0.001,0.1,0.2,0.3\n", i / 3.0, i / 7.0, i / 11.0);
    fclose(file);
    struct timespec start, end;
    clock_gettime(CLOCK_MONOTONIC, &start);
    bed b = case_generate(&s);
    clock_gettime(CLOCK_MONOTONIC, &end);
    print_message("1,000,000 rows: %.2f s\n", (double)(end.tv_sec - start.tv_sec) + 1.0e-9 * (double)(end.tv_nsec - start.tv_nsec));
    assert_int_equal(b.count, 1000000);
    for (int i = 0; i < 1000000; i += 12345)
        assert_true(b.position[i][0] == i / 3.0 && b.position[i][1] == i / 7.0 && b.position[i][2] == i / 11.0);
    bed_free(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(columns_by_name), cmocka_unit_test(radius_of_the_scene),
                                       cmocka_unit_test(bad_tables), cmocka_unit_test(files_that_are_no_tables),
                                       cmocka_unit_test(a_million_rows)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
