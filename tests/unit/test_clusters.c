/* Clusters: which grains bonds join, against sweeps over the bonds until nothing changes, and in bodies whose clusters are known. */
#include "physics/case.h"

#define RADIUS 1.0e-3

/* Chains of grains that touch, in lanes along y, with ids that run to and fro; `more`: keys of the scene. */
static physics_case chains(const int *length, int lanes, const char *more)
{
    text t = {0};
    put(&t, "effects: [{slot: normal, law: hertz}, {slot: bond, law: parallel}]\n"
            "materials: [{name: m, density_kg_m3: 2000, youngs_modulus_pa: 1.0e9, poissons_ratio: 0.2}]\n"
            "interactions: [{between: default, normal_damping_ratio: 0, bond_youngs_modulus_pa: 1.0e6, bond_damping_ratio: 0.3, "
            "bond_tensile_strength_pa: 1.0e4}]\n%sparticles:\n  - name: p\n    material: m\n    generator: list\n    items:\n",
        more);
    for (int lane = 0; lane < lanes; lane++)
        for (int k = 0; k < length[lane]; k++) {
            int place = k % 2 ? length[lane] - 1 - k / 2 : k / 2;
            double v = length[lane] == 3 && place == 2 ? 1.0 : 0.0; /* v sqrt(k m*) is 2.6 times the strength: the last of three is torn off */
            put_grain(&t, RADIUS, (double[]){2.0 * RADIUS * place, 5.0 * RADIUS * lane, RADIUS}, (double[]){v, 0, 0}, (double[]){0, 0, 0});
        }
    return case_open(&t);
}

/* Smallest id that each grain reaches: over all bonds again and again. */
static void sweep(physics_case *c, int32_t *label)
{
    int64_t count;
    live_contact *live = case_contacts(c, &count);
    for (int64_t i = 0; i < c->sim->id_count; i++)
        label[i] = (int32_t)i;
    for (bool changed = true; changed;) {
        changed = false;
        for (int64_t k = 0; k < count; k++) {
            if (!live[k].bonded || live[k].j < 0)
                continue;
            int32_t least = label[live[k].i] < label[live[k].j] ? label[live[k].i] : label[live[k].j];
            changed = changed || label[live[k].i] != label[live[k].j];
            label[live[k].i] = label[live[k].j] = least;
        }
    }
    free(live);
}

static void check_labels(physics_case *c)
{
    int32_t *cluster = NULL, *label = malloc(sizeof *label * (size_t)c->sim->id_count);
    MUST(clusters_find(c->sim, &cluster, why));
    sweep(c, label);
    for (int64_t i = 0; i < c->sim->id_count; i++)
        if (cluster[i] >= 0)
            assert_int_equal(cluster[i], label[i]);
    free(cluster);
    free(label);
}

static cluster_sums measure(physics_case *c)
{
    cluster_sums sums;
    MUST(clusters_measure(c->sim, &sums, why));
    return sums;
}

static void test_chains(void **state)
{
    (void)state;
    const int length[] = {1, 2, 3, 5, 9, 1, 17, 4};
    physics_case c = chains(length, COUNT_OF(length), "");
    cluster_sums before = measure(&c);
    assert_int_equal(before.count, 0);
    assert_int_equal(before.largest, 1);
    assert_true(before.sizes[0] == 42.0);
    case_run(&c, 1, 1e-6);
    cluster_sums made = measure(&c);
    check_labels(&c);
    assert_int_equal(made.count, 6);
    assert_int_equal(made.grains, 40);
    assert_int_equal(made.largest, 17);
    const double expected[CLUSTER_CLASSES] = {2, 1, 2, 1, 1, 1}; /* 1: two; 2; 3 and 4; 5; 9; 17 */
    for (int n = 0; n < CLUSTER_CLASSES; n++)
        assert_true(made.sizes[n] == expected[n]);
    case_run(&c, 500, 1e-6);
    cluster_sums torn = measure(&c);
    check_labels(&c);
    assert_int_equal(torn.count, 6);
    assert_int_equal(torn.grains, 39);
    assert_true(torn.sizes[0] == 3.0 && torn.sizes[1] == 2.0 && torn.sizes[2] == 1.0);
    case_close(&c);
}

/* Two grains that are bonded to one floor are two clusters; one that has left belongs to none. */
static void test_floor_and_leavers(void **state)
{
    (void)state;
    const int length[] = {1, 2};
    physics_case c = chains(length, 2, "walls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}]\n");
    case_run(&c, 1, 1e-6);
    bond_sums bonds;
    MUST(bonds_count(c.sim, &bonds, why));
    assert_int_equal(bonds.alive, 4);
    cluster_sums sums = measure(&c);
    assert_int_equal(sums.count, 1);
    assert_true(sums.sizes[0] == 1.0 && sums.sizes[1] == 1.0);
    case_close(&c);

    const int three[] = {3};
    c = chains(three, 1, "domain: {low_m: [-0.01, -0.01, -0.01], high_m: [0.0045, 0.01, 0.01], leaving: delete}\n");
    case_run(&c, 1000, 1e-6);
    MUST(table_build(c.sim, true, why));
    assert_int_equal(c.sim->count, 2);
    int32_t *cluster = NULL;
    MUST(clusters_find(c.sim, &cluster, why));
    assert_int_equal(cluster[0], 0); /* ids 0, 1, 2 stand at places 0, 2, 1: the last place is outside */
    assert_int_equal(cluster[1], -1);
    assert_int_equal(cluster[2], 0);
    free(cluster);
    case_close(&c);
}

/* A cloud that falls together and sticks here and there. */
static void test_cloud(void **state)
{
    (void)state;
    text t = {0};
    put(&t, "effects: [{slot: normal, law: hertz}, {slot: bond, law: adhesion}]\nseed: 5\ngravity_m_s2: [0, 0, -9.81]\n"
            "materials: [{name: m, density_kg_m3: 2000, youngs_modulus_pa: 1.0e8, poissons_ratio: 0.2}]\n"
            "interactions: [{between: default, normal_damping_ratio: 0, bond_equilibrium_strain: 0.02, bond_damping_ratio: 0.3}]\n"
            "walls: [{name: box, shape: box, low_m: [0, 0, 0], high_m: [0.02, 0.02, 0.1]}]\n"
            "particles: [{name: p, material: m, generator: random, count: 400, radius_m: 0.0008, region: {low_m: [0, 0, 0], high_m: [0.02, 0.02, 0.04]}}]\n");
    physics_case c = case_open(&t);
    int64_t seen = 0;
    for (int n = 0; n < 6; n++) {
        case_run(&c, 3000, 4e-6);
        check_labels(&c);
        cluster_sums sums = measure(&c);
        double grains = 0.0;
        for (int k = 0; k < CLUSTER_CLASSES; k++)
            grains += sums.sizes[k] * (k == 0);
        assert_int_equal((int64_t)grains + sums.grains, 400);
        seen = sums.count > seen ? sums.count : seen;
    }
    assert_true(seen > 10);
    case_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_chains), cmocka_unit_test(test_floor_and_leavers), cmocka_unit_test(test_cloud)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
