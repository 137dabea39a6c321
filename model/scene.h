/* scene.h - what a scene file says, as plain structs; scene_table is their field table (io/yaml.h) and so the
 * list of all keys. What it says of its body is in the body's own folder (shell/front/scene.h). Nothing here is resolved yet: files are not read, groups not looked up (build.h does
 * that).
 *
 * Numbers are SI; an absent number is NAN, an absent choice -1, an absent list or table NULL (YamlKind). */
#pragma once
#include "io/yaml.h"
#include "model/scene_flux.h"
#include "model/scene_world.h"
#include "solve/direct.h"

/* ---- Values over faces, edges or space ---- */

/* Helper of a formula: where: {a: "atan2(y, x)"} */
struct WhereScene {
    char *name, *formula;
};

typedef struct NumberGroup {
    char *group;
    double value;
} NumberGroup;

/* One number per face or edge. */
typedef struct NumberScene {
    double value;
    char *file, *formula;
    WhereScene *where;
    NumberGroup *groups;
    double other; /* outside all groups */
    int where_count, groups_count;
} NumberScene;

typedef struct VectorGroup {
    char *group;
    double value[3], remanence[3]; /* one of them */
} VectorGroup;

/* One vector per face. */
typedef struct VectorScene {
    double value[3], remanence[3];
    char *file, **formula;
    WhereScene *where;
    VectorGroup *groups;
    double other[3];
    int formula_count, where_count, groups_count;
} VectorScene;

/* ---- A mesh and its parts ---- */

typedef enum MeshShape { MESH_SHEET, MESH_STRIP, MESH_HEXAGRAM, MESH_DISC, MESH_KIRIGAMI } MeshShape;

typedef struct MeshScene {
    char *file;
    int shape;    /* MeshShape */
    double *size; /* one or two lengths */
    int *cells, n, pattern, size_count, cells_count;
    double scale, weld;
} MeshScene;

typedef struct PoseScene {
    char *file, **formula;
    double scale; /* NAN: the mesh's */
    WhereScene *where;
    int formula_count, where_count;
} PoseScene;

/* Velocities of the vertices at the start. */
typedef struct VelocityScene {
    double value[3];
    char **formula, *file;
    WhereScene *where;
    int formula_count, where_count;
} VelocityScene;

typedef struct BallScene {
    double center[3], radius;
} BallScene;

/* Members of every entry that means some vertices. */
#define SELECTION_MEMBERS                                                                                    \
    int *vertices;                                                                                           \
    double(*box)[3];                                                                                         \
    BallScene *ball;                                                                                         \
    char *group;                                                                                             \
    bool boundary;                                                                                           \
    int vertices_count, box_count

typedef struct SelectionScene {
    SELECTION_MEMBERS;
} SelectionScene;

typedef struct FixScene {
    SELECTION_MEMBERS;
    char *axes, **move;
    bool clamp;
    int move_count;
} FixScene;

/* On a rod: an arclength, or its end. */
typedef struct LoadPointScene {
    int end;      /* 0: the end */
    double value; /* m; NAN: there */
} LoadPointScene;

typedef struct LoadScene {
    double force[3], line[3], area[3], couple[3]; /* one of them */
    SelectionScene *on;                           /* of a mesh   */
    LoadPointScene *point;                        /* of a rod    */
} LoadScene;

/* ---- Load cases ---- */

typedef struct TargetScene {
    char *file, *height_map, **formula, *cloud, *axes;
    double (*strokes)[4], width, height, blend, weight, scale; /* of a file, NAN: the mesh's, of a cloud 1 */
    WhereScene *where;
    SelectionScene *on;
    int formula_count, strokes_count, where_count;
} TargetScene;

typedef struct CaseScene {
    char *name;
    double weight, gravity[3];
    FluxScene *flux_density; /* NULL: the scene's */
    LoadScene *loads;
    TargetScene *target;
    int flux_density_count, loads_count, target_count;
} CaseScene;

/* One stage of a sequence; what it does not say stays as in the stage before. */
typedef struct StageScene {
    double gravity[3], time;
    FluxScene *flux_density;
    LoadScene *loads;
    int flux_density_count, loads_count;
} StageScene;

/* From one end to the other; of ranges beside each other one at least has a count. */
typedef struct FluxRange {
    FluxScene *from, *to;
    int from_count, to_count, count;
} FluxRange;

typedef struct LoadsRange {
    LoadScene *from, *to;
    int from_count, to_count, count;
} LoadsRange;

typedef struct GravityRange {
    double from[3], to[3];
    int count;
} GravityRange;

typedef struct TimeRange {
    double from, to;
    int count;
} TimeRange;

/* Stages one by one, or ranges. */
typedef struct SequenceScene {
    StageScene *stages;
    FluxRange *flux_density;
    LoadsRange *loads;
    GravityRange *gravity;
    TimeRange *time;
    int stages_count;
} SequenceScene;

/* ---- Design ---- */

/* Of a block with a row per face (edge, tetrahedron, element). */
typedef enum UnknownPer { PER_FACE, PER_GROUP, PER_BODY } UnknownPer;

/* Which of its rows are unknown, and which are one. */
#define ROWS_MEMBERS                                                                                         \
    int per;       /* UnknownPer                */                                                           \
    char **groups; /* of the mesh's; NULL: all  */                                                           \
    int groups_count

typedef enum UnknownScale { SCALE_LOG, SCALE_LINEAR } UnknownScale;

typedef struct NumberUnknown {
    double bounds[2], noise;
    int scale; /* UnknownScale */
    ROWS_MEMBERS;
    NumberScene *start;
} NumberUnknown;

typedef struct VectorUnknown {
    double bounds[2], noise, scale, magnitude, max_magnitude;
    ROWS_MEMBERS;
    VectorScene *start;
} VectorUnknown;

/* Of a rod. */
/* Of sources of the flux density: strengths, moves or turns. */
typedef struct SourceUnknown {
    double noise, scale, bounds[2];
    char **sources;                           /* names; NULL: all */
    int sources_count, per, knots, harmonics; /* per: ControlKind, of strengths over time; -1: constant */
} SourceUnknown;

typedef struct StrainUnknown {
    double bounds[2], noise, scale;
} StrainUnknown;

/* A row for each of a control's values, or one for all. */
typedef struct FluxStart {
    double value[3];
    char *file;
} FluxStart;

typedef struct FluxUnknown {
    double bounds[2], noise, scale;
    int per; /* ControlKind, of a trajectory */
    int knots, harmonics;
    FluxStart *start;
} FluxUnknown;

typedef struct UnknownsScene {
    VectorUnknown *magnetization;
    NumberUnknown *young, *skin_young, *thickness, *fold;
    StrainUnknown *natural_strain;
    FluxUnknown *flux_density;
    SourceUnknown *source_strength, *source_move, *source_turn;
} UnknownsScene;

/* Members of every objective of one point of the body; and frames at which it counts. */
#define TRACKED_MEMBERS                                                                                      \
    char *vertex;                                                                                            \
    bool mass_center;                                                                                        \
    int frame, *frames, frames_count

typedef struct WaypointScene {
    TRACKED_MEMBERS;
    double at[3];
} WaypointScene;

typedef struct CurveScene {
    TRACKED_MEMBERS;
    double (*points)[3], (*arc)[3], blend;
    int points_count, arc_count;
} CurveScene;

typedef struct ReachScene {
    char *vertex;
    bool mass_center;
    double (*targets)[3], every, delay;
    int targets_count;
} ReachScene;

typedef struct ObjectiveScene {
    /* One of these: a weight, or a table, to which `weight` belongs. */
    double target, height, magnetization_smoothness, young_smoothness, thickness_smoothness, fold_smoothness,
        field_magnitude, field_smoothness, dmp;
    WaypointScene *waypoint;
    CurveScene *curve;
    ReachScene *reach;
    double weight;
    char *of;                         /* height: a group, or all */
    double at;                        /* height: NAN, or its mean that is wanted */
    int frame, *frames, frames_count; /* target, height          */
    int pairs;                        /* dmp                     */
} ObjectiveScene;

typedef struct DesignScene {
    UnknownsScene unknowns;
    ObjectiveScene *objectives;
    int objectives_count, optimizer, iterations, seed;
    double tolerance;
} DesignScene;

/* ---- Probes ---- */

typedef struct ForceScene {
    int fix;
    char *group, *obstacle; /* one of them */
} ForceScene;

/* What is followed; one of these. Points are those of a vertex, a group's mean or mass_center. */
typedef struct ProbeScene {
    char *name, *vertex, *group, *height, **distance, **angle;
    bool mass_center;
    double axis[3];
    ForceScene *force;
    int couple; /* of this support; absent: none */
    int distance_count, angle_count;
} ProbeScene;

/* ---- The whole ---- */

typedef enum SceneCheck { CHECK_STABILITY, CHECK_SELF_CONTACT, CHECK_ROUND_TRIP } SceneCheck;

typedef struct SolverScene {
    int max_iterations;
    double step_tolerance, force_tolerance;
    DirectKind direct;
} SolverScene;

/* auto, or a number */
typedef struct LoadStepsScene {
    int mode, count; /* mode 0: auto */
    bool frames;
} LoadStepsScene;

/* The time t of formulas in statics, or the steps of a simulation. */
typedef struct TimeScene {
    double at, step;
    int steps;
} TimeScene;

/* last, or a number */
typedef struct StartFrameScene {
    int mode, number; /* mode 0: last */
} StartFrameScene;

typedef struct StartScene {
    char *result, *load_case;
    StartFrameScene frame;
} StartScene;

typedef struct OutputScene {
    int every, film, precision, states;
    bool stress;
    char *svg, *png, *gcode, *gcode_servo, *hpgl, *plotter; /* of a drawing: names of files */
} OutputScene;

enum { OUTPUT_SINGLE, OUTPUT_DOUBLE };
enum { STATES_LAST, STATES_ALL };

enum { BODIES_MAX = 8 };

typedef struct Scene {
    int job;                /* number of its name (rows.h)                        */
    void *body[BODIES_MAX]; /* what it says of its body, in the place of its row; else NULL (scene_of) */
    FluxScene *flux_density;
    FixScene *fix;
    LoadScene *loads;
    TargetScene *target;
    CaseScene *cases;
    SequenceScene *sequence;
    ProbeScene *probes;
    DesignScene *design;
    SolverScene solver;
    LoadStepsScene load_steps;
    TimeScene time;
    StartScene *start;
    ObstacleScene *obstacles;
    ContactScene contact;
    WaterScene *water;
    int modes;
    OutputScene output;
    int *checks; /* SceneCheck */
    int flux_density_count, fix_count, loads_count, target_count, cases_count, obstacles_count, probes_count,
        checks_count;
} Scene;

/* Its keys: the common ones, and one for each body (rows.h). */
const YamlTable *scene_table(void);
