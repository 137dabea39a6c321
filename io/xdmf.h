/* xdmf.h - the sidecar that shows the steps of a result to ParaView 5.11. Private to result.c. */
#pragma once
#include "io/journal.h"

typedef struct XdmfDef {
    const char *result; /* path of the .vtkhdf file */
    int vertex_count, face_count, step_count;
    const double *times;
    bool double_points;
} XdmfDef;

/* The file's text, the caller's. fields: names of the frames' arrays, cell/.. and point/..; frames: their
 * indices. */
char *xdmf_text(const XdmfDef *def, char *const *fields, int field_count, Journal *journal,
                const int *frames);
