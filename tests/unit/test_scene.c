/* The scene reader: what it accepts, and what it makes of it. */
#include "scene_case.h"

static void test_full_example(void **state)
{
    (void)state;
    scene *s = read_good(full);
    assert_string_equal(s->title, "Heated layer");
    assert_int_equal(s->dimensions, 3);
    assert_int_equal(s->seed, 1);
    assert_true(s->gravity_m_s2[2] == -9.81);
    assert_true(s->domain.given && s->domain.periodic[0] && s->domain.periodic[1] && !s->domain.periodic[2] && !s->domain.delete_leaving);
    assert_true(s->domain.high_m[2] == 0.2);
    assert_int_equal(s->effect_count, 3);
    assert_string_equal(scene_effect(s, -1, SLOT_TANGENTIAL)->law->name, "mindlin");
    assert_non_null(scene_effect(s, 0, SLOT_ROLLING));
    assert_null(scene_effect(s, 1, SLOT_ROLLING));
    assert_true(scene_material(s, 0, &property_youngs_modulus) == 2.0e11);
    assert_int_equal(s->group_count, 3);
    const particle_group *bed = &s->group[0], *pair = &s->group[1], *rows = &s->group[2];
    assert_int_equal(bed->count, 10000);
    assert_int_equal(bed->radius_m.distribution, RADIUS_NORMAL);
    assert_true(bed->radius_m.std == 1.0e-4 && bed->radius_m.truncate_sigmas == 3.0 && bed->region_given && bed->region_high_m[2] == 0.2);
    assert_true(bed->temperature_k == 300.0 && !bed->fixed && bed->motion.count == 0);
    assert_int_equal(pair->count, 1);
    assert_true(pair->item[0].velocity_m_s[0] == 1.0 && pair->item[0].radius_m == 1.0e-3 && isnan(rows->temperature_k));
    assert_int_equal(rows->lattice, LATTICE_TRIANGULAR);
    assert_true(rows->counts[0] == 200 && rows->counts[1] == 1 && rows->counts[2] == 9 && rows->spacing_m == 1.5e-3);
    assert_int_equal(s->wall_count, 3);
    assert_int_equal(s->wall[0].motion.count, 1);
    assert_int_equal(s->wall[0].motion.term[0].type, MOTION_SINUSOID);
    assert_true(s->wall[0].motion.term[0].frequency_hz == 10.0);
    assert_true(s->wall[1].open[5] && !s->wall[1].open[4]);
    assert_true(s->wall[2].corners_m[2][1] == 1.0);
    assert_true(s->stage[0].until_rest == 1.0e-9 && isnan(s->stage[0].step_s) && isnan(s->stage[0].until_time_s));
    assert_int_equal(s->stage[0].until_steps, -1);
    assert_true(s->stage[1].step_s == 5.0e-6 && s->stage[1].gravity_given && s->stage[1].wall_change[0].wall == 1);
    assert_false(s->stage[1].wall_change[0].motion_given);
    assert_true(s->output.every_s == 0.01 && s->output.observables_every_s == 0.001 && s->output.checkpoint_every_s == 0.5);
    assert_true(isnan(s->table.skin_m) && s->table.batch_steps == 0);
    assert_int_equal(s->study.answer_count, 2);
    assert_string_equal(s->study.answers[1], "particles[pair].items[0].velocity");
    assert_string_equal(s->path, "dir/scene.yaml");
    assert_int_equal(s->material[0].at.line, 13);
    assert_int_equal(s->material[0].at.column, 5);
    scene_free(s);
}

static void test_defaults(void **state)
{
    (void)state;
    scene *s = read_good("materials: [{name: m, density_kg_m3: 1}]\nparticles: []\nstages: [{until: {steps: 1e6}}]\n");
    assert_string_equal(s->title, "");
    assert_true(s->dimensions == 3 && s->seed == 1 && s->gravity_m_s2[2] == 0.0 && !s->domain.given);
    assert_true(s->precision == PRECISION_AUTO && s->integrator == INTEGRATOR_SEMI_IMPLICIT_EULER);
    assert_true(s->guards.every_steps == 100 && s->guards.overlap_max == 0.3 && s->guards.move_max == 0.5);
    assert_true(isnan(s->output.every_s) && isnan(s->output.observables_every_s) && isnan(s->output.checkpoint_every_s));
    assert_int_equal(s->output.field_count, 2);
    assert_string_equal(s->output.fields[1], "velocity");
    assert_int_equal(s->output.observable_count, 1);
    assert_string_equal(s->output.observables[0], "kinetic_energy");
    assert_string_equal(s->stage[0].name, "stage1");
    assert_int_equal(s->stage[0].until_steps, 1000000);
    assert_false(s->stage[0].allow_unstable_step);
    scene_free(s);
    s = read_good(base);
    assert_int_equal(s->output.field_count, 3); /* friction makes particles spin */
    assert_string_equal(s->output.fields[2], "spin");
    assert_true(s->wall[0].normal[2] == 1.0); /* normalised */
    assert_true(s->effect[1].option[0] == 0.0);
    assert_string_equal(s->stage[1].name, "stage2");
    scene_free(s);
}

static void test_generators_and_motion(void **state)
{
    (void)state;
    scene *s = read_replaced(base, "generator: random, count: 10, radius_m: 1.0e-3, region: {low_m: [0, 0, 0], high_m: [1, 1, 1]}",
                             "generator: csv, file: grains.csv, motion: fixed");
    assert_string_equal(s->group[1].path, "dir/grains.csv");
    assert_true(s->group[1].fixed);
    scene_free(s);
    s = read_replaced(
        base, "generator: random, count: 10, radius_m: 1.0e-3, region: {low_m: [0, 0, 0], high_m: [1, 1, 1]}",
        "generator: result, file: /tmp/a.h5, frame: 3, motion: [{type: rotation, point_m: [0, 0, 0], axis: [0, 3, 4], rate_rad_s: 2}, "
        "{type: table, time_s: [0, 1], velocity_m_s: [[0, 0, 0], [1, 2, 3]]}]");
    const particle_group *group = &s->group[1];
    assert_string_equal(group->path, "/tmp/a.h5");
    assert_int_equal(group->frame, 3);
    assert_int_equal(group->motion.count, 2);
    assert_true(fabs(group->motion.term[0].axis[2] - 0.8) < 1e-15);
    assert_true(group->motion.term[1].count == 2 && group->motion.term[1].table_velocity_m_s[1][2] == 3.0);
    scene_free(s);
    s = read_replaced(base, "radius_m: 1.0e-3, region",
                      "radius_m: {distribution: sieve, size_m: [1, 2, 3], mass_fraction: [0.25, 0.75]}, region");
    assert_int_equal(s->group[1].radius_m.distribution, RADIUS_SIEVE);
    assert_int_equal(s->group[1].radius_m.count, 2);
    assert_true(s->group[1].radius_m.size_m[2] == 3.0 && s->group[1].radius_m.mass_fraction[1] == 0.75);
    scene_free(s);
    s = read_replaced(base, "items: [", "velocity_m_s: [1, 2, 3], items: [{position_m: [1, 0, 0], radius_m: 1, velocity_m_s: [0, 0, 0]}, ");
    assert_true(s->group[0].item[0].velocity_m_s[1] == 0.0 && s->group[0].item[1].velocity_m_s[1] == 2.0);
    scene_free(s);
    s = read_replaced(base, ", region: {low_m: [0, 0, 0], high_m: [1, 1, 1]}", ""); /* the domain is there */
    assert_false(s->group[1].region_given);
    scene_free(s);
}

static void test_two_dimensions(void **state)
{
    (void)state;
    scene *s = read_good(flat);
    assert_true(s->wall[1].open[4] && s->wall[1].open[5] && !s->wall[1].open[0]);
    scene_free(s);
}

/* Pair before default, key by key; of two ways to say one thing the closer one; then the fallback property. */
static void test_resolution(void **state)
{
    (void)state;
    scene *s = read_good(full);
    const int box = 1, floor_wall = 0, none = -1;
    assert_true(scene_interaction(s, -1, 0, 0, none, &property_restitution) == 0.5);
    assert_true(isnan(scene_interaction(s, -1, 0, 0, none, &property_normal_damping)));
    assert_true(scene_interaction(s, -1, 0, none, floor_wall, &property_normal_damping) == 0.2);
    assert_true(isnan(scene_interaction(s, -1, 0, none, floor_wall, &property_restitution)));
    assert_true(scene_interaction(s, -1, 0, none, floor_wall, &property_rolling_damping) == 0.1);
    assert_true(scene_interaction(s, -1, 0, none, floor_wall, &property_rolling_friction) == 0.01);
    assert_true(scene_interaction(s, -1, 0, none, floor_wall, &property_friction_static) == 0.3);
    assert_true(scene_interaction(s, -1, 0, none, floor_wall, &property_friction_dynamic) == 0.3);
    assert_false(scene_interaction_given(s, -1, 0, none, floor_wall, &property_friction_dynamic));
    assert_true(scene_interaction_given(s, -1, 0, 0, none, &property_friction_dynamic));
    assert_true(scene_interaction(s, 0, 0, none, box, &property_friction_static) == 0.5);
    assert_true(scene_interaction(s, 1, 0, none, box, &property_friction_static) == 0.1);
    assert_true(scene_interaction(s, 1, 0, none, box, &property_friction_dynamic) == 0.1);
    assert_true(scene_interaction(s, 1, 0, none, floor_wall, &property_friction_static) == 0.3);
    scene_free(s);

    s = read_good(base);
    assert_true(scene_interaction(s, -1, 1, 0, none, &property_friction_static) == 0.2); /* in either order */
    assert_true(scene_interaction(s, -1, 1, 0, none, &property_friction_dynamic) == 0.2);
    assert_true(scene_interaction(s, -1, 0, 0, none, &property_friction_static) == 0.5);
    assert_true(scene_interaction(s, 1, 0, 0, none, &property_friction_static) == 0.1);
    assert_true(scene_interaction(s, 1, 0, 0, none, &property_friction_dynamic) == 0.1);
    assert_true(scene_interaction(s, 1, 1, 0, none, &property_friction_static) == 0.2); /* the pair's own stays closer */
    assert_true(isnan(scene_interaction(s, -1, 0, 0, none, &property_tangential_damping)));
    scene_free(s);

    s = read_replaced(base, "restitution: 0.5,", "normal_damping_ratio: 0.4,");
    assert_true(scene_interaction(s, -1, 0, 0, none, &property_tangential_damping) == 0.4);
    assert_false(scene_interaction_given(s, -1, 0, 0, none, &property_tangential_damping));
    scene_free(s);
    s = read_replaced(base, "[glass, steel], ", "[glass, steel], normal_damping_ratio: 0.7, ");
    assert_true(isnan(scene_interaction(s, -1, 0, 1, none, &property_restitution)));
    assert_true(scene_interaction(s, -1, 0, 1, none, &property_normal_damping) == 0.7);
    scene_free(s);
}

/* What a stage changes stays so in the stages after it. */
static void test_changes_last(void **state)
{
    (void)state;
    scene *s = read_replaced(
        base, "output:",
        "  - {name: third, until: {steps: 1}, change: {gravity_m_s2: [1, 0, 0], particles: [{name: one, motion: fixed}], "
        "walls: [{name: floor, motion: [], friction_static: 0.9}]}}\n"
        "  - {name: last, until: {steps: 1}, change: {interactions: [{between: [steel, floor], friction_static: 0.8}]}}\n"
        "output:");
    double g[3];
    scene_gravity(s, 1, g);
    assert_true(g[2] == -9.81);
    scene_gravity(s, 3, g);
    assert_true(g[0] == 1.0 && g[2] == 0.0);
    assert_true(s->stage[2].group_change[0].group == 0 && s->stage[2].group_change[0].fixed && !s->stage[2].group_change[0].free);
    assert_true(s->stage[2].wall_change[0].motion_given && s->stage[2].wall_change[0].motion.count == 0);
    assert_true(scene_interaction(s, 1, 1, -1, 0, &property_friction_static) == 0.1);
    assert_true(scene_interaction(s, 2, 1, -1, 0, &property_friction_static) == 0.9);
    assert_true(scene_interaction(s, 3, 1, -1, 0, &property_friction_static) == 0.8);
    assert_true(scene_interaction(s, 3, 0, -1, 0, &property_friction_static) == 0.9);
    assert_true(scene_interaction(s, 3, 0, -1, 1, &property_friction_static) == 0.1);
    scene_free(s);
}

static void test_files(void **state)
{
    (void)state;
    scene *s = NULL;
    failure why;
    assert_int_equal(scene_read("/nonexistent/scene.yaml", 0, NULL, &s, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.text, "/nonexistent/scene.yaml: there is no such file");
    assert_int_equal(scene_read("/tmp", 0, NULL, &s, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.text, "/tmp: is a folder"));
    char path[] = "/tmp/clast_scene_XXXXXX";
    int handle = mkstemp(path);
    assert_true(handle >= 0);
    FILE *file = fdopen(handle, "w");
    assert_non_null(file);
    fputs(full, file);
    fclose(file);
    assert_int_equal(scene_read(path, 0, NULL, &s, &why), STATUS_OK);
    assert_int_equal(s->group_count, 3);
    scene_free(s);
    unlink(path);
}

static void test_set(void **state)
{
    (void)state;
    char *const sets[] = {"walls[floor].point_m=[0,0,1]",
                          "effects[tangential].shear_modulus=mindlin",
                          "particles[pair].items[0].velocity_m_s=[2,0,0]",
                          "stages[settle].until.time_s=1",
                          "seed=3",
                          "interactions[default].restitution=0.25",
                          "interactions[floor,steel].friction_static=0.7",
                          "walls[2].motion=[]",
                          "particles[bed].radius_m={distribution: uniform, low: 1e-3, high: 2e-3}",
                          "particles[bed].count=5",
                          "output.fields[1]=force",
                          "title=\"a: b\"",
                          "seed=4"};
    scene *s = read_good_with(full, (int)COUNT(sets), sets);
    assert_true(s->wall[0].point_m[2] == 1.0);
    assert_true(s->effect[1].option[0] == 1.0);
    assert_true(s->group[1].item[0].velocity_m_s[0] == 2.0);
    assert_true(s->stage[0].until_time_s == 1.0 && s->stage[0].until_rest == 1.0e-9);
    assert_int_equal(s->seed, 4);
    assert_true(scene_interaction(s, -1, 0, 0, -1, &property_restitution) == 0.25);
    assert_true(scene_interaction(s, -1, 0, -1, 0, &property_friction_static) == 0.7);
    assert_true(s->group[0].radius_m.distribution == RADIUS_UNIFORM && s->group[0].count == 5);
    assert_string_equal(s->output.fields[1], "force");
    assert_string_equal(s->title, "a: b");
    scene_free(s);
    char *const created[] = {"guards.every_steps=0", "study.answers=[momentum]", "stages[stage2].step_s=1e-6"};
    s = read_good_with(base, (int)COUNT(created), created);
    assert_int_equal(s->guards.every_steps, 0);
    assert_true(s->guards.overlap_max == 0.3 && s->stage[1].step_s == 1e-6);
    assert_string_equal(s->study.answers[0], "momentum");
    scene_free(s);
}

/* What is kept with a result reads back to the same scene, settings included. */
static void test_text_round_trip(void **state)
{
    (void)state;
    static const char *const texts[] = {full, base, flat};
    char *const sets[] = {"seed=7", "title='5 \"quoted\": # text'"};
    for (size_t k = 0; k < COUNT(texts); k++) {
        scene *first = read_good_with(texts[k], 2, sets);
        scene *second = read_good(first->text);
        assert_int_equal(second->seed, 7);
        assert_string_equal(second->title, "5 \"quoted\": # text");
        assert_string_equal(second->text, first->text);
        assert_int_equal(second->group_count, first->group_count);
        assert_memory_equal(second->gravity_m_s2, first->gravity_m_s2, sizeof first->gravity_m_s2);
        assert_memory_equal(&second->domain, &first->domain, offsetof(domain, periodic));
        for (int w = 0; w < first->wall_count; w++) {
            assert_memory_equal(second->wall[w].normal, first->wall[w].normal, sizeof first->wall[w].normal);
            assert_memory_equal(second->wall[w].corners_m, first->wall[w].corners_m, sizeof first->wall[w].corners_m);
        }
        scene_free(first);
        scene_free(second);
    }
    scene *s = read_good("title: \"12\"\nmaterials: []\nparticles: []\nstages: [{until: {steps: 1}}]\n");
    assert_non_null(strstr(s->text, "title: \"12\"")); /* a text stays a text */
    scene_free(s);
}

static void test_reference(void **state)
{
    (void)state;
    char *page = scene_reference();
    static const char *const expected[] = {"`dimensions`",
                                           "`shear_modulus`",
                                           "rolling: `constant_torque`",
                                           "`youngs_modulus_pa` | number, above 0",
                                           "J/(kg K)",
                                           "`truncate_sigmas`",
                                           "| `every_steps` | whole number",
                                           "`coordination_number`",
                                           "that of friction_static",
                                           "| `step_s` | number, above 0, or `auto` | s | `auto`",
                                           "(generator `random`)"};
    for (size_t k = 0; k < COUNT(expected); k++)
        if (!strstr(page, expected[k]))
            fail_msg("the reference lacks: %s", expected[k]);
    for (const property *const *p = material_properties(); *p; p++)
        assert_non_null(strstr(page, (*p)->key));
    for (const property *const *p = interaction_properties(); *p; p++)
        assert_non_null(strstr(page, (*p)->key));
    for (const law *const *l = laws; *l; l++)
        assert_non_null(strstr(page, (*l)->doc));
    free(page);
}
int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_full_example),
        cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_generators_and_motion),
        cmocka_unit_test(test_two_dimensions),
        cmocka_unit_test(test_resolution),
        cmocka_unit_test(test_changes_last),
        cmocka_unit_test(test_files),
        cmocka_unit_test(test_set),
        cmocka_unit_test(test_text_round_trip),
        cmocka_unit_test(test_reference),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
