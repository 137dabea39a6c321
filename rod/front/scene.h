/* scene.h - what a scene says of a rod. */
#pragma once
#include "model/rows.h"

/* auto, or a standard deviation. */
typedef struct NoiseScene {
    int mode; /* 0: auto */
    double value;
} NoiseScene;

typedef struct RodCurveScene {
    char **formula, *file, *parameter;
    double *range, scale;
    WhereScene *where;
    NoiseScene noise;
    int formula_count, range_count, where_count, strands;
} RodCurveScene;

/* Strains along a rod. */
typedef struct StrainScene {
    double value[3];
    char **formula, *file;
    WhereScene *where;
    int formula_count, where_count;
} StrainScene;

typedef enum FrameKind { FRAME_FRENET, FRAME_BISHOP } FrameKind;

typedef struct RodFrameScene {
    int kind, from; /* FrameKind */
    char *formula, *file;
} RodFrameScene;

/* Rows of a frame: tangent, n1, n2. */
typedef struct ClampScene {
    double position[3], (*frame)[3];
    PathScene *move, *turn;
    int frame_count;
} ClampScene;

typedef enum HoldKind { HOLD_CLAMPED, HOLD_PINNED } HoldKind;

/* The other end: where it is held, or, of a curve that is inverted, what its support does there. */
typedef struct EndScene {
    double position[3], (*frame)[3], force[3], couple[3];
    PathScene *move, *turn;
    int hold, frame_count, choose; /* HoldKind; RodEndChoice, -1: force and couple are given */
} EndScene;

/* Three numbers, or formulas of them. */
typedef struct LoadVectorScene {
    double value[3];
    char **formula;
    WhereScene *where;
    int formula_count, where_count;
} LoadVectorScene;

typedef struct RodLoadScene {
    LoadPointScene *point;
    LoadVectorScene *line, *force, *couple;
    char *potential;
    WhereScene *where;
    int where_count;
} RodLoadScene;

typedef struct RodPoseScene {
    char *file;
    double (*frame)[3];
    NoiseScene noise;
    int frame_count;
} RodPoseScene;

/* A curve of a moving rod. */
typedef struct RodMotionFrameScene {
    char *file;
    double time;
    NoiseScene noise;
} RodMotionFrameScene;

typedef enum RodDifference { ROD_CENTRAL, ROD_BACKWARD } RodDifference;

typedef struct RodMotionScene {
    RodMotionFrameScene *frames;
    char *result;
    int frames_count, difference; /* RodDifference */
} RodMotionScene;

typedef enum RodSolver { ROD_SOLVER_NEWTON, ROD_SOLVER_PBD } RodSolver;

typedef struct PbdScene {
    int substeps, sweeps;
} PbdScene;

/* A number of a rod, the same everywhere or along it. */
typedef struct AlongScene {
    double value;
    char *formula, *file;
    WhereScene *where;
    int where_count;
} AlongScene;

typedef struct SectionScene {
    AlongScene *width, *height, *area, *I1, *I2, *J;
    double kappa[2], contact_radius;
} SectionScene;

typedef enum RodKind { ROD_KIRCHHOFF, ROD_COSSERAT } RodKind;

typedef enum RodStart { ROD_START_NATURAL, ROD_START_CURVE } RodStart;

typedef struct RodScene {
    RodCurveScene *curve;
    StrainScene *natural_strain;
    RodPoseScene *poses;
    RodMotionScene *motion;
    AlongScene *radius, *young;
    SectionScene *section;
    double length, *ellipse, poisson, density, gravity[3], bishop_normal[3], damping;
    ClampScene clamp;
    EndScene *end;
    int elements, ellipse_count, poses_count, loads_count, frames_count;
    RodFrameScene frame, *frames;
    RodLoadScene *loads;
    VectorScene magnetization;
    double coercivity; /* A/m */
    VelocityScene *velocity;
    int model, start, hold, solver; /* RodKind; RodStart; HoldKind of the clamp; RodSolver */
    PbdScene pbd;
} RodScene;

extern const YamlTable rod_table;
extern const BodyRow rod_body; /* body.c */

const RodScene *rod_scene(const Scene *scene);
