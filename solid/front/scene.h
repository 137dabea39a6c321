/* scene.h - what a scene says of a solid. */
#pragma once
#include "model/rows.h"

/* The generated meshes, in the order of the key `shape`. */
typedef enum SolidShape {
    SOLID_BOX,
    SOLID_PLATE,
    SOLID_HAND,
    SOLID_HEART,
    SOLID_STARFISH,
    SOLID_SHAPES
} SolidShape;

typedef struct SolidMeshScene {
    char *file, *surface;
    MeshScene *extrude;
    int shape; /* SolidShape */
    double *size, thickness, scale;
    int *cells, n, layers, pattern, size_count, cells_count;
} SolidMeshScene;

/* Where a skin is. */
typedef struct SkinPlace {
    char *group; /* of faces */
} SkinPlace;

/* The layer on the surface: magnetised, and a film if it has a modulus. */
typedef struct SkinScene {
    double thickness, poisson; /* the latter NAN where there is none */
    int material;              /* MembraneMaterial                    */
    NumberScene *young;        /* NULL: none                         */
    VectorScene magnetization;
    SkinPlace *on; /* NULL: all of the surface */
} SkinScene;

typedef struct SolidScene {
    SolidMeshScene mesh;
    PoseScene *pose;
    VelocityScene *velocity;
    SkinScene *skin;
    NumberScene young;
    VectorScene magnetization; /* of the volume */
    double poisson, density, averaging, coercivity, damping, gravity[3];
    int order, material; /* 1 or 2; SolidMaterial */
} SolidScene;

extern const YamlTable solid_table, solid_mesh_table;
extern const BodyRow solid_body; /* body.c */

const SolidScene *solid_scene(const Scene *scene);
