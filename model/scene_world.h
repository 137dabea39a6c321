/* scene_world.h - what a scene says of what its body meets: obstacles, contact and water. */
#pragma once
#include "model/scene_flux.h"
#include <stdbool.h>

typedef struct PlaneScene {
    double point[3], normal[3];
} PlaneScene;

typedef struct SphereScene {
    double center[3], radius;
    bool inside;
} SphereScene;

typedef struct CylinderScene {
    double point[3], axis[3], radius;
    bool inside;
} CylinderScene;

typedef struct BoxScene {
    double center[3], half[3], rounding; /* rounding NAN: a tenth of the smallest half */
} BoxScene;

typedef struct HeightFieldScene {
    char *formula, *image;
    struct WhereScene *where;
    double height, (*range)[2]; /* height: of an image */
    int cells[2], where_count, range_count;
} HeightFieldScene;

typedef struct TubeScene {
    int axis; /* x, y, z */
    char *radius, **center;
    double range[2];
    int cells, center_count;
} TubeScene;

typedef struct BlockScene {
    char *file;
    double scale, cell;
} BlockScene;

typedef struct ObstacleScene {
    char *name; /* NULL: obstacle1, .. */
    PlaneScene *plane;
    SphereScene *sphere;
    CylinderScene *cylinder;
    BoxScene *box;
    HeightFieldScene *height_field;
    TubeScene *tube;
    BlockScene *mesh;
    double friction; /* NAN: contact.friction */
    PathScene *move, *turn;
} ObstacleScene;

/* true or false, or what it is made of */
typedef struct SelfContactScene {
    bool enabled;
    double distance, stiffness; /* NAN: from the body */
} SelfContactScene;

/* auto, or a number */
typedef struct AutoScene {
    int mode; /* 0: auto */
    double value;
} AutoScene;

typedef enum ContactCoupling { COUPLING_LAGGED, COUPLING_IMPLICIT } ContactCoupling;

typedef struct ContactScene {
    double friction, slip_speed;
    SelfContactScene self;
    AutoScene stiffness, offset;
    int coupling; /* ContactCoupling */
} ContactScene;

/* Does the body meet itself? */
bool self_contact_is_asked(const SelfContactScene *self);

typedef struct StreamScene {
    double value[3];
    char **formula;
    struct WhereScene *where;
    int formula_count, where_count;
} StreamScene;

typedef enum WaterSides { SIDES_TWO, SIDES_OUTER } WaterSides;

typedef struct WaterScene {
    double density, viscosity;
    StreamScene velocity;
    int sides; /* WaterSides */
} WaterScene;
