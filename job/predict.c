#include "job/predict.h"
#include "base/clock.h"
#include "base/memory.h"
#include "job/job.h"
#include "optim/trajectory_adjoint.h"
#include "surface/shapes.h"
#include "solve/kernels.h"
#include <math.h>

/* ---- What one thing takes ---- */

typedef struct Units {
    double build, hessian, factor, solve; /* s: pattern, order and slots; each once */
} Units;

typedef struct Piece {
    Shell *shell;
    System *sys;
    double *p, *gradient;
    State state;
} Piece;

enum { PIECE_LENGTH = 64, PIECE_WIDTH = 32, REPEATS = 4 };

/* A sheet that bends like the shell, at rest, held at one end. */
static Piece piece_create(const Shell *like)
{
    MeshFile file;
    Error err;
    shape_sheet((double[]){2, 1}, (int[]){PIECE_LENGTH, PIECE_WIDTH}, PATTERN_RIGHT, &file, &err);
    Shell *shell = shell_create(mesh_create(&file, 0, NULL, &err), NULL);
    mesh_file_clear(&file);
    shell->thickness = 0.01, shell->poisson = like->poisson, shell->density = 1000,
    shell->bending = like->bending;
    for (int v = 0; v < shell->mesh->vertex_count; v++)
        for (int i = 0; shell->mesh->rest[v][0] == 0 && i < 3; i++) shell_fix(shell, v, i);
    Piece piece = {.shell = shell, .sys = shell_system(shell)};
    piece.p = mem_alloc((size_t)shell->params.size, sizeof(double));
    piece.gradient = mem_alloc((size_t)shell_dof_count(shell), sizeof(double));
    piece.state = system_state(piece.sys);
    shell_default_params(shell, piece.p);
    shell_rest_state(shell, piece.state.x);
    return piece;
}

static void piece_destroy(Piece *piece)
{
    system_destroy(piece->sys);
    shell_destroy(piece->shell);
    state_destroy(&piece->state);
    mem_free(piece->p);
    mem_free(piece->gradient);
}

static double lap(double *last)
{
    double now = clock_thread_seconds(), seconds = now - *last;
    *last = now;
    return seconds;
}

/* The least of some times, but for the matrix, which is built once. */
static Units measure(System *sys, const Point *at, double *gradient, int repeats)
{
    Units least = {INFINITY, INFINITY, INFINITY, INFINITY};
    double time = clock_thread_seconds();
    system_build(sys);
    least.build = lap(&time);
    for (int k = 0; k < repeats; k++) {
        system_hessian(sys, at, gradient);
        least.hessian = fmin(least.hessian, lap(&time));
        (void)(system_factor(sys, 0) || system_factor(sys, 1e-6));
        least.factor = fmin(least.factor, lap(&time));
        system_solve(sys, gradient, gradient);
        least.solve = fmin(least.solve, lap(&time));
    }
    return least;
}

/* ---- What the factor of a surface costs ---- */

/* Numbers of L over n = slope * log2(n) - less, flops = rate * n^1.5: METIS on sheets of 33 000 to a million
 * triangles twice as long as wide, by the bending model. */
static const struct {
    double slope, less, rate;
} laws[] = {[BENDING_MIDEDGE] = {33.6, 316, 480}, [BENDING_HINGE] = {39, 324, 690}};

static const double REFERENCE = 4.5;    /* elongation of those sheets                          */
static const double BYTES = 9.5;        /* of a number of L: supernodes store a few zeros, too */
static const double METIS_COST = 2.2;   /* to order an unknown, over AMD                       */
static const double OUT_OF_CACHE = 1.5; /* assembly of a large mesh, over that of the piece    */

/* Vertices by their distance in edges from a vertex; returns the one farthest off, and how far. */
static int sweep(const int *first, const int *next, int count, int from, int *distance, int *queue,
                 int *depth)
{
    int head = 0, tail = 0;
    for (int v = 0; v < count; v++) distance[v] = -1;
    queue[tail++] = from;
    for (distance[from] = 0; head < tail; head++)
        for (int k = first[queue[head]]; k < first[queue[head] + 1]; k++)
            if (distance[next[k]] < 0) distance[next[k]] = distance[queue[head]] + 1, queue[tail++] = next[k];
    *depth = distance[queue[tail - 1]];
    return queue[tail - 1];
}

/* The squared diameter over the vertices, in edges: about length over width. Separators are as long as the body is
 * wide. */
static double elongation(const Mesh *mesh)
{
    int n = mesh->vertex_count, end = 0, depth = 0;
    int *first = mem_alloc((size_t)n + 2, sizeof *first),
        *next = mem_alloc(2 * (size_t)mesh->edge_count, sizeof *next),
        *work = mem_alloc(2 * (size_t)n, sizeof *work);
    for (int e = 0; e < mesh->edge_count; e++)
        for (int i = 0; i < 2; i++) first[mesh->edges[e][i] + 2]++;
    for (int v = 0; v < n; v++) first[v + 2] += first[v + 1];
    for (int e = 0; e < mesh->edge_count; e++)
        for (int i = 0; i < 2; i++) next[first[mesh->edges[e][i] + 1]++] = mesh->edges[e][1 - i];
    for (int pass = 0; pass < 3; pass++) end = sweep(first, next, n, end, work, work + n, &depth);
    mem_free(first);
    mem_free(next);
    mem_free(work);
    return (double)depth * depth / n;
}

/* A long body is a row of pieces of the sheets' form. */
static void count_by_law(const Shell *shell, Prediction *r)
{
    double pieces = fmax(1, elongation(shell->mesh) / REFERENCE), n = r->unknowns / pieces;
    r->numbers = r->unknowns * (laws[shell->bending].slope * log2(n) - laws[shell->bending].less);
    r->flops = pieces * laws[shell->bending].rate * pow(n, 1.5);
    r->factor_bytes = BYTES * r->numbers;
}

static void take_cost(SparseInfo cost, Prediction *r)
{
    r->numbers = (double)cost.factor_nonzeros;
    r->flops = cost.factor_flops;
    r->factor_bytes = fmax((double)cost.factor_bytes, 8 * r->numbers);
}

/* Numbers of the piece's factor that are not multiplied take their time, too: the same for each. */
static Units units_of_shell(const Model *model, Prediction *r)
{
    const Shell *shell = model->shell;
    Piece piece = piece_create(shell);
    Point at = state_point(&piece.state, piece.p);
    Units unit = measure(piece.sys, &at, piece.gradient, REPEATS);
    SparseInfo info = system_info(piece.sys);
    double faces = (double)shell->mesh->face_count / piece.shell->mesh->face_count, rate = kernels_flops(),
           numbers = (double)info.factor_nonzeros,
           each = fmax(0, (unit.factor - info.factor_flops / rate) / numbers);
    r->exact = r->unknowns <= PREDICT_EXACT;
    if (r->exact) {
        take_cost(system_cost(model->cases[0].sys), r);
    } else {
        count_by_law(shell, r);
    }
    unit.hessian *= faces * (faces > 4 ? OUT_OF_CACHE : 1);
    unit.build *= faces * (r->exact ? 1 : METIS_COST);
    unit.factor = each * r->numbers + r->flops / rate;
    unit.solve *= r->numbers / numbers;
    piece_destroy(&piece);
    return unit;
}

/* A rod's matrix is a band: all of it takes as long as its elements are many. */
static Units units_of_rod(const Model *model, Prediction *r)
{
    const ModelCase *c = &model->cases[0];
    double *gradient = mem_alloc((size_t)system_dof_count(c->sys), sizeof *gradient);
    Point at = state_point(&c->state, c->stages[0].p);
    Units unit = measure(c->sys, &at, gradient, 1);
    r->exact = true;
    take_cost(system_info(c->sys), r);
    mem_free(gradient);
    return unit;
}

/* ---- What a job does ---- */

/* As measured on scenes/ and by ./do bench equilibria: Newton iterations of a solve and of one that goes on from another,
 * factorisations and solves of each (in time some iterations make do with an older factor; a design's solves are those
 * of its optimiser, too), and bytes of the picture while it is drawn. */
typedef struct Effort {
    double first, more, factorizations, solves, picture;
} Effort;

static const Effort efforts[] = {[JOB_EQUILIBRIUM] = {12, 5, 2, 2, 100e6},
                                 [JOB_EVALUATE] = {1, 1, 2, 25, 100e6},
                                 [JOB_DESIGN] = {5, 5, 1.1, 8, 60e6},
                                 [JOB_SIMULATE] = {2, 2, 0.9, 4, 25e6},
                                 [JOB_TRAJECTORY] = {2, 2, 1, 8, 25e6}},
                    rod_equilibrium = {5, 5, 1.2, 1.2, 5e6};

static Effort effort_of(const Model *model, const Scene *scene)
{
    return model->rod && scene->job == JOB_EQUILIBRIUM ? rod_equilibrium : efforts[scene->job];
}

static double stage_count(const Model *model)
{
    double stages = 0;
    for (int k = 0; k < model->case_count; k++) stages += model->cases[k].stage_count;
    return stages;
}

static double iteration_count(const Model *model, const Scene *scene, const Effort *effort)
{
    double solves = stage_count(model), firsts = model->case_count;
    if (scene->job == JOB_EQUILIBRIUM)
        solves *= scene->load_steps.mode < 0 ? scene->load_steps.count : model->load_steps;
    if (model_is_motion(scene->job)) solves *= scene->time.steps;
    if (scene->design) solves *= scene->design->iterations + 1, firsts *= scene->design->iterations + 1;
    return firsts * effort->first + (solves - firsts) * effort->more;
}

static double frame_count(const Model *model, const Scene *scene)
{
    if (!model_is_motion(scene->job)) return stage_count(model);
    return 1 + (scene->output.every > 0 ? scene->time.steps / scene->output.every : 0);
}

/* ---- After the job: stability, result, picture ---- */

static const double LANCZOS_SOLVES = 30;
static const double PROGRAM_SECONDS = 0.1, SHELL_PICTURE_SECONDS = 0.4,
                    ELEMENT_SECONDS = 2e-6; /* of a frame, or picture */

static double end_seconds(const Model *model, double elements, double frames, Units unit)
{
    double seconds = PROGRAM_SECONDS + elements * ELEMENT_SECONDS * (1 + frames);
    if (!model->shell) return seconds;
    return seconds + SHELL_PICTURE_SECONDS + unit.hessian + unit.factor + LANCZOS_SOLVES * unit.solve;
}

/* ---- Memory ---- */

/* Bytes of the program; of a triangle or element in the mesh, the arrays and the result, and in the System of each case;
 * of a factor's byte while it is made. */
static const double PROGRAM_BYTES = 30e6, ELEMENT_BYTES = 1300, SYSTEM_BYTES[] = {4200, 3300}, WORK = 1.65;

static double peak_bytes(const Model *model, const Scene *scene, double elements, double factor)
{
    double dofs = system_dof_count(model->cases[0].sys),
           steps = scene->job == JOB_TRAJECTORY ? scene->time.steps : 0,
           kept = fmin(2 * steps * factor, (double)trajectory_default().factor_memory),
           system = SYSTEM_BYTES[model->shell ? model->shell->bending : BENDING_MIDEDGE];
    return PROGRAM_BYTES + effort_of(model, scene).picture + elements * ELEMENT_BYTES +
           8 * stage_count(model) * model->params->size +
           model->case_count * (elements * system + WORK * factor) + 32 * steps * dofs + kept;
}

/* ---- The whole ---- */

Prediction predict(const Model *model, const Scene *scene)
{
    Prediction r = {.unknowns = system_free_count(model->cases[0].sys)};
    Effort effort = effort_of(model, scene);
    double elements = model->shell ? model->shell->mesh->face_count : model->point_count - 1;
    Units unit = model->shell ? units_of_shell(model, &r) : units_of_rod(model, &r);
    r.iterations = iteration_count(model, scene, &effort);
    r.factorizations = effort.factorizations;
    r.factorization = unit.factor;
    r.iteration = unit.hessian + effort.factorizations * unit.factor + effort.solves * unit.solve;
    r.start = model->case_count * unit.build;
    r.end = end_seconds(model, elements, frame_count(model, scene), unit);
    r.bytes = peak_bytes(model, scene, elements, r.factor_bytes);
    return r;
}

double predict_seconds(const Prediction *r)
{
    return r->start + r->iterations * r->iteration + r->end;
}
