/* Finds the spheres near a sphere, at any ratio of sizes: one cell grid per factor of two in radius, all in one hash table, so that
 * neither small grains beside large ones nor a grain far away from the rest cost time or memory. */
#ifndef CLAST_HOST_SPHERE_GRID_H
#define CLAST_HOST_SPHERE_GRID_H
#include "scene.h"

#include <stdbool.h>
#include <stdint.h>

#define SPHERE_GRID_LEVELS 24

/* Straight coordinates, some of them wrapped. */
typedef struct sphere_space {
    double origin[3], length[3]; /* length counts only where periodic */
    bool periodic[3];
} sphere_space;

/* Without a domain, or where it is not periodic: no images. */
sphere_space sphere_space_of(const domain *domain);

typedef struct sphere_link {
    uint64_t key;
    int32_t next;
} sphere_link;

typedef struct sphere_grid {
    sphere_space space;
    double radius_top; /* the largest radius; level k holds (top 2^-(k+1), top 2^-k] */
    struct sphere_level {
        int64_t members;
        double radius_max;
        double cell[3];
        int64_t cells[3];          /* along periodic directions */
        int64_t first[3], last[3]; /* occupied */
    } level[SPHERE_GRID_LEVELS];
    uint64_t mask;
    int32_t *head;
    sphere_link *link;
} sphere_grid;

typedef struct sphere_list {
    int32_t *index;
    int64_t count, capacity;
} sphere_list;

/* Room for spheres 0 .. count-1 with radii up to `radius_top`. False when memory runs out. */
bool sphere_grid_init(sphere_grid *grid, const sphere_space *space, int64_t count, double radius_top);
void sphere_grid_clear(sphere_grid *grid);
void sphere_grid_free(sphere_grid *grid);
void sphere_grid_insert(sphere_grid *grid, int32_t index, const double position[3], double radius);
int sphere_grid_level(const sphere_grid *grid, double radius);
/* Appends every inserted sphere of levels 0 .. level_last that may touch the given one, and some more. False when memory runs out. */
bool sphere_grid_near(const sphere_grid *grid, const double position[3], double radius, int level_last, sphere_list *found);

/* Vector from b to a, to b's nearest image. */
static inline void sphere_branch(const sphere_space *space, const double a[3], const double b[3], double branch[3])
{
    for (int d = 0; d < 3; d++) {
        double x = a[d] - b[d];
        if (space->periodic[d]) {
            double half = 0.5 * space->length[d];
            while (x > half)
                x -= space->length[d];
            while (x < -half)
                x += space->length[d];
        }
        branch[d] = x;
    }
}

/* Coordinate brought into [origin, origin + length) where periodic. */
double sphere_wrap(const sphere_space *space, int direction, double x);
/* Order along a space-filling curve, so that spheres close in space are close in memory. `order` has room for count. */
bool sphere_order(int64_t count, const double (*position)[3], const double *radius, int32_t *order);

#endif
