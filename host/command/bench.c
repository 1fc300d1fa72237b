/* clast bench */
#include "../bench.h"
#include "../parameter.h"
#include "../settled_bed.h"
#include "../scene.h"
#include "command.h"

#include <stdio.h>
#include <string.h>

enum { KEY_PRECISION = 256, KEY_ROLLING, KEY_EFFECTS, KEY_EXPORT, KEY_JSON };

typedef struct bench_input {
    const char *what;
    bench_options options;
    device_options device;
} bench_input;

static void check_what(const struct argp_state *state, const char *what)
{
    static const char *const known[] = {"bed", "effects", "kernels", "tune"};
    if (!what)
        option_refuse(state, "which benchmark? This version has `bed`");
    if (strcmp(what, "bed") == 0)
        return;
    const char *nearest = word_nearest(what, known, 4);
    if (nearest && strcmp(nearest, what) == 0)
        option_refuse(state, "the benchmark `%s` is not in this version, which has `bed`", what);
    option_refuse(state, "there is no benchmark `%s`; this version has `bed`", what);
}

static void read_effects_option(const struct argp_state *state, const char *argument, unsigned *effects)
{
    for (const char *word = argument; *word;) {
        size_t length = strcspn(word, ",");
        char one[32];
        snprintf(one, sizeof one, "%.*s", (int)(length < sizeof one ? length : sizeof one - 1), word);
        int index = words_find(bed_effect_words, one);
        if (index < 0)
            option_refuse(state, "--effects: there is no effect `%s`; this version has rolling, conduction, convection and radiation", one);
        *effects |= 1u << index;
        word += length + (word[length] == ',');
    }
}

static error_t parse_bench(int key, char *argument, struct argp_state *state)
{
    bench_input *input = state->input;
    precision found;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &input->device;
        return 0;
    case 'n':
        input->options.particles = option_count(state, "--particles", argument, 100, 1000000000);
        return 0;
    case 'S':
        input->options.steps = option_count(state, "--steps", argument, 1, 1000000000000);
        return 0;
    case KEY_PRECISION:
        if (!precision_find(argument, &found))
            option_refuse(state, "--precision: `%s` is none of auto, double, mixed", argument);
        input->options.mixed = found == PRECISION_MIXED;
        return 0;
    case KEY_EFFECTS:
        read_effects_option(state, argument, &input->options.effects);
        return 0;
    case KEY_ROLLING:
        input->options.effects |= BED_ROLLING;
        return 0;
    case KEY_EXPORT:
        input->options.export_path = argument;
        return 0;
    case KEY_JSON:
        input->options.json_path = argument;
        return 0;
    case ARGP_KEY_ARG:
        option_only(state, &input->what, argument);
        return 0;
    case ARGP_KEY_END:
        check_what(state, input->what);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_option bench_option[] = {
    {"particles", 'n', "N", 0, "Number of particles, as in 1e5 (100000)", 0},
    {"steps", 'S', "STEPS", 0, "Steps that are timed, after 200 of warm-up", 0},
    {"precision", KEY_PRECISION, "P", 0, "auto, double or mixed", 0},
    {"rolling", KEY_ROLLING, NULL, 0, "With rolling resistance", 0},
    {"effects", KEY_EFFECTS, "A,B,...", 0, "With these on top of contact and friction, of rolling, conduction, convection, radiation", 0},
    {"export", KEY_EXPORT, "FILE.csv", 0, "Write the bed as it is before the warm-up", 0},
    {"json", KEY_JSON, "FILE.json", 0, "Write the figures as JSON", 0},
    {0},
};
static const struct argp_child bench_children[] = {{.argp = &device_options_argp}, {0}};
static const struct argp bench_argp = {
    .options = bench_option,
    .parser = parse_bench,
    .args_doc = "bed",
    .doc = "Time a settled bed in a box with five frictional walls.\vA settled bed of up to 20,000 particles is made once and kept in"
           " ${XDG_CACHE_HOME:-~/.cache}/clast; larger beds are tiled from it.",
    .children = bench_children,
};

status command_bench(int argc, char **argv, failure *why)
{
    bench_input input = {.options = bench_options_default()};
    error_t error = argp_parse(&bench_argp, argc, argv, 0, NULL, &input);
    if (error)
        return fail(why, STATUS_ERROR, "%s", strerror(error));
    input.options.device = input.device.device;
    input.options.kernels = input.device.kernels;
    return bench_bed(&input.options, why);
}
