/* clast bench */
#include "../bench.h"
#include "../parameter.h"
#include "../scene.h"
#include "../settled_bed.h"
#include "command.h"

#include <stdio.h>
#include <string.h>

enum {
    KEY_PRECISION = 256,
    KEY_ROLLING,
    KEY_EFFECTS,
    KEY_EXPORT,
    KEY_JSON,
    KEY_CSV,
    KEY_SECONDS,
    KEY_ONLY,
    KEY_SCENES,
    KEY_FORGET,
    KEY_STEP_FORM,
    KEY_RATIO,
    KEY_SHARE
};

/* A benchmark, and the options that it takes beside device, kernels and number of particles. */
typedef struct benchmark {
    const char *name;
    status (*run)(const bench_options *options, failure *why);
} benchmark;

static const benchmark benchmarks[] = {{"bed", bench_bed}, {"effects", bench_effects}, {"kernels", bench_kernels}, {"tune", bench_tune}};
#define BENCHMARKS (sizeof benchmarks / sizeof *benchmarks)

static const benchmark *find_benchmark(const struct argp_state *state, const char *what)
{
    if (!what)
        option_refuse(state, "which benchmark? There are `bed`, `effects`, `kernels` and `tune`");
    for (size_t n = 0; n < BENCHMARKS; n++)
        if (strcmp(benchmarks[n].name, what) == 0)
            return &benchmarks[n];
    option_refuse(state, "there is no benchmark `%s`; there are `bed`, `effects`, `kernels` and `tune`", what);
    return NULL;
}

typedef struct bench_input {
    const char *what;
    const benchmark *chosen;
    bench_options options;
    device_options device;
} bench_input;

/* In the order of step_form. */
static step_form read_form(struct argp_state *state, const char *word)
{
    static const char *const forms[] = {"auto", "two_kernels", "one_group", "phases", "team"};
    for (size_t f = 0; f < sizeof forms / sizeof *forms; f++)
        if (strcmp(word, forms[f]) == 0)
            return (step_form)f;
    option_refuse(state, "--step-form: `%s` is none of auto, two_kernels, one_group, phases, team", word);
    return STEP_AUTO;
}

static void read_effects_option(const struct argp_state *state, const char *argument, unsigned *effects)
{
    for (const char *word = argument; *word;) {
        size_t length = strcspn(word, ",");
        char one[32];
        snprintf(one, sizeof one, "%.*s", (int)(length < sizeof one ? length : sizeof one - 1), word);
        int index = words_find(bed_effect_words, one);
        if (index < 0)
            option_refuse(state,
                          "--effects: there is no effect `%s`; this version has rolling, conduction, convection, radiation and bonds", one);
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
        precision_find(option_precision(state, argument), &found);
        input->options.mixed = found == PRECISION_MIXED;
        return 0;
    case KEY_STEP_FORM:
        input->options.form = read_form(state, argument);
        return 0;
    case KEY_RATIO:
        input->options.sizes.ratio = option_number(state, "--size-ratio", argument, 1.0, 50.0);
        return 0;
    case KEY_SHARE:
        input->options.sizes.large_share = option_number(state, "--large-share", argument, 0.0, 1.0);
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
    case KEY_CSV:
        input->options.csv_path = argument;
        return 0;
    case KEY_SECONDS:
        input->options.seconds = (double)option_count(state, "--seconds", argument, 1, 1000000);
        return 0;
    case KEY_ONLY:
        input->options.only = argument;
        return 0;
    case KEY_SCENES:
        input->options.scenes = argument;
        return 0;
    case KEY_FORGET:
        input->options.forget = true;
        return 0;
    case ARGP_KEY_ARG:
        option_only(state, &input->what, argument);
        return 0;
    case ARGP_KEY_END:
        input->chosen = find_benchmark(state, input->what);
        if ((input->options.sizes.ratio > 1.0) != (input->options.sizes.large_share > 0.0))
            option_refuse(state, "--size-ratio and --large-share come together: how large, and how many");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_option bench_option[] = {
    {"particles", 'n', "N", 0, "Number of particles, as in 1e5 (100000)", 0},
    {"steps", 'S', "STEPS", 0, "Steps that are timed, after 200 of warm-up", 0},
    {"precision", KEY_PRECISION, "P", 0, "auto, double or mixed", 0},
    {"step-form", KEY_STEP_FORM, "FORM", 0,
     "How `bed` takes its steps: auto, two_kernels, one_group, phases or team, as in contact_table.step_form", 0},
    {"size-ratio", KEY_RATIO, "X", 0, "With some grains X times as large as the others, and all X times as stiff (bed, kernels)", 0},
    {"large-share", KEY_SHARE, "F", 0, "The share of large grains by number, as 0.01", 0},
    {"rolling", KEY_ROLLING, NULL, 0, "With rolling resistance", 0},
    {"effects", KEY_EFFECTS, "A,B,...", 0,
     "With these on top of contact and friction, of rolling, conduction, convection, radiation, bonds", 0},
    {"export", KEY_EXPORT, "FILE.csv", 0, "Write the bed as it is before the warm-up", 0},
    {"json", KEY_JSON, "FILE.json", 0, "Write the figures as JSON", 0},
    {"csv", KEY_CSV, "FILE.csv", 0, "Write them as CSV (effects, kernels)", 0},
    {"seconds", KEY_SECONDS, "S", 0, "Time that `effects` may take, about 240", 0},
    {"only", KEY_ONLY, "WORD,...", 0, "Of the cases of `effects` those that have one of these words in their name", 0},
    {"forget", KEY_FORGET, NULL, 0, "Drop what `tune` has kept for this device", 0},
    {"scenes", KEY_SCENES, "FOLDER", 0, "Write the scenes of `effects` there and measure nothing", 0},
    {0},
};
static const struct argp_child bench_children[] = {{.argp = &device_options_argp}, {0}};
static const struct argp bench_argp = {
    .options = bench_option,
    .parser = parse_bench,
    .args_doc = "bed|effects|kernels|tune",
    .doc = "Time a settled bed in a box with five frictional walls: a step, what every law adds to it, or every kernel; or find"
           " what is fastest on this device and keep it for later runs (tune).\vA settled bed of up to 20,000 particles is made once and "
           "kept in"
           " ${XDG_CACHE_HOME:-~/.cache}/clast; larger beds are tiled from it.",
    .children = bench_children,
};

status command_bench(int argc, char **argv, failure *why)
{
    bench_input input = {.options = bench_options_default()};
    TRY(command_parse(&bench_argp, 0, argc, argv, &input, why));
    input.options.device = input.device.device;
    input.options.kernels = input.device.kernels;
    return input.chosen->run(&input.options, why);
}
