/* The message of the scene reader for what it refuses. */
#include "scene_case.h"

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
    {"high_m: [1, 1, 1]}", "high_m: [1, 1, 1], periodic: [x, y, x]}", "`periodic` lists `x` twice; keep one"},
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
        {"[[0, 0, 0], [1, 1, 0], [0, 0, 1]]", "[[0, 0, 1], [1, 1, 1], [0, 0, 2]]", "a rectangle must reach the plane z = 0, in which the grains are; it runs from z = 1 to 2"},
        {"region: {low_m: [0, 0, 0]", "region: {low_m: [0, 0, -1]", "a region lies at z = 0"},
        {"effects:", "domain: {low_m: [0, 0, 0], high_m: [1, 1, 1], periodic: [z]}\neffects:", "the domain cannot repeat along z"},
    };
    expect_refusals(flat, bad, COUNT(bad));
}

static void test_bad_documents(void **state)
{
    (void)state;
    expect_refusal("", 0, NULL, "dir/scene.yaml:1:1: holds no YAML");
    expect_refusal("# nothing\n", 0, NULL, "dir/scene.yaml:1:1: holds no YAML");
    expect_refusal("seed: 1\ntitle: caf\xe9\n", 0, NULL, "dir/scene.yaml:2:11: not a text file in UTF-8");
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
    expect_refusal("materials: [{name: m, density_kg_m3: 1}]\nwalls: [{name: m, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}]\n"
                   "interactions: [{between: [m, m], friction_static: 1}]\nstages: [{until: {steps: 1}}]\n"
                   "particles: [{name: a, material: m, generator: list, items: [{position_m: [0, 0, 1], radius_m: 1}]}]\n",
                   0, NULL, "dir/scene.yaml:2:16: the name `m` is taken by a material at line 1");
    char *deep = malloc(200001);
    assert_non_null(deep);
    memset(deep, '[', 200000);
    deep[200000] = '\0';
    expect_refusal(deep, 0, NULL, "nested too deeply");
    free(deep);
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
        {"wals[floor].point_m=[0,0,0]", "the scene has no list `wals` to choose an entry from"},
        {"stages[0].change.walls[floor].motion=[]", "the scene has no list `stages[0].change.walls` to choose an entry from"},
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
int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bad_scenes),
        cmocka_unit_test(test_bad_flat_scenes),
        cmocka_unit_test(test_bad_documents),
        cmocka_unit_test(test_bad_settings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
