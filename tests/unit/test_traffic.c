/* Bytes that the stages move, counted from their arguments, against the layout written out by hand. */
#include "simulation_case.h"

#include "traffic.h"

#define SCENE(effects, more)                                                                                                         \
    "effects: [{slot: normal, law: hertz}" effects "]\n" more                                                                        \
    "materials: [{name: m, density_kg_m3: 2500, youngs_modulus_pa: 5.0e6, poissons_ratio: 0.3, conductivity_w_mk: 1, "               \
    "specific_heat_j_kgk: 800}]\n"                                                                                                   \
    "interactions: [{between: default, restitution: 0.5, friction_static: 0.5}]\n"                                                   \
    "particles: [{name: bed, material: m, generator: lattice, lattice: simple_cubic, counts: [6, 6, 6], spacing_m: 0.002, radius_m: 0.001, temperature_k: 300}]\n" \
    "stages: [{name: go, until: {steps: 1}, step_s: 1.0e-5}]\n"

static void open_and_count(sim_case *c, const char *yaml, step_traffic *traffic, field_sizes *sizes)
{
    case_open(c, yaml);
    MUST(traffic_of_step(c->sim, traffic, why));
    *sizes = traffic_field_sizes(c->sim);
}

/* position 24, velocity 24, radius 8, mass 8 are read of a grain; owner and other 4 + 4, and the force written, 24, of a record. The particle
 * stage reads force, radius, mass and where the grain was, and reads and writes position and velocity. */
static void test_contact(void **state)
{
    (void)state;
    sim_case c;
    step_traffic t;
    field_sizes sizes;
    open_and_count(&c, SCENE("", ""), &t, &sizes);
    double grains = 216.0, records = c.sim->table.record_count, slots = c.sim->table.slot_count, blocks = (double)c.sim->stride / CLAST_BLOCK;
    assert_true(records > 0.0);
    assert_float_equal(t.pair_bytes, grains * (24 + 24 + 8 + 8) + records * (4 + 4 + 24), 1e-6);
    assert_float_equal(t.particle_bytes, grains * (8 + 8 + 24 + 2 * (24 + 24)) + records * 24 + slots * 4 + blocks * 4, 1e-6);
    double mark = c.sim->live.blocks ? 4 : 0; /* of what touches: at rest nobody looks at it */
    assert_float_equal(sizes.grain, 24 + 24 + 8 + 8 + 4 + 24 + mark, 1e-12);
    assert_float_equal(sizes.record, 4 + 4 + 24, 1e-12);
    case_close(&c);
}

/* Friction: spin 24 of a grain; torques 48 and the spring 24 of a record, the spring read and written. */
static void test_friction(void **state)
{
    (void)state;
    sim_case a, b;
    step_traffic without, with;
    field_sizes s, u;
    open_and_count(&a, SCENE("", ""), &without, &s);
    open_and_count(&b, SCENE(", {slot: tangential, law: mindlin}", ""), &with, &u);
    double grains = 216.0, records = b.sim->table.record_count;
    assert_float_equal(with.pair_bytes - without.pair_bytes, grains * 24 + records * (48 + 2 * 24), 1e-6);
    assert_float_equal(with.particle_bytes - without.particle_bytes, grains * 2 * 24 + records * 48, 1e-6);
    assert_float_equal(u.grain - s.grain, 24, 1e-12);
    assert_float_equal(u.record - s.record, 48 + 24, 1e-12);
    assert_int_equal(with.pair_arguments - without.pair_arguments, 3);
    assert_int_equal(with.particle_arguments - without.particle_arguments, 2);
    case_close(&a);
    case_close(&b);
}

/* In mixed precision what is not exact takes half: mass and force. Where stages go by blocks, pairs read packets of 16 numbers beside. */
static void test_mixed(void **state)
{
    (void)state;
    sim_case c;
    step_traffic t;
    field_sizes sizes;
    open_and_count(&c, SCENE("", "precision: mixed\n"), &t, &sizes);
    double grains = 216.0, records = c.sim->table.record_count, packet = c.sim->live.blocks ? 16 * 4 : 0;
    assert_float_equal(t.pair_bytes, grains * (24 + 24 + 8 + 4 + packet) + records * (4 + 4 + 12), 1e-6);
    case_close(&c);
}

/* Two halves of a stage move what the whole moves. */
static void test_pieces(void **state)
{
    (void)state;
    sim_case c;
    step_traffic t;
    field_sizes sizes;
    double piece = 0.0;
    open_and_count(&c, SCENE("", ""), &t, &sizes);
    MUST(traffic_of_launch(c.sim, launch_kernel(c.sim, "pair_stage"), "pair_stage", (size_t)c.sim->table.record_count / 2, &piece, why));
    assert_float_equal(2.0 * piece, t.pair_bytes, 1e-6);
    case_close(&c);
}

static void test_copy(void **state)
{
    (void)state;
    double speed = 0.0;
    MUST(traffic_copy_speed(case_device(), 3.0e6, &speed, why));
    assert_true(speed > 1e7 && speed < 1e14);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_contact), cmocka_unit_test(test_friction), cmocka_unit_test(test_mixed), cmocka_unit_test(test_pieces), cmocka_unit_test(test_copy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
