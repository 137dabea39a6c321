/* params.h - every physical parameter of a model in one contiguous vector p, divided into named blocks.
 *
 * Scene key = block name = design variable name = result dataset name. A derivative dp has the same layout. First all
 * that blocks hold is counted, then they are added, one behind the other, and then vectors are made: p[size], as many
 * as there are load cases. So an offset is final as soon as its block is there, and nothing grows later. */
#pragma once
#include <stdbool.h>

typedef struct ParamBlock {
    const char *name; /* "young", "magnetization", ...; static text                            */
    const char *unit; /* "Pa", "A/m", ...                                                      */
    int offset;       /* first entry in p                                                      */
    int count, width; /* rows and numbers per row: [count][width]                              */
    bool load;        /* a load: scaled from 0 to 1 by load steps                              */
} ParamBlock;

typedef struct Params {
    int block_count, size;
    ParamBlock *blocks; /* owned; those of a layout that is final stay where they are */
    bool final;         /* there are vectors                                          */
} Params;

/* Appends a block and returns its offset; before the first vector. */
int params_add(Params *params, const char *name, const char *unit, int count, int width, bool load);

/* A vector of zeros, p[size], which is the caller's; from now on the layout is final. */
double *params_vector(Params *params);

/* The block of that name, or NULL. */
const ParamBlock *params_find(const Params *params, const char *name);

void params_clear(Params *params);
