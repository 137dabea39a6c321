/* model.h - a scene made ready to run: the shell, its load cases and what is prescribed over time. */
#pragma once
#include "cli/scene.h"
#include "cli/timed_flux.h"
#include "io/formula.h"
#include "optim/control.h"
#include "optim/design.h"
#include "shell/select.h"
#include "shell/shell.h"
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
    double *x; /* [dofs] where to start */
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
} Motion;

typedef struct Model {
    Shell *shell;
    MeshReport report; /* warnings about the mesh */
    int case_count, motion_count;
    ModelCase *cases;
    Motion *motions;
    double *x, *v;          /* [dofs] rest or pose; velocities at the start of a motion */
    Design design;          /* of a design or trajectory */
    Control control;        /* of a trajectory: the unknown flux density; no rows: none */
    TimedFlux flux_of_time; /* of a motion: the uniform flux density, if it changes */
} Model;

/* Reads the files that the scene names and builds everything. On bad input NULL, and the errors are in the
 * file's list. */
Model *model_create(const Scene *scene, YamlFile *file);
void model_destroy(Model *model);

/* Puts the moved coordinates where they are at that time, a part of the way (0..1) from where x has them. */
bool model_move(const Model *model, double time, double part, double *x, Error *err);

/* Puts what depends on time into p. */
bool model_load(const Model *model, double time, double *p, Error *err);

/* The scene's unknowns, with their starts (noise included) written into the p of all cases, and (model_objectives)
 * the objectives of all cases. Parts of model_create for designs and trajectories; false after a refusal. */
bool model_design(Model *model, const Scene *scene, YamlFile *file);
bool model_objectives(Model *model, const Scene *scene, YamlFile *file);
