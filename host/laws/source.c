/* Beams that heat. A scene lists the two laws at the top, as often as it likes; its programs hold one of those below, by the attenuations that
 * occur and the number of directions that depths are kept for. */
#include "../property.h"
#include "../scene.h"
#include "fields.h"
#include "laws.h"

#include <clast/shared.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* clang-format off */
#define PROFILE  {"profile", "top_hat|gaussian", 0, 0, 0, "even over the diameter; or Gaussian, 1/e2 of the axis' intensity at half the diameter"}
#define DIAMETER {"diameter_m", NULL, 1e-12, 1e12, NAN, "diameter of the beam"}
#define INTERVAL {"surface_every_steps", NULL, 1, 1e9, 100, "steps between two searches for the bed's surface; of several sources the smallest counts"}

const law law_laser = {
    .name = "laser",
    .slot = SLOT_SOURCE,
    .doc = "A laser beam, attenuated exponentially with the depth below the bed's surface.",
    .source = "TM Eq. 29 and 31",
    .kernel_file = "effect/source_laser.cl",
    .options = {PROFILE, DIAMETER, {"attenuation_1_m", NULL, 0, 1e12, NAN, "attenuation coefficient of the bed"}, INTERVAL},
    .material_needs = {&property_absorptance},
};

const law law_burner = {
    .name = "burner",
    .slot = SLOT_SOURCE,
    .doc = "A burner, attenuated linearly down to its largest depth below the bed's surface.",
    .source = "TM Eq. 29 and 30",
    .kernel_file = "effect/source_burner.cl",
    .options = {PROFILE, DIAMETER, {"depth_max_m", NULL, 1e-12, 1e12, NAN, "depth that the heat reaches"}, INTERVAL},
    .material_needs = {&property_absorptance},
};
/* clang-format on */

static bool lists(const scene *s, const law *l)
{
    for (int e = 0; e < s->effect_count; e++)
        if (s->effect[e].law == l)
            return true;
    return false;
}

static void beam_constants(const scene *s, char *text, size_t size)
{
    size_t used = strlen(text);
    bool laser = lists(s, &law_laser), burner = lists(s, &law_burner);
    snprintf(text + used, size - used, "#define BEAM_COUNT %d\n#define BEAM_SIDES %d\n#define BEAM_PASSES(b, s) %s\n", scene_beam_count(s),
             scene_beam_sides(s),
             laser && burner ? "((b)->law == 0 ? beam_laser((b), (s)) : beam_burner((b), (s)))" :
             laser           ? "beam_laser((b), (s))" :
                               "beam_burner((b), (s))");
}

static void derive_absorptance(const scene *scene, int stage, int material, const double *option, double *parameter)
{
    (void)stage;
    (void)option;
    parameter[0] = scene_material(scene, material, &property_absorptance);
}

/* clang-format off */
#define BEAMS(sides, first, ...)                                                \
    {.name = "beams",                                                           \
     .slot = SLOT_SOURCE,                                                       \
     .doc = "Beams that heat.",                                                 \
     .source = "TM Eq. 29",                                                     \
     .kernel_file = first,                                                      \
     .more_files = {__VA_ARGS__},                                               \
     .particle_fields = {&field_beams, &field_depth[sides - 1], &field_beam_meets}, \
     .grain_parameters = {"SOURCE_ABSORPTANCE"},                                \
     .derive_grain = derive_absorptance,                                        \
     .scene_constants = beam_constants}
#define BY_SIDES(...) {BEAMS(1, __VA_ARGS__), BEAMS(2, __VA_ARGS__), BEAMS(3, __VA_ARGS__), BEAMS(4, __VA_ARGS__)}
/* clang-format on */

static const law lasers[CLAST_BEAM_SIDES_MAX] = BY_SIDES("effect/source_laser.cl", "effect/source_beams.cl");
static const law burners[CLAST_BEAM_SIDES_MAX] = BY_SIDES("effect/source_burner.cl", "effect/source_beams.cl");
static const law both[CLAST_BEAM_SIDES_MAX] = BY_SIDES("effect/source_laser.cl", "effect/source_burner.cl", "effect/source_beams.cl");

const law *law_of_beams(const scene *s)
{
    const law *of = !lists(s, &law_burner) ? lasers : !lists(s, &law_laser) ? burners : both;
    return &of[scene_beam_sides(s) - 1];
}
