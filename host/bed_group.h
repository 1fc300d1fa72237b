/* What the generators share: each appends one group's particles to the bed. */
#ifndef CLAST_HOST_BED_GROUP_H
#define CLAST_HOST_BED_GROUP_H
#include "bed.h"

/* A message about a group: "scene.yaml:12:5: particles[bed]: ...". Returns STATUS_BAD_INPUT. */
status bed_refuse(const scene *scene, int group, failure *why, const char *format, ...) __attribute__((format(printf, 4, 5)));
/* Adds `count` particles with the group's velocity, spin, temperature and material, at the origin and with radius 0; `first` is the
 * index of the first. */
status bed_extend(const scene *scene, int group, int64_t count, bed *bed, int64_t *first, failure *why);
/* Draws the radii of the group's particles, the first of which is bed particle `first`. */
status bed_draw_radii(const scene *scene, int group, bed *bed, int64_t first, failure *why);
/* True when the scene gives the group's radii. */
bool bed_radius_given(const particle_group *group);

status bed_list(const scene *scene, int group, bed *bed, failure *why);
status bed_lattice(const scene *scene, int group, bed *bed, failure *why);
status bed_random(const scene *scene, int group, bed *bed, failure *why);
status bed_csv(const scene *scene, int group, bed *bed, failure *why);
status bed_result(const scene *scene, int group, bed *bed, failure *why);

#endif
