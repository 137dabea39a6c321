/* What a shell's evaluation and factor take, from those of a small piece and from laws. */
#include "base/memory.h"
#include "job/predict.h"
#include "shell/front/front.h"
#include "solve/kernels.h"
#include "surface/shapes.h"
#include <math.h>

/* ---- A piece ---- */

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
    shell->bending = like->bending, shell->material = like->material;
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

/* ---- What the factor of a surface costs ---- */

/* Numbers of L over n = slope * log2(n) - less, flops = rate * n^1.5: METIS on sheets of 33 000 to a million
 * triangles twice as long as wide, by the bending model. Of small ones, 2 to 2000 triangles: small * sqrt(n). */
static const struct {
    double slope, less, rate, small;
} laws[] = {[BENDING_MIDEDGE] = {33.6, 316, 480, 2.1}, [BENDING_HINGE] = {39, 324, 690, 2.3}};

static const double SMALL_MOST = 110;   /* numbers over n, where the laws meet                 */
static const double REFERENCE = 4.5;    /* elongation of those sheets                          */
static const double BYTES = 9.5;        /* of a number of L: supernodes store a few zeros, too */
static const double METIS_COST = 2.2;   /* to order an unknown, over AMD                       */
static const double OUT_OF_CACHE = 1.5; /* assembly of a large mesh, over that of the piece    */

/* The vertices of each vertex's edges: next[first[v] .. first[v + 1] - 1]. */
typedef struct Ways {
    int *first, *next;
} Ways;

static Ways ways_create(const Mesh *mesh)
{
    int n = mesh->vertex_count;
    Ways ways = {mem_alloc((size_t)n + 2, sizeof(int)), mem_alloc(2 * (size_t)mesh->edge_count, sizeof(int))};
    for (int e = 0; e < mesh->edge_count; e++)
        for (int i = 0; i < 2; i++) ways.first[mesh->edges[e][i] + 2]++;
    for (int v = 0; v < n; v++) ways.first[v + 2] += ways.first[v + 1];
    for (int e = 0; e < mesh->edge_count; e++)
        for (int i = 0; i < 2; i++) ways.next[ways.first[mesh->edges[e][i] + 1]++] = mesh->edges[e][1 - i];
    return ways;
}

/* A part's vertices, by their distance in edges from one of them, which is -1 before. The last is farthest off. */
typedef struct Sweep {
    int end, depth, count;
} Sweep;

static Sweep sweep(Ways ways, int from, int *distance, int *queue)
{
    int head = 0, tail = 0;
    queue[tail++] = from;
    for (distance[from] = 0; head < tail; head++)
        for (int v = queue[head], k = ways.first[v]; k < ways.first[v + 1]; k++)
            if (distance[ways.next[k]] < 0)
                distance[ways.next[k]] = distance[v] + 1, queue[tail++] = ways.next[k];
    return (Sweep){queue[tail - 1], distance[queue[tail - 1]], tail};
}

/* Of a part of the body with that diameter, in edges, whose square over the vertices is about length over width: a long one is
 * a row of pieces of the sheets' form, as separators are as long as it is wide. */
static void add_part(BendingModel bending, Sweep part, double unknowns, Cost *cost)
{
    double elongation = (double)part.depth * part.depth / part.count,
           pieces = fmax(1, elongation / REFERENCE), n = unknowns / pieces,
           large = laws[bending].slope * log2(n) - laws[bending].less,
           small = fmin(laws[bending].small * sqrt(n), SMALL_MOST);
    cost->numbers += unknowns * fmax(large, small);
    cost->flops += pieces * fmin(laws[bending].rate * pow(n, 1.5), n * n * n / 3);
}

static void count_by_law(const Shell *shell, double unknowns, Cost *cost)
{
    enum { PASSES = 3 };
    const Mesh *mesh = shell->mesh;
    int n = mesh->vertex_count, *distance[PASSES], *queue = mem_alloc((size_t)n, sizeof *queue);
    Ways ways = ways_create(mesh);
    for (int k = 0; k < PASSES; k++) {
        distance[k] = mem_alloc((size_t)n, sizeof *distance[k]);
        for (int v = 0; v < n; v++) distance[k][v] = -1;
    }
    for (int v = 0; v < n; v++) {
        if (distance[0][v] >= 0) continue;
        Sweep part = {.end = v};
        for (int k = 0; k < PASSES; k++) part = sweep(ways, part.end, distance[k], queue);
        add_part(shell->bending, part, unknowns * part.count / n, cost);
    }
    cost->factor_bytes = BYTES * cost->numbers;
    for (int k = 0; k < PASSES; k++) mem_free(distance[k]);
    mem_free(queue);
    mem_free(ways.first);
    mem_free(ways.next);
}

/* ---- The whole ---- */

static const double SYSTEM_BYTES[] = {[BENDING_MIDEDGE] = 4200, [BENDING_HINGE] = 3300},
                    PICTURE_SECONDS = 0.4;

/* Numbers of the piece's factor that are not multiplied take their time, too: the same for each. */
void shell_cost(const Model *model, Cost *cost)
{
    const Shell *shell = model->self;
    double unknowns = system_free_count(model->cases[0].sys);
    Piece piece = piece_create(shell);
    Point at = state_point(&piece.state, piece.p);
    predict_measure(piece.sys, &at, REPEATS, cost);
    SparseInfo info = system_info(piece.sys);
    double faces = (double)shell->mesh->face_count / piece.shell->mesh->face_count, rate = kernels_flops(),
           numbers = (double)info.factor_nonzeros,
           each = fmax(0, (cost->factor - info.factor_flops / rate) / numbers);
    cost->exact = unknowns <= PREDICT_EXACT;
    if (cost->exact)
        predict_take_factor(system_cost(model->cases[0].sys), cost);
    else
        count_by_law(shell, unknowns, cost);
    cost->hessian *= faces * (faces > 4 ? OUT_OF_CACHE : 1);
    cost->build *= faces * (cost->exact ? 1 : METIS_COST);
    cost->factor = each * cost->numbers + cost->flops / rate;
    cost->solve *= cost->numbers / numbers;
    cost->elements = shell->mesh->face_count;
    cost->system_bytes = SYSTEM_BYTES[shell->bending];
    cost->picture = PICTURE_SECONDS;
    cost->stability = true;
    piece_destroy(&piece);
}
