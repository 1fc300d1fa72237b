/* A scene of tests/stability/scenes in a precision, run as a stage runs it, and the margins that are measured on it. CLAST_LONG=1 makes the runs as
 * long as docs/stability.md says; CLAST_MARGINS names a file that every margin is appended to; CLAST_TEST_SET holds settings that every scene is
 * given (settings.h), and CLAST_HARD names of cases, with blanks between, that alone are run. */
#ifndef CLAST_TESTS_HARD_CASE_H
#define CLAST_TESTS_HARD_CASE_H
#include "../physics/case.h"
#include "ledger.h"

#define LOOK_STEPS 200

static const char *const precisions[] = {"double", "mixed"};

/* True where the case of that name is to be run. */
static inline bool hard_wanted(const char *name)
{
    const char *only = getenv("CLAST_HARD"), *at = only ? strstr(only, name) : NULL;
    size_t length = strlen(name);
    for (; at; at = strstr(at + 1, name))
        if ((at == only || at[-1] == ' ') && (at[length] == '\0' || at[length] == ' '))
            return true;
    return !only;
}

/* True where the settings of all scenes leave that precision its turn. */
static inline bool hard_has(const char *precision)
{
    return !settings_name("precision=") || settings_name(precision);
}

/* A test of all precisions, named body_all. */
#define IN_EVERY_PRECISION(body)         \
    static void body##_all(void **state) \
    {                                    \
        (void)state;                     \
        if (!hard_wanted(#body))         \
            skip();                      \
        for (int p = 0; p < 2; p++)      \
            if (hard_has(precisions[p])) \
                body(precisions[p]);     \
    }

static inline bool hard_long(void)
{
    const char *set = getenv("CLAST_LONG");
    return set && strcmp(set, "0") != 0;
}

/* `set`: further settings with ; between them, or NULL. */
static inline physics_case hard_open(const char *scene, const char *precision, const char *set)
{
    physics_case c = {0};
    char path[512], first[64], more[256], *list[8 + SETTINGS_MAX] = {first}, *rest = NULL;
    int count = 1;
    settings all;
    settings_read(&all);
    for (int k = 0; k < all.count; k++)
        list[count++] = all.at[k];
    snprintf(path, sizeof path, CLAST_SOURCE_DIR "/tests/stability/scenes/%s.yaml", scene);
    snprintf(first, sizeof first, "precision=%s", precision);
    snprintf(more, sizeof more, "%s", set ? set : "");
    for (char *one = strtok_r(more, ";", &rest); one && count < 8 + SETTINGS_MAX; one = strtok_r(NULL, ";", &rest))
        list[count++] = one;
    MUST(scene_read(path, count, list, &c.scene, why));
    MUST(bed_generate(c.scene, &c.bed, why));
    MUST(simulation_create(c.scene, &c.bed, case_device(), NULL, &c.sim, why));
    MUST(simulation_begin_stage(c.sim, 0, why));
    return c;
}

static inline void hard_guard(physics_case *c)
{
    guard_finding found;
    MUST(guard_check(c->sim, &found, why));
    if (found.stop)
        fail_msg("%s", found.text);
}

/* Steps as `step_s: auto` takes them, times a factor; guards look on. */
static inline void hard_auto(physics_case *c, int64_t steps, double factor)
{
    for (int64_t done = 0; done < steps; done += LOOK_STEPS) {
        double dt = factor * case_limit(c).recommended_s;
        case_run(c, LOOK_STEPS < steps - done ? LOOK_STEPS : steps - done, dt);
        hard_guard(c);
    }
}

static inline void hard_auto_until(physics_case *c, double time)
{
    while (c->sim->time < time)
        hard_auto(c, LOOK_STEPS, 1.0);
}

/* Kinetic energy over the sum of m g r. */
static inline double hard_unrest(physics_case *c)
{
    particle_sums sums = case_sums(c);
    return (sums.kinetic + sums.rotational) / (9.81 * sums.weight_radius);
}

static inline void hard_settle(physics_case *c, double unrest, int64_t most)
{
    int calm = 0;
    for (int64_t done = 0; done < most && calm < 3; done += 10 * LOOK_STEPS) {
        hard_auto(c, 10 * LOOK_STEPS, 1.0);
        calm = hard_unrest(c) < unrest ? calm + 1 : 0;
    }
    if (calm < 3)
        fail_msg("%s is not at rest after %lld steps: %.3g of the sum of m g r", c->scene->title, (long long)most, hard_unrest(c));
}

static inline double hard_energy(physics_case *c)
{
    particle_sums sums = case_sums(c);
    return sums.kinetic + sums.rotational + sums.gravitational + case_contact_sums(c).elastic;
}

/* Notes a measured value that must not be past its bound, with the steps that the case has run, and checks it. */
static inline void hard_margin(const physics_case *c, const char *name, const char *what, double value, double bound)
{
    const char *path = getenv("CLAST_MARGINS"), *precision = c->sim->mixed ? "mixed" : "double";
    const char *integrator = case_verlet() ? "velocity_verlet" : "semi_implicit_euler";
    FILE *file = path ? fopen(path, "a") : NULL;
    if (file) {
        fprintf(file, "%s\t%s\t%s\t%s\t%.3g\t%.3g\t%lld\n", name, precision, integrator, what, value, bound, (long long)c->sim->step);
        fclose(file);
    }
    if (!(value <= bound))
        fail_msg("%s, %s, %s: %s is %.6g, past its bound of %.6g", name, precision, integrator, what, value, bound);
}

/* Largest distance of any grain from where it was, over the smallest radius. */
static inline double hard_move(physics_case *c, const double *from)
{
    double most = 0.0, *now = case_field(c, "position");
    for (int64_t n = 0; n < c->bed.count; n++) {
        double sum = 0.0;
        for (int k = 0; k < 3; k++)
            sum += pow(now[3 * n + k] - from[3 * n + k], 2);
        most = fmax(most, sqrt(sum) / c->sim->radius_min);
    }
    free(now);
    return most;
}

static inline double hard_overlap(physics_case *c, int i, int j)
{
    int64_t count;
    live_contact *live = case_contacts(c, &count);
    double overlap = 0.0;
    for (int64_t k = 0; k < count; k++)
        if (live[k].i == i && (j < 0 ? live[k].wall >= 0 : live[k].j == j))
            overlap = fmax(overlap, live[k].overlap);
    free(live);
    return overlap;
}

#endif
