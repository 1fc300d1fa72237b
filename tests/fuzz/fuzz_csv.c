/* Any file is a table of grains or is refused with a message; the grains of a table have places and radii that are numbers. */
#include "bed.h"
#include "fuzz.h"
#include "scene.h"

#include <math.h>

static const char *const yaml = "effects: []\n"
                                "materials: [{name: m, density_kg_m3: 1000}]\n"
                                "particles: [{name: p, material: m, generator: csv, file: %s}]\n"
                                "stages: [{name: s, until: {steps: 1}}]\n";

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    failure why = {""};
    scene *read = NULL;
    bed bed = {0};
    char path[64], text[512];
    int file = fuzz_file(data, size, path, sizeof path);
    snprintf(text, sizeof text, yaml, path);
    FUZZ_HOLDS(scene_read_text(text, "fuzz.yaml", 0, NULL, &read, &why) == STATUS_OK);
    status result = bed_generate(read, &bed, &why);
    FUZZ_HOLDS(result == STATUS_OK || (why.text[0] && result == STATUS_BAD_INPUT));
    for (int64_t n = 0; result == STATUS_OK && n < bed.count; n++) {
        FUZZ_HOLDS(isfinite(bed.position[n][0]) && isfinite(bed.position[n][1]) && isfinite(bed.position[n][2]));
        FUZZ_HOLDS(isfinite(bed.radius[n]) && bed.radius[n] > 0.0);
    }
    if (result == STATUS_OK)
        bed_free(&bed);
    scene_free(read);
    close(file);
    return 0;
}
