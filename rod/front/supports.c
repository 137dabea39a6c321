/* Where rods are held: what a scene says of it, and what holds them. */
#include "base/memory.h"
#include "model/forces.h"
#include "rod/front/front.h"
#include <math.h>

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
    ok = build_rigid_move(b, key("rod.clamp"), scene->clamp.move, scene->clamp.turn, &rm->first_moves) && ok;
    vec3_store(rm->first_moves.pivot, rm->curves ? rm->curves[0].x[0] : rod->strand[0].position);
    if (!scene->end) return ok;
    rm->held = true;
    ok = build_rigid_move(b, key("rod.end"), scene->end->move, scene->end->turn, &rm->last_moves) && ok;
    rod->end = scene->end->hold == HOLD_CLAMPED ? ROD_CLAMPED : ROD_PINNED;
    rm->end_position = vec3_load(scene->end->position);
    vec3_store(rm->last_moves.pivot, rm->end_position);
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

/* Turns are increments in the frames of their nodes. */
void rod_support_couples(const Model *model, const Snapshot *shot, double *couple)
{
    const RodLayout *layout = &((const RodModel *)model->self)->layout;
    System *sys = shot->load_case->sys;
    Point at = state_point(&shot->at, shot->p);
    double *gradient = mem_alloc((size_t)layout->dofs, sizeof *gradient);
    system_gradient(sys, &at, gradient);
    for (int i = 0; i < layout->nodes; i++) {
        int turn = layout->turn + 3 * i;
        Vec3 own = system_is_fixed(sys, turn) ? vec3_load(gradient + turn) : vec3(0, 0, 0);
        vec3_store(couple + 3 * i, quat_rotate(rod_reference(layout, at.x, i), own));
    }
    mem_free(gradient);
}
