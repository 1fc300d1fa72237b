/* The scene reader: what it accepts, what it makes of it, and the message for what it refuses. */
#include "property.h"
#include "scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* cmocka has a macro called fail, so it comes after the headers that declare the function; and it wants this order. */
/* clang-format off */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
/* clang-format on */

/* clang-format off */
/* Every key of the interface that this version has. */
static const char full[] =
    "title: Heated layer\n"
    "dimensions: 3                # 2: motion in x and y (y is up), spin about z\n"
    "seed: 1\n"
    "gravity_m_s2: [0, 0, -9.81]\n"
    "precision: auto              # auto | double | mixed\n"
    "integrator: semi_implicit_euler   # | velocity_verlet\n"
    "domain: {low_m: [0, 0, 0], high_m: [0.1, 0.1, 0.2], periodic: [x, y], leaving: stop}\n"
    "effects:\n"
    "  - {slot: normal, law: hertz}                 # | linear\n"
    "  - {slot: tangential, law: mindlin, shear_modulus: printed, lever_arm: contact_point, unloading: printed}\n"
    "  - {slot: rolling, law: elastic_plastic}      # | constant_torque\n"
    "materials:\n"
    "  - {name: steel, density_kg_m3: 7800, youngs_modulus_pa: 2.0e11, poissons_ratio: 0.3, conductivity_w_mk: 60, specific_heat_j_kgk: 600}\n"
    "interactions:\n"
    "  - {between: default, restitution: 0.5, friction_static: 0.5, friction_dynamic: 0.5, rolling_friction: 0.01}\n"
    "  - {between: [steel, floor], normal_damping_ratio: 0.2, tangential_damping_ratio: 0.2, rolling_damping_ratio: 0.1, friction_static: 0.3}\n"
    "particles:\n"
    "  - name: bed\n"
    "    material: steel\n"
    "    generator: random        # list | lattice | random | csv | result\n"
    "    count: 10000\n"
    "    radius_m: {distribution: normal, mean: 1.0e-3, std: 1.0e-4, truncate_sigmas: 3}\n"
    "    region: {low_m: [0, 0, 0], high_m: [0.1, 0.1, 0.2]}\n"
    "    velocity_m_s: [0, 0, 0]\n"
    "    temperature_k: 300\n"
    "    motion: free             # free | fixed | a list as for walls\n"
    "  - {name: pair, material: steel, generator: list, items: [{position_m: [0, 0, 0], radius_m: 1.0e-3, velocity_m_s: [1, 0, 0], spin_rad_s: [0, 0, 0], temperature_k: 300}]}\n"
    "  - {name: rows, material: steel, generator: lattice, lattice: triangular, counts: [200, 1, 9], spacing_m: 1.5e-3, radius_m: 7.5e-4}\n"
    "walls:\n"
    "  - {name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1], motion: [{type: sinusoid, direction: [0, 0, 1], amplitude_m: 1.0e-3, frequency_hz: 10, phase_rad: 0}]}\n"
    "  - {name: box, shape: box, low_m: [0, 0, 0], high_m: [0.1, 0.1, 0.2], open: [z_high]}\n"
    "  - {name: hopper, shape: rectangle, corners_m: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}\n"
    "stages:\n"
    "  - {name: settle, until: {rest: 1.0e-9}, step_s: auto}\n"
    "  - {name: shake, until: {time_s: 2.0}, step_s: 5.0e-6, change: {gravity_m_s2: [0, 0, -9.81], walls: [{name: box, friction_static: 0.1}]}, effects_off: [rolling]}\n"
    "output: {every_s: 0.01, fields: [position, velocity], observables: [kinetic_energy], observables_every_s: 0.001, contacts: false, checkpoint_every_s: 0.5}\n"
    "contact_table: {skin_m: auto, batch_steps: auto}\n"
    "guards: {every_steps: 100, overlap_max: 0.3, move_max: 0.5}\n"
    "study: {answers: [kinetic_energy, \"particles[pair].items[0].velocity\"]}\n";

/* A small scene that bad ones are made from. Lines matter: messages name them. */
static const char base[] =
    "title: base\n"
    "dimensions: 3\n"
    "gravity_m_s2: [0, 0, -9.81]\n"
    "domain: {low_m: [-1, -1, -1], high_m: [1, 1, 1]}\n"
    "effects:\n"
    "  - {slot: normal, law: hertz}\n"
    "  - {slot: tangential, law: mindlin}\n"
    "materials:\n"
    "  - {name: glass, density_kg_m3: 2500, youngs_modulus_pa: 5.0e6, poissons_ratio: 0.3}\n"
    "  - {name: steel, density_kg_m3: 7800, youngs_modulus_pa: 2.0e8, poissons_ratio: 0.3}\n"
    "interactions:\n"
    "  - {between: default, restitution: 0.5, friction_static: 0.5}\n"
    "  - {between: [glass, steel], friction_static: 0.2}\n"
    "walls:\n"
    "  - {name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 2]}\n"
    "  - {name: plate, shape: rectangle, corners_m: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}\n"
    "particles:\n"
    "  - {name: one, material: glass, generator: list, items: [{position_m: [0, 0, 0], radius_m: 1.0e-3}]}\n"
    "  - {name: two, material: steel, generator: random, count: 10, radius_m: 1.0e-3, region: {low_m: [0, 0, 0], high_m: [1, 1, 1]}}\n"
    "stages:\n"
    "  - {name: first, until: {rest: 1.0e-9}}\n"
    "  - {until: {time_s: 1}, change: {interactions: [{between: default, friction_static: 0.1}]}}\n"
    "output: {every_s: 0.1, observables: [kinetic_energy]}\n";

/* In two dimensions. */
static const char flat[] =
    "dimensions: 2\n"
    "gravity_m_s2: [0, -9.81, 0]\n"
    "effects: [{slot: normal, law: hertz}]\n"
    "materials: [{name: glass, density_kg_m3: 2500, youngs_modulus_pa: 5.0e6, poissons_ratio: 0.3}]\n"
    "walls:\n"
    "  - {name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 1, 0]}\n"
    "  - {name: box, shape: box, low_m: [0, 0, 0], high_m: [1, 1, 0]}\n"
    "  - {name: plate, shape: rectangle, corners_m: [[0, 0, 0], [1, 1, 0], [0, 0, 1]]}\n"
    "particles:\n"
    "  - {name: one, material: glass, generator: list, items: [{position_m: [0, 0, 0], radius_m: 1.0e-3, velocity_m_s: [1, 0, 0], spin_rad_s: [0, 0, 1]}]}\n"
    "  - {name: rows, material: glass, generator: lattice, lattice: triangular, counts: [20, 1, 9], spacing_m: 2.0e-3, radius_m: 1.0e-3}\n"
    "  - {name: cloud, material: glass, generator: random, count: 3, radius_m: 1.0e-3, region: {low_m: [0, 0, 0], high_m: [1, 1, 0]}}\n"
    "stages: [{until: {time_s: 1}}]\n";

/* clang-format on */

static scene *read_good_with(const char *text, int set_count, char *const *sets)
{
    scene *s = NULL;
    failure why = {""};
    if (scene_read_text(text, "dir/scene.yaml", set_count, sets, &s, &why) != STATUS_OK)
        fail_msg("refused: %s", why.text);
    return s;
}

static scene *read_good(const char *text)
{
    return read_good_with(text, 0, NULL);
}

/* The text with the first `from` replaced. Caller frees. */
static char *replaced(const char *text, const char *from, const char *to)
{
    const char *at = strstr(text, from);
    if (!at)
        fail_msg("the scene does not hold: %s", from);
    char *out = malloc(strlen(text) + strlen(to) + 1);
    assert_non_null(out);
    size_t before = (size_t)(at - text);
    memcpy(out, text, before);
    strcpy(out + before, to);
    strcat(out, at + strlen(from));
    return out;
}

static scene *read_replaced(const char *text, const char *from, const char *to)
{
    char *changed = replaced(text, from, to);
    scene *s = read_good(changed);
    free(changed);
    return s;
}

/* False, with both messages printed, when the refusal is not the expected one. */
static bool is_refused(const char *text, int set_count, char *const *sets, const char *message)
{
    scene *s = (scene *)1;
    failure why = {""};
    status result = scene_read_text(text, "dir/scene.yaml", set_count, sets, &s, &why);
    if (result == STATUS_OK)
        scene_free(s);
    if (result == STATUS_BAD_INPUT && strstr(why.text, message) && !s)
        return true;
    print_error("status %d\n  wanted: %s\n  given:  %s\n", result, message, result == STATUS_OK ? "(accepted)" : why.text);
    return false;
}

static void expect_refusal(const char *text, int set_count, char *const *sets, const char *message)
{
    assert_true(is_refused(text, set_count, sets, message));
}

typedef struct bad_scene {
    const char *from, *to, *message;
} bad_scene;

static void expect_refusals(const char *text, const bad_scene *bad, size_t count)
{
    int wrong = 0;
    for (size_t k = 0; k < count; k++) {
        char *changed = replaced(text, bad[k].from, bad[k].to);
        wrong += !is_refused(changed, 0, NULL, bad[k].message);
        free(changed);
    }
    assert_int_equal(wrong, 0);
}

#define COUNT(array) (sizeof(array) / sizeof *(array))

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

/* clang-format off */
static const bad_scene bad_scenes[] = {
    /* YAML */
    {"title: base", "title: [", "scene.yaml:"},
    {"title: base", "title: *x", "dir/scene.yaml:1:8: anchors and aliases"},
    {"title: base", "title: &x base", "anchors and aliases"},
    {"title: base", "title: !!str base", "tags"},
    {"title: base", "\t- title", "indent with spaces"},
    {"title: base", "title: \"a\\0b\"", "zero byte"},
    {"title: base", "[a]: base", "a key must be one word"},
    {"title: base", "title: a\n---\ntitle: b", "dir/scene.yaml:2:1: a second YAML document"},
    {"title: base", "title: [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]", "nested too deeply"},
    /* keys */
    {"title: base", "titel: base", "dir/scene.yaml:1:1: unknown key `titel` in a scene; did you mean `title`?"},
    {"title: base", "surroundings: {}", "unknown key `surroundings` in a scene; its keys are `title`"},
    {"title: base", "gravity: [0, 0, 0]", "did you mean `gravity_m_s2`?"},
    {"title: base", "seed: 1\nseed: 2", "dir/scene.yaml:2:1: the key `seed` stands twice in this scene, first at line 1"},
    {"youngs_modulus_pa: 5.0e6", "youngs_modulus: 5.0e6", "did you mean `youngs_modulus_pa`?"},
    {"name: floor, shape: plane", "name: floor, shape: plane, radius_m: 1", "`radius_m` has no meaning in a wall with `shape: plane`; it belongs to `disc`"},
    {"shape: plane, point_m: [0, 0, 0], ", "shape: plane, ", "dir/scene.yaml:15:5: a wall needs the key `point_m`"},
    {"name: floor, shape: plane", "name: floor", "a wall needs the key `shape`"},
    {"materials:\n", "walls_:\n", "unknown key `walls_`"},
    {"generator: list", "generator: list, count: 3", "`count` has no meaning in a particle group with `generator: list`; it belongs to `random`"},
    {"generator: list, items", "generator: list, thermic: free, items", "unknown key `thermic` in a particle group"},
    {"domain: {low_m: [-1, -1, -1], high_m: [1, 1, 1]}", "domain: {periodic: [x]}", "a domain needs the key `low_m`"},
    {"stages:\n  - {name: first, until: {rest: 1.0e-9}}", "stages:\n  - {name: first}", "a stage needs the key `until`"},
    /* numbers */
    {"youngs_modulus_pa: 5.0e6", "youngs_modulus_pa: 5 MPa",
     "dir/scene.yaml:9:59: `youngs_modulus_pa` must be a number in Pa, above 0, at most 1e+15; it is `5 MPa`; write the number alone"},
    {"youngs_modulus_pa: 5.0e6", "youngs_modulus_pa: .nan", "`youngs_modulus_pa` must be a number in Pa"},
    {"youngs_modulus_pa: 5.0e6", "youngs_modulus_pa: nan", "it is `nan`"},
    {"youngs_modulus_pa: 5.0e6", "youngs_modulus_pa: inf", "it is `inf`"},
    {"youngs_modulus_pa: 5.0e6", "youngs_modulus_pa: 0x10", "it is `0x10`"},
    {"youngs_modulus_pa: 5.0e6", "youngs_modulus_pa: 1e6x", "it is `1e6x`"},
    {"youngs_modulus_pa: 5.0e6", "youngs_modulus_pa: 1e999", "too large"},
    {"youngs_modulus_pa: 5.0e6", "youngs_modulus_pa: \"5e6\"", "the text \"5e6\"; remove the quotes"},
    {"title: base", "seed:", "it is empty"},
    {"youngs_modulus_pa: 5.0e6", "youngs_modulus_pa: [1]", "it is a list of 1"},
    {"youngs_modulus_pa: 5.0e6", "youngs_modulus_pa: -1", "above 0, at most 1e+15; it is `-1`"},
    {"poissons_ratio: 0.3", "poissons_ratio: 0.6", "above -1, at most 0.5; it is `0.6`"},
    {"poissons_ratio: 0.3", "poissons_ratio: 0,3", "unknown key `3`"},
    {"count: 10", "count: 10.5", "`count` must be a whole number, at least 0, at most 2000000000; it is `10.5`, which has a fraction"},
    {"count: 10", "count: -1", "`count` must be a whole number"},
    {"title: base", "seed: 1e17", "`seed` must be a whole number"},
    {"gravity_m_s2: [0, 0, -9.81]", "gravity_m_s2: -9.81", "dir/scene.yaml:3:15: `gravity_m_s2` must be three numbers [x, y, z] in m/s^2; it is `-9.81`"},
    {"gravity_m_s2: [0, 0, -9.81]", "gravity_m_s2: [0, -9.81]", "it is a list of 2"},
    {"gravity_m_s2: [0, 0, -9.81]", "gravity_m_s2: [0, 0, g]", "dir/scene.yaml:3:22: `gravity_m_s2` must be a number in m/s^2; it is `g`"},
    {"output: {every_s: 0.1", "output: {every_s: 0", "`every_s` must be a number in s, above 0; it is `0`"},
    {"name: first, until", "name: first, step_s: 0, until", "`step_s` must be a number in s, above 0, or `auto`; it is `0`"},
    {"name: first, until", "name: first, step_s: automatic, until", "or `auto`; it is `automatic`"},
    {"name: first, until", "name: first, allow_unstable_step: yes, until", "must be `true` or `false`; it is `yes`"},
    {"title: base", "title: [a]", "`title` must be a text; it is a list of 1"},
    {"effects:\n", "effects: 3\nstudy: {answers: [a]}\nguards:\n", "`effects` must be a list"},
    /* choices */
    {"dimensions: 3", "dimensions: 4", "`dimensions` must be one of `2`, `3`; it is `4`"},
    {"title: base", "precision: float", "`precision` must be one of `auto`, `double`, `mixed`; it is `float`"},
    {"title: base", "integrator: leapfrog", "`integrator` must be one of `semi_implicit_euler`, `velocity_verlet`; it is `leapfrog`"},
    {"shape: plane, point_m: [0, 0, 0], normal", "shape: cylinder, axis", "a wall needs the key `axis_point_m`"},
    {"shape: plane, point_m: [0, 0, 0], normal: [0, 0, 2]", "shape: cylinder, axis_point_m: [0, 0, 0], axis: [0, 0, 2], radius_m: 0, length_m: 1",
     "`radius_m` must be a number in m, above 0; it is `0`"},
    {"shape: plane, point_m: [0, 0, 0], normal: [0, 0, 2]", "shape: cylinder, axis_point_m: [0, 0, 0], axis: [0, 0, 0], radius_m: 1, length_m: 1",
     "`axis`"},
    {"shape: plane, point_m: [0, 0, 0], normal: [0, 0, 2]", "shape: cylinder, side: in, axis_point_m: [0, 0, 0], axis: [0, 0, 1], radius_m: 1, length_m: 1",
     "`side` must be one of `inside`, `outside`; it is `in`"},
    {"shape: plane, point_m: [0, 0, 0], normal: [0, 0, 2]", "shape: cone, axis_point_m: [0, 0, 0], axis: [0, 0, 1], radius_m: 1, length_m: 1",
     "`radius_m` of a cone must be two numbers, [radius at the first end, at the other]; it is `1`"},
    {"shape: plane, point_m: [0, 0, 0], normal: [0, 0, 2]", "shape: cone, axis_point_m: [0, 0, 0], axis: [0, 0, 1], radius_m: [1, 1], length_m: 1",
     "both radii of the cone are 1 m; write `shape: cylinder`"},
    {"shape: plane, point_m: [0, 0, 0], normal: [0, 0, 2]", "shape: cone, axis_point_m: [0, 0, 0], axis: [0, 0, 1], radius_m: [-1, 1], length_m: 1",
     "it is `-1`"},
    {"shape: plane", "shape: plan", "did you mean `plane`?"},
    {"name: floor, ", "name: floor, servo: {pressure_pa: 1, speed_max_m_s: 1}, ", "a servo needs the key `direction`"},
    {"name: floor, ", "name: floor, servo: {direction: [0, 0, 1], force_n: 0, speed_max_m_s: 1}, ", "`force_n` must be a number in N, above 0; it is `0`"},
    {"name: floor, ", "name: floor, servo: {direction: [0, 0, 1], force_n: 1, speed_max_m_s: 1, gain: 2}, ", "unknown key `gain` in a servo"},
    {"change: {inter", "change: {walls: [{name: floor, servo: on}], inter", "or `off`; it is `on`"},
    {"change: {inter", "change: {wall_groups: [{name: lids}], inter", "there is no wall group called `lids`; known here: none"},
    {"rest: 1.0e-9", "rest: 1.0e-9, steady_k_s: 1", "`steady_k_s` looks at temperatures, and no law of heat is listed under `effects`"},
    {"until: {time_s: 1}", "motion: frozen, until: {time_s: 1}", "`motion: frozen` leaves only heat to advance, and no law of heat is listed"},
    {"until: {time_s: 1}", "motion: still, until: {time_s: 1}", "`motion` must be one of `free`, `frozen`; it is `still`"},
    {"until: {time_s: 1}", "heat: {tolerance: 0}, until: {time_s: 1}", "`tolerance` must be a number, at least 1e-12, at most 0.1"},
    {"until: {time_s: 1}", "heat: {method: rk4}, until: {time_s: 1}", "`method` must be one of"},
    {"high_m: [1, 1, 1]}", "high_m: [1, 1, 1], periodic: [w]}", "`periodic` must be one of `x`, `y`, `z`; it is `w`"},
    {"high_m: [1, 1, 1]}", "high_m: [1, 1, 1], periodic: x}", "`periodic` must be a list"},
    /* effects */
    {"slot: normal", "slot: induction", "there is no slot called `induction`; this version has `radius`"},
    {"slot: normal", "slot: periodic", "there is no slot called `periodic`"},
    {"law: hertz", "law: jkr", "the slot `normal` has no law called `jkr`; this version has `hertz`, `linear`"},
    {"{slot: normal, law: hertz}", "hertz", "an effect must be a mapping"},
    {"{slot: normal, law: hertz}", "{slot: normal}", "an effect needs the key `law`"},
    {"law: mindlin", "law: mindlin, shear: printed", "unknown key `shear` in a tangential effect with the law `mindlin`; did you mean `shear_modulus`?"},
    {"law: mindlin", "law: mindlin, shear_modulus: print", "`shear_modulus` must be one of `printed`, `mindlin`; it is `print`"},
    {"law: mindlin}", "law: mindlin}\n  - {slot: normal, law: linear}", "dir/scene.yaml:8:5: the slot `normal` is filled twice, by `hertz` and by `linear`"},
    {"law: mindlin}", "law: mindlin}\n  - {slot: body, law: local_damping, coefficient: 2}", "`coefficient` must be a number, at least 0, at most 1; it is `2`"},
    {"  - {slot: normal, law: hertz}\n", "", "the tangential law `mindlin` needs a normal law"},
    {"name: first, until", "name: first, effects_off: [normal], until", "switches the normal law off and leaves `tangential` on"},
    {"name: first, until", "name: first, effects_off: [rolling], until", "`effects_off` names the slot `rolling`, which no entry of `effects` fills"},
    /* needs */
    {", youngs_modulus_pa: 2.0e8", "", "dir/scene.yaml:10:5: the normal law `hertz` needs `youngs_modulus_pa`, which the material `steel` lacks"},
    {"density_kg_m3: 2500, ", "", "the material `glass` lacks `density_kg_m3`; every particle needs a mass"},
    {"restitution: 0.5, friction_static: 0.5", "restitution: 0.5", "the tangential law `mindlin` needs `friction_static` between `glass` and `glass`"},
    {"{between: default, restitution: 0.5, friction_static: 0.5}",
     "{between: [glass, glass], friction_static: 0.5}\n  - {between: [steel, steel], friction_static: 0.5}\n  - {between: [glass, floor], friction_static: 1}",
     "needs `friction_static` between `glass` and the wall `plate`"},
    /* names and references */
    {"poissons_ratio: 0.3}\ninteractions", "poissons_ratio: 0.3}\n  - {name: glass, density_kg_m3: 1}\ninteractions",
     "dir/scene.yaml:11:12: the name `glass` is taken by a material at line 9"},
    {"name: plate", "name: floor", "the name `floor` is taken by a wall at line 15"},
    {"name: plate", "name: steel", "the name `steel` is taken by a material at line 10"},
    {"name: plate", "name: default", "cannot be called `default`"},
    {"name: two", "name: one", "the name `one` is taken by a particle group"},
    {"{until: {time_s: 1}", "{name: first, until: {time_s: 1}", "the name `first` is taken by a stage at line 21"},
    {"name: plate", "name: 2nd", "must begin with a letter"},
    {"name: plate", "name: a/b", "must begin with a letter and hold at most 40 letters"},
    {"material: glass", "material: sand", "there is no material called `sand`; known here: `glass`, `steel`"},
    {"[glass, steel], friction", "[glass, sand], friction", "there is no material or wall called `sand`; known here: `glass`, `steel`, `floor`, `plate`"},
    {"[glass, steel], friction", "[floor, plate], friction", "names two walls"},
    {"[glass, steel], friction", "glass, friction", "`between` must be `default` or two names"},
    {"[glass, steel], friction", "default, friction", "this pair has an entry already, at line 12"},
    {"restitution: 0.5,", "restitution: 0.5, normal_damping_ratio: 0.1,", "gives both `restitution` and `normal_damping_ratio`"},
    {"change: {inter", "change: {walls: [{name: roof, motion: []}], inter", "there is no wall called `roof`"},
    {"change: {inter", "change: {walls: [{name: floor, restitution: 1, normal_damping_ratio: 0}], inter", "gives both"},
    {"change: {inter", "change: {walls: [{name: floor}, {name: floor}], inter", "the wall `floor` is changed twice"},
    {"change: {inter", "change: {particles: [{name: three, motion: free}], inter", "there is no particle group called `three`; known here: `one`, `two`"},
    {"change: {inter", "change: {particles: [{name: one, motion: frozen}], inter", "`motion` must be `free`, `fixed` or a list of motion terms; it is `frozen`"},
    /* geometry */
    {"high_m: [1, 1, 1]}", "high_m: [1, -2, 1]}", "`low_m` must be below `high_m` in y; they are -1 and -2"},
    {"normal: [0, 0, 2]", "normal: [0, 0, 0]", "`normal` is a zero vector"},
    {"[0, 1, 0]]}", "[0.5, 1, 0]]}", "must be perpendicular; at the first corner they meet at 63.4349 degrees"},
    {"[0, 1, 0]]}", "[0, 0, 0]]}", "corners 1 and 3 of the rectangle are the same point"},
    {"[1, 0, 0], [0, 1, 0]]}", "[1, 0, 0]]}", "`corners_m` must be three points"},
    {"normal: [0, 0, 2]", "normal: [0, 0, 2], motion: [{type: table, time_s: [0, 0], velocity_m_s: [[0, 0, 0], [0, 0, 0]]}]", "`time_s` must rise"},
    {"normal: [0, 0, 2]", "normal: [0, 0, 2], motion: [{type: table, time_s: [0, 1], velocity_m_s: [[0, 0, 0]]}]", "`velocity_m_s` has 1 entries and `time_s` has 2"},
    {"normal: [0, 0, 2]", "normal: [0, 0, 2], motion: fixed", "`motion` must be a list"},
    {"normal: [0, 0, 2]", "normal: [0, 0, 2], motion: [{type: constant, rate_rad_s: 1}]", "`rate_rad_s` has no meaning in a motion term with `type: constant`"},
    {"high_m: [1, 1, 1]}}", "high_m: [1, 0, 1]}}", "`low_m` must be below `high_m` in y"},
    /* radii */
    {"radius_m: 1.0e-3, region", "radius_m: {distribution: uniform, low: 2, high: 1}, region", "`low` (2 m) is above `high` (1 m)"},
    {"radius_m: 1.0e-3, region", "radius_m: {distribution: normal, mean: 1, std: 0.5}, region", "radii down to mean - truncate_sigmas std = -0.5 m"},
    {"radius_m: 1.0e-3, region", "radius_m: {distribution: sieve, size_m: [1, 2], mass_fraction: [0.5, 0.5]}, region", "it takes one size more than fractions"},
    {"radius_m: 1.0e-3, region", "radius_m: {distribution: sieve, size_m: [1, 2, 2], mass_fraction: [0.5, 0.5]}, region", "`size_m` must rise"},
    {"radius_m: 1.0e-3, region", "radius_m: {distribution: sieve, size_m: [1, 2, 3], mass_fraction: [0.5, 0.6]}, region", "they add up to 1.1"},
    {"radius_m: 1.0e-3, region", "radius_m: {mean: 1}, region", "a radius distribution needs the key `distribution`"},
    {"radius_m: 1.0e-3, region", "radius_m: 0, region", "`radius_m` must be a number in m, above 0; it is `0`"},
    /* stages and output */
    {"until: {rest: 1.0e-9}", "until: {}", "`until` needs at least one of"},
    {"gravity_m_s2: [0, 0, -9.81]", "gravity_m_s2: [0, 0, 0]", "dir/scene.yaml:21:33: `rest` compares with m g r, and this stage has no gravity; use `rest_j`"},
    {"observables: [kinetic_energy]", "observables: [kinetic_enrgy]", "there is no observable called `kinetic_enrgy`; did you mean `kinetic_energy`?"},
    {"observables: [kinetic_energy]", "observables: [thermal_energy]", "the material `glass` lacks `specific_heat_j_kgk`, which every scene with temperatures needs"},
    {"observables: [kinetic_energy]", "fields: [temperature]", "the material `glass` lacks `specific_heat_j_kgk`"},
    {"observables: [kinetic_energy]", "fields: [position, position]", "listed twice"},
    /* heat */
    {"{slot: tangential, law: mindlin}", "{slot: conduction, law: overlap_area}", "the conduction law `overlap_area` needs `conductivity_w_mk`, which the material `glass` lacks"},
    {"{slot: tangential, law: mindlin}", "{slot: conduction, law: pipe_network}", "needs `conductivity_w_mk`"},
    {"{slot: tangential, law: mindlin}", "{slot: convection, law: newton, coefficient_w_m2k: 50}", "needs the temperature of the environment; add `environment: {temperature_k: ...}`"},
    {"{slot: tangential, law: mindlin}", "{slot: convection, law: newton}", "needs the key `coefficient_w_m2k`"},
    {"{slot: tangential, law: mindlin}", "{slot: radiation, law: stefan_boltzmann}", "the radiation law `stefan_boltzmann` needs `emissivity`, which the material `glass` lacks"},
    {"poissons_ratio: 0.3}", "poissons_ratio: 0.3, emissivity: 1.1}", "`emissivity` must be a number, at least 0, at most 1; it is"},
    {"title: base", "environment: {temperature_k: 0}", "`temperature_k` must be a number in K, above 0; it is"},
    {"title: base", "environment: {temperature_k: {time_s: [0, 0], value: [1, 2]}}", "`time_s` must rise from entry to entry; 0 follows 0"},
    {"title: base", "environment: {temperature_k: {time_s: [0, 1], value: [1]}}", "`value` has 1 entries and the table 2 places"},
    {"title: base", "environment: {temperature_k: {value: [1]}}", "`temperature_k` as a table needs `time_s`, or `axis` and `at_m`"},
    {"title: base", "environment: {temperature_k: {axis: x, at_m: [0, 1], time_s: [0, 1], value: [1, 2]}}", "not both"},
    {"title: base", "environment: {gas: {viscosity_pa_s: 0}}", "`viscosity_pa_s` must be a number in Pa s, above 0"},
    {"normal: [0, 0, 2]", "normal: [0, 0, 2], temperature_k: 0", "`temperature_k` must be a number in K, above 0; it is"},
    {"normal: [0, 0, 2]", "normal: [0, 0, 2], temperature_k: {axis: x, at_m: [0, 1], value: [1, 2]}", "`temperature_k` cannot vary along an axis"},
    {"normal: [0, 0, 2]", "normal: [0, 0, 2], temperature_k: 300, heat_flux_w: 1", "keep one"},
    {"normal: [0, 0, 2]", "normal: [0, 0, 2], heat: none", "`heat` must be"},
    {"generator: list, items", "generator: list, temperature_k: 0, items", "`temperature_k` must be a number in K, above 0"},
    {"generator: list, items", "generator: list, temperature_k: {time_s: [0, 1], value: [300, 400]}, items", "add `thermal: prescribed`"},
    {"generator: list, items", "generator: list, thermal: prescribed, items", "`thermal: prescribed` needs `temperature_k`"},
    {"generator: list, items", "generator: list, thermal: flux, items", "`thermal: flux` needs `heat_flux_w`"},
    {"generator: list, items", "generator: list, heat_flux_w: 1, items", "`heat_flux_w` needs `thermal: flux`"},
    {"between: default, friction_static: 0.1}]", "between: default, friction_static: 0.1}], walls: [{name: floor, temperature_k: -1}]", "`temperature_k` must be a number in K, above 0"},
    {"observables: [kinetic_energy]", "fields: [colour]", "there is no field called `colour`"},
};
/* clang-format on */

static void test_bad_scenes(void **state)
{
    (void)state;
    expect_refusals(base, bad_scenes, COUNT(bad_scenes));
}

static void test_bad_flat_scenes(void **state)
{
    (void)state;
    static const bad_scene bad[] = {
        {"[0, -9.81, 0]", "[0, 0, -9.81]",
         "dir/scene.yaml:2:15: with `dimensions: 2` z of `gravity_m_s2` (y is up) must be 0; it is -9.81"},
        {"position_m: [0, 0, 0]", "position_m: [0, 0, 1]", "z of a position must be 0"},
        {"velocity_m_s: [1, 0, 0]", "velocity_m_s: [1, 0, 1]", "z of a velocity must be 0"},
        {"spin_rad_s: [0, 0, 1]", "spin_rad_s: [0, 1, 1]", "spin about y must be 0"},
        {"counts: [20, 1, 9]", "counts: [20, 2, 9]", "a triangular lattice has one layer: entry 2 of `counts` must be 1; it is 2"},
        {"lattice: triangular", "lattice: hexagonal", "entry 3 of `counts` must be 1; it is 9"},
        {"normal: [0, 1, 0]", "normal: [0, 1, 1]", "a wall's normal must lie in the x-y plane"},
        {"normal: [0, 1, 0]", "normal: [0, 1, 0], motion: [{type: rotation, point_m: [0, 0, 0], axis: [1, 0, 0], rate_rad_s: 1}]",
         "an axis must lie along z"},
        {"normal: [0, 1, 0]", "normal: [0, 1, 0], motion: [{type: constant, velocity_m_s: [0, 0, 1]}]", "velocities have no z component"},
        {"shape: plane, point_m: [0, 0, 0], normal: [0, 1, 0]", "shape: cylinder, axis_point_m: [0, 0, -1], axis: [0, 1, 1], radius_m: 1, length_m: 2",
         "the axis of a cylinder must lie along z"},
        {"shape: plane, point_m: [0, 0, 0], normal: [0, 1, 0]", "shape: cylinder, axis_point_m: [0, 0, 0], axis: [0, 0, 1], radius_m: 1, length_m: 2",
         "a cylinder must pass through z = 0; it runs from z = 0 to 2"},
        {"shape: plane, point_m: [0, 0, 0], normal: [0, 1, 0]", "shape: cone, axis_point_m: [0, 0, 0], axis: [0, 0, 1], radius_m: [1, 0], length_m: 2",
         "a cone's normals leave the x-y plane"},
        {"[0, 0, 1]]", "[-1, 1, 0]]", "one side of a rectangle must lie along z"},
        {"region: {low_m: [0, 0, 0]", "region: {low_m: [0, 0, -1]", "a region lies at z = 0"},
        {"effects:", "domain: {low_m: [0, 0, 0], high_m: [1, 1, 1], periodic: [z]}\neffects:", "the domain cannot repeat along z"},
    };
    expect_refusals(flat, bad, COUNT(bad));
}

static void test_bad_documents(void **state)
{
    (void)state;
    expect_refusal("", 0, NULL, "holds no YAML");
    expect_refusal("# nothing\n", 0, NULL, "holds no YAML");
    expect_refusal("- a\n", 0, NULL, "dir/scene.yaml:1:1: a scene must be a mapping");
    expect_refusal("hello\n", 0, NULL, "a scene must be a mapping");
    expect_refusal("title: a\n", 0, NULL, "a scene needs the key `materials`");
    expect_refusal("materials: []\nparticles: []\nstages: []\n", 0, NULL, "`stages` must hold at least one stage");
    expect_refusal("materials: [{name: m, density_kg_m3: 1}]\nstages: [{until: {steps: 1}}]\n"
                   "particles: [{name: a, material: m, generator: random, count: 1, radius_m: 1}]\n",
                   0, NULL, "needs a `region`, or the scene a `domain`");
    expect_refusal("materials: [{name: m, density_kg_m3: 1}]\nstages: [{until: {steps: 1}}]\n"
                   "particles: [{name: a, material: m, generator: lattice, counts: [1e9, 1e9, 1], spacing_m: 1, radius_m: 1}]\n",
                   0, NULL, "the scene has 1e+18 particles");
    char *deep = malloc(200001);
    assert_non_null(deep);
    memset(deep, '[', 200000);
    deep[200000] = '\0';
    expect_refusal(deep, 0, NULL, "nested too deeply");
    free(deep);
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

static void test_bad_settings(void **state)
{
    (void)state;
    static const struct {
        char *set;
        const char *message;
    } bad[] = {
        {"seed", "--set seed: must read `path=value`"},
        {"=1", "must read `path=value`"},
        {"seed=", "--set seed=: the value is missing"},
        {"seed=x", "--set seed=x: `seed` must be a whole number"},
        {"seed=\"3\"", "remove the quotes"},
        {"sead=3", "--set sead=3: unknown key `sead` in a scene; did you mean `seed`?"},
        {"outputs.every_s=3", "unknown key `outputs` in a scene; did you mean `output`?"},
        {"walls[flor].point_m=[0,0,0]", "`walls` has no entry called `flor`; it has 2 entries: floor, plate"},
        {"walls[2].point_m=[0,0,0]", "`walls` has 2 entries, counted from 0; there is no entry 2"},
        {"walls[99999999999999999999].point_m=[0,0,0]", "`walls` has 2 entries"},
        {"particles[one].items[3].radius_m=1", "`particles[one].items` has 1 entries"},
        {"walls.point_m=1", "`walls` is a list of 2, so it has no key `point_m`; choose an entry"},
        {"title.x=1", "`title` is `base`, so it has no key `x`"},
        {"title[0]=1", "`title` is `base`, not a list"},
        {"walls[floor=1", "the path lacks a `]`"},
        {"walls[]=1", "empty step"},
        {"walls[floor]x=1", "needs a `.` or `[` after `]`"},
        {"a..b=1", "empty step"},
        {"[0]=1", "must begin with a key"},
        {"walls[floor].point_m=[0,0", "not valid YAML"},
        {"title=[&a x, *a]", "anchors and aliases"},
        {"walls[floor]=1", "a wall must be a mapping (`key: value`), not `1`"},
        {"walls[floor].normal=[0,0,0]", "--set walls[floor].normal=[0,0,0]: `normal` is a zero vector"},
        {"effects[conduction].law=x", "`effects` has no entry called `conduction`; it has 2 entries: normal, tangential"},
        {"stages=[]", "--set stages=[]: `stages` must hold at least one stage"},
        {"materials[glass].poissons_ratio=0.7", "--set materials[glass].poissons_ratio=0.7: `poissons_ratio` must be"},
        {"output.observables=[bonds_alive]", "--set output.observables=[bonds_alive]: the observable `bonds_alive` needs a bond law"},
    };
    int wrong = 0;
    for (size_t k = 0; k < COUNT(bad); k++)
        wrong += !is_refused(base, 1, &bad[k].set, bad[k].message);
    assert_int_equal(wrong, 0);
    char *const twice[] = {"seed=x", "seed=5"}; /* the later one counts */
    scene *s = read_good_with(base, 2, twice);
    assert_int_equal(s->seed, 5);
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
        cmocka_unit_test(test_bad_scenes),
        cmocka_unit_test(test_bad_flat_scenes),
        cmocka_unit_test(test_bad_documents),
        cmocka_unit_test(test_files),
        cmocka_unit_test(test_set),
        cmocka_unit_test(test_bad_settings),
        cmocka_unit_test(test_text_round_trip),
        cmocka_unit_test(test_reference),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
