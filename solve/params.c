#include "solve/params.h"
#include <assert.h>
#include <string.h>

int params_add(Params *params, const char *name, const char *unit, int count, int width, bool load)
{
    assert(params->block_count < PARAMS_MAX_BLOCKS && !params_find(params, name));
    int offset = params->size;
    params->blocks[params->block_count++] = (ParamBlock){name, unit, offset, count, width, load};
    params->size += count * width;
    return offset;
}

const ParamBlock *params_find(const Params *params, const char *name)
{
    for (int b = 0; b < params->block_count; b++)
        if (!strcmp(params->blocks[b].name, name)) return &params->blocks[b];
    return NULL;
}
