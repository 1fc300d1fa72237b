/* Walls that keep a force (docs/theory.md, "Servo"): after every step one work-group sums what the bed pushes back with, advances the drives
 * and places their faces for the next step, so that the host waits for nothing. Forces are summed as whole numbers of a small unit: the
 * order in which records stand depends on when the table was built, and that sum does not. */
OUTLINE void servo_place_row(__global const clast_servo *servos, __global clast_face *row, int face_count)
{
    for (int f = 0; f < face_count; f++) {
        if (row[f].drive < 0)
            continue;
        __global const clast_servo *s = servos + row[f].drive;
        for (int c = 0; c < 3; c++) {
            precise way = precise_mul(precise_load(s->shift), precise_load(s->direction[c]));
            row[f].origin[c] = precise_store(precise_add(precise_load(row[f].origin[c]), way));
            row[f].pivot[c] = precise_store(precise_add(precise_load(row[f].pivot[c]), way));
            row[f].velocity[c] = precise_store(precise_from(number(row[f].velocity[c]) + number(s->velocity) * number(s->direction[c])));
        }
    }
}

/* Before a batch: the faces of its first step. */
__kernel void servo_place(__global const clast_servo *restrict servos, __global clast_face *restrict faces, const int face_count)
{
    servo_place_row(servos, faces, face_count);
}

/* M u' = F - f - C u, the damper implicit; positions with the new velocity. Counts reversals at more than half of the largest speed. */
OUTLINE void servo_advance(__global clast_servo *s, real force, real dt)
{
    real before = number(s->velocity), most = number(s->speed_max), damping = number(s->damping), fastest = number(s->fastest);
    real rate = (number(s->target) - force - damping * before) / (number(s->mass) + dt * damping);
    precise velocity = precise_add_scaled(precise_load(s->velocity), dt, precise_from(rate));
    if (fabs(rounded(velocity)) > most)
        velocity = precise_from(rounded(velocity) > R(0.0) ? most : -most);
    real u = rounded(velocity);
    bool turned = (u < R(0.0)) != (before < R(0.0));
    s->reversals += turned && fastest > R(0.5) * most ? 1 : 0;
    s->fastest = precise_store(precise_from(turned || fabs(u) > fastest ? fabs(u) : fastest));
    s->force = precise_store(precise_from(force));
    s->velocity = precise_store(velocity);
    s->shift = precise_store(precise_add_scaled(precise_load(s->shift), dt, velocity));
}

/* One work-group. Wall records stand from first_record to end_record; `rows` of faces were written for this batch. */
__kernel void servo_stage(const clast_launch launch, __global clast_control *restrict control, __global clast_servo *restrict servos,
                          __global clast_face *restrict faces, __global const int *restrict other, __global const real *restrict force,
                          const int servo_count, const int first_record, const int end_record, const int rows)
{
    __local long sum[CLAST_BLOCK];
    int lane = get_local_id(0);
    bool halted = control->halt_step <= launch.step;
    __global const clast_face *row = faces + launch.face_row * launch.face_count;
    for (int d = 0; d < servo_count; d++) {
        vec3 direction = v3(number(servos[d].direction[0]), number(servos[d].direction[1]), number(servos[d].direction[2]));
        real inverse = number(servos[d].inverse_unit);
        long mine = 0;
        for (int k = first_record + lane; k < end_record && servos[d].live; k += CLAST_BLOCK)
            if (row[other[k]].drive == d)
                mine += convert_long_sat_rte(inverse * dot3(LOAD_POLAR3(force, launch.record_stride, k), direction));
        sum[lane] = mine;
        barrier(CLK_LOCAL_MEM_FENCE);
        if (lane == 0 && servos[d].live && !halted) {
            for (int l = 1; l < CLAST_BLOCK; l++)
                mine += sum[l];
            servo_advance(servos + d, (real)mine * number(servos[d].unit), number(launch.dt));
            if (fabs(rounded(precise_sub(precise_load(servos[d].shift), precise_load(servos[d].built)))) > number(servos[d].travel_max)) {
                control->reason = CLAST_HALT_TRAVEL;
                control->halt_step = launch.step + 1;
            }
        }
        barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    }
    if (lane == 0 && !halted && launch.face_row + 1 < rows)
        servo_place_row(servos, faces + (launch.face_row + 1) * launch.face_count, launch.face_count);
}
