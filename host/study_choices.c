/* The choices of a study, read off the parameter table and the descriptors of laws: nothing here names a law. */
#include "laws/laws.h"
#include "property.h"
#include "scene_table.h"
#include "study.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WORDS_MAX 16

const char *const study_choice_names[] = {"integrator", "precision", "modulus", "heat_steps", "solver", "frozen", "law", NULL};
const char *const study_choice_docs[] = {"every integrator",
                                         "every precision",
                                         "Young's moduli divided by up to a thousand, with and without the corrections that laws offer",
                                         "heat advanced every n-th step",
                                         "methods and tolerances of frozen heat",
                                         "motion frozen where it is free, and free where it is frozen",
                                         "other normal laws whose properties the scene has",
                                         NULL};
bool study_wants(const study *s, const char *choice)
{
    const char *at = s->options->choices;
    size_t length = strlen(choice);
    if (!at)
        return true;
    for (; *at; at += at[0] == ',') {
        size_t word = strcspn(at, ",");
        if (word == length && strncmp(at, choice, length) == 0)
            return true;
        at += word;
    }
    return false;
}

void study_add_set(char ***set, int *count, const char *format, ...)
{
    va_list values;
    char text[1024];
    va_start(values, format);
    vsnprintf(text, sizeof text, format, values);
    va_end(values);
    char **grown = realloc(*set, sizeof *grown * (size_t)(*count + 1));
    if (!grown)
        abort();
    *set = grown;
    grown[(*count)++] = scene_copy(text);
}

int study_add_curve(study *s, ladder along, const char *format, ...)
{
    va_list values;
    study_curve *grown = realloc(s->curve, sizeof *grown * (size_t)(s->curve_count + 1));
    if (!grown)
        abort();
    s->curve = grown;
    study_curve *c = &grown[s->curve_count];
    *c = (study_curve){.ladder = along, .order = NAN, .step_cost_s = NAN, .probe = -1, .costs_like = -1};
    va_start(values, format);
    vsnprintf(c->label, sizeof c->label, format, values);
    va_end(values);
    return s->curve_count++;
}

study_point *study_add_point(study *s, int curve, int probe)
{
    study_point *grown = realloc(s->point, sizeof *grown * (size_t)(s->point_count + 1));
    if (!grown)
        abort();
    s->point = grown;
    study_point *p = &grown[s->point_count++];
    *p = (study_point){.curve = curve,
                       .probe = probe,
                       .level = -1,
                       .parameter = NAN,
                       .step_s = NAN,
                       .steps = NAN,
                       .time_s = NAN,
                       .wall_s = NAN,
                       .error = NAN,
                       .bar = NAN,
                       .uncertainty = NAN};
    p->answer_error = scene_allocate((size_t)s->answer_count, sizeof *p->answer_error);
    return p;
}

bool study_moves(const scene_stage *stage)
{
    return !stage->frozen;
}

/* ---- what the table and the descriptors offer ---- */

static const parameter *find_row(const section *in, const char *key)
{
    for (const parameter *row = in->row; row->key; row++)
        if (strcmp(row->key, key) == 0)
            return row;
    return NULL;
}

/* Words of a row's choices, without those that leave the choice open or answer another question. */
static int choices_of(const parameter *row, const char *except, char word[WORDS_MAX][40])
{
    int count = 0;
    for (const char *at = row->choices; *at && count < WORDS_MAX;) {
        size_t length = strcspn(at, "|");
        snprintf(word[count], sizeof word[count], "%.*s", (int)length, at);
        count += words_find(except, word[count]) < 0;
        at += length + (at[length] == '|');
    }
    return count;
}

static const char *own_integrator(const study *s, char word[WORDS_MAX][40])
{
    return word[(int)s->scene->integrator];
}

static bool has_frozen_heat(const scene *scene)
{
    bool found = false;
    for (int t = 0; t < scene->stage_count; t++)
        found |= scene->stage[t].frozen && scene->stage[t].heat_method != HEAT_STEADY;
    return found;
}

static int add_probe(study *s, int curve)
{
    study_probe *p = &s->probe[s->probe_count];
    const study_curve *c = &s->curve[curve];
    for (int k = 0; k < c->set_count; k++)
        study_add_set(&p->set, &p->set_count, "%s", c->set[k]);
    return s->probe_count++;
}

static void set_basis(study *s, int curve, const char *integrator, const char *precision)
{
    study_curve *c = &s->curve[curve];
    snprintf(c->integrator, sizeof c->integrator, "%.39s", integrator);
    snprintf(c->precision, sizeof c->precision, "%.15s", precision);
    study_add_set(&c->set, &c->set_count, "integrator=%s", integrator);
    study_add_set(&c->set, &c->set_count, "precision=%s", precision);
}

/* ---- curves ---- */

static void choose_steps(study *s)
{
    char integrator[WORDS_MAX][40], precision[WORDS_MAX][40];
    int integrators = choices_of(find_row(&scene_section, "integrator"), "", integrator);
    int precisions = choices_of(find_row(&scene_section, "precision"), "auto", precision);
    for (int i = 0; i < integrators; i++)
        for (int p = 0; p < precisions; p++) {
            bool own = strcmp(integrator[i], own_integrator(s, integrator)) == 0, exact = strcmp(precision[p], "double") == 0;
            if ((!own && !study_wants(s, "integrator")) || (!exact && !study_wants(s, "precision")))
                continue;
            int c = study_add_curve(s, LADDER_STEP, "%s, %s", integrator[i], precision[p]);
            set_basis(s, c, integrator[i], precision[p]);
            s->curve[c].candidate = exact && (own || s->seeds == 1);
            s->curve[c].probe = add_probe(s, c);
        }
}

static bool some_law_reads(const scene *scene, const property *what)
{
    for (int e = 0; e < scene->effect_count; e++)
        for (int k = 0; k < LAW_PROPERTIES_MAX && scene->effect[e].law->material_needs[k]; k++)
            if (scene->effect[e].law->material_needs[k] == what)
                return true;
    return false;
}

/* The curve of the scene as it is, in double precision. */
static int own_curve(const study *s, const char *integrator)
{
    for (int c = 0; c < s->curve_count; c++)
        if (s->curve[c].ladder == LADDER_STEP && strcmp(s->curve[c].integrator, integrator) == 0 &&
            strcmp(s->curve[c].precision, "double") == 0)
            return c;
    return -1;
}

/* Along the factor, at the recommended step. `effect` and `word`: the correction, or -1. */
static void soften(study *s, const char *integrator, int effect, const char *option, const char *word)
{
    static const double factor[] = {0.3, 0.1, 0.03, 0.01, 0.003, 0.001};
    const scene *scene = s->scene;
    int c = effect < 0 ? study_add_curve(s, LADDER_VALUES, "softer modulus")
                       : study_add_curve(s, LADDER_VALUES, "softer modulus, %s %s", option, word);
    s->curve[c].along = "modulus factor";
    s->curve[c].costs_like = own_curve(s, integrator);
    set_basis(s, c, integrator, "double");
    if (effect >= 0)
        study_add_set(&s->curve[c].set, &s->curve[c].set_count, "effects[%d].%s=%s", effect, option, word);
    for (size_t f = 0; f < sizeof factor / sizeof *factor; f++) {
        study_probe *probe = &s->probe[add_probe(s, c)];
        study_point *p = study_add_point(s, c, (int)(probe - s->probe));
        p->parameter = factor[f];
        for (int m = 0; m < scene->material_count; m++) {
            double modulus = scene_material(scene, m, &property_youngs_modulus);
            if (isnan(modulus))
                continue;
            study_add_set(&p->set, &p->set_count, "materials[%d].%s=%.17g", m, property_youngs_modulus.key, factor[f] * modulus);
            if (effect >= 0 && isnan(scene_material(scene, m, &property_real_modulus)))
                study_add_set(&p->set, &p->set_count, "materials[%d].%s=%.17g", m, property_real_modulus.key, modulus);
        }
        for (int k = 0; k < p->set_count; k++)
            study_add_set(&probe->set, &probe->set_count, "%s", p->set[k]);
    }
}

/* A law that can make up for a softened modulus has an option `soft_modulus`, whose first choice is not to. */
static void choose_moduli(study *s, const char *integrator)
{
    const scene *scene = s->scene;
    if (!study_wants(s, "modulus") || !some_law_reads(scene, &property_youngs_modulus))
        return;
    soften(s, integrator, -1, NULL, NULL);
    for (int e = 0; e < scene->effect_count; e++)
        for (const law_option *option = scene->effect[e].law->options; option->key; option++) {
            if (strcmp(option->key, "soft_modulus") != 0)
                continue;
            char word[WORDS_MAX][40];
            parameter row = {.choices = option->choices};
            int count = choices_of(&row, "none", word);
            for (int w = 0; w < count; w++)
                soften(s, integrator, e, option->key, word[w]);
        }
}

static void choose_heat_steps(study *s, const char *integrator)
{
    static const int every[] = {1, 3, 10, 30, 100, 300, 1000};
    const parameter *row = find_row(&stage_heat_section, "every_steps");
    if (!study_wants(s, "heat_steps") || !row || row->type == PARAMETER_LATER || !scene_has_heat(s->scene))
        return;
    int c = study_add_curve(s, LADDER_VALUES, "heat every n steps");
    s->curve[c].along = "steps of motion a step of heat";
    s->curve[c].each_costs = true;
    set_basis(s, c, integrator, "double");
    int probe = add_probe(s, c);
    for (size_t k = 0; k < sizeof every / sizeof *every; k++) {
        study_point *p = study_add_point(s, c, probe);
        p->parameter = every[k];
        for (int t = 0; t < s->scene->stage_count; t++)
            if (study_moves(&s->scene->stage[t]))
                study_add_set(&p->set, &p->set_count, "stages[%d].heat.every_steps=%d", t, every[k]);
    }
}

/* Tolerances of one method of frozen heat; stages that move and have heat become frozen where `freeze` says so. */
static void add_tolerances(study *s, const char *method, const char *integrator, const char *precision, bool freeze)
{
    int c = freeze ? study_add_curve(s, LADDER_TOLERANCE, "frozen, %s", method)
                   : study_add_curve(s, LADDER_TOLERANCE, "%s, %s", method, precision);
    s->curve[c].each_costs = true;
    s->curve[c].candidate = !freeze && strcmp(precision, "double") == 0;
    set_basis(s, c, integrator, precision);
    for (int decade = 2; decade <= 10; decade++) {
        study_point *p = study_add_point(s, c, -1);
        p->parameter = pow(10.0, -decade);
        p->hidden = decade == 10;
        for (int t = 0; t < s->scene->stage_count; t++) {
            const scene_stage *stage = &s->scene->stage[t];
            if (freeze ? !study_moves(stage) : !stage->frozen || stage->heat_method == HEAT_STEADY)
                continue;
            if (freeze)
                study_add_set(&p->set, &p->set_count, "stages[%d].motion=frozen", t);
            if (freeze)
                study_add_set(&p->set, &p->set_count, "stages[%d].step_s=auto", t);
            study_add_set(&p->set, &p->set_count, "stages[%d].heat.method=%s", t, method);
            study_add_set(&p->set, &p->set_count, "stages[%d].heat.tolerance=1e-%d", t, decade);
        }
    }
}

static void choose_solvers(study *s, const char *integrator, bool freeze)
{
    char method[WORDS_MAX][40], precision[WORDS_MAX][40];
    int methods = choices_of(find_row(&stage_heat_section, "method"), "steady", method);
    int precisions = choices_of(find_row(&scene_section, "precision"), "auto", precision);
    int own = 0;
    for (int t = 0; t < s->scene->stage_count; t++)
        if (s->scene->stage[t].frozen && s->scene->stage[t].heat_method != HEAT_STEADY)
            own = (int)s->scene->stage[t].heat_method; /* in the order of the table's choices */
    for (int m = 0; m < methods; m++)
        for (int p = 0; p < precisions; p++) {
            bool exact = strcmp(precision[p], "double") == 0;
            if ((!exact && (freeze || !study_wants(s, "precision"))) ||
                (!freeze && !study_wants(s, "solver") && words_find(find_row(&stage_heat_section, "method")->choices, method[m]) != own))
                continue;
            add_tolerances(s, method[m], integrator, precision[p], freeze);
        }
}

static void choose_coupled(study *s, const char *integrator)
{
    if (!study_wants(s, "frozen"))
        return;
    int c = study_add_curve(s, LADDER_STEP, "coupled motion");
    set_basis(s, c, integrator, "double");
    for (int t = 0; t < s->scene->stage_count; t++)
        if (s->scene->stage[t].frozen && s->scene->stage[t].heat_method != HEAT_STEADY)
            study_add_set(&s->curve[c].set, &s->curve[c].set_count, "stages[%d].motion=free", t);
    s->curve[c].probe = add_probe(s, c);
}

/* Laws of the normal slot that the scene could name instead. */
static void choose_laws(study *s, const char *integrator)
{
    const effect *live = scene_effect(s->scene, -1, SLOT_NORMAL);
    if (!live || !study_wants(s, "law"))
        return;
    for (int k = 0; laws[k]; k++) {
        failure ignored;
        scene *other = NULL;
        char **set = NULL;
        int count = 0;
        if (laws[k]->slot != live->law->slot || laws[k] == live->law)
            continue;
        for (int b = 0; b < s->base_count; b++)
            study_add_set(&set, &count, "%s", s->base[b]);
        study_add_set(&set, &count, "effects[%s].law=%s", slot_name(live->law->slot), laws[k]->name);
        if (scene_read(s->options->run.scene_path, count, set, &other, &ignored) == STATUS_OK) {
            int c = study_add_curve(s, LADDER_STEP, "%s law %s", slot_name(live->law->slot), laws[k]->name);
            set_basis(s, c, integrator, "double");
            s->curve[c].other_model = true;
            study_add_set(&s->curve[c].set, &s->curve[c].set_count, "%s", set[count - 1]);
            s->curve[c].probe = add_probe(s, c);
        }
        scene_free(other);
        for (int b = 0; b < count; b++)
            free(set[b]);
        free(set);
    }
}

status study_choose(study *s, failure *why)
{
    char integrator[WORDS_MAX][40];
    choices_of(find_row(&scene_section, "integrator"), "", integrator);
    const char *own = own_integrator(s, integrator);
    if (has_frozen_heat(s->scene)) {
        choose_solvers(s, own, false);
        choose_coupled(s, own);
        return STATUS_OK;
    }
    choose_steps(s);
    choose_moduli(s, own);
    choose_heat_steps(s, own);
    if (scene_has_heat(s->scene) && study_wants(s, "frozen"))
        choose_solvers(s, own, true);
    choose_laws(s, own);
    return s->curve_count > 0 ? STATUS_OK : fail(why, STATUS_BAD_INPUT, "%s: there is nothing to choose", s->options->run.scene_path);
}

/* ---- what to expect ---- */

static bool ends_with(const char *text, const char *end)
{
    size_t a = strlen(text), b = strlen(end);
    return a >= b && strcmp(text + a - b, end) == 0;
}

static bool pair_is_damped(const scene *scene, int a, int b, int wall)
{
    for (const property *const *p = interaction_properties(); *p; p++) {
        double value = scene_interaction(scene, -1, a, b, wall, *p);
        if ((ends_with((*p)->key, "damping_ratio") && value > 0.0) || (*p == &property_restitution && value < 1.0))
            return true;
    }
    return false;
}

static bool contacts_are_damped(const scene *scene)
{
    bool damped = false;
    for (int a = 0; a < scene->material_count; a++) {
        for (int b = a; b < scene->material_count; b++)
            damped |= pair_is_damped(scene, a, b, -1);
        for (int w = 0; w < scene->wall_count; w++)
            damped |= pair_is_damped(scene, a, -1, w);
    }
    return damped;
}

void study_expected_order(const scene *scene, char *text, size_t size)
{
    double g[3];
    scene_gravity(scene, 0, g);
    bool falls = g[0] != 0.0 || g[1] != 0.0 || g[2] != 0.0, contacts = scene_effect(scene, -1, SLOT_NORMAL) != NULL;
    bool slips = scene_effect(scene, -1, SLOT_TANGENTIAL) || scene_effect(scene, -1, SLOT_ROLLING);
    if (scene_has_heat(scene))
        snprintf(text, size, "1 (heat by Euler's method)");
    else if (contacts && contacts_are_damped(scene))
        snprintf(text, size, "1 to 1.25 (damped contacts)");
    else if (falls && scene->integrator == INTEGRATOR_SEMI_IMPLICIT_EULER)
        snprintf(text, size, "1 (free flight by Euler's method)");
    else if (contacts)
        snprintf(text, size, "%s",
                 slips                                                 ? "at most 2 (slip and stick)"
                 : scene->integrator == INTEGRATOR_SEMI_IMPLICIT_EULER ? "2, speeds 1 (elastic contacts)"
                                                                       : "2 (elastic contacts)");
    else
        snprintf(text, size, "exact (free flight)");
}
