/* Equal spheres side by side on the plane z = 0, each in a lane along y, under a gravity that may lean along x: what the tests of friction
 * and rolling share. Every sphere starts at its overlap at rest. */
#ifndef CLAST_TESTS_ON_PLANE_H
#define CLAST_TESTS_ON_PLANE_H
#include "case.h"

#define G 9.81

static const double young = 1.0e7, poisson = 0.3, density = 2500.0, radius = 5.0e-3;

typedef struct lane {
    const char *interaction; /* of the sphere's material and the plane, e.g. "friction_static: 0.3" */
    double vx, vy, wx, wy, wz;
} lane;

static inline double plane_modulus(void)
{
    return young / (1.0 - poisson * poisson);
}

/* G* at a wall, as TM prints it. */
static inline double plane_shear_modulus(void)
{
    return young / (2.0 * (1.0 + poisson));
}

static inline double lane_mass(void)
{
    return sphere_mass(density, radius);
}

static inline double rest_overlap(double slope)
{
    return hertz_rest(plane_modulus(), radius, lane_mass() * G * cos(slope));
}

/* Arm of friction over the radius. */
static inline double arm_share(double slope)
{
    return 1.0 - rest_overlap(slope) / radius;
}

/* Always the same number of materials, so that cases share programs. */
#define LANES 4

static inline physics_case lanes_open(const char *effects, double slope, const lane *lanes, int count)
{
    text t = {0};
    assert_in_range(count, 1, LANES);
    put(&t, "gravity_m_s2: [%.17g, 0, %.17g]\neffects:\n%s\nmaterials:\n", G * sin(slope), -G * cos(slope), effects);
    for (int k = 0; k < LANES; k++)
        put(&t, "  - {name: m%d, density_kg_m3: %.17g, youngs_modulus_pa: %.17g, poissons_ratio: %.17g}\n", k, density, young, poisson);
    put(&t, "interactions:\n  - {between: default, friction_static: 0, rolling_friction: 0, normal_stiffness_n_m: 1, "
            "tangential_stiffness_n_m: 1}\n");
    for (int k = 0; k < count; k++)
        put(&t, "  - {between: [m%d, floor], %s}\n", k, lanes[k].interaction);
    put(&t, "walls: [{name: floor, shape: plane, point_m: [0, 0, 0], normal: [0, 0, 1]}]\nparticles:\n");
    for (int k = 0; k < count; k++) {
        put(&t, "  - name: p%d\n    material: m%d\n    generator: list\n    items:\n", k, k);
        put_grain(&t, radius, (double[]){0, 4.0 * radius * k, radius - rest_overlap(slope)}, (double[]){lanes[k].vx, lanes[k].vy, 0},
                  (double[]){lanes[k].wx, lanes[k].wy, lanes[k].wz});
    }
    return case_open(&t);
}

static inline double vx_of(physics_case *c, int lane)
{
    return case_get(c, "velocity", lane, 0);
}

static inline double x_of(physics_case *c, int lane)
{
    return case_get(c, "position", lane, 0);
}

static inline double wy_of(physics_case *c, int lane)
{
    return case_get(c, "spin", lane, 1);
}

#endif
