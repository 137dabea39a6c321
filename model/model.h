/* model.h - a scene made ready to run: a body, its load cases and what is prescribed over time; or a body without
 * cases (a drawing), which has its own job. */
#pragma once
#include "model/rows.h"
#include "field/flux.h"
#include "field/timed.h"
#include "optim/control.h"
#include "optim/design.h"
#include "surface/select.h"
#include "world/world.h"

/* Where the scene writes a key whose formulas are asked in a run, and how sentences about it begin. */
typedef struct Written {
    char *how, *where;
} Written;

/* Coordinates that follow formulas of rest position and time. */
typedef struct Motion {
    Formula *formula;
    Indices vertices;
    bool axis[3];
    int entry; /* of the scene's `fix` */
} Motion;

/* Points that are held along these axes (forces.h). */
typedef struct Support {
    Indices points;
    bool axis[3];
} Support;

typedef struct Model Model;
typedef struct ModelProbe ModelProbe; /* probe.h */
typedef struct Start Start;           /* start.h */

/* What a scene says of the flux density, of all cases or of one. */
typedef struct CaseFlux {
    double uniform[3]; /* T */
    int first, count;  /* of the body's fields, which vary in space */
} CaseFlux;

struct Model {
    const BodyRow *body;
    const JobRow *job;
    void *self;        /* the body as its front knows it: a Shell, ..; owned     */
    const Mesh *mesh;  /* of a body that has one; the body's                     */
    DirectKind direct; /* what factors matrices of its systems                  */
    bool general;      /* of any use, not only that of its job: all points are dofs */
    double time;       /* s, where it begins                                     */
    Start *start;      /* while it is made: what it starts from; NULL: nothing   */
    /* Nothing below is of a body without cases. */
    Params *params; /* the body's                                          */
    /* First entries in p of gravity, of the flux density and its `fields`; -1: it feels none. */
    int gravity;
    FluxBlocks flux_blocks;
    FluxFields *fields; /* the body's */
    World *world;       /* what it meets, the body's; NULL: nothing */
    int point_count;    /* vertices or nodes                                   */
    int load_steps;     /* of an equilibrium, unless the scene says            */
    double step_cap;    /* of Newton                                           */
    bool moves;         /* held coordinates do: BodyOps.move                   */
    MeshReport report;  /* warnings about the mesh */
    int case_count, motion_count, support_count, probe_count, written_count;
    Case *cases;
    Motion *motions;
    Written *written;
    Support *supports; /* what holds it, as the scene says it */
    ModelProbe *probes;
    double *x;         /* [dofs] rest or pose */
    Design design;     /* of a design or trajectory */
    Control control;   /* of a trajectory: the unknown flux density; no rows: none */
    Control strengths; /* of a trajectory: unknown strengths of sources; no rows: none, or constant */
    CaseFlux *flux;    /* of the scene, then of each case or stage */
    bool *told_within; /* [fields] in which of their sources the body was said to be; NULL: none (within.h) */
    Timed flux_of_time; /* of a motion: the uniform flux density, if it changes */
};

/* Reads the files that the scene names and builds everything. On bad input NULL, and the errors are in the
 * file's list. */
Model *model_create(const Scene *scene, YamlFile *file);

/* The same for any use, whatever the scene's job: its systems and states have all points as dofs, first of all. */
Model *model_create_general(const Scene *scene, YamlFile *file);
void model_destroy(Model *model);

/* The sentence with the key, and the place where the scene writes it; false. */
bool model_unknown(const Model *model, const char *key, Error *err);

/* Puts the moved coordinates where they are then. */
bool model_move(const Model *model, HeldWay way, double *x, Error *err);

/* A system of the model's that was just made, with what the scene says of solvers; it is returned. */
System *model_take_system(const Model *model, System *sys);

/* Puts what depends on time into p, but for the flux density where that is given from elsewhere. False and a sentence that says which field or obstacle
 * has a formula that is not finite then. */
bool model_load(const Model *model, double time, bool flux_given, double *p, Error *err);

/* Are the fields in which a case is, the water's stream and the body's own loads known where it is in the state x? False and a sentence
 * that says where which of them is not: to be asked when a solve has failed. */
bool model_knows_fields(const Model *model, const double *p, double time, const double *x, Error *err);

/* What the scene's key `fix` holds of a body with a mesh: coordinates, fixed[3*vertex_count], and slopes, clamped[edge_count];
 * and how it moves them, into the model. False after a refusal. model_move_held is then BodyOps.move. */
bool model_hold(Model *model, const Build *b, const Scene *scene, bool *fixed, bool *clamped);
bool model_move_held(const Model *model, HeldWay way, double *x, Error *err);

/* Other operations (BodyOps) of bodies with a mesh, whose first dofs are the positions of its vertices, and which have a block
 * `load` and tell the rows of others (row_dim). model_start_cases, last of all, gives each case its system and start; an equilibrium needs forces in balance,
 * unless there is something that may bear them. */
bool model_put_loads(Model *model, const Build *b, const char *at, const LoadScene *loads, int count,
                     double *p);
bool model_put_target(Model *model, const Build *b, const char *at, const TargetScene *scene,
                      double (*target)[3]);
bool model_put_numbers(Model *model, const Build *b, const char *at, const NumberScene *scene,
                       const ParamBlock *block, double *values);
bool model_put_vectors(Model *model, const Build *b, const char *at, const VectorScene *scene,
                       const ParamBlock *block, double *values);
bool model_select(const Model *model, const Build *b, const char *at, const char *name, Indices *found);
void model_places(const Model *model, const double *x, double *place);
void model_supports(const Model *model, const Snapshot *shot, double *force);
bool model_start_cases(Model *model, const Build *b, const bool *fixed);

/* What of a scene counts before there can be vectors p, in this order (blocks.c): the flux densities of all cases or
 * stages, whose fields are then the body's; and, once the body and its blocks are there, the blocks that a trajectory
 * has beside them (model->control is the first one). False after a refusal. */
bool model_read_flux(Model *model, const Build *b, const Scene *scene, FluxFields *fields);
void model_add_blocks(Model *model, const Scene *scene);

/* The world of a scene, for a body to take before its vectors p are made : NULL where it meets nothing. False
 * after a refusal, *world is then to be taken, too. model_put_world puts its numbers, which follow from the body, into the p of
 * all cases; model_check_world refuses starts that pass through themselves. */
bool model_read_world(Model *model, const Build *b, const Scene *scene, const WorldBody *body, World **world);
void model_put_world(Model *model, const Scene *scene);
bool model_check_world(Model *model, YamlFile *file);

/* What of a trajectory changes in time as an unknown; how many. */
int model_controls(const Model *model, Control controls[2]);

/* Of all points of a body that tells its masses (BodyOps.masses), with those numbers; mass[point_count], kg. */
void model_masses(const Model *model, const double *p, double *mass);

/* A flux density, model->flux[number], into p. */
void model_put_flux(const Model *model, int number, double *p);

/* The flux density with those numbers and at that time in the middle of the body: the mean of its points at rest, or, of a
 * body without a mesh, where it starts. T. */
void model_flux(const Model *model, const double *p, double time, double flux[3]);

/* The load cases or stages of a scene, each with p as a copy; false after a refusal. */
bool model_cases(Model *model, const Build *b, const Scene *scene, const double *p);

/* Where a scene or case says that the body should be, into the case; false after a refusal. What one of them asks for; and the
 * places of all of them, [point][3], the last one's where several give one: NAN where there is none. The caller frees; NULL:
 * there are none. */
bool model_targets(Model *model, const Build *b, Key at, const TargetScene *list, int count, Case *c);
Objective model_target_objective(const Target *target, int point_count, double weight);
double (*model_target_places(const Case *c, int point_count))[3];

/* Velocities at the start of a motion, of the free coordinates, into its case; place[point_count][3] is what formulas know.
 */
bool model_velocity(Model *model, const Build *b, const char *at, const VelocityScene *scene,
                    const double *place);

/* The scene's unknowns, with their starts (noise included) written into the p of all cases, and
 * (model_objectives) the objectives of all cases. Parts of model_create for designs and trajectories; false
 * after a refusal. */
bool model_design(Model *model, const Scene *scene, YamlFile *file);

bool model_objectives(Model *model, const Scene *scene, YamlFile *file);

/* Is the text the number of one of so many points, 0 .. count - 1? */
bool model_point_number(const char *text, int count, int *point);
