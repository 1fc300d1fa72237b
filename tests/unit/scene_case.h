/* Scenes to read, and to make bad ones from; what tests of the scene reader share. */
#ifndef CLAST_TESTS_SCENE_CASE_H
#define CLAST_TESTS_SCENE_CASE_H
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

static inline scene *read_good_with(const char *text, int set_count, char *const *sets)
{
    scene *s = NULL;
    failure why = {""};
    if (scene_read_text(text, "dir/scene.yaml", set_count, sets, &s, &why) != STATUS_OK)
        fail_msg("refused: %s", why.text);
    return s;
}

static inline scene *read_good(const char *text)
{
    return read_good_with(text, 0, NULL);
}

/* The text with the first `from` replaced. Caller frees. */
static inline char *replaced(const char *text, const char *from, const char *to)
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

static inline scene *read_replaced(const char *text, const char *from, const char *to)
{
    char *changed = replaced(text, from, to);
    scene *s = read_good(changed);
    free(changed);
    return s;
}

/* False, with both messages printed, when the refusal is not the expected one. */
static inline bool is_refused(const char *text, int set_count, char *const *sets, const char *message)
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

static inline void expect_refusal(const char *text, int set_count, char *const *sets, const char *message)
{
    assert_true(is_refused(text, set_count, sets, message));
}

typedef struct bad_scene {
    const char *from, *to, *message;
} bad_scene;

static inline void expect_refusals(const char *text, const bad_scene *bad, size_t count)
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

#endif
