#include "model/forces.h"
#include "base/memory.h"
#include <string.h>

void model_add_support(Model *model, Indices points, const bool axis[3])
{
    size_t count = (size_t)model->support_count++;
    model->supports = mem_resize(model->supports, count, count + 1, sizeof *model->supports);
    model->supports[count] = (Support){points, {axis[0], axis[1], axis[2]}};
}

Point model_point(const Snapshot *shot)
{
    Point at = state_point(&shot->at, shot->p);
    const StepStart *from = shot->from;
    if (from) at.x_prev = from->x, at.v_prev = from->v, at.x_lag = from->lag, at.dt = from->dt;
    return at;
}

/* What holds each point; to be freed. */
static double *held_forces(const Model *model, const Snapshot *shot)
{
    size_t count = 3 * (size_t)model->point_count;
    if (shot->held) return mem_copy(shot->held, count, sizeof *shot->held);
    double *force = mem_alloc(count, sizeof *force);
    model->body->ops->supports(model, shot, force);
    return force;
}

/* Of what is done to each point (freed here) the sums over the supports. */
static void sum_supports(const Model *model, double *left, double (*force)[3])
{
    for (int k = 0; k < model->support_count; k++) {
        const Support *support = &model->supports[k];
        memset(force[k], 0, sizeof force[k]);
        for (int n = 0; n < 3 * support->points.count; n++) {
            int axis = n % 3, i = 3 * support->points.items[n / 3] + axis;
            if (!support->axis[axis]) continue;
            force[k][axis] += left[i];
            left[i] = 0;
        }
    }
    mem_free(left);
}

void model_support_forces(const Model *model, const Snapshot *shot, double (*force)[3])
{
    sum_supports(model, held_forces(model, shot), force);
}

void model_support_couples(const Model *model, const Snapshot *shot, double (*couple)[3])
{
    double *all = mem_alloc(3 * (size_t)model->point_count, sizeof *all);
    model->body->ops->couples(model, shot, all);
    sum_supports(model, all, couple);
}

void model_add_supports(const Model *model, const Snapshot *shot, const char *prefix, Arrays *list)
{
    int count = model->support_count;
    if (!count) return;
    double *force = arrays_numbers(list, 3 * (size_t)count);
    model_support_forces(model, shot, (double(*)[3])force);
    char *name = arrays_keep(list, mem_format("%s/support_force", prefix));
    arrays_add(list, array_float(name, "N", force, 2, count, 3));
    if (!model->body->ops->couples) return;
    double *couple = arrays_numbers(list, 3 * (size_t)count);
    model_support_couples(model, shot, (double(*)[3])couple);
    name = arrays_keep(list, mem_format("%s/support_couple", prefix));
    arrays_add(list, array_float(name, "N m", couple, 2, count, 3));
}

void model_force_on(const Model *model, const Snapshot *shot, const Indices *points, double force[3])
{
    double *all = held_forces(model, shot);
    memset(force, 0, 3 * sizeof *force);
    for (int n = 0; n < 3 * points->count; n++) force[n % 3] += all[3 * points->items[n / 3] + n % 3];
    mem_free(all);
}

ContactSums model_contacts(const Model *model, const Snapshot *shot, Arrays *list)
{
    const World *world = model->world;
    if (shot->felt) return shot->felt->contact;
    WorldSums all = {
        .contact = {.force = (double(*)[3])arrays_numbers(list, 3 * (size_t)world->obstacle_count),
                    .point = arrays_numbers(list, (size_t)shot->at.dofs)}};
    Point at = state_point(&shot->at, shot->p);
    world_measure(world, &at, &all);
    return all.contact;
}

void model_held_forces(const Model *model, const Snapshot *shot, int first, double *force)
{
    System *sys = shot->load_case->sys;
    Point at = model_point(shot);
    double *gradient = mem_alloc((size_t)shot->at.dofs, sizeof *gradient);
    system_gradient(sys, &at, gradient);
    for (int i = 0; i < 3 * model->point_count; i++)
        force[i] = system_is_fixed(sys, first + i) ? gradient[first + i] : 0;
    mem_free(gradient);
}
