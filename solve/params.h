/* params.h - every physical parameter of a model in one contiguous vector p, divided into named blocks.
 *
 * Scene key = block name = design variable name = result dataset name. A derivative dp has the same layout. The
 * layout belongs to the model and does not change; the values are plain vectors p[layout.size], as many as there are
 * load cases. */
#pragma once
#include <stdbool.h>

typedef struct ParamBlock {
    const char *name; /* "young", "magnetization", ...; static text                            */
    const char *unit; /* "Pa", "A/m", ...                                                      */
    int offset;       /* first entry in p                                                      */
    int count, width; /* rows and numbers per row: [count][width]                              */
    bool load;        /* a load: scaled from 0 to 1 by load steps                              */
} ParamBlock;

enum { PARAMS_MAX_BLOCKS = 16 };

typedef struct Params {
    int block_count, size;
    ParamBlock blocks[PARAMS_MAX_BLOCKS];
} Params;

/* Appends a block and returns its offset. */
int params_add(Params *params, const char *name, const char *unit, int count, int width, bool load);

/* The block of that name, or NULL. */
const ParamBlock *params_find(const Params *params, const char *name);
