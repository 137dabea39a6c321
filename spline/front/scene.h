/* scene.h - what a scene says of a drawing. */
#pragma once
#include "model/rows.h"
#include "spline/weights.h"

typedef enum ToneFit { TONE_CONTAIN, TONE_COVER } ToneFit;

typedef struct ToneScene {
    double crop[4], black, white, gamma, density;
    double (*curve)[2];
    int fit, curve_count; /* ToneFit */
    bool invert;
} ToneScene;

/* A name, or two sides. */
typedef struct PaperScene {
    char *name;
    double *sides;
    int sides_count;
} PaperScene;

typedef struct PageScene {
    PaperScene size;
    double margin;
} PageScene;

typedef struct PenScene {
    char *name, *color;
    double width, from, turn;
    bool opaque;
} PenScene;

typedef enum SeparationKind { SEPARATE_CMYK, SEPARATE_TONES, SEPARATE_MATCH } SeparationKind;

typedef struct SeparationScene {
    int kind, intent; /* SeparationKind, InkIntent */
    double black;
} SeparationScene;

typedef struct CrossScene {
    double angle, *from;
    int from_count;
} CrossScene;

typedef struct DirectionScene {
    int image; /* 0: structure tensor */
    double angle, detail, smooth, spread, turn;
    char **formula, *file;
    WhereScene *where;
    int formula_count, where_count;
} DirectionScene;

typedef enum ContoursKind { CONTOURS_EDGES, CONTOURS_OUTLINES } ContoursKind;

/* Edges, outlines, or lines of equal tone. */
typedef struct ContoursScene {
    int kind; /* ContoursKind */
    double *levels, contrast, detail, shortest, width;
    int levels_count;
    char *color;
    bool opaque;
} ContoursScene;

typedef enum RegionFit { REGION_CONTAIN, REGION_PAPER } RegionFit;

typedef struct RegionScene {
    char *svg, *mask, *pen;
    int fit; /* RegionFit */
    bool invert;
    DirectionScene *direction; /* NULL: the drawing's */
} RegionScene;

typedef enum StrokesStart { START_STREAMLINES, START_RANDOM } StrokesStart;

/* A kind, or a file. */
typedef struct StrokesScene {
    char *file;
    int kind, segments; /* StrokesStart */
    double separation, ink, longest;
} StrokesScene;

/* A density, or a potential. */
typedef struct FieldScene {
    char *formula;
    WhereScene *where;
    int where_count;
} FieldScene;

typedef struct FlowScene {
    char **formula;
    WhereScene *where;
    int formula_count, where_count;
} FlowScene;

typedef struct PairScene {
    int kernel; /* PairKernel */
    double radius;
} PairScene;

typedef struct MonteCarloScene {
    int temperatures, sweeps;
    double first, last;
} MonteCarloScene;

typedef struct DynamicsScene {
    double step, damping;
    int steps;
} DynamicsScene;

typedef struct ZAxisScene {
    double up, down, speed;
} ZAxisScene;

typedef struct ServoScene {
    char *up, *down;
    int pause; /* ServoPause */
} ServoScene;

typedef enum ServoPause { PAUSE_SECONDS, PAUSE_MILLISECONDS } ServoPause;

typedef struct PlotterScene {
    double down, up, lift, at_most;
    char *profile;
    ZAxisScene *z;     /* NULL: the default */
    ServoScene *servo; /* NULL: the default */
} PlotterScene;

typedef struct SplineScene {
    char *image, *paper;
    FieldScene *density, *potential;
    FlowScene *flow;
    ToneScene tone;
    PageScene page;
    double pen;
    PenScene *pens;
    RegionScene *regions;
    SeparationScene *separation;
    CrossScene *cross;
    ContoursScene *contours;
    DirectionScene direction;
    StrokesScene start;
    SplineWeights energies;
    PairScene pair;
    int method, iterations, rounds, seed, order, pens_count, regions_count; /* RelaxMethod; DrawOrder */
    double tolerance, rest;
    bool draft;
    MonteCarloScene monte_carlo;
    DynamicsScene dynamics;
    PlotterScene plotter;
} SplineScene;

typedef enum DrawOrder { ORDER_SHORTEST, ORDER_AS_MADE } DrawOrder;

extern const YamlTable spline_table;
extern const BodyRow spline_body; /* body.c */

const SplineScene *spline_scene(const Scene *scene);
