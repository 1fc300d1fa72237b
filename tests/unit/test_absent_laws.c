/* A scene pays only for the effects that it calls for, by inspection: for every law that a scene may name, alone and with every other one, and
 * for every stage of a scene with stages, the assembled program contains no symbol of an absent law, the stages no argument of it, and what is
 * allocated no field of it. Nothing is compiled. The scenes are those of `clast bench effects`, which come from the descriptors, so that a law
 * that is added is looked at without a word here. */
#include "every_law.h"
#include "simulation_case.h"

#include "bench_scene.h"
#include "program.h"

#include <ctype.h>

/* ---- words of the kernel files ---- */

typedef struct words {
    char **word;
    int count, capacity;
} words;

static int by_text(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static void add_word(words *w, const char *start, size_t length)
{
    if (w->count == w->capacity) {
        w->capacity = 2 * w->capacity + 256;
        w->word = realloc(w->word, sizeof *w->word * (size_t)w->capacity);
        assert_non_null(w->word);
    }
    w->word[w->count++] = strndup(start, length);
}

static void sort_words(words *w)
{
    int kept = 0;
    qsort(w->word, (size_t)w->count, sizeof *w->word, by_text);
    for (int n = 0; n < w->count; n++)
        if (kept > 0 && strcmp(w->word[n], w->word[kept - 1]) == 0)
            free(w->word[n]);
        else
            w->word[kept++] = w->word[n];
    w->count = kept;
}

static bool has_word(const words *w, const char *word)
{
    return w->count > 0 && bsearch(&word, w->word, (size_t)w->count, sizeof *w->word, by_text);
}

static void free_words(words *w)
{
    for (int n = 0; n < w->count; n++)
        free(w->word[n]);
    free(w->word);
    *w = (words){0};
}

/* Spaces instead of comments and of the names of files. */
static char *code_of(const char *text)
{
    char *code = strdup(text);
    assert_non_null(code);
    for (char *p = code; *p;) {
        size_t skip = 0;
        if (p[0] == '/' && p[1] == '*')
            skip = strstr(p, "*/") ? (size_t)(strstr(p, "*/") + 2 - p) : strlen(p);
        else if ((p[0] == '/' && p[1] == '/') || strncmp(p, "#line", 5) == 0)
            skip = strcspn(p, "\n");
        for (size_t n = 0; n < skip; n++)
            p[n] = p[n] == '\n' ? '\n' : ' ';
        p += skip > 0 ? skip : 1;
    }
    return code;
}

static bool in_name(char c)
{
    return isalnum((unsigned char)c) || c == '_';
}

static words all_words(const char *text)
{
    words w = {0};
    char *code = code_of(text);
    for (char *p = code; *p;) {
        size_t length = 0;
        while (in_name(p[length]))
            length++;
        if (length > 0 && !isdigit((unsigned char)*p))
            add_word(&w, p, length);
        p += length > 0 ? length : 1;
    }
    free(code);
    sort_words(&w);
    return w;
}

/* What a file defines: macros, functions, types. Members of structs and names of variables are no symbols of a program. */
static void add_symbols(words *w, const char *text)
{
    char *code = code_of(text);
    for (char *line = code; line && *line;) {
        char *end = line + strcspn(line, "\n"), saved = *end, name[128];
        *end = '\0';
        if (sscanf(line, "#define %127[A-Za-z0-9_]", name) == 1)
            add_word(w, name, strlen(name));
        else if (strncmp(line, "INLINE ", 7) == 0 || strncmp(line, "OUTLINE ", 8) == 0) {
            char *paren = strchr(line, '('), *start = paren;
            while (start && start > line && in_name(start[-1]))
                start--;
            if (paren)
                add_word(w, start, (size_t)(paren - start));
        } else if (sscanf(line, "typedef struct %127[A-Za-z0-9_] {", name) == 1 ||
                   sscanf(line, "typedef %*[a-z0-9_] %127[A-Za-z0-9_];", name) == 1)
            add_word(w, name, strlen(name));
        *end = saved;
        line = saved ? end + 1 : NULL;
    }
    free(code);
}

static const char *text_of(const char *file)
{
    for (const kernel_file *f = kernels_embedded; f->name; f++)
        if (strcmp(f->name, file) == 0)
            return f->text;
    fail_msg("%s is no kernel file", file);
    return NULL;
}

/* ---- one program ---- */

typedef struct assembled {
    const char *files[128];
    int count;
    words words, symbols; /* of the whole text; defined by its files */
} assembled;

static assembled assemble(const live_laws *live, const scene *scene)
{
    assembled a = {.count = 0};
    char constants[8192], *text = NULL;
    live_constants(live, scene, constants, sizeof constants);
    a.count = live_files(live, a.files, 127);
    a.files[a.count++] = "stage/step_loop.cl";
    MUST(program_assemble(constants, a.files, a.count, NULL, &text, why));
    a.words = all_words(text);
    free(text);
    for (int f = 0; f < a.count; f++)
        add_symbols(&a.symbols, text_of(a.files[f]));
    sort_words(&a.symbols);
    return a;
}

static void free_assembled(assembled *a)
{
    free_words(&a->words);
    free_words(&a->symbols);
}

static void describe(const live_laws *live, char *text, size_t size)
{
    text[0] = '\0';
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
        if (live->law[slot])
            snprintf(text + strlen(text), size - strlen(text), " %s", live->law[slot]->name);
}

static bool is_file_of(const law *l, const char *file)
{
    bool found = l && strcmp(l->kernel_file, file) == 0;
    for (int f = 0; l && f < LAW_FILES_MAX && l->more_files[f]; f++)
        found = found || strcmp(l->more_files[f], file) == 0;
    return found;
}

static void check_files(const live_laws *live, const assembled *a, const law *absent, const char *what)
{
    for (int k = 0; k < a->count; k++) {
        bool shared = false;
        for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
            shared = shared || is_file_of(live->law[slot], a->files[k]);
        if (!shared && is_file_of(absent, a->files[k]))
            fail_msg("the program with%s contains %s of the absent law %s", what, a->files[k], absent->name);
    }
}

static void check_text(const assembled *a, const law *absent, const char *what)
{
    const char *files[1 + LAW_FILES_MAX] = {absent->kernel_file};
    for (int f = 0; f < LAW_FILES_MAX; f++)
        files[1 + f] = absent->more_files[f];
    words symbols = {0};
    for (int f = 0; f <= LAW_FILES_MAX; f++)
        if (files[f])
            add_symbols(&symbols, text_of(files[f]));
    sort_words(&symbols);
    for (int n = 0; n < symbols.count; n++)
        if (has_word(&a->words, symbols.word[n]) && !has_word(&a->symbols, symbols.word[n]))
            fail_msg("the program with%s contains %s of the absent law %s %s", what, symbols.word[n], slot_name(absent->slot),
                     absent->name);
    free_words(&symbols);
}

/* Constants have their places in rows only where a live law reads them. */
static void check_constants(const live_laws *live, const assembled *a, const law *absent, const char *what)
{
    const char *const *lists[] = {absent->parameters, absent->grain_parameters};
    for (int l = 0; l < 2; l++)
        for (int p = 0; p < LAW_PARAMETERS_MAX && lists[l][p]; p++) {
            bool shared = has_word(&a->symbols, lists[l][p]);
            for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
                for (int q = 0; live->law[slot] && q < LAW_PARAMETERS_MAX; q++)
                    shared = shared || (live->law[slot]->parameters[q] && strcmp(live->law[slot]->parameters[q], lists[l][p]) == 0) ||
                             (live->law[slot]->grain_parameters[q] && strcmp(live->law[slot]->grain_parameters[q], lists[l][p]) == 0);
            if (!shared && has_word(&a->words, lists[l][p]))
                fail_msg("the program with%s has a constant %s of the absent law %s", what, lists[l][p], absent->name);
        }
}

static bool uses(const live_laws *live, const char *name)
{
    for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
        for (int f = 0; live->law[slot] && f < LAW_ARGUMENTS_MAX; f++) {
            const field *const both[] = {live->law[slot]->pair_fields[f], live->law[slot]->particle_fields[f]};
            for (int n = 0; n < 2; n++)
                if (both[n] && strcmp(both[n]->name, name) == 0)
                    return true;
        }
    return false;
}

/* No stage has an argument of the absent law that no live one shares. */
static void check_arguments(const live_laws *live, const law *absent, const char *what)
{
    static const char *const kernels[] = {"pair_stage",    "particle_stage", "pair_probe",           "observe_records",
                                          "limit_records", "step_loop",      "particle_synchronise", "heat_conductances",
                                          "heat_limit",    "heat_sums",      "heat_frozen_stage",    "beam_depth"};
    const char *names[LAUNCH_NAMES_MAX];
    for (size_t k = 0; k < sizeof kernels / sizeof *kernels; k++) {
        int count = launch_argument_names(live, kernels[k], names, LAUNCH_NAMES_MAX);
        for (int a = 0; a < count; a++)
            for (int f = 0; f < LAW_ARGUMENTS_MAX; f++) {
                const field *const both[] = {absent->pair_fields[f], absent->particle_fields[f]};
                for (int n = 0; n < 2; n++)
                    if (both[n] && strcmp(both[n]->name, names[a]) == 0 && !uses(live, names[a]))
                        fail_msg("%s with%s has an argument %s of the absent law %s", kernels[k], what, names[a], absent->name);
            }
    }
}

static void check_fields(const live_laws *all, const law *absent, const char *what)
{
    const field *needed[SIMULATION_FIELDS_MAX];
    int count = store_needs(all, needed, SIMULATION_FIELDS_MAX);
    for (int k = 0; k < count; k++)
        for (int f = 0; f < LAW_ARGUMENTS_MAX; f++)
            if ((absent->pair_fields[f] == needed[k] || absent->particle_fields[f] == needed[k]) && !uses(all, needed[k]->name))
                fail_msg("a scene with%s allocates %s of the absent law %s", what, needed[k]->name, absent->name);
}

/* ---- laws that follow from others ---- */

static bool any(const live_laws *live, const slot_id *slots, size_t count)
{
    for (size_t s = 0; s < count; s++)
        if (live->law[slots[s]])
            return true;
    return false;
}

/* Slots that no scene lists are filled only where something that is listed needs them. The bed has walls, one material, one domain, no spin. */
static void check_derived(const live_laws *live, const char *what)
{
    static const slot_id turning[] = {SLOT_TANGENTIAL, SLOT_ROLLING, SLOT_BOND};
    static const slot_id thermal[] = {SLOT_MODULUS, SLOT_CONDUCTION,      SLOT_CONVECTION,      SLOT_RADIATION,
                                      SLOT_SOURCE,  SLOT_HEAT_GENERATION, SLOT_DISSIPATION_HEAT};
    static const slot_id surfaces[] = {SLOT_CONVECTION, SLOT_RADIATION};
    static const slot_id never[] = {SLOT_PRECISION, SLOT_COMPOSITION, SLOT_DIMENSIONS, SLOT_PERIODIC,  SLOT_MOTION,         SLOT_SUBSTANCE,
                                    SLOT_SOFTENING, SLOT_LEDGER,      SLOT_WALL_HEAT, SLOT_THERMAL_GROUPS, SLOT_ORIENTATION};
    for (size_t n = 0; n < sizeof never / sizeof *never; n++)
        if (live->law[never[n]])
            fail_msg("with%s: nothing asks for %s", what, slot_name(never[n]));
    if (live->law[SLOT_HEAT_TALLY] && !live->law[SLOT_SOURCE]) /* a run with beams reports what they brought */
        fail_msg("with%s: nothing asks for heat by path", what);
    if (live->law[SLOT_ROTATION] && !any(live, turning, sizeof turning / sizeof *turning))
        fail_msg("with%s: nothing turns grains", what);
    if (live->law[SLOT_ROTATION] && !live->law[SLOT_TANGENTIAL] && !live->law[SLOT_ROLLING] && !live->law[SLOT_BOND]->turns)
        fail_msg("with%s: this bond turns no grains", what);
    if (live->law[SLOT_TEMPERATURE] && !any(live, thermal, sizeof thermal / sizeof *thermal)) {
        bool read = false; /* a law outside those slots, such as expansion */
        for (slot_id slot = 0; slot < SLOT_COUNT; slot++)
            read = read || (live->law[slot] && slot_is_listed(slot) && slot != SLOT_NORMAL && slot != SLOT_TANGENTIAL &&
                            slot != SLOT_ROLLING && slot != SLOT_BODY && slot != SLOT_COHESION);
        assert_true(read);
    }
    if (live->law[SLOT_ENVIRONMENT] && !any(live, surfaces, 2))
        fail_msg("with%s: nothing reads the environment", what);
    if (live->law[SLOT_SLIP] && !live->law[SLOT_TANGENTIAL])
        fail_msg("with%s: there is a friction coefficient without friction", what);
    if (live->law[SLOT_BONDING] && !live->law[SLOT_BOND])
        fail_msg("with%s: contacts may bond without bonds", what);
    if (live->law[SLOT_DISSIPATION] && !live->law[SLOT_DISSIPATION_HEAT])
        fail_msg("with%s: nothing reads what contacts dissipate", what);
}

/* ---- scenes ---- */

/* The laws of a program, held against every law that is not among them. Sources stand in a program under laws of their own. */
static void inspect(const live_laws *live, const live_laws *all, const scene *scene)
{
    char what[512];
    describe(live, what, sizeof what);
    assembled a = assemble(live, scene);
    for (size_t n = 0; n < sizeof every_law / sizeof *every_law; n++) {
        const law *l = every_law[n];
        if (live->law[l->slot] == l || (l->slot == SLOT_SOURCE && live->law[SLOT_SOURCE]))
            continue;
        check_files(live, &a, l, what);
        check_text(&a, l, what);
        check_constants(live, &a, l, what);
        check_arguments(live, l, what);
        if (all->law[l->slot] != l)
            check_fields(all, l, what);
    }
    free_assembled(&a);
}

static bed one_grain(void)
{
    bed b = case_bed(1);
    case_measure(&b);
    return b;
}

/* False where a scene may not have these laws. */
static bool try_laws(const law *const *live_list, int count)
{
    settled_bed of = {.bed = {.count = 100}, .side_m = 0.01};
    scene *scene = NULL;
    failure why;
    live_laws live;
    char what[512];
    if (bench_scene_make(&of, live_list, count, NULL, false, &scene, &why) != STATUS_OK)
        return false;
    bed b = one_grain();
    live_laws_of(scene, &b, &live);
    describe(&live, what, sizeof what);
    for (int l = 0; l < count; l++) /* a source stands for itself among the beams */
        if (live.law[live_list[l]->slot] != live_list[l] && live_list[l]->slot != SLOT_SOURCE)
            fail_msg("%s is listed and not live", live_list[l]->name);
    check_derived(&live, what);
    inspect(&live, &live, scene);
    bed_free(&b);
    scene_free(scene);
    return true;
}

static void test_single_laws_and_pairs(void **state)
{
    (void)state;
    int tried = 0, refused = 0;
    for (const law *const *a = laws; *a; a++)
        for (const law *const *b = a; *b; b++) {
            const law *list[3] = {*a, *b, laws[0]};
            int count = *a == *b ? 1 : 2;
            if (count == 2 && (*a)->slot == (*b)->slot && (*a)->slot != SLOT_SOURCE)
                continue;
            bool fits = try_laws(list, count);
            if (!fits && (*a)->slot != SLOT_NORMAL) { /* some need a law of contact */
                list[count] = laws[0];
                fits = try_laws(list, count + 1);
            }
            tried += fits;
            refused += !fits;
        }
    print_message("%d programs; %d scenes are refused\n", tried, refused);
    assert_true(tried > 200 && refused < tried / 3);
}

/* Each stage has the program of its own laws; memory is that of all stages together. */
static void test_stages(void **state)
{
    (void)state;
    static const char text[] =
        "gravity_m_s2: [0, 0, -9.81]\n"
        "effects: [{slot: normal, law: hertz}, {slot: tangential, law: mindlin}, {slot: rolling, law: elastic_plastic}, {slot: bond, law: "
        "adhesion}, "
        "{slot: conduction, law: overlap_area}, {slot: convection, law: newton, coefficient_w_m2k: 50}, {slot: radiation, law: "
        "stefan_boltzmann}]\n"
        "environment: {temperature_k: 300}\n"
        "materials: [{name: m, density_kg_m3: 2500, youngs_modulus_pa: 5.0e6, poissons_ratio: 0.3, conductivity_w_mk: 1, "
        "specific_heat_j_kgk: 800, emissivity: 0.9}]\n"
        "interactions: [{between: default, restitution: 0.5, friction_static: 0.5, rolling_friction: 0.01, bond_equilibrium_strain: "
        "1.0e-3}]\n"
        "particles: [{name: bed, material: m, generator: list, items: [{position_m: [0, 0, 0], radius_m: 0.01}], temperature_k: 300}]\n"
        "walls: [{name: floor, shape: plane, point_m: [0, 0, -1], normal: [0, 0, 1], temperature_k: 400}]\n"
        "stages:\n"
        "  - {name: all, until: {steps: 1}, step_s: 1.0e-5}\n"
        "  - {name: no_rolling, until: {steps: 1}, step_s: 1.0e-5, effects_off: [rolling, bond]}\n"
        "  - {name: no_friction, until: {steps: 1}, step_s: 1.0e-5, effects_off: [tangential, rolling, bond, conduction]}\n"
        "  - {name: cool, until: {time_s: 1}, motion: frozen, effects_off: [radiation]}\n"
        "  - {name: no_heat, until: {steps: 1}, step_s: 1.0e-5, effects_off: [conduction, convection, radiation]}\n";
    static const slot_id off[5][5] = {{0},
                                      {SLOT_ROLLING, SLOT_BOND, SLOT_BONDING},
                                      {SLOT_TANGENTIAL, SLOT_SLIP, SLOT_CONDUCTION, SLOT_WALL_HEAT, SLOT_BOND},
                                      {SLOT_RADIATION},
                                      {SLOT_CONDUCTION, SLOT_CONVECTION, SLOT_RADIATION, SLOT_ENVIRONMENT, SLOT_WALL_HEAT}};
    scene *scene = NULL;
    live_laws all, live;
    MUST(scene_read_text(text, "case.yaml", 0, NULL, &scene, why));
    bed b = one_grain();
    live_laws_of(scene, &b, &all);
    for (int s = 0; s < scene->stage_count; s++) {
        live_laws_in_stage(scene, &all, s, &live);
        for (int n = 0; n < 5 && off[s][n]; n++)
            if (live.law[off[s][n]])
                fail_msg("stage %d: %s is live", s, slot_name(off[s][n]));
        inspect(&live, &all, scene);
    }
    bed_free(&b);
    scene_free(scene);
}

/* What kernels with arguments of their own add for a slot, its twin leaves out. */
static void test_twins_add_no_arguments(void **state)
{
    (void)state;
    int seen = 0;
    for (const kernel_file *f = kernels_embedded; f->name; f++)
        if (strncmp(f->name, "none/", 5) == 0)
            for (const char *p = f->text; (p = strstr(p, "_FIELDS(READ, WRITE)")) != NULL; p += 5, seen++) {
                const char *rest = p + strlen("_FIELDS(READ, WRITE)");
                size_t length = strcspn(rest, "\n");
                for (size_t n = 0; n < length; n++)
                    if (!isspace((unsigned char)rest[n]))
                        fail_msg("%s names arguments: %.*s", f->name, (int)length, rest);
            }
    assert_true(seen > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_single_laws_and_pairs),
        cmocka_unit_test(test_stages),
        cmocka_unit_test(test_twins_add_no_arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
