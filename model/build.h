/* build.h - what the parts of a scene become once a mesh is there: values, selections, loads, fields,
 * targets.
 *
 * Each function takes the entry and the key under which it stands in the scene file, so that refusals point
 * at the line: they return false after adding an error to the file (yaml_refuse). */
#pragma once
#include "model/scene.h"
#include "field/timed.h"
#include "field/flux_field.h"
#include "surface/select.h"
#include "world/obstacle.h"

typedef struct Build {
    YamlFile *file;
    const Mesh *mesh;   /* NULL: of a rod */
    double size;        /* m, the body's: the scale on which fields vary */
    double time;        /* s, of formulas; where a motion begins */
    double duration;    /* s, of a motion; 0: statics */
    Timed *timed;       /* where a uniform field that depends on time is left; NULL: in statics */
    double mesh_scale;  /* of the mesh's file; 1 where it is generated */
    MeshReport *report; /* of warnings; NULL: none are wanted */
} Build;

/* The part of a rod or of a motion over which a table must have rows, at least: one over less is most likely in another
 * unit. Beyond its ends a table stays as it is there. */
#define TABLE_SHARE 0.5

/* What the models of a scene share, which begin at that time; `timed` is NULL. The size of a rod is still to be told. */
Build build_start(const Scene *scene, const Mesh *mesh, double time, YamlFile *file);

/* The path of a key: key("cases[%d].target", c). */
typedef struct Key {
    char text[160];
} Key;

Key key(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Can that name of a case, obstacle, .. be a group of the result? */
bool build_check_name(const Build *b, Key at, const char *whose, const char *name);

/* A formula of these variables (NULL-terminated) with its helpers; NULL after a refusal at that key. */
Formula *build_formula(const Build *b, Key at, char *const *formula, int count, const WhereScene *where,
                       int where_count, const char *const *variables);

/* x, y, z, r of a position, and with time t: the variables of formulas, in order. */
extern const char *const build_variables[], *const build_variables_time[];
enum { BUILD_VARIABLES = 5 };
void build_position(double *variables, const double *x, double time);

/* Three formulas of x, y, z, r at each of the places: place[count][3], values[count][3]. */
bool build_vectors_at(const Build *b, Key at, char *const *formula, const WhereScene *where, int where_count,
                      const double *place, int count, double *values);

/* A key of a mesh that not all of its sources take; the keys of a table end with NULL, and are bits by their places in it. */
typedef struct BuildKey {
    const char *key, *needed; /* what is said where it is missing; NULL: there is a default */
} BuildKey;

/* A source of meshes ("a box"), and which of the keys it takes. */
typedef struct BuildTakes {
    const char *name;
    unsigned takes;
} BuildTakes;

/* Refuses keys that were given and are not taken, and those that are missing. */
bool build_check_keys(const BuildKey *keys, BuildTakes of, unsigned given, YamlFile *yaml, const char *at);

/* The mesh that a scene describes at that key; NULL after a refusal: a key that its shape does not take, too. */
Mesh *build_mesh(const MeshScene *scene, YamlFile *yaml, const char *at, MeshReport *report);

/* A mesh file with its coordinates times scale; of tetrahedra, too. */
bool build_read_mesh(const char *path, double scale, MeshFile *file, Error *err);

/* A file with all vertices of the mesh, in another state; scale NAN: that of the mesh's file. Refused where
 * it is 100 times as large as the mesh, or as small. */
bool build_state(const Build *b, Key at, const char *path, double scale, MeshFile *file);

/* The group of that dimension (2: faces, ..); NULL after a refusal that says which there are. */
const MeshGroup *build_group(const Build *b, Key at, const char *name, int dim);

/* The cell, face or edge that is a group's member; -1 after a refusal. */
int build_element(const Build *b, Key at, const MeshGroup *group, int member);

/* A number, or three, for each of the mesh's edges (dim 1), faces (2) or cells (3): values[count], values[count][3].
 * Numbers are in this unit, which the header of a table may say otherwise. */
bool build_numbers(const Build *b, Key at, int dim, const char *unit, const NumberScene *scene,
                   double *values);
bool build_vectors(const Build *b, Key at, int dim, const VectorScene *scene, double *values);

/* Magnetisation as it is written, A/m: itself, or a remanence over mu_0. */
void build_magnetization(const double value[3], const double remanence[3], double to[3]);

/* "vertices", "edges", "faces", "tetrahedra". */
extern const char *const build_elements[];

/* The vertices of any entry with SELECTION_MEMBERS; NULL: all. found->items is the caller's. */
#define SELECTION_OF(entry)                                                                                  \
    (SelectionScene)                                                                                         \
    {                                                                                                        \
        .vertices = (entry)->vertices, .box = (entry)->box, .ball = (entry)->ball, .group = (entry)->group,  \
        .boundary = (entry)->boundary, .vertices_count = (entry)->vertices_count,                            \
        .box_count = (entry)->box_count                                                                      \
    }
bool build_selection(const Build *b, Key at, const SelectionScene *scene, Indices *found);

/* Which of the coordinates a key `axes` names. */
bool build_axes(const Build *b, Key at, const char *text, bool axes[3]);

/* load[3*vertex_count] N: the sum of all entries; the key is the list's. */
bool build_loads(const Build *b, Key at, const LoadScene *loads, int count, double *load);

/* The obstacles of the scene's key `obstacles`, (*list)[count]: the caller's, to be cleared each. */
bool build_obstacles(const Build *b, const ObstacleScene *scenes, int count, Obstacle **list);

/* Has a file in another state the faces of the mesh? */
typedef bool BuildFits(const Mesh *mesh, const MeshFile *file);

/* place[vertex_count][3] m: that of the pose; as it was where there is none. A file must fit; NULL: its faces do not matter. */
bool build_pose(const Build *b, Key at, const PoseScene *scene, BuildFits *fits, double (*place)[3]);

/* The sum of a list: uniform[3] in T, and what varies in space, added to the fields. */
bool build_flux(const Build *b, Key at, const FluxScene *list, int count, double *uniform,
                FluxFields *fields);

/* How something moves and turns, the scene's keys `move` and `turn` below `at`; its pivot stays. */
bool build_rigid_move(const Build *b, Key at, const PathScene *move, const PathScene *turn,
                      RigidMove *motion);

/* target[vertex_count][3] m; a row of NAN where a vertex has none. */
bool build_target(const Build *b, Key at, const TargetScene *scene, double (*target)[3]);
