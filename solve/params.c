#include "solve/params.h"
#include "base/memory.h"
#include <assert.h>
#include <string.h>

int params_add(Params *params, const char *name, const char *unit, int count, int width, bool load)
{
    assert(!params->final && !params_find(params, name));
    int offset = params->size;
    size_t blocks = (size_t)params->block_count++;
    params->blocks = mem_resize(params->blocks, blocks, blocks + 1, sizeof *params->blocks);
    params->blocks[blocks] = (ParamBlock){name, unit, offset, count, width, load};
    params->size += count * width;
    return offset;
}

double *params_vector(Params *params)
{
    params->final = true;
    return mem_alloc((size_t)params->size, sizeof(double));
}

const ParamBlock *params_find(const Params *params, const char *name)
{
    for (int b = 0; b < params->block_count; b++)
        if (!strcmp(params->blocks[b].name, name)) return &params->blocks[b];
    return NULL;
}

void params_clear(Params *params)
{
    mem_free(params->blocks);
}
