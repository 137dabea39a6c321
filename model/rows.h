/* rows.h - the bodies that a scene may have and the jobs that it may ask for: a row each. Nothing else asks what kind a
 * body or a job is.
 *
 * A body's row stands in its folder's front (shell/front/body.c), THE list of them in lib/bodies.c. Its jobs are those
 * of job/ that fit it and its own; the scene's key `job` has the names of all. */
#pragma once
#include "base/memory.h"
#include "io/arrays.h"
#include "io/result.h"
#include "model/build.h"
#include "optim/case.h"
#include "solve/masses.h"
#include "solve/newton.h"
#include "solve/params.h"
#include "world/world.h"

struct Model;
struct Run;

/* ---- Jobs ---- */

/* What a job ends with, and the exit codes of `slender run`. */
typedef enum RunStatus {
    RUN_DONE = 0,
    RUN_NOT_CONVERGED = 1, /* computed, and said so in the result */
    RUN_USAGE = 2,
    RUN_REFUSED = 3, /* scene or mesh */
    RUN_CANNOT_WRITE = 4,
    RUN_NO_MEMORY = 5,
    RUN_INTERRUPTED = 75, /* state saved: go on with --resume */
} RunStatus;

/* Where a job's frames are once its result is safe. */
typedef enum FramesThen {
    FRAMES_STAY,  /* in the journal, too: they are few                                                  */
    FRAMES_MOVE,  /* in the result only: a run that is extended takes them back (job/recall.h)          */
    FRAMES_AGAIN, /* in the result only: a run that is extended makes them again, from what it has kept */
} FramesThen;

/* What the rows of a job's probes are (probe.h). */
typedef enum ProbeRows {
    PROBED_STAGES, /* frames that are states of rest */
    PROBED_TIMES,  /* frames of a motion             */
    PROBED_EVALUATIONS,
} ProbeRows;

/* As measured on scenes/ and by ./do bench equilibria: Newton iterations of a solve and of one that goes on from another,
 * factorisations and solves of each (in time some iterations make do with an older factor; a design's solves are those
 * of its optimiser, too), and bytes of the picture while it is drawn. */
typedef struct Effort {
    double first, more, factorizations, solves, picture;
} Effort;

typedef struct JobRow {
    const char *name;                              /* the value of the scene's key `job` */
    RunStatus (*run)(struct Run *run, Error *err); /* as job_run (job/run.h) */
    const char *noun;                              /* "a simulation" */
    bool motion;                                   /* steps of time: `time` has them, systems have inertia */
    bool path;                                     /* all of the motion is kept while it runs              */
    bool design;                                   /* the scene's key `design` says what it looks for      */
    bool rest;                                     /* it looks for rest: forces on a free body must balance */
    bool leads; /* it leads what is held to its place while loads come on; else it begins with that there  */
    bool given; /* it looks at the state that it is given, and solves for none                             */
    FramesThen frames;
    ProbeRows probed;
    const char *const *free_keys; /* that a run which goes on may change; ends with NULL */
    Effort effort;
} JobRow;

/* ---- Bodies ---- */

/* A common key (of the scene's root) that the body does not always take: under which condition (YamlField.when; what
 * there is in its place stands in braces). */
typedef struct KeyUse {
    const char *key, *when;
} KeyUse;

/* Where the step of time began that ended in a state, as a Point has it; lag NULL: at x. */
typedef struct StepStart {
    const double *x, *v, *lag; /* [dofs] */
    double dt;
} StepStart;

/* One state to be shown or stored, with p[params] of a case; borrowed. */
typedef struct Snapshot {
    const Case *load_case;
    const double *p;
    State at;
    NewtonStatus status;
    const double *anchor;  /* of a simulation: where the next step's factor stands (system_anchor) */
    const StepStart *from; /* of a step of time, for BodyOps.supports; NULL: as in statics          */
    const WorldSums *felt; /* of a step of time, what it met at its end; NULL: as in statics */
    const double *held;    /* [point_count][3] of a step of time, what its supports do; NULL: as in statics */
    double part;           /* of an equilibrium's frame: how much of its stage's loads p has */
} Snapshot;

/* What one evaluation takes on this machine, and the factor; s, bytes (job/predict.h). */
typedef struct Cost {
    double build, hessian, factor, solve; /* pattern, order and places; each once                  */
    double numbers, flops, factor_bytes;  /* of a factor                                           */
    bool exact;                           /* they are counted, not a law's                         */
    double elements, system_bytes;        /* triangles or pieces; of each of them in a System       */
    double picture;                       /* s beside what each element takes                       */
    bool stability;                       /* a few eigenvalues are found at the end                */
    Effort effort;                        /* the job's, unless the body knows better               */
} Cost;

/* A static array that tells a body from others of its kind, and what a result with another one is of: "a mesh with
 * other faces". */
typedef struct Likeness {
    const char *name, *other;
} Likeness;

/* What is out of balance in a pose: the largest of these forces where nothing is held, and what that is relative to. */
typedef struct Balance {
    const char *what, *unit; /* "forces", "N" */
    double most, scale;
    bool finite;
} Balance;

/* On which way what is held is: from where it is at `since` (NAN: from where the body was made) to where it is at `time`. x has it
 * at a part (0..1) of the way, `from`, and gets it at the part `to`. */
typedef struct HeldWay {
    double since, time, from, to;
} HeldWay;

/* All of it. */
static inline HeldWay held_way(double time)
{
    return (HeldWay){time, time, 0, 1};
}

/* How a body becomes numbers, and how its states are written into the journal. A refusal at a key (yaml_refuse) gives
 * false. Every body has create, destroy, add_static and describe; one with load cases all else that is not said to be
 * optional. Of what is optional and NULL the body has none, and scenes that ask for it are refused. */
typedef struct BodyOps {
    /* Everything of the model: body, params, cases with their systems and starts. */
    bool (*create)(struct Model *model, const Scene *scene, YamlFile *file);
    void (*destroy)(void *body);

    /* Of a case or stage into its p: dead loads; places of its target, NAN where there is none. */
    bool (*put_loads)(struct Model *model, const Build *b, const char *at, const LoadScene *loads, int count,
                      double *p);
    bool (*put_target)(struct Model *model, const Build *b, const char *at, const TargetScene *scene,
                       double (*target)[3]);

    /* What of the body's own loads depends on time, into p; a sentence where it is not finite. Optional. */
    bool (*load)(const struct Model *model, double time, double *p, Error *err);

    /* Are its loads known at its points, place[point_count][3]? A sentence where not. Optional. */
    bool (*knows)(const struct Model *model, double time, const double *place, Error *err);

    /* Of which elements of the mesh a block of p has a row each: edges (1), faces (2), cells (3). Optional where there is
     * no mesh. */
    int (*row_dim)(const struct Model *model, const ParamBlock *block);

    /* Which of a block's rows act on anything; [block->count]; NULL: all. Optional. */
    const bool *(*rows_on)(const struct Model *model, const ParamBlock *block);

    /* The values of a block of p, as an unknown's start says them. */
    bool (*put_numbers)(struct Model *model, const Build *b, const char *at, const NumberScene *scene,
                        const ParamBlock *block, double *values);
    bool (*put_vectors)(struct Model *model, const Build *b, const char *at, const VectorScene *scene,
                        const ParamBlock *block, double *values);

    /* The points of a part that has a name, or `all`. */
    bool (*select)(const struct Model *model, const Build *b, const char *at, const char *name,
                   Indices *found);
    /* Of all points, kg; to be cleared; optional. */
    Masses (*masses)(const struct Model *model);

    /* Sum of squared jumps of a block of p between neighbours; optional. */
    Objective (*smoothness)(const struct Model *model, const ParamBlock *block, double weight);

    /* Held coordinates, further on their way. */
    bool (*move)(const struct Model *model, HeldWay way, double *x, Error *err);

    /* Its energies over its dofs, prepared: of statics, or with inertia. The caller's; the model outlives it. */
    System *(*system)(const struct Model *model, bool motion);

    /* What its supports do to its points, force[point_count][3] N: 0 where nothing is held. At rest, or at the end of a step
     * of time, what is held being accelerated and damped (model_point). */
    void (*supports)(const struct Model *model, const Snapshot *shot, double *force);
    /* The couples there, couple[point_count][3] N m: 0 where no frame is held. Optional. */
    void (*couples)(const struct Model *model, const Snapshot *shot, double *couple);

    /* All points held: what is left relaxes in a given pose. The caller's; optional. */
    System *(*pose_system)(const struct Model *model);

    /* Is a given pose in balance? Forces that hold what cannot give way (multipliers) go into the case's state as they do
     * it best. Optional, where it is the forces on the points. */
    Balance (*balance)(const struct Model *model, Case *c);

    /* Into the journal: what does not change (rest shape, faces or lines); of a frame beside places and field, numbers
     * per cell and per point, cell/NAME and point/NAME (`whole`: those too that seldom change; optional); of a state beside places and energies, under prefix/..; of
     * the final state, once: its stability, so many modes, and what else it shows. */
    void (*add_static)(const struct Model *model, Arrays *list);
    void (*add_frame)(const struct Model *model, const Snapshot *shot, bool whole, Arrays *list);
    void (*add_state)(const struct Model *model, const Snapshot *shot, const char *prefix, Arrays *list);
    /* What its parts bear in a frame, cell/NAME and point/NAME: strains, stresses, moments. Optional. */
    void (*add_stress)(const struct Model *model, const Snapshot *shot, Arrays *list);
    void (*add_final)(const struct Model *model, const Snapshot *shot, int modes, Arrays *list);

    /* What a result that a model starts from has to have alike; ends with {0}; optional. And a state from[dofs] of such a result
     * in the form of the model's own, x; optional, where all have one form. */
    const Likeness *likeness;
    bool (*take_state)(const struct Model *model, const double *from, int dofs, double *x, Error *err);

    /* Places of its points, place[point_count][3], in the state x[dofs]. */
    void (*places)(const struct Model *model, const double *x, double *place);

    /* What the state cannot be trusted in, a sentence of the caller's; NULL: nothing. Optional. */
    char *(*doubt)(const struct Model *model, const Snapshot *shot);

    /* What in the state is none of this body any more, so that its energies mean nothing (a face without area), and why; a
     * sentence of the caller's; NULL: nothing. `failed`: no state was found from there on, and what is near it is the
     * reason. Optional. */
    char *(*crushed)(const struct Model *model, const Snapshot *shot, bool failed);
    NewtonStatus crushed_as; /* what such a state is said to be */

    /* Lines on what the scene made, for `slender check`; the caller's. */
    char *(*describe)(const struct Model *model, const Scene *scene);

    /* Warnings into the model's report, before any work; optional. */
    void (*advise)(struct Model *model, const Scene *scene);

    /* How far each dof moves in a small motion (m, rad, N): the length of a piece, ..; 0: it is no unknown. */
    void (*dof_sizes)(const struct Model *model, double *size);
    void (*cost)(const struct Model *model, Cost *cost);

    /* Writes what a result shows as a file of that language (svg, gcode, ..), unless it has nothing yet; optional. */
    bool (*write)(Result *result, const char *language, const char *path, bool *written, Error *err);
} BodyOps;

typedef struct BodyRow {
    const char *key;           /* of the scene: "shell"                  */
    const char *noun, *nouns;  /* "a shell", "shells"                    */
    const char *doc;           /* of its key                             */
    const YamlTable *table;    /* the keys of its scene                  */
    const KeyUse *uses;        /* ends with {0}                          */
    const JobRow *const *jobs; /* ends with NULL                        */
    const BodyOps *ops;
} BodyRow;

extern const BodyRow *const bodies[]; /* lib/bodies.c; ends with NULL */

/* The row of the scene's body; that of its job, NULL where the body has no such job. */
const BodyRow *scene_body(const Scene *scene);
const JobRow *scene_job(const Scene *scene);

/* A body's job of that name; NULL: it has none. */
const JobRow *body_job(const BodyRow *body, const char *name);

/* What the scene says of that body; NULL: it has another one. */
const void *scene_of(const Scene *scene, const BodyRow *row);
