/* model.h - a scene made ready to run: a shell or a rod, its load cases and what is prescribed over time; or
 * a drawing. */
#pragma once
#include "io/arrays.h"
#include "model/scene.h"
#include "model/timed_flux.h"
#include "io/formula.h"
#include "optim/control.h"
#include "optim/design.h"
#include "surface/select.h"
#include "shell/shell.h"
#include "solve/newton.h"
#include "solve/objective.h"

/* Loads at a moment: one, or the stages of a sequence. */
typedef struct Stage {
    double *p; /* [params] owned */
    double time;
} Stage;

typedef struct ModelCase {
    char *name;
    double weight;
    System *sys;
    State state; /* where to start */
    int stage_count;
    Stage *stages;
    int objective_count;
    Objective *objectives;
    double (*target)[3]; /* [vertex] m, NAN where there is none; NULL: no target */
} ModelCase;

/* Coordinates that follow formulas of rest position and time. */
typedef struct Motion {
    Formula *formula;
    Indices vertices;
    bool axis[3];
    int entry; /* of the scene's `fix` */
} Motion;

/* One state to be shown or stored, with p[params] of a case; borrowed. */
typedef struct Snapshot {
    const ModelCase *load_case;
    const double *p;
    State at;
    NewtonStatus status;
} Snapshot;

typedef struct Model Model;

struct Build;

/* What is not alike for shells, rods and drawings: how scenes become numbers, and how states are written into
 * the journal. */
typedef struct BodyOps {
    /* Of a case or stage into its p: dead loads; places of its target, NAN where there is none. False after a
     * refusal at that key. */
    bool (*put_loads)(Model *model, const struct Build *b, const char *at, const LoadScene *loads, int count,
                      double *p);
    bool (*put_target)(Model *model, const struct Build *b, const char *at, const TargetScene *scene,
                       double (*target)[3]);

    /* Held coordinates where they are at that time, a part of the way (0..1) from where x has them. */
    bool (*move)(const Model *model, double time, double part, double *x, Error *err);

    /* What does not change: rest shape, faces or lines. */
    void (*add_static)(const Model *model, Arrays *list);

    /* Places of its points, place[point_count][3], in the state x[dofs]. */
    void (*places)(const Model *model, const double *x, double *place);

    /* Of a frame beside places and field: numbers per cell. `whole`: those too that seldom change. */
    void (*add_frame)(const Model *model, const Snapshot *shot, bool whole, Arrays *list);

    /* Of a state beside places and energies, under prefix/.. */
    void (*add_state)(const Model *model, const Snapshot *shot, const char *prefix, Arrays *list);

    /* Of the final state, once: its stability, so many modes, and what else it shows. */
    void (*add_final)(const Model *model, const Snapshot *shot, int modes, Arrays *list);

    /* What the state cannot be trusted in, a sentence of the caller's; NULL: nothing. May be NULL itself. */
    char *(*doubt)(const Model *model, const Snapshot *shot);
} BodyOps;

/* What a scene says of the flux density, of all cases or of one. */
typedef struct CaseFlux {
    double uniform[3]; /* T */
    int field;         /* one of the body's fields, which vary in space; -1: none */
} CaseFlux;

struct RodModel;

struct Model {
    Shell *shell;            /* one of these three */
    struct RodModel *rod;    /* rod_model.h        */
    struct Drawing *drawing; /* drawing.h; nothing below is of it but body->add_static */
    const BodyOps *body;
    Params *params; /* the body's                                          */
    int gravity;    /* first entries in p                                  */
    int flux_density, field_scale;
    FluxFields *fields; /* the body's */
    int point_count;    /* vertices or nodes                                   */
    int load_steps;     /* of an equilibrium, unless the scene says            */
    double step_cap;    /* of Newton                                           */
    bool moves;         /* held coordinates do: BodyOps.move                   */
    MeshReport report;  /* warnings about the mesh */
    int case_count, motion_count;
    ModelCase *cases;
    Motion *motions;
    double *x;              /* [dofs] rest or pose */
    Design design;          /* of a design or trajectory */
    Control control;        /* of a trajectory: the unknown flux density; no rows: none */
    CaseFlux *flux;         /* of the scene, then of each case or stage */
    TimedFlux flux_of_time; /* of a motion: the uniform flux density, if it changes */
};

/* Reads the files that the scene names and builds everything. On bad input NULL, and the errors are in the
 * file's list. */
Model *model_create(const Scene *scene, YamlFile *file);
void model_destroy(Model *model);

/* Puts the moved coordinates where they are at that time, a part of the way (0..1) from where x has them. */
bool model_move(const Model *model, double time, double part, double *x, Error *err);

/* Puts what depends on time into p. */
bool model_load(const Model *model, double time, double *p, Error *err);

/* Parts of model_create, by body: false after a refusal. */
bool model_shell(Model *model, const Scene *scene, YamlFile *file);
bool model_rod(Model *model, const Scene *scene, YamlFile *file);
bool model_drawing(Model *model, const Scene *scene, YamlFile *file);

/* What of a scene counts before there can be vectors p, in this order (blocks.c): the flux densities of all cases or
 * stages, whose fields are then the body's; and, once the body and its blocks are there, the blocks that a trajectory
 * has beside them (model->control is the first one). False after a refusal. */
bool model_read_flux(Model *model, const struct Build *b, const Scene *scene, FluxFields *fields);
void model_add_blocks(Model *model, const Scene *scene);

/* A flux density of model->flux into p. */
void model_put_flux(const Model *model, const CaseFlux *flux, double *p);

/* Where a case starts, once its system is there: x, at its first stage's time. */
void model_start_case(ModelCase *c, const double *x);

/* The load cases or stages of a scene, each with p as a copy; false after a refusal. */
bool model_cases(Model *model, const struct Build *b, const Scene *scene, const double *p);

/* Velocities at the start of a motion, of the free coordinates, into its case; place[point_count][3] is what formulas know.
 */
bool model_velocity(Model *model, const struct Build *b, const char *at, const VelocityScene *scene,
                    const double *place);

bool model_is_motion(int job);

/* The scene's unknowns, with their starts (noise included) written into the p of all cases, and
 * (model_objectives) the objectives of all cases. Parts of model_create for designs and trajectories; false
 * after a refusal. */
bool model_design(Model *model, const Scene *scene, YamlFile *file);
bool model_objectives(Model *model, const Scene *scene, YamlFile *file);
