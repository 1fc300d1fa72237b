/* Conduction between grains and with walls. */
#include "../property.h"
#include "fields.h"
#include "laws.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* 1/k, finite where nothing conducts. */
static double resistivity(const contact_class *class, int material)
{
    double k = material_value(class, material, &property_conductivity);
    return k > 1e-30 ? 1.0 / k : 1e30;
}

/* t/k of the film on one material, m2 K/W. */
static double film(const contact_class *class, int material)
{
    return material_value(class, material, &property_film_thickness) / material_value(class, material, &property_film_conductivity);
}

/* E* of the simulation over that of the real materials. */
static double softness(const contact_class *class)
{
    double compliance = 0.0;
    const int body[2] = {class->material_a, class->material_b};
    for (int k = 0; k < 2; k++) {
        if (body[k] < 0)
            continue;
        double nu = material_value(class, body[k], &property_poissons_ratio);
        compliance += (1.0 - nu * nu) / material_value(class, body[k], &property_real_modulus);
    }
    return effective_modulus(class) * compliance;
}

/* Factors on the overlap that conducts, and on the conductance. Under the same force overlaps go as E^(-2/3); at the same speed of impact
 * as E^(-2/5), and so does the time of contact. */
static void soften(const contact_class *class, double choice, double *overlap, double *time)
{
    double ratio = choice == 0.0 ? 1.0 : softness(class);
    *overlap = choice == 0.0 ? 1.0 : pow(ratio, choice == 1.0 ? 2.0 / 3.0 : 0.4);
    *time = choice == 2.0 ? pow(ratio, 0.4) : 1.0;
}

#define WALL_OPTION {"wall", "mirror|plane", 0, 0, 0, "a wall is the grain's mirror image, or a plane of its own temperature (twice the heat)"}
#define SOFT_OPTION                                      \
    {                                                    \
        "soft_modulus", "none|static|collisional", 0, 0, 0, \
            "correction where `youngs_modulus_pa` is softer than `real_modulus_pa`: none; for the same heat under the same force; or for the "     \
            "same heat in a collision at the same speed"                                                                                      \
    }

static void wall_constant(double choice, char *text, size_t size)
{
    size_t used = strlen(text);
    snprintf(text + used, size - used, "#define CONDUCTION_WALL_FACTOR %s\n", choice == 0.0 ? "R(1.0)" : "R(2.0)");
}

static void derive_overlap_area(const contact_class *class, const double *option, double *parameter)
{
    int a = class->material_a, b = class->material_b < 0 ? a : class->material_b;
    parameter[0] = resistivity(class, a);
    parameter[1] = resistivity(class, b);
    parameter[2] = film(class, a) + (class->material_b < 0 ? 0.0 : film(class, b));
    soften(class, option[1], &parameter[3], &parameter[4]);
}

static void overlap_area_constants(const double *option, char *text, size_t size)
{
    wall_constant(option[0], text, size);
}

const law law_overlap_area = {
    .name = "overlap_area",
    .slot = SLOT_CONDUCTION,
    .doc = "Heat through the circle in which two spheres cut each other, over the distance of their centres.",
    .source = "TM Eq. 32-35",
    .kernel_file = "effect/conduction_record.cl",
    .more_files = {"effect/conduction_overlap_area.cl"},
    .options = {WALL_OPTION, SOFT_OPTION},
    .material_needs = {&property_conductivity},
    .reads_temperature = true,
    .pair_fields = {&field_heat},
    .particle_fields = {&field_heat},
    .parameters = {"CONDUCTION_RESISTIVITY_I", "CONDUCTION_RESISTIVITY_J", "CONDUCTION_FILM", "CONDUCTION_OVERLAP_FACTOR", "CONDUCTION_TIME_FACTOR"},
    .derive = derive_overlap_area,
    .constants = overlap_area_constants,
};

static void derive_batchelor_obrien(const contact_class *class, const double *option, double *parameter)
{
    double overlap, time, own = resistivity(class, class->material_a), sum = own;
    if (class->material_b >= 0)
        sum += resistivity(class, class->material_b);
    soften(class, option[0], &overlap, &time);
    parameter[0] = 4.0 * time * sqrt(overlap) / sum;
    parameter[1] = own / sum;
}

const law law_batchelor_obrien = {
    .name = "batchelor_obrien",
    .slot = SLOT_CONDUCTION,
    .doc = "Heat through the circle of a Hertz contact between half-spaces: H = 2 a k, at a wall 4 a k.",
    .source = "Batchelor and O'Brien (1977), HC Eq. 9-12 with the harmonic mean",
    .kernel_file = "effect/conduction_record.cl",
    .more_files = {"effect/conduction_batchelor_obrien.cl"},
    .options = {SOFT_OPTION},
    .material_needs = {&property_conductivity},
    .reads_temperature = true,
    .pair_fields = {&field_heat},
    .particle_fields = {&field_heat},
    .parameters = {"CONDUCTION_STRENGTH", "CONDUCTION_SHARE"},
    .derive = derive_batchelor_obrien,
};

static void derive_pipe_network(const contact_class *class, const double *option, double *parameter)
{
    int a = class->material_a, b = class->material_b < 0 ? a : class->material_b;
    parameter[0] = material_value(class, a, &property_conductivity);
    parameter[1] = material_value(class, b, &property_conductivity);
    soften(class, option[1], &parameter[2], &parameter[3]);
}

static void pipe_network_constants(const double *option, char *text, size_t size)
{
    wall_constant(option[0], text, size);
    size_t used = strlen(text);
    snprintf(text + used, size - used, "#define CONDUCTION_DEPTH R(%.17e)\n", option[2]);
}

const law law_pipe_network = {
    .name = "pipe_network",
    .slot = SLOT_CONDUCTION,
    .doc = "Heat between discs, in scenes of two dimensions: each has a conductance by the angle under which it sees the contact.",
    .source = "TM Eq. 36 (Feng et al.)",
    .kernel_file = "effect/conduction_record.cl",
    .more_files = {"effect/conduction_pipe_network.cl"},
    .options = {WALL_OPTION, SOFT_OPTION, {"depth_m", NULL, 0, 1e3, 0, "depth of the discs; 0: the diameter of each"}},
    .material_needs = {&property_conductivity},
    .reads_temperature = true,
    .pair_fields = {&field_heat},
    .particle_fields = {&field_heat},
    .parameters = {"CONDUCTION_K_I", "CONDUCTION_K_J", "CONDUCTION_OVERLAP_FACTOR", "CONDUCTION_TIME_FACTOR"},
    .derive = derive_pipe_network,
    .constants = pipe_network_constants,
};
