/* clast run, clast resume */
#include "../sweep.h"
#include "command.h"

enum { KEY_SWEEP = 256, KEY_PRECISION, KEY_JOBS };

typedef struct run_input {
    scene_input scene;
    set_options sweep;
    int jobs;
} run_input;

static error_t parse_run(int key, char *argument, struct argp_state *state)
{
    run_input *input = state->input;
    run_options *options = &input->scene.run;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &input->scene;
        return 0;
    case 'o':
        options->out = argument;
        return 0;
    case 'q':
        options->quiet = true;
        return 0;
    case KEY_PRECISION:
        options->precision = option_precision(state, argument);
        return 0;
    case KEY_SWEEP:
        return option_add(state, "--sweep", "A,B,C", &input->sweep, argument);
    case KEY_JOBS:
        input->jobs = (int)option_count(state, "--jobs", argument, 1, 10000);
        return 0;
    case ARGP_KEY_END:
        if (!options->out)
            option_refuse(state, "where to? Name the results file: --out RESULT.h5 (with --sweep a folder)");
        if (input->jobs > 0 && input->sweep.count == 0)
            option_refuse(state, "--jobs: there is no --sweep to spread over them");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

typedef struct resume_input {
    run_options options;
    device_options device;
} resume_input;

static error_t parse_resume(int key, char *argument, struct argp_state *state)
{
    resume_input *input = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &input->device;
        return 0;
    case 'o':
        input->options.out = argument;
        return 0;
    case 'q':
        input->options.quiet = true;
        return 0;
    case ARGP_KEY_ARG:
        option_only(state, &input->options.checkpoint_path, argument);
        return 0;
    case ARGP_KEY_END:
        if (!input->options.checkpoint_path)
            option_refuse(state, "from where? Name a CHECKPOINT.h5");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_option run_option[] = {
    {"out", 'o', "RESULT.h5", 0, "Results file; an XDMF file and the checkpoint get the same stem", 0},
    {"precision", KEY_PRECISION, "P", 0, "auto, double or mixed, instead of the scene's", 0},
    {"sweep", KEY_SWEEP, "PATH=A,B,C", 0,
     "Run once for each value, into the folder --out, with one table (sweep.csv); repeated: every combination", 0},
    {"jobs", KEY_JOBS, "N", 0, "Runs of a sweep at a time (default: one a core where beds are small)", 0},
    {"quiet", 'q', NULL, 0, "Show neither progress nor warnings", 0},
    {0},
};
static const struct argp_child run_children[] = {{.argp = &scene_input_argp}, {0}};
static const struct argp run_argp = {
    .options = run_option,
    .parser = parse_run,
    .args_doc = "SCENE.yaml",
    .doc =
        "Run a scene from its beginning to its end and write the results.\vCtrl-C ends a run with a checkpoint, from which `clast resume`"
        " goes on.",
    .children = run_children,
};

static const struct argp_option resume_option[] = {
    {"out", 'o', "RESULT.h5", 0, "Start a new results file instead of going on with the run's own", 0},
    {"quiet", 'q', NULL, 0, "Show neither progress nor warnings", 0},
    {0},
};
static const struct argp_child resume_children[] = {{.argp = &device_options_argp}, {0}};
static const struct argp resume_argp = {
    .options = resume_option,
    .parser = parse_resume,
    .args_doc = "CHECKPOINT.h5",
    .doc =
        "Go on with a run from its checkpoint.\vThe results go on in the file of the run, from which frames later than the checkpoint are"
        " cut first, or in a new file with --out.",
    .children = resume_children,
};

status command_run(int argc, char **argv, failure *why)
{
    run_input input = {0};
    status result;
    TRY(command_parse(&run_argp, 0, argc, argv, &input, why));
    if (input.sweep.count > 0) {
        const sweep_options sweep = {input.scene.run, input.sweep.count, input.sweep.value, input.jobs};
        result = sweep_run(&sweep, why);
    } else {
        run_catch_signals();
        result = run_scene(&input.scene.run, why);
    }
    set_options_free(&input.sweep);
    scene_input_free(&input.scene);
    return result;
}

status command_resume(int argc, char **argv, failure *why)
{
    resume_input input = {0};
    TRY(command_parse(&resume_argp, 0, argc, argv, &input, why));
    input.options.device = input.device.device;
    input.options.kernels = input.device.kernels;
    run_catch_signals();
    return run_resume(&input.options, why);
}
