/* Where walls and prescribed groups are at a time: rigid motions, composed over the stages of a scene. */
#ifndef CLAST_HOST_POSE_H
#define CLAST_HOST_POSE_H
#include "scene.h"

#include <clast/shared.h>

/* A body that moves as prescribed: x(t) = motion since `start` applied to (rotation x0 + shift). */
typedef struct moving_body {
    double rotation[9], shift[3]; /* up to `start` */
    double start;                 /* s */
    bool from_origin;             /* sinusoids count from zero displacement (the scene's own motion), else from where the body is at `start` */
    const motion_list *motion;    /* since then; NULL or empty: at rest */
} moving_body;

void moving_body_init(moving_body *body, const motion_list *motion);
/* Takes up another motion at time t; the body goes on from where it is. */
void moving_body_change(moving_body *body, const motion_list *motion, double t);
bool moving_body_moves(const moving_body *body);

typedef struct body_pose {
    double rotation[9], shift[3]; /* x = rotation x0 + shift */
    double velocity[3], spin[3], pivot[3]; /* v(x) = velocity + spin x (x - pivot) */
} body_pose;

body_pose moving_body_pose(const moving_body *body, double t);
void pose_point(const body_pose *pose, const double *x0, double *x);
void pose_vector(const body_pose *pose, const double *v0, double *v);
/* The motion over [t, t + dt], for grains that follow it. */
clast_mover moving_body_step(const moving_body *body, double t, double dt);

/* Unit quaternion w, x, y, z of its rotation. */
void pose_quaternion(const body_pose *pose, double *q);

/* Point of a wall whose place stands for the wall's. */
const double *wall_reference(const wall *wall);
/* Number of faces of a wall, and the faces at a pose. */
int wall_face_count(const wall *wall);
void wall_faces(const wall *wall, const body_pose *pose, int party, int wall_index, clast_face *out);

#endif
