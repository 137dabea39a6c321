/* objects.h - what stands behind the library's handles. */
#pragma once
#include "base/guard.h"
#include "base/workers.h"
#include "slender.h"
#include "io/arrays.h"
#include "job/run.h"
#include "optim/path.h"

struct SlenderScene {
    YamlFile *file;
    Scene scene;
    char *path; /* NULL: a text of a program's */
};

/* A load case at hand: its systems are made when they are needed. */
typedef struct LibCase {
    System *statics, *motion; /* one of them is the model's */
} LibCase;

struct SlenderModel {
    const SlenderScene *scene;
    Model *model;
    Workers *workers; /* NULL: one thread */
    LibCase *cases;   /* [case_count] */
    unsigned long id; /* no other model of the process has it: an address may come again */
    char *warnings;
};

struct SlenderState {
    State now;
    const char *status;
    double energy;
    int newton_iterations;

    /* The last equilibrium found from it: where it is, for which parameters, and with the factor. NULL: none. */
    unsigned long model; /* its id */
    int load_case, params;
    double *rest, *p; /* [dofs], [params] */
    Factor *factor;
};

struct SlenderMotion {
    SlenderModel *model;
    int load_case, reached;
    bool given;    /* the flux density was, as a control */
    Params params; /* the model's, and the control's rows behind them */
    Control control;
    TrajectoryProblem problem;
    MarchDef march;
    Path path;
    State start;
    Run run; /* of the march: whom it tells */
    Host host;
    Error err;
    bool refused; /* a formula of time is not finite; err says so */
    Arrays met;   /* what the body met, from when it was asked for on */
    bool met_known;
};

/* Does work(self) and puts what it says of itself into the caller's error. */
SlenderStatus lib_call(SlenderStatus (*work)(void *self, Error *err), void *self, SlenderError *err);

/* The model of a scene, for its job or for any use, with so many threads; not SLENDER_DONE: err says what is wrong. */
SlenderStatus lib_build(SlenderScene *scene, int threads, bool general, Model **model, Error *err);

/* A sentence at the caller's. */
SlenderStatus lib_refuse(Error *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The caller's host as jobs know it; NULL: nobody listens. */
Host lib_host(const SlenderHost *host);

/* Is there such a case? */
bool lib_has_case(const SlenderModel *model, int load_case, Error *err);

/* The system of a case, at work with the model's threads; and its parameters, those that cases share put in. */
System *lib_system(SlenderModel *model, int load_case, bool motion);
double *lib_params(SlenderModel *model, int load_case);

/* An array as the caller has it, which takes what is in it. */
SlenderArray lib_array(const Array *array);

/* A state of the caller's with these numbers; NULL where memory is not there. */
SlenderState *lib_state(const State *from, SlenderError *err);
