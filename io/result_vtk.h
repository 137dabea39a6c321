/* result_vtk.h - the frames of a journal as the group /VTKHDF of a result. Private to result.c.
 *
 * An UnstructuredGrid over time (VTKHDF 2.0) of triangles, from static/faces, of tetrahedra, from static/cells, and
 * triangles after them, or of poly lines, from static/lines; points that never move, static/still, follow those of each
 * frame. */
#pragma once
#include "io/hdf5_file.h"
#include "io/journal.h"

/* The cells on which the frames are shown: triangles, tetrahedra and triangles, or polylines of two points or more. */
typedef struct VtkCells {
    bool lines;
    int count;
    int *types;   /* [count] VTK's                                                         */
    int uniform;  /* points of every cell; 0: they differ                                  */
    int id_count; /* of all cells                                                          */
    int *ids;     /* [id_count] points of the cells, one after the other                   */
    int *offsets; /* [count + 1] where each cell begins in ids                             */
    int mixed_count;
    int *mixed; /* [mixed_count] as XDMF lists cells that differ; NULL if uniform        */
} VtkCells;

/* What is being written. */
typedef struct VtkFrames {
    Journal *journal;
    Hdf5 *file;
    bool single; /* positions and fields as float32, as long as that resolves the body */
    VtkCells cells;
    int vertex_count, count; /* vertices with those that stand still */
    int still_count;
    double (*still)[3]; /* [still_count] points of static/still, the last ones of every frame */
    int *frames;        /* [count] indices of the journal */
    double *times;      /* [count] s */
    char **fields;      /* names of the first frame: those that the file has */
    int field_count;
} VtkFrames;

/* Does the journal say on which cells its frames are shown? False where that cannot be read. */
bool vtk_frames_exist(Journal *journal, bool *exist, Error *err);

/* Reads the cells, times and names of a VtkFrames that has its journal and frames. False and a sentence for
 * lines that are not within the frames' points. */
bool vtk_frames_read(VtkFrames *frames, Error *err);
void vtk_frames_clear(VtkFrames *frames);

/* Writes the group. */
bool vtk_frames_write(VtkFrames *frames, Error *err);

/* Writes one array of the frames at a path: a chunk per frame that has it, of the rows of all frames, or
 * stacked, [chunks,rows,width]. offsets_path: where each step's rows begin; NULL: not written. */
bool vtk_frames_put(VtkFrames *frames, const char *name, const char *path, const char *offsets_path,
                    bool stacked, Error *err);
