/* slender.h - slender as a library: simulates and designs slender things. For C and C++.
 *
 *     SlenderError err;
 *     SlenderScene *scene = slender_scene_read("sheet.yaml", NULL, 0, &err);
 *     SlenderModel *model = scene ? slender_model_create(scene, 1, &err) : NULL;
 *     SlenderState *state = model ? slender_state_create(model, 0, &err) : NULL;
 *     if (!state || slender_equilibrium(model, 0, state, NULL, &err) != SLENDER_DONE) puts(err.text);
 *
 * Link libslender (pkg-config slender; CMake: find_package(slender), slender::slender).
 *
 * Units are SI. Vectors over dofs are [dofs]: first the places of the points, [points][3] in m, then what else moves (edge
 * angles, turns: rad; multipliers: N). Vectors over parameters are [params], in blocks that have names
 * (slender_model_block), each in its own unit.
 *
 * Pointers must not be NULL unless it is said; what destroys or frees takes NULL.
 *
 * Errors. A call that can fail returns a SlenderStatus, or NULL; err, which may be NULL, then has one sentence on what is wrong
 * and what is allowed, with file, line and column or the key of the scene. Where a solve does not converge the call
 * returns SLENDER_NOT_CONVERGED, and the state is where it came to. Where memory is not there it returns
 * SLENDER_NO_MEMORY: then the model (or motion) that the call worked on is lost, and is not even to be destroyed;
 * everything else stays as it was.
 *
 * Threads. Calls may come from several threads at once, as long as each scene, and each model with its states and motions, is used
 * by one at a time. Within a call a model works with the threads that it was created with: the same numbers come out, bit by bit,
 * for any number of them.
 *
 * No call prints, ends the process, catches a signal or sets anything for the process as a whole. So what OpenBLAS does
 * is the program's to say, before it is loaded: with OPENBLAS_NUM_THREADS=1 numbers are the same bits every time, and
 * OPENBLAS_CORETYPE chooses kernels for a processor that is newer than the library (slender_versions says which there
 * are). */
#ifndef SLENDER_H
#define SLENDER_H

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define SLENDER_API __attribute__((visibility("default")))
#else
#define SLENDER_API
#endif

/* ---- What calls return ---- */

typedef enum SlenderStatus {
    SLENDER_DONE = 0,
    SLENDER_NOT_CONVERGED = 1,
    SLENDER_REFUSED = 3, /* scene or arguments */
    SLENDER_CANNOT_WRITE = 4,
    SLENDER_NO_MEMORY = 5,
    SLENDER_INTERRUPTED = 75, /* the host has asked for it */
} SlenderStatus;

typedef struct SlenderError {
    SlenderStatus status;
    char text[1024];
} SlenderError;

/* "0.1.0". */
SLENDER_API const char *slender_version(void);

/* Slender and the libraries that it works with, a line each; the JSON Schema of scenes. To be freed by slender_free; NULL
 * where memory is not there. */
SLENDER_API char *slender_versions(void);
SLENDER_API char *slender_schema(void);

/* Frees a text that a call returned; NULL is fine. */
SLENDER_API void slender_free(char *text);

/* ---- Whoever calls ---- */

/* What a long call tells, and when it shall stop. All may be NULL. */
typedef struct SlenderHost {
    void *self;

    /* A step of `total` is done; what it brought: "F 0.02 F0". And sentences. From the calling thread. */
    void (*step)(void *self, int step, int total, const char *detail);
    void (*say)(void *self, const char *sentence);
    void (*warn)(void *self, const char *sentence);

    /* Asked often, from any thread: not 0 when the call shall return, and from then on. */
    int (*stop)(void *self);

    /* A frame is there: its time in s, and place[points][3] in m. From the calling thread. */
    void (*frame)(void *self, double time, int points, const double *place);
} SlenderHost;

/* ---- Scenes ---- */

typedef struct SlenderScene SlenderScene;

/* Reads a scene file; settings[count] are assignments like "shell.thickness=1 mm" (--set of the program). */
SLENDER_API SlenderScene *slender_scene_read(const char *path, const char *const *settings, int count,
                                             SlenderError *err);

/* The same of a text, YAML or JSON, made by a program: sentences name keys, not lines. Paths are relative to the working
 * directory. */
SLENDER_API SlenderScene *slender_scene_parse(const char *text, const char *const *settings, int count,
                                              SlenderError *err);

/* The effective scene as YAML: every key with its value, in SI units. To be freed by slender_free. */
SLENDER_API char *slender_scene_text(const SlenderScene *scene);
SLENDER_API void slender_scene_destroy(SlenderScene *scene);

/* Runs the scene's job as `slender run` does. */
typedef struct SlenderRun {
    const char *output; /* NAME of NAME.vtkhdf, NAME.run, ..                                                */
    int threads;        /* 1 to 64 */
    int resume, force;  /* goes on with a run, or extends one; discards one, or the result of another scene */
    int no_journal;     /* keeps the journal in memory: what is interrupted is lost                         */
    SlenderHost host;
} SlenderRun;

SLENDER_API SlenderStatus slender_run(const SlenderScene *scene, const SlenderRun *def, SlenderError *err);

/* ---- Models ---- */

/* A scene's body made ready, with its load cases, for whatever its job is. */
typedef struct SlenderModel SlenderModel;

/* The scene must outlive it. threads: 1 to 64, that it works with in a call. Refused: a scene without load cases (a drawing, an inversion); what is doubtful
 * is among its info, as warnings. */
SLENDER_API SlenderModel *slender_model_create(const SlenderScene *scene, int threads, SlenderError *err);
SLENDER_API void slender_model_destroy(SlenderModel *model);

typedef struct SlenderModelInfo {
    int cases, terms, blocks; /* how many; all cases have the same terms */
    int points, dofs, params; /* lengths of vectors                      */
    int faces;                /* of its mesh; 0: it has none             */
    int memory;               /* numbers that the terms remember         */
    const double *rest;       /* [dofs] at rest, or in its pose; a scene's `start` is in its states only */
    const int *face;          /* [faces][3] points of each; NULL: it has none                 */
    const char *warnings;     /* what is doubtful, a line each; "" : nothing                    */
} SlenderModelInfo;

/* Borrowed from the model. */
SLENDER_API SlenderModelInfo slender_model_info(const SlenderModel *model);

/* Names: of a case, "up"; of a term of energy in statics, "magnetic". NULL: there is none of that number. */
SLENDER_API const char *slender_model_case(const SlenderModel *model, int load_case);
SLENDER_API const char *slender_model_term(const SlenderModel *model, int term);

typedef struct SlenderBlock {
    const char *name, *unit;  /* "young", "Pa"                                        */
    int offset, count, width; /* values[count][width] from p[offset] on              */
    int per_case;             /* each load case has its own: fields, gravity, loads  */
} SlenderBlock;

SLENDER_API SlenderBlock slender_model_block(const SlenderModel *model, int block);

/* p[params] of a case, borrowed: what is written there counts from the next call on. Blocks that are not per_case are those
 * of all cases: they are written in case 0, the others' are copies. */
SLENDER_API double *slender_model_params(SlenderModel *model, int load_case);

/* ---- States ---- */

/* Where a body is: a value. */
typedef struct SlenderState SlenderState;

/* Where the case starts. */
SLENDER_API SlenderState *slender_state_create(SlenderModel *model, int load_case, SlenderError *err);
SLENDER_API SlenderState *slender_state_copy(const SlenderState *state);
SLENDER_API void slender_state_destroy(SlenderState *state);

typedef struct SlenderStateInfo {
    int dofs, memory_count;
    double *x, *v, *memory; /* [dofs], [dofs] (0 in statics), [memory_count]: may be written */
    double *time;           /* s */
    const char *status;     /* of the last solve: "converged", "saddle", ..; "start" */
    double energy;          /* J, of the last solve */
    int newton_iterations;
} SlenderStateInfo;

/* Borrowed from the state. */
SLENDER_API SlenderStateInfo slender_state_info(SlenderState *state);

/* ---- Statics ---- */

/* Takes the state to the equilibrium of the case, at the scene's time: by load steps from a start, or, where it was the model's equilibrium of
 * this case with other parameters, from there along the tangent. host may be NULL. */
SLENDER_API SlenderStatus slender_equilibrium(SlenderModel *model, int load_case, SlenderState *state,
                                              const SlenderHost *host, SlenderError *err);

/* The energy in J; of each term energies[terms], and gradient[dofs] dE/dx; where they are not NULL. At dofs that are held
 * the gradient is the support's force on the body. NAN: not finite, or refused: then err says why. */
SLENDER_API double slender_energy(SlenderModel *model, int load_case, const SlenderState *state,
                                  double *energies, double *gradient, SlenderError *err);

/* Derivatives of an equilibrium x(p): dp[params] = (dx/dp)^T dx, and dx[dofs] = (dx/dp) dp. Exact at an equilibrium, with
 * the factor of its solve where that is at hand; SLENDER_REFUSED where the Hessian is not positive definite: there is no
 * stable equilibrium near. */
SLENDER_API SlenderStatus slender_vjp(SlenderModel *model, int load_case, const SlenderState *state,
                                      const double *dx, double *dp, SlenderError *err);
SLENDER_API SlenderStatus slender_jvp(SlenderModel *model, int load_case, const SlenderState *state,
                                      const double *dp, double *dx, SlenderError *err);

/* ---- Arrays ---- */

typedef enum SlenderType { SLENDER_DOUBLE, SLENDER_INT, SLENDER_TEXT } SlenderType;

typedef struct SlenderArray {
    SlenderType type;
    int rank, dims[3];
    const char *unit;
    void *data; /* double, int (32 bits) or char, row by row */
    const char *name;
} SlenderArray;

SLENDER_API void slender_array_free(SlenderArray *array);

/* ---- Motion ---- */

/* A stored motion: its states, and what its derivatives need. */
typedef struct SlenderMotion SlenderMotion;

typedef struct SlenderMotionDef {
    int steps;
    double step; /* s */

    /* [steps][3] T: the uniform flux density that acts in each step. NULL: the scene's, over time where its job is a
     * motion. */
    const double *flux;

    double memory; /* bytes that factors may take, which derivatives else make again; 0: 1 GiB */
    SlenderHost host;
} SlenderMotionDef;

/* From a state (with its velocities) on, by implicit Euler. A motion in which a step fails or that is stopped comes back too,
 * as long as it came, and one in which an obstacle goes through the body (SLENDER_NOT_CONVERGED) as a whole; *status
 * says so. */
SLENDER_API SlenderMotion *slender_simulate(SlenderModel *model, int load_case, const SlenderState *start,
                                            const SlenderMotionDef *def, SlenderStatus *status,
                                            SlenderError *err);
SLENDER_API void slender_motion_destroy(SlenderMotion *motion);

/* Steps that were reached, and the state after n of them (0: the start): the caller's. */
SLENDER_API int slender_motion_steps(const SlenderMotion *motion);
SLENDER_API SlenderState *slender_motion_state(const SlenderMotion *motion, int n, SlenderError *err);

/* What the body met and what held it, a row for each step that was reached, named and measured as history/ of a simulation (docs/result.md):
 * "contacts", "contact_force", "support_force", .. Array number 0, 1, ..; beyond the last one it has no name (NULL). To be freed
 * by slender_array_free. */
SLENDER_API SlenderStatus slender_motion_met(SlenderMotion *motion, int number, SlenderArray *array,
                                             SlenderError *err);

/* Of F(x_n, v_n, ..): dF/dx[count][dofs] and dF/dv alike, either may be NULL, of the states after frame[count] steps, to dF/dp[params]
 * (of which flux_density is 0 where flux was given), dF/dflux[steps][3], and dF/dx, dF/dv of the start, [dofs]; NULL: not
 * wanted. Exact. */
SLENDER_API SlenderStatus slender_motion_vjp(SlenderMotion *motion, int count, const int *frame,
                                             const double *dx, const double *dv, double *dp, double *dflux,
                                             double *start_x, double *start_v, SlenderError *err);

/* The tangent: dx[steps + 1][dofs] of all states for changes dp[params], dflux[steps][3], and of the start's x and v; NULL: none. */
SLENDER_API SlenderStatus slender_motion_jvp(SlenderMotion *motion, const double *dp, const double *dflux,
                                             const double *start_x, const double *start_v, double *dx,
                                             SlenderError *err);

/* ---- Results ---- */

typedef struct SlenderResult SlenderResult;

SLENDER_API SlenderResult *slender_result_open(const char *path, SlenderError *err);
SLENDER_API void slender_result_close(SlenderResult *result);

/* Paths of its datasets, "slender/state/x", borrowed; NULL beyond the last one. And its frames. */
SLENDER_API const char *slender_result_name(const SlenderResult *result, int number);
SLENDER_API int slender_result_frames(SlenderResult *result);

/* A dataset or, with a frame from 0 on, "Points", "CellData/NAME", "PointData/NAME" of it. To be freed by slender_array_free. */
SLENDER_API SlenderStatus slender_result_read(SlenderResult *result, const char *name, int frame,
                                              SlenderArray *array, SlenderError *err);

#ifdef __cplusplus
}
#endif
#endif
