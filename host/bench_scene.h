/* Scenes of the settled bed under any choice of laws, made from the laws' descriptors: what `clast bench effects` measures. */
#ifndef CLAST_HOST_BENCH_SCENE_H
#define CLAST_HOST_BENCH_SCENE_H
#include "scene.h"
#include "settled_bed.h"

#define BENCH_LAWS_MAX 32

/* What a scene asks for beside the laws that it lists, as lines of its file. */
typedef struct bench_setting {
    const char *name;
    const char *lines;        /* of the scene; or NULL */
    const char *interactions; /* keys of the default interaction; or NULL */
    bool second_material, mixed;
} bench_setting;

/* Ends with a NULL name. */
extern const bench_setting bench_settings[];

/* The laws that stand one on another in `one by one`: the first of every slot that a scene may list, contact and friction first. Returns
 * their number. */
int bench_stack(const law **out, int max);

/* The bed's scene under these laws and a setting (or NULL), in mixed precision where either says so. A scene that may not be is STATUS_BAD_INPUT with its message. */
status bench_scene_make(const settled_bed *of, const law *const *live, int count, const bench_setting *setting, bool mixed, scene **out,
                        failure *why);

/* The same as the lines of its file. Caller frees. */
char *bench_scene_text(const settled_bed *of, const law *const *live, int count, const bench_setting *setting, bool mixed);

#endif
