#include "pose.h"

#include <math.h>
#include <string.h>

static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

void moving_body_init(moving_body *body, const motion_list *motion)
{
    memset(body, 0, sizeof *body);
    memcpy(body->rotation, identity, sizeof identity);
    body->motion = motion;
    body->from_origin = true;
}

bool moving_body_moves(const moving_body *body)
{
    return body->motion && body->motion->count > 0;
}

/* Integral of the table's velocity from time 0 (before the first row: its velocity). */
static double table_distance(const motion *m, int axis, double t)
{
    double sum = 0.0, previous = 0.0;
    if (t <= m->time_s[0])
        return m->table_velocity_m_s[0][axis] * t;
    sum = m->table_velocity_m_s[0][axis] * m->time_s[0];
    previous = m->time_s[0];
    for (int k = 1; k < m->count; k++) {
        double a = m->table_velocity_m_s[k - 1][axis], b = m->table_velocity_m_s[k][axis], span = m->time_s[k] - m->time_s[k - 1];
        if (t <= m->time_s[k]) {
            double u = t - previous;
            return sum + u * (a + 0.5 * (b - a) * u / span);
        }
        sum += 0.5 * (a + b) * span;
        previous = m->time_s[k];
    }
    return sum + m->table_velocity_m_s[m->count - 1][axis] * (t - previous);
}

static double table_speed(const motion *m, int axis, double t)
{
    if (t <= m->time_s[0])
        return m->table_velocity_m_s[0][axis];
    for (int k = 1; k < m->count; k++)
        if (t <= m->time_s[k]) {
            double a = m->table_velocity_m_s[k - 1][axis], b = m->table_velocity_m_s[k][axis];
            return a + (b - a) * (t - m->time_s[k - 1]) / (m->time_s[k] - m->time_s[k - 1]);
        }
    return m->table_velocity_m_s[m->count - 1][axis];
}

/* Displacement of all translations at t, counted from the body's start, and its velocity. */
static void translation(const moving_body *body, double t, double *shift, double *velocity)
{
    memset(shift, 0, 3 * sizeof *shift);
    memset(velocity, 0, 3 * sizeof *velocity);
    for (int k = 0; body->motion && k < body->motion->count; k++) {
        const motion *m = &body->motion->term[k];
        double omega = 2.0 * M_PI * m->frequency_hz;
        for (int c = 0; c < 3; c++)
            switch (m->type) {
            case MOTION_CONSTANT:
                shift[c] += m->velocity_m_s[c] * (t - body->start);
                velocity[c] += m->velocity_m_s[c];
                break;
            case MOTION_SINUSOID:
                shift[c] += m->direction[c] * m->amplitude_m *
                            (sin(omega * t + m->phase_rad) - (body->from_origin ? 0.0 : sin(omega * body->start + m->phase_rad)));
                velocity[c] += m->direction[c] * m->amplitude_m * omega * cos(omega * t + m->phase_rad);
                break;
            case MOTION_TABLE:
                shift[c] += table_distance(m, c, t) - table_distance(m, c, body->start);
                velocity[c] += table_speed(m, c, t);
                break;
            case MOTION_ROTATION:
                break;
            }
    }
}

/* Rodrigues' formula. */
static void rotation_matrix(const double *axis, double angle, double *r)
{
    double c = cos(angle), s = sin(angle), v = 1.0 - c, x = axis[0], y = axis[1], z = axis[2];
    const double m[9] = {c + v * x * x,     v * x * y - s * z, v * x * z + s * y, v * x * y + s * z, c + v * y * y,
                         v * y * z - s * x, v * x * z - s * y, v * y * z + s * x, c + v * z * z};
    memcpy(r, m, sizeof m);
}

static void multiply(const double *a, const double *b, double *out)
{
    double r[9];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            r[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
    memcpy(out, r, sizeof r);
}

static void apply(const double *r, const double *x, double *out)
{
    double y[3];
    for (int i = 0; i < 3; i++)
        y[i] = r[3 * i] * x[0] + r[3 * i + 1] * x[1] + r[3 * i + 2] * x[2];
    memcpy(out, y, sizeof y);
}

static const motion *rotation_term(const moving_body *body)
{
    for (int k = 0; body->motion && k < body->motion->count; k++)
        if (body->motion->term[k].type == MOTION_ROTATION)
            return &body->motion->term[k];
    return NULL;
}

/* The axis of a rotation moves with the translations of the same list. */
body_pose moving_body_pose(const moving_body *body, double t)
{
    body_pose pose;
    double shift[3];
    translation(body, t, shift, pose.velocity);
    memcpy(pose.rotation, body->rotation, sizeof pose.rotation);
    memcpy(pose.shift, body->shift, sizeof pose.shift);
    memset(pose.spin, 0, sizeof pose.spin);
    memset(pose.pivot, 0, sizeof pose.pivot);
    const motion *turn = rotation_term(body);
    if (turn) {
        double r[9], arm[3];
        rotation_matrix(turn->axis, turn->rate_rad_s * (t - body->start), r);
        multiply(r, body->rotation, pose.rotation);
        for (int c = 0; c < 3; c++)
            arm[c] = body->shift[c] - turn->point_m[c];
        apply(r, arm, arm);
        for (int c = 0; c < 3; c++) {
            pose.shift[c] = turn->point_m[c] + arm[c];
            pose.spin[c] = turn->rate_rad_s * turn->axis[c];
            pose.pivot[c] = turn->point_m[c] + shift[c];
        }
    }
    for (int c = 0; c < 3; c++)
        pose.shift[c] += shift[c];
    return pose;
}

void moving_body_change(moving_body *body, const motion_list *motion, double t)
{
    body_pose pose = moving_body_pose(body, t);
    memcpy(body->rotation, pose.rotation, sizeof pose.rotation);
    memcpy(body->shift, pose.shift, sizeof pose.shift);
    body->start = t;
    body->from_origin = false;
    body->motion = motion;
}

void pose_vector(const body_pose *pose, const double *v0, double *v)
{
    apply(pose->rotation, v0, v);
}

void pose_point(const body_pose *pose, const double *x0, double *x)
{
    apply(pose->rotation, x0, x);
    for (int c = 0; c < 3; c++)
        x[c] += pose->shift[c];
}

clast_mover moving_body_step(const moving_body *body, double t, double dt)
{
    clast_mover m;
    memset(&m, 0, sizeof m);
    double before[3], after[3], velocity[3];
    translation(body, t, before, velocity);
    translation(body, t + dt, after, m.velocity);
    const motion *turn = rotation_term(body);
    m.axis[2] = 1.0;
    for (int c = 0; c < 3; c++)
        m.shift[c] = after[c] - before[c];
    if (turn) {
        double angle = turn->rate_rad_s * dt, half = sin(0.5 * angle);
        m.sine = sin(angle);
        m.versine = 2.0 * half * half;
        for (int c = 0; c < 3; c++) {
            m.axis[c] = turn->axis[c];
            m.pivot[c] = turn->point_m[c] + before[c];
            m.pivot_end[c] = turn->point_m[c] + after[c];
            m.spin[c] = turn->rate_rad_s * turn->axis[c];
        }
    }
    return m;
}

int wall_face_count(const wall *wall)
{
    if (wall->shape == WALL_CONE)
        return 2; /* a wedged sphere touches it on both sides of the axis */
    if (wall->shape != WALL_BOX)
        return 1;
    int count = 0;
    for (int f = 0; f < 6; f++)
        count += !wall->open[f];
    return count;
}

static void normalise(double *v)
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int c = 0; c < 3; c++)
        v[c] /= length;
}

static void cross(const double *a, const double *b, double *out)
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* A rectangle from its centre and two half edges, in the scene's own pose. */
static void set_rectangle(clast_face *face, const double *centre, const double *a, const double *b)
{
    face->shape = CLAST_FACE_RECTANGLE;
    face->extent[0] = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    face->extent[1] = sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    for (int c = 0; c < 3; c++) {
        face->origin[c] = centre[c];
        face->e1[c] = a[c] / face->extent[0];
        face->e2[c] = b[c] / face->extent[1];
    }
    cross(face->e1, face->e2, face->normal);
    normalise(face->normal);
}

static void set_box_face(const wall *wall, int side, clast_face *face)
{
    int axis = side / 2, first = (axis + 1) % 3, second = (axis + 2) % 3;
    double centre[3], a[3] = {0, 0, 0}, b[3] = {0, 0, 0};
    for (int c = 0; c < 3; c++)
        centre[c] = 0.5 * (wall->low_m[c] + wall->high_m[c]);
    centre[axis] = side % 2 ? wall->high_m[axis] : wall->low_m[axis];
    a[first] = 0.5 * (wall->high_m[first] - wall->low_m[first]);
    b[second] = 0.5 * (wall->high_m[second] - wall->low_m[second]);
    set_rectangle(face, centre, a, b);
}

/* Two unit vectors square to n and to one another. */
static void set_frame(const double *n, clast_face *face)
{
    double pick[3] = {0, 0, 0};
    pick[fabs(n[0]) < 0.6 ? 0 : 1] = 1.0;
    memcpy(face->normal, n, sizeof face->normal);
    cross(n, pick, face->e1);
    normalise(face->e1);
    cross(n, face->e1, face->e2);
}

static void set_flat(const wall *wall, clast_face *face)
{
    bool disc = wall->shape == WALL_DISC;
    face->shape = disc ? CLAST_FACE_DISC : CLAST_FACE_PLANE;
    face->extent[0] = disc ? wall->radius_m : 0.0;
    memcpy(face->origin, disc ? wall->center_m : wall->point_m, sizeof face->origin);
    set_frame(wall->normal, face);
}

static void set_round(const wall *wall, bool far, clast_face *face)
{
    double widen = wall->radii_m[1] - wall->radii_m[0];
    face->shape = far ? CLAST_FACE_ROUND_FAR : CLAST_FACE_ROUND;
    memcpy(face->origin, wall->axis_point_m, sizeof face->origin);
    memcpy(face->extent, wall->radii_m, sizeof face->extent);
    face->slant_length = hypot(wall->length_m, widen);
    face->slant[0] = wall->length_m / face->slant_length;
    face->slant[1] = widen / face->slant_length;
    set_frame(wall->axis, face);
}

static void set_rectangle_wall(const wall *wall, clast_face *face)
{
    double centre[3], a[3], b[3];
    for (int c = 0; c < 3; c++) {
        a[c] = 0.5 * (wall->corners_m[1][c] - wall->corners_m[0][c]);
        b[c] = 0.5 * (wall->corners_m[2][c] - wall->corners_m[0][c]);
        centre[c] = wall->corners_m[0][c] + a[c] + b[c];
    }
    set_rectangle(face, centre, a, b);
}

static void place_face(clast_face *face, const body_pose *pose, int party, int wall_index)
{
    pose_point(pose, face->origin, face->origin);
    pose_vector(pose, face->normal, face->normal);
    pose_vector(pose, face->e1, face->e1);
    pose_vector(pose, face->e2, face->e2);
    memcpy(face->velocity, pose->velocity, sizeof face->velocity);
    memcpy(face->spin, pose->spin, sizeof face->spin);
    memcpy(face->pivot, pose->pivot, sizeof face->pivot);
    face->party = party;
    face->wall = wall_index;
}

void wall_faces(const wall *wall, const body_pose *pose, int party, int wall_index, clast_face *out)
{
    int count = wall_face_count(wall);
    memset(out, 0, sizeof *out * (size_t)count);
    if (wall->shape == WALL_BOX) {
        for (int side = 0, f = 0; side < 6; side++)
            if (!wall->open[side])
                set_box_face(wall, side, &out[f++]);
    } else if (wall->shape == WALL_RECTANGLE) {
        set_rectangle_wall(wall, out);
    } else if (wall->shape == WALL_CYLINDER || wall->shape == WALL_CONE) {
        for (int f = 0; f < count; f++)
            set_round(wall, f == 1, &out[f]);
    } else {
        set_flat(wall, out);
    }
    for (int f = 0; f < count; f++)
        place_face(&out[f], pose, party, wall_index);
}

const double *wall_reference(const wall *wall)
{
    switch (wall->shape) {
    case WALL_PLANE:
        return wall->point_m;
    case WALL_BOX:
        return wall->low_m;
    case WALL_RECTANGLE:
        return wall->corners_m[0];
    case WALL_DISC:
        return wall->center_m;
    default:
        return wall->axis_point_m;
    }
}

void pose_quaternion(const body_pose *pose, double *q)
{
    const double *r = pose->rotation;
    double largest = 0.0, square[4] = {1 + r[0] + r[4] + r[8], 1 + r[0] - r[4] - r[8], 1 - r[0] + r[4] - r[8], 1 - r[0] - r[4] + r[8]};
    int most = 0;
    for (int k = 0; k < 4; k++)
        if (square[k] > largest) {
            largest = square[k];
            most = k;
        }
    double s = 0.5 / sqrt(largest);
    const double part[4][4] = {{largest, r[7] - r[5], r[2] - r[6], r[3] - r[1]},
                               {r[7] - r[5], largest, r[1] + r[3], r[2] + r[6]},
                               {r[2] - r[6], r[1] + r[3], largest, r[5] + r[7]},
                               {r[3] - r[1], r[2] + r[6], r[5] + r[7], largest}};
    for (int k = 0; k < 4; k++)
        q[k] = s * part[most][k];
}
