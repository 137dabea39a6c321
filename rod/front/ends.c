/* The ends of rods where they are held: at what time where, and states that are so or are brought there. */
#include "base/memory.h"
#include "rod/front/front.h"
#include "solve/ramp.h"
#include <math.h>
#include <string.h>

static const double LITTLE = 1e-6;
static const double TURN_MOST =
    1; /* rad in a step of time or loads: an element takes no more than half a turn */

/* ---- Where they are ---- */

/* A node that is held before it moves, and how it moves. */
typedef struct Hold {
    int node;
    Vec3 place;
    Quat frame;
    bool clamped;
    const RigidMove *moves;
    Key at;
} Hold;

static Hold first_hold(const RodModel *rm, int strand)
{
    const RodStrand *base = &(rm->base ? rm->base : rm->rod->strand)[strand];
    return (Hold){.node = strand * (rod_each(rm->rod) + 1),
                  .place = base->position,
                  .frame = base->frame,
                  .clamped = rm->rod->start == ROD_CLAMPED,
                  .moves = &rm->first_moves,
                  .at = key("rod.clamp")};
}

static Hold last_hold(const RodModel *rm)
{
    return (Hold){.node = rm->rod->elements,
                  .place = rm->end_position,
                  .frame = rm->end_frame,
                  .clamped = rm->rod->end == ROD_CLAMPED,
                  .moves = &rm->last_moves,
                  .at = key("rod.end")};
}

static void put_frame(const RodLayout *layout, int node, Quat frame, double *x)
{
    double *to = x + layout->reference + 4 * node;
    to[0] = frame.w;
    vec3_store(to + 1, frame.v);
}

bool rod_ends_move(const RodModel *rm)
{
    return rigid_move_is_given(&rm->first_moves) || rigid_move_is_given(&rm->last_moves);
}

typedef struct EndPose {
    Vec3 moved, turned; /* m; a rotation vector */
} EndPose;

static bool pose_at(const Hold *hold, double time, EndPose *pose, Error *err)
{
    double moved[3], turned[3];
    if (!rigid_move_vectors(hold->moves, time, moved, turned, err))
        return error_prefix(err, "%s", hold->at.text);
    *pose = (EndPose){vec3_load(moved), vec3_load(turned)};
    return true;
}

/* At a part of the way. */
static bool pose_on(const Hold *hold, HeldWay way, double part, EndPose *pose, Error *err)
{
    EndPose was = {0}, is = {0};
    if (!isnan(way.since) && !pose_at(hold, way.since, &was, err)) return false;
    if (!pose_at(hold, way.time, &is, err)) return false;
    pose->moved = vec3_axpy(part, is.moved, vec3_scale(1 - part, was.moved));
    pose->turned = vec3_axpy(part, is.turned, vec3_scale(1 - part, was.turned));
    return true;
}

static Quat turn_frame(EndPose pose, Quat frame)
{
    return quat_unit(quat_mul(quat_exp(pose.turned), frame));
}

static void turn_pose(EndPose pose, Vec3 pivot, Vec3 *place, Quat *frame)
{
    Vec3 from = vec3_sub(*place, pivot);
    *place = vec3_add(vec3_add(quat_rotate(quat_exp(pose.turned), from), pivot), pose.moved);
    *frame = turn_frame(pose, *frame);
}

static void turn_back(EndPose pose, Vec3 pivot, Vec3 *place, Quat *frame)
{
    Quat back = quat_exp(vec3_scale(-1, pose.turned));
    *place = vec3_add(quat_rotate(back, vec3_sub(vec3_sub(*place, pose.moved), pivot)), pivot);
    *frame = quat_unit(quat_mul(back, *frame));
}

bool rod_leads_ends(const Model *model)
{
    return model->job->leads && !model->general;
}

/* Where a hold is at that time. */
static bool stand_at(Hold *hold, double time, Error *err)
{
    EndPose pose;
    if (!rigid_move_is_given(hold->moves)) return true;
    if (!pose_at(hold, time, &pose, err)) return false;
    turn_pose(pose, vec3_load(hold->moves->pivot), &hold->place, &hold->frame);
    return true;
}

bool rod_stand_first(const Model *model, double *x, Error *err)
{
    RodModel *rm = model->self;
    Rod *rod = rm->rod;
    RodLayout layout = rod_layout(rod, false);
    EndPose pose;
    if (!rigid_move_is_given(&rm->first_moves)) return true;
    rm->base = mem_copy(rod->strand, (size_t)rod->strands, sizeof *rm->base);
    Hold hold = first_hold(rm, 0);
    if (!pose_at(&hold, model->time, &pose, err)) return false;
    Vec3 pivot = vec3_load(hold.moves->pivot);
    for (int k = 0; !rod_leads_ends(model) && k < rod->strands; k++)
        turn_pose(pose, pivot, &rod->strand[k].position, &rod->strand[k].frame);
    for (int i = 0; !rod_leads_ends(model) && i < layout.nodes; i++)
        put_frame(&layout, i, turn_frame(pose, rod_reference(&layout, x, i)), x);
    return true;
}

bool rod_is_near(Vec3 place, Vec3 wanted, double size)
{
    return vec3_length(vec3_sub(place, wanted)) <= LITTLE * size;
}

bool rod_is_at(const RodLayout *layout, const double *x, int node, Vec3 place, const Quat *frame, double size)
{
    bool near = layout->position < 0 || rod_is_near(vec3_load(x + layout->position + 3 * node), place, size);
    Quat turn = frame ? quat_mul(quat_conj(*frame), rod_reference(layout, x, node)) : (Quat){1, {0, 0, 0}};
    return near && vec3_length(turn.v) <= LITTLE;
}

bool rod_end_is_held(const RodModel *rm, double time, const double *x)
{
    Hold hold = last_hold(rm);
    if (!rm->held) return true;
    return stand_at(&hold, time, NULL) && rod_is_at(&rm->layout, x, hold.node, hold.place,
                                                    hold.clamped ? &hold.frame : NULL, rod_length(rm->rod));
}

bool rod_last_is_near(const RodModel *rm, double time, Vec3 place)
{
    Hold hold = last_hold(rm);
    return !rm->held || (stand_at(&hold, time, NULL) && rod_is_near(place, hold.place, rod_length(rm->rod)));
}

/* ---- As results show them ---- */

int rod_support_count(const RodModel *rm)
{
    return rm->rod->strands + rm->held;
}

static void put_pose(const Hold *hold, double pose[12])
{
    const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int j = 0; j < 4; j++) {
        Vec3 column = j < 3 ? quat_rotate(hold->frame, axes[j]) : hold->place;
        if (j < 3 && !hold->clamped) column = vec3(NAN, NAN, NAN);
        pose[j] = column.x, pose[4 + j] = column.y, pose[8 + j] = column.z;
    }
}

static Hold hold_of(const RodModel *rm, int k)
{
    return k < rm->rod->strands ? first_hold(rm, k) : last_hold(rm);
}

void rod_support_poses(const RodModel *rm, double *poses)
{
    for (int k = 0; k < rod_support_count(rm); k++) {
        Hold hold = hold_of(rm, k);
        put_pose(&hold, poses + 12 * k);
    }
}

void rod_support_poses_in(const RodModel *rm, const double *x, double *poses)
{
    for (int k = 0; k < rod_support_count(rm); k++) {
        Hold hold = hold_of(rm, k);
        hold.place = vec3_load(x + rm->layout.position + 3 * hold.node);
        hold.frame = rod_reference(&rm->layout, x, hold.node);
        put_pose(&hold, poses + 12 * k);
    }
}

/* ---- Leading them there ---- */

static void put_node(const RodLayout *layout, int node, Vec3 place, Quat frame, double *x)
{
    vec3_store(x + layout->position + 3 * node, place);
    put_frame(layout, node, frame, x);
}

void rod_lead_end(const RodLayout *layout, int node, Vec3 place, const Quat *frame, double part, double *x)
{
    Vec3 at = vec3_load(x + layout->position + 3 * node);
    Quat now = rod_reference(layout, x, node), next = now;
    if (frame) {
        Quat turn = quat_mul(quat_conj(now), *frame);
        next = quat_unit(quat_mul(now, quat_exp(vec3_scale(part, quat_log(turn)))));
    }
    put_node(layout, node, vec3_axpy(part, vec3_sub(place, at), at), next, x);
}

/* One that moves: what it has moved and turned grows evenly, by whole turns, too; beside that x comes to the hold. */
static bool lead_moving(const RodLayout *layout, const Hold *hold, HeldWay way, double *x, Error *err)
{
    EndPose was = {0}, is = {0};
    if (!pose_on(hold, way, way.from, &was, err) || !pose_on(hold, way, way.to, &is, err)) return false;
    Vec3 pivot = vec3_load(hold->moves->pivot), place = vec3_load(x + layout->position + 3 * hold->node);
    Quat free = rod_reference(layout, x, hold->node), frame = free;
    turn_back(was, pivot, &place, &frame);
    put_node(layout, hold->node, place, frame, x);
    rod_lead_end(layout, hold->node, hold->place, &hold->frame, ramp_part(way.from, way.to), x);
    place = vec3_load(x + layout->position + 3 * hold->node), frame = rod_reference(layout, x, hold->node);
    if (way.to == 1) place = hold->place, frame = hold->frame;
    turn_pose(is, pivot, &place, &frame);
    put_node(layout, hold->node, place, hold->clamped ? frame : free, x);
    return true;
}

static bool lead(const RodLayout *layout, const Hold *hold, HeldWay way, double *x, Error *err)
{
    if (rigid_move_is_given(hold->moves)) return lead_moving(layout, hold, way, x, err);
    rod_lead_end(layout, hold->node, hold->place, hold->clamped ? &hold->frame : NULL,
                 ramp_part(way.from, way.to), x);
    return true;
}

static bool lead_last(const RodModel *rm, HeldWay way, double *x, Error *err)
{
    Hold hold = last_hold(rm);
    return !rm->held || lead(&rm->layout, &hold, way, x, err);
}

bool rod_move_ends(const Model *model, HeldWay way, double *x, Error *err)
{
    const RodModel *rm = model->self;
    bool ok = true;
    for (int k = 0; ok && rm->base && k < rm->rod->strands; k++) {
        Hold hold = first_hold(rm, k);
        ok = lead(&rm->layout, &hold, way, x, err);
    }
    return ok && lead_last(rm, way, x, err);
}

static bool settle_move(void *self, double from, double to, double *x)
{
    const Model *model = self;
    return lead_last(model->self, (HeldWay){NAN, model->time, from, to}, x, NULL);
}

bool rod_settle(Model *model, const Build *b, const double *p)
{
    RodModel *rm = model->self;
    double *unloaded = mem_copy(p, (size_t)model->params->size, sizeof *p);
    for (int k = 0; k < model->params->block_count; k++) {
        const ParamBlock *block = &model->params->blocks[k];
        if (block->load)
            memset(unloaded + block->offset, 0, (size_t)(block->count * block->width) * sizeof *p);
    }
    System *sys = rod_system(rm->rod, rm->young, false);
    RampDef def = ramp_default();
    def.newton.step_cap = model->step_cap;
    def.steps = model->load_steps;
    def.move = settle_move, def.self = model;
    State state = system_state(sys);
    size_t bytes = (size_t)state.dofs * sizeof *state.x;
    memcpy(state.x, model->x, bytes);
    RampInfo info = ramp_solve(sys, model->params, &def, NULL, unloaded, &state);
    memcpy(model->x, state.x, bytes);
    state_destroy(&state);
    system_destroy(sys);
    mem_free(unloaded);
    return info.reached >= 1 ||
           yaml_refuse(b->file, "rod.end", "the rod could not be brought to where its end is held (%s)",
                       newton_status_text(info.newton.status));
}

/* ---- Can the rod follow? ---- */

/* Ends further apart than an inextensible rod is long. */
static bool check_apart(const RodModel *rm, const Build *b, Hold first, Hold last, double time)
{
    double length = rod_length(rm->rod);
    if (!rm->held || rm->rod->cosserat || !stand_at(&first, time, NULL) || !stand_at(&last, time, NULL))
        return true;
    double apart = vec3_length(vec3_sub(last.place, first.place));
    return apart <= length * (1 + 1e-9) ||
           yaml_refuse(b->file, rigid_move_is_given(last.moves) ? "rod.end" : "rod.clamp",
                       "at t = %g s the ends are %g m apart, and the rod is %g m long", time, apart, length);
}

/* rad, between two times; since NAN: from where it was made. A formula that is not finite is told where it is used. */
static double turned(const Hold *hold, double since, double time)
{
    EndPose was = {0}, is = {0};
    HeldWay way = {since, time, 0, 1};
    if (!pose_on(hold, way, 0, &was, NULL) || !pose_on(hold, way, 1, &is, NULL)) return 0;
    return vec3_length(vec3_sub(is.turned, was.turned));
}

static bool check_steps(const RodModel *rm, const Scene *scene, const Build *b, const Hold holds[2])
{
    const TimeScene *time = &scene->time;
    for (int n = 0; n < time->steps; n++) {
        double since = b->time + n * time->step, now = since + time->step;
        for (int k = 0; k < 2; k++)
            if (turned(&holds[k], since, now) > TURN_MOST)
                return yaml_refuse(
                    b->file, holds[k].at.text,
                    "it turns by %.3g rad within a step of time, at t = %g s; a rod follows %g "
                    "rad: a smaller `time.step` is needed",
                    turned(&holds[k], since, now), since, TURN_MOST);
        if (!check_apart(rm, b, holds[0], holds[1], now)) return false;
    }
    return true;
}

/* The turns between stages go over as many load steps as they need. */
static bool check_stage(Model *model, const Scene *scene, const Build *b, const Hold holds[2], double since,
                        double time)
{
    const LoadStepsScene *given = &scene->load_steps;
    double most = fmax(turned(&holds[0], since, time), turned(&holds[1], since, time));
    int needed = (int)ceil(fmin(most / TURN_MOST, 1e6));
    if (needed > model->load_steps) model->load_steps = needed;
    if (given->mode < 0 && given->count < needed && rod_leads_ends(model))
        return yaml_refuse(b->file, "load_steps",
                           "an end turns by %.3g rad up to t = %g s; a rod follows %g rad in a load step: %d "
                           "steps are needed, or `auto`",
                           most, time, TURN_MOST, needed);
    return check_apart(model->self, b, holds[0], holds[1], time);
}

bool rod_check_ends(Model *model, const Scene *scene, const Build *b)
{
    const RodModel *rm = model->self;
    const Hold holds[2] = {first_hold(rm, 0), last_hold(rm)};
    if (!rod_ends_move(rm)) return true;
    bool ok = true;
    for (int c = 0; ok && c < model->case_count; c++)
        for (int s = 0; ok && s < model->cases[c].stage_count; s++) {
            const Stage *stages = model->cases[c].stages;
            double since = s ? stages[s - 1].time : scene->start ? stages[s].time : NAN;
            ok = check_stage(model, scene, b, holds, since, stages[s].time);
        }
    return ok && (!model->job->motion || check_steps(rm, scene, b, holds));
}
