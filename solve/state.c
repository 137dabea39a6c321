#include "solve/state.h"
#include "base/memory.h"
#include <string.h>

State state_create(int dofs, int memory_count)
{
    size_t n = (size_t)dofs;
    return (State){.dofs = dofs,
                   .memory_count = memory_count,
                   .x = mem_alloc(n, sizeof(double)),
                   .v = mem_alloc(n, sizeof(double)),
                   .memory = mem_alloc((size_t)memory_count, sizeof(double))};
}

void state_destroy(State *state)
{
    mem_free(state->x);
    mem_free(state->v);
    mem_free(state->memory);
    *state = (State){0};
}

void state_copy(State *to, const State *from)
{
    memcpy(to->x, from->x, (size_t)from->dofs * sizeof *to->x);
    for (int i = 0; i < from->dofs; i++) to->v[i] = from->v ? from->v[i] : 0;
    memcpy(to->memory, from->memory, (size_t)from->memory_count * sizeof *to->memory);
    to->time = from->time;
}

State state_clone(const State *from)
{
    State state = state_create(from->dofs, from->memory_count);
    state_copy(&state, from);
    return state;
}
