/* What the adhesion bond of a pair comes to: overlaps, forces and velocities that follow from its constants. */
#ifndef CLAST_HOST_BOND_FIGURES_H
#define CLAST_HOST_BOND_FIGURES_H
#include "bed.h"
#include "scene.h"

typedef struct bond_figures {
    const char *a, *b;  /* materials, or a material and a wall */
    bool wall;
    double radius_i, radius_j;      /* for which the figures hold: means of the two materials, m */
    double equilibrium, critical;   /* overlaps, m */
    double pull_off;                /* N */
    double velocity;                /* BM Eq. 21: largest approach that bounces off, without damping, m/s */
    double sticks_from, breaks_from; /* approaches between which a pair sticks; beyond the second a fresh bond breaks again; INFINITY: never */
} bond_figures;

/* One row for each pair that can bond in stage `stage`; returns how many. Caller frees. NULL: out of memory. */
bond_figures *bond_figures_of(const scene *scene, const bed *bed, int stage, int *count);
/* Refuses parameters without a stable bond, or with one beyond small overlaps. */
status bond_check(const scene *scene, const bed *bed, failure *why);

#endif
