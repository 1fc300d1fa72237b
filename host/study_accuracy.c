#include "bed.h"
#include "crew.h"
#include "study.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Settings that leave what the scene is as it is: closed forms still hold with them. */
static bool changes_nothing(const char *set)
{
    static const char *const harmless[] = {"study.", "output", "contact_table.", "guards.", "title=", "integrator=", "precision="};
    for (size_t k = 0; k < sizeof harmless / sizeof *harmless; k++)
        if (strncmp(set, harmless[k], strlen(harmless[k])) == 0)
            return true;
    return false;
}

/* The scene's own settings for studies first, so that the user's are stronger. */
static status read_scene(study *s, failure *why)
{
    const run_options *o = &s->options->run;
    scene *first = NULL;
    TRY(scene_read(o->scene_path, o->set_count, o->sets, &first, why));
    status result = STATUS_OK;
    for (int k = 0; k < first->study.set_count && result == STATUS_OK; k++) {
        study_add_set(&s->base, &s->base_count, "%s", first->study.set[k]);
        if (!strchr(first->study.set[k], '='))
            result = fail(why, STATUS_BAD_INPUT, "%s: study.set[%d]: `%s`: write PATH=VALUE", first->path, k, first->study.set[k]);
    }
    scene_free(first);
    TRY(result);
    s->closed_forms_hold = true;
    for (int k = 0; k < o->set_count; k++) {
        study_add_set(&s->base, &s->base_count, "%s", o->sets[k]);
        s->closed_forms_hold = s->closed_forms_hold && changes_nothing(o->sets[k]);
    }
    TRY(scene_read(o->scene_path, s->base_count, s->base, &s->scene, why));
    TRY(answer_check_study(s->scene, why));
    if (!s->closed_forms_hold && s->scene->study.closed_form_count > 0)
        fprintf(stderr, "the scene's closed forms are left aside: --set has changed what they hold for\n");
    s->seeds = s->scene->study.seeds > 1 ? (int)s->scene->study.seeds : 1;
    return STATUS_OK;
}

static status find_answers(study *s, failure *why)
{
    const scene *scene = s->scene;
    s->answer_count = scene->study.answer_count;
    if (s->answer_count == 0)
        return fail(why, STATUS_BAD_INPUT, "%s: the scene names no answers; add them, like study: {answers: [kinetic_energy]}",
                    scene->path);
    s->answer = scene_allocate((size_t)s->answer_count, sizeof *s->answer);
    for (int a = 0; a < s->answer_count; a++)
        TRY(answer_find(scene, scene->study.answers[a], &s->answer[a], why));
    return STATUS_OK;
}

static status find_grains(study *s, failure *why)
{
    bed bed;
    TRY(bed_generate(s->scene, &bed, why));
    s->first = scene_allocate((size_t)s->scene->group_count + 1, sizeof *s->first);
    for (int64_t i = 0; i < bed.count; i++)
        s->first[bed.group[i] + 1] = i + 1;
    for (int g = 0; g < s->scene->group_count; g++)
        s->first[g + 1] = s->first[g + 1] > s->first[g] ? s->first[g + 1] : s->first[g];
    s->grains = bed.count;
    bed_free(&bed);
    for (int a = 0; a < s->answer_count; a++) {
        const answer *answer = &s->answer[a];
        if (answer->group >= 0 && answer->item >= s->first[answer->group + 1] - s->first[answer->group])
            return fail(why, STATUS_BAD_INPUT, "%s: the answer `%s`: the group has %lld grains, counted from 0", s->scene->path,
                        answer->text, (long long)(s->first[answer->group + 1] - s->first[answer->group]));
    }
    return STATUS_OK;
}

/* Where only times end the stages, answers are compared at samples; else at the end alone. */
static status find_samples(study *s, failure *why)
{
    const scene *scene = s->scene;
    s->duration_s = 0.0;
    if (scene->stage_count > STUDY_STAGES_MAX)
        return fail(why, STATUS_BAD_INPUT, "%s: has %d stages; a study can follow %d", scene->path, scene->stage_count, STUDY_STAGES_MAX);
    for (int t = 0; t < scene->stage_count; t++) {
        const scene_stage *stage = &scene->stage[t];
        if (study_moves(stage) && stage->until_steps >= 0)
            return fail(why, STATUS_BAD_INPUT,
                        "%s:%d:%d: stage %s ends after a number of steps, which is another time for every step; a study needs `time_s`, "
                        "`rest` or `rest_j`",
                        scene->path, stage->at.line, stage->at.column, stage->name);
        if (stage->frozen && stage->until_steps >= 0 && isnan(stage->until_time_s))
            continue; /* takes no time, or none that counts */
        bool by_time = isnan(stage->until_rest) && isnan(stage->until_rest_j) && isnan(stage->until_steady_k_s);
        s->duration_s += by_time ? stage->until_time_s : NAN;
    }
    s->interval_s = s->duration_s / (double)scene->study.samples;
    if (s->seeds > 1 && scene->study.average_from_s > s->duration_s)
        return fail(why, STATUS_BAD_INPUT, "%s: study.average_from_s is %g s, after the end of the run at %g s", scene->path,
                    scene->study.average_from_s, s->duration_s);
    return STATUS_OK;
}

static void add_word(char *list, size_t size, const char *word)
{
    char quoted[160], all[2200];
    snprintf(quoted, sizeof quoted, "|%s|", word);
    snprintf(all, sizeof all, "|%s|", list);
    for (char *c = all; *c; c++)
        *c = *c == ',' ? '|' : *c;
    size_t used = strlen(list);
    if (!strstr(all, quoted))
        snprintf(list + used, size - used, "%s%s", used ? "," : "", word);
}

/* Results hold the answers at the samples and nothing else, so that runs are timed without output. */
static void set_output(study *s)
{
    char fields[2048] = "", observables[2048] = "", every[64] = "";
    for (int a = 0; a < s->answer_count; a++) {
        const answer *answer = &s->answer[a];
        if (answer->group >= 0)
            add_word(fields, sizeof fields, answer->source);
        else if (strncmp(answer->source, "walls/", 6) != 0)
            add_word(observables, sizeof observables, answer->source);
    }
    if (!isnan(s->interval_s))
        snprintf(every, sizeof every, "every_s: %.17g, ", s->interval_s);
    study_add_set(&s->base, &s->base_count, "output={%sfields: [%s], observables: [%s]}", every, fields, observables);
}

static void expect_orders(study *s)
{
    for (int c = 0; c < s->curve_count; c++) {
        int count;
        failure ignored;
        scene *scene = NULL;
        study_point none = {.curve = c};
        char **set = study_sets(s, &none, NULL, 0, &count);
        if (s->curve[c].ladder == LADDER_STEP && s->seeds == 1 && !s->curve[c].other_model &&
            scene_read(s->options->run.scene_path, count, set, &scene, &ignored) == STATUS_OK)
            study_expected_order(scene, s->curve[c].expected, sizeof s->curve[c].expected);
        scene_free(scene);
        for (int k = 0; k < count; k++)
            free(set[k]);
        free(set);
    }
}

static status check_choices(const study_options *o, failure *why)
{
    for (const char *at = o->choices; at && *at; at += at[0] == ',') {
        size_t length = strcspn(at, ",");
        bool known = false;
        for (int k = 0; study_choice_names[k]; k++)
            known |= strlen(study_choice_names[k]) == length && strncmp(at, study_choice_names[k], length) == 0;
        if (!known)
            return fail(why, STATUS_BAD_INPUT, "--choices: `%.*s` is none; `clast study accuracy --help` lists them", (int)length, at);
        at += length;
    }
    return STATUS_OK;
}

static status prepare(study *s, failure *why)
{
    char runs[4200];
    TRY(check_choices(s->options, why));
    TRY(read_scene(s, why));
    TRY(find_answers(s, why));
    TRY(find_grains(s, why));
    TRY(find_samples(s, why));
    TRY(crew_folder(s->options->run.out, why));
    snprintf(runs, sizeof runs, "%s/runs", s->options->run.out);
    TRY(crew_folder(runs, why));
    set_output(s);
    s->probe = crew_shared(sizeof *s->probe * 64);
    return s->probe ? STATUS_OK : fail(why, STATUS_ERROR, "out of memory");
}

static void free_texts(char **text, int count)
{
    for (int k = 0; k < count; k++)
        free(text[k]);
    free(text);
}

static void study_free(study *s)
{
    for (int r = 0; r < s->run_count; r++) {
        for (int a = 0; s->run && s->run[r].answer && a < s->answer_count; a++)
            answer_free(&s->run[r].answer[a]);
        if (s->run)
            free(s->run[r].answer);
    }
    for (int p = 0; p < s->point_count; p++) {
        free_texts(s->point[p].set, s->point[p].set_count);
        free(s->point[p].answer_error);
    }
    for (int c = 0; c < s->curve_count; c++) {
        free_texts(s->curve[c].set, s->curve[c].set_count);
        free(s->curve[c].answer_order);
    }
    for (int p = 0; p < s->probe_count; p++)
        free_texts(s->probe[p].set, s->probe[p].set_count);
    for (int a = 0; s->reference && a < s->answer_count; a++)
        free(s->reference[a]);
    free(s->reference);
    free(s->reference_floor);
    free(s->scale);
    free(s->run);
    free(s->point);
    free(s->curve);
    free(s->answer);
    free(s->first);
    free_texts(s->base, s->base_count);
    scene_free(s->scene);
}

status study_accuracy(const study_options *options, failure *why)
{
    study s = {.options = options};
    status result;
    crew_catch_signals();
    TRY_GOTO(result, done, prepare(&s, why));
    TRY_GOTO(result, done, study_choose(&s, why));
    expect_orders(&s);
    TRY_GOTO(result, done, study_fill_probes(&s, why));
    TRY_GOTO(result, done, study_lay_ladders(&s, why));
    TRY_GOTO(result, done, study_run_all(&s, why));
    TRY_GOTO(result, done, study_calibrate(&s, why));
    TRY_GOTO(result, done, study_compare(&s, why));
    TRY_GOTO(result, done, study_write(&s, why));
    study_print(&s);
done:
    study_free(&s);
    return result;
}
