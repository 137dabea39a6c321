/* show_mesh.h - the mesh of a result, cut open if that is asked for: what its pages draw, and the numbers on it.
 *
 * A face shows its own number; where it has none, that of the tetrahedron that it is a side of, or lies in. */
#pragma once
#include "view/clip.h"
#include "view/show_data.h"

/* Numbers, or vectors, of the faces and of the tetrahedra; NULL: they have none. */
typedef struct ShowRows {
    const double *faces, *cells;
} ShowRows;

typedef struct ShowMesh {
    ShowData *data;
    ClipBody body; /* the whole                                                           */
    Clip clip;     /* what is shown of it                                                 */
    int part_count;
    const int *part;        /* [body.face_count] row of the skin's numbers; NULL: each face has its own */
    ShowRows magnetization; /* of the final design */
    bool magnetic;          /* somewhere */
} ShowMesh;

/* Reads it and cuts it at the plane of the data's ShowDef, so that one sees the cut. Clear it in any case. */
bool show_mesh_read(ShowMesh *mesh, ShowData *data, Error *err);
void show_mesh_clear(ShowMesh *mesh);

/* Of the whole body's vertices, what is kept of them and what is new; NULL for NULL. */
const double (*show_mesh_points(const ShowMesh *mesh, const double (*x)[3]))[3];

/* Have frames an array of CellData of their own each, as those of a design do, or have all the same one? */
bool show_mesh_has_own(const ShowMesh *mesh, const char *name);

/* Of a frame, in material space; -1, or where the frames have no other: of the final design. */
ShowRows show_mesh_magnetization(const ShowMesh *mesh, int step);

/* The magnetisation of each face that is shown, in a frame or the final one (-1), as the body carries it to where its vertices
 * are. */
const double (*show_mesh_carried(const ShowMesh *mesh, int step, const double (*x)[3]))[3];

/* A number for each face that is shown, of the field that was asked for; NULL: a plain surface. step: the frame, -1: the
 * last, and the final design. False where there is no such field. */
bool show_mesh_field(const ShowMesh *mesh, int step, const double **values, const char **name,
                     const char **unit, Error *err);
