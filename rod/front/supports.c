/* Where rods are held: what a scene says of it, and states that are so or are brought there. */
#include "base/memory.h"
#include "model/forces.h"
#include "rod/front/front.h"
#include "solve/ramp.h"
#include <math.h>
#include <string.h>

bool rod_read_supports(RodModel *rm, const RodScene *scene, const Build *b)
{
    Rod *rod = rm->rod;
    RodFrame frame;
    bool ok = true;
    if (scene->clamp.frame) {
        ok = rod_model_frame(b, "rod.clamp.frame", (const double(*)[3])scene->clamp.frame, &frame);
        if (ok) rod->strand[0].frame = quat_from_axes(frame.n0, frame.n1, frame.n2);
    }
    rod->strand[0].position = vec3_load(scene->clamp.position);
    rod->start = scene->hold == HOLD_PINNED ? ROD_PINNED : ROD_CLAMPED;
    if (!scene->end) return ok;
    rm->held = true;
    rod->end = scene->end->hold == HOLD_CLAMPED ? ROD_CLAMPED : ROD_PINNED;
    rm->end_position = vec3_load(scene->end->position);
    if (rod->end == ROD_CLAMPED && !scene->end->frame)
        return yaml_refuse(b->file, "rod.end", "a clamped end needs its `frame`: tangent, n1, n2");
    if (rod->end == ROD_CLAMPED &&
        !rod_model_frame(b, "rod.end.frame", (const double(*)[3])scene->end->frame, &frame))
        return false;
    if (rod->end == ROD_CLAMPED) rm->end_frame = quat_from_axes(frame.n0, frame.n1, frame.n2);
    if (isnan(scene->end->position[0]))
        return yaml_refuse(b->file, "rod.end", "`position`, where it is held, is missing");
    double apart =
        vec3_length(vec3_sub(rm->end_position, rm->curves ? rm->curves[0].x[0] : rod->strand[0].position));
    if (apart > rod_length(rod) && !rod->cosserat)
        return yaml_refuse(b->file, "rod.end.position",
                           "it is %g m from the other end, and the rod %g m long", apart, rod_length(rod));
    return ok;
}

static const double LITTLE = 1e-6;

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

bool rod_end_is_held(const RodModel *rm, const double *x)
{
    const Rod *rod = rm->rod;
    return !rm->held || rod_is_at(&rm->layout, x, rod->elements, rm->end_position,
                                  rod->end == ROD_CLAMPED ? &rm->end_frame : NULL, rod_length(rod));
}

void rod_lead_end(const RodLayout *layout, Vec3 place, const Quat *frame, double part, double *x)
{
    int last = layout->nodes - 1;
    double *at = x + layout->position + 3 * last, *to = x + layout->reference + 4 * last;
    vec3_store(at, vec3_axpy(part, vec3_sub(place, vec3_load(at)), vec3_load(at)));
    if (!frame) return;
    Quat now = rod_reference(layout, x, last), turn = quat_mul(quat_conj(now), *frame);
    Quat next = quat_unit(quat_mul(now, quat_exp(vec3_scale(part, quat_log(turn)))));
    to[0] = next.w;
    vec3_store(to + 1, next.v);
}

bool rod_move_end(const Model *model, double time, double part, double *x, Error *err)
{
    (void)time, (void)err;
    const RodModel *rm = model->self;
    rod_lead_end(&rm->layout, rm->end_position, rm->rod->end == ROD_CLAMPED ? &rm->end_frame : NULL, part, x);
    return true;
}

static bool settle_move(void *self, double part, double *x)
{
    return rod_move_end(self, 0, part, x, NULL);
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

/* The first node of each strand, or the last one. */
static Indices end_nodes(const Rod *rod, bool last)
{
    Indices nodes = {rod->strands, mem_alloc((size_t)rod->strands, sizeof(int))};
    for (int k = 0; k < rod->strands; k++)
        nodes.items[k] = k * (rod_each(rod) + 1) + (last ? rod_each(rod) : 0);
    return nodes;
}

void rod_add_supports(Model *model)
{
    const RodModel *rm = model->self;
    static const bool all[3] = {true, true, true};
    model_add_support(model, end_nodes(rm->rod, false), all);
    if (rm->held) model_add_support(model, end_nodes(rm->rod, true), all);
}

/* A hanging rod, whose places are no dofs, is held by its first nodes against all of its weight and its dead loads. */
static void hanging_forces(const Rod *rod, const double *p, double *force)
{
    int each = rod_each(rod);
    for (int k = 0; k < rod->strands; k++) {
        double *own = force + 3 * k * (each + 1), mass = rod_strand_mass(rod, k);
        for (int i = 0; i < 3; i++) {
            double load = mass * p[rod->gravity + i];
            for (int n = 0; n <= each; n++) load += p[rod->load + 3 * (k * (each + 1) + n) + i];
            own[i] = -load;
        }
    }
}

void rod_support_forces(const Model *model, const Snapshot *shot, double *force)
{
    const RodModel *rm = model->self;
    if (rm->layout.position >= 0)
        model_held_forces(model, shot, rm->layout.position, force);
    else
        hanging_forces(rm->rod, shot->p, force);
}
