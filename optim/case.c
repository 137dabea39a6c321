#include "optim/case.h"
#include "base/memory.h"
#include <string.h>

Case case_create(const char *name, const double *p, size_t size, double time)
{
    Case c = {.name = mem_text(name), .weight = 1, .stage_count = 1};
    c.stages = mem_alloc(1, sizeof *c.stages);
    c.stages[0] = (Stage){mem_copy(p, size, sizeof *p), time};
    return c;
}

void case_clear(Case *c)
{
    for (int s = 0; s < c->stage_count; s++) mem_free(c->stages[s].p);
    for (int k = 0; k < c->objective_count; k++) objective_destroy(c->objectives[k]);
    system_destroy(c->sys);
    state_destroy(&c->state);
    mem_free(c->name);
    mem_free(c->stages);
    mem_free(c->objectives);
    for (int k = 0; k < c->target_count; k++) {
        mem_free(c->targets[k].place);
        mem_free(c->targets[k].cloud.segments);
        mem_free(c->targets[k].cloud.points);
    }
    mem_free(c->targets);
    mem_free(c->loads);
    mem_free(c->anchor);
    *c = (Case){0};
}

void case_start(Case *c, System *sys, const double *x)
{
    c->sys = sys;
    c->state = system_state(sys);
    memcpy(c->state.x, x, (size_t)c->state.dofs * sizeof *x);
    c->state.time = c->stages[0].time;
}

Objective *case_add_objective(Case *c)
{
    size_t count = (size_t)c->objective_count++;
    c->objectives = mem_resize(c->objectives, count, count + 1, sizeof *c->objectives);
    return &c->objectives[count];
}
